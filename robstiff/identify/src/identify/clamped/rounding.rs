//! What rounding does to readings of clamped axes.
//!
//! A gauge reads in steps. Where the noise is small against a step, rows may fit exactly,
//! and what they leave says nothing of how sure their slope is: every reading is off by up
//! to half a step all the same, with a variance of a twelfth of its square. Rows of one
//! torque are then off alike, and say it once.

use std::vec::Vec;

use nalgebra::DMatrix;

use crate::campaign::{ClampedRow, rounded};

/// Readings in proportion to this part of a step were not rounded to it, but are alike
/// because their torques are.
const PROPORTIONAL: f64 = 0.25;

/// Noise of half a step makes rows of one torque differ in how they are rounded: no more than
/// so many rows count as one.
const MOST_ALIKE: f64 = 4.0;

/// The least variance of the readings of each axis (rad^2 or m^2), from 0, that their own
/// rounding lets be; 0 where they show no step.
pub fn of_rounding(rows: &[ClampedRow]) -> Vec<f64> {
    let axes = rows.iter().map(|row| row.axis).max().unwrap_or(0);
    // One gauge reads all axes, or each has its own.
    let common = step(rows);
    let of_axis = |axis: usize| {
        let own: Vec<ClampedRow> = rows_of(rows, axis).into_iter().map(|row| rows[row]).collect();
        common.or_else(|| step(&own)).map_or(0.0, |step| step * step / 12.0 * alike(&own).min(MOST_ALIKE))
    };
    (1..=axes).map(of_axis).collect()
}

/// The step that readings are multiples of, if they show one and are not alike for another
/// reason.
fn step(rows: &[ClampedRow]) -> Option<f64> {
    let step = rounded::step(rows.iter().map(|row| row.deflection))?;
    (off(rows) > PROPORTIONAL * step).then_some(step)
}

/// How far a reading is at most from being in proportion to the torque on its axis.
fn off(rows: &[ClampedRow]) -> f64 {
    let columns = torques(rows);
    let of_axis = |column: nalgebra::DVectorView<'_, f64>| {
        let own = || rows.iter().zip(column.iter()).filter(|(_, torque)| **torque != 0.0);
        let slope = own().map(|(row, torque)| row.deflection * torque).sum::<f64>() / column.norm_squared();
        own().map(|(row, torque)| (row.deflection - slope * torque).abs()).fold(0.0, f64::max)
    };
    columns.column_iter().map(of_axis).fold(0.0, f64::max)
}

/// How many loaded rows there are to a torque, whichever way.
fn alike(rows: &[ClampedRow]) -> f64 {
    let mut torques: Vec<f64> = rows.iter().map(|row| row.torque.abs()).filter(|&torque| torque > 0.0).collect();
    let loaded = torques.len();
    torques.sort_by(f64::total_cmp);
    torques.dedup();
    loaded as f64 / torques.len().max(1) as f64
}

/// The axes (from 1) that are loaded, in order.
pub fn loaded(rows: &[ClampedRow]) -> Vec<usize> {
    axes_of(rows.iter().filter(|row| row.torque != 0.0))
}

/// The axes (from 1) of some rows, in order.
fn axes_of<'a>(rows: impl Iterator<Item = &'a ClampedRow>) -> Vec<usize> {
    let mut axes: Vec<usize> = rows.map(|row| row.axis).collect();
    axes.sort_unstable();
    axes.dedup();
    axes
}

/// The rows of an axis, by index.
pub fn rows_of(rows: &[ClampedRow], axis: usize) -> Vec<usize> {
    (0..rows.len()).filter(|&row| rows[row].axis == axis).collect()
}

/// The columns of the axes' compliances: the torque of each [`loaded`] axis (Nm).
pub fn torques(rows: &[ClampedRow]) -> DMatrix<f64> {
    let axes = loaded(rows);
    DMatrix::from_fn(rows.len(), axes.len(), |row, k| if rows[row].axis == axes[k] { rows[row].torque } else { 0.0 })
}
