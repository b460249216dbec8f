//! Tracing: which effects a campaign shows that a description lacks.
//!
//! The way of the data, in the order of `displacements.rs` and `search.rs`:
//! 1. every row has a forward model (`identify/setup.rs`), whose nonlinear numbers are fitted in
//!    their own form (`bench`); at what comes out, a campaign becomes a regression with a column
//!    for everything in the `catalogue` (`point`, `model`);
//! 2. what is wrong in single visits is left out (`isolated`);
//! 3. `selection` searches for the effects that the data ask for, admitted by the family-wise
//!    `bootstrap` test and by poses left out in turn;
//! 4. `lack_of_fit` asks whether structure is left (`sizes`, `resemblance`, `agreement`),
//!    `beyond` whether something without a name accounts for it or for what names do, `wander`
//!    whether a slip is what goes there and back, `along` whether what is left points where a
//!    named effect does;
//! 5. `verdict` takes names back and draws the conclusion, unless the readings do not even follow
//!    the loads (`follows`);
//! 6. effects in the place of others are tried in their own form, one by one (`alias`), and where
//!    one accounts clearly better the search goes on from there;
//! 7. `misread` asks whether the files say something else than what was measured, and if so nothing
//!    is told of the arm;
//! 8. where nothing seems to be left, `overlooked` asks whether something fits far better that the
//!    tests did not see, as few poses hardly show it;
//! 9. where masses are known, `preload` asks whether gears carry the arm's own weight;
//! 10. `matters` drops what is not distinct from zero, or hardly lowers the error;
//! 11. `alias` says what the data cannot tell apart, `confounded` which numbers depend on it, and
//!     `report` puts all of it together.
//!
//! Positions and clamped axes go the same way on benches of their own (`positions`, `clamped`).
//!
//! Of numbers that are all in another unit than the files say, as `identify` refuses them, nothing
//! is searched for.
//!
//! Levels: an effect is named, and structure is found, at a family-wise
//! [`Options::alpha`] of 1 % each, so a robot that lacks nothing is called
//! adequate in about 98 of 100 campaigns.

mod accounted;
pub(crate) mod agreement;
pub(crate) mod alias;
pub(crate) mod along;
pub(crate) mod bench;
pub(crate) mod beyond;
#[cfg(test)]
mod beyond_tests;
pub(crate) mod bootstrap;
pub(crate) mod catalogue;
pub(crate) mod clamped;
mod confounded;
#[cfg(test)]
mod confounded_tests;
pub(crate) mod correction;
mod displacements;
pub(crate) mod features;
mod follows;
#[cfg(test)]
mod follows_tests;
pub(crate) mod found;
pub(crate) mod held_out;
pub(crate) mod isolated;
pub(crate) mod lack_of_fit;
mod matters;
mod misread;
#[cfg(test)]
mod misread_tests;
pub(crate) mod model;
mod nested;
#[cfg(test)]
mod one_line_tests;
mod order;
mod overlooked;
#[cfg(test)]
mod overlooked_tests;
#[cfg(test)]
mod physics_tests;
pub(crate) mod point;
pub(crate) mod positions;
mod preload;
#[cfg(test)]
mod reflector_tests;
mod report;
mod resemblance;
mod search;
pub(crate) mod selection;
mod settle;
mod sizes;
#[cfg(test)]
mod slides_tests;
pub(crate) mod slip;
#[cfg(test)]
mod slips_tests;
mod stable;
pub(crate) mod step;
#[cfg(test)]
mod tests;
pub(crate) mod verdict;
pub(crate) mod wander;
#[cfg(test)]
mod wild_tests;
mod written;
#[cfg(test)]
mod written_tests;
mod yardstick;

use std::format;
use std::string::String;
use std::vec::Vec;

use robstiff_robots::Description;

pub use accounted::account_for;
pub use alias::Rival;
pub use catalogue::is_offered_as_change;
pub use correction::Correction;
pub use found::{EffectParameter, Found, Place};
pub use lack_of_fit::StructureTest;
pub use nested::{Nested, Recurring, nested};
pub use step::{Step, Tested};
pub use verdict::Verdict;

use crate::campaign::{Campaign, Data};
use crate::identify::encoders::EncodersRead;
use crate::identify::{Error, Estimate, NoiseSource};

/// How to trace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Seed of the bootstrap; one seed gives one result.
    pub seed: u64,
    /// Bootstrap draws. The p-value of an effect is no smaller than one over one more than
    /// these. Tests for structure share a level, and take as many as it needs where these
    /// are too few.
    pub draws: usize,
    /// Family-wise level at which effects are named, and structure is found.
    pub alpha: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { seed: 1, draws: 1999, alpha: 0.01 }
    }
}

impl Options {
    /// Whether the level is one, and the draws resolve it.
    ///
    /// # Errors
    /// What is wrong, and how many draws it takes.
    pub fn check(&self) -> Result<(), String> {
        let Self { draws, alpha, .. } = *self;
        if !(alpha > 0.0 && alpha < 1.0) {
            return Err(format!("a level is a number between 0 and 1, not {alpha}"));
        }
        if 1.0 / (draws as f64 + 1.0) > alpha {
            let least = alpha.recip().ceil() - 1.0;
            return Err(format!("{draws} draws resolve no level of {alpha}; at least {least} are needed"));
        }
        Ok(())
    }
}

/// What is told while it takes: one line for each stage.
pub type Progress<'a> = dyn Fn(&str) + 'a;

/// The result of tracing a campaign. Lengths are in m; an rms is over rows of
/// the displacement residual's length over `sqrt(3)`, of clamped axes over their
/// angles.
#[derive(Clone, Debug)]
pub struct Trace {
    /// The robot's name.
    pub robot: String,
    /// The number of rows.
    pub rows: usize,
    /// The number of poses.
    pub poses: usize,
    /// The poses held out, by id.
    pub held_out: Vec<String>,
    /// Lines of poses held out that are not judged by: the fit does not say on which side of
    /// the moment of a slip they are.
    pub undecided: Vec<usize>,
    /// The noise of one reading, in the unit of [`Misfit`].
    pub noise: f64,
    /// Where the noise is known from.
    pub noise_source: NoiseSource,
    /// The encoders that took part; none where none were read.
    pub encoders: Option<EncodersRead>,
    /// The error of the description as declared.
    pub declared: Misfit,
    /// The error with the description's own numbers identified again.
    pub identified: Misfit,
    /// The effects named, the one that explains most first.
    pub effects: Vec<NamedEffect>,
    /// The error with them; as declared where the data cannot tell.
    pub after: Misfit,
    /// The conclusion.
    pub verdict: Verdict,
    /// Why, in a sentence.
    pub why: String,
    /// The share of the residual variance that is beyond the noise.
    pub unexplained: f64,
    /// The columns the residual depends on, the strongest first.
    pub depends_on: Vec<String>,
    /// What it looks like that the catalogue has no name for, each as a noun for a sentence.
    pub looks_like: Vec<String>,
    /// Other models that fit about as well, the best first.
    pub rivals: Vec<Rival>,
    /// Full names of what these data could not show if it were there.
    pub invisible: Vec<String>,
    /// Measurements that would separate what these cannot tell apart.
    pub next: Vec<Proposal>,
    /// The description with the effects and the compliances fitted with them;
    /// as declared where the data cannot tell.
    pub description: Description,
    /// The description's own numbers without the effects.
    pub estimates_before: Vec<Estimate>,
    /// The same with them.
    pub estimates: Vec<Estimate>,
    /// Every step of the search with every candidate.
    pub steps: Vec<Step>,
    /// The tests for structure in what is left.
    pub structure: Vec<StructureTest>,
    /// The residual of each row.
    pub residuals: Vec<RowResidual>,
    /// How many components of a residual are read: three of a displacement, of a
    /// clamped axis the first (an angle).
    pub components: usize,
    /// Whether what is read is the difference of two readings, a loaded and an
    /// unloaded one; absolute positions are one.
    pub differences: bool,
    /// The rms of each pose.
    pub pose_errors: Vec<PoseError>,
}

/// How far off a model is (m; of clamped axes that turn, rad). Rows that a fit leaves out because
/// they do not belong to the others count like all others, by what it predicts of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Misfit {
    /// On the poses fitted to.
    pub rms: f64,
    /// On poses not fitted to: those held out, or each pose by the fit without
    /// it. The search has seen the latter ([`nested`]).
    pub holdout_rms: f64,
}

/// An effect that was named.
#[derive(Clone, Debug)]
pub struct NamedEffect {
    /// The effect, its numbers with their uncertainty.
    pub effect: Found,
    /// The lines of the CSV file that it concerns, where it is about single
    /// rows.
    pub lines: Vec<usize>,
    /// The family-wise p-value of the model without it.
    pub p_value: f64,
    /// The error on unseen poses with it and those before it, in the unit of [`Misfit`].
    pub holdout_rms: f64,
    /// Full names of what these data cannot tell it from.
    pub same_as: Vec<String>,
    /// Full names of what some of its numbers alone may as well be, the others kept.
    pub in_part: Vec<String>,
    /// Whether structure is left beyond all named effects.
    pub partial: bool,
}

/// A measurement that would separate two effects.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// Joint coordinates (rad or m).
    pub q: Vec<f64>,
    /// The force (N) in the base frame, acting where the campaign's loads do; of a payload, its
    /// weight.
    pub force: [f64; 3],
    /// The payload (kg), where positions are read.
    pub payload: Option<f64>,
    /// Full names of what it separates.
    pub separates: [String; 2],
}

/// What is left of a row, in the base frame (m; of clamped axes that turn, the angle in rad).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowResidual {
    /// The line of the CSV file, from 1.
    pub line: usize,
    /// Index of the pose.
    pub pose: usize,
    /// With the description's own numbers identified again.
    pub before: [f64; 3],
    /// With the effects; as declared where the data cannot tell.
    pub after: [f64; 3],
}

/// The rms of one pose, or of one clamped axis, in the unit of [`Misfit`].
#[derive(Clone, Debug, PartialEq)]
pub struct PoseError {
    /// The pose's id.
    pub pose: String,
    /// Whether the pose was held out.
    pub held_out: bool,
    /// With the description's own numbers identified again.
    pub before: f64,
    /// With the effects; as declared where the data cannot tell.
    pub after: f64,
}

/// Traces a campaign.
///
/// # Errors
/// What [`Options::check`] and [`Campaign::check`] find; a campaign that shows none of the
/// robot's compliances, or whose description could not be read back with what was found; clamped
/// axes of which some turn and some slide, or one deflects against its torque.
pub fn trace(campaign: &Campaign, options: &Options, progress: &Progress<'_>) -> Result<Trace, Error> {
    options.check().map_err(Error::Invalid)?;
    campaign.check().map_err(Error::Invalid)?;
    let mut trace = match &campaign.data {
        Data::Displacement(_) => displacements::trace(campaign, options, progress)?,
        Data::Position(data) => positions::trace(campaign, data, options, progress)?,
        Data::Clamped(rows) => clamped::trace(campaign, rows, options, progress)?,
    };
    // Noise that is known from what the model leaves has in it what the model lacks.
    if trace.verdict == Verdict::Explained && trace.noise_source == NoiseSource::Residuals {
        trace.verdict = Verdict::Partial;
        trace.why = String::from(NOISE_IS_NOT_KNOWN);
    }
    Ok(trace)
}

/// Why effects that leave what looks like noise are not said to be all.
const NOISE_IS_NOT_KNOWN: &str = "what the named effects leave looks like noise, but how large the noise is, is known \
                                  from that alone: declare it, or repeat loads";
