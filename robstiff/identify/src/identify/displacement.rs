//! Compliances from displacements at the tool: generalised least squares over
//! all poses, with compliances that are not negative.

use nalgebra::{DMatrix, DVector};
use std::string::String;
use std::vec::Vec;

use super::baseline::with_values;
use super::normal::Fit;
use super::not_shown::{SCATTERS, enough};
use super::prepare::{Prepared, fit};
use super::problem::{Problem, rms};
use super::readable::readable;
use super::uncertainty::{correlation, covariance, of_held};
use super::untold::untold;
use super::{Error, Identification, estimates};
use crate::campaign::{Campaign, Data, Observation};

/// Identifies the numbers of a description.
///
/// # Errors
/// A campaign that sees none of them, has too few rows to say how sure they are, or asks
/// for numbers that no description takes.
pub fn identify(campaign: &Campaign) -> Result<Identification, Error> {
    nothing_was_read(campaign)?;
    let mut prepared = Prepared::without_wild(campaign)?;
    let mut problem = prepared.problem();
    enough(&prepared, &problem)?;
    let mut fitted = fit(&prepared, &problem)?;
    // The description is the final model here: once more with axes weighed by what
    // it leaves, where there was nothing better to weigh them by.
    let refined = prepared.covariance.refined(&problem, &fitted);
    if refined.basis != prepared.covariance.basis {
        prepared.covariance = refined;
        problem = prepared.problem();
        fitted = fit(&prepared, &problem)?;
    }
    let (fitted, covariance) = told(campaign, &mut prepared, &mut problem, fitted)?;
    let values = prepared.with(&fitted);
    let estimates =
        estimates(&campaign.robot, (&prepared.own, &prepared.visibility), &values, &fitted.columns, &covariance);
    let residuals = residuals(&prepared, &fitted);
    let (noise, noise_source) = prepared.noise(problem.variance(&fitted));
    let rows = prepared.samples.rows.len();
    let (left_out, kept): (Vec<usize>, Vec<usize>) = (0..rows).partition(|&row| prepared.left_out[row]);
    Ok(Identification {
        description: with_values(&campaign.robot, &values),
        correlation: among_all(&correlation(&covariance), &fitted.columns, estimates.len()),
        estimates,
        rows,
        poses: prepared.samples.poses,
        noise: Some((noise, noise_source)),
        covariance: Some(prepared.covariance.clone()),
        left_out: left_out.iter().map(|&row| prepared.data.rows[row].line).collect(),
        rms_declared: Some(declared_rms(&prepared, kept.iter().copied())),
        rms: Some(rms(&residuals, prepared.samples.axes, kept)),
    })
}

/// Refuses displacements that are all zero: by them the arm is rigid, and no sign is wrong.
fn nothing_was_read(campaign: &Campaign) -> Result<(), Error> {
    let Data::Displacement(data) = &campaign.data else { return Ok(()) };
    let is_zero = |row: &Observation| {
        let rotation = row.rotation.unwrap_or_default();
        row.encoders.is_none() && row.displacement.iter().chain(&rotation).all(|&reading| reading == 0.0)
    };
    if data.rows.iter().all(is_zero) {
        return Err(Error::NotShown(String::from(
            "every displacement is zero: nothing was read of how the arm gives way",
        )));
    }
    Ok(())
}

/// The fit that is reported, of numbers that a description takes, with its covariance. What it tells
/// no more of than was declared is held at that, and the rest fitted beside it.
fn told(
    campaign: &Campaign,
    prepared: &mut Prepared<'_>,
    problem: &mut Problem,
    mut fitted: Fit,
) -> Result<(Fit, DMatrix<f64>), Error> {
    let noise = prepared.declared_noise;
    loop {
        let signs: Vec<_> = fitted.columns.iter().map(|&i| prepared.own[i].sign).collect();
        let described = |fit: &Fit| {
            let description = with_values(&campaign.robot, &prepared.with(fit));
            let own = |effect: usize| {
                let is_own = |k: &usize| prepared.own[fit.columns[*k]].effect == Some(effect);
                (0..fit.columns.len()).filter(is_own).collect()
            };
            let places = (0..description.effects.len()).map(own).collect();
            (description, places)
        };
        fitted = readable(&problem.total, &fitted, &signs, described).ok_or(Error::NoDescription)?;
        let covariance = covariance(problem, &fitted, &signs, noise)
            + of_held(problem, &fitted, &signs, &prepared.held(&fitted), noise);
        let declared: Vec<_> = fitted.columns.iter().map(|&i| Some(prepared.own[i].value)).collect();
        // Readings against the loads are refused as such, not held as if they told nothing.
        let against = prepared.is_against_the_loads(&fitted);
        let untold = untold(problem, &fitted, &signs, &declared, &covariance, noise).filter(|_| !against);
        let Some(place) = untold else { return Ok((fitted, covariance)) };
        prepared.hold(fitted.columns[place]);
        if prepared.seen().is_empty() {
            return Err(Error::NotShown(String::from(SCATTERS)));
        }
        *problem = prepared.problem();
        fitted = fit(prepared, problem)?;
    }
}

/// What a fit of the description's numbers leaves of the readings, stacked;
/// (m, rad).
fn residuals(prepared: &Prepared<'_>, fit: &Fit) -> DVector<f64> {
    let mut left = prepared.readings(&prepared.samples);
    for (&number, &value) in fit.columns.iter().zip(fit.coefficients.iter()) {
        left.axpy(-value, &prepared.samples.column(prepared.own[number].column), 1.0);
    }
    left
}

/// The rms of the readings against the description as declared (m).
pub fn declared_rms(prepared: &Prepared<'_>, rows: impl IntoIterator<Item = usize>) -> f64 {
    rms(&declared_residuals(prepared), prepared.samples.axes, rows)
}

/// What the description as declared leaves of the readings, stacked; (m, rad).
pub fn declared_residuals(prepared: &Prepared<'_>) -> DVector<f64> {
    let seen = prepared.seen();
    let coefficients = DVector::from_fn(seen.len(), |k, _| prepared.own[seen[k]].value);
    residuals(prepared, &Fit { columns: seen, coefficients, rss: f64::NAN })
}

/// A matrix of some columns among all; the identity elsewhere.
pub fn among_all(part: &DMatrix<f64>, columns: &[usize], count: usize) -> DMatrix<f64> {
    let mut whole = DMatrix::identity(count, count);
    for (i, &a) in columns.iter().enumerate() {
        for (j, &b) in columns.iter().enumerate() {
            whole[(a, b)] = part[(i, j)];
        }
    }
    whole
}
