//! What tracing writes down, on simulated campaigns: the description that comes out
//! stands by itself, and says what was told of it.

use std::format;
use std::string::{String, ToString};

use robstiff_robots::catalogue;

use super::*;
use crate::campaign::made;
use crate::simulate::{Scenario, simulate};
use crate::triage::triage;

const PLAN: &str = "\
poses: {count: 30, floor: 100 mm, column: 600 mm}
visits: 2
ramp: [0.05, 0.35, 0.7, 1, 0.7, 0.35]
force: {bounds: [500 N, 1300 N]}
noise: {displacement: 8 um, stated: no}
";

fn robot(effects: &str) -> Description {
    let mut text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue").to_string();
    if !effects.is_empty() {
        text += &format!("effects:\n  - {effects}\n");
    }
    Description::parse("robot.yaml", &text).expect("of the catalogue")
}

fn measured(robot: &Description, seed: u64, scenario: &str) -> Campaign {
    let scenario = format!("name: x\nseed: {seed}\n{scenario}");
    let scenario = Scenario::parse("try.yaml", &scenario, robot).unwrap_or_else(|problems| panic!("{problems}"));
    let found = simulate(robot, &scenario).expect("it can be measured");
    let noise = scenario.states_noise.then_some(scenario.noise[0]);
    Campaign {
        noise: crate::campaign::Noise { displacement: noise, ..crate::campaign::Noise::default() },
        holdout: scenario.holdout,
        ..made::campaign(robot.clone(), Data::Displacement(found.data))
    }
}

fn traced(campaign: &Campaign) -> Trace {
    trace(campaign, &Options { draws: 499, ..Options::default() }, &|_| {}).expect("joints are seen")
}

fn names(trace: &Trace) -> Vec<String> {
    trace.effects.iter().map(|named| named.effect.to_string()).collect()
}

/// What a description declares is neither noise nor something that is missing.
#[test]
fn declared_laws_of_joints_leave_nothing_to_explain() {
    for effect in [
        "{kind: hysteresis, at: joint 2, weight1: 8e-8 rad/Nm, radius1: 150 Nm}",
        "{kind: lost_motion, at: joint 2, gap: 2e-4, knee: 60 Nm}",
    ] {
        let campaign = measured(&robot(effect), 1, PLAN);
        let found = traced(&campaign);
        assert_eq!((found.verdict, names(&found)), (Verdict::Adequate, Vec::new()), "{effect}: {}", found.why);
        assert!((found.noise / 8e-6 - 1.0).abs() < 0.1, "{effect}: {}", found.noise);
        let violated: Vec<&str> = triage(&campaign).violated().map(|(check, _)| check.name).collect();
        assert!(violated.is_empty(), "{effect}: {violated:?}");
    }
}
