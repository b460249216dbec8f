//! What absolute positions say of a description, with nothing missing from it.

use robstiff_robots::{Description, catalogue};

use super::super::{Error, Visibility, identify as identified};
use crate::campaign::Data;
use crate::campaign::made_positions::Plan;
use crate::predict::predict as predicted;
use robstiff::Effect;
use robstiff_robots::samples::{five_axis, odd};

fn six_axis() -> Description {
    let text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
    Description::parse("kuka-kr270-r2700.yaml", text).expect("a description")
}

/// Wherever the tracker stands, what is left is noise.
#[test]
fn the_declared_robot_predicts_what_it_measured() {
    for (robot, seed) in [(five_axis(), 1), (odd(), 2), (six_axis(), 3)] {
        let campaign = Plan { payloads: vec![0.0, 120.0], ..Plan::new(robot.clone(), seed) }.run();
        let found = predicted(&robot, &campaign).expect("positions");
        assert!((found.rms / 3e-5 - 1.0).abs() < 0.15, "{} um", found.rms * 1e6);
        let exact = Plan { noise: 0.0, payloads: vec![80.0], ..Plan::new(robot.clone(), seed) }.run();
        assert!(predicted(&robot, &exact).expect("positions").max < 1e-12);
    }
}

/// What a description declares is no part of what is left.
#[test]
fn declared_effects_are_in_the_prediction() {
    let mut robot = six_axis();
    let hidden = vec![
        Effect::JointZeroOffset { joint: 3, value: 0.02 },
        Effect::TransmissionError { joint: 2, order: 1.0, sin: 1e-3, cos: -2e-3 },
    ];
    let campaign = Plan { noise: 0.0, hidden: hidden.clone(), ..Plan::new(robot.clone(), 4) }.run();
    assert!(predicted(&robot, &campaign).expect("positions").rms > 1e-3);
    robot.effects = hidden;
    assert!(predicted(&robot, &campaign).expect("positions").max < 1e-12);
}

/// The joints that weights at the TCP turn: not the first, and not the last, whose axis goes
/// through it.
const LOADED: core::ops::Range<usize> = 1..5;

/// Payloads show the compliances of the joints that they load; the others keep their values.
#[test]
fn payloads_show_compliances() {
    let robot = six_axis();
    let mut declared = robot.clone();
    declared.joints.iter_mut().for_each(|joint| joint.compliance.iter_mut().for_each(|part| part.value *= 1.4));
    let mut within = 0;
    for seed in 0..20 {
        let mut campaign = Plan { payloads: vec![0.0, 100.0, 250.0], ..Plan::new(robot.clone(), seed) }.run();
        campaign.robot = declared.clone();
        let found = identified(&campaign).expect("payloads");
        assert!(found.rms < found.rms_declared);
        assert_eq!([0, 5].map(|k| found.estimates[k].visibility.clone()), [Visibility::Unseen, Visibility::Unseen]);
        for (estimate, joint) in found.estimates[LOADED].iter().zip(&robot.joints[LOADED]) {
            let std = estimate.std.expect("a number that shows");
            within += usize::from((estimate.value - joint.compliance()).abs() <= 1.96 * std);
        }
    }
    assert!((70..=80).contains(&within), "{within} of 80");
}

/// Poses with one payload are no witnesses of how sure two others are.
#[test]
fn two_poses_under_payloads_know_what_they_do_not() {
    let (mut within, mut count) = (0, 0);
    for seed in 0..40 {
        let mut campaign = Plan { payloads: vec![0.0, 100.0, 200.0], ..Plan::new(six_axis(), 60 + seed) }.run();
        let Data::Position(data) = &mut campaign.data else { unreachable!("made of positions") };
        data.rows.retain(|row| row.pose < 2 || row.payload == 0.0);
        let found = identified(&campaign).expect("payloads");
        for (estimate, joint) in found.estimates.iter().zip(&campaign.robot.joints).skip(1) {
            let Some(std) = estimate.std else { continue };
            count += 1;
            within += usize::from((estimate.value - joint.compliance()).abs() <= 1.96 * std);
        }
    }
    assert!(count > 60 && 10 * within >= 9 * count, "{within} of {count}");
}

/// What payloads of one visit differ by does not know how the table is off.
#[test]
fn errors_of_the_table_do_not_matter_within_a_visit() {
    let mut plan = Plan { payloads: vec![0.0, 200.0], ..Plan::new(six_axis(), 5) };
    let of = |plan: &Plan| identified(&plan.run()).expect("payloads").estimates;
    let right = of(&plan);
    plan.hidden =
        vec![Effect::JointZeroOffset { joint: 2, value: 2e-3 }, Effect::JointZeroOffset { joint: 3, value: 3e-3 }];
    let off = of(&plan);
    for (right, off) in right[LOADED].iter().zip(&off[LOADED]) {
        let std = right.std.expect("a number that shows");
        assert!((right.value - off.value).abs() < 0.2 * std, "{right:?} {off:?}");
    }
    // One payload all the time says less, and only with the table as it is.
    plan.payloads = vec![200.0];
    assert!(of(&plan)[1].std > off[1].std);
}

/// Readings of one payload that come again in a visit have nothing but noise between them.
#[test]
fn one_payload_read_several_times_a_visit_shows_compliances() {
    let plan = Plan { payloads: vec![100.0; 3], repeatability: 1e-4, ..Plan::new(six_axis(), 5) };
    let found = identified(&plan.run()).expect("payloads");
    for (estimate, joint) in found.estimates.iter().zip(&six_axis().joints).skip(1).take(2) {
        let std = estimate.std.expect("a number that shows");
        assert!((estimate.value - joint.compliance()).abs() < 4.0 * std, "{estimate:?}");
    }
    // By what the robot misses a pose is more than what readings of a visit differ by.
    let (noise, _) = found.noise.expect("from what is left");
    let whole = plan.noise.hypot(plan.repeatability);
    assert!(noise > 0.7 * whole && noise < 1.4 * whole, "{noise} {whole}");
}

#[test]
fn what_shows_no_compliance_is_told() {
    let robot = five_axis();
    let of = |campaign| identified(&campaign).map(|_| ()).expect_err("nothing to identify");
    let bare = of(Plan::new(robot.clone(), 1).run());
    assert!(matches!(&bare, Error::NotShown(why) if why.contains("no row has a payload")), "{bare}");
    let mut two = Plan::new(robot, 1);
    two.poses = 2;
    let few = predicted(&two.robot, &two.run()).expect_err("two positions");
    assert!(matches!(&few, Error::NotShown(why) if why.contains("do not tell where the robot stands")), "{few}");
}

/// A reading that is off by far more than anything else has no part in the fit.
#[test]
fn a_position_that_does_not_belong_is_left_out() {
    let hidden = vec![Effect::JointZeroOffset { joint: 3, value: 1e-3 }];
    let plan = Plan { payloads: vec![0.0, 200.0], hidden, ..Plan::new(six_axis(), 5) };
    let right = identified(&plan.run()).expect("payloads");
    let campaign = plan.run_with(|i, row| row.position[1] += if [31, 80].contains(&i) { 0.3 } else { 0.0 });
    let found = identified(&campaign).expect("payloads");
    assert_eq!((right.left_out.len(), found.left_out), (0, vec![33, 82]));
    for (right, found) in right.estimates[LOADED].iter().zip(&found.estimates[LOADED]) {
        let std = right.std.expect("a number that shows");
        assert!((right.value - found.value).abs() < std, "{right:?} {found:?}");
    }
    let off = found.rms_declared.expect("positions") / right.rms_declared.expect("positions");
    assert!((off - 1.0).abs() < 0.1, "{off}");
}

/// A decimal point that was lost hides no other reading that is off.
#[test]
fn a_position_off_by_metres_hides_no_other() {
    let plan = Plan { payloads: vec![0.0, 200.0], ..Plan::new(six_axis(), 5) };
    for far in [2.0, 15.0] {
        let off = |i| match i {
            31 => far,
            80 => 0.05,
            _ => 0.0,
        };
        let found = identified(&plan.run_with(|i, row| row.position[1] += off(i))).expect("payloads");
        assert_eq!(found.left_out, [33, 82], "{far} m");
    }
}
