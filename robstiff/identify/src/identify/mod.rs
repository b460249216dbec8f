//! Identification: the compliances of a description from a campaign, with
//! their uncertainty.
//!
//! It is the fit of `fit/own.rs`, put together by `fitted`: `displacement`, `positions` and `clamped` refuse what
//! each kind of campaign does not show; `scale` and `misread` say what looks like a mistake in files.

pub(crate) mod clamped;
#[cfg(test)]
mod coverage_tests;
pub(crate) mod displacement;
pub(crate) mod fitted;
#[cfg(test)]
mod held_tests;
pub(crate) mod misread;
pub(crate) mod positions;
pub(crate) mod scale;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod told_tests;

use core::fmt;
use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::DMatrix;
use robstiff_robots::Description;

pub use crate::fit::estimate::{Estimate, NOTEWORTHY_DEVIATION, Visibility};
pub use crate::fit::noise::NoiseSource;
pub use clamped::without_laws;
pub use displacement::noise_not_used;
pub use fitted::Scatter;
pub use misread::{Misread, misread};
pub use scale::{ALL_JOINTS, off_by_one_factor};

use crate::campaign::{Campaign, Data};

/// Why a campaign does not give what was asked of it, in words for people.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// A campaign, or options, that are none: what [`Campaign::check`] or
    /// [`Options::check`](crate::campaign::Campaign::check) find.
    Invalid(String),
    /// Another kind of campaign is needed, or one of another robot.
    OtherCampaign(String),
    /// The data do not show the numbers, or do not tell them from each other.
    NotShown(String),
    /// By the readings, the robot would be less than rigid: they, or the loads, have a
    /// wrong sign, unit or frame.
    AgainstTheLoads(String),
    /// All joints are off from what is declared by one factor between units: of loads, of readings
    /// or of the description.
    OtherUnit(String),
    /// No description takes the numbers found beside the effects that it declares.
    NoDescription,
    /// An error is not finite: the numbers are too large.
    NotFinite,
    /// A plan cannot have what was asked of it.
    NoPlan(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Invalid(why)
            | Self::OtherCampaign(why)
            | Self::NotShown(why)
            | Self::AgainstTheLoads(why)
            | Self::OtherUnit(why)
            | Self::NoPlan(why) => why,
            Self::NoDescription => {
                "the description's own effects leave a joint without compliance, or couple joints too strongly, with \
                 the compliances that these data ask for; without these effects they could be identified"
            }
            Self::NotFinite => "the numbers are too large: the error is not finite",
        })
    }
}

impl core::error::Error for Error {}

/// A description from measurements.
#[derive(Clone, Debug)]
pub struct Identification {
    /// The description with what was identified.
    pub description: Description,
    /// The joints' compliances in order, then the numbers of the description's
    /// effects.
    pub estimates: Vec<Estimate>,
    /// The correlations of the estimates; those not seen have none.
    pub correlation: DMatrix<f64>,
    /// The number of rows.
    pub rows: usize,
    /// The number of poses; 0 for clamped axes.
    pub poses: usize,
    /// The noise of one displacement reading (m), and where it is from.
    pub noise: Option<(f64, NoiseSource)>,
    /// How the readings scatter; of displacements.
    pub scatter: Option<Scatter>,
    /// The lines of rows that do not belong to the others and have no part in the fit.
    pub left_out: Vec<usize>,
    /// The error of the description as declared (m): rms over rows, without those left
    /// out, of the displacement residual's length over `sqrt(3)`.
    pub rms_declared: Option<f64>,
    /// The same of the description as identified (m).
    pub rms: Option<f64>,
}

/// What is said of readings by which every joint that they show would be less than
/// rigid: they are of something else, or of the wrong sign.
pub const AGAINST_THE_LOADS: &str = "the readings do not follow the loads";

/// Identifies the compliances of a campaign's robot.
///
/// # Errors
/// What [`Campaign::check`] finds; a campaign that shows none of them, or deflections and
/// readings against their loads, or in another unit.
pub fn identify(campaign: &Campaign) -> Result<Identification, Error> {
    campaign.check().map_err(Error::Invalid)?;
    let found = match &campaign.data {
        Data::Displacement(data) => displacement::identify(campaign, data),
        Data::Position(data) => positions::identify(campaign, data),
        Data::Clamped(rows) => clamped::identify(campaign, rows),
    }?;
    let joints = &found.estimates[..campaign.robot.joints.len()];
    let mut seen = joints.iter().filter(|joint| joint.visibility == Visibility::Seen).peekable();
    let is_clamped = matches!(campaign.data, Data::Clamped(_));
    if !is_clamped && seen.peek().is_some() && seen.all(|joint| joint.at_bound) {
        return Err(less_than_rigid());
    }
    match scale::other_unit(campaign, &found.estimates) {
        Some(why) => Err(Error::OtherUnit(why)),
        None => Ok(found),
    }
}

/// That by the readings every joint would be less than rigid.
pub(crate) fn less_than_rigid() -> Error {
    Error::AgainstTheLoads(format!(
        "{AGAINST_THE_LOADS}: by them every joint would be less than rigid; check the signs of loads and readings, their \
         frames and their units"
    ))
}
