//! Few poses without declared noise, and something that random signs of poses hardly tell.

use std::string::String;
use std::vec;
use std::vec::Vec;

use super::Verdict;
use super::tests::{names, traced};
use crate::campaign::Data;
use crate::campaign::made::Plan;
use robstiff::Effect;
use robstiff_robots::samples::five_axis;

/// Another point than the file says (m).
const OFF: [f64; 3] = [0.2, -0.1, 0.15];

/// Joints that were fitted to what a reflector elsewhere reads do not let it look like that; it is
/// found by what it fits by itself.
#[test]
fn a_reflector_elsewhere_is_found_at_few_poses() {
    for seed in 0..4 {
        let reads_at = [0.1 + OFF[0], OFF[1], OFF[2]];
        let plan = Plan { poses: 12, ramp: vec![1.0], visits: 1, at: [[0.0; 3], reads_at], ..Plan::new(seed) };
        let mut campaign = plan.run();
        let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
        data.measured_at = core::array::from_fn(|k| data.measured_at[k] - OFF[k]);
        let trace = traced(&campaign);
        // One load a pose, and no noise declared: nothing but the fit says how large it is.
        assert_eq!((trace.verdict, names(&trace)), (Verdict::Partial, vec!["reflector_offset@rig".into()]), "{seed}");
        for (number, off) in trace.effects[0].effect.parameters.iter().zip(OFF) {
            let std = number.std.expect("a length has one");
            assert!((number.value - off).abs() < 4.0 * std && std < 0.05, "{seed}: {number:?}");
        }
    }
}

/// What one joint does at three of twelve poses fits, and many patterns of signs leave as much.
#[test]
fn what_is_clear_and_not_significant_is_left_open() {
    let mut robot = five_axis();
    robot.effects.push(Effect::PoseDependentCompliance { joint: 2, cos1: 0.5, sin1: 0.2, cos2: 0.0, sin2: 0.0 });
    let mut campaign = Plan { robot, poses: 12, ramp: vec![0.5, 1.0], visits: 1, ..Plan::new(1) }.run();
    campaign.robot.effects.clear();
    let trace = traced(&campaign);
    assert_eq!((trace.verdict, names(&trace)), (Verdict::Insufficient, Vec::<String>::new()));
    assert!(trace.why.contains("pose_dependent_compliance@joint 2"), "{}", trace.why);
    assert_eq!(trace.description.source, campaign.robot.source);
}

/// An arm that lacks nothing stays adequate, however few its poses are, and where noise is larger
/// at some of them.
#[test]
fn nothing_is_found_in_noise() {
    for seed in 0..6 {
        let plan = Plan { poses: 10, ramp: vec![0.5, 1.0], visits: 1, ..Plan::new(seed) };
        for several in [1.0, 4.0] {
            let louder = |i: usize, row: &mut crate::campaign::Observation| {
                let wobble = [1.0, -0.5, 0.8].map(|one| 1e-5 * one * (several - 1.0));
                if i % 6 < 2 {
                    row.displacement = core::array::from_fn(|k| row.displacement[k] + wobble[(k + i) % 3]);
                }
            };
            let trace = traced(&plan.run_with(louder));
            assert!(names(&trace).is_empty() && trace.verdict == Verdict::Adequate, "{seed}: {}", trace.why);
        }
    }
}
