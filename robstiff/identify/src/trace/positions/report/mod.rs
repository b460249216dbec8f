//! Putting the result together.

mod errors;
mod named;

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use self::errors::Errors;
use self::named::effects;
pub use self::named::{parameters, parts};
use super::bench::{Bench, Model, Proposed};
use super::confounded::aliases;
use super::search::Searched;
use super::spread::{spread_as_declared, spread_of};
use super::structure::noise;
use super::unseen::{undecided, unseen};
use super::weight;
use super::written::{described, own_effects, without_untold};
use crate::campaign::Campaign;
use crate::identify::Error;
use crate::identify::misread::{NOISIEST, apart, in_positions};
use crate::identify::positions::estimated;
use crate::identify::positions::regression::STANDS;
use crate::trace::catalogue::{KINDS, Kind};
use crate::trace::confounded::tell;
use crate::trace::held_out;
use crate::trace::selection::WITHIN_REACH;
use crate::trace::verdict::{self, Besides};
use crate::trace::{Options, Rival, Trace, Verdict};

/// A tracing in full.
///
/// # Errors
/// Compliances that no description takes beside its own effects.
pub fn report(campaign: &Campaign, found: &Searched<'_>, options: &Options) -> Result<Trace, Error> {
    let (bench, model, base) = (&found.bench, &found.model, &found.base);
    let data = bench.prepared.data;
    let mut left = found.left.clone();
    let (mut verdict, mut why, looks_like) = judged(campaign, found);
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
    let errors = Errors::of(campaign, found, (written, tells), &undecided);
    let values = bench.prepared.values(&written.solved.state);
    let spread = spread_of(bench, model);
    let spread_written = if fewer.is_some() { spread_of(bench, written) } else { spread.clone() };
    let replaced = if tells { bench.replaced(&model.named) } else { Vec::new() };
    let effects = match tells {
        true => effects(campaign, found, &replaced, &spread, &undecided, (structure, errors.after.holdout_rms)),
        false => Vec::new(),
    };
    why.extend(weight::how_to_tell(&effects));
    let description = match tells {
        true => described(campaign, bench, &values, &own_effects(bench, written, &effects))?,
        false => campaign.robot.clone(),
    };
    let kept_back = data.poses.iter().zip(bench.rows.training.iter()).filter(|(_, training)| !**training);
    let (noise, noise_source) = noise(campaign, bench, model);
    let estimates_before =
        estimated(&bench.prepared, &bench.prepared.values(&base.solved.state), &spread_as_declared(base));
    let estimates = match tells {
        true => {
            let (mut estimates, seen) = (estimated(&bench.prepared, &values, &spread_written), bench.prepared.seen());
            let at = |own: usize| seen.iter().position(|&number| number == own).map(|at| STANDS + at);
            tell(&mut estimates, &aliases(bench, written, campaign.robot.joints.len()), at);
            estimates
        }
        false => estimates_before.clone(),
    };
    Ok(Trace {
        encoders: None,
        robot: campaign.robot.name.clone(),
        rows: data.rows.len(),
        poses: data.poses.len(),
        undecided: undecided.iter().map(|&row| data.rows[row].line).collect(),
        held_out: kept_back.map(|(id, _)| id.clone()).collect(),
        noise,
        noise_source,
        declared: errors.declared,
        identified: errors.identified,
        after: errors.after,
        verdict,
        why,
        unexplained: left.fraction,
        depends_on: if structure { left.depends_on } else { Vec::new() },
        looks_like,
        rivals: rivals(found, &replaced),
        invisible: invisible(campaign, bench),
        next: Vec::new(),
        estimates_before,
        estimates,
        description,
        effects,
        steps: found.selection.steps.clone(),
        structure: left.tests,
        residuals: errors.residuals,
        components: 3,
        differences: false,
        pose_errors: errors.of_poses,
    })
}

/// The verdict by the poses that were fitted and why, and which mistakes the files look like.
fn judged(campaign: &Campaign, found: &Searched<'_>) -> (Verdict, String, Vec<String>) {
    let too_little = found.too_little.clone().map(|why| (why, Vec::new()));
    if let Some((why, mistakes)) = too_little.or_else(|| no_noise(campaign, &found.bench, &found.model)) {
        return (Verdict::Insufficient, why, mistakes);
    }
    let besides = Besides {
        isolated: usize::from(!found.wild.rows.is_empty()),
        taken_back: &found.taken_back,
        looks_like: &found.looks_like,
        ..Besides::default()
    };
    let (verdict, why) = verdict::judge(&found.selection, &found.left, &besides);
    (verdict, why, found.looks_like.clone())
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
    let offered = |kind: &Kind| bench.candidates.iter().any(|candidate| candidate.kind == kind);
    for kind in KINDS.into_iter().filter(|kind| !kind.of_rig && !offered(kind)) {
        names.extend(kind.places(&campaign.robot).into_iter().map(|place| format!("{}@{place}", kind.name)));
    }
    names.retain(|name| campaign.robot.effects.iter().all(|effect| effect.to_string() != *name));
    names
}
