//! Putting the result together from a model that stands.

pub mod named;
mod spread;
mod worth;

use std::format;
use std::rc::Rc;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use robstiff_robots::effect::physics::MOST_DEVIATION;

use self::named::{effects, isolated};
use self::spread::spread_of;
use self::worth::worth_naming;
use super::alias::{rivals, same_as_wild, swaps};
use super::bench::Bench;
use super::catalogue::TRANSMISSION_ERROR;
use super::confounded::{aliases, tell};
use super::found::Found;
use super::model::{Fitted, Setting};
use super::search::Outcome;
use super::written::{described, own_effects, values, within_description, without_untold};
use super::{Misfit, NamedEffect, Options, PoseError, RowResidual, Trace, Verdict};
use crate::campaign::Campaign;
use crate::identify::displacement::{declared_residuals, declared_rms};
use crate::identify::encoders::EncodersRead;
use crate::identify::prepare::Prepared;
use crate::identify::problem::{Block, Equations, rms};
use crate::identify::{Error, Estimate, NoiseSource, Visibility, estimates};

/// A tracing in full: errors before and after, the effects with their
/// uncertainty, and the description that says it all.
///
/// # Errors
/// Why a model that was fitted before cannot be again.
pub fn report(
    campaign: &Campaign,
    prepared: &Prepared<'_>,
    bench: &Bench<'_>,
    outcome: Outcome,
    options: &Options,
) -> Result<Trace, Error> {
    let outcome = &worth_naming(campaign, prepared, bench, outcome, options).map_err(Error::NotShown)?;
    // Before anything was corrected, wild rows and all.
    let untouched = Bench::bare(campaign, prepared);
    let all = untouched.at(&[]).map_err(Error::NotShown)?;
    let base = all.fit(&[]).map_err(Error::NotShown)?;
    let polished = bench.polished(&outcome.selection.model.named);
    let (bench_of_numbers, setting, model) =
        where_it_fits_best(bench, &polished, &outcome.selection.model).map_err(Error::NotShown)?;
    let model = &within_description(campaign, prepared, &setting, &model);
    let written = without_untold(campaign, prepared, bench_of_numbers, &setting, model);
    let spread = spread_of(bench_of_numbers, &setting, model);
    // What is told of the joints, and the errors, are those of what is written; the effects
    // that are told are the model's that was found.
    let (of_written, written) = written.as_ref().map_or((&setting, model), |(setting, model)| (setting, model));
    let estimates = if written.named == model.named {
        numbers(campaign, prepared, &setting, model, &spread)
    } else {
        numbers(campaign, prepared, of_written, written, &spread_of(bench_of_numbers, of_written, written))
    };
    let aliases = aliases(prepared, &setting, model);
    let undecided = setting.undecided(&model.named);
    let after = misfit(of_written, written, &undecided);
    let swaps = swaps(bench, &outcome.selection.model, &outcome.events);
    let of_numbers = (&spread, &aliases[..], &swaps[..]);
    let mut effects = effects(bench, &setting, model, outcome, of_numbers, (&undecided, after.holdout_rms), options);
    let slipped = effects.iter_mut().find(|named| named.effect.slipping().is_some());
    let may_be = same_as_wild(bench, &outcome.selection.model, &outcome.events);
    let isolated = isolated(prepared, outcome, after.holdout_rms, slipped, &may_be);
    effects.extend(isolated);
    let tells = outcome.verdict != Verdict::Insufficient;
    let declared = declared(prepared, &all.problem, &undecided);
    // Data that can tell nothing change nothing.
    let (description, after, left_after) = match tells {
        true => {
            let values = values(prepared, of_written, written);
            let own = own_effects(of_written, written, &effects);
            (described(campaign, "a campaign", &values, &own)?, after, of_written.residuals(&written.fit))
        }
        false => (campaign.robot.clone(), declared, declared_residuals(prepared)),
    };
    let (residuals, pose_errors) = residuals(prepared, &all, &all.residuals(&base.fit), &left_after);
    let (noise, noise_source) = noise(prepared, bench, setting.problem.variance(&model.fit));
    let left = outcome.left.as_ref();
    let (verdict, why) = match more_than_a_gear_errs(&effects) {
        Some(why) if outcome.verdict == Verdict::Explained => (Verdict::Partial, why),
        _ => (outcome.verdict, outcome.why.clone()),
    };
    Ok(Trace {
        encoders: EncodersRead::of(prepared.data, &prepared.samples, &bench.noise.covariance),
        robot: campaign.robot.name.clone(),
        rows: prepared.samples.rows.len(),
        poses: prepared.samples.poses,
        held_out: setting.problem.held_out.iter().map(|block| prepared.data.poses[block.pose].clone()).collect(),
        undecided: undecided.iter().map(|&row| prepared.data.rows[row].line).collect(),
        noise,
        noise_source,
        declared,
        identified: misfit(&all, &base, &undecided),
        after,
        verdict,
        why,
        unexplained: left.map_or(0.0, |left| left.fraction),
        depends_on: left.map_or_else(Vec::new, |left| left.depends_on.clone()),
        looks_like: outcome.looks_like.clone(),
        rivals: if tells { rivals(bench, &swaps, outcome.rival.as_ref()) } else { Vec::new() },
        invisible: invisible(bench, &effects),
        next: Vec::new(),
        description,
        effects,
        estimates_before: numbers(campaign, prepared, &all, &base, &spread_of(&untouched, &all, &base)),
        estimates,
        steps: outcome.selection.steps.clone(),
        structure: left.map_or_else(Vec::new, |left| left.tests.clone()),
        residuals,
        components: 3,
        differences: true,
        pose_errors,
    })
}

/// What is the matter where an angle is off in waves by more than any gear errs and any
/// description takes: the column says something else, whatever fits.
fn more_than_a_gear_errs(effects: &[NamedEffect]) -> Option<String> {
    let wave = |effect: &Found| effect.value("sin").hypot(effect.value("cos"));
    let mut waves = effects.iter().map(|named| &named.effect).filter(|effect| effect.is(&TRANSMISSION_ERROR));
    let effect = waves.find(|effect| wave(effect) > MOST_DEVIATION)?;
    Some(format!(
        "no gear errs by as much as {:.0} mrad: the column of the angle of {} may be in another unit, scaled, or that \
         of another joint",
        1e3 * wave(effect),
        effect.place()
    ))
}

/// Numbers are told where they fit best, not where a grid has them: a model that was found
/// at its setting, and the bench of that.
fn where_it_fits_best<'b, 'c>(
    bench: &'b Bench<'c>,
    polished: &'b Bench<'c>,
    found: &Fitted,
) -> Result<(&'b Bench<'c>, Rc<Setting<'c>>, Fitted), String> {
    let fine = polished.at(&found.named).and_then(|setting| Ok((setting.fit(&found.named)?, setting)));
    match fine {
        Ok((model, setting)) => Ok((polished, setting, model)),
        Err(_) => Ok((bench, bench.at(&found.named)?, found.clone())),
    }
}

/// How far off the description is as it is declared, on unseen poses but for some rows.
fn declared(prepared: &Prepared<'_>, problem: &Equations, but: &[usize]) -> Misfit {
    let rows = |blocks: &'_ [Block]| blocks.iter().flat_map(|block| block.rows.clone()).collect::<Vec<usize>>();
    let fitted_to = declared_rms(prepared, rows(&problem.blocks));
    let unseen = rows(&problem.held_out).into_iter().filter(|row| !but.contains(row));
    let holdout_rms = if problem.held_out.is_empty() { fitted_to } else { declared_rms(prepared, unseen) };
    Misfit { rms: fitted_to, holdout_rms }
}

/// Full names of what could not be seen. What a named effect may as well be has shown, if it
/// is there.
fn invisible(bench: &Bench<'_>, effects: &[NamedEffect]) -> Vec<String> {
    let may_be = |name: &String| effects.iter().any(|named| named.same_as.contains(name));
    bench.invisible.iter().filter(|name| !may_be(name)).cloned().collect()
}

/// How far off a model is at its setting, on unseen poses but for some rows.
fn misfit(setting: &Setting<'_>, model: &Fitted, but: &[usize]) -> Misfit {
    Misfit { rms: setting.fitted_rms(&model.fit), holdout_rms: setting.holdout_rms(&model.fit, but) }
}

/// The noise of one reading (m), and where it is known from, by the variance of what the
/// model leaves (m^2).
fn noise(prepared: &Prepared<'_>, bench: &Bench<'_>, residual_variance: f64) -> (f64, NoiseSource) {
    match prepared.noise(residual_variance) {
        // Learnt again without what the effects do: repeated readings differ by more than noise where
        // they depend on time or order.
        (before, source @ (NoiseSource::Repetitions | NoiseSource::Poses)) => {
            (bench.noise.covariance.reading().unwrap_or(before), source)
        }
        known => known,
    }
}

/// The estimates of the description's own numbers in a model.
fn numbers(
    campaign: &Campaign,
    prepared: &Prepared<'_>,
    setting: &Setting<'_>,
    model: &Fitted,
    spread: &DMatrix<f64>,
) -> Vec<Estimate> {
    let mut visibility = prepared.visibility.clone();
    for (column, visibility) in visibility.iter_mut().enumerate() {
        // Held, for the model does not tell it from what was declared.
        if *visibility == Visibility::Seen && !model.fit.columns.contains(&column) {
            *visibility = Visibility::Unseen;
        }
    }
    let columns = &model.fit.columns;
    let values = values(prepared, setting, model);
    let mut estimates = estimates(&campaign.robot, (&prepared.own, &visibility), &values, columns, spread);
    tell(&mut estimates, &aliases(prepared, setting, model), |own| columns.iter().position(|&column| column == own));
    estimates
}

/// What is left of each row and of each pose before and after, given stacked, in the base
/// frame (m).
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
