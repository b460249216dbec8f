//! What fits far better than what is told, though no test found it.
//!
//! The tests of the search compare with random signs of whole poses, of which few poses hardly
//! have any: where three of them carry most of what is missing, every fourth pattern of signs
//! leaves as much. And candidates are tested where the arm stands without them; joints that were
//! fitted to what a reflector elsewhere reads hardly let it look like that. So where nothing seems
//! to be left, the model is held against others, each in its own form: with one effect more, with
//! one in place of another, or with one alone. What is better by [far](FAR), and than chance has
//! it by Fisher's F, over all that were tried, is where the search begins anew, and effects are
//! then tested where the model with them stands. If it does not pass there either, it is still
//! more than "nothing is missing", or another name, can be told against.
//!
//! Of 856 simulated campaigns that were told to lack nothing, or nothing more, with none to two
//! effects or something that has no name in them, it finds 18, each with what is true.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::Options;
use super::bench::Bench;
use super::displacements::searched_from;
use super::model::{Fitted, Named, all_but};
use super::search::Outcome;
use super::selection::{best_with, p_values};
use super::step::Step;
use super::verdict::Verdict;
use crate::identify::covariance::outliers::STRICT;
use crate::identify::prepare::Prepared;
use crate::probability::{fisher_tail, told};
use crate::words::micrometres;

/// A criterion that is lower by this is far better: odds of three millions to one.
const FAR: f64 = 30.0;

/// More poses have signs enough.
const FEW_POSES: usize = 25;

/// What was found, or what is found from where something that was overlooked fits far better; if
/// that is not significant either, that something is missing, or that the data cannot tell.
///
/// # Errors
/// Why a model cannot be fitted that was before.
pub fn instead<'c>(
    (bench, mut outcome): (Bench<'c>, Outcome),
    prepared: &Prepared<'c>,
    options: &Options,
) -> Result<(Bench<'c>, Outcome), String> {
    let is_told = matches!(outcome.verdict, Verdict::Adequate | Verdict::Explained);
    // Noise with heavy tails, which wild readings come with, is no measure of what is better.
    if !is_told || !outcome.events.is_empty() || bench.at(&[])?.problem.blocks.len() > FEW_POSES {
        return Ok((bench, outcome));
    }
    let Some((other, on)) = far_better(&bench, &outcome.selection.model) else { return Ok((bench, outcome)) };
    let names = on.names(&other.named);
    let mut step = Step::bare(outcome.names(&bench));
    step.outcome = format!("what fits far better by its own form: {}", names.join(", "));
    outcome.selection.steps.push(step);
    let why = besides(&outcome, &bench, (&other, &on))?;
    if let Some((found_on, found)) = anew(on, other, prepared, options) {
        return Ok((found_on, found.after(outcome)));
    }
    if outcome.names(&bench).iter().all(|name| names.contains(name)) && !outcome.selection.model.named.is_empty() {
        outcome.left.iter_mut().for_each(|left| left.structure = true);
        (outcome.verdict, outcome.why) = (Verdict::Partial, why);
        return Ok((bench, outcome));
    }
    let base = bench.fit(&[])?;
    Ok((bench, Outcome::nothing(base, Verdict::Insufficient, why).after(outcome)))
}

/// The model that fits far better than another, of all that were tried the best, and the bench
/// that it is of.
fn far_better<'c>(bench: &Bench<'c>, model: &Fitted) -> Option<(Fitted, Bench<'c>)> {
    let mut rests: Vec<Vec<Named>> = (0..model.named.len()).map(|k| all_but(&model.named, k)).collect();
    rests.extend([model.named.clone(), Vec::new()]);
    rests.sort_unstable();
    rests.dedup();
    let others = tried(bench, &rests);
    let count = others.len() + 1;
    let best = others.into_iter().min_by(|a, b| a.bic.total_cmp(&b.bic));
    let other = best?;
    let is_far =
        other.bic < model.bic - FAR && by_chance(bench, model, &other).is_none_or(|p| told(count as f64 * p) <= STRICT);
    is_far.then(|| (other, bench.copy()))
}

/// The models of some effects and one candidate more, in their own form.
fn tried(bench: &Bench<'_>, rests: &[Vec<Named>]) -> Vec<Fitted> {
    let mut found = Vec::new();
    for rest in rests {
        bench.spare_memory();
        let Ok(setting) = bench.at(rest) else { continue };
        for candidate in 0..bench.candidates().len() {
            let linear = best_with(&setting, rest, candidate);
            found.extend(linear.and_then(|linear| bench.refit(&setting, &linear).ok()).filter(|one| one.physical));
        }
    }
    found
}

/// How probable it is by chance that a model leaves so much less than one of fewer numbers; `None`
/// of one that has no more.
fn by_chance(bench: &Bench<'_>, model: &Fitted, other: &Fitted) -> Option<f64> {
    let more = other.fit.columns.len().checked_sub(model.fit.columns.len()).filter(|&more| more > 0)? as f64;
    let freedom = bench.at(&model.named).ok()?.problem.freedom(&other.fit);
    fisher_tail((model.fit.rss - other.fit.rss) / more / (other.fit.rss / freedom), [more, freedom])
}

/// What is found from a model on where effects are tested where the model with them stands, if
/// those of that model are.
fn anew<'c>(
    mut on: Bench<'c>,
    start: Fitted,
    prepared: &Prepared<'c>,
    options: &Options,
) -> Option<(Bench<'c>, Outcome)> {
    on.by_own_form = true;
    let left_out = |named: &[Named]| {
        let setting = on.at(named).ok()?;
        Some(setting.left_out(&setting.fit(named).ok()?.fit).deviance)
    };
    let predicts = left_out(&start.named)? < left_out(&[])?;
    if !predicts || p_values(&on, &start.named, options).iter().any(|&p| p > options.alpha) {
        return None;
    }
    let names = on.names(&start.named);
    let (on, found) = searched_from(on, prepared, start, options, &|_| ()).ok()?;
    let found_names = found.names(&on);
    let keeps = names.iter().all(|name| found_names.contains(name)) && found.verdict != Verdict::Insufficient;
    keeps.then_some((on, found))
}

/// That something fits far better which is not significant.
fn besides(outcome: &Outcome, bench: &Bench<'_>, (other, on): (&Fitted, &Bench<'_>)) -> Result<String, String> {
    let left = |bench: &Bench<'_>, model: &Fitted| -> Result<String, String> {
        Ok(micrometres(bench.at(&model.named)?.problem.variance(&model.fit).sqrt()))
    };
    let model = &outcome.selection.model;
    Ok(format!(
        "with {} what is left of a reading is {} instead of {}, but these poses do not say that this is no chance; measure \
         at more",
        on.names(&other.named).join(", "),
        left(on, other)?,
        left(bench, model)?
    ))
}
