//! Numbers that an effect elsewhere would make others, in positions under payloads.

use std::string::ToString;
use std::vec;

use super::tests::{names, six_axis, traced};
use crate::campaign::made_positions::Plan;
use robstiff::Effect;

/// The axes of the wrist meet in a point, and of a payload on its axis joint 6 feels nothing.
#[test]
fn joints_that_a_tilt_of_another_would_change_are_told() {
    let robot = six_axis();
    let hidden = vec![Effect::TransverseCompliance { joint: 5, value: 2e-6 }];
    let plan = Plan { hidden, payloads: vec![0.0, 200.0], ..Plan::new(robot.clone(), 4) };
    let trace = traced(&plan.run());
    let name = names(&trace).concat();
    let other = if name.ends_with('5') { "transverse_compliance@joint 6" } else { "transverse_compliance@joint 5" };
    assert!(name.starts_with("transverse_compliance@joint"), "{name}");
    for (joint, (estimate, declared)) in (1..).zip(trace.estimates.iter().zip(&robot.joints)) {
        let confounded = estimate.confounded_with.contains(&other.to_string());
        assert_eq!(confounded, joint == 5, "{name}, {estimate:?}");
        if let Some(std) = estimate.std {
            assert!((estimate.value - declared.compliance()).abs() < 4.0 * std, "{estimate:?}");
        }
    }
}
