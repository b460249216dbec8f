//! Putting the result together from a model that stands.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use robstiff_robots::Description;

use super::alias::same_as;
use super::candidate::with_numbers;
use super::model::{Fitted, Setting};
use super::selection::Selection;
use super::{EffectParameter, Found, Misfit, NamedEffect, Options, PoseError, RowResidual, Trace, Verdict};
use crate::campaign::Campaign;
use crate::identify::baseline::{sign_of, with_values};
use crate::identify::displacement::{declared_residuals, declared_rms};
use crate::identify::normal::Sign;
use crate::identify::prepare::Prepared;
use crate::identify::problem::{Block, Problem, rms};
use crate::identify::samples::Column;
use crate::identify::uncertainty::covariance;
use crate::identify::{Estimate, estimates, parameter_name, unit_of};

/// A tracing in full: errors before and after, the effects with their
/// uncertainty, and the description that says it all.
pub fn report(
    campaign: &Campaign,
    prepared: &Prepared<'_>,
    setting: &Setting,
    found: &Found,
    options: &Options,
) -> Trace {
    let (problem, model) = (&setting.problem, &found.selection.model);
    let base = setting.fit(&[]).expect("the description's own numbers were fitted before");
    let fitted_rows = || problem.blocks.iter().flat_map(|block| block.rows.iter().copied());
    let unseen_rows = || if problem.held_out.is_empty() { &problem.blocks } else { &problem.held_out };
    let misfit = |fitted: &Fitted| Misfit {
        rms: rms(&problem.residuals(&fitted.fit.columns, &fitted.fit.coefficients), problem.axes, fitted_rows()),
        holdout_rms: setting.holdout_rms(&fitted.fit),
    };
    let residual_variance = model.fit.rss / problem.total.rows.saturating_sub(model.fit.columns.len()).max(1) as f64;
    let (noise, noise_source) = prepared.noise(residual_variance);
    let (estimates_before, _) = numbers(campaign, prepared, setting, &base);
    let (estimates, spread) = numbers(campaign, prepared, setting, model);
    let structure = found.left.as_ref().is_some_and(|left| left.structure) || found.selection.unnamed;
    let effects = effects(campaign, setting, &found.selection, &spread, structure, options);
    let values: Vec<f64> = estimates.iter().map(|estimate| estimate.value).collect();
    let held_out = problem.held_out.iter().map(|block| prepared.data.poses[block.pose].clone()).collect();
    let left = |fitted: &Fitted| problem.residuals(&fitted.fit.columns, &fitted.fit.coefficients);
    let declared = Misfit {
        rms: declared_rms(prepared, problem, fitted_rows()),
        holdout_rms: declared_rms(prepared, problem, unseen_rows().iter().flat_map(|b| b.rows.iter().copied())),
    };
    // Data that can tell nothing change nothing.
    let (description, after, left_after) = if found.verdict == Verdict::Insufficient {
        (campaign.robot.clone(), declared, declared_residuals(prepared, problem))
    } else {
        (described(campaign, &values, &effects), misfit(model), left(model))
    };
    let (residuals, pose_errors) = residuals(prepared, problem, &left(&base), &left_after);
    Trace {
        robot: campaign.robot.name.clone(),
        rows: prepared.samples.rows.len(),
        poses: prepared.samples.poses,
        held_out,
        noise,
        noise_source,
        declared,
        identified: misfit(&base),
        after,
        verdict: found.verdict,
        why: found.why.clone(),
        unexplained: found.left.as_ref().map_or(0.0, |left| left.fraction),
        depends_on: found.left.as_ref().map_or_else(Vec::new, |left| left.depends_on.clone()),
        next: Vec::new(),
        description,
        effects,
        estimates_before,
        estimates,
        steps: found.selection.steps.clone(),
        structure: found.left.as_ref().map_or_else(Vec::new, |left| left.tests.clone()),
        residuals,
        pose_errors,
    }
}

/// The estimates of the description's own numbers in a model, and the
/// covariance of all its coefficients.
fn numbers(
    campaign: &Campaign,
    prepared: &Prepared<'_>,
    setting: &Setting,
    model: &Fitted,
) -> (Vec<Estimate>, DMatrix<f64>) {
    let signs: Vec<Sign> = model.fit.columns.iter().map(|&column| setting.signs[column]).collect();
    let spread = covariance(&setting.problem, &model.fit, &signs);
    let mut values = prepared.values.clone();
    for (&column, &value) in model.fit.columns.iter().zip(model.fit.coefficients.iter()) {
        if column < setting.own {
            values[column] = value;
        }
    }
    (estimates(&campaign.robot, prepared, &values, &model.fit.columns, &spread), spread)
}

/// The named effects, the one whose removal costs most first.
fn effects(
    campaign: &Campaign,
    setting: &Setting,
    selection: &Selection,
    spread: &DMatrix<f64>,
    partial: bool,
    options: &Options,
) -> Vec<NamedEffect> {
    let model = &selection.model;
    let cost = |k: usize| {
        let mut rest = model.named.clone();
        rest.remove(k);
        setting.fit(&rest).map_or(f64::INFINITY, |without| without.bic)
    };
    let mut order: Vec<(f64, usize)> = (0..model.named.len()).map(|k| (cost(k), k)).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut so_far = Vec::new();
    let named = order.into_iter().map(|(_, k)| {
        let one = model.named[k];
        so_far.push(one);
        so_far.sort_unstable();
        let holdout = setting.fit(&so_far).map_or(f64::NAN, |fitted| setting.holdout_rms(&fitted.fit));
        let columns = &setting.variant(one).columns;
        let at = |column: &usize| model.fit.columns.iter().position(|c| c == column).expect("its own model has it");
        let found: Vec<(Column, f64)> = columns
            .iter()
            .map(|column| (setting.problem.columns[*column], model.fit.coefficients[at(column)]))
            .collect();
        let mut parameters: Vec<EffectParameter> = columns
            .iter()
            .zip(&found)
            .map(|(index, &(column, value))| {
                let std = spread[(at(index), at(index))].sqrt();
                let unit = unit_of(&campaign.robot, column);
                EffectParameter { name: told(column), value, std: Some(std), unit }
            })
            .collect();
        if let [(Column::Knee { knee, .. }, _)] = found[..] {
            parameters.push(EffectParameter { name: "knee", value: knee, std: None, unit: "Nm" });
        }
        NamedEffect {
            effect: with_numbers(&setting.candidates[one.candidate].effect, &found),
            parameters,
            p_value: selection.p_values[k],
            holdout_rms: holdout,
            same_as: same_as(setting, model, k, options),
            partial,
        }
    });
    named.collect()
}

/// What a result calls a column's number: a sole compliance is `h`.
fn told(column: Column) -> &'static str {
    match parameter_name(column) {
        "value" if sign_of(column) == Sign::Nonnegative => "h",
        name => name,
    }
}

/// The description with identified numbers and named effects, which says so.
fn described(campaign: &Campaign, values: &[f64], effects: &[NamedEffect]) -> Description {
    let mut description = with_values(&campaign.robot, values);
    description.effects.extend(effects.iter().map(|named| named.effect));
    let names: Vec<String> = effects.iter().map(|named| named.effect.to_string()).collect();
    let added = if names.is_empty() { String::new() } else { format!(", with {}", names.join(", ")) };
    let campaign = if campaign.name.is_empty() { "a campaign" } else { &campaign.name };
    let separator = if description.source.is_empty() { "" } else { "\n" };
    description.source =
        format!("{}{separator}Compliances identified from {campaign}{added}.", description.source.trim_end());
    description
}

fn residuals(
    prepared: &Prepared<'_>,
    problem: &Problem,
    before: &DVector<f64>,
    after: &DVector<f64>,
) -> (Vec<RowResidual>, Vec<PoseError>) {
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
