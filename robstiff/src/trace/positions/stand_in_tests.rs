//! Faults of the rig that stand in for lengths, and lengths for them.

use std::string::String;
use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;
use robstiff_robots::effect::DhEntry;

use super::tests::{names, six_axis, traced};
use crate::Effect;
use crate::campaign::PositionRow;
use crate::campaign::made_positions::Plan;
use crate::trace::{Trace, Verdict};

/// Upper arm and forearm longer by as much: of `d4` the sign is the other.
fn longer_arms() -> Vec<Effect> {
    vec![Effect::DhError { entry: DhEntry::A(2), value: 4e-4 }, Effect::DhError { entry: DhEntry::D(4), value: -4e-4 }]
}

fn is_explained_by(trace: &Trace, effects: &[&str]) {
    assert_eq!(
        (names(trace), trace.verdict),
        (effects.iter().copied().map(String::from).collect(), Verdict::Explained)
    );
}

/// All that is read is longer by a share of where it is.
fn scaled(by: f64) -> impl FnMut(usize, &mut PositionRow) {
    move |_, read: &mut PositionRow| read.position = (Vector3::from(read.position) * (1.0 + by)).into()
}

/// Two lengths are no scale with a reflector and another length.
#[test]
fn two_lengths_are_not_told_as_a_scale() {
    for seed in 1..5 {
        let trace = traced(&Plan { hidden: longer_arms(), poses: 30, ..Plan::new(six_axis(), seed) }.run());
        is_explained_by(&trace, &["dh_error@a2", "dh_error@d4"]);
    }
}

/// A true scale, a true reflector, and both beside a length, keep their names.
#[test]
fn what_the_rig_does_is_not_told_as_lengths() {
    for seed in 1..4 {
        let marker = [3e-4, -2e-4, 5e-4];
        let hidden = vec![Effect::DhError { entry: DhEntry::A(2), value: 4e-4 }];
        let plan = Plan::new(six_axis(), seed);
        is_explained_by(&traced(&plan.run_with(scaled(2e-4))), &["tracker_scale@rig"]);
        let plan = Plan { marker, ..plan };
        is_explained_by(&traced(&plan.run()), &["reflector_offset@rig"]);
        let plan = Plan { hidden, ..plan };
        let all = ["dh_error@a2", "reflector_offset@rig", "tracker_scale@rig"];
        is_explained_by(&traced(&plan.run_with(scaled(2e-4))), &all);
    }
}
