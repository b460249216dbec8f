//! `trace.json`.

use robstiff::JointKind;
use robstiff_identify::campaign::Campaign;
use robstiff_identify::identify::EncodersRead;
use robstiff_identify::trace::{Misfit, NamedEffect, Nested, Proposal, Rival, Trace};
use robstiff_identify::triage::Triage;
use serde_json::{Value, json};

use super::{triage, warned};
use crate::identify;
use crate::json::{number, numbers};
use crate::report::terms::Terms;

/// The result for other programs.
pub fn document(trace: &Trace, triage: &Triage, nested: Option<&Nested>, campaign: &Campaign) -> Value {
    let unit = Terms::of(campaign).unit;
    let misfit = |misfit| misfit_in(unit, misfit);
    let mut document = json!({
        "robot": trace.robot,
        "rows": trace.rows,
        "poses": trace.poses,
        (format!("noise_{unit}")): number(trace.noise * 1e6),
        "before": {"declared": misfit(&trace.declared), "identified": misfit(&trace.identified)},
        "effects": trace.effects.iter().map(|named| effect(named, unit)).collect::<Value>(),
        "after": misfit(&trace.after),
        "verdict": trace.verdict.to_string(),
        "why": trace.why,
        "unexplained": {
            "fraction": number(trace.unexplained),
            "depends_on": trace.depends_on,
            "looks_like": trace.looks_like,
        },
        "warnings": warned::warnings(trace, campaign),
        "numbers": identify::numbers(&trace.estimates),
        "rivals": trace.rivals.iter().map(rival).collect::<Value>(),
        "invisible": trace.invisible,
        "triage": triage::document(triage),
        "next": trace.next.iter().map(|next| proposal(next, campaign)).collect::<Value>(),
    });
    if let Some(read) = &trace.encoders {
        document["encoders"] = encoders(read, campaign);
    }
    if let Some(Nested { folds, rms, identified_rms, names }) = nested {
        document["nested"] = json!({
            "folds": folds,
            (format!("rms_{unit}")): number(rms * 1e6),
            (format!("identified_rms_{unit}")): number(identified_rms * 1e6),
            "names": names.iter().map(|one| json!({"name": one.name, "share": number(one.share)})).collect::<Value>(),
        });
    }
    document
}

/// The joints whose encoders behind the gears took part, with their noise (um for
/// a joint that slides), and whether the motors' were read.
fn encoders(read: &EncodersRead, campaign: &Campaign) -> Value {
    let of = |(&joint, &noise): (&usize, &f64)| match campaign.robot.joints[joint - 1].kind {
        JointKind::Revolute => json!({"joint": joint, "noise_urad": number(noise * 1e6)}),
        JointKind::Prismatic => json!({"joint": joint, "noise_um": number(noise * 1e6)}),
    };
    json!({
        "output": read.joints.iter().zip(&read.noise).map(of).collect::<Value>(),
        "motors": read.motors,
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
    let parameters = named.effect.parameters.iter().map(|parameter| {
        json!({
            "name": parameter.name,
            "value": number(parameter.value),
            "std": parameter.std.map(number),
            "unit": parameter.unit,
        })
    });
    json!({
        "kind": named.effect.kind(),
        "at": named.effect.place().to_string(),
        "parameters": parameters.collect::<Value>(),
        "p_value": number(named.p_value),
        (format!("holdout_rms_{unit}")): number(named.holdout_rms * 1e6),
        "same_as": named.same_as.iter().chain(&named.in_part).collect::<Vec<&String>>(),
        "in_part": named.in_part,
        "partial": named.partial,
        "lines": named.lines,
    })
}

/// Another model that fits about as well.
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
