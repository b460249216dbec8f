//! What is written down of a model of absolute positions.

use std::format;
use std::vec::Vec;

use robstiff_robots::Description;

use super::bench::{Bench, Model};
use crate::campaign::Campaign;
use crate::identify::Error;
use crate::identify::positions::own::with_values;
use crate::identify::positions::regression::STANDS;
use crate::trace::NamedEffect;
use crate::trace::found::{EffectParameter, Found};
use crate::trace::model::Named;
use crate::trace::written::{fitted_again, in_told_order, taken_by, with_effects};

/// The model without effects that a description has a word for but takes at no such numbers,
/// fitted again; `None` where there are none of these.
pub fn without_untold(campaign: &Campaign, bench: &Bench<'_>, model: &Model) -> Option<Model> {
    let stays = |model: &Model| {
        let values = bench.prepared.values(&model.solved.state);
        let description = with_values(&campaign.robot, &bench.prepared.own, &values);
        taken_by(description, &model.named, |one| of_model(bench, model, one))
    };
    let fit = |rest: &[Named]| bench.solve(rest, &model.solved.state);
    fitted_again(model.named.len(), stays(model), fit, stays)
}

/// An effect of a model with its numbers alone.
fn of_model(bench: &Bench<'_>, model: &Model, one: Named) -> Found {
    of_numbers(bench, one, |number| model.solved.state.values[number])
}

/// An effect with numbers that are given by their index among all.
pub fn of_numbers(bench: &Bench<'_>, one: Named, value: impl Fn(usize) -> f64) -> Found {
    let (form, candidate) = (bench.variant(one), &bench.candidates[one.candidate]);
    let number = |column: &usize| {
        let number = column - STANDS;
        let about = &bench.numbers[number - bench.prepared.own.len()];
        EffectParameter { name: about.name, value: value(number), std: None, unit: about.unit }
    };
    let parameters = form.columns.iter().map(number).chain(form.shape.iter().cloned()).collect();
    Found::new(candidate.kind, candidate.place, parameters)
}

/// The effects of a model with its own numbers, in the order in which they are told.
pub fn own_effects(bench: &Bench<'_>, model: &Model, told: &[NamedEffect]) -> Vec<Found> {
    in_told_order(model.named.iter().map(|&one| of_model(bench, model, one)), told)
}

/// The description with the numbers of a model and its effects, which says so.
///
/// # Errors
/// As for [`with_effects`].
pub fn described(
    campaign: &Campaign,
    bench: &Bench<'_>,
    values: &[f64],
    effects: &[Found],
) -> Result<Description, Error> {
    let description = with_values(&campaign.robot, &bench.prepared.own, values);
    let from = if campaign.name.is_empty() { "absolute positions" } else { &campaign.name };
    with_effects(description, effects, |names| {
        let with = if names.is_empty() { "nothing added" } else { names };
        format!("Traced from {from}: {with}.")
    })
}
