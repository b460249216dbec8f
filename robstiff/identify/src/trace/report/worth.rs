//! Names that are not worth one: what is not distinct from zero, or hardly lowers the error.

use std::format;
use std::string::String;

use super::named::parameters;
use super::spread::spread_of;
use super::{noise, where_it_fits_best};
use crate::campaign::Campaign;
use crate::identify::prepare::Prepared;
use crate::identify::problem::rms;
use crate::trace::bench::Bench;
use crate::trace::matters::matters;
use crate::trace::model::{Fitted, Named, all_but};
use crate::trace::search::Outcome;
use crate::trace::selection::p_values;
use crate::trace::step::Step;
use crate::trace::written::within_description;
use crate::trace::{Options, Verdict};

/// What was found without effects that are not worth a name, one at a time, the one first without
/// which the error is lowest. What they did is so little that nothing is looked for in its place.
///
/// # Errors
/// Why a model cannot be fitted that was before.
pub fn worth_naming(
    campaign: &Campaign,
    prepared: &Prepared<'_>,
    bench: &Bench<'_>,
    mut outcome: Outcome,
    options: &Options,
) -> Result<Outcome, String> {
    while let Some((dropped, rest)) = least(campaign, prepared, bench, &outcome.selection.model)? {
        let mut step = Step::bare(bench.names(&rest.named));
        let name = bench.candidates()[dropped.candidate].name();
        step.outcome = format!("not distinct from zero, or too little to matter: {name}");
        outcome.selection.steps.push(step);
        outcome.selection.p_values = p_values(bench, &rest.named, options);
        outcome.selection.model = rest;
        if outcome.selection.model.named.is_empty() && outcome.events.is_empty() {
            match outcome.verdict {
                Verdict::Explained => {
                    outcome.verdict = Verdict::Adequate;
                    outcome.why = format!("{name} is not distinct from zero, or lowers the error too little to matter");
                }
                Verdict::Partial => outcome.verdict = Verdict::Unexplained,
                _ => {}
            }
        }
    }
    Ok(outcome)
}

/// The effect of a model that is not worth a name, if there is one: of several, that without which
/// the error is lowest. With the model without it.
fn least(
    campaign: &Campaign,
    prepared: &Prepared<'_>,
    bench: &Bench<'_>,
    model: &Fitted,
) -> Result<Option<(Named, Fitted)>, String> {
    if model.named.is_empty() {
        return Ok(None);
    }
    let polished = bench.polished(&model.named);
    let (of_numbers, setting, fine) = where_it_fits_best(bench, &polished, model)?;
    let fine = within_description(campaign, prepared, &setting, &fine);
    let spread = spread_of(of_numbers, &setting, &fine);
    let (noise, _) = noise(prepared, bench, setting.problem.variance(&fine.fit));
    let whole = errors(bench, model)?;
    let mut found: Option<(f64, usize, Fitted)> = None;
    for k in 0..model.named.len() {
        // What the rest cannot be fitted without matters.
        let Ok(rest) = bench.fit(&all_but(&model.named, k)) else { continue };
        let without = errors(bench, &rest)?;
        let lowers = whole.iter().zip(&without).map(|(with, without)| without - with).fold(0.0, f64::max);
        let numbers = parameters(&setting, &fine, &spread, k);
        let sizes = &numbers[..setting.variant(model.named[k]).columns.len()];
        if !matters(sizes, lowers, noise) && found.as_ref().is_none_or(|(least, ..)| lowers < *least) {
            found = Some((lowers, k, rest));
        }
    }
    Ok(found.map(|(_, k, rest)| (model.named[k], rest)))
}

/// The error on the rows in the fit (m): of displacements as people are told it, and of all that is
/// read, by its noise.
fn errors(bench: &Bench<'_>, model: &Fitted) -> Result<[f64; 2], String> {
    let setting = bench.at(&model.named)?;
    let problem = &setting.problem;
    let rows = problem.blocks.iter().flat_map(|block| block.rows.iter().copied());
    let of_displacements = rms(&setting.residuals(&model.fit), problem.axes, rows);
    Ok([of_displacements, (model.fit.rss / problem.total.rows as f64).sqrt()])
}
