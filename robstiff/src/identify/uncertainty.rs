//! How sure coefficients are: the delete-one-pose jackknife.
//!
//! What a model lacks is common to the rows of a pose, so a standard deviation
//! from the residuals of single rows would be too small. Fitting again without
//! each pose in turn asks the poses themselves: with `P` poses the covariance
//! is `(P - 1) / P sum (b_p - b)(b_p - b)^T` with the mean `b` of the `b_p`
//! (Efron and Stein, Annals of Statistics 9, 1981); it is the cluster-robust
//! covariance, slightly on the safe side.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::normal::{Fit, Sign};
use super::problem::Problem;

/// With fewer poses than this for each coefficient the jackknife has no basis;
/// the residual variance then has to do.
const POSES_PER_COEFFICIENT: usize = 2;

/// The covariance of a fit's coefficients; `signs` are those of its columns.
pub fn covariance(problem: &Problem, fit: &Fit, signs: &[Sign]) -> DMatrix<f64> {
    let poses = problem.blocks.len();
    let without: Vec<DVector<f64>> =
        problem.blocks.iter().filter_map(|block| problem.solve_without(block, &fit.columns, Some(signs))).collect();
    if poses < POSES_PER_COEFFICIENT * fit.columns.len() || without.len() < poses {
        let inverse = problem.total.inverse(&fit.columns);
        let none = || DMatrix::zeros(signs.len(), signs.len());
        return inverse.map_or_else(none, |inverse| inverse * (fit.rss / problem.freedom(fit)));
    }
    let mean = without.iter().sum::<DVector<f64>>() / poses as f64;
    let spread = without.iter().map(|b| (b - &mean) * (b - &mean).transpose());
    spread.sum::<DMatrix<f64>>() * ((poses - 1) as f64 / poses as f64)
}

/// The correlations in a covariance; zero with a coefficient that does not
/// vary.
pub fn correlation(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let std = covariance.diagonal().map(f64::sqrt);
    DMatrix::from_fn(std.len(), std.len(), |i, j| {
        let scale = std[i] * std[j];
        if scale > 0.0 { covariance[(i, j)] / scale } else { f64::from(u8::from(i == j)) }
    })
}
