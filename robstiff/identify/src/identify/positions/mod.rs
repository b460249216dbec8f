//! Absolute positions: what a description says of them, and the compliances that
//! payloads show.
//!
//! Positions are read in a frame of their own, wherever the tracker stands. Where the
//! robot stands in it is fitted with everything ([`registration`]), so what is the
//! same as another stand (the zero of a joint that the base turns with, a length
//! along its axis) cannot show. A description's numbers enter its forward model
//! ([`model`]), not a linear one; they are fitted in steps ([`regression`]).
//!
//! A compliance shows where a payload loads its joint, and with a description that
//! sags (`gravity_sag`) where links do.

pub mod model;
pub mod own;
mod prepare;
pub mod registration;
pub mod regression;
#[cfg(test)]
mod tests;
mod unit;
pub mod wild;
mod within;

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Vector3};

use self::model::State;
use self::own::{Own, with_values};
use self::prepare::standing;
use self::regression::{Regression, Rows, STANDS, Solved};
use self::wild::wild_rows;
use self::within::within_visits;
use super::displacement::among_all;
use super::problem::rms;
use super::readable::is_readable;
use super::uncertainty::{correlation, covariance};
use super::untold::untold;
use super::{Error, Estimate, Identification, NoiseSource, is_at_bound};
use crate::campaign::{Campaign, Positions};

pub use self::prepare::Prepared;

/// Positions are all but linear in compliances: a step is off by some 1e-3 of itself. As
/// often are outlying rows looked for.
const PASSES: usize = 3;

/// Identifies the compliances that payloads show: from what payloads of one visit
/// differ by, or where that does not tell, from all positions with the kinematics as
/// declared.
///
/// # Errors
/// Positions that show none, or not where the robot stands, or are in another unit; compliances
/// that no description takes beside its own effects.
pub fn identify(campaign: &Campaign, data: &Positions) -> Result<Identification, Error> {
    if let Some(why) = unit::other_unit(&campaign.robot, data) {
        return Err(Error::OtherUnit(why));
    }
    let mut prepared = Prepared::new(campaign, data)?;
    let seen = prepared.seen();
    if seen.is_empty() {
        let why = match data.rows.iter().all(|row| row.payload == 0.0) {
            true => "no row has a payload, so these positions show no compliance",
            false => "these payloads load no joint in a way that could not be another stand of the robot",
        };
        return Err(Error::NotShown(format!("{why}; `robstiff trace` asks what they show of the kinematics")));
    }
    let regression = prepared.regression([]);
    // A row that is off by metres hides others: they are looked for again without it.
    let (every, mut wild) = (prepared.rows.clone(), Vec::new());
    for _ in 0..PASSES {
        let Some(fitted) = regression.solve(&seen, &prepared.state(prepared.own.len()), &prepared.rows) else { break };
        let (whole, _) = regression.at(&fitted.state, &seen, &every);
        // The table may be off: rows must stand out from that, too.
        let mut found = wild_rows(&whole, false).unwrap_or_default().rows;
        found.sort_unstable();
        if found == wild {
            break;
        }
        wild = found;
        prepared.leave_out(&wild, campaign)?;
    }
    let (regression, seen, state, spread) = told(&mut prepared)?;
    let values = prepared.values(&state);
    let (rows, left) = (data.rows.len(), residuals(&regression, &state));
    let noise = match campaign.noise_of_reading() {
        Some(noise) => (noise, NoiseSource::of_declared(campaign)),
        None => {
            // By what the robot misses a pose is in it, whatever compliances are found by.
            let fitted: Vec<usize> = (0..rows).filter(|&row| prepared.rows.has(row, data)).collect();
            let readings = 3.0 * fitted.len() as f64;
            let freedom = (readings - (STANDS + seen.len()) as f64).max(1.0);
            (rms(&left, 3, fitted) * (readings / freedom).sqrt(), NoiseSource::Residuals)
        }
    };
    let estimates = estimated(&prepared, &values, &spread);
    let description = with_values(&campaign.robot, &prepared.own, &values);
    if !is_readable(&description) {
        return Err(Error::NoDescription);
    }
    let kept = (0..rows).filter(|&row| !prepared.rows.left_out[row]);
    let left_out: Vec<usize> = wild.iter().map(|&row| data.rows[row].line).collect();
    Ok(Identification {
        description,
        correlation: among_all(&correlation(&spread), &seen, estimates.len()),
        estimates,
        rows,
        poses: data.poses.len(),
        noise: Some(noise),
        covariance: None,
        left_out,
        rms_declared: Some(rms(&prepared.declared_residuals(campaign), 3, kept.clone())),
        rms: Some(rms(&left, 3, kept)),
    })
}

/// The numbers that are reported, by index, their regression, values and covariance. What positions
/// tell no more of than was declared is held at that, and the rest fitted beside it.
fn told<'c>(prepared: &mut Prepared<'c>) -> Result<(Regression<'c>, Vec<usize>, State, DMatrix<f64>), Error> {
    loop {
        let (regression, seen) = (prepared.regression([]), prepared.seen());
        let start = prepared.state(prepared.own.len());
        let solved = match by_payloads(&regression, &start, &seen, &prepared.rows)? {
            Some(solved) => solved,
            None => regression.solve(&seen, &start, &prepared.rows).ok_or_else(confounded)?,
        };
        let Solved { state, problem, fit, signs } = solved;
        let spread = covariance(&problem, &fit, &signs, None);
        let stands = fit.columns.len() - seen.len();
        let mut declared = std::vec![None; stands];
        declared.extend(seen.iter().map(|&k| Some(prepared.own[k].value)));
        // Positions against the payloads are refused as such, not held as if they told nothing.
        let is_clipped = |&k: &usize| is_at_bound(prepared.own[k].sign, prepared.own[k].value, state.values[k]);
        let against = seen.iter().all(is_clipped);
        let place = untold(&problem, &fit, &signs, &declared, &spread, None).filter(|_| !against);
        let Some(place) = place else {
            let numbers = spread.view((stands, stands), (seen.len(), seen.len())).into_owned();
            return Ok((regression, seen, state, numbers));
        };
        if seen.len() == 1 {
            return Err(Error::NotShown(String::from(
                "the positions scatter by more than the payloads do to any joint",
            )));
        }
        prepared.hold(seen[place - stands]);
    }
}

/// The own numbers by what payloads of one visit differ by; `None` where that does not tell
/// them from each other.
fn by_payloads(
    regression: &Regression<'_>,
    start: &State,
    seen: &[usize],
    rows: &Rows,
) -> Result<Option<Solved>, Error> {
    let data = regression.data;
    let (signs, columns) = (&regression.signs_of(seen)[STANDS..], Vec::from_iter(0..seen.len()));
    let mut state = start.clone();
    let mut pass = 1;
    loop {
        let (problem, _) = regression.at(&state, seen, rows);
        let Some(within) = within_visits(&problem, data) else { return Ok(None) };
        let fit = within.total.solve_signed(&columns, signs).ok_or_else(confounded)?;
        seen.iter().zip(fit.coefficients.iter()).for_each(|(&k, &value)| state.values[k] = value);
        if pass == PASSES {
            let model = state.model(&regression.start, &regression.numbers);
            state.registration = standing(&model, data, |row| rows.has(row, data))?;
            return Ok(Some(Solved { state, problem: within, fit, signs: signs.to_vec() }));
        }
        pass += 1;
    }
}

fn confounded() -> Error {
    Error::NotShown(String::from("these positions do not tell the compliances from each other"))
}

/// What a state leaves of the readings, stacked (m).
pub fn residuals(regression: &Regression<'_>, state: &State) -> DVector<f64> {
    let points = state.model(&regression.start, &regression.numbers).points(regression.data);
    let left = regression.data.rows.iter().enumerate().flat_map(|(row, read)| {
        let point = points[row] + state.beside(&regression.numbers, row);
        let left = Vector3::from(read.position) - state.registration.placed(&point);
        [left.x, left.y, left.z]
    });
    DVector::from_vec(left.collect())
}

/// The estimates of a description's numbers after a fit; `spread` is the covariance of
/// those that are seen.
pub fn estimated(prepared: &Prepared<'_>, values: &[f64], spread: &DMatrix<f64>) -> Vec<Estimate> {
    let seen = prepared.seen();
    let one = |(k, own): (usize, &Own)| {
        let fitted = seen.iter().position(|&number| number == k).map(|at| spread[(at, at)]);
        Estimate::new((own.name.clone(), own.unit), (own.value, own.sign), values[k], fitted, &prepared.visibility[k])
    };
    prepared.own.iter().enumerate().map(one).collect()
}
