//! How sure the numbers of a model of clamped axes are.
//!
//! Axes that no effect joins are measured apart: the rows of each tell how noisy
//! they are, and how sure that is, as for a slope alone
//! ([`identify`](crate::identify::clamped)). So a standard deviation is that of
//! least squares, with the quantile of Student's distribution for what the axis's
//! own rows leave, and of no less than their [rounding](crate::identify::clamped::rounding);
//! 1.96 of it are the 95 % interval.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::bench::Bench;
use crate::identify::clamped::regression::problem;
use crate::identify::normal::{Scaled, Sign};
use crate::identify::uncertainty::{WITHIN, student};
use crate::trace::model::Fitted;

/// Step of differences in the logarithm of a number out of a grid; and how far
/// one may be off of which nothing is known, in logarithms.
const LOG_STEP: f64 = 0.02;
const ANYTHING: f64 = 2.3;

/// What a model consists of, linear where it was found.
struct Linear {
    /// The columns of its coefficients, and behind them those of the logarithms of
    /// its numbers out of grids.
    columns: Vec<DVector<f64>>,
    /// One over the variance that each is known with beforehand, 0 where nothing is.
    known: Vec<f64>,
    /// Whether physics holds it at zero.
    held: Vec<bool>,
}

/// The covariance of a model's coefficients, and behind them of the logarithms of
/// its numbers out of grids. What is held at zero has none.
pub fn spread(bench: &Bench, model: &Fitted) -> DMatrix<f64> {
    let linear = linear(bench, model);
    let whole = problem(&bench.axes.rows, DMatrix::from_columns(&linear.columns));
    let own: Vec<usize> = (0..model.fit.columns.len()).collect();
    let left = whole.white_residuals(&own, &model.fit.coefficients);
    let mut spread = DMatrix::zeros(linear.columns.len(), linear.columns.len());
    for axes in joined(bench, &linear.columns) {
        let rows: Vec<usize> = axes.iter().flat_map(|&axis| bench.axes.rows_of(axis)).collect();
        let moves = |&k: &usize| !linear.held[k] && rows.iter().any(|&row| linear.columns[k][row] != 0.0);
        let columns: Vec<usize> = (0..linear.columns.len()).filter(moves).collect();
        if columns.is_empty() {
            continue;
        }
        let freedom = rows.len().saturating_sub(columns.len()).max(1) as f64;
        let rounding = axes.iter().map(|axis| bench.axes.rounding[axis - 1]).fold(0.0, f64::max);
        let scatter = left.select_rows(&rows).norm_squared() / freedom;
        let told = (scatter * (student(freedom) / WITHIN).powi(2)).max(rounding);
        let variance = scatter.max(rounding);
        let white = DMatrix::from_fn(rows.len(), columns.len(), |i, j| whole.white[(rows[i], columns[j])]);
        let known = DVector::from_fn(columns.len(), |j, _| linear.known[columns[j]] * variance);
        let Some(factor) = Scaled::of(&(white.tr_mul(&white) + DMatrix::from_diagonal(&known))) else { continue };
        let of_group = factor.inverse() * told;
        for (i, &row) in columns.iter().enumerate() {
            columns.iter().enumerate().for_each(|(j, &column)| spread[(row, column)] = of_group[(i, j)]);
        }
    }
    spread
}

fn linear(bench: &Bench, model: &Fitted) -> Linear {
    let own = bench.columns(&model.named);
    let mut columns: Vec<DVector<f64>> = own.iter().map(|&column| bench.raw.column(column).into_owned()).collect();
    let at_zero = own.iter().zip(model.fit.coefficients.iter());
    let mut held: Vec<bool> =
        at_zero.map(|(&column, value)| bench.signs[column] == Sign::Nonnegative && *value == 0.0).collect();
    let mut known = std::vec![0.0; columns.len()];
    let mut at = bench.base;
    for &one in &model.named {
        let form = bench.form(one);
        let numbers = model.fit.coefficients.rows(at, form.numbers.len()).into_owned();
        at += form.numbers.len();
        for k in 0..form.shape.len() {
            let moved = |step: f64| -> DVector<f64> {
                let mut shape = form.values();
                shape[k] *= step.exp();
                (form.columns)(&shape).iter().zip(numbers.iter()).map(|(column, value)| column * *value).sum()
            };
            columns.push((moved(LOG_STEP) - moved(-LOG_STEP)) / (2.0 * LOG_STEP));
            known.push(form.likely.map_or(ANYTHING, |[_, spread]| spread).powi(-2));
            held.push(false);
        }
    }
    Linear { columns, known, held }
}

/// The loaded axes, those together that a column joins.
fn joined(bench: &Bench, columns: &[DVector<f64>]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = bench.axes.loaded().map(|axis| std::vec![axis]).collect();
    for column in columns {
        let moves =
            |axes: &Vec<usize>| axes.iter().flat_map(|&axis| bench.axes.rows_of(axis)).any(|row| column[row] != 0.0);
        let (together, apart): (Vec<Vec<usize>>, Vec<Vec<usize>>) = groups.into_iter().partition(moves);
        groups = apart;
        groups.push(together.concat());
    }
    groups
}
