//! Mistakes in files of absolute positions: what they leave where they are undone is what the
//! description as declared leaves, wherever the robot stands.

use std::string::String;
use std::vec::Vec;

use nalgebra::Vector3;
use robstiff_robots::Description;

use super::mistakes::of_positions;
use super::{FAR_LESS, Left, ROWS, joined, likely, words};
use crate::campaign::Positions;
use crate::identify::positions::model::Model;
use crate::identify::positions::registration::Registration;

/// What positions look like of which a model leaves so much a reading (m), each mistake as the
/// files have it; and all of them in a sentence, with what it leaves where it is undone.
pub fn in_positions(robot: &Description, data: &Positions, left: f64) -> Option<(Vec<String>, String)> {
    let mut some = data.clone();
    let step = data.rows.len().div_ceil(ROWS);
    some.rows = data.rows.iter().step_by(step.max(1)).cloned().collect();
    let filed = Left { squares: left * left * some.rows.len() as f64, ..spread(&some) };
    let undone = |mistake: &super::Mistake| {
        let (robot, data) = mistake.undone_in_positions(robot, &some);
        left_by(&robot, &data)
    };
    let likely = likely(of_positions(robot), undone, FAR_LESS * filed.share());
    let (least, _) = likely.first()?;
    let words = words(&likely);
    let millimetres = 1e3 * (least.squares / least.rows as f64).sqrt();
    let sentence = std::format!("{}, for with that undone it leaves {millimetres:.1} mm", joined(&words));
    Some((words, sentence))
}

/// How far positions are apart, nothing of which is accounted for.
fn spread(data: &Positions) -> Left {
    let rows = data.rows.len();
    let read = || data.rows.iter().map(|row| Vector3::from(row.position));
    let middle = read().sum::<Vector3<f64>>() / rows as f64;
    let squares = read().map(|position| (position - middle).norm_squared()).sum();
    Left { squares, read: squares, rows }
}

/// What a description leaves as it is; `None` where it puts all points on a line.
fn left_by(robot: &Description, data: &Positions) -> Option<Left> {
    let points = Model::new(robot, data).points(data);
    let pairs = points.iter().zip(&data.rows).map(|(point, row)| (*point, Vector3::from(row.position)));
    let stands = Registration::fitted(pairs.clone())?;
    let squares = pairs.map(|(point, read)| (read - stands.placed(&point)).norm_squared()).sum();
    Some(Left { squares, ..spread(data) })
}
