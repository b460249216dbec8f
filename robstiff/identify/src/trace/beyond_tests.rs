//! What tracing makes of loads that are not what is read of them.

use std::format;
use std::vec;
use std::vec::Vec;

use super::tests::{names, traced};
use super::*;
use crate::campaign::made::Plan;
use crate::identify::column::Column;
use robstiff::elements::Spring;

/// Nothing is named, and what it looks like is told.
fn looks_like(campaign: &Campaign, words: &str) -> bool {
    let found = traced(campaign);
    assert_eq!((names(&found), found.verdict), (vec![], Verdict::Unexplained), "{}", found.why);
    found.looks_like == [words]
}

/// Each gear seems to soften about its own torque.
#[test]
fn a_load_cell_whose_line_is_bent_is_no_softening() {
    let bent = |seed| Plan { acts: |force| force * (1.0 + 0.08 * force.norm() / 1300.0), ..Plan::new(seed) }.run();
    let told =
        (0..6).filter(|&seed| looks_like(&bent(seed), "a load cell that does not read in proportion to the force"));
    assert_eq!(told.count(), 6);
}

/// The arm seems to come back late.
#[test]
fn friction_in_a_pulley_is_no_creep() {
    let held_back = |seed| {
        let plan = Plan { ramp: vec![0.2, 0.6, 1.0, 0.6, 0.2], ..Plan::new(seed) };
        plan.run_with(|row, reading| {
            let acts = if row % 5 < 3 { 0.96 } else { 1.04 };
            reading.displacement = reading.displacement.map(|displacement| acts * displacement);
        })
    };
    let told = (0..6).filter(|&seed| looks_like(&held_back(seed), "friction between the load cell and the tool"));
    assert_eq!(told.count(), 6);
}

/// The drives of a wrist couple its joints, by name; what turns one joint under the torque of another
/// without one has none.
#[test]
fn a_coupling_without_a_drive_has_no_name() {
    let coupled = |pair, value, seed| {
        let hidden = vec![(Column::Spring(Spring::Coupling(pair)), value)];
        Plan { hidden, ..Plan::new(seed) }.run()
    };
    for (seed, [i, j]) in (0..).zip([[1, 2], [1, 5], [3, 4]]) {
        assert!(looks_like(
            &coupled([i, j], 2e-7, seed),
            &format!("a coupling of joints {i} and {j}, which share no drive")
        ));
    }
    // Of the wrist as little would not matter.
    let named = traced(&coupled([4, 5], 8e-7, 3));
    assert_eq!((names(&named), named.verdict), (vec!["joint_coupling@joints 4,5".into()], Verdict::Explained));
}

/// Of one gear alone it is that gear's.
#[test]
fn what_one_gear_does_is_not_told_of_the_load() {
    let of = |seed, hidden: Vec<(Column, f64)>| traced(&Plan { hidden, ..Plan::new(seed) }.run());
    for seed in 0..3 {
        let softening =
            of(seed, vec![(Column::Knee { joint: 3, knee: 500.0 }, -2e-7), (Column::Spring(Spring::Joint(3)), 2e-7)]);
        assert_eq!((names(&softening), softening.looks_like), (vec!["stiffness_nonlinearity@joint 3".into()], vec![]));
        let lagging = of(seed, vec![(Column::Play { joint: 2, operator: 0, radius: 150.0 }, 2e-7)]);
        assert_eq!((names(&lagging), lagging.looks_like), (vec!["hysteresis@joint 2".into()], vec![]));
    }
}
