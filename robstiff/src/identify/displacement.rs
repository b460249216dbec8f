//! Compliances from displacements at the tool: generalised least squares over
//! all poses, with compliances that are not negative.

use nalgebra::{DMatrix, DVector};
use std::vec::Vec;

use super::baseline::with_values;
use super::prepare::{Prepared, fit};
use super::problem::{Problem, rms};
use super::uncertainty::{correlation, covariance};
use super::{Error, Identification, estimates};
use crate::campaign::Campaign;

/// Identifies the numbers of a description.
///
/// # Errors
/// A campaign that sees none of them.
pub fn identify(campaign: &Campaign) -> Result<Identification, Error> {
    let mut prepared = Prepared::new(campaign)?;
    let mut problem = prepared.problem(&[]);
    let mut fitted = fit(&prepared, &problem)?;
    // The description is the final model here: once more with axes weighed by what
    // it leaves, where there was nothing better to weigh them by.
    let refined = prepared.covariance.refined(&problem, &fitted);
    if refined.basis != prepared.covariance.basis {
        prepared.covariance = refined;
        problem = prepared.problem(&[]);
        fitted = fit(&prepared, &problem)?;
    }
    let signs: Vec<_> = fitted.columns.iter().map(|&i| prepared.own[i].sign).collect();
    let covariance = covariance(&problem, &fitted, &signs);
    let mut values = prepared.values.clone();
    for (&column, &value) in fitted.columns.iter().zip(fitted.coefficients.iter()) {
        values[column] = value;
    }
    let estimates = estimates(&campaign.robot, &prepared, &values, &fitted.columns, &covariance);
    let residuals = problem.residuals(&fitted.columns, &fitted.coefficients);
    let freedom = problem.total.rows.saturating_sub(fitted.columns.len()).max(1) as f64;
    let (noise, noise_source) = prepared.noise(fitted.rss / freedom);
    let rows = prepared.samples.rows.len();
    Ok(Identification {
        description: with_values(&campaign.robot, &values),
        correlation: spread(&correlation(&covariance), &fitted.columns, estimates.len()),
        estimates,
        rows,
        poses: prepared.samples.poses,
        noise: Some((noise, noise_source)),
        covariance: Some(prepared.covariance.clone()),
        rms_declared: Some(declared_rms(&prepared, &problem, 0..rows)),
        rms: Some(rms(&residuals, problem.axes, 0..rows)),
    })
}

/// The rms of the readings against the description as declared (m).
pub fn declared_rms(prepared: &Prepared<'_>, problem: &Problem, rows: impl IntoIterator<Item = usize>) -> f64 {
    rms(&declared_residuals(prepared, problem), problem.axes, rows)
}

/// What the description as declared leaves of the readings, stacked; (m, rad).
pub fn declared_residuals(prepared: &Prepared<'_>, problem: &Problem) -> DVector<f64> {
    let seen = prepared.seen();
    let values = DVector::from_fn(seen.len(), |k, _| prepared.own[seen[k]].value);
    problem.residuals(&seen, &values)
}

/// A matrix of some columns among all; the identity elsewhere.
fn spread(part: &DMatrix<f64>, columns: &[usize], count: usize) -> DMatrix<f64> {
    let mut whole = DMatrix::identity(count, count);
    for (i, &a) in columns.iter().enumerate() {
        for (j, &b) in columns.iter().enumerate() {
            whole[(a, b)] = part[(i, j)];
        }
    }
    whole
}
