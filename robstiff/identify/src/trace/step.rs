//! The steps of a search, as they are told.

use core::borrow::Borrow;
use std::format;
use std::string::String;
use std::vec::Vec;

use super::catalogue::Candidate;
use super::model::Named;

/// One step: all candidates against the model so far.
#[derive(Clone, Debug)]
pub struct Step {
    /// The effects named before.
    pub named: Vec<String>,
    /// Every candidate with its statistic.
    pub candidates: Vec<Tested>,
    /// What came of it.
    pub outcome: String,
}

/// One candidate in one step.
#[derive(Clone, Debug)]
pub struct Tested {
    /// The full name, `kind@at`.
    pub name: String,
    /// The gain in sums of squares over the residual variance, less the price
    /// of further numbers; `None` where it gains nothing physical.
    pub statistic: Option<f64>,
    /// Its family-wise p-value.
    pub p_value: f64,
    /// The criterion of the model with it; lower is better.
    pub bic: Option<f64>,
    /// The error with it on poses left out of the fit (m; of clamped axes that turn, rad), each
    /// in turn; those held out have no part in it.
    pub left_out_rms: Option<f64>,
    /// Why it was not taken; empty for the one that was.
    pub reason: String,
}

/// A candidate against a model without it, in a search that goes forward.
#[derive(Clone, Copy, Debug, Default)]
pub struct Against {
    /// The statistic with its family-wise p-value; `None` where it gains nothing.
    pub gains: Option<(f64, f64)>,
    /// The criterion of the best model with it; `None` where none is physical.
    pub bic: Option<f64>,
    /// The error of that on poses left out of the fit (m), where it is asked for.
    pub left_out_rms: Option<f64>,
}

impl Step {
    /// Every candidate against a model, by what `of` says of those that it has not named.
    pub fn against(candidates: &[Candidate], named: &[Named], of: impl Fn(usize) -> Against) -> Self {
        let tested = |(k, candidate): (usize, &Candidate)| {
            let already = named.iter().any(|one| one.candidate == k);
            let Against { gains, bic, left_out_rms } = if already { Against::default() } else { of(k) };
            let reason = match (already, gains.and(bic)) {
                (true, _) => "already named",
                (false, None) => "it explains nothing with numbers that are physically possible",
                (false, Some(_)) => "another explains more, or it is not significant",
            };
            Tested {
                name: candidate.name(),
                statistic: gains.map(|(statistic, _)| statistic),
                p_value: gains.filter(|_| bic.is_some()).map_or(1.0, |(_, p_value)| p_value),
                bic,
                left_out_rms,
                reason: String::from(reason),
            }
        };
        Self {
            named: named.iter().map(|one| candidates[one.candidate].name()).collect(),
            candidates: candidates.iter().enumerate().map(tested).collect(),
            outcome: String::new(),
        }
    }

    /// A model that nothing can be tested against.
    pub fn bare(named: Vec<String>) -> Self {
        Self { named, candidates: Vec::new(), outcome: String::new() }
    }

    /// A model beside what has no name, each a noun for a sentence.
    pub fn beside_nameless(named: Vec<String>, nameless: &[impl Borrow<str>]) -> Self {
        let outcome = format!("beside what has no name in the catalogue: {}", nameless.join(", "));
        Self { outcome, ..Self::bare(named) }
    }

    /// Says that the search is at its end.
    pub fn nothing_is_missing(&mut self) {
        self.outcome = String::from("nothing is missing significantly");
    }

    /// Says that what is missing has no name that stands up.
    pub fn none_passes(&mut self) {
        self.outcome = String::from("something is missing, but no effect passes every test");
    }

    /// Says that what is missing would need more effects than a model may have.
    pub fn too_many(&mut self, most: usize) {
        self.outcome = format!("something is missing beside {most} effects, more than are looked for");
    }

    /// Says that these effects were dropped on the way to the model.
    pub fn dropped(&mut self, names: &[String]) {
        self.outcome = format!("no longer significant: {}", names.join(", "));
    }

    /// Says that these effects are named now.
    pub fn came_to(&mut self, names: &[String]) {
        self.outcome = format!("named {}", names.join(", "));
        self.candidates.iter_mut().filter(|tested| names.contains(&tested.name)).for_each(|one| one.reason.clear());
    }
}
