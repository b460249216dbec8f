//! The effects of a model, and its wild rows, as they are told.

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::DMatrix;
use robstiff_robots::effect::Place as Part;

use super::errors::unseen_rms;
use crate::trace::NamedEffect;
use crate::trace::catalogue::{BASE_SLIP, HYSTERESIS, OUTLIERS, STIFFNESS_NONLINEARITY, axis_tells_hysteresis};
use crate::trace::clamped::alike::Alike;
use crate::trace::clamped::apart::Apart;
use crate::trace::clamped::axes::AxisNumber;
use crate::trace::clamped::bench::Bench;
use crate::trace::clamped::curves::instead_of_rows;
use crate::trace::clamped::one_off::one_off;
use crate::trace::clamped::search::Found as Searched;
use crate::trace::clamped::slips::as_good_as_slip;
use crate::trace::found::{EffectParameter, Found, Place};
use crate::trace::model::{Fitted, Named, all_but};
use crate::trace::order::costliest_first;
use crate::trace::selection::WITHIN_REACH;

/// The effects that were found, that without which the criterion is worst first, with what the
/// data cannot tell them from; and behind them the wild rows. `spread` is that of
/// [`spread`](crate::trace::clamped::spread::spread), `holdout_rms` the error (rad) of all of them.
pub fn effects(
    found: &Searched,
    spread: &DMatrix<f64>,
    partial: bool,
    holdout_rms: f64,
    apart: Option<&Apart>,
    alike: Option<&Alike>,
) -> Vec<NamedEffect> {
    let (bench, model) = (&found.bench, &found.selection.model);
    let whole = Bench::new(bench.axes.whole(), Some(&bench.offers));
    let replaced = bench.replaced(&model.named);
    let all = with_spread(bench, model, spread);
    let mut so_far = Vec::new();
    let by_cost = costliest_first(&model.named, |rest| Some(bench.fit(rest)?.bic));
    let of_apart = |k| apart.filter(|apart| apart.shared == k).map_or_else(Vec::new, |apart| apart.names.clone());
    let of_alike = |k| alike.map_or_else(Vec::new, |alike| alike.instead_of(model, k));
    let named = by_cost.into_iter().map(|k| {
        so_far.push(model.named[k]);
        so_far.sort_unstable();
        NamedEffect {
            effect: all[k].clone(),
            lines: Vec::new(),
            p_value: found.selection.p_values[k],
            holdout_rms: bench
                .fit(&so_far)
                .map_or(holdout_rms, |so_far| unseen_rms(bench, &so_far.fit, &whole.residuals(&so_far.fit))),
            in_part: Vec::new(),
            same_as: same_as(bench, model, k, &replaced, [of_apart(k), of_alike(k)].concat()),
            partial,
        }
    });
    named.chain(wild_rows(found, partial, holdout_rms)).collect()
}

/// The wild rows, if there are any, with what else they may be.
fn wild_rows(found: &Searched, partial: bool, holdout_rms: f64) -> Option<NamedEffect> {
    let (bench, model) = (&found.bench, &found.selection.model);
    let (mut lines, p_value) = found.wild.clone();
    if lines.is_empty() {
        return None;
    }
    lines.sort_unstable();
    let effect = Found::outliers(lines.len());
    let slip = slip_before_last(bench, &lines);
    // Of several rows it is one.
    let (mut same_as, mut in_part) = if lines.len() > 1 { (Vec::new(), slip) } else { (slip, Vec::new()) };
    let (curves, all) = instead_of_rows(bench, model, &lines);
    if all { &mut same_as } else { &mut in_part }.extend(curves);
    Some(NamedEffect { effect, lines, p_value, holdout_rms, same_as, in_part, partial })
}

/// An effect of a model with its numbers alone.
pub fn of_model(bench: &Bench, model: &Fitted, one: Named) -> Found {
    let (form, candidate) = (bench.form(one), &bench.candidates[one.candidate]);
    let at = model.fit.columns.iter().position(|column| candidate.variants[one.variant].columns[0] == *column);
    let fitted = model.fit.coefficients.iter().skip(at.expect("its own model has it"));
    let number = |(number, &value): (&AxisNumber, &f64)| EffectParameter {
        name: number.name,
        value,
        std: None,
        unit: number.unit,
    };
    let numbers = form.numbers.iter().zip(fitted).map(number);
    Found::new(candidate.kind, candidate.place, numbers.chain(form.shape.iter().chain(&form.told).cloned()).collect())
}

/// The effects of a model with the uncertainty of their numbers. `spread` is the covariance of the
/// axes' compliances, then of the numbers of each effect that enter linearly, in the order of
/// the model, and then of the logarithms of their shapes.
pub fn with_spread(bench: &Bench, model: &Fitted, spread: &DMatrix<f64>) -> Vec<Found> {
    let (mut linear, mut shapes) = (bench.base.., model.fit.columns.len()..);
    let next = |of: &mut core::ops::RangeFrom<usize>| of.next().map(|k| spread[(k, k)].sqrt());
    let one = |&one: &Named| {
        let (form, mut found) = (bench.form(one), of_model(bench, model, one));
        let (numbers, others) = found.parameters.split_at_mut(form.numbers.len());
        numbers.iter_mut().for_each(|number| number.std = next(&mut linear));
        for shape in &mut others[..form.shape.len()] {
            shape.std = next(&mut shapes).map(|relative| shape.value * relative);
        }
        found
    };
    model.named.iter().map(one).collect()
}

/// Full names of what an effect of a model may as well be; `replaced` are the models with another
/// one in the place of each, `wholes` the names of what is in its place in models that are held
/// against this one as wholes.
fn same_as(bench: &Bench, model: &Fitted, k: usize, replaced: &[(usize, Fitted)], wholes: Vec<String>) -> Vec<String> {
    let candidate = &bench.candidates[model.named[k].candidate];
    let near = replaced.iter().filter(|(of, other)| *of == k && other.bic < model.bic + WITHIN_REACH);
    let in_its_place = |(_, other): &(usize, Fitted)| {
        let new = other.named.iter().find(|new| model.named.iter().all(|old| old.candidate != new.candidate))?;
        Some(bench.candidates[new.candidate].name())
    };
    let names = near.filter_map(in_its_place).chain(dead_zone(bench, model, k));
    let names = names.chain(wholes);
    let mut same_as: Vec<String> = Vec::new();
    for name in names.chain(as_good_as_slip(bench, model, k)).chain(wild_row(bench, model, k)) {
        // Slips of several axes have one name.
        if name != candidate.name() && !same_as.contains(&name) {
            same_as.push(name);
        }
    }
    same_as
}

/// The full name of a slip, of whichever axis.
pub fn slip() -> String {
    format!("{}@{}", BASE_SLIP.name, Place::from(Part::Base))
}

/// The name of a slip, where the last row of an axis is wild, which may be the first after one.
fn slip_before_last(bench: &Bench, lines: &[usize]) -> Vec<String> {
    let whole = bench.axes.whole();
    let last = |axis: usize| whole.rows_of(axis).last().map(|&row| whole.rows[row].line);
    let is_last = whole.loaded().filter_map(last).any(|line| lines.contains(&line));
    is_last.then(slip).into_iter().collect()
}

/// The hysteresis that a softening of the axis may as well be, where its loads never go back.
fn dead_zone(bench: &Bench, model: &Fitted, k: usize) -> Option<String> {
    let candidate = &bench.candidates[model.named[k].candidate];
    let Place::Part(Part::Joint(axis)) = candidate.place else { return None };
    let added = of_model(bench, model, model.named[k]).parameters.first().map(|number| number.value);
    let softens = candidate.kind == &STIFFNESS_NONLINEARITY && added.is_some_and(|added| added < 0.0);
    (softens && !axis_tells_hysteresis(&bench.axes, axis)).then(|| format!("{}@{}", HYSTERESIS.name, candidate.place))
}

/// The name of wild rows, where one of them explains what an effect does.
fn wild_row(bench: &Bench, model: &Fitted, effect: usize) -> Option<String> {
    let rest = all_but(&model.named, effect);
    let off = one_off(bench, &bench.fit(&rest)?)?;
    (off.bic < model.bic + WITHIN_REACH).then(|| format!("{}@{}", OUTLIERS.name, Place::Rig))
}
