//! What stays named: effects are tested a last time, on the rows and with the noise that the
//! model stands on.

use std::string::String;
use std::vec::Vec;

use super::Options;
use super::bench::Bench;
use super::catalogue::Candidate;
use super::model::{Fitted, Named, all_but};
use super::selection::{p_values, table};
use super::step::Step;

/// A model as the rows and the noise have it that it stands on.
pub struct Settled {
    /// The model.
    pub model: Fitted,
    /// The family-wise p-value of each of its effects.
    pub p_values: Vec<f64>,
    /// What was dropped.
    pub dropped: Vec<Named>,
}

/// A model with the noise learnt and the rows that are wild judged at it, and without
/// effects that such rows, or an earlier noise, had made significant; but for those that the
/// rest cannot be fitted without.
pub fn settled(bench: &mut Bench<'_>, mut model: Fitted, options: &Options) -> Settled {
    let mut dropped = Vec::new();
    loop {
        for judge in [Bench::learn_noise, Bench::look_again] {
            if let Some(better) = bench.tried(&model.named, judge) {
                model = better;
            }
        }
        let p_values = p_values(bench, &model.named, options);
        let smaller = without_insignificant(&model.named, &p_values, options, |rest| bench.fit(rest).ok());
        let Some((one, smaller)) = smaller else { return Settled { model, p_values, dropped } };
        dropped.push(one);
        model = smaller;
    }
}

/// The effect of a model that is the least significant of those which are not and without
/// which the rest can be fitted; with that fit.
pub fn without_insignificant<M>(
    named: &[Named],
    p_values: &[f64],
    options: &Options,
    fit: impl Fn(&[Named]) -> Option<M>,
) -> Option<(Named, M)> {
    let mut found: Vec<usize> = (0..named.len()).filter(|&k| p_values[k] > options.alpha).collect();
    found.sort_by(|&a, &b| p_values[b].total_cmp(&p_values[a]));
    found.into_iter().find_map(|k| Some((named[k], fit(&all_but(named, k))?)))
}

/// What was dropped on the way to a model, as [`dropped_step`] tells it.
pub fn told(bench: &Bench<'_>, model: &Fitted, dropped: &[Named], options: &Options) -> Option<(Step, bool)> {
    dropped_step(bench.candidates(), &model.named, dropped, || {
        let (tests, setting) = (bench.tests(&model.named, options)?, bench.at(&model.named).ok()?);
        Some((table(&setting, model, &tests, options), tests.smallest_p() <= options.alpha))
    })
}

/// The step that says what was dropped on the way to a model, if something was, and whether
/// anything is missing there, which what was dropped had said better than others; `tested` are
/// all candidates against the model, and the same of them.
pub fn dropped_step(
    candidates: &[Candidate],
    named: &[Named],
    dropped: &[Named],
    tested: impl FnOnce() -> Option<(Step, bool)>,
) -> Option<(Step, bool)> {
    if dropped.is_empty() {
        return None;
    }
    let names = |of: &[Named]| -> Vec<String> { of.iter().map(|one| candidates[one.candidate].name()).collect() };
    let (mut step, missing) = tested().unwrap_or_else(|| (Step::bare(names(named)), false));
    step.dropped(&names(dropped));
    Some((step, missing))
}
