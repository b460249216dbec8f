//! Identification axis by axis, as in the paper: all axes before one are
//! clamped, the axis is loaded, and how far it turns over how much torque is
//! its compliance, which is held against what the maker says.
//!
//! The rows are simulated: a moment turns the tool about the axis of the one
//! joint that is let go, about which axis and how far is read from the tool.

use std::fmt::Write as _;
use std::fs;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_identify::campaign::Campaign;
use robstiff_identify::identify::{Identification, Visibility, identify};
use robstiff_robots::{Description, Part};
use robstiff_tests::folder::Folder;
use robstiff_tests::simulator::{Arm, Scenario, five_axis};

/// One sigma of a deflection reading (rad).
const NOISE: f64 = 1e-6;

/// Readings of an axis: up and down in both directions.
const LOADS: [f64; 8] = [200.0, 500.0, 800.0, 500.0, -200.0, -500.0, -800.0, -500.0];

/// The arm as the maker describes it; joints 3 and 5 are a gear and a belt.
fn declared() -> Description {
    let mut arm = five_axis();
    let part = |name: &str, value| Part { name: name.into(), value };
    arm.joints[2].compliance = vec![part("gear", 1.9e-7), part("belt", 1.22e-7)];
    arm.joints[4].compliance = vec![part("gear", 5.2e-6), part("belt", 2.6e-6)];
    arm
}

/// What the joints are over what is declared.
const FACTORS: [f64; 5] = [1.1, 0.85, 1.4, 0.7, 1.2];

/// The arm in the hall. The belt of joint 3 has slackened, the gear is as new:
/// only the sum can be seen.
fn truth() -> Description {
    let mut arm = declared();
    for (joint, factor) in arm.joints.iter_mut().zip(FACTORS) {
        let sum = joint.compliance();
        joint.compliance.last_mut().expect("a part").value += (factor - 1.0) * sum;
    }
    arm
}

/// Turns of the loaded axis under moments: the table that is written down.
fn rows(arm: &Description, axes: &[usize], random: &mut ChaCha8Rng) -> String {
    let mut table = String::from("axis,torque [Nm],deflection [urad]\n");
    for &axis in axes {
        let mut clamped = arm.clone();
        for (_, joint) in clamped.joints.iter_mut().enumerate().filter(|(index, _)| index + 1 != axis) {
            joint.compliance.iter_mut().for_each(|part| part.value = 0.0);
        }
        let clamped = Arm::new(&clamped, &[]);
        let q: Vec<f64> = (0..5).map(|_| random.random_range(-0.9..0.9)).collect();
        let push = Vector3::new(0.6, -0.5, 0.7);
        let turn = |load: f64| {
            let moment = push * load;
            let turned = Vector3::from(clamped.deflect(&q, &[0.0, 0.0, 0.0, moment.x, moment.y, moment.z]).rotation);
            // The tool turns about the axis; the torque is the moment about it.
            (moment.dot(&turned) / turned.norm(), turned.norm())
        };
        for load in LOADS {
            let (torque, angle) = turn(load);
            let sign = load.signum();
            let noise: f64 = (0..12).map(|_| random.random_range(-0.5..0.5)).sum::<f64>() * NOISE;
            writeln!(table, "{axis},{},{}", sign * torque, 1e6 * (sign * angle + noise)).expect("a text");
        }
    }
    table
}

fn identified(declared: &Description, table: &str) -> Identification {
    let folder = Folder::new();
    let write = |file: &str, text: &str| fs::write(folder.0.join(file), text).expect("a temporary file");
    write("robot.yaml", &declared.to_yaml());
    write("campaign.yaml", "name: axis by axis\nrobot: robot.yaml\nobservations: axes.csv\nkind: clamped\n");
    write("axes.csv", table);
    let campaign = Campaign::read(folder.0.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"));
    identify(&campaign).unwrap_or_else(|problem| panic!("{problem}"))
}

#[test]
fn each_axis_is_found_and_the_far_off_are_flagged() {
    let (declared, truth) = (declared(), truth());
    let mut random = ChaCha8Rng::seed_from_u64(700);
    let found = identified(&declared, &rows(&truth, &[1, 2, 3, 4, 5], &mut random));
    assert_eq!((found.rows, found.poses, found.noise), (40, 0, None));
    for ((estimate, joint), factor) in found.estimates.iter().zip(&truth.joints).zip(FACTORS) {
        let std = estimate.std.expect("eight readings");
        assert!(std < 0.05 * estimate.value, "{estimate:?}");
        assert!((estimate.value - joint.compliance()).abs() < 4.0 * std, "{estimate:?}");
        assert!((estimate.deviation().expect("declared") + 1.0 - factor).abs() < 0.1, "{estimate:?}");
    }
    let flagged: Vec<&str> = found.estimates.iter().filter(|e| e.is_noteworthy()).map(|e| e.name.as_str()).collect();
    assert_eq!(flagged, ["joint 3", "joint 4"]);
}

/// The measurement sees the sum of a gear and a belt, so they keep their
/// proportion, and the description that is written has the sum.
#[test]
fn parts_share_what_is_found() {
    let declared = declared();
    let mut random = ChaCha8Rng::seed_from_u64(701);
    let found = identified(&declared, &rows(&truth(), &[3, 5], &mut random));
    let read = Description::parse("robot.yaml", &found.description.to_yaml()).expect("what was written");
    assert_eq!(read, found.description);
    for (index, (before, after)) in declared.joints.iter().zip(&read.joints).enumerate() {
        let estimate = &found.estimates[index];
        if ![2, 4].contains(&index) {
            assert_eq!((before, estimate.std, &estimate.visibility), (after, None, &Visibility::Unseen));
            continue;
        }
        assert!((after.compliance() / estimate.value - 1.0).abs() < 1e-12);
        let [gear, belt] = [0, 1].map(|part| after.compliance[part].value / before.compliance[part].value);
        assert!((gear / belt - 1.0).abs() < 1e-12 && (gear - FACTORS[index]).abs() < 0.1, "{gear} {belt}");
        assert_eq!(after.compliance.iter().map(|part| part.name.as_str()).collect::<Vec<_>>(), ["gear", "belt"]);
    }
}

/// Both ways to the compliances of the joints, axis by axis and all at once from
/// the tool, are of the same robot.
#[test]
fn axis_by_axis_agrees_with_all_at_once() {
    let (declared, truth) = (declared(), truth());
    let mut random = ChaCha8Rng::seed_from_u64(702);
    let by_axis = identified(&declared, &rows(&truth, &[1, 2, 3, 4, 5], &mut random));
    let folder = Folder::new();
    Scenario::new(truth, Vec::new(), 702).run().write(&folder.0, &declared.to_yaml()).expect("files");
    let campaign = Campaign::read(folder.0.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"));
    let at_once = identify(&campaign).expect("all joints are seen");
    for (one, other) in by_axis.estimates.iter().zip(&at_once.estimates) {
        assert_eq!(one.name, other.name);
        let std = one.std.expect("seen").hypot(other.std.expect("seen"));
        assert!((one.value - other.value).abs() < 4.0 * std, "{one:?} {other:?}");
    }
}

#[test]
fn an_axis_against_its_torque_is_refused() {
    let folder = Folder::new();
    let write = |file: &str, text: &str| fs::write(folder.0.join(file), text).expect("a temporary file");
    write("robot.yaml", &declared().to_yaml());
    write("campaign.yaml", "robot: robot.yaml\nobservations: axes.csv\nkind: clamped\n");
    write("axes.csv", "axis,torque [Nm],deflection [urad]\n1,100,30\n2,100,-30\n2,200,-60\n");
    let campaign = Campaign::read(folder.0.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"));
    assert_eq!(
        identify(&campaign).expect_err("a sign is wrong").to_string(),
        "axis 2 deflects against its torque (rows from line 3): check the signs"
    );
}
