//! Putting the result together from a model that stands.

use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use robstiff_robots::effect::Place as Part;

use super::alias::{rivals, same_as, same_as_wild};
use super::bench::Bench;
use super::catalogue::{BASE_SLIP, OUTLIERS};
use super::found::{EffectParameter, Found, Place};
use super::isolated::Event;
use super::model::{Fitted, Setting};
use super::written::{described, values, within_description, without_untold};
use super::{Misfit, NamedEffect, Options, Outcome, PoseError, RowResidual, Trace, Verdict};
use crate::campaign::Campaign;
use crate::identify::displacement::{declared_residuals, declared_rms};
use crate::identify::encoders::EncodersRead;
use crate::identify::normal::{Fit, Sign};
use crate::identify::prepare::Prepared;
use crate::identify::problem::{Block, Problem, rms};
use crate::identify::uncertainty::{covariance, covariance_with};
use crate::identify::{Estimate, NoiseSource, estimates};

/// A tracing in full: errors before and after, the effects with their
/// uncertainty, and the description that says it all.
///
/// # Errors
/// Why a model that was fitted before cannot be again.
pub fn report(
    campaign: &Campaign,
    prepared: &Prepared<'_>,
    bench: &Bench<'_>,
    outcome: &Outcome,
    options: &Options,
) -> Result<Trace, String> {
    // Before anything was corrected, wild rows and all.
    let untouched = Bench::bare(campaign, prepared);
    let all = untouched.at(&[])?;
    let base = all.fit(&[])?;
    let found = &outcome.selection.model;
    // Numbers are told where they fit best, not where a grid has them.
    let polished = bench.polished(&found.named);
    let fine = polished.at(&found.named).and_then(|setting| Ok((setting.fit(&found.named)?, setting)));
    let (model, setting, bench_of_numbers) = match fine {
        Ok((model, setting)) => (model, setting, &polished),
        Err(_) => (found.clone(), bench.at(&found.named)?, bench),
    };
    let model = within_description(campaign, prepared, &setting, &model);
    let written = without_untold(campaign, prepared, bench_of_numbers, &setting, &model);
    let (model, problem) = (&model, &setting.problem);
    let fitted_rows = || all.problem.blocks.iter().flat_map(|block| block.rows.iter().copied());
    let unseen = if all.problem.held_out.is_empty() { &all.problem.blocks } else { &all.problem.held_out };
    let unseen_rows = || unseen.iter().flat_map(|block| block.rows.iter().copied());
    let misfit = |setting: &Setting<'_>, fitted: &Fitted| Misfit {
        rms: rms(
            &setting.residuals(&fitted.fit),
            setting.problem.axes,
            setting.problem.blocks.iter().flat_map(|block| block.rows.iter().copied()),
        ),
        holdout_rms: setting.holdout_rms(&fitted.fit),
    };
    let residual_variance = model.fit.rss / problem.freedom(&model.fit);
    // Repeated readings differ by more than noise where they depend on time or
    // order; a model that accounts for it knows better.
    let (noise, noise_source) = match prepared.noise(residual_variance) {
        (repeated, NoiseSource::Repetitions) if repeated * repeated > residual_variance => {
            (residual_variance.sqrt(), NoiseSource::Residuals)
        }
        // Learnt again without what the effects do.
        (before, NoiseSource::Poses) => (bench.noise.covariance.reading().unwrap_or(before), NoiseSource::Poses),
        known => known,
    };
    let estimates_before = numbers(campaign, prepared, &all, &base, &spread_of(&untouched, &all, &base));
    let spread = spread_of(bench_of_numbers, &setting, model);
    // What is told of the joints, and the errors, are those of what is written.
    let (of_written, written) = written.as_ref().map_or((&setting, model), |(setting, model)| (setting, model));
    let estimates = if written.named == model.named {
        numbers(campaign, prepared, &setting, model, &spread)
    } else {
        numbers(campaign, prepared, of_written, written, &spread_of(bench_of_numbers, of_written, written))
    };
    let mut effects = effects(bench, &setting, model, outcome, &spread, options);
    let holdout_rms = misfit(of_written, written).holdout_rms;
    let slipped = effects.iter_mut().find(|named| named.effect.kind() == BASE_SLIP.name);
    let may_be = if outcome.events.is_empty() { Vec::new() } else { same_as_wild(bench, found, &outcome.events) };
    let isolated = isolated(prepared, outcome, holdout_rms, slipped, &may_be);
    effects.extend(isolated);
    // What a named effect may as well be has shown, if it is there.
    let may_be = |name: &String| effects.iter().any(|named| named.same_as.contains(name));
    let invisible = bench.invisible.iter().filter(|name| !may_be(name)).cloned().collect();
    let held_out = problem.held_out.iter().map(|block| prepared.data.poses[block.pose].clone()).collect();
    let declared =
        Misfit { rms: declared_rms(prepared, fitted_rows()), holdout_rms: declared_rms(prepared, unseen_rows()) };
    // Data that can tell nothing change nothing.
    let (description, after, left_after) = if outcome.verdict == Verdict::Insufficient {
        (campaign.robot.clone(), declared, declared_residuals(prepared))
    } else {
        let values = values(prepared, of_written, written);
        (described(campaign, &values, &effects)?, misfit(of_written, written), of_written.residuals(&written.fit))
    };
    let (residuals, pose_errors) = residuals(prepared, &all, &all.residuals(&base.fit), &left_after);
    let left = outcome.left.as_ref();
    Ok(Trace {
        encoders: EncodersRead::of(prepared.data, &prepared.samples, &bench.noise.covariance),
        robot: campaign.robot.name.clone(),
        rows: prepared.samples.rows.len(),
        poses: prepared.samples.poses,
        held_out,
        noise,
        noise_source,
        declared,
        identified: misfit(&all, &base),
        after,
        verdict: outcome.verdict,
        why: outcome.why.clone(),
        unexplained: left.map_or(0.0, |left| left.fraction),
        depends_on: left.map_or_else(Vec::new, |left| left.depends_on.clone()),
        rivals: if outcome.verdict == Verdict::Insufficient { Vec::new() } else { rivals(bench, found) },
        invisible,
        next: Vec::new(),
        description,
        effects,
        estimates_before,
        estimates,
        steps: outcome.selection.steps.clone(),
        structure: left.map_or_else(Vec::new, |left| left.tests.clone()),
        residuals,
        components: 3,
        differences: true,
        pose_errors,
    })
}

/// The covariance of a model's coefficients, and behind them of the logarithms
/// of its numbers out of grids, in the order of its effects; with what readings
/// may have besides that no column says.
fn spread_of(bench: &Bench<'_>, setting: &Setting<'_>, model: &Fitted) -> DMatrix<f64> {
    let mut signs: Vec<Sign> = model.fit.columns.iter().map(|&column| setting.signs[column]).collect();
    let mut known = std::vec![0.0; signs.len()];
    let mut shapes: Vec<DVector<f64>> = Vec::new();
    let mut unsure: Vec<Vec<DVector<f64>>> = Vec::new();
    for &one in &model.named {
        let variant = setting.variant(one);
        for k in 0..variant.shape.len() {
            if let Some(change) = bench.of_shape(setting, model, one, k) {
                shapes.push(change);
                let spread = variant.likely.map_or(ANYTHING, |[_, spread]| spread);
                known.push(spread.powi(-2));
            }
        }
        if let Some(of) = &variant.unsure {
            let value = |column: &usize| {
                let at = model.fit.columns.iter().position(|c| c == column);
                at.map_or(0.0, |at| model.fit.coefficients[at])
            };
            unsure.push(of(&setting.point, &variant.columns.iter().map(value).collect::<Vec<f64>>()));
        }
    }
    if shapes.is_empty() && unsure.is_empty() {
        let (problem, fit) = setting.alone(&model.fit);
        return covariance(&problem, &fit, &signs);
    }
    let count = model.fit.columns.len() + shapes.len();
    let examples = unsure.iter().flatten().cloned();
    let raw: Vec<DVector<f64>> =
        model.fit.columns.iter().map(|&column| setting.raw(column)).chain(shapes).chain(examples).collect();
    let readings = std::rc::Rc::clone(&setting.problem.readings);
    let samples = &setting.point.samples;
    let problem = Problem::new(samples, DMatrix::from_columns(&raw), readings, &setting.correction, bench.weights());
    let columns: Vec<usize> = (0..count).collect();
    let coefficients = model.fit.coefficients.clone().resize_vertically(count, 0.0);
    signs.resize(count, Sign::Free);
    let fit = Fit { columns, coefficients, rss: model.fit.rss };
    let mut spread = covariance_with(&problem, &fit, &signs, &known);
    let mut next = count;
    for examples in &unsure {
        let shifts = shifts(&problem, &fit, &signs, next..next + examples.len());
        spread += &shifts * shifts.transpose() / examples.len().max(1) as f64;
        next += examples.len();
    }
    spread
}

/// By how much each of some columns would shift the coefficients of a fit, a
/// column each, were it there; those that are held stay.
fn shifts(problem: &Problem, fit: &Fit, signs: &[Sign], examples: core::ops::Range<usize>) -> DMatrix<f64> {
    let free: Vec<usize> =
        (0..fit.columns.len()).filter(|&k| !(signs[k] == Sign::Nonnegative && fit.coefficients[k] == 0.0)).collect();
    let mut shifts = DMatrix::zeros(fit.columns.len(), examples.len());
    let Some(inverse) = problem.total.inverse(&free) else { return shifts };
    for (k, example) in examples.enumerate() {
        let along = DVector::from_fn(free.len(), |i, _| problem.total.gram[(free[i], example)]);
        let shift = &inverse * along;
        free.iter().zip(&shift).for_each(|(&row, &by)| shifts[(row, k)] = by);
    }
    shifts
}

/// A number out of a grid of which nothing is known beforehand is within ten
/// times of what it is, up and down: this many logarithms.
const ANYTHING: f64 = 2.3;

/// The estimates of the description's own numbers in a model.
fn numbers(
    campaign: &Campaign,
    prepared: &Prepared<'_>,
    setting: &Setting<'_>,
    model: &Fitted,
    spread: &DMatrix<f64>,
) -> Vec<Estimate> {
    estimates(
        &campaign.robot,
        (&prepared.own, &prepared.visibility),
        &values(prepared, setting, model),
        &model.fit.columns,
        spread,
    )
}

/// The named effects, the one whose removal costs most first.
fn effects(
    bench: &Bench<'_>,
    setting: &Setting<'_>,
    fine: &Fitted,
    outcome: &Outcome,
    spread: &DMatrix<f64>,
    options: &Options,
) -> Vec<NamedEffect> {
    let model = &outcome.selection.model;
    // Where the numbers out of grids of each effect begin in the covariance.
    let shapes = |k: usize| -> usize {
        let before = model.named[..k].iter().map(|&one| setting.variant(one));
        let refined = before.filter(|variant| variant.refine.is_some());
        fine.fit.columns.len() + refined.map(|variant| variant.shape.len()).sum::<usize>()
    };
    let cost = |k: usize| {
        let mut rest = model.named.clone();
        rest.remove(k);
        bench.fit(&rest).map_or(f64::INFINITY, |without| without.bic)
    };
    let mut order: Vec<(f64, usize)> = (0..model.named.len()).map(|k| (cost(k), k)).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut so_far = Vec::new();
    let named = order.into_iter().map(|(_, k)| {
        let one = model.named[k];
        so_far.push(one);
        so_far.sort_unstable();
        let unseen = |setting: &Setting<'_>| Some(setting.holdout_rms(&setting.fit(&so_far).ok()?.fit));
        let holdout = bench.at(&so_far).ok().and_then(|setting| unseen(&setting)).unwrap_or(f64::NAN);
        let at = |column: &usize| model.fit.columns.iter().position(|c| c == column).expect("its own model has it");
        let variant = setting.variant(one);
        let number = |(k, column): (usize, &usize)| {
            let (number, at) = (&setting.numbers[column - setting.own.len()], at(column));
            let (value, std) = match number.share_of {
                Some(joint) => share_of(setting, fine, spread, at, joint),
                None => (fine.fit.coefficients[at], spread[(at, at)].sqrt()),
            };
            let name = variant.names.get(k).copied().unwrap_or(number.name);
            EffectParameter { name, value, std: Some(std), unit: number.unit }
        };
        let numbers = variant.columns.iter().enumerate().map(number);
        let first = shapes(k);
        let shape = |(s, number): (usize, &EffectParameter)| {
            let known = variant.refine.is_some() && first + s < spread.nrows();
            let std = known.then(|| number.value * spread[(first + s, first + s)].sqrt());
            EffectParameter { std, ..number.clone() }
        };
        let shapes: Vec<EffectParameter> = variant.shape.iter().enumerate().map(shape).collect();
        let parameters = in_order(numbers.collect(), shapes);
        let candidate = &setting.candidates[one.candidate];
        NamedEffect {
            effect: Found::new(candidate.kind, candidate.place, parameters.clone()),
            parameters,
            lines: Vec::new(),
            p_value: outcome.selection.p_values[k],
            holdout_rms: holdout,
            same_as: same_as(bench, model, k, outcome.structure(), options),
            partial: outcome.structure(),
        }
    });
    named.collect()
}

/// Numbers with those out of a grid that go with each, the smallest of these
/// first: fitting may have brought them out of order.
pub(super) fn in_order(numbers: Vec<EffectParameter>, shapes: Vec<EffectParameter>) -> Vec<EffectParameter> {
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

/// A compliance as a share of that of a joint (from 1), with its standard
/// deviation to the first order.
fn share_of(setting: &Setting<'_>, model: &Fitted, spread: &DMatrix<f64>, at: usize, joint: usize) -> (f64, f64) {
    let (value, own) = (model.fit.coefficients[at], setting.joint_value(&model.fit, joint));
    let share = value / own;
    let variance = match model.fit.columns.iter().position(|&column| column == joint - 1) {
        Some(k) => spread[(at, at)] - 2.0 * share * spread[(at, k)] + share * share * spread[(k, k)],
        None => spread[(at, at)],
    };
    (share, variance.max(0.0).sqrt() / own)
}

/// The names of what is wrong in single visits, which some effects may as well be. A
/// robot slips once: several slips are several wild visits, and a slip in the visit that
/// one was found at the end of, or within, is that one.
fn isolated(
    prepared: &Prepared<'_>,
    outcome: &Outcome,
    holdout_rms: f64,
    slipped: Option<&mut NamedEffect>,
    may_be: &[String],
) -> Vec<NamedEffect> {
    let line = |row: &usize| prepared.data.rows[*row].line;
    // First as what is said of single visits.
    let besides = |first: Option<&str>| {
        let others = may_be.iter().filter(|name| first != Some(name.as_str())).cloned();
        first.map(String::from).into_iter().chain(others).collect()
    };
    let one = |effect: Found, lines: Vec<usize>, events: &[&Event], other: Option<&str>| NamedEffect {
        parameters: effect.parameters.clone(),
        effect,
        lines,
        p_value: events.iter().map(|event| event.p_value).fold(0.0, f64::max),
        holdout_rms,
        same_as: besides(other),
        partial: outcome.structure(),
    };
    let (slips, wild): (Vec<&Event>, Vec<&Event>) = outcome.events.iter().partition(|event| event.is_slip);
    let mut found = Vec::new();
    let mut outliers = wild;
    let already = slipped.is_some();
    if let Some(known) = slipped {
        let moment = known.effect.value("line") as usize;
        let lines = |slip: &Event| slip.rows.iter().map(line).collect::<Vec<usize>>();
        for slip in slips {
            let lines = lines(slip);
            let (first, last) = (lines.iter().min(), lines.iter().max());
            match first.zip(last) {
                Some((&first, &last)) if (first..=last + 1).contains(&moment) => known.lines.extend(lines),
                _ => outliers.push(slip),
            }
        }
    } else if let [slip] = slips[..] {
        let number =
            |(name, value): (&'static str, &f64)| EffectParameter { name, value: *value, std: None, unit: "m" };
        let mut parameters: Vec<EffectParameter> =
            ["dx", "dy", "dz"].into_iter().zip(slip.shift.iter()).map(number).collect();
        let first = slip.rows.iter().map(line).min().unwrap_or_default();
        parameters.push(EffectParameter { name: "line", value: first as f64, std: None, unit: "1" });
        let effect = Found::new(&BASE_SLIP, Part::Base.into(), parameters);
        found.push(one(effect, slip.rows.iter().map(line).collect(), &[slip], Some("outliers@rig")));
    } else {
        outliers.extend(slips);
    }
    if !outliers.is_empty() {
        let mut lines: Vec<usize> = outliers.iter().flat_map(|event| event.rows.iter().map(line)).collect();
        lines.sort_unstable();
        let rows = EffectParameter { name: "rows", value: lines.len() as f64, std: None, unit: "1" };
        let effect = Found::new(&OUTLIERS, Place::Rig, std::vec![rows]);
        // One visit alone may as well have been where the robot slipped.
        let slip = (outliers.len() == 1 && !already).then_some("base_slip@base");
        found.push(one(effect, lines, &outliers, slip));
    }
    found
}

fn residuals(
    prepared: &Prepared<'_>,
    setting: &Setting<'_>,
    before: &DVector<f64>,
    after: &DVector<f64>,
) -> (Vec<RowResidual>, Vec<PoseError>) {
    let problem = &setting.problem;
    let three =
        |residuals: &DVector<f64>, row: usize| core::array::from_fn(|axis| residuals[row * problem.axes + axis]);
    let rows = prepared.data.rows.iter().enumerate();
    let rows = rows.map(|(i, row)| RowResidual {
        line: row.line,
        pose: row.pose,
        before: three(before, i),
        after: three(after, i),
    });
    let pose = |block: &Block, held_out| PoseError {
        pose: prepared.data.poses[block.pose].to_string(),
        held_out,
        before: rms(before, problem.axes, block.rows.iter().copied()),
        after: rms(after, problem.axes, block.rows.iter().copied()),
    };
    let trained = problem.blocks.iter().map(|block| pose(block, false));
    let poses = trained.chain(problem.held_out.iter().map(|block| pose(block, true)));
    (rows.collect(), poses.collect())
}
