//! Effects of clamped axes that are not worth a name: what is not distinct from zero, or hardly lowers
//! the error of the axes that it moves.

use std::format;
use std::vec::Vec;

use nalgebra::DVector;

use super::bench::Bench;
use super::noise::noise;
use super::report::with_spread;
use super::search::Found;
use super::spread::spread;
use crate::campaign::Campaign;
use crate::trace::Options;
use crate::trace::matters::matters;
use crate::trace::model::{Fitted, Named, all_but};
use crate::trace::step::Step;

/// What was found without effects that are not worth a name, one at a time, the one first without
/// which the error is lowest.
pub fn worth_naming(campaign: &Campaign, mut found: Found, options: &Options) -> Found {
    while let Some((k, rest)) = least(campaign, &found.bench, &found.selection.model) {
        let (bench, selection) = (&found.bench, &mut found.selection);
        let name = |one: &Named| bench.candidates[one.candidate].name();
        let mut step = Step::bare(rest.named.iter().map(name).collect());
        step.outcome = format!("not distinct from zero, or too little to matter: {}", name(&selection.model.named[k]));
        selection.steps.push(step);
        selection.p_values = bench.p_values(&rest.named, options);
        selection.model = rest;
    }
    found
}

/// The place of the effect that is not worth a name and without which the error is lowest, with the
/// model without it.
fn least(campaign: &Campaign, bench: &Bench, model: &Fitted) -> Option<(usize, Fitted)> {
    let (noise, _) = noise(campaign, bench, model);
    let numbers = with_spread(bench, model, &spread(bench, model));
    let whole = bench.residuals(&model.fit);
    let mut found: Option<(f64, usize, Fitted)> = None;
    for (k, &one) in model.named.iter().enumerate() {
        // What the rest cannot be fitted without matters.
        let Some(rest) = bench.fit(&all_but(&model.named, k)) else { continue };
        let rows: Vec<usize> = match bench.axis_of(one.candidate) {
            Some(axis) => bench.axes.rows_of(axis),
            None => (0..bench.axes.rows.len()).collect(),
        };
        let rms = |left: &DVector<f64>| (left.select_rows(&rows).norm_squared() / rows.len().max(1) as f64).sqrt();
        let lowers = rms(&bench.residuals(&rest.fit)) - rms(&whole);
        let sizes = &numbers[k].parameters[..bench.form(one).numbers.len()];
        if !matters(sizes, lowers, noise) && found.as_ref().is_none_or(|(least, ..)| lowers < *least) {
            found = Some((lowers, k, rest));
        }
    }
    found.map(|(_, k, rest)| (k, rest))
}
