//! Tracing: which effects a campaign shows that a description lacks.
//!
//! The way of the data:
//! 1. a case (`fit/case.rs`) is made of the campaign: what it reads, and what it can show;
//! 2. the search (`select`) weighs sets of effects by their evidence;
//! 3. it is repeated (`select/folds.rs`) without some poses, which gives the error on unseen poses;
//! 4. each class of effects is judged (`judge`): named, or suspected;
//! 5. the effects that predict go into the description (`trace/written.rs`), as far as it takes them.

mod accounted;
pub(crate) mod basis;
mod beside;
mod corrected;
mod errors;
mod features;
mod forms;
mod found;
mod report;
#[cfg(test)]
mod tests;
mod written;

use robstiff_robots::Description;

pub use crate::fit::estimate::{Estimate, NOTEWORTHY_DEVIATION, Visibility, estimates, with_values};
pub use crate::fit::noise::NoiseSource;
pub use accounted::account_for;
pub use errors::{Misfit, PoseError, RowResidual};
pub use found::Found;
pub use written::is_offered_as_change;

use crate::campaign::Campaign;
pub use crate::effects::{Number as EffectParameter, Place};
use crate::fit::case::Case;
use crate::identify::Error;
use crate::judge::gates;
pub use crate::judge::thresholds::SUSPECTED;
use crate::judge::thresholds::{DISTINCT, FEWEST_POSES, FOLDS};
pub use crate::judge::verdict::Verdict;
use crate::select::Engine;
use crate::select::always::{Declared, Own};
use crate::select::folds::nested;
use basis::Basis;

/// How to trace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Seed of the folds; one seed gives one result.
    pub seed: u64,
    /// In how many folds the search is repeated; each pose by itself where there are no more.
    pub folds: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { seed: 1, folds: FOLDS }
    }
}

/// What is reported while it takes: one line for each stage.
pub type Progress<'a> = dyn Fn(&str) + 'a;

/// The result of tracing a campaign. Lengths are in m; an rms is over rows of the residual's length
/// over `sqrt(3)`, of clamped axes over their angles (rad).
#[derive(Clone, Debug)]
pub struct Trace {
    /// The robot's name.
    pub robot: String,
    /// The number of rows.
    pub rows: usize,
    /// The number of poses, or of clamped axes.
    pub poses: usize,
    /// The poses held out, by id.
    pub held_out: Vec<String>,
    /// The noise of one reading.
    pub noise: f64,
    /// Where the noise is known from.
    pub noise_source: NoiseSource,
    /// The joints (from 1) whose angle is read behind the gear, with the noise of each.
    pub encoders: Vec<(usize, f64)>,
    /// Whether what the motors let through was taken from the readings.
    pub motors: bool,
    /// The error of the description as declared.
    pub declared: Misfit,
    /// The error with the description's own numbers fitted again.
    pub identified: Misfit,
    /// The error with everything that was found; as declared where the data cannot tell.
    pub after: Misfit,
    /// The error of the description that is written, what the rig is off by corrected for. It is that of
    /// the description's own numbers alone where these predict unseen poses better.
    pub written: Misfit,
    /// The effects named, the one that matters most first.
    pub effects: Vec<NamedEffect>,
    /// What is likely, but not certain enough to be named.
    pub suspected: Vec<Suspected>,
    /// The conclusion.
    pub verdict: Verdict,
    /// Why, in a sentence without its full stop.
    pub why: String,
    /// The share of the residual's variance that is beyond the noise.
    pub unexplained: f64,
    /// The columns that the residual depends on, the strongest first.
    pub depends_on: Vec<String>,
    /// What it looks like that the catalogue has no name for, each as a noun for a sentence.
    pub looks_like: Vec<String>,
    /// Other sets of effects that are nearly as probable, the best first.
    pub rivals: Vec<Rival>,
    /// The sets that were judged best, with their probability: full names with their forms.
    pub sets: Vec<(Vec<String>, f64)>,
    /// Full names of what these data could not show if it were there.
    pub invisible: Vec<String>,
    /// Measurements that would separate what these cannot tell apart.
    pub next: Vec<Proposal>,
    /// The whole search repeated without some poses.
    pub nested: Nested,
    /// The description with the effects and the numbers fitted with them; as declared where the data
    /// cannot tell.
    pub description: Description,
    /// The description's own numbers without the effects.
    pub estimates_before: Vec<Estimate>,
    /// The same with them.
    pub estimates: Vec<Estimate>,
    /// The residual of each row.
    pub residuals: Vec<RowResidual>,
    /// How many components of a residual are read: three, of a clamped axis one.
    pub components: usize,
    /// Whether what is read is the difference of two readings.
    pub differences: bool,
    /// The rms of each pose.
    pub pose_errors: Vec<PoseError>,
    /// Where it ended; none where the data cannot tell.
    pub(crate) basis: Option<Basis>,
}

/// An effect that was named.
#[derive(Clone, Debug)]
pub struct NamedEffect {
    /// The effect, its numbers with their uncertainty.
    pub effect: Found,
    /// The lines of the CSV file that it concerns, where it is about single rows.
    pub lines: Vec<usize>,
    /// The probability of its class: that it, or what these data cannot tell from it, is there.
    pub probability: f64,
    /// The members of its class, itself first, by full name with the probability of each.
    pub class: Vec<(String, f64)>,
    /// The share of folds in which it is back.
    pub recurs: f64,
    /// The error on unseen poses with it and those before it, in the unit of [`Misfit`].
    pub holdout_rms: f64,
    /// Whether more than the named effects is missing.
    pub partial: bool,
}

impl NamedEffect {
    /// Full names of what these data cannot tell it from.
    pub fn same_as(&self) -> Vec<String> {
        self.class.iter().skip(1).map(|(name, _)| name.clone()).collect()
    }
}

/// An effect that is not certain enough to be named.
#[derive(Clone, Debug)]
pub struct Suspected {
    /// The effect, its numbers with their uncertainty.
    pub effect: Found,
    /// The probability of its class.
    pub probability: f64,
    /// The members of its class, itself first, by full name with the probability of each.
    pub class: Vec<(String, f64)>,
    /// The share of folds in which it is back.
    pub recurs: f64,
    /// What keeps it from being named.
    pub why_not: String,
}

/// A set of effects that is nearly as probable as the best.
#[derive(Clone, Debug, PartialEq)]
pub struct Rival {
    /// Full names.
    pub names: Vec<String>,
    /// Twice the logarithm of the odds of the best set against it.
    pub bic_difference: f64,
}

/// A measurement that would separate two effects.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// Joint coordinates (rad or m).
    pub q: Vec<f64>,
    /// The force (N) in the base frame, acting where the campaign's loads do; of a payload, its weight.
    pub force: [f64; 3],
    /// The payload (kg), where positions are read.
    pub payload: Option<f64>,
    /// Full names of what it separates.
    pub separates: [String; 2],
}

/// The whole search repeated without some poses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Nested {
    /// How many folds there were; none where poses are held out, or the data cannot tell.
    pub folds: usize,
    /// The error on poses that had no part in the search.
    pub rms: f64,
    /// The same with the description's own numbers alone.
    pub identified_rms: f64,
    /// The share of the folds whose best set has each effect, by full name.
    pub names: Vec<(String, f64)>,
}

/// Traces a campaign.
///
/// # Errors
/// What [`Campaign::check`] finds; a campaign that shows none of the robot's compliances, or whose
/// description could not be read back with what was found.
pub fn trace(campaign: &Campaign, options: &Options, progress: &Progress<'_>) -> Result<Trace, Error> {
    campaign.check().map_err(Error::Invalid)?;
    let case = Case::new(campaign, &campaign.robot);
    let mut engine = case.engine(&campaign.robot);
    let nothing = || Error::NotShown("these data show none of the robot's numbers".into());
    let (found, alone) = engine.run_from_alone(progress).ok_or_else(nothing)?;
    if let Some(why) = too_little(&case, &found).or_else(|| against_the_loads(campaign, &engine, &found)) {
        return report::insufficient(campaign, &case, &engine, why);
    }
    let nested = nested(&engine, &found, options.folds, options.seed, progress);
    progress("weighing what may be named");
    let judgement = gates::weigh(&engine, &found, &nested, options.seed);
    report::report(campaign, (&case, &engine), (&found, &alone), &nested, &judgement)
}

/// Why a campaign cannot tell what is missing, if so.
fn too_little(case: &Case<'_>, found: &crate::select::passes::Found) -> Option<String> {
    let readings = case.observation.readings();
    let blocks = case.training.iter().filter(|fitted| **fitted).count();
    let is_clamped = matches!(case.scene.what, crate::effects::What::Clamped);
    if !is_clamped && blocks < FEWEST_POSES {
        return Some(format!("{blocks} poses are too few to judge by, at least {FEWEST_POSES} are needed"));
    }
    let numbers = found.layout.always().filter(|k| found.own.fit.place(*k).is_some()).count();
    let count = case.rows(true).len() * readings.width;
    let few = count < 2 * numbers && !matches!(case.scene.what, crate::effects::What::Positions);
    few.then(|| format!("{count} readings are too few for {numbers} numbers"))
}

/// Why readings that go against the loads say nothing, if these do: no joint that they show yields.
fn against_the_loads(campaign: &Campaign, engine: &Engine<'_>, found: &crate::select::passes::Found) -> Option<String> {
    let own = engine.declared();
    let alone = engine.alone(&found.layout)?;
    let estimates = estimates(&campaign.robot, &own, Some((&found.layout, &alone)));
    let is_joint =
        |(own, of): &(&Declared, &Estimate)| matches!(own.what, Own::Joint(_)) && of.visibility == Visibility::Seen;
    let mut seen = own.iter().zip(&estimates).filter(is_joint).peekable();
    seen.peek()?;
    let free = engine.free(&found.layout)?;
    let negative = |k: usize| free.fit.mean[k] < -DISTINCT * free.fit.std[k];
    let goes_against = (0..own.len()).filter_map(|k| free.fit.place(found.layout.fixed + k)).any(negative);
    (goes_against && seen.all(|(_, of)| of.value <= 0.0)).then(|| {
        "every joint that the readings show comes out rigid: they go against the loads, so that they or the loads have \
         a wrong sign or frame"
            .into()
    })
}
