//! Numbers that an effect elsewhere would make others, on an arm whose shoulder, elbow and wrist
//! have three axes each that meet in a point, or two of them.

use std::string::ToString;
use std::vec;
use std::vec::Vec;

use super::tests::{campaign, names, traced};
use super::*;
use crate::identify::column::Column;
use robstiff::Convention;
use robstiff::elements::Spring;
use robstiff_robots::samples::{arm, five_axis};

const QUARTER: f64 = core::f64::consts::FRAC_PI_2;

/// The arm with its shoulder's axes this far from each other (m).
fn seven_axis(apart: f64) -> Description {
    arm(
        Convention::Standard,
        &[
            [0.0, 0.34, 0.0, -QUARTER, 2.6e-7],
            [0.0, 0.0, apart, QUARTER, 2.8e-7],
            [0.0, 0.4, 0.0, QUARTER, 3.6e-7],
            [0.0, 0.0, 0.0, -QUARTER, 4.0e-7],
            [0.0, 0.4, 0.0, -QUARTER, 6.0e-7],
            [0.0, 0.0, 0.0, QUARTER, 9.0e-7],
            [0.0, 0.2, 0.1, 0.0, 9.0e-7],
        ],
    )
}

fn measured(robot: &Description, hidden: &[(Spring, f64)]) -> Campaign {
    let hidden: Vec<(Column, f64)> = hidden.iter().map(|&(spring, value)| (Column::Spring(spring), value)).collect();
    campaign(robot, 20, &hidden, 5)
}

fn of(robot: &Description, hidden: &[(Spring, f64)]) -> Trace {
    traced(&measured(robot, hidden))
}

/// By joint, the number of standard deviations off the truth, and what it is confounded with.
fn joints(trace: &Trace, robot: &Description) -> Vec<(f64, Vec<String>)> {
    let off = |(estimate, joint): (&Estimate, &robstiff_robots::Joint)| {
        let std = estimate.std.unwrap_or_else(|| panic!("{estimate:?}"));
        ((estimate.value - joint.compliance()) / std, estimate.confounded_with.clone())
    };
    trace.estimates.iter().zip(&robot.joints).map(off).collect()
}

#[test]
fn joints_that_a_tilt_of_another_would_change_are_told() {
    for apart in [0.0, 5e-4] {
        let robot = seven_axis(apart);
        for joint in [2, 3] {
            let trace = of(&robot, &[(Spring::Transverse(joint), 2e-7)]);
            let named = &trace.effects[0];
            let other = if named.effect.to_string().ends_with('2') { 3 } else { 2 };
            let other = std::format!("transverse_compliance@joint {other}");
            assert!(names(&trace).len() == 1 && named.same_as.contains(&other), "{:?}", trace.effects);
            for (joint, (off, confounded)) in (1..).zip(joints(&trace, &robot)) {
                assert!(off.abs() < 4.0, "joint {joint} is {off} standard deviations off");
                // So may joints be that are half a millimetre apart, with the link in between.
                let is_changed = [2, 3].contains(&joint);
                assert_eq!(confounded.contains(&other), is_changed, "joint {joint}, {apart} m apart: {confounded:?}");
                assert!(is_changed || confounded.is_empty(), "joint {joint}: {confounded:?}");
            }
        }
    }
}

/// Some of a tilt may be another's where all of it cannot.
#[test]
fn a_share_of_a_tilt_may_be_of_another() {
    let robot = seven_axis(0.0);
    let trace = of(&robot, &[(Spring::Transverse(2), 7e-7)]);
    assert_eq!(names(&trace), ["transverse_compliance@joint 2"]);
    let other = ["transverse_compliance@joint 3"];
    assert!(trace.effects[0].same_as.is_empty() && trace.effects[0].in_part == other, "{:?}", trace.effects);
    let told: Vec<Vec<String>> = joints(&trace, &robot).into_iter().map(|(_, confounded)| confounded).collect();
    assert!(told[1] == other && told[2] == other, "{told:?}");
}

#[test]
fn a_link_that_yields_may_twist_about_its_joint() {
    let robot = seven_axis(0.0);
    let hidden = [(Spring::LinkBending(3), 3e-7), (Spring::LinkTorsion(3), 5e-7)];
    let campaign = measured(&robot, &hidden);
    let trace = traced(&campaign);
    assert_eq!(names(&trace), ["link_compliance@link 3"]);
    for (joint, (off, confounded)) in (1..).zip(joints(&trace, &robot)) {
        assert!(off.abs() < 4.0, "joint {joint} is {off} standard deviations off");
        assert_eq!(!confounded.is_empty(), joint == 3, "joint {joint}: {confounded:?}");
    }
    // Nor is that forgotten with what is written.
    let written = Campaign { robot: trace.description, ..campaign };
    let again = joints(&traced(&written), &robot);
    assert_eq!(again[2].1, ["link_compliance@link 3 torsion"]);
    assert!(again[2].0.abs() < 4.0, "{again:?}");
}

/// What is not there changes no number, nor what the data tell from what is.
#[test]
fn numbers_that_the_data_tell_are_confounded_with_nothing() {
    let apart = (seven_axis(0.1), vec![(Spring::Transverse(3), 4e-7)]);
    for (robot, hidden) in [(seven_axis(0.0), vec![]), apart, (five_axis(), vec![(Spring::Transverse(3), 6e-7)])] {
        let trace = of(&robot, &hidden);
        assert_eq!(names(&trace).len(), hidden.len());
        for (joint, (off, confounded)) in (1..).zip(joints(&trace, &robot)) {
            assert!(off.abs() < 4.0 && confounded.is_empty(), "joint {joint}: {off}, {confounded:?}");
        }
    }
}
