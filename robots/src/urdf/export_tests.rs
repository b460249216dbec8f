use core::f64::consts::FRAC_PI_2;
use core::iter::zip;
use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::{Isometry3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::{Export, Tree};
use crate::{Convention, Description, DhEntry, Effect, JointKind, Placement};

const ARM: &str = include_str!("arm.urdf");

fn tree(text: &str) -> Tree {
    Tree::parse("arm.urdf", text).unwrap_or_else(|problems| panic!("{problems}"))
}

fn imported(text: &str, tip: &str) -> Description {
    tree(text).chain(None, Some(tip)).unwrap().description()
}

fn export(text: &str, tip: &str, robot: &Description) -> Export {
    tree(text).export(None, Some(tip), robot).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The frames of the links at a pose, by the digits of the file: a reader of its own, that knows
/// nothing of rounded angles.
fn links(text: &str, q: &[f64]) -> Vec<(String, Isometry3<f64>)> {
    let document = roxmltree::Document::parse(text).unwrap();
    let joints = || document.descendants().filter(|node| node.has_tag_name("joint"));
    let attribute = |joint: roxmltree::Node<'_, '_>, tag: &str, name: &str| {
        let child = joint.children().find(|child| child.has_tag_name(tag));
        child.and_then(|child| child.attribute(name)).map(String::from)
    };
    let numbers = |text: Option<String>, other: [f64; 3]| {
        text.map_or(other, |text| {
            let words: Vec<f64> = text.split_whitespace().map(|word| word.parse().unwrap()).collect();
            words.try_into().unwrap()
        })
    };
    let moving: Vec<_> = joints().filter(|joint| joint.attribute("type") != Some("fixed")).collect();
    let mut frames = Vec::new();
    for link in document.descendants().filter(|node| node.has_tag_name("link")) {
        let (mut frame, mut name) = (Isometry3::identity(), link.attribute("name").unwrap().to_owned());
        while let Some(joint) = joints().find(|joint| attribute(*joint, "child", "link").as_deref() == Some(&name)) {
            let xyz = numbers(attribute(joint, "origin", "xyz"), [0.0; 3]);
            let [roll, pitch, yaw] = numbers(attribute(joint, "origin", "rpy"), [0.0; 3]);
            let axis = Vector3::from(numbers(attribute(joint, "axis", "xyz"), [1.0, 0.0, 0.0])).normalize();
            let q = moving.iter().position(|other| *other == joint).map_or(0.0, |index| q[index]);
            let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_euler_angles(roll, pitch, yaw));
            let motion = match joint.attribute("type") {
                Some("prismatic") => Translation3::from(axis * q).into(),
                _ => Isometry3::rotation(axis * q),
            };
            frame = Isometry3::from_parts(Translation3::from(Vector3::from(xyz)), turn) * motion * frame;
            name = attribute(joint, "parent", "link").unwrap();
        }
        frames.push((link.attribute("name").unwrap().to_owned(), frame));
    }
    frames
}

fn link(text: &str, name: &str, q: &[f64]) -> Isometry3<f64> {
    links(text, q).into_iter().find(|(link, _)| link == name).unwrap().1
}

/// The table's own meaning.
fn by_table(robot: &Description, q: &[f64]) -> Isometry3<f64> {
    let placement = |at: &Placement| {
        let [x, y, z] = at.rpy;
        let turn = Isometry3::rotation(Vector3::z() * z)
            * Isometry3::rotation(Vector3::y() * y)
            * Isometry3::rotation(Vector3::x() * x);
        Isometry3::from(Translation3::from(Vector3::from(at.xyz))) * turn
    };
    let mut pose = placement(&robot.base);
    for (joint, &q) in zip(robot.corrected_joints(), q) {
        let (theta, d) = match joint.kind {
            JointKind::Revolute => (joint.theta + q, joint.d),
            JointKind::Prismatic => (joint.theta, joint.d + q),
        };
        let along = Isometry3::translation(0.0, 0.0, d) * Isometry3::rotation(Vector3::z() * theta);
        let across = Isometry3::translation(joint.a, 0.0, 0.0) * Isometry3::rotation(Vector3::x() * joint.alpha);
        pose *= if robot.convention == Convention::Standard { along * across } else { across * along };
    }
    pose * placement(&robot.tool)
}

fn apart(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    (a.to_homogeneous() - b.to_homogeneous()).abs().max()
}

const POSES: [[f64; 8]; 3] =
    [[0.0; 8], [0.3, -0.4, 0.5, 1.6, -0.7, 0.8, 0.2, -0.9], [-2.1, 0.9, -1.5, 0.4, 1.7, -2.8, 1.1, 0.6]];

/// The largest difference of the tip between a file and a description.
fn off(text: &str, tip: &str, robot: &Description) -> f64 {
    let off = |q: &[f64; 8]| apart(&link(text, tip, q), &by_table(robot, &q[..robot.joints.len()]));
    POSES.iter().map(off).fold(0.0, f64::max)
}

fn corrected() -> Description {
    let mut robot = imported(ARM, "cutter_tip");
    robot.base = Placement { xyz: [0.001, -0.002, 0.0005], rpy: [0.001, -0.0007, 0.0004] };
    robot.joints[0].d += 0.0011;
    robot.joints[1].a -= 0.0007;
    robot.joints[1].alpha = 0.0009;
    robot.joints[3].theta += 0.004;
    robot.joints[5].a += 0.0003;
    robot.tool.xyz[0] += 0.002;
    robot.effects = vec![
        Effect::JointZeroOffset { joint: 2, value: 0.003 },
        Effect::DhError { entry: DhEntry::Alpha(3), value: -0.0012 },
        Effect::DhError { entry: DhEntry::D(4), value: 0.0008 },
        Effect::TransverseCompliance { joint: 3, value: 1e-7 },
    ];
    robot
}

#[test]
fn a_calibrated_description_goes_there_and_back() {
    let robot = corrected();
    let exported = export(ARM, "cutter_tip", &robot);
    assert!(off(&exported.text, "cutter_tip", &robot) < 1e-11, "{}", off(&exported.text, "cutter_tip", &robot));
    assert!(off(ARM, "cutter_tip", &robot) > 1e-3);
    assert_eq!(exported.warnings, Vec::<String>::new());
    let again = imported(&exported.text, "cutter_tip");
    for q in POSES {
        assert!(apart(&by_table(&robot, &q[..6]), &by_table(&again, &q[..6])) < 1e-9);
    }
}

/// Of what is not changed nothing is written, and of what is only the two attributes.
#[test]
fn all_but_the_origins_stays_byte_for_byte() {
    let windows = format!("\u{feff}{}", ARM.replace('\n', "\r\n").replace(" rpy=\"0 0 0\"", "\trpy = '0  0 0'"));
    for text in [ARM, &windows] {
        // The flange is not behind the angle that is rounded at the tip.
        let robot = imported(text, "flange");
        let exported = export(text, "flange", &robot);
        let exact = text.replacen("rpy=\"0 1.5708 0\"", "rpy=\"0 1.5707963267948966 0\"", 1);
        assert_eq!((exported.text.as_str(), exported.exact), (exact.as_str(), 1));
        let mut longer = robot.clone();
        longer.joints[0].d += 0.25;
        let moved = export(text, "flange", &longer).text;
        assert_eq!(moved, exact.replacen("xyz=\"0.32 0 0\"", "xyz=\"0.32 0 0.25\"", 1));
    }
}

/// Where a table has its frames is its own matter: on an axis they may be anywhere.
#[test]
fn another_table_of_the_same_arm_changes_nothing() {
    let mut robot = imported(ARM, "flange");
    // Axes 2 and 3 are parallel.
    robot.joints[1].d += 0.2;
    robot.joints[2].d -= 0.2;
    // About the last axis the table and the tool turn alike.
    robot.joints[5].theta += 0.5;
    robot.tool.rpy[2] -= 0.5;
    robot.joints[5].d -= 0.1;
    robot.tool.xyz[2] += 0.1;
    let exact = ARM.replacen("rpy=\"0 1.5708 0\"", "rpy=\"0 1.5707963267948966 0\"", 1);
    assert_eq!(export(ARM, "flange", &robot).text, exact);
    // The same rows, each with the turn and the length before it.
    let mut modified = imported(ARM, "flange");
    let rows = modified.joints.clone();
    modified.convention = Convention::Modified;
    for (joint, before) in zip(&mut modified.joints[1..], &rows) {
        (joint.a, joint.alpha) = (before.a, before.alpha);
    }
    (modified.joints[0].a, modified.joints[0].alpha) = (0.0, 0.0);
    (modified.tool.xyz[0], modified.tool.rpy[0]) = (rows[5].a, rows[5].alpha);
    assert_eq!(export(ARM, "flange", &modified).text, exact);
}

/// Where each link's frame is at zero against the template, as a motion in the base frame.
fn moved(robot: &Description) -> Vec<(String, Isometry3<f64>)> {
    let text = export(ARM, "cutter_tip", robot).text;
    // The template as it is meant, with its rounded angles exact.
    let exact = export(ARM, "cutter_tip", &imported(ARM, "cutter_tip")).text;
    let pairs = zip(links(&exact, &[0.0; 8]), links(&text, &[0.0; 8]));
    pairs.map(|((name, old), (_, new))| (name, new * old.inverse())).collect()
}

/// A zero offset turns the link itself about its axis and all that is behind it; meshes follow.
#[test]
fn a_zero_offset_turns_what_is_behind_the_joint() {
    let nominal = imported(ARM, "cutter_tip");
    for (index, axis) in
        [Vector3::z(), Vector3::y(), Vector3::y(), Vector3::x(), Vector3::y(), Vector3::x()].into_iter().enumerate()
    {
        let mut robot = nominal.clone();
        robot.effects = vec![Effect::JointZeroOffset { joint: index + 1, value: 0.01 }];
        let center = link(ARM, &format!("link_{}", index + 1), &[0.0; 8]).translation.vector;
        for (name, motion) in moved(&robot) {
            let number = name.strip_prefix("link_").map(|number| number.parse().unwrap_or(0));
            let is_behind = match name.as_str() {
                "base_link" => false,
                // It is on link 3.
                "cable_guide" => index < 3,
                _ => number.is_none_or(|number: usize| number > index),
            };
            let turn = Isometry3::rotation(axis * 0.01);
            let turn = Translation3::from(center) * turn * Translation3::from(-center);
            let expected = if is_behind { turn } else { Isometry3::identity() };
            assert!(apart(&motion, &expected) < 1e-11, "{index} {name}: {motion}");
        }
    }
}

/// A length displaces what is behind its end, and no link along its own axis.
#[test]
fn a_length_shifts_what_is_behind_it() {
    for (row, along, first) in [(1, Vector3::z(), 2), (4, Vector3::x(), 5), (6, Vector3::x(), 7)] {
        let mut robot = imported(ARM, "cutter_tip");
        robot.effects = vec![Effect::DhError { entry: DhEntry::D(row), value: 0.002 }];
        for (name, motion) in moved(&robot) {
            let number = match name.as_str() {
                "base_link" => 0,
                "cable_guide" => 3,
                "cutter_tip" => 7,
                "flange" | "spindle" => 6,
                _ => name.strip_prefix("link_").unwrap().parse().unwrap(),
            };
            let expected = if number >= first { along * 0.002 } else { Vector3::zeros() };
            assert!(apart(&motion, &Translation3::from(expected).into()) < 1e-11, "{row} {name}: {motion}");
        }
    }
}

/// No link goes further than the errors of the table take it.
#[test]
fn corrections_move_no_link_further_than_they_are() {
    for (name, motion) in moved(&corrected()) {
        // Some milliradians on three metres, and some millimetres.
        let center = link(ARM, &name, &[0.0; 8]).translation.vector;
        let shift = motion * Point3::from(center) - Point3::from(center);
        assert!(shift.norm() < 0.02 && motion.rotation.angle() < 0.01, "{name}: {motion}");
    }
}

#[test]
fn a_joint_without_origin_gets_one() {
    for (from, to, here) in [
        (
            "<origin xyz=\"0.32 0 0\"/>",
            "",
            "<joint name=\"joint_2\" type=\"revolute\">\n    <origin xyz=\"0.32 0 0.78\" rpy=\"0 0 0\"/>\n    <parent",
        ),
        ("<origin xyz=\"0.32 0 0\"/>", "<origin/>", "<origin xyz=\"0.32 0 0.78\"/>"),
        ("<origin xyz=\"0.32 0 0\"/>", "<origin />", "<origin xyz=\"0.32 0 0.78\" />"),
        (
            "<origin xyz=\"0.32 0 0\"/>",
            "<origin rpy='0 0 0'></origin>",
            "<origin rpy='0 0 0' xyz=\"0.32 0 0.78\"></origin>",
        ),
    ] {
        let bare = ARM.replacen(from, to, 1).replacen("<origin xyz=\"0 0 0.78\" rpy=\"0 0 0\"/>", "", 1);
        let text = export(&bare, "flange", &imported(ARM, "flange")).text;
        assert!(off(&text, "flange", &imported(ARM, "flange")) < 1e-12);
        assert!(text.contains(here), "{text}");
    }
    let close = ARM.replacen("<origin xyz=\"0.32 0 0\"/>", "", 1).replacen(
        "revolute\">\n    <parent link=\"link_1\"",
        "revolute\"><!-- a --><parent link=\"link_1\"",
        1,
    );
    let text = export(&close, "flange", &imported(ARM, "flange")).text;
    assert!(text.contains("revolute\"><origin xyz=\"0.32 0 0\" rpy=\"0 0 0\"/><!-- a -->"), "{text}");
}

#[test]
fn limits_are_changed_where_the_description_has_others() {
    let mut robot = imported(ARM, "flange");
    robot.joints[0].limits = Some([-2.5, 2.967]);
    robot.joints[1].limits = None;
    robot.joints[5].limits = Some([-1.0, 1.0]);
    let exported = export(ARM, "flange", &robot);
    let exact = ARM.replacen("rpy=\"0 1.5708 0\"", "rpy=\"0 1.5707963267948966 0\"", 1);
    assert_eq!(exported.text, exact.replace("lower=\"-2.967\"", "lower=\"-2.5\""));
    let changed: Vec<_> = exported.joints.iter().map(|joint| joint.limits.is_some()).collect();
    assert_eq!(changed, [true, false, false, false, false, false]);
    assert_eq!(
        exported.warnings,
        ["the description's limits of the joint `joint_6` are left out: it has none in the template"]
    );
    let one = ARM.replacen("lower=\"-2.967\" ", "", 1);
    assert!(export(&one, "flange", &robot).text.contains("velocity=\"1.7\" lower=\"-2.5\"/>"));
}

#[test]
fn what_moves_with_the_pose_is_left_out_with_a_word() {
    let mut robot = imported(ARM, "flange");
    robot.effects = vec![Effect::TransmissionError { joint: 2, order: 1.0, sin: 1e-4, cos: 0.0 }];
    let exported = export(ARM, "flange", &robot);
    assert_eq!(exported.warnings, ["transmission_error@joint 2 is left out: a URDF file has no word for it"]);
}

#[test]
fn other_arms_are_refused_where_they_differ() {
    let refused =
        |text: &str, tip: &str, robot: &Description| tree(text).export(None, Some(tip), robot).unwrap_err().to_string();
    let robot = imported(ARM, "flange");
    let mut fewer = robot.clone();
    fewer.joints.pop();
    let said = refused(ARM, "flange", &fewer);
    assert!(
        said.contains("6 moving joints from `base_link` to `flange`, 5 moving joints in the description"),
        "{said}"
    );
    assert!(said.contains("arm.urdf:1:1"), "{said}");
    let mut sliding = robot.clone();
    sliding.joints[2].kind = JointKind::Prismatic;
    let said = refused(ARM, "flange", &sliding);
    assert!(
        said.contains("the joint `joint_3` turns, the description's slides") && said.contains("arm.urdf:42:3"),
        "{said}"
    );
    // The first joint counted the other way round.
    let mut other = robot.clone();
    other.base.rpy[0] = 2.0 * FRAC_PI_2;
    let said = refused(ARM, "flange", &other);
    assert!(said.contains("at zero the description turns what the joint `joint_1` carries by 180.0 deg"), "{said}");
    // The second one.
    let mut other = robot.clone();
    other.joints[0].alpha = FRAC_PI_2;
    let said = refused(ARM, "flange", &other);
    assert!(said.contains("at zero the description turns what the joint `joint_1` carries by 180.0 deg"), "{said}");
    assert!(said.contains("arm.urdf:32:3"), "{said}");
}

/// The frame of a link is on the axis of its joint: a tool beside it needs a fixed joint.
#[test]
fn a_tip_that_turns_itself_takes_what_it_can() {
    let mut robot = imported(ARM, "link_6");
    robot.joints[5].d += 0.003;
    robot.joints[4].theta += 0.002;
    let text = export(ARM, "link_6", &robot).text;
    assert!(off(&text, "link_6", &robot) < 1e-11);
    robot.tool.xyz[0] += 0.001;
    let said = tree(ARM).export(None, Some("link_6"), &robot).unwrap_err().to_string();
    assert!(said.contains("the tip `link_6` turns with the joint `joint_6` itself"), "{said}");
    assert!(said.contains("1.0e-3 m or rad beside its axis") && said.contains("arm.urdf:57:3"), "{said}");
}

/// The description that is meant by what is not: a hall's frame in place of the base link's.
#[test]
fn far_moves_are_asked_about() {
    let mut robot = imported(ARM, "flange");
    robot.base.xyz[0] = 1.5;
    let said = &export(ARM, "flange", &robot).warnings[0];
    assert!(said.contains("arm.urdf:32: the joint `joint_1` is moved by 1500 mm"), "{said}");
}

/// A joint: how it moves, axis, place, turn.
type Drawn = (u8, [f64; 3], [f64; 3], [f64; 3]);

fn drawn() -> impl Strategy<Value = Drawn> {
    let angle = || prop_oneof![4 => prop::sample::select(vec![0.0, FRAC_PI_2, -FRAC_PI_2]), 1 => -3.0..3.0_f64];
    let axis = prop_oneof![
        3 => prop::sample::select(vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]),
        1 => prop::array::uniform3(-1.0..1.0_f64).prop_filter("a direction", |v| Vector3::from(*v).norm() > 0.2),
    ];
    let length = || prop_oneof![2 => Just(0.0), 1 => Just(0.5), 2 => -1.5..1.5_f64];
    let kind = prop_oneof![1 => Just(0_u8), 5 => Just(1), 2 => Just(2)];
    (kind, axis, prop::array::uniform3(length()), prop::array::uniform3(angle()))
}

fn urdf(joints: &[Drawn]) -> String {
    let mut text = String::from("<robot name=\"drawn\">\n<link name=\"l0\"/>\n");
    for (i, (kind, axis, xyz, rpy)) in joints.iter().enumerate() {
        let kind = ["fixed", "continuous", "prismatic"][usize::from(*kind)];
        let [axis, xyz, rpy] = [axis, xyz, rpy].map(|numbers| numbers.map(|number| format!("{number:?}")).join(" "));
        text += &format!(
            "<link name=\"l{0}\"/><joint name=\"j{i}\" type=\"{kind}\"><parent link=\"l{i}\"/><child link=\"l{0}\"/>\
             <origin xyz=\"{xyz}\" rpy=\"{rpy}\"/><axis xyz=\"{axis}\"/></joint>\n",
            i + 1
        );
    }
    let end = joints.len() + 1;
    text + &format!(
        "<link name=\"l{end}\"/><joint name=\"end\" type=\"fixed\"><parent link=\"l{}\"/><child link=\"l{end}\"/></joint></robot>",
        end - 1
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_chain_takes_any_correction(
        joints in prop::collection::vec(drawn(), 1..9),
        errors in prop::array::uniform8(prop::array::uniform4(-0.002..0.002_f64)),
        tool in prop::array::uniform6(-0.002..0.002_f64),
    ) {
        let moving = joints.iter().filter(|joint| joint.0 > 0).count();
        prop_assume!((1..=8).contains(&moving));
        let (text, tip) = (urdf(&joints), format!("l{}", joints.len() + 1));
        let mut robot = tree(&text).chain(Some("l0"), Some(&tip)).unwrap().description();
        let far = robot.joints.iter().map(|joint| joint.d.abs() + joint.a.abs()).fold(1.0, f64::max);
        // Axes that are almost parallel have their table far away, where an angle is long.
        prop_assume!(far < 20.0);
        // Nothing is corrected: not a byte.
        let same = tree(&text).export(Some("l0"), Some(&tip), &robot).unwrap().text;
        prop_assert!(off(&same, &tip, &robot) < 1e-9 * far);
        for (joint, [theta, d, a, alpha]) in zip(&mut robot.joints, errors) {
            joint.theta += theta;
            joint.d += d;
            joint.a += a;
            joint.alpha += alpha;
        }
        for (value, error) in zip(robot.tool.xyz.iter_mut().chain(&mut robot.tool.rpy), tool) {
            *value += error;
        }
        let exported = tree(&text).export(Some("l0"), Some(&tip), &robot).unwrap();
        prop_assert!(off(&exported.text, &tip, &robot) < 1e-9 * far, "{}", off(&exported.text, &tip, &robot));
    }
}
