//! `plan.json` and `plan.csv`.

use std::fmt::Write as _;

use robstiff_identify::campaign::{Campaign, Data};
use robstiff_identify::plan::{Number, Outlook, Pair, Plan, Planned, Visit};
use robstiff_identify::trace::Trace;
use serde_json::{Value, json};

use crate::json::{number, numbers};

/// The plan for other programs.
pub fn document(plan: &Plan, trace: &Trace, campaign: &Campaign) -> Value {
    json!({
        "robot": trace.robot,
        "poses": trace.poses,
        "verdict": trace.verdict.to_string(),
        "proposals": plan.proposals.iter().map(|planned| proposal(planned, plan, campaign)).collect::<Value>(),
        "pairs": plan.pairs.iter().map(pair).collect::<Value>(),
        "numbers": plan.numbers.iter().map(known).collect::<Value>(),
        "assumptions": plan.assumptions,
    })
}

fn proposal(planned: &Planned, plan: &Plan, campaign: &Campaign) -> Value {
    let q = planned.visit.q.iter().zip(&campaign.robot.joints).map(|(&q, joint)| joint.for_people(q));
    let mut proposal = json!({
        "q_deg": numbers(q),
        "force_N": numbers(planned.greatest[..3].iter().copied()),
        "moment_Nm": numbers(planned.greatest[3..].iter().copied()),
        "separates": planned.separates.map(|pair| plan.pairs[pair].names.clone()),
        "separation": numbers(planned.separation.iter().copied()),
        "std": numbers(planned.std.iter().copied()),
    });
    if let Data::Position(_) = campaign.data {
        proposal["payloads_kg"] = numbers(planned.visit.payloads());
    }
    proposal
}

const FORCES: [&str; 6] = ["Fx [N]", "Fy [N]", "Fz [N]", "Mx [Nm]", "My [Nm]", "Mz [Nm]"];

/// The columns that loads have in the campaign's table: forces, and moments where there
/// are some; or payloads.
pub fn columns_of_loads(plan: &Plan, campaign: &Campaign) -> &'static [&'static str] {
    let any = |of: fn(&[f64; 6]) -> bool| plan.proposals.iter().any(|planned| of(&planned.greatest));
    match &campaign.data {
        Data::Displacement(_) if any(|load| load[3..] != [0.0; 3]) => &FORCES,
        Data::Displacement(_) => &FORCES[..3],
        Data::Position(_) if any(|load| load[2] != 0.0) => &["payload [kg]"],
        Data::Position(_) | Data::Clamped(_) => &[],
    }
}

/// The loads of a visit in these columns and in the campaign's frame, or more of them.
fn loads(visit: &Visit, campaign: &Campaign) -> Vec<Vec<f64>> {
    match &campaign.data {
        Data::Displacement(data) => {
            visit.loads_in(data.wrench_frame, &campaign.robot).iter().map(|load| load.to_vec()).collect()
        }
        Data::Position(_) | Data::Clamped(_) => visit.payloads().into_iter().map(|payload| vec![payload]).collect(),
    }
}

fn pair(pair: &Pair) -> Value {
    let remedies = pair.remedies.iter();
    let remedies = remedies.map(|remedy| json!({"what": remedy.words, "separation": remedy.separation.map(number)}));
    json!({
        "names": pair.names,
        "separation_now": number(pair.now),
        "separation_after": number(pair.after),
        "chi_square_after": number(pair.after * pair.after),
        "log_bayes_after": number(pair.log_bayes),
        "angle_deg": number(pair.angle.to_degrees()),
        "outlook": match pair.outlook {
            Outlook::Separable => "separable",
            Outlook::Slow(_) => "slow",
            Outlook::Alias => "alias",
        },
        "poses_needed": match pair.outlook {
            Outlook::Slow(poses) => Some(poses),
            _ => None,
        },
        "remedies": remedies.collect::<Value>(),
    })
}

fn known(known: &Number) -> Value {
    json!({
        "name": known.name,
        "value": number(known.value),
        "unit": known.unit,
        "std_now": number(known.now),
        "std_after": number(known.after),
        "factor": number(known.now / known.after),
    })
}

/// A row for each load in the campaign's own frame, in the units of the header; only the
/// readings are missing.
pub fn table(plan: &Plan, campaign: &Campaign) -> String {
    let joints = &campaign.robot.joints;
    let columns = columns_of_loads(plan, campaign);
    let mut csv = String::from("pose,visit");
    for (number, joint) in (1..).zip(joints) {
        write!(csv, ",q{number} [{}]", joint.people_unit()).expect("a string takes any text");
    }
    columns.iter().for_each(|name| write!(csv, ",{name}").expect("a string takes any text"));
    csv.push('\n');
    for (index, planned) in (1..).zip(&plan.proposals) {
        for load in loads(&planned.visit, campaign) {
            write!(csv, "next {index},next {index}").expect("a string takes any text");
            let q = planned.visit.q.iter().zip(joints).map(|(&q, joint)| joint.for_people(q));
            let load = load.into_iter().take(columns.len()).map(|value| rounded(value, 1e3));
            for value in q.chain(load) {
                write!(csv, ",{value}").expect("a string takes any text");
            }
            csv.push('\n');
        }
    }
    csv
}

/// To one over `steps`, without a negative zero.
fn rounded(value: f64, steps: f64) -> f64 {
    (value * steps).round() / steps + 0.0
}
