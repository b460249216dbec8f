//! Putting the result together.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use robstiff_robots::effect::Place as Part;

use super::apart::Apart;
use super::axes::AxisNumber;
use super::bench::Bench;
use super::curves::instead_of_rows;
use super::one_off::one_off;
use super::search::Found as Searched;
use super::slips::{as_good_as_slip, shifts_all};
use super::spread::spread;
use crate::campaign::{Campaign, ClampedRow};
use crate::identify::baseline::{declared, with_values};
use crate::identify::normal::Fit;
use crate::identify::{Error, Estimate, Identification, NoiseSource};
use crate::trace::catalogue::{BASE_SLIP, HYSTERESIS, KINDS, OUTLIERS, STIFFNESS_NONLINEARITY, axis_tells_hysteresis};
use crate::trace::found::{EffectParameter, Found, Place};
use crate::trace::model::{Fitted, Named, all_but};
use crate::trace::selection::WITHIN_REACH;
use crate::trace::verdict::{self, Besides};
use crate::trace::written::{described, fitted_again, in_told_order, taken_by};
use crate::trace::{Misfit, NamedEffect, PoseError, Rival, RowResidual, Trace, Verdict};

/// A tracing in full.
///
/// # Errors
/// Declared effects that do not go with the compliances found.
pub fn report(campaign: &Campaign, identified: &Identification, found: &Searched) -> Result<Trace, Error> {
    let (bench, model) = (&found.bench, &found.selection.model);
    let wild = &found.wild.0;
    let apart = Apart::of(bench, model).filter(|apart| found.too_little.is_none() && apart.is_as_good());
    let (verdict, why) = match &found.too_little {
        Some(why) => (Verdict::Insufficient, why.clone()),
        None => {
            let besides = Besides { isolated: usize::from(!wild.is_empty()), ..Besides::default() };
            let judged = verdict::judge(&found.selection, &found.left, &besides);
            match (judged.0, apart.is_some().then(told_apart).or_else(|| off(bench, model)).or_else(|| many(bench))) {
                (Verdict::Adequate, Some(why)) => (Verdict::Unexplained, why),
                (Verdict::Explained, Some(why)) => (Verdict::Partial, why),
                _ => judged,
            }
        }
    };
    let structure = found.left.structure || found.selection.unnamed;
    let tells = verdict != Verdict::Insufficient;
    // Before anything was left out, wild rows and all.
    let whole = Bench::new(bench.axes.whole(), Some(&bench.offers));
    let base = whole.fit(&[]).unwrap_or_else(|| model.clone());
    let misfit =
        |bench: &Bench, fit: &Fit| Misfit { rms: rms(&bench.residuals(fit)), holdout_rms: bench.left_out_rms(fit) };
    let before = misfit(&whole, &base.fit);
    let as_declared = whole
        .axes
        .rows
        .iter()
        .map(|row| row.deflection - campaign.robot.joints[row.axis - 1].compliance() * row.torque);
    let left_declared = DVector::from_iterator(whole.axes.rows.len(), as_declared);
    let declared = Misfit { rms: rms(&left_declared), holdout_rms: rms(&left_declared) };
    let left_before = whole.residuals(&base.fit);
    // What is told of the axes, and the errors, are those of what is written; the effects that
    // are told are the model's that was found.
    let fewer = without_untold(campaign, bench, model);
    let written = fewer.as_ref().unwrap_or(model);
    // Data that can tell nothing change nothing.
    let (after, left_after) =
        if tells { (misfit(bench, &written.fit), whole.residuals(&written.fit)) } else { (declared, left_declared) };

    let spread_written = spread(bench, written);
    let spread = if fewer.is_some() { spread(bench, model) } else { spread_written.clone() };
    let values = values(campaign, bench, written);
    let effects =
        if tells { effects(found, &spread, structure, after.holdout_rms, apart.as_ref()) } else { Vec::new() };
    let (verdict, why) = match one_more_is_off(bench, model, &effects) {
        Some(why) if verdict == Verdict::Explained => (Verdict::Partial, why),
        _ => (verdict, why),
    };
    let description = match tells {
        true => {
            let own = written.named.iter().map(|&one| of_model(bench, written, one));
            described(campaign, "clamped axes", &values, &in_told_order(own, &effects))?
        }
        false => campaign.robot.clone(),
    };
    let fitted_axes: Vec<usize> = bench.axes.loaded().collect();
    let residual = |(i, row): (usize, &ClampedRow)| RowResidual {
        line: row.line,
        pose: row.axis - 1,
        before: [left_before[i], 0.0, 0.0],
        after: [left_after[i], 0.0, 0.0],
    };
    let error = |&axis: &usize| {
        let of = |left: &DVector<f64>| rms(&left.select_rows(&whole.axes.rows_of(axis)));
        PoseError { pose: format!("axis {axis}"), held_out: false, before: of(&left_before), after: of(&left_after) }
    };
    Ok(Trace {
        encoders: None,
        robot: campaign.robot.name.clone(),
        rows: whole.axes.rows.len(),
        poses: fitted_axes.len(),
        held_out: Vec::new(),
        noise: bench.problem.variance(&model.fit).sqrt(),
        noise_source: NoiseSource::Residuals,
        declared,
        identified: before,
        after,
        verdict,
        why,
        unexplained: found.left.fraction,
        depends_on: if structure { found.left.depends_on.clone() } else { Vec::new() },
        undecided: Vec::new(),
        looks_like: Vec::new(),
        rivals: if tells { rivals(bench, model) } else { Vec::new() },
        invisible: invisible(campaign, bench),
        next: Vec::new(),
        description,
        effects,
        estimates_before: identified.estimates.clone(),
        estimates: estimates(identified, bench, written, &values, &spread_written),
        steps: found.selection.steps.clone(),
        structure: found.left.tests.clone(),
        residuals: whole.axes.rows.iter().enumerate().map(residual).collect(),
        components: 1,
        differences: true,
        pose_errors: fitted_axes.iter().map(error).collect(),
    })
}

/// What is left in readings as they are, over the noise that rows have to themselves, is more than
/// an unloaded reading as noisy as others lets it be.
const SEVERAL: f64 = 4.0;

/// What is off where more is left than noise: all rows of an axis are, which share one
/// unloaded reading.
fn off(bench: &Bench, model: &Fitted) -> Option<String> {
    let left = bench.residuals(&model.fit);
    let noise = bench.problem.variance(&model.fit).sqrt();
    let of_axis = |axis: &usize| rms(&left.select_rows(&bench.axes.rows_of(*axis)));
    let axis = bench.axes.loaded().max_by(|a, b| of_axis(a).total_cmp(&of_axis(b)))?;
    let is_noise = bench.leaves_nothing(&model.fit) || of_axis(&axis) <= SEVERAL * noise;
    (!is_noise).then(|| format!("what is left of axis {axis} is several times the noise: its unloaded reading is off"))
}

/// Of an axis more than this share of the rows, and more than two, are wild for a reason.
const MANY: f64 = 0.15;
const TWO: usize = 2;

/// Which axis has too many wild rows for single accidents.
fn many(bench: &Bench) -> Option<String> {
    let whole = bench.axes.whole();
    bench.axes.loaded().find_map(|axis| {
        let wild = bench.axes.left_out().filter(|row| row.axis == axis).count();
        let rows = whole.rows_of(axis).len();
        let many = wild > TWO && wild as f64 > MANY * rows as f64;
        many.then(|| format!("{wild} of {rows} rows of axis {axis} are wild: they have something in common"))
    })
}

/// How many unloaded readings are off before one more is the likeliest of what looks like it.
const SEVERAL_OFF: usize = 2;

/// Which effect one more unloaded reading that is off may look like, where several are.
fn one_more_is_off(bench: &Bench, model: &Fitted, effects: &[NamedEffect]) -> Option<String> {
    let off = model.named.iter().filter(|&&one| shifts_all(bench, one)).count();
    let slip = slip();
    let other = effects.iter().find(|named| named.effect.to_string() != slip && named.same_as.contains(&slip))?;
    (off >= SEVERAL_OFF).then(|| {
        format!("the unloaded readings of several axes are off, and {} may be one more of them", other.effect.words())
    })
}

fn told_apart() -> String {
    String::from("what all axes share and what each has of its own account for the readings alike")
}

/// The model without effects that a description has a word for but takes at no such numbers,
/// fitted again; `None` where there are none of these.
fn without_untold(campaign: &Campaign, bench: &Bench, model: &Fitted) -> Option<Fitted> {
    let stays = |model: &Fitted| {
        let description = with_values(&campaign.robot, &values(campaign, bench, model));
        taken_by(description, &model.named, |one| of_model(bench, model, one))
    };
    fitted_again(model.named.len(), stays(model), |rest| bench.fit(rest), stays)
}

/// An effect of a model with its numbers alone.
fn of_model(bench: &Bench, model: &Fitted, one: Named) -> Found {
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

/// The estimates of identification with the compliances of a model, whose numbers have a
/// covariance; of an axis that is not loaded as they are.
fn estimates(
    identified: &Identification,
    bench: &Bench,
    model: &Fitted,
    values: &[f64],
    spread: &DMatrix<f64>,
) -> Vec<Estimate> {
    let fitted_axes: Vec<usize> = bench.axes.loaded().collect();
    let of_model = |(i, estimate): (usize, &Estimate)| {
        let at = fitted_axes.iter().position(|&axis| axis == i + 1);
        let std = at.filter(|&k| model.fit.coefficients[k] > 0.0).map(|k| spread[(k, k)].sqrt());
        let clipped = at.is_some() && values[i] == 0.0;
        let std = std.or(estimate.std.filter(|_| !clipped));
        let at_bound = clipped && estimate.declared > 0.0;
        Estimate { value: values[i], std, at_bound, ..estimate.clone() }
    };
    identified.estimates.iter().enumerate().map(of_model).collect()
}

/// Other models of as many effects that are about as good, the best first, but those whose names
/// are the same: slips of several axes have one.
fn rivals(bench: &Bench, model: &Fitted) -> Vec<Rival> {
    let names =
        |of: &Fitted| -> Vec<String> { of.named.iter().map(|one| bench.candidates[one.candidate].name()).collect() };
    let own = names(model);
    let within = bench.replaced(&model.named).into_iter().filter(|(_, other)| other.bic < model.bic + WITHIN_REACH);
    let mut rivals: Vec<Rival> = within
        .map(|(_, other)| Rival { names: names(&other), bic_difference: other.bic - model.bic })
        .filter(|rival| rival.names != own)
        .collect();
    rivals.sort_by(|a, b| a.bic_difference.total_cmp(&b.bic_difference));
    rivals
}

fn rms(residuals: &DVector<f64>) -> f64 {
    (residuals.norm_squared() / residuals.len().max(1) as f64).sqrt()
}

/// The description's numbers in a model.
fn values(campaign: &Campaign, bench: &Bench, model: &Fitted) -> Vec<f64> {
    let mut values: Vec<f64> = declared(&campaign.robot).iter().map(|number| number.value).collect();
    for (axis, &value) in bench.axes.loaded().zip(model.fit.coefficients.iter()) {
        values[axis - 1] = value;
    }
    values
}

/// The effects that were found, that without which the criterion is worst first, with what the
/// data cannot tell them from; and behind them the wild rows.
fn effects(
    found: &Searched,
    spread: &DMatrix<f64>,
    partial: bool,
    holdout_rms: f64,
    apart: Option<&Apart>,
) -> Vec<NamedEffect> {
    let (bench, model) = (&found.bench, &found.selection.model);
    let replaced = bench.replaced(&model.named);
    let all = with_spread(bench, model, spread);
    let without = |k: usize| bench.fit(&all_but(&model.named, k)).map_or(f64::INFINITY, |without| without.bic);
    let mut costs: Vec<(f64, usize)> = (0..all.len()).map(|k| (without(k), k)).collect();
    costs.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut so_far = Vec::new();
    let whole = costs.into_iter().map(|(_, k)| {
        so_far.push(model.named[k]);
        so_far.sort_unstable();
        NamedEffect {
            effect: all[k].clone(),
            lines: Vec::new(),
            p_value: found.selection.p_values[k],
            holdout_rms: bench.fit(&so_far).map_or(holdout_rms, |so_far| bench.left_out_rms(&so_far.fit)),
            in_part: Vec::new(),
            same_as: same_as(bench, model, k, &replaced, apart.filter(|apart| apart.shared == k)),
            partial,
        }
    });
    let mut named: Vec<NamedEffect> = whole.collect();
    let (lines, p_value) = &found.wild;
    if !lines.is_empty() {
        let mut lines = lines.clone();
        lines.sort_unstable();
        let effect = Found::outliers(lines.len());
        let slip = slip_before_last(bench, &lines);
        // Of several rows it is one.
        let (mut same_as, mut in_part) = if lines.len() > 1 { (Vec::new(), slip) } else { (slip, Vec::new()) };
        let (curves, all) = instead_of_rows(bench, model, &lines);
        if all { &mut same_as } else { &mut in_part }.extend(curves);
        named.push(NamedEffect { effect, lines, p_value: *p_value, holdout_rms, same_as, in_part, partial });
    }
    named
}

/// The effects of a model with the uncertainty of their numbers. `spread` is the covariance of the
/// axes' compliances, then of the numbers of each effect that enter linearly, in the order of
/// the model, and then of the logarithms of their shapes.
fn with_spread(bench: &Bench, model: &Fitted, spread: &DMatrix<f64>) -> Vec<Found> {
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
/// one in the place of each.
fn same_as(
    bench: &Bench,
    model: &Fitted,
    k: usize,
    replaced: &[(usize, Fitted)],
    apart: Option<&Apart>,
) -> Vec<String> {
    let candidate = &bench.candidates[model.named[k].candidate];
    let near = replaced.iter().filter(|(of, other)| *of == k && other.bic < model.bic + WITHIN_REACH);
    let in_its_place = |(_, other): &(usize, Fitted)| {
        let new = other.named.iter().find(|new| model.named.iter().all(|old| old.candidate != new.candidate))?;
        Some(bench.candidates[new.candidate].name())
    };
    let names = near.filter_map(in_its_place).chain(dead_zone(bench, model, k));
    let names = names.chain(apart.into_iter().flat_map(|apart| apart.names.iter().cloned()));
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
fn slip() -> String {
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

/// What clamped axes do not show: what is at another place than the loaded axis,
/// and what needs more rows of it.
fn invisible(campaign: &Campaign, bench: &Bench) -> Vec<String> {
    let offered: Vec<String> = bench.candidates.iter().map(crate::trace::catalogue::Candidate::name).collect();
    let joints = campaign.robot.joints.len();
    let declared = |name: &String| campaign.robot.effects.iter().any(|effect| effect.to_string() == *name);
    let mut names = Vec::new();
    for kind in KINDS.iter().filter(|kind| **kind != &OUTLIERS) {
        names.extend(kind.places(joints).into_iter().map(|place| format!("{}@{place}", kind.name)));
    }
    names.retain(|name| !offered.contains(name) && !declared(name));
    names
}
