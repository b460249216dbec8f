//! Mistakes in files of displacements: what they leave where they are undone is what the
//! description's own numbers leave, fitted to all rows alike.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Vector3};
use robstiff_robots::Description;

use super::mistakes::of_displacements;
use super::{Left, Misread, ROWS};
use crate::campaign::Displacements;
use crate::identify::baseline::declared;
use crate::identify::normal::{Normal, independent};
use crate::identify::samples::Samples;

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
    let samples = Samples::of_description(robot, data).without_encoders();
    let displacements = |stacked: &DVector<f64>| {
        let of_row = |row: usize| stacked.as_slice()[row * samples.axes..][..3].to_vec();
        DVector::from_vec((0..samples.rows.len()).flat_map(of_row).collect())
    };
    let own = declared(robot);
    let columns: Vec<DVector<f64>> = own.iter().map(|number| displacements(&samples.column(number.column))).collect();
    let normal = Normal::new(&DMatrix::from_columns(&columns), &displacements(&samples.readings()));
    let (kept, _) = independent(&normal.gram, &(0..own.len()).collect::<Vec<usize>>(), 0.0);
    let signs = kept.iter().map(|&k| own[k].sign).collect::<Vec<_>>();
    let fit = normal.solve_signed(&kept, &signs)?;
    Some(Left { squares: fit.rss, read: normal.energy, rows: samples.rows.len() })
}
