//! Rows of clamped axes as a regression: every row is a block of its own, and the rows
//! of an axis share their unloaded reading.

use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use crate::campaign::ClampedRow;
use crate::identify::normal::Normal;
use crate::identify::problem::{Block, Equations, Problem};
use crate::identify::whitening::ByVisit;

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

/// The whitening of rows, of which those of an axis share their unloaded reading.
pub fn by_axis(rows: &[ClampedRow]) -> ByVisit {
    let axes: Vec<usize> = rows.iter().map(|row| row.axis - 1).collect();
    ByVisit::new(&axes, 1.0)
}

/// The normal equations of whitened columns. Most of them move one axis, and products of what
/// moves different ones are zero.
fn normal(rows: &[ClampedRow], white: &DMatrix<f64>, readings: &DVector<f64>) -> Normal {
    let mut gram = DMatrix::zeros(white.ncols(), white.ncols());
    for axis in axes_of(rows.iter()) {
        let of_axis = rows_of(rows, axis);
        let moves = |&column: &usize| of_axis.iter().any(|&row| white[(row, column)] != 0.0);
        let columns: Vec<usize> = (0..white.ncols()).filter(moves).collect();
        let part = DMatrix::from_fn(of_axis.len(), columns.len(), |i, j| white[(of_axis[i], columns[j])]);
        let products = part.tr_mul(&part);
        for (j, &second) in columns.iter().enumerate() {
            columns.iter().enumerate().for_each(|(i, &first)| gram[(first, second)] += products[(i, j)]);
        }
    }
    Normal { gram, moment: white.tr_mul(readings), energy: readings.norm_squared(), rows: rows.len() }
}

/// The regression of the deflections (rad) on some columns.
pub fn problem(rows: &[ClampedRow], raw: DMatrix<f64>) -> Problem {
    let count = raw.ncols();
    let readings = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.deflection));
    let mut white = raw.insert_column(count, 0.0);
    white.set_column(count, &readings);
    by_axis(rows).whiten(&mut white, 0, 1);
    let white_readings = white.column(count).into_owned();
    let white = white.remove_column(count);
    let blocks = (0..rows.len()).map(|row| Block { pose: row, rows: vec![row], stacked: vec![row] }).collect();
    let equations = Equations {
        axes: 1,
        shared: 1.0,
        blocks,
        total: normal(rows, &white, &white_readings),
        readings: Rc::new(readings),
        white_readings: Rc::new(white_readings),
    };
    Problem { equations, white }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether columns move one axis or all.
    #[test]
    fn products_are_those_of_all_columns() {
        let row = |k: usize| ClampedRow { line: k + 2, axis: [3, 1, 3][k % 3], torque: 1.0, deflection: 0.5 };
        let rows: Vec<ClampedRow> = (0..9).map(row).collect();
        let raw = DMatrix::from_fn(9, 4, |i, j| match j {
            0 | 1 if rows[i].axis != [1, 3][j] => 0.0,
            _ => ((3 * i + 5 * j) as f64).sin(),
        });
        let problem = problem(&rows, raw);
        let all = problem.white.tr_mul(&problem.white);
        assert!((&problem.total.gram - &all).amax() < 1e-12, "{}", problem.total.gram);
    }
}
