//! Identification: the compliances of a description from a campaign, with
//! their uncertainty.
//!
//! The way of the data: `samples` brings rows to the base frame and turns
//! parameters into columns, with what encoders read, `covariance` asks the readings how noisy they are
//! and `whitening` accounts for it, `problem` holds the regression in blocks of poses, `normal`
//! solves it, `prepare` finds what the data can see (`not_shown` why nothing), and `displacement`
//! puts the result together. Of absolute `positions` and `clamped` axes it is the fit of
//! `fit/own.rs` that `fitted` puts together.

pub(crate) mod baseline;
pub(crate) mod clamped;
pub(crate) mod column;
pub(crate) mod covariance;
pub(crate) mod displacement;
pub(crate) mod fitted;
#[cfg(test)]
mod held_tests;
pub(crate) mod misread;
pub(crate) mod noise;
pub(crate) mod normal;
mod not_shown;
pub(crate) mod one_by_one;
pub(crate) mod positions;
pub(crate) mod prepare;
pub(crate) mod problem;
pub(crate) mod readable;
pub(crate) mod samples;
pub(crate) mod scale;
pub(crate) mod second_order;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod told_tests;
pub(crate) mod uncertainty;
pub(crate) mod untold;
pub(crate) mod whitening;
pub(crate) mod wild;

use core::fmt;
use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::DMatrix;
use robstiff_robots::Description;

pub use crate::fit::estimate::NOTEWORTHY_DEVIATION;
pub use baseline::Visibility;
pub use clamped::without_laws;
pub use covariance::{Basis, Covariance};
pub use misread::{Misread, misread};
pub use prepare::noise_not_used;
pub use scale::{ALL_JOINTS, off_by_one_factor};

use self::baseline::Declared;
use self::column::Column;
use self::normal::Sign;
use crate::campaign::{Campaign, Data};
use crate::fit::noise::NoiseSource as Source;
use robstiff::JointKind;
use robstiff::elements::Spring;

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

/// Where the noise of a reading is known from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseSource {
    /// The campaign declares it.
    Declared,
    /// The campaign declares less than the step that readings are in: with what their rounding
    /// adds.
    Rounded,
    /// From what repeated readings differ by.
    Repetitions,
    /// From what is left when every pose has a free response to its loads.
    Poses,
    /// From what the model leaves: an upper bound, since it counts what the
    /// model lacks as noise.
    Residuals,
}

impl From<Source> for NoiseSource {
    fn from(source: Source) -> Self {
        match source {
            Source::Declared => Self::Declared,
            Source::Rounded => Self::Rounded,
            Source::Repetitions => Self::Repetitions,
            Source::Residuals => Self::Residuals,
        }
    }
}

impl NoiseSource {
    /// Where noise that is declared is known from.
    pub(crate) fn of_declared(campaign: &Campaign) -> Self {
        if campaign.step_beyond_noise().is_some() { Self::Rounded } else { Self::Declared }
    }

    /// Whether the campaign says it.
    pub(crate) fn is_declared(self) -> bool {
        matches!(self, Self::Declared | Self::Rounded)
    }
}

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
    /// How the readings hang together, and which do not belong; of displacements.
    pub covariance: Option<Covariance>,
    /// The lines of rows that do not belong to the others and were left out.
    pub left_out: Vec<usize>,
    /// The error of the description as declared (m): rms over rows, without those left
    /// out, of the displacement residual's length over `sqrt(3)`.
    pub rms_declared: Option<f64>,
    /// The same of the description as identified (m).
    pub rms: Option<f64>,
}

/// One number with its uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// `joint 3`, or an effect's number: `transverse_compliance@joint 3`,
    /// `link_compliance@link 2 bending`.
    pub name: String,
    /// What the description said.
    pub declared: f64,
    /// What it is now; the declared value where the data do not see it.
    pub value: f64,
    /// One standard deviation, where it could be estimated; not at a bound.
    pub std: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
    /// Whether the data see it.
    pub visibility: Visibility,
    /// Whether it is zero only because a compliance is not negative: the data
    /// see it, but do not follow the load on it.
    pub at_bound: bool,
    /// Full names of effects that would change it by more than its standard deviation and that the
    /// data do not show. None of [`identify`], which knows no effects but the description's.
    pub confounded_with: Vec<String>,
}

/// What is said of readings by which every joint that they show would be less than
/// rigid: they are of something else, or of the wrong sign.
pub const AGAINST_THE_LOADS: &str = "the readings do not follow the loads";

impl Estimate {
    /// A number with its unit, of a declared value and a sign, that has a value after a
    /// fit; with its variance where it was fitted, `visibility` where not.
    pub(crate) fn new(
        (name, unit): (String, &'static str),
        (declared, sign): (f64, Sign),
        value: f64,
        fitted: Option<f64>,
        visibility: &Visibility,
    ) -> Self {
        let at_bound = fitted.is_some() && is_at_bound(sign, declared, value);
        // What is held at zero has no variance.
        let std = fitted.filter(|variance| !at_bound && *variance > 0.0).map(f64::sqrt);
        // An effect may have brought it to light.
        let visibility = if fitted.is_some() { Visibility::Seen } else { visibility.clone() };
        Self { name, declared, value, std, unit, visibility, at_bound, confounded_with: Vec::new() }
    }

    /// The relative deviation from the declared value; `None` where nothing
    /// was declared or seen, or the value is but a bound.
    pub fn deviation(&self) -> Option<f64> {
        (self.declared != 0.0 && self.visibility == Visibility::Seen && !self.at_bound)
            .then(|| self.value / self.declared - 1.0)
    }

    /// Whether the deviation is beyond [`NOTEWORTHY_DEVIATION`].
    pub fn is_noteworthy(&self) -> bool {
        self.deviation().is_some_and(|deviation| deviation.abs() > NOTEWORTHY_DEVIATION)
    }
}

/// Identifies the compliances of a campaign's robot.
///
/// # Errors
/// What [`Campaign::check`] finds; a campaign that shows none of them, or deflections and
/// readings against their loads, or in another unit.
pub fn identify(campaign: &Campaign) -> Result<Identification, Error> {
    campaign.check().map_err(Error::Invalid)?;
    whole(campaign)?;
    let found = match &campaign.data {
        Data::Displacement(_) => displacement::identify(campaign),
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

/// Refuses displacements along one direction.
fn whole(campaign: &Campaign) -> Result<(), Error> {
    match &campaign.data {
        Data::Displacement(data) if !data.is_whole() => Err(Error::OtherCampaign(
            "displacements along one direction only: `trace` takes them, `identify` needs dx, dy and dz".to_string(),
        )),
        _ => Ok(()),
    }
}

/// That by the readings every joint would be less than rigid.
pub(crate) fn less_than_rigid() -> Error {
    Error::AgainstTheLoads(format!(
        "{AGAINST_THE_LOADS}: by them every joint would be less than rigid; check the signs of loads and readings, their \
         frames and their units"
    ))
}

/// The estimates of a description's own numbers, given what the data see of each;
/// `columns` are the numbers that the covariance is of.
pub(crate) fn estimates(
    description: &Description,
    (own, visibility): (&[Declared], &[Visibility]),
    values: &[f64],
    columns: &[usize],
    covariance: &DMatrix<f64>,
) -> Vec<Estimate> {
    let one = |(i, number): (usize, &Declared)| {
        let fitted = columns.iter().position(|&column| column == i).map(|k| covariance[(k, k)]);
        let name = (element_name(description, number), unit_of(description, number.column));
        Estimate::new(name, (number.value, number.sign), values[i], fitted, &visibility[i])
    };
    own.iter().enumerate().map(one).collect()
}

/// Whether a fitted value is where the solution was clipped. What is declared
/// zero and comes out zero is no surprise.
pub(crate) fn is_at_bound(sign: Sign, declared: f64, value: f64) -> bool {
    sign == Sign::Nonnegative && declared > 0.0 && value == 0.0
}

/// `joint 3`, or an effect's full name with its number's where it has several.
pub(crate) fn element_name(description: &Description, number: &Declared) -> String {
    match (number.effect, number.column) {
        (None, Column::Spring(Spring::Joint(joint))) => format!("joint {joint}"),
        (Some(effect), column) => {
            let name = description.effects[effect].to_string();
            let number = parameter_name(column);
            if number == "value" { name } else { format!("{name} {number}") }
        }
        (None, _) => unreachable!("only joints' own compliances belong to no effect"),
    }
}

/// What a description calls a column's number.
pub(crate) fn parameter_name(column: Column) -> &'static str {
    match column {
        Column::Spring(Spring::Joint(_) | Spring::Transverse(_) | Spring::Coupling(_)) => "value",
        Column::Spring(Spring::LinkBending(_)) => "bending",
        Column::Spring(Spring::LinkTorsion(_)) => "torsion",
        Column::Spring(Spring::BaseTilt) => "tilt",
        Column::Spring(Spring::ToolRotation) => "rotation",
        Column::Spring(Spring::BaseTranslation | Spring::ToolTranslation) => "translation",
        Column::Knee { .. } => "added",
        Column::Gap { .. } => "gap",
        Column::Play { operator, .. } => ["weight1", "weight2", "weight3"][operator],
    }
}

/// The unit of a column's number.
pub fn unit_of(description: &Description, column: Column) -> &'static str {
    match column {
        Column::Spring(Spring::BaseTranslation | Spring::ToolTranslation) => "m/N",
        Column::Gap { .. } => "rad",
        Column::Spring(Spring::Joint(joint)) | Column::Knee { joint, .. } | Column::Play { joint, .. }
            if description.joints[joint - 1].kind == JointKind::Prismatic =>
        {
            "m/N"
        }
        _ => "rad/Nm",
    }
}
