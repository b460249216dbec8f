//! Triage: what the readings themselves say, before any model of the robot.
//!
//! An elastic arm moves in proportion to its load, back and forth alike, the same
//! under `F1` along `F2` as under `F2` along `F1` (Betti), never against the load,
//! on one path up and down, and comes back to where it was. None of this needs a
//! compliance, and each that fails points somewhere. A check says whether these
//! data could be asked at all and what would let them be, what it found with its
//! unit and its probability under noise alone, and what that points to.
//!
//! Probabilities are by random signs of whole poses ([`randomisation`]) where
//! nothing else is said. All checks together have the level [`LEVEL`] (Holm,
//! Scandinavian Journal of Statistics 6, 1979): of campaigns in which nothing is
//! wrong one in a hundred is said to have something. What a large deflection of a
//! linear arm makes of proportion is not held against it: a violation is also as
//! large as the check says ([`Finding::matters_from`]). Nor is what laws of joints do
//! that the description declares, such as hysteresis.

pub mod clamped;
mod encoders;
mod energy;
pub mod evidence;
#[cfg(test)]
mod level_tests;
mod loop_area;
mod noise;
mod positions;
mod proportionality;
pub mod randomisation;
mod reciprocity;
mod residual;
mod return_to_zero;
mod reversal;
#[cfg(test)]
mod tests;

use std::string::String;
use std::vec::Vec;

use self::evidence::Evidence;
use crate::campaign::{Campaign, Data};
use crate::noise::tails;
use crate::probability::told;

/// The probability that anything is found where nothing is wrong.
pub const LEVEL: f64 = 0.01;

/// The answers of a campaign.
#[derive(Clone, Debug)]
pub struct Triage {
    /// Every check, in the order of the registry.
    pub checks: Vec<Check>,
    /// One sigma of a displacement reading (m), where the readings say.
    pub reading: Option<f64>,
    /// Outlying readings.
    pub outliers: Vec<Stray>,
}

/// A check and its answer.
#[derive(Clone, Debug)]
pub struct Check {
    /// Its name.
    pub name: &'static str,
    /// What it asks.
    pub question: &'static str,
    /// What came of it.
    pub answer: Answer,
}

/// What came of a check.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// These data could not be asked; what measurement would let them be.
    NotAsked(String),
    /// What was found.
    Asked(Finding),
}

/// What a check found.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The statistic.
    pub statistic: f64,
    /// Its unit; empty for a number.
    pub unit: &'static str,
    /// The probability of one as large under noise alone; none where there is
    /// nothing to judge it by.
    pub p_value: Option<f64>,
    /// The same with all checks counted (Holm).
    pub adjusted: Option<f64>,
    /// The size from which it matters, in the same unit.
    pub matters_from: f64,
    /// Whether it is beyond noise, all checks counted, and matters.
    pub violated: bool,
    /// How many poses, load sequences or readings it is from.
    pub witnesses: usize,
    /// What was found and what it points to.
    pub said: String,
    /// Full names of the effects that account for a violation, once a trace has named them
    /// ([`account_for`](crate::trace::account_for)).
    pub accounted_for_by: Vec<String>,
}

/// A reading that does not belong to the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Stray {
    /// The visit, by index.
    pub visit: usize,
    /// It in a sentence, with visit and line.
    pub said: String,
    /// Full names of the effects that account for it, likewise.
    pub accounted_for_by: Vec<String>,
}

/// A check by its name, its question, and how it is answered.
type Registered = (&'static str, &'static str, fn(&Evidence<'_>) -> Unjudged);

/// What a check says before all are counted; an error, what measurement would let it be asked.
type Unjudged = Result<Raw, String>;

/// A finding before all checks are counted.
pub(crate) struct Raw {
    statistic: f64,
    unit: &'static str,
    p_value: Option<f64>,
    matters_from: f64,
    witnesses: usize,
    /// What to say where it holds, and where it is violated.
    said: [String; 2],
}

/// Every check there is.
const CHECKS: [Registered; 14] = [
    ("proportionality", "does the displacement grow in proportion to the load?", proportionality::check),
    ("reversal", "do opposite loads give opposite displacements?", reversal::check),
    ("reciprocity", "does one load move the tool along another as much as that along the one?", reciprocity::check),
    ("energy", "does every load do work on the arm?", energy::check),
    ("loop area", "is the way back the way there?", loop_area::check),
    ("return to zero", "is the arm where it was when the load is gone?", return_to_zero::check),
    ("time", "does what is left depend on time?", residual::time),
    ("temperature", "does what is left depend on temperature?", residual::temperature),
    ("order", "does what is left depend on the order of loads?", residual::order),
    ("offset", "have the rows of a visit more in common than their unloaded reading?", noise::offset),
    ("replicates", "what do repeated loads differ by?", noise::replicates),
    ("tails", "is the noise normal?", noise::tails),
    ("outliers", "does every reading belong to the others?", noise::outliers),
    ("encoders", "how much of the displacement do the joints account for?", encoders::check),
];

// P-values by simulation and by random signs can be small enough for the level with all checks
// counted: else a check would hold that could not have failed.
const _: () = assert!(CHECKS.len() as f64 <= LEVEL * (1 + tails::DRAWS) as f64);
const _: () = assert!(CHECKS.len() as f64 * randomisation::LEAST_P <= LEVEL);

/// Asks the readings of a campaign.
///
/// # Panics
/// Where [`Campaign::check`] finds something wrong, which it does not in one that was read.
pub fn triage(campaign: &Campaign) -> Triage {
    let (mut checks, reading, outliers) = match &campaign.data {
        Data::Clamped(rows) => (clamped::checks(campaign, rows), None, Vec::new()),
        Data::Position(data) => (positions::checks(data), None, Vec::new()),
        Data::Displacement(data) if !data.is_whole() => {
            let needs = "displacements along three axes".to_owned();
            (CHECKS.iter().map(|&(name, question, _)| (name, question, Err(needs.clone()))).collect(), None, Vec::new())
        }
        Data::Displacement(data) => {
            let evidence = Evidence::new(campaign, data);
            let checks: Vec<_> = CHECKS.iter().map(|&(name, question, ask)| (name, question, ask(&evidence))).collect();
            (checks, evidence.covariance.reading(), noise::strays(&evidence))
        }
    };
    let adjusted =
        holm(checks.iter().map(|(_, _, verdict)| verdict.as_ref().ok().and_then(|raw| raw.p_value.map(told))));
    let checks = checks.drain(..).zip(adjusted).map(|((name, question, verdict), adjusted)| {
        let answer = match verdict {
            Err(needs) => Answer::NotAsked(needs),
            Ok(raw) => Answer::Asked(judged(raw, adjusted)),
        };
        Check { name, question, answer }
    });
    Triage { checks: checks.collect(), reading, outliers }
}

fn judged(raw: Raw, adjusted: Option<f64>) -> Finding {
    let violated = adjusted.is_some_and(|p| p <= LEVEL) && raw.statistic.abs() >= raw.matters_from;
    let [holds, fails] = raw.said;
    Finding {
        statistic: raw.statistic,
        unit: raw.unit,
        p_value: raw.p_value.map(told),
        adjusted,
        matters_from: raw.matters_from,
        violated,
        witnesses: raw.witnesses,
        said: if violated { fails } else { holds },
        accounted_for_by: Vec::new(),
    }
}

/// Holm's adjusted p-values.
fn holm(p_values: impl Iterator<Item = Option<f64>>) -> Vec<Option<f64>> {
    let mut adjusted: Vec<Option<f64>> = p_values.collect();
    let mut order: Vec<usize> = (0..adjusted.len()).filter(|&i| adjusted[i].is_some()).collect();
    order.sort_by(|&a, &b| adjusted[a].partial_cmp(&adjusted[b]).unwrap_or(core::cmp::Ordering::Equal));
    let mut least: f64 = 0.0;
    for (rank, &i) in order.iter().enumerate() {
        least = least.max(adjusted[i].map_or(1.0, |p| (p * (order.len() - rank) as f64).min(1.0)));
        adjusted[i] = Some(least);
    }
    adjusted
}

impl Triage {
    /// The checks that are violated.
    pub fn violated(&self) -> impl Iterator<Item = (&Check, &Finding)> {
        self.asked().filter(|(_, finding)| finding.violated)
    }

    /// The checks that could be asked.
    pub fn asked(&self) -> impl Iterator<Item = (&Check, &Finding)> {
        self.checks.iter().filter_map(|check| match &check.answer {
            Answer::Asked(finding) => Some((check, finding)),
            Answer::NotAsked(_) => None,
        })
    }
}
