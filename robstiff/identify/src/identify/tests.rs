//! Identification of numbers that are known.

use std::vec;

use nalgebra::{DVector, Vector3, Vector6};

use super::*;
use crate::campaign::made::Plan;
use crate::campaign::{Displacements, Frame, Observation, made};
use crate::fit::estimate::with_value;
use crate::model::described::{Own, as_declared, declared};
use crate::observe::Observation as _;
use crate::observe::displacement::Displacement;
use crate::predict::predict;
use robstiff::{Convention, Effect, Generic, Robot};
use robstiff_robots::samples::{arm, five_axis};

/// A campaign without noise, by the reference robot: `deflection` of the TCP,
/// read at a point and in a frame as asked.
fn campaign(truth: &Description, declared: Description, frame: Frame, at: [f64; 3], moments: bool) -> Campaign {
    let robot = Generic::<5>::new(truth).expect("five joints");
    let rows = (0..30).map(|i| {
        let part = |k: usize| (1.0 + f64::from(i) * 1.7 + k as f64 * 2.3).sin();
        let q = nalgebra::SVector::<f64, 5>::from_fn(|k, _| part(k));
        let force = Vector3::from_fn(|k, _| 600.0 * part(5 + k));
        let moment = if moments { Vector3::from_fn(|k, _| 90.0 * part(9 + k)) } else { Vector3::zeros() };
        let tool = robot.transform(&q).fixed_view::<3, 3>(0, 0).into_owned();
        let lever = tool * Vector3::from(at);
        // The wrench acts at the point, and so has a moment about the TCP.
        let about_tcp = moment + lever.cross(&force);
        let wrench = Vector6::new(force.x, force.y, force.z, about_tcp.x, about_tcp.y, about_tcp.z);
        let twist = robot.deflection(&q, &wrench);
        let turn: Vector3<f64> = twist.fixed_rows::<3>(3).into_owned();
        let displacement = twist.fixed_rows::<3>(0) + turn.cross(&lever);
        let seen = |v: Vector3<f64>| if frame == Frame::Tool { tool.transpose() * v } else { v };
        let (force, moment) = (seen(force), seen(moment));
        Observation {
            line: i as usize + 2,
            pose: i as usize,
            visit: i as usize,
            time: None,
            temperature: None,
            q: q.iter().copied().collect(),
            wrench: [force.x, force.y, force.z, moment.x, moment.y, moment.z],
            displacement: seen(displacement).into(),
            rotation: Some(seen(turn).into()),
            encoders: None,
            motors: None,
        }
    });
    let data = Displacements {
        wrench_frame: frame,
        wrench_at: at,
        measured_frame: frame,
        measured_at: at,
        directions: crate::campaign::AXES.to_vec(),
        poses: (0..30).map(|i| format!("{i}")).collect(),
        visits: (0..30).map(|i| format!("{i}")).collect(),
        rows: rows.collect(),
    };
    made::campaign(declared, Data::Displacement(data))
}

fn stiffer(description: &Description) -> Description {
    let mut stiffer = description.clone();
    stiffer.joints.iter_mut().flat_map(|joint| &mut joint.compliance).for_each(|part| part.value *= 0.6);
    stiffer
}

#[test]
fn known_compliances_come_back_from_any_frame_and_point() {
    let mut truth = five_axis();
    truth.tool.xyz = [0.1, 0.0, 0.12];
    for (frame, at) in [(Frame::Base, [0.0; 3]), (Frame::Tool, [0.2, -0.1, 0.3])] {
        let found = identify(&campaign(&truth, stiffer(&truth), frame, at, true)).expect("all joints are seen");
        for (estimate, joint) in found.estimates.iter().zip(&truth.joints) {
            let off = (estimate.value / joint.compliance() - 1.0).abs();
            assert!(off < 5e-3, "{frame:?} {at:?}: {} off by {off}", estimate.name);
            assert!(estimate.is_noteworthy() && estimate.visibility == Visibility::Seen);
        }
        assert!(found.rms < found.rms_declared);
        assert_eq!(found.correlation.nrows(), 5);
    }
}

#[test]
fn declared_laws_of_joints_are_fitted_again() {
    let mut truth = five_axis();
    truth.effects = vec![
        Effect::LostMotion { joint: 2, gap: 2e-4, knee: 40.0 },
        Effect::Hysteresis {
            joint: 3,
            radius1: 60.0,
            weight1: 8e-8,
            radius2: 150.0,
            weight2: 5e-8,
            radius3: 0.0,
            weight3: 0.0,
        },
    ];
    let known = campaign(&truth, stiffer(&truth), Frame::Tool, [0.2, -0.1, 0.3], true);
    let found = identify(&known).expect("all joints are seen");
    for (estimate, joint) in found.estimates.iter().zip(&truth.joints) {
        let off = (estimate.value - joint.compliance()).abs();
        let std = estimate.std.expect("it is seen");
        // The second order of the laws is not in the model: it is a discrepancy, which grows with the load.
        assert!(off < 1e-2 * joint.compliance() || off < 1.96 * std, "{} off by {off}, {std}", estimate.name);
        assert!(std < 5e-2 * joint.compliance(), "{} {std}", estimate.name);
    }
    // Thirty loads, each on a robot at rest, do not tell weights well from a compliance.
    for (estimate, truth) in found.estimates[5..].iter().zip([2e-4, 8e-8, 5e-8]) {
        let (off, std) = ((estimate.value - truth).abs(), estimate.std.expect("it is seen"));
        assert!(off <= 0.1 * truth || off < 1.96 * std, "{} off by {off}, {std}", estimate.name);
        assert!(std < 0.3 * truth, "{} {std}", estimate.name);
    }
    // A compliance that varies is a share of the joint's own, and grows with it.
    truth.effects.push(Effect::PoseDependentCompliance { joint: 2, cos1: 0.5, sin1: 0.3, cos2: 0.0, sin2: 0.1 });
    let known = campaign(&truth, stiffer(&truth), Frame::Tool, [0.2, -0.1, 0.3], true);
    let found = identify(&known).expect("all joints are seen");
    let off = found.estimates[1].value / truth.joints[1].compliance() - 1.0;
    assert!(off.abs() < 5e-3, "{off}");
}

/// The flange axis of the arm goes through its TCP: without moments and lever
/// arms, joint 5 does not move the point it is read at.
#[test]
fn a_joint_that_cannot_be_seen_keeps_what_is_declared() {
    let mut truth = five_axis();
    truth.joints[4].a = 0.0;
    let mut campaign = campaign(&truth, stiffer(&truth), Frame::Base, [0.0; 3], false);
    if let Data::Displacement(data) = &mut campaign.data {
        data.rows.iter_mut().for_each(|row| row.rotation = None);
    }
    let found = identify(&campaign).expect("four joints are seen");
    let unseen = &found.estimates[4];
    assert_eq!((unseen.value, unseen.std, &unseen.visibility), (unseen.declared, None, &Visibility::Unseen));
    assert!((found.estimates[1].value / truth.joints[1].compliance() - 1.0).abs() < 5e-3);
    assert_eq!(found.description.joints[4], campaign.robot.joints[4]);
}

/// What gives way has a column, or is a share of what has one.
#[test]
fn no_effect_is_left_out_of_the_regression() {
    use robstiff_robots::effect::{CATALOGUE, DhEntry, Place};

    let places = [
        Place::Joint(2),
        Place::Joints([1, 2]),
        Place::Link(2),
        Place::Base,
        Place::Tool,
        Place::Entry(DhEntry::A(2)),
        Place::Robot,
    ];
    for about in CATALOGUE.iter().filter(|about| !about.kinematic) {
        let place = places.into_iter().find(|&place| about.at.takes(place)).expect("some place");
        let numbers = vec![0.5; about.parameters.len()];
        let effect = Effect::of_kind(about.kind, place, &numbers).expect("an effect of the catalogue");
        // A preload is where curves begin, and gives way to nothing itself.
        let begins = matches!(effect, Effect::GravityPreload { .. });
        let with = Description { effects: vec![effect], ..five_axis() };
        let is_fitted = declared(&with).iter().any(|own| matches!(own.what, Own::Effect(..)));
        assert!(begins || is_fitted || matches!(effect, Effect::PoseDependentCompliance { .. }), "{effect}");
    }
}

/// A reading that is off by far more than noise has no part in the fit; many are a matter
/// of something else.
#[test]
fn a_reading_that_does_not_belong_is_left_out() {
    let wild = |every: usize| {
        move |i: usize, row: &mut Observation| row.displacement[1] += if i % every == 3 { 0.02 } else { 0.0 }
    };
    let plan = crate::campaign::made::Plan::new(9);
    let right = identify(&plan.run()).expect("all joints are seen");
    let campaign = plan.run_with(wild(500));
    let found = identify(&campaign).expect("all joints are seen");
    let Data::Displacement(data) = &campaign.data else { unreachable!("displacements") };
    assert_eq!((right.left_out.len(), found.left_out), (0, vec![data.rows[3].line]));
    for (right, found) in right.estimates.iter().zip(&found.estimates) {
        let std = right.std.unwrap_or_else(|| panic!("{right:?}"));
        assert!(
            (right.value - found.value).abs() < std && found.std.is_some_and(|found| found < 1.2 * std),
            "{found:?}"
        );
    }
    assert!(found.rms < right.rms.map(|rms| 1.1 * rms));
    assert!(identify(&plan.run_with(wild(6))).expect("all joints are seen").left_out.is_empty());
    assert_eq!(identify(&plan.run_with(wild(40))).expect("all joints are seen").left_out.len(), 10);
}

#[test]
fn parts_of_a_compound_joint_keep_their_proportion() {
    let mut description = five_axis();
    description.joints[2].compliance = vec![
        robstiff_robots::Part { name: "gear".into(), value: 1e-7 },
        robstiff_robots::Part { name: "belt".into(), value: 3e-7 },
    ];
    let values: Vec<f64> = vec![1e-7, 1e-7, 8e-7, 1e-7, 1e-7];
    let own = declared(&description);
    let changed = values.iter().zip(&own).fold(description, |changed, (value, own)| with_value(changed, own, *value));
    let parts: Vec<f64> = changed.joints[2].compliance.iter().map(|part| part.value).collect();
    assert!((parts[0] - 2e-7).abs() < 1e-20 && (parts[1] - 6e-7).abs() < 1e-20);
}

/// A lever of length `l` under a constant force across it turns by
/// `h F l cos(angle)`: the tip moves by `l sin` across and `l (cos - 1)` along.
#[test]
fn the_second_order_is_that_of_a_lever() {
    let (length, h, force) = (1.0, 1e-6, 1000.0);
    let description = arm(Convention::Standard, &[[0.0, 0.0, length, 0.0, h]]);
    let data = Displacements {
        wrench_frame: Frame::Base,
        wrench_at: [0.0; 3],
        measured_frame: Frame::Base,
        measured_at: [0.0; 3],
        directions: crate::campaign::AXES.to_vec(),
        poses: vec!["1".into()],
        visits: vec!["1".into()],
        rows: vec![Observation {
            line: 2,
            pose: 0,
            visit: 0,
            time: None,
            temperature: None,
            q: vec![0.0],
            wrench: [0.0, force, 0.0, 0.0, 0.0, 0.0],
            displacement: [0.0; 3],
            rotation: None,
            encoders: None,
            motors: None,
        }],
    };
    let observation = Displacement::new(&description, &data);
    let (parameters, values) = as_declared(&description);
    let beyond = observation.second_order(observation.world(), &parameters, &values);
    let mut angle: f64 = 0.0;
    for _ in 0..20 {
        angle = h * force * length * angle.cos();
    }
    let exact =
        DVector::from_column_slice(&[length * (angle.cos() - 1.0), length * (angle.sin() - h * force * length), 0.0]);
    assert!((beyond - exact).amax() < 1e-12);
}

/// Displacements in another unit are those of joints so many times as compliant, which by the
/// formula for moved arms go round in circles.
#[test]
fn displacements_in_another_unit_have_no_second_order() {
    let truth = five_axis();
    for unit in [1e3, 1e6, 1e12] {
        let mut campaign = campaign(&truth, stiffer(&truth), Frame::Base, [0.0; 3], true);
        let Data::Displacement(data) = &mut campaign.data else { unreachable!("made above") };
        for row in &mut data.rows {
            row.displacement = row.displacement.map(|d| unit * d);
            row.rotation = row.rotation.map(|rotation| rotation.map(|r| unit * r));
        }
        let found = displacement::identify(&campaign, made::displacements(&campaign)).expect("all joints are seen");
        for (estimate, joint) in found.estimates.iter().zip(&truth.joints) {
            let off = (estimate.value / unit / joint.compliance() - 1.0).abs();
            assert!(off < 1e-6, "{unit:e}: {} off by {off}", estimate.name);
        }
    }
}

/// What the description lacks hides which of two joints with axes 3 cm apart gives way, in the
/// noise or in what they are sure to, but not that one does.
#[test]
fn joints_that_look_alike_are_not_both_lost() {
    let mut robot = five_axis();
    robot.joints[1].a = 0.03;
    let hidden = vec![Effect::TransverseCompliance { joint: 4, value: 6e-6 }];
    let plan = Plan { robot, hidden, ..Plan::new(5) };
    let seen = |plan: Plan| {
        let found = identify(&plan.run()).expect("joints are seen");
        found.estimates[1..3].iter().filter(|estimate| estimate.visibility == Visibility::Seen).count()
    };
    assert_eq!(seen(plan.clone()), 1);
    assert_eq!(seen(Plan { visits: 1, ramp: vec![1.0], ..plan }), 1);
}

/// A robot that was imported is rigid: its compliances have no declared value to be held to.
#[test]
fn wrong_signs_are_told_of_a_rigid_robot_too() {
    let rigid = {
        let mut robot = five_axis();
        robot.joints.iter_mut().for_each(|joint| joint.compliance.iter_mut().for_each(|part| part.value = 0.0));
        robot
    };
    let mut campaign = Plan::new(3).run();
    campaign.robot = rigid;
    assert!(identify(&campaign).is_ok());
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements were planned") };
    data.rows.iter_mut().for_each(|row| row.displacement = row.displacement.map(|reading| -reading));
    for declared in [None, Some(1e-5)] {
        campaign.noise.displacement = declared;
        let told = identify(&campaign).map(|_| ()).expect_err("signs are wrong");
        assert!(matches!(told, Error::AgainstTheLoads(_)), "{told:?}");
    }
}

/// Neither in the numbers nor in how displacements and rotations are weighed against each other.
#[test]
fn poses_held_out_have_no_part_in_the_fit() {
    let truth = five_axis();
    let mut campaign = campaign(&truth, stiffer(&truth), Frame::Base, [0.0; 3], true);
    campaign.holdout = Some(crate::campaign::Holdout { fraction: 0.25, seed: 1 });
    let fitted_to = crate::campaign::holdout::training(30, campaign.holdout);
    let estimates = |off: f64| -> Vec<f64> {
        let mut campaign = campaign.clone();
        if let Data::Displacement(data) = &mut campaign.data {
            for row in &mut data.rows {
                let noise = |k: usize| (12.9898 * (row.pose * 6 + k) as f64).sin();
                row.displacement = core::array::from_fn(|k| row.displacement[k] + 5e-6 * noise(k));
                let share = if fitted_to[row.pose] { 1.0 } else { off };
                let rotation = row.rotation.expect("rotations are read");
                row.rotation = Some(core::array::from_fn(|k| share * (rotation[k] + 3e-5 * noise(3 + k))));
            }
        }
        identify(&campaign).expect("all joints are seen").estimates.iter().map(|estimate| estimate.value).collect()
    };
    assert!(fitted_to.iter().any(|fitted| !fitted));
    assert_eq!(estimates(1.0), estimates(20.0));
}

/// The error that is reported is that of the description that is written.
#[test]
fn the_error_is_that_of_the_description() {
    let robot = {
        let mut robot = stiffer(&five_axis());
        robot.effects = vec![Effect::PoseDependentCompliance { joint: 2, cos1: 0.4, sin1: 0.2, cos2: 0.0, sin2: 0.0 }];
        robot
    };
    for robot in [stiffer(&five_axis()), robot] {
        let campaign = Campaign { robot, ..Plan::new(8).run() };
        let found = identify(&campaign).expect("all joints are seen");
        assert!(found.left_out.is_empty());
        for (robot, rms) in [(&campaign.robot, found.rms_declared), (&found.description, found.rms)] {
            let predicted = predict(robot, &campaign).expect("of the same robot").rms;
            assert!(rms.is_some_and(|rms| (rms / predicted - 1.0).abs() < 1e-6), "{rms:?} {predicted}");
        }
    }
}

/// A dial gauge shows less, and what it shows is right.
#[test]
fn one_direction_shows_joints_too() {
    let plan = Plan::new(8);
    let mut campaign = plan.run();
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements were planned") };
    data.directions = vec![[0.0, 0.0, 1.0]];
    data.rows.iter_mut().for_each(|row| row.displacement = [0.0, 0.0, row.displacement[2]]);
    let found = identify(&campaign).expect("joints are seen");
    let joints = found.estimates.iter().zip(&plan.robot.joints);
    let off: Vec<f64> =
        joints.filter_map(|(found, truth)| Some((found.value - truth.compliance()) / found.std?)).collect();
    assert!(off.len() >= 3 && off.iter().all(|off| off.abs() < 3.5), "{off:?}");
}
