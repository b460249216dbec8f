//! Faults of the rig that stand in for lengths, and lengths for them; and for constants what
//! moved at the very beginning.

use std::string::String;
use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;
use robstiff_robots::effect::DhEntry;

use super::tests::{names, six_axis, traced};
use crate::campaign::made_positions::Plan;
use crate::campaign::{Campaign, Data, PositionRow};
use crate::trace::{Trace, Verdict};
use robstiff::Effect;

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

/// A reflector that is elsewhere, but in the first row, is no slip before the second: the first
/// row is wild.
#[test]
fn a_reflector_elsewhere_beside_a_wild_row_is_no_slip() {
    let first = |campaign: &Campaign| {
        let Data::Position(data) = &campaign.data else { unreachable!("made of positions") };
        data.rows[0].position
    };
    for seed in 1..4 {
        let plan = Plan::new(six_axis(), seed);
        let where_described = first(&plan.run());
        let mut campaign = Plan { marker: [6e-4, -5e-4, 4e-4], ..plan }.run();
        let Data::Position(data) = &mut campaign.data else { unreachable!("made of positions") };
        data.rows[0].position = where_described;
        let trace = traced(&campaign);
        let is_slip = |name: &String| name.starts_with("reflector_slip");
        assert!(names(&trace).contains(&"reflector_offset@rig".into()), "{:?}", names(&trace));
        assert!(!names(&trace).iter().any(is_slip), "{:?}", names(&trace));
    }
}
