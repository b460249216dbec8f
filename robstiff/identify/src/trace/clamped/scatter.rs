//! Does what is left grow with the torque? Noise of the force, or of a gauge that is read in
//! parts of what it shows, is more at large torques, and rows there are no wild ones.

use std::vec::Vec;

use super::bench::Bench;
use crate::campaign::ClampedRow;
use crate::identify::clamped::wild::gains;
use crate::trace::lack_of_fit::correlation;
use crate::trace::model::Fitted;

/// So many standard deviations the correlation has to be above none: without growth it is once
/// in a thousand campaigns.
const GROWS: f64 = 3.1;

/// Of noise that grows, rows beyond this share of the torque on their axis have most.
const LARGE: f64 = 0.5;

/// Whether rows that are wild, by their lines, may be noise that grows with the torque: all are
/// at large torques, and what the others leave is more there.
pub fn may_be_noise(bench: &Bench, model: &Fitted, wild: &[usize]) -> bool {
    let whole = bench.axes.whole();
    let is_large = |row: &ClampedRow| row.torque.abs() > LARGE * whole.largest(row.axis);
    whole.rows.iter().filter(|row| wild.contains(&row.line)).all(is_large) && grows(bench, model)
}

/// Whether rows are the further off, up or down, the larger their torque: the correlation in
/// each axis, whose variance over all orders of its rows is one over their number less one.
fn grows(bench: &Bench, model: &Fitted) -> bool {
    let Some(all) = gains(&bench.axes.rows, &bench.problem, &model.fit) else { return false };
    let of_axis = |axis: usize| {
        let rows = bench.axes.rows_of(axis);
        let off: Vec<f64> = rows.iter().map(|&row| all[row].sqrt()).collect();
        let torques: Vec<f64> = rows.iter().map(|&row| bench.axes.rows[row].torque.abs()).collect();
        let sum = correlation(&off, &torques) * (rows.len() as f64 - 1.0).sqrt();
        (rows.len() > 2 && sum.is_finite()).then_some(sum)
    };
    let axes: Vec<f64> = bench.axes.loaded().filter_map(of_axis).collect();
    axes.iter().sum::<f64>() > GROWS * (axes.len() as f64).sqrt()
}
