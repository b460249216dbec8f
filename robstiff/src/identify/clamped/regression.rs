//! Rows of clamped axes as a regression: every row is a block of its own, and the rows
//! of an axis share their unloaded reading.

use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use crate::campaign::ClampedRow;
use crate::identify::normal::Normal;
use crate::identify::problem::{Block, Equations, Problem};
use crate::identify::whitening::whiten;

/// The axes (from 1) that are loaded, in order.
pub fn loaded(rows: &[ClampedRow]) -> Vec<usize> {
    let mut axes: Vec<usize> = rows.iter().filter(|row| row.torque != 0.0).map(|row| row.axis).collect();
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

/// The regression of the deflections (rad) on some columns.
pub fn problem(rows: &[ClampedRow], raw: DMatrix<f64>) -> Problem {
    let count = raw.ncols();
    let readings = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.deflection));
    let mut white = raw.insert_column(count, 0.0);
    white.set_column(count, &readings);
    let visits: Vec<usize> = rows.iter().map(|row| row.axis - 1).collect();
    whiten(&mut white, &visits, 1, 1.0);
    let white_readings = white.column(count).into_owned();
    let white = white.remove_column(count);
    let blocks = (0..rows.len()).map(|row| Block { pose: row, rows: vec![row], stacked: vec![row] }).collect();
    let equations = Equations {
        axes: 1,
        shared: 1.0,
        blocks,
        held_out: Rc::new([]),
        total: Normal::new(&white, &white_readings),
        readings: Rc::new(readings),
        white_readings: Rc::new(white_readings),
    };
    Problem { equations, white }
}
