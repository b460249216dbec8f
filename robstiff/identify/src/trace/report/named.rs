//! The effects of a model, and what is wrong in single visits, as they are told.

use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::DMatrix;
use robstiff_robots::effect::Place as Part;

use super::spread::share_of;
use crate::identify::prepare::Prepared;
use crate::trace::alias::{Swap, in_part, same_as};
use crate::trace::bench::Bench;
use crate::trace::catalogue::{BASE_SLIP, SHIFT};
use crate::trace::confounded::Alias;
use crate::trace::found::{EffectParameter, Found};
use crate::trace::isolated::Event;
use crate::trace::model::{Fitted, Named, Setting};
use crate::trace::order::costliest_first;
use crate::trace::search::Outcome;
use crate::trace::slip::SLIPPED_AT;
use crate::trace::{NamedEffect, Options};

/// The named effects, the one whose removal costs most first: each with the error on unseen
/// poses, but for some rows, that it and those before it leave; that of all of them where these
/// are not possible alone.
pub fn effects(
    bench: &Bench<'_>,
    setting: &Setting<'_>,
    fine: &Fitted,
    outcome: &Outcome,
    (spread, aliases, swaps): (&DMatrix<f64>, &[Alias], &[Swap]),
    (but, whole): (&[usize], f64),
    options: &Options,
) -> Vec<NamedEffect> {
    let model = &outcome.selection.model;
    let mut so_far = Vec::new();
    let by_cost = costliest_first(&model.named, |rest| Some(bench.fit(rest).ok()?.bic));
    let named = by_cost.into_iter().map(|k| {
        so_far.push(model.named[k]);
        so_far.sort_unstable();
        let holdout_rms = unseen_rms(bench, &so_far, but).unwrap_or(whole);
        let parameters = parameters(setting, fine, spread, k);
        let candidate = &setting.candidates[model.named[k].candidate];
        let same_as = same_as(bench, model, k, swaps, outcome.structure(), options);
        let mut parts = in_part(bench, model, k);
        let of_effect = setting.variant(model.named[k]).columns.iter();
        let places: Vec<usize> = of_effect.filter_map(|column| place_of(fine, *column)).collect();
        let changes = |alias: &&Alias| places.iter().any(|&at| alias.changes(at, spread[(at, at)].sqrt()));
        for Alias { name, .. } in aliases.iter().filter(changes) {
            if *name != candidate.name() && !parts.contains(name) {
                parts.push(name.clone());
            }
        }
        NamedEffect {
            effect: Found::new(candidate.kind, candidate.place, parameters).in_whole(bench.robot()),
            lines: Vec::new(),
            p_value: outcome.selection.p_values[k],
            holdout_rms,
            in_part: parts.into_iter().filter(|name| !same_as.contains(name)).collect(),
            same_as,
            partial: outcome.structure(),
        }
    });
    named.collect()
}

/// The error on unseen poses, but for some rows, of a model with some effects; none where they are
/// not possible without others, for which they make up.
pub fn unseen_rms(bench: &Bench<'_>, named: &[Named], but: &[usize]) -> Option<f64> {
    let setting = bench.at(named).ok()?;
    Some(setting.holdout_rms(&setting.fit(named).ok()?.fit, but))
}

/// The place of a column in the fit of a model.
fn place_of(model: &Fitted, column: usize) -> Option<usize> {
    model.fit.columns.iter().position(|&of| of == column)
}

/// The numbers of one of a model's effects, with their standard deviations; where they fit
/// best it has the same effects in the same order.
pub fn parameters(setting: &Setting<'_>, model: &Fitted, spread: &DMatrix<f64>, k: usize) -> Vec<EffectParameter> {
    let variant = setting.variant(model.named[k]);
    let fitted = variant.columns.iter().enumerate().map(|(n, column)| {
        let number = &setting.numbers[column - setting.own.len()];
        let at = place_of(model, *column).expect("its own model has it");
        let (value, std) = match number.share_of {
            Some(joint) => share_of(setting, model, spread, at, joint),
            None => (model.fit.coefficients[at], spread[(at, at)].sqrt()),
        };
        let name = variant.names.get(n).copied().unwrap_or(number.name);
        EffectParameter { name, value, std: Some(std), unit: number.unit }
    });
    // Those out of grids follow in the covariance, those of the effects before first.
    let of_grid = |one: &Named| Some(setting.variant(*one)).filter(|variant| variant.refine.is_some());
    let before = model.named[..k].iter().filter_map(of_grid).map(|variant| variant.shape.len()).sum::<usize>();
    let first = model.fit.columns.len() + before;
    let out_of_grid = variant.shape.iter().enumerate().map(|(n, number)| {
        let known = variant.refine.is_some() && first + n < spread.nrows();
        let std = known.then(|| number.value * spread[(first + n, first + n)].sqrt());
        EffectParameter { std, ..number.clone() }
    });
    in_order(fitted.collect(), out_of_grid.collect())
}

/// Numbers with those out of a grid that go with each, the smallest of these
/// first: fitting may have brought them out of order.
pub fn in_order(numbers: Vec<EffectParameter>, shapes: Vec<EffectParameter>) -> Vec<EffectParameter> {
    let mut order: Vec<usize> = (0..shapes.len()).collect();
    if numbers.len() == shapes.len() {
        order.sort_by(|&a, &b| shapes[a].value.total_cmp(&shapes[b].value));
    }
    let sorted = |all: &[EffectParameter]| -> Vec<EffectParameter> {
        let one = |(place, &from): (usize, &usize)| EffectParameter { name: all[place].name, ..all[from].clone() };
        order.iter().enumerate().map(one).collect()
    };
    match numbers.len() == shapes.len() {
        true => sorted(&numbers).into_iter().chain(sorted(&shapes)).collect(),
        false => numbers.into_iter().chain(shapes).collect(),
    }
}

/// A mount that yields more often than this in one campaign is not what is wrong: something
/// gives way within visits, whatever it is.
const MOST_SLIPS: usize = 3;

/// The names of what is wrong in single visits, which some effects may as well be. Rows at the
/// end of a visit that are all off alike are what a slip of the base within the visit leaves, of
/// which the next unloaded reading knows nothing; a slip in the visit that one was found at the
/// end of, or within, is that one (`slipped`).
pub fn isolated(
    prepared: &Prepared<'_>,
    outcome: &Outcome,
    holdout_rms: f64,
    slipped: Option<&mut NamedEffect>,
    may_be: &[String],
) -> Vec<NamedEffect> {
    let lines = |event: &Event| event.rows.iter().map(|&row| prepared.data.rows[row].line).collect::<Vec<usize>>();
    // First as what is said of single visits; a slip is among the candidates itself.
    let besides = |own: &Found, first: &[&str]| {
        let own = own.to_string();
        let others = may_be.iter().filter(|name| !first.contains(&name.as_str()) && **name != own).cloned();
        first.iter().copied().map(String::from).chain(others).collect()
    };
    let one = |effect: Found, events: &[&Event], first: &[&str]| {
        let mut lines: Vec<usize> = events.iter().flat_map(|event| lines(event)).collect();
        lines.sort_unstable();
        NamedEffect {
            same_as: besides(&effect, first),
            effect,
            lines,
            p_value: events.iter().map(|event| event.p_value).fold(0.0, f64::max),
            holdout_rms,
            in_part: Vec::new(),
            partial: outcome.structure(),
        }
    };
    let (mut slips, mut outliers): (Vec<&Event>, Vec<&Event>) =
        outcome.events.iter().partition(|event| event.slip.is_some());
    let already = slipped.is_some();
    if let Some(known) = slipped {
        let moment = known.effect.value(SLIPPED_AT) as usize;
        // By their places among the rows, for the next one read may be on any line.
        let moment = prepared.data.rows.iter().position(|row| row.line == moment).unwrap_or(usize::MAX);
        let (same, others): (Vec<_>, Vec<_>) = slips.into_iter().partition(|slip| slipped_at(slip, moment));
        known.lines.extend(same.into_iter().flat_map(lines));
        slips = others;
    }
    let too_many = slips.len() > MOST_SLIPS;
    if too_many {
        outliers.append(&mut slips);
    }
    slips.sort_by_key(|slip| slip.rows.iter().min().copied());
    // At one pose a shift in the base frame is one in the tool frame.
    let slip = |slip: &Event| one(slip_of(slip, prepared), &[slip], &["outliers@rig", "reflector_slip@rig"]);
    let mut found: Vec<NamedEffect> = slips.into_iter().map(slip).collect();
    if !outliers.is_empty() {
        // One visit alone may as well have been where the robot slipped, or the reflector.
        let may_have_slipped = (outliers.len() == 1 && !already) || too_many;
        let slips: &[&str] = if may_have_slipped { &["base_slip@base", "reflector_slip@rig"] } else { &[] };
        let rows = outliers.iter().map(|event| event.rows.len()).sum();
        found.push(one(Found::outliers(rows), &outliers, slips));
    }
    found
}

/// Whether a row is one of those that a slip in a visit has shifted, or the next.
fn slipped_at(slip: &Event, row: usize) -> bool {
    let ends = slip.rows.iter().min().zip(slip.rows.iter().max());
    ends.is_some_and(|(&first, &last)| (first..=last + 1).contains(&row))
}

/// The slip in a visit, with its shift and the first line that has it.
fn slip_of(event: &Event, prepared: &Prepared<'_>) -> Found {
    let shift = event.slip.unwrap_or_default();
    let number = |(name, &value): (&'static str, &f64)| EffectParameter { name, value, std: None, unit: "m" };
    let mut parameters: Vec<EffectParameter> = SHIFT.into_iter().zip(shift.iter()).map(number).collect();
    let first = event.rows.iter().min().map_or(0, |&row| prepared.data.rows[row].line);
    parameters.push(EffectParameter { name: SLIPPED_AT, value: first as f64, std: None, unit: "1" });
    Found::new(&BASE_SLIP, Part::Base.into(), parameters)
}
