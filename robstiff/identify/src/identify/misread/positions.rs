//! Mistakes in files of absolute positions: what they leave where they are undone is what the
//! description as declared leaves, wherever the robot stands.

use nalgebra::Vector3;
use robstiff_robots::Description;

use super::mistakes::of_positions;
use super::{FAR_LESS, Left, Misread, ROWS};
use crate::campaign::Positions;
use crate::observe::position::Position;
use crate::observe::registration::{are_spread, registration};

/// Of how far positions are from their middle, more than this is no noise, nor anything that an
/// arm is off by.
pub const NOISIEST: f64 = 0.01;

/// What the files of positions may have been written with of which a model leaves so much (m, the
/// root mean square of one axis), more than any arm is off by.
pub fn in_positions(robot: &Description, data: &Positions, left: f64) -> Option<Misread> {
    let mut some = data.clone();
    let step = data.rows.len().div_ceil(ROWS).max(1);
    some.rows = data.rows.iter().step_by(step).cloned().collect();
    let filed = Left { squares: 3.0 * left * left * some.rows.len() as f64, ..spread(&some) };
    if filed.share() <= NOISIEST * NOISIEST {
        return None;
    }
    let undone = |mistake: &super::Mistake| {
        let (robot, data) = mistake.undone_in_positions(robot, &some);
        left_by(&robot, &data)
    };
    Misread::likely(of_positions(robot), undone, FAR_LESS * filed.share())
}

/// How far positions are from their middle (m), the root mean square.
pub fn apart(data: &Positions) -> f64 {
    from_middle(data.rows.iter().map(|row| Vector3::from(row.position)))
}

/// How far points are from their middle (m), the root mean square.
pub fn from_middle(points: impl ExactSizeIterator<Item = Vector3<f64>> + Clone) -> f64 {
    let count = points.len() as f64;
    (squares(points) / count).sqrt()
}

/// The sum of the squares of how far points are from their middle (m^2).
fn squares(points: impl ExactSizeIterator<Item = Vector3<f64>> + Clone) -> f64 {
    let middle = points.clone().sum::<Vector3<f64>>() / points.len() as f64;
    points.map(|point| (point - middle).norm_squared()).sum()
}

/// How far positions are apart, nothing of which is accounted for.
fn spread(data: &Positions) -> Left {
    let squares = squares(data.rows.iter().map(|row| Vector3::from(row.position)));
    Left { squares, read: squares, rows: data.rows.len() }
}

/// What a description leaves as it is; `None` where it puts all points on a line.
fn left_by(robot: &Description, data: &Positions) -> Option<Left> {
    let points = Position::new(robot, data).points(robot);
    let read: Vec<Vector3<f64>> = data.rows.iter().map(|row| row.position.into()).collect();
    are_spread(&points).then(|| {
        let stand = registration(&points, &read);
        let left = |(point, read): (&Vector3<f64>, &Vector3<f64>)| {
            (read - stand.rotation * point - stand.translation.vector).norm_squared()
        };
        Left { squares: points.iter().zip(&read).map(left).sum(), ..spread(data) }
    })
}
