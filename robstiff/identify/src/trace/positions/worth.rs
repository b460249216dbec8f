//! Effects in positions that are not worth a name: what is not distinct from zero, or hardly lowers the
//! error.

use std::format;
use std::vec::Vec;

use super::bench::{Bench, Model};
use super::report::parameters;
use super::search::Searched;
use super::spread::spread_of;
use super::structure::noise;
use crate::campaign::Campaign;
use crate::trace::Options;
use crate::trace::matters::matters;
use crate::trace::model::all_but;
use crate::trace::step::Step;

/// What was found without effects that are not worth a name, one at a time, the one first without
/// which the error is lowest.
pub fn worth_naming<'c>(campaign: &Campaign, mut found: Searched<'c>, options: &Options) -> Searched<'c> {
    while found.too_little.is_none()
        && let Some((k, rest)) = least(campaign, &found.bench, &found.model)
    {
        let name = found.bench.candidates[found.model.named[k].candidate].name();
        found.bench.turn_to(&rest);
        let (bench, selection) = (&found.bench, &mut found.selection);
        let mut step = Step::bare(rest.named.iter().map(|one| bench.candidates[one.candidate].name()).collect());
        step.outcome = format!("not distinct from zero, or too little to matter: {name}");
        selection.steps.push(step);
        selection.p_values = (0..rest.named.len()).map(|k| bench.p_value(&rest.named, k, options)).collect();
        selection.model.named.clone_from(&rest.named);
        selection.model.fit.clone_from(&rest.solved.fit);
        selection.model.bic = rest.bic;
        found.model = rest;
    }
    found
}

/// The place of the effect that is not worth a name and without which the error is lowest, with the
/// model without it.
fn least(campaign: &Campaign, bench: &Bench<'_>, model: &Model) -> Option<(usize, Model)> {
    let error = |rss: f64| (rss / model.solved.problem.total.rows as f64).sqrt();
    let whole = error(bench.rss(&model.named)?);
    let (noise, _) = noise(campaign, bench, model);
    let spread = spread_of(bench, model);
    let lowers = |k: usize| Some(error(bench.rss(&all_but(&model.named, k))?) - whole);
    let is_worth = |k: usize, lowers: f64| {
        let numbers = parameters(bench, model, &spread, k);
        matters(&numbers[..bench.variant(model.named[k]).columns.len()], lowers, noise)
    };
    // What the rest cannot be fitted without matters.
    let found = (0..model.named.len()).filter_map(|k| Some((k, lowers(k)?))).filter(|&(k, by)| !is_worth(k, by));
    let mut found: Vec<(usize, f64)> = found.collect();
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    found.into_iter().find_map(|(k, _)| Some((k, bench.solve(&all_but(&model.named, k), &model.solved.state)?)))
}
