//! Numbers of which a fit says no more than was declared.
//!
//! A number is held against the noise of the readings before it is fitted for good
//! ([`lost`](super::prepare::Prepared::lost)), but that noise is not all that a number may be
//! off by: what the model lacks is common to the rows of a pose, and where a joint hardly shows
//! it makes up a compliance thousands of times the declared one. So each is held once more against
//! the standard deviation that is told of it. And a number that is clipped at zero is told to be
//! zero only where the readings do not fit the declared one as well.

use nalgebra::DMatrix;

use super::is_at_bound;
use super::normal::{Fit, Sign};
use super::prepare::{DECLARED_STANDS_OUT, IDENTIFIED_STANDS_OUT};
use super::problem::Problem;
use super::scale::FARTHEST;
use super::uncertainty::covariance;

/// A number that is further off what was declared than any maker is must be so by this many
/// standard deviations: those are of what poses disagree in, and what the model lacks they agree
/// in, too.
const FAR_STANDS_OUT: f64 = 10.0;

/// With this much more of chi-square, the square of two standard deviations, the readings tell
/// zero from what was declared.
const TOLD_APART: f64 = 4.0;

/// The place in a fit of the number that the readings tell the least of, if they do not tell it
/// from what was declared: its standard deviation hides it, or zero fits, which it is clipped at,
/// and the declared value as well. `declared` is that value of those that may be held at it, by
/// place, `spread` the fit's covariance, `noise` as in [`covariance`]. One at a time, for of two
/// that look alike either may be told without the other.
pub fn untold(
    problem: &Problem,
    fit: &Fit,
    signs: &[Sign],
    declared: &[Option<f64>],
    spread: &DMatrix<f64>,
    noise: Option<f64>,
) -> Option<usize> {
    let candidates = || declared.iter().enumerate().filter_map(|(k, declared)| declared.map(|declared| (k, declared)));
    let is_clipped = |&(k, declared): &(usize, f64)| is_at_bound(signs[k], declared, fit.coefficients[k]);
    let hidden = candidates().filter(|one| !is_clipped(one)).filter_map(|(k, declared)| {
        let std = spread[(k, k)].sqrt();
        let (before, after) = (declared.abs() / std, fit.coefficients[k].abs() / std);
        let is_far = declared != 0.0 && fit.coefficients[k].abs() > FARTHEST * declared.abs();
        let enough = if is_far { FAR_STANDS_OUT } else { IDENTIFIED_STANDS_OUT };
        (before < DECLARED_STANDS_OUT && after < enough).then_some((before, k))
    });
    if let Some((_, k)) = hidden.min_by(|a, b| a.0.total_cmp(&b.0)) {
        return Some(k);
    }
    candidates().any(|one| is_clipped(&one)).then_some(())?;
    // Where they may be negative: what clipping leaves of the readings is no noise.
    let free = std::vec![Sign::Free; signs.len()];
    let unclipped = problem.total.solve_signed(&fit.columns, &free)?;
    let spread = covariance(problem, &unclipped, &free, noise);
    let alike = candidates().filter(is_clipped).filter_map(|(k, declared)| {
        let (from_declared, from_zero) = (declared - unclipped.coefficients[k], unclipped.coefficients[k]);
        let more = (from_declared * from_declared - from_zero * from_zero) / spread[(k, k)];
        (more < TOLD_APART).then_some((more, k))
    });
    alike.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
}
