//! Putting the result together.

mod errors;
mod judged;
mod named;

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::DMatrix;

use self::errors::Errors;
use self::judged::{judged, one_more_is_off};
pub use self::named::with_spread;
use self::named::{effects, of_model};
use super::alike::Alike;
use super::apart::Apart;
use super::bench::Bench;
use super::noise::{is_exceeded, noise};
use super::search::Found as Searched;
use super::spread::spread;
use crate::campaign::Campaign;
use crate::identify::baseline::{declared, with_values};
use crate::identify::{Error, Estimate, Identification};
use crate::trace::catalogue::{Candidate, KINDS, OUTLIERS};
use crate::trace::model::Fitted;
use crate::trace::selection::WITHIN_REACH;
use crate::trace::written::{described, fitted_again, in_told_order, taken_by};
use crate::trace::{Options, Rival, Trace, Verdict};

/// A tracing in full.
///
/// # Errors
/// Declared effects that do not go with the compliances found.
pub fn report(
    campaign: &Campaign,
    identified: &Identification,
    found: &Searched,
    options: &Options,
) -> Result<Trace, Error> {
    let (bench, model) = (&found.bench, &found.selection.model);
    let apart = Apart::of(bench, model).filter(|apart| found.too_little.is_none() && apart.is_as_good());
    let alike = Alike::of(bench, model).filter(|alike| found.too_little.is_none() && alike.is_as_good());
    let two_kinds = apart.as_ref().is_some_and(|apart| !apart.is_of_one_kind(model));
    let exceeded = is_exceeded(campaign, bench, model, options);
    let (verdict, why) = judged(found, two_kinds, alike.is_some(), exceeded);
    let (noise, noise_source) = noise(campaign, bench, model);
    let tells = verdict != Verdict::Insufficient;
    let structure = found.left.structure || found.selection.unnamed;
    // What is told of the axes, and the errors, are those of what is written; the effects that
    // are told are the model's that was found.
    let fewer = without_untold(campaign, bench, model);
    let written = fewer.as_ref().unwrap_or(model);
    let errors = Errors::of(campaign, bench, model, Some(written).filter(|_| tells));
    let spread_written = spread(bench, written);
    let spread = if fewer.is_some() { spread(bench, model) } else { spread_written.clone() };
    let effects = match tells {
        true => effects(found, &spread, structure, errors.after.holdout_rms, apart.as_ref(), alike.as_ref()),
        false => Vec::new(),
    };
    let (verdict, why) = match one_more_is_off(bench, model, &effects) {
        Some(why) if verdict == Verdict::Explained => (Verdict::Partial, why),
        _ => (verdict, why),
    };
    let values = values(campaign, bench, written);
    let description = match tells {
        true => {
            let own = written.named.iter().map(|&one| of_model(bench, written, one));
            described(campaign, "clamped axes", &values, &in_told_order(own, &effects))?
        }
        false => campaign.robot.clone(),
    };
    Ok(Trace {
        encoders: None,
        robot: campaign.robot.name.clone(),
        rows: errors.residuals.len(),
        poses: errors.of_axes.len(),
        held_out: Vec::new(),
        noise,
        noise_source,
        declared: errors.declared,
        identified: errors.identified,
        after: errors.after,
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
        residuals: errors.residuals,
        components: 1,
        differences: true,
        pose_errors: errors.of_axes,
    })
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

/// The description's numbers in a model.
fn values(campaign: &Campaign, bench: &Bench, model: &Fitted) -> Vec<f64> {
    let mut values: Vec<f64> = declared(&campaign.robot).iter().map(|number| number.value).collect();
    for (axis, &value) in bench.axes.loaded().zip(model.fit.coefficients.iter()) {
        values[axis - 1] = value;
    }
    values
}

/// What clamped axes do not show: what is at another place than the loaded axis,
/// and what needs more rows of it.
fn invisible(campaign: &Campaign, bench: &Bench) -> Vec<String> {
    let offered: Vec<String> = bench.candidates.iter().map(Candidate::name).collect();
    let declared = |name: &String| campaign.robot.effects.iter().any(|effect| effect.to_string() == *name);
    let mut names = Vec::new();
    for kind in KINDS.iter().filter(|kind| **kind != &OUTLIERS) {
        names.extend(kind.places(&campaign.robot).into_iter().map(|place| format!("{}@{place}", kind.name)));
    }
    names.retain(|name| !offered.contains(name) && !declared(name));
    names
}
