//! Why data show none of a description's numbers, where they do not.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::baseline::{Visibility, visibility};
use super::prepare::{IDENTIFIED_STANDS_OUT, Prepared};
use super::problem::Problem;
use super::{Error, NoiseSource, less_than_rigid};
use crate::campaign::told_length;
use crate::words::count;

/// What is said of readings whose noise hides every number.
pub const SCATTERS: &str = "the readings scatter by more than the loads do to any joint";

/// With fewer readings for each number than this, scatter says nothing of the instrument,
/// nor of how sure a number is.
const READINGS_A_NUMBER: usize = 2;

/// A number below zero by more standard deviations is so by no noise.
const BELOW_ZERO: f64 = 5.0;

/// Refuses what has neither a declared noise nor the readings to tell one by: a number would
/// have no uncertainty, or one made of chance.
///
/// # Errors
/// Fewer than two readings for each number that they show.
pub fn enough(prepared: &Prepared<'_>, problem: &Problem) -> Result<(), Error> {
    let shown = visibility(&problem.total, prepared.own.len());
    let numbers = shown.iter().filter(|visibility| **visibility != Visibility::Unseen).count();
    let is_known = prepared.noise(0.0).1 != NoiseSource::Residuals;
    if is_known || problem.total.rows >= READINGS_A_NUMBER * numbers { Ok(()) } else { Err(cannot_tell(prepared)) }
}

/// What rows cannot tell that are too few.
fn cannot_tell(prepared: &Prepared<'_>) -> Error {
    Error::NotShown(format!(
        "{} at {} cannot tell the {} of the robot from each other: load the arm at more poses",
        count(prepared.data.rows.len(), "row"),
        count(prepared.samples.poses, "pose"),
        count(prepared.own.len(), "compliance")
    ))
}

/// Whether the readings go against the loads of a description that is rigid: clipped at zero its
/// joints have nothing that could stand out from the noise.
fn is_less_than_rigid(prepared: &Prepared<'_>, problem: &Problem) -> bool {
    let shown = visibility(&problem.total, prepared.own.len());
    let columns: Vec<usize> = (0..shown.len()).filter(|&column| shown[column] == Visibility::Seen).collect();
    let solved = problem.total.solve(&columns).zip(problem.total.inverse(&columns));
    let Some((free, inverse)) = solved.filter(|_| !columns.is_empty()) else { return false };
    let (noise, _) = prepared.noise(problem.variance(&free));
    let over_std = |k: usize| free.coefficients[k] / (inverse[(k, k)].sqrt() * noise);
    let mut all = (0..columns.len()).map(over_std);
    all.clone().all(|value| value < IDENTIFIED_STANDS_OUT) && all.any(|value| value < -BELOW_ZERO)
}

/// Why the data show none of the numbers: of geometry, of the noise, or of readings against the
/// loads.
pub fn nothing_shows(prepared: &Prepared<'_>, problem: &Problem) -> Error {
    if prepared.data.rows.iter().all(|row| row.wrench.iter().all(|&load| load == 0.0)) {
        return Error::NotShown(String::from("every force and moment is zero: nothing pushes the arm"));
    }
    if is_less_than_rigid(prepared, problem) {
        return less_than_rigid();
    }
    let numbers = prepared.own.len();
    // By the geometry, before anything is held against the noise.
    let shown = visibility(&problem.total, numbers);
    let is_seen = shown.contains(&Visibility::Seen);
    let is_confounded = shown.iter().any(|visibility| matches!(visibility, Visibility::Confounded(_)));
    let too_few = prepared.declared_noise.is_none() && problem.total.rows < READINGS_A_NUMBER * numbers;
    Error::NotShown(match prepared.declared_noise.filter(|_| is_seen) {
        Some(noise) => {
            format!("the noise of {} that the campaign declares hides all that the loads do", told_length(noise))
        }
        None if (is_seen && too_few) || (!is_seen && is_confounded) => return cannot_tell(prepared),
        None if is_seen => String::from(SCATTERS),
        None => String::from("these poses and loads show none of the robot's compliances"),
    })
}
