//! Putting the result together.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Vector3};

use super::bench::{Bench, Model, Proposed};
use super::search::Searched;
use super::spread::{spread_as_declared, spread_of};
use super::unseen::{undecided, unseen, unseen_rms};
use super::weight::{self, SAG};
use super::written::{described, own_effects, without_untold};
use crate::campaign::{Campaign, PositionRow};
use crate::identify::misread::{NOISIEST, apart, in_positions};
use crate::identify::positions::regression::STANDS;
use crate::identify::positions::{estimated, residuals};
use crate::identify::problem::rms;
use crate::identify::{Error, NoiseSource};
use crate::trace::catalogue::{KINDS, Kind, Variant};
use crate::trace::found::{EffectParameter, Found};
use crate::trace::held_out;
use crate::trace::model::{Named, all_but};
use crate::trace::selection::WITHIN_REACH;
use crate::trace::verdict::{self, Besides};
use crate::trace::{Misfit, NamedEffect, Options, PoseError, Rival, RowResidual, Trace, Verdict};

/// A tracing in full.
///
/// # Errors
/// Compliances that no description takes beside its own effects.
pub fn report(campaign: &Campaign, found: &Searched<'_>, options: &Options) -> Result<Trace, Error> {
    let (bench, model, base) = (&found.bench, &found.model, &found.base);
    let data = bench.prepared.data;
    let mut left = found.left.clone();
    let nothing = found.too_little.clone().map(|why| (why, Vec::new()));
    let (mut verdict, mut why, looks_like) = match nothing.or_else(|| no_noise(campaign, bench, model)) {
        Some((why, mistakes)) => (Verdict::Insufficient, why, mistakes),
        None => {
            let looks_like = found.looks_like.clone();
            let besides = Besides {
                isolated: usize::from(!found.wild.rows.is_empty()),
                taken_back: &found.taken_back,
                looks_like: &looks_like,
                ..Besides::default()
            };
            let (verdict, why) = verdict::judge(&found.selection, &left, &besides);
            (verdict, why, looks_like)
        }
    };
    let tells = verdict != Verdict::Insufficient;
    let undecided = undecided(bench, model);
    if let Some(test) = unseen(model, &undecided, options).filter(|_| tells)
        && let Some(judged) = held_out::judged(test, verdict, &mut left, options)
    {
        (verdict, why) = judged;
    }
    let structure = left.structure || found.selection.unnamed;
    // What is told of the joints, and the errors, are those of what is written; the effects
    // that are told are the model's that was found.
    let fewer = without_untold(campaign, bench, model);
    let written = fewer.as_ref().unwrap_or(model);
    let Errors { declared, identified, after, left: [left_before, left_after] } =
        errors(campaign, found, (written, tells), &undecided);
    let values = bench.prepared.values(&written.solved.state);
    let (spread_before, spread) = (spread_as_declared(base), spread_of(bench, model));
    let spread_written = if fewer.is_some() { spread_of(bench, written) } else { spread.clone() };
    let replaced = if tells { bench.replaced(&model.named) } else { Vec::new() };
    let effects = if tells {
        effects(campaign, found, &replaced, &spread, &undecided, (structure, after.holdout_rms))
    } else {
        Vec::new()
    };
    why.extend(weight::how_to_tell(&effects));
    let description = match tells {
        true => described(campaign, bench, &values, &own_effects(bench, written, &effects))?,
        false => campaign.robot.clone(),
    };
    let kept_back = data.poses.iter().zip(bench.rows.training.iter()).filter(|(_, training)| !**training);
    let (noise, noise_source) = match campaign.noise_of_reading() {
        Some(noise) => (noise, NoiseSource::of_declared(campaign)),
        None => (model.solved.problem.variance(&model.solved.fit).sqrt(), NoiseSource::Residuals),
    };
    let values_before = bench.prepared.values(&base.solved.state);
    Ok(Trace {
        encoders: None,
        robot: campaign.robot.name.clone(),
        rows: data.rows.len(),
        poses: data.poses.len(),
        undecided: undecided.iter().map(|&row| data.rows[row].line).collect(),
        held_out: kept_back.map(|(id, _)| id.clone()).collect(),
        noise,
        noise_source,
        declared,
        identified,
        after,
        verdict,
        why,
        unexplained: left.fraction,
        depends_on: if structure { left.depends_on } else { Vec::new() },
        looks_like,
        rivals: rivals(found, &replaced),
        invisible: invisible(campaign, bench),
        next: Vec::new(),
        estimates_before: estimated(&bench.prepared, &values_before, &spread_before),
        estimates: match tells {
            true => estimated(&bench.prepared, &values, &spread_written),
            false => estimated(&bench.prepared, &values_before, &spread_before),
        },
        description,
        effects,
        steps: found.selection.steps.clone(),
        structure: left.tests,
        residuals: row_residuals(bench, written, [&left_before, &left_after]),
        components: 3,
        differences: false,
        pose_errors: pose_errors(bench, [&left_before, &left_after]),
    })
}

/// How far off the models of a tracing are.
struct Errors {
    declared: Misfit,
    identified: Misfit,
    /// With the effects; as declared where the data cannot tell.
    after: Misfit,
    /// What is left of the readings with the numbers identified again, and after, stacked (m).
    left: [DVector<f64>; 2],
}

fn errors(campaign: &Campaign, found: &Searched<'_>, (written, tells): (&Model, bool), undecided: &[usize]) -> Errors {
    let (bench, base) = (&found.bench, &found.base);
    let (data, training) = (bench.prepared.data, &bench.rows.training);
    let rows = || 0..data.rows.len();
    let is_fitted_to = |row: &usize| training[data.rows[*row].pose];
    let left_declared = bench.prepared.declared_residuals(campaign);
    let rms_declared = rms(&left_declared, 3, rows().filter(is_fitted_to));
    let unseen_declared = match training.contains(&false) {
        true => rms(&left_declared, 3, rows().filter(|row| !is_fitted_to(row) && !undecided.contains(row))),
        false => rms_declared,
    };
    let declared = Misfit { rms: rms_declared, holdout_rms: unseen_declared };
    let left_before = residuals(&bench.regression, &base.solved.state);
    let rms_before = rms(&left_before, 3, rows().filter(is_fitted_to));
    let identified = Misfit { rms: rms_before, holdout_rms: unseen_rms(bench, base, undecided) };
    // Data that can tell nothing change nothing.
    let (after, left_after) = match tells {
        true => {
            let left = residuals(&bench.regression, &written.solved.state);
            let rms = rms(&left, 3, rows().filter(is_fitted_to).filter(|row| !found.wild.rows.contains(row)));
            (Misfit { rms, holdout_rms: unseen_rms(bench, written, undecided) }, left)
        }
        false => (declared, left_declared),
    };
    Errors { declared, identified, after, left: [left_before, left_after] }
}

/// What is left of each row before and after, stacked in the frame of what reads it (m), in
/// the base frame of the robot where a model has it stand.
fn row_residuals(bench: &Bench<'_>, model: &Model, left: [&DVector<f64>; 2]) -> Vec<RowResidual> {
    let turn = model.solved.state.registration.turn.inverse();
    let residual = |(i, row): (usize, &PositionRow)| {
        let in_base = |left: &DVector<f64>| -> [f64; 3] {
            let left: Vector3<f64> = left.fixed_rows::<3>(3 * i).into_owned();
            (turn * left).into()
        };
        let [before, after] = left.map(in_base);
        RowResidual { line: row.line, pose: row.pose, before, after }
    };
    bench.prepared.data.rows.iter().enumerate().map(residual).collect()
}

/// The rms of each pose of what is left before and after, stacked (m).
fn pose_errors(bench: &Bench<'_>, left: [&DVector<f64>; 2]) -> Vec<PoseError> {
    let data = bench.prepared.data;
    let error = |(pose, id): (usize, &String)| {
        let rows = || (0..data.rows.len()).filter(|&row| data.rows[row].pose == pose);
        let [before, after] = left.map(|left| rms(left, 3, rows()));
        PoseError { pose: id.clone(), held_out: !bench.rows.training[pose], before, after }
    };
    data.poses.iter().enumerate().map(error).collect()
}

/// Why what a model leaves is no noise, if so: nothing reads as badly as that. With it, what
/// mistakes the files may have been written with, where one accounts for it.
fn no_noise(campaign: &Campaign, bench: &Bench<'_>, model: &Model) -> Option<(String, Vec<String>)> {
    let apart = apart(bench.prepared.data);
    let left = (model.solved.fit.rss * 3.0 / model.solved.problem.total.rows as f64).sqrt();
    if left <= NOISIEST * apart {
        return None;
    }
    let misread = in_positions(&campaign.robot, bench.prepared.data, left / 3_f64.sqrt());
    let may_be = misread.as_ref().map_or_else(
        || {
            let unknown = "angles or lengths in another unit, axes of another hand, a reflector that is not where the \
                           campaign says, or a tracker that moved in between";
            String::from(unknown)
        },
        |misread| {
            let left = 1e3 * 3_f64.sqrt() * misread.left;
            format!("{}, for with that undone {left:.1} mm are left", misread.mistakes.join(", or "))
        },
    );
    let why = format!(
        "the model leaves {:.0} mm of positions that are {:.0} mm from their middle, which is no noise: {may_be}",
        left * 1e3,
        apart * 1e3
    );
    Some((why, misread.map_or_else(Vec::new, |misread| misread.mistakes)))
}

/// The named effects, the one without which most is left first: each with the error on
/// unseen poses (m) that it and those before it leave; wild readings come last.
fn effects(
    campaign: &Campaign,
    found: &Searched<'_>,
    replaced: &[(usize, Proposed)],
    spread: &DMatrix<f64>,
    undecided: &[usize],
    (partial, holdout_rms): (bool, f64),
) -> Vec<NamedEffect> {
    let (bench, model) = (&found.bench, &found.model);
    let chosen = bench.chosen(&model.named);
    // Numbers out of grids come behind the others.
    let shaped: Vec<Named> = bench.shape_columns(model).into_iter().map(|(one, _)| one).collect();
    let spread_of_shape = |one: Named| {
        let at = chosen.len() + shaped.iter().position(|other| *other == one)?;
        spread.get((at, at)).map(|variance| variance.sqrt())
    };
    let weight = weight::in_place(bench, &campaign.robot, model);
    let mut named: Vec<(f64, Named, NamedEffect)> = Vec::new();
    for (k, &one) in model.named.iter().enumerate() {
        let (form, candidate) = (bench.variant(one), &bench.candidates[one.candidate]);
        let number = |column: &usize| {
            let number = column - STANDS;
            let at = chosen.iter().position(|&of| of == number).expect("a model has its own numbers");
            let about = &bench.numbers[number - bench.prepared.own.len()];
            let value = model.solved.fit.coefficients[STANDS + at];
            EffectParameter { name: about.name, value, std: Some(spread[(at, at)].sqrt()), unit: about.unit }
        };
        let of_shape = form.shape.iter().map(|number| EffectParameter { std: spread_of_shape(one), ..number.clone() });
        let parameters: Vec<EffectParameter> = form.columns.iter().map(number).chain(of_shape).collect();
        let rest = all_but(&model.named, k);
        let without = bench.solve(&rest, &model.solved.state).map_or(f64::INFINITY, |rest| rest.solved.fit.rss);
        let value = parameters.first().map_or(0.0, |number| number.value);
        let mut same_as = same_as(bench, model, k, value, replaced);
        let is_sag = candidate.name() == SAG || same_as.iter().any(|name| name == SAG);
        if !is_sag && weight[k].is_some_and(|rss| alike(bench, model, rss)) {
            same_as.push(SAG.to_string());
        }
        named.push((
            without,
            one,
            NamedEffect {
                effect: Found::new(candidate.kind, candidate.place, parameters),
                lines: Vec::new(),
                p_value: found.selection.p_values[k],
                holdout_rms,
                same_as,
                in_part: Vec::new(),
                partial,
            },
        ));
    }
    // What explains most comes first, each with the error of those before it and itself.
    named.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut so_far = Vec::new();
    for (_, one, named) in &mut named {
        so_far.push(*one);
        so_far.sort_unstable();
        let smaller = bench.solve(&so_far, &model.solved.state);
        named.holdout_rms = smaller.map_or(holdout_rms, |smaller| unseen_rms(bench, &smaller, undecided));
    }
    let mut named: Vec<NamedEffect> = named.into_iter().map(|(.., named)| named).collect();
    if !found.wild.rows.is_empty() {
        let mut lines: Vec<usize> = found.wild.rows.iter().map(|&row| bench.prepared.data.rows[row].line).collect();
        lines.sort_unstable();
        named.push(NamedEffect {
            effect: Found::outliers(lines.len()),
            lines,
            p_value: found.wild.p,
            holdout_rms,
            same_as: Vec::new(),
            in_part: Vec::new(),
            partial,
        });
    }
    named
}

/// Full names of what these positions do not tell effect `k` of a model from, whose first
/// number has this value.
fn same_as(bench: &Bench<'_>, model: &Model, k: usize, value: f64, replaced: &[(usize, Proposed)]) -> Vec<String> {
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

/// Other models that are about as good: of as many effects, or come to from elsewhere.
fn rivals(found: &Searched<'_>, replaced: &[(usize, Proposed)]) -> Vec<Rival> {
    let (bench, model) = (&found.bench, &found.model);
    let within = replaced.iter().filter(|(_, other)| other.bic < model.bic + WITHIN_REACH);
    let mut rivals: Vec<Rival> = Vec::new();
    for (_, other) in within {
        let names: Vec<String> = other.named.iter().map(|one| bench.candidates[one.candidate].name()).collect();
        if rivals.iter().all(|rival| rival.names != names) {
            rivals.push(Rival { names, bic_difference: other.bic - model.bic });
        }
    }
    let from_elsewhere = found.rival.iter().filter(|rival| rivals.iter().all(|other| other.names != rival.names));
    let from_elsewhere: Vec<Rival> = from_elsewhere.cloned().collect();
    rivals.extend(from_elsewhere);
    rivals.sort_by(|a, b| a.bic_difference.total_cmp(&b.bic_difference));
    rivals
}

/// What these positions could not show if it were there: what is the same as another
/// stand of the robot or as its own compliances, and what needs loads.
fn invisible(campaign: &Campaign, bench: &Bench<'_>) -> Vec<String> {
    let mut names: Vec<String> = (0..bench.candidates.len())
        .filter(|&candidate| !bench.shows(candidate))
        .map(|candidate| bench.candidates[candidate].name())
        .collect();
    let joints = campaign.robot.joints.len();
    let offered = |kind: &Kind| bench.candidates.iter().any(|candidate| candidate.kind == kind);
    for kind in KINDS.into_iter().filter(|kind| !kind.of_rig && !offered(kind)) {
        names.extend(kind.places(joints).into_iter().map(|place| format!("{}@{place}", kind.name)));
    }
    names.retain(|name| campaign.robot.effects.iter().all(|effect| effect.to_string() != *name));
    names
}
