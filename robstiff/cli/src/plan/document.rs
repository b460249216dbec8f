//! `plan.json` and `plan.csv`.

use std::fmt::Write as _;

use robstiff::JointKind;
use robstiff::campaign::{Campaign, Data, Frame};
use robstiff::plan::{Number, Outlook, Pair, Plan, Planned};
use robstiff::trace::Trace;
use robstiff_robots::Joint;
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

/// Degrees for joints that turn, millimetres for one that slides.
pub fn people(q: f64, joint: &Joint) -> f64 {
    match joint.kind {
        JointKind::Revolute => q.to_degrees(),
        JointKind::Prismatic => q * 1e3,
    }
}

fn proposal(planned: &Planned, plan: &Plan, campaign: &Campaign) -> Value {
    let q = planned.visit.q.iter().zip(&campaign.robot.joints).map(|(&q, joint)| people(q, joint));
    json!({
        "q_deg": numbers(q),
        "force_N": numbers(planned.greatest[..3].iter().copied()),
        "moment_Nm": numbers(planned.greatest[3..].iter().copied()),
        "separates": planned.separates.map(|pair| plan.pairs[pair].names.clone()),
        "separation": numbers(planned.separation.iter().copied()),
        "std": numbers(planned.std.iter().copied()),
    })
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

/// A row for each load, with the columns that the campaign has for it, in its own
/// frame; only the readings are missing.
pub fn table(plan: &Plan, campaign: &Campaign) -> String {
    let joints = &campaign.robot.joints;
    let frame = match &campaign.data {
        Data::Displacement(data) => data.wrench_frame,
        // No other campaign is planned for.
        Data::Position(_) | Data::Clamped(_) => Frame::Base,
    };
    let moments = plan.proposals.iter().any(|planned| planned.greatest[3..].iter().any(|value| *value != 0.0));
    let mut csv = String::from("pose,visit");
    for (number, joint) in (1..).zip(joints) {
        write!(csv, ",q{number} [{}]", joint.people_unit()).expect("a string takes any text");
    }
    csv += ",Fx [N],Fy [N],Fz [N]";
    csv += if moments { ",Mx [Nm],My [Nm],Mz [Nm]\n" } else { "\n" };
    for (index, planned) in (1..).zip(&plan.proposals) {
        for load in planned.visit.loads_in(frame, &campaign.robot) {
            write!(csv, "next {index},next {index}").expect("a string takes any text");
            let q = planned.visit.q.iter().zip(joints).map(|(&q, joint)| rounded(people(q, joint), 1e6));
            let load = load[..if moments { 6 } else { 3 }].iter().map(|&value| rounded(value, 1e3));
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
