//! The effects of a model, and its wild rows, as they are told.

use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::DMatrix;

use crate::campaign::Campaign;
use crate::identify::positions::regression::STANDS;
use crate::trace::NamedEffect;
use crate::trace::catalogue::Variant;
use crate::trace::found::{EffectParameter, Found};
use crate::trace::model::{Named, all_but};
use crate::trace::order::costliest_first;
use crate::trace::positions::bench::{Bench, Model, Proposed};
use crate::trace::positions::search::Searched;
use crate::trace::positions::unseen::unseen_rms;
use crate::trace::positions::weight::{self, SAG};
use crate::trace::selection::WITHIN_REACH;

/// The named effects, the one without which most is left first: each with the error on
/// unseen poses (m) that it and those before it leave; wild readings come last. `replaced` are the
/// models with another one in the place of each.
pub fn effects(
    campaign: &Campaign,
    found: &Searched<'_>,
    replaced: &[(usize, Proposed)],
    spread: &DMatrix<f64>,
    undecided: &[usize],
    (partial, holdout_rms): (bool, f64),
) -> Vec<NamedEffect> {
    let (bench, model) = (&found.bench, &found.model);
    let weight = weight::in_place(bench, &campaign.robot, model);
    let mut so_far = Vec::new();
    let by_cost = costliest_first(&model.named, |rest| Some(bench.solve(rest, &model.solved.state)?.solved.fit.rss));
    let named = by_cost.into_iter().map(|k| {
        so_far.push(model.named[k]);
        so_far.sort_unstable();
        let smaller = bench.solve(&so_far, &model.solved.state);
        let candidate = &bench.candidates[model.named[k].candidate];
        let parameters = parameters(bench, model, spread, k);
        let value = parameters.first().map_or(0.0, |number| number.value);
        NamedEffect {
            effect: Found::new(candidate.kind, candidate.place, parameters),
            lines: Vec::new(),
            p_value: found.selection.p_values[k],
            holdout_rms: smaller.map_or(holdout_rms, |smaller| unseen_rms(bench, &smaller, undecided)),
            same_as: same_as(bench, model, k, value, replaced, weight[k]),
            in_part: Vec::new(),
            partial,
        }
    });
    named.chain(wild_rows(found, partial, holdout_rms)).collect()
}

/// The numbers of effect `k` of a model, with their standard deviations.
pub fn parameters(bench: &Bench<'_>, model: &Model, spread: &DMatrix<f64>, k: usize) -> Vec<EffectParameter> {
    let one = model.named[k];
    let form = bench.variant(one);
    let chosen = bench.chosen(&model.named);
    let of_column = |column: &usize| {
        let number = column - STANDS;
        let at = chosen.iter().position(|&of| of == number).expect("a model has its own numbers");
        let about = &bench.numbers[number - bench.prepared.own.len()];
        let value = model.solved.fit.coefficients[STANDS + at];
        EffectParameter { name: about.name, value, std: Some(spread[(at, at)].sqrt()), unit: about.unit }
    };
    // Numbers out of grids come behind the others.
    let shaped = bench.shape_columns(model);
    let at = shaped.iter().position(|(other, _)| *other == one).map(|place| chosen.len() + place);
    let std = at.and_then(|at| spread.get((at, at))).map(|variance| variance.sqrt());
    let of_shape = form.shape.iter().map(|number| EffectParameter { std, ..number.clone() });
    form.columns.iter().map(of_column).chain(of_shape).collect()
}

/// The wild rows, if there are any.
fn wild_rows(found: &Searched<'_>, partial: bool, holdout_rms: f64) -> Option<NamedEffect> {
    let mut lines: Vec<usize> = found.wild.rows.iter().map(|&row| found.bench.prepared.data.rows[row].line).collect();
    lines.sort_unstable();
    let (effect, p_value) = (Found::outliers(lines.len()), found.wild.p);
    let named = NamedEffect { effect, lines, p_value, holdout_rms, same_as: Vec::new(), in_part: Vec::new(), partial };
    (!named.lines.is_empty()).then_some(named)
}

/// Full names of what these positions do not tell effect `k` of a model from, whose first
/// number has this value; `weight` is what weight in its place leaves (m^2), if it can be.
fn same_as(
    bench: &Bench<'_>,
    model: &Model,
    k: usize,
    value: f64,
    replaced: &[(usize, Proposed)],
    weight: Option<f64>,
) -> Vec<String> {
    let one = model.named[k];
    let near = replaced.iter().filter(|(of, other)| *of == k && alike(bench, model, other.rss));
    let near = near.flat_map(|(_, other)| new_in(&other.named, &model.named));
    let twin = bench.twin(one).filter(|_| bench.may_be_its_twin(one, value));
    let name = |candidate: usize| bench.candidates[candidate].name();
    let mut names: Vec<String> = near.map(name).collect();
    for other in twin.into_iter().chain(parts(bench, &all_but(&model.named, k), one)).map(name) {
        if !names.contains(&other) {
            names.push(other);
        }
    }
    let is_sag = name(one.candidate) == SAG || names.iter().any(|name| name == SAG);
    if !is_sag && weight.is_some_and(|rss| alike(bench, model, rss)) {
        names.push(SAG.to_string());
    }
    names
}

/// The candidates that an effect of several numbers says as well, beside the rest of the
/// model: it may be one of these, or some together.
pub fn parts(bench: &Bench<'_>, rest: &[Named], one: Named) -> Vec<usize> {
    let whole = bench.variant(one);
    if whole.columns.len() == 1 {
        return Vec::new();
    }
    let Some(test) = bench.test(rest) else { return Vec::new() };
    let other = |candidate: &usize| {
        *candidate != one.candidate && rest.iter().all(|named| named.candidate != *candidate) && bench.shows(*candidate)
    };
    let within = |candidate: &usize| {
        let forms = &bench.candidates[*candidate].variants;
        // What shows nothing is within everything.
        let seen = |form: &&Variant| form.columns.iter().all(|&column| bench.is_seen(column));
        forms.iter().filter(seen).any(|form| test.distance(form, whole) < SAME)
    };
    (0..bench.candidates.len()).filter(other).filter(within).collect()
}

/// What is left of a column with less than this beside others says nothing else.
const SAME: f64 = 1e-4;

/// Whether a model that leaves so much fits about as well, numbers not counted: what
/// has more of them says the same and more.
fn alike(bench: &Bench<'_>, model: &Model, rss: f64) -> bool {
    let readings = model.solved.problem.total.rows as f64;
    readings * (rss / bench.rss(&model.named).unwrap_or(model.solved.fit.rss)).ln() < WITHIN_REACH
}

/// The candidates of a model that another has not.
fn new_in<'a>(named: &'a [Named], other: &'a [Named]) -> impl Iterator<Item = usize> + 'a {
    let is_new = |one: &&Named| other.iter().all(|old| old.candidate != one.candidate);
    named.iter().filter(is_new).map(|one| one.candidate)
}
