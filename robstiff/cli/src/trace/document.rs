//! `trace.json`.

use robstiff::JointKind;
use robstiff_identify::campaign::Campaign;
use robstiff_identify::trace::{
    EffectParameter, Estimate, Misfit, NamedEffect, Nested, Proposal, Rival, Suspected, Trace, Visibility,
};
use robstiff_identify::triage::Triage;
use serde_json::{Value, json};

use super::triage;
use crate::json::{number, numbers};
use crate::report::terms::Terms;

/// The result for other programs.
pub fn document(trace: &Trace, triage: &Triage, campaign: &Campaign, warnings: &[String]) -> Value {
    let unit = Terms::of(campaign).unit;
    let misfit = |misfit| misfit_in(unit, misfit);
    let mut document = json!({
        "robot": trace.robot,
        "rows": trace.rows,
        "poses": trace.poses,
        (format!("noise_{unit}")): number(trace.noise * 1e6),
        "before": {"declared": misfit(&trace.declared), "identified": misfit(&trace.identified)},
        "effects": trace.effects.iter().map(|named| effect(named, unit)).collect::<Value>(),
        "suspected": trace.suspected.iter().map(suspected).collect::<Value>(),
        "after": misfit(&trace.after),
        "written": misfit(&trace.written),
        "verdict": trace.verdict.to_string(),
        "why": trace.why,
        "unexplained": {
            "fraction": number(trace.unexplained),
            "depends_on": trace.depends_on,
            "looks_like": trace.looks_like,
        },
        "nested": nested(&trace.nested, unit),
        "warnings": warnings,
        "numbers": trace.estimates.iter().map(estimate).collect::<Value>(),
        "rivals": trace.rivals.iter().map(rival).collect::<Value>(),
        "invisible": trace.invisible,
        "triage": triage::document(triage),
        "next": trace.next.iter().map(|next| proposal(next, campaign)).collect::<Value>(),
    });
    if !trace.encoders.is_empty() || trace.motors {
        document["encoders"] = encoders(trace, campaign);
    }
    document
}

/// The whole search repeated without some poses.
fn nested(nested: &Nested, unit: &str) -> Value {
    let name = |(name, share): &(String, f64)| json!({"name": name, "share": number(*share)});
    json!({
        "folds": nested.folds,
        (format!("rms_{unit}")): number(nested.rms * 1e6),
        (format!("identified_rms_{unit}")): number(nested.identified_rms * 1e6),
        "names": nested.names.iter().map(name).collect::<Value>(),
    })
}

/// The joints whose encoders behind the gears took part, with their noise (um for
/// a joint that slides), and whether the motors' were read.
fn encoders(trace: &Trace, campaign: &Campaign) -> Value {
    let of = |&(joint, noise): &(usize, f64)| match campaign.robot.joints[joint - 1].kind {
        JointKind::Revolute => json!({"joint": joint, "noise_urad": number(noise * 1e6)}),
        JointKind::Prismatic => json!({"joint": joint, "noise_um": number(noise * 1e6)}),
    };
    json!({
        "output": trace.encoders.iter().map(of).collect::<Value>(),
        "motors": trace.motors,
    })
}

/// One of the description's own numbers.
fn estimate(estimate: &Estimate) -> Value {
    json!({
        "name": estimate.name,
        "declared": number(estimate.declared),
        "value": number(estimate.value),
        "std": estimate.std.map(number),
        "unit": estimate.unit,
        "visibility": match estimate.visibility {
            Visibility::Seen => "seen",
            Visibility::Unseen | Visibility::Confounded(_) => "unseen",
        },
        "at_bound": estimate.at_bound,
        "deviation": estimate.deviation().map(number),
        "noteworthy": estimate.is_noteworthy(),
    })
}

/// The errors, in the unit of the campaign's.
fn misfit_in(unit: &str, misfit: &Misfit) -> Value {
    json!({
        (format!("rms_{unit}")): number(misfit.rms * 1e6),
        (format!("holdout_rms_{unit}")): number(misfit.holdout_rms * 1e6),
    })
}

fn effect(named: &NamedEffect, unit: &str) -> Value {
    json!({
        "kind": named.effect.kind(),
        "at": named.effect.place().to_string(),
        "parameters": parameters(&named.effect.parameters),
        "probability": number(named.probability),
        "class": class(&named.class),
        "recurs": number(named.recurs),
        "p_value": number(1.0 - named.probability),
        (format!("holdout_rms_{unit}")): number(named.holdout_rms * 1e6),
        "same_as": named.same_as(),
        "partial": named.partial,
        "lines": named.lines,
    })
}

fn suspected(suspected: &Suspected) -> Value {
    json!({
        "kind": suspected.effect.kind(),
        "at": suspected.effect.place().to_string(),
        "parameters": parameters(&suspected.effect.parameters),
        "probability": number(suspected.probability),
        "class": class(&suspected.class),
        "recurs": number(suspected.recurs),
        "why_not": suspected.why_not,
    })
}

fn parameters(parameters: &[EffectParameter]) -> Value {
    let one = |parameter: &EffectParameter| {
        json!({
            "name": parameter.name,
            "value": number(parameter.value),
            "std": parameter.std.map(number),
            "unit": parameter.unit,
        })
    };
    parameters.iter().map(one).collect()
}

/// The members of a class, each with its probability.
fn class(class: &[(String, f64)]) -> Value {
    class.iter().map(|(name, p)| json!({"name": name, "probability": number(*p)})).collect()
}

/// Another set of effects that is nearly as probable.
fn rival(rival: &Rival) -> Value {
    json!({"effects": rival.names, "bic_difference": number(rival.bic_difference)})
}

/// Degrees for joints that turn; one that slides has its millimetres there.
fn proposal(next: &Proposal, campaign: &Campaign) -> Value {
    let coordinates = next.q.iter().zip(&campaign.robot.joints).map(|(&q, joint)| joint.for_people(q));
    let mut proposal = json!({
        "q_deg": numbers(coordinates),
        "force_N": numbers(next.force),
        "separates": next.separates,
    });
    if let Some(payload) = next.payload {
        proposal["payload_kg"] = number(payload);
    }
    proposal
}
