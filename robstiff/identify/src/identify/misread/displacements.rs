//! Mistakes in files of displacements: what they leave where they are undone is what the
//! description's own numbers leave, fitted to all rows alike.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Vector3};
use robstiff_robots::Description;

use super::mistakes::of_displacements;
use super::{Left, Misread, ROWS};
use crate::campaign::Displacements;
use crate::model::described::declared;
use crate::model::{Parameter, Sign};
use crate::observe::Observation;
use crate::observe::displacement::Displacement;

/// Directions of columns of one length that are so much smaller than the largest say nothing.
const ALIKE_COLUMNS: f64 = 1e-7;

/// What the files of displacements may have been written with: what leaves, where it is undone, no
/// more than a part of what a model leaves of some rows (m, the root mean square of one axis), both
/// as shares of what is read, by squares.
pub fn in_displacements(
    robot: &Description,
    data: &Displacements,
    is_kept: impl Fn(usize) -> bool,
    left: f64,
    part: f64,
) -> Option<Misread> {
    // Whole visits, which laws of joints remember.
    let step = data.rows.len().div_ceil(ROWS).max(1);
    let is_asked = |row: &usize| is_kept(*row) && data.rows[*row].visit.is_multiple_of(step);
    let rows: Vec<_> = (0..data.rows.len()).filter(is_asked).map(|row| data.rows[row].clone()).collect();
    let read = rows.iter().map(|row| Vector3::from(row.displacement).norm_squared()).sum();
    let filed = Left { squares: 3.0 * left * left * rows.len() as f64, read, rows: rows.len() };
    let some = Displacements { rows, ..data.clone() };
    let undone = |mistake: &super::Mistake| {
        let (robot, data) = mistake.undone(robot, &some);
        left_by(&robot, &data)
    };
    (filed.read > 0.0).then(|| Misread::likely(of_displacements(robot), undone, part * filed.share()))?
}

/// What the description's own numbers leave; `None` where the rows show none of them. What is not
/// linear in the load, a thousandth of it, is not asked for.
fn left_by(robot: &Description, data: &Displacements) -> Option<Left> {
    let observation = Displacement::new(robot, data);
    let own = declared(robot);
    let parameters: Vec<Parameter> = own.iter().map(|own| own.parameter.clone()).collect();
    let all: Vec<usize> = (0..own.len()).collect();
    let columns = observation.columns(observation.world(), &parameters, &vec![0.0; own.len()], &all);
    let readings = observation.readings();
    let displacements = |stacked: &DVector<f64>| {
        let of_row = |row: usize| stacked.as_slice()[row * readings.width..][..readings.reported].to_vec();
        DVector::from_vec((0..readings.rows()).flat_map(of_row).collect())
    };
    let columns: Vec<DVector<f64>> = (0..own.len()).map(|k| displacements(&columns.column(k).into_owned())).collect();
    let read = displacements(&readings.values);
    let mut shown: Vec<usize> = all.into_iter().filter(|&k| columns[k].norm() > 0.0).collect();
    loop {
        if shown.is_empty() {
            return None;
        }
        // Columns of one length: numbers have units of their own.
        let scaled: Vec<DVector<f64>> = shown.iter().map(|&k| columns[k].normalize()).collect();
        let design = DMatrix::from_columns(&scaled);
        let numbers = design.clone().svd(true, true).solve(&read, ALIKE_COLUMNS).ok()?;
        let is_negative = |at: usize| numbers[at] < 0.0 && own[shown[at]].parameter.sign == Sign::Nonnegative;
        if !(0..shown.len()).any(is_negative) {
            let left = &read - design * numbers;
            return Some(Left { squares: left.norm_squared(), read: read.norm_squared(), rows: readings.rows() });
        }
        let kept = (0..shown.len()).filter(|&at| !is_negative(at)).map(|at| shown[at]).collect();
        shown = kept;
    }
}
