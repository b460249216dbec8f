//! Compliances from displacements at the tool, beside the effects that the description declares.

use std::format;
use std::string::String;

use super::fitted::identification;
use super::{Error, Identification, NoiseSource, less_than_rigid};
use crate::campaign::{Campaign, Data, Displacements, Observation as Row, told_length};
use crate::fit::case::Case;
use crate::fit::noise::known;
use crate::fit::own::Alone;
use crate::noise::Covariance;
use crate::noise::straight::straightened;
use crate::words::{count, micrometres};

/// What is said of readings whose noise hides every number.
const SCATTERS: &str = "the readings scatter by more than the loads do to any joint";

/// With fewer readings for each number than this, scatter says nothing of the instrument, nor of how sure
/// a number is.
const READINGS_A_NUMBER: usize = 2;

/// Identifies the numbers of a description.
///
/// # Errors
/// Displacements that show none of them, that go against the loads, or are too few to say how sure the
/// numbers are; numbers that no description takes.
pub fn identify(campaign: &Campaign, data: &Displacements) -> Result<Identification, Error> {
    something_was_read(data)?;
    let mut case = Case::new(campaign, &campaign.robot);
    case.noise = case.noise.filter(|_| !is_far_below(campaign, data));
    let alone = Alone::fitted(&case, &campaign.robot, 0.0).ok_or(Error::NotFinite)?;
    enough((campaign, data), &case, &alone)?;
    if alone.is_against_the_loads() {
        return Err(less_than_rigid());
    }
    if alone.seen().is_empty() {
        return Err(Error::NotShown(match case.noise.and(campaign.noise_of_reading()) {
            _ if !alone.moves_any() => String::from("these poses and loads show none of the robot's compliances"),
            Some(noise) => {
                format!("the noise of {} that the campaign declares hides all that the loads do", told_length(noise))
            }
            None => String::from(SCATTERS),
        }));
    }
    identification(campaign, (&case, &alone), data.poses.len())
}

/// Refuses displacements that are all zero: by them the arm is rigid, and no sign is wrong; and loads that are.
fn something_was_read(data: &Displacements) -> Result<(), Error> {
    let is_zero = |row: &Row| {
        let rotation = row.rotation.unwrap_or_default();
        row.encoders.is_none() && row.displacement.iter().chain(&rotation).all(|&reading| reading == 0.0)
    };
    if data.rows.iter().all(is_zero) {
        return Err(Error::NotShown(String::from(
            "every displacement is zero: nothing was read of how the arm gives way",
        )));
    }
    if data.rows.iter().all(|row| row.wrench.iter().all(|&load| load == 0.0)) {
        return Err(Error::NotShown(String::from("every force and moment is zero: nothing pushes the arm")));
    }
    Ok(())
}

/// Whether the readings show far less noise than is declared.
fn is_far_below(campaign: &Campaign, data: &Displacements) -> bool {
    let Some(declared) = campaign.noise.displacement.filter(|_| data.is_whole()) else { return false };
    let samples = straightened(&campaign.robot, data);
    Covariance::estimate(&samples, data.measured_frame, campaign.noise, |_| true).is_far_below(declared)
}

/// Refuses what has neither a noise that is known nor the readings to tell one by: a number would have no
/// uncertainty, or one made of chance.
fn enough((campaign, data): (&Campaign, &Displacements), case: &Case<'_>, alone: &Alone<'_>) -> Result<(), Error> {
    let readings = case.observation.readings();
    let fitted = case.rows(true).len() * (readings.width - case.encoders.len());
    if known(campaign, case, &alone.solved.left).is_some() || fitted >= READINGS_A_NUMBER * alone.moving() {
        return Ok(());
    }
    Err(Error::NotShown(format!(
        "{} at {} cannot tell the {} of the robot from each other: load the arm at more poses",
        count(data.rows.len(), "row"),
        count(data.poses.len(), "pose"),
        count(alone.own.len(), "compliance")
    )))
}

/// That the noise which a campaign of displacements declares is not used, in a sentence, where the noise that is
/// reported (m) is known from elsewhere: the readings show far less.
pub fn noise_not_used(campaign: &Campaign, (noise, source): (f64, NoiseSource)) -> Option<String> {
    let declared = campaign.noise.displacement?;
    let is_used = source.is_declared() || !matches!(campaign.data, Data::Displacement(_));
    (!is_used).then(|| {
        format!(
            "The declared noise of {} is not used: the readings show {}.",
            micrometres(declared),
            micrometres(noise)
        )
    })
}
