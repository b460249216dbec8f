//! Each hidden thing alone, against what it is to first order, written out
//! here.

use nalgebra::Vector3;
use robstiff_robots::{Description, Effect, Link, Placement};

use super::{Arm, DhColumn, Follows, GRAVITY, Hidden, Mount, Outside, Row, Scenario, five_axis, six_axis};

/// One pose of the six-axis arm, with no angle of a special size (rad).
const POSE: [f64; 6] = [0.4, -1.1, 0.7, 0.9, -0.8, 1.3];

/// An arm that nothing moves: what is read then is the rig's doing.
pub(super) fn rigid() -> Description {
    let mut arm = six_axis();
    arm.joints.iter_mut().for_each(|joint| joint.compliance.clear());
    arm
}

pub(super) fn small(truth: Description, hidden: Hidden) -> Scenario {
    Scenario { poses: 4, noise: 0.0, ..Scenario::new(truth, Vec::new(), 21) }.hiding(hidden)
}

pub(super) fn rows(truth: Description, hidden: Hidden) -> Vec<Row> {
    small(truth, hidden).run().rows
}

pub(super) fn force(row: &[f64; 6]) -> Vector3<f64> {
    Vector3::from_column_slice(&row[..3])
}

pub(super) fn vector(three: [f64; 3]) -> Vector3<f64> {
    three.into()
}

pub(super) fn assert_near(found: Vector3<f64>, expected: Vector3<f64>, allowed: f64) {
    assert!((found - expected).norm() <= allowed, "{found}{expected}");
}

/// Joint 2 of the six-axis arm, of compliance `h`, under a torque about it:
/// how far it turns beyond what a plain one does.
fn beyond(hidden: &Hidden, q: &[f64; 6], torque: f64) -> f64 {
    // A moment about the joint's axis, which is level and across the arm's
    // plane; all other joints are rigid.
    let mut description = rigid();
    description.joints[1].compliance = six_axis().joints[1].compliance.clone();
    let axis = [-q[0].sin(), q[0].cos(), 0.0];
    let wrench = [0.0, 0.0, 0.0, axis[0] * torque, axis[1] * torque, 0.0];
    let turned = |arm: &Arm| vector(arm.deflect(q, &wrench).rotation).dot(&vector(axis));
    let plain = Arm::new(&description, &[]);
    turned(&plain.clone().hiding(hidden)) - turned(&plain)
}

#[test]
fn a_joint_turns_by_what_is_added_to_its_law() {
    let h = six_axis().joints[1].compliance();
    for torque in [-900.0_f64, -20.0, 5.0, 400.0] {
        let near = |hidden: Hidden, expected: f64| {
            let found = beyond(&hidden, &POSE, torque);
            assert!((found - expected).abs() < 1e-12, "{hidden:?}: {found} {expected}");
        };
        let lost = Hidden::LostMotion { joint: 2, gap: 3e-4, knee: 12.0 };
        near(lost, 1.5e-4 * torque / torque.hypot(12.0));
        let plays = Hidden::Hysteresis { joint: 2, operators: vec![(10.0, 3e-8), (300.0, 5e-8)] };
        let played = |radius: f64| torque.signum() * (torque.abs() - radius).max(0.0);
        near(plays, 3e-8 * played(10.0) + 5e-8 * played(300.0));
        let q = POSE[1];
        let varies = Hidden::PoseDependentCompliance { joint: 2, cos: [0.2, -0.1], sin: [0.15, 0.05] };
        let factor = 0.2 * q.cos() - 0.1 * (2.0 * q).cos() + 0.15 * q.sin() + 0.05 * (2.0 * q).sin();
        near(varies, h * factor * torque);
        let crossed = Outside::CrossDependence { joint: 2, of: 3, cos: 0.3, sin: -0.1 };
        near(Hidden::Outside(crossed), h * (0.3 * POSE[2].cos() - 0.1 * POSE[2].sin()) * torque);
        near(Hidden::Outside(Outside::WarmingJoint { joint: 2, per_kelvin: 0.1 }), 0.0);
    }
}

#[test]
fn angles_and_lengths_are_where_they_are_said_to_be_wrong() {
    let tcp = |hidden: Hidden| vector(Arm::new(&six_axis(), &[]).hiding(&hidden).tcp(&POSE));
    let plain = |q: [f64; 6]| vector(Arm::new(&six_axis(), &[]).tcp(&q));
    let turned = |joint: usize, by: f64| {
        let mut q = POSE;
        q[joint - 1] += by;
        plain(q)
    };
    assert_near(tcp(Hidden::JointZeroOffset { joint: 3, offset: 0.02 }), turned(3, 0.02), 1e-14);
    let error = Hidden::TransmissionError { joint: 2, order: 3, sin: 1e-3, cos: -2e-3 };
    assert_near(tcp(error), turned(2, 1e-3 * (3.0 * POSE[1]).sin() - 2e-3 * (3.0 * POSE[1]).cos()), 1e-14);
    // Row 4 is d along the forearm's axis, which is joint 4's: the TCP shifts
    // along it wherever the wrist turns.
    let longer = tcp(Hidden::DhError { of: DhColumn::D, row: 4, by: 1e-3 }) - plain(POSE);
    assert!((longer.norm() - 1e-3).abs() < 1e-15);
    let (one, other) = (turned(4, 0.5), turned(4, -0.5));
    assert!(longer.dot(&(one - other)).abs() < 1e-15);
    let wider = tcp(Hidden::DhError { of: DhColumn::A, row: 1, by: 1e-3 }) - plain(POSE);
    assert_near(wider, Vector3::new(POSE[0].cos(), POSE[0].sin(), 0.0) * 1e-3, 1e-14);
    // A twist turns what follows about the x axis of its row.
    let twisted = tcp(Hidden::DhError { of: DhColumn::Alpha, row: 1, by: 1e-3 }) - plain(POSE);
    let x = Vector3::new(POSE[0].cos(), POSE[0].sin(), 0.0);
    assert_near(twisted, x.cross(&(plain(POSE) - x * 0.35 - Vector3::z() * 0.75)) * 1e-3, 2e-6);
}

fn heavy() -> Vec<Link> {
    let link = |mass, center_of_mass| Link { mass, center_of_mass };
    vec![
        link(300.0, [-0.1, 0.0, 0.0]),
        link(250.0, [-0.6, 0.05, 0.1]),
        link(180.0, [0.0, -0.1, 0.2]),
        link(60.0, [0.0, 0.0, -0.3]),
        link(40.0, [0.0, 0.02, 0.0]),
        link(150.0, [0.05, 0.0, 0.2]),
    ]
}

/// The center of mass of a link in the base frame: the tip of an arm that ends
/// there.
fn center(number: usize, link: &Link, q: &[f64]) -> Vector3<f64> {
    let mut arm = six_axis();
    arm.joints.truncate(number);
    arm.tool = Placement { xyz: link.center_of_mass, rpy: [0.0; 3] };
    vector(Arm::new(&arm, &[]).tcp(&q[..number]))
}

#[test]
fn weight_sags_by_the_slopes_of_its_potential() {
    let arm = six_axis();
    let step = 1e-5;
    let slope = |of: &dyn Fn(&[f64]) -> Vector3<f64>, joint: usize| {
        let at = |by: f64| {
            let mut q = POSE;
            q[joint] += by;
            of(&q)
        };
        (at(step) - at(-step)) / (2.0 * step)
    };
    // A thousandth of the weight, so that first order is enough.
    let sag = |share: f64| {
        let links = heavy().into_iter().map(|link| Link { mass: link.mass * share, ..link }).collect();
        vector(Arm::new(&arm, &[]).hiding(&Hidden::GravitySag(links)).at(&POSE).sag())
    };
    let mut expected = Vector3::zeros();
    for joint in 0..6 {
        let torque: f64 = heavy()
            .iter()
            .enumerate()
            .filter(|(link, _)| *link >= joint)
            .map(|(link, body)| -GRAVITY * body.mass * slope(&|q| center(link + 1, body, q), joint).z)
            .sum();
        expected += slope(&|q| vector(Arm::new(&arm, &[]).tcp(q)), joint) * (arm.joints[joint].compliance() * torque);
    }
    assert_near(sag(1e-3) * 1e3, expected, 1e-5 * expected.norm());
    // Some millimetres, of which hardly anything is in displacements.
    assert!((5e-4..1e-2).contains(&expected.norm()), "{expected}");
    let plain = rows(arm.clone(), Hidden::JointZeroOffset { joint: 1, offset: 0.0 });
    let sagging = rows(arm, Hidden::GravitySag(heavy()));
    for (one, other) in plain.iter().zip(&sagging) {
        let (one, other) = (vector(one.displacement), vector(other.displacement));
        assert!((one - other).norm() < 2e-2 * one.norm() && one != other);
    }
}

#[test]
fn weight_that_keeps_the_sign_hides_lost_motion() {
    let lost = Hidden::LostMotion { joint: 2, gap: 3e-4, knee: 5.0 };
    let seen = |arm: &Arm| {
        let with = arm.clone().hiding(&lost).deflect(&POSE, &[0.0, 0.0, -200.0, 0.0, 0.0, 0.0]);
        let without = arm.deflect(&POSE, &[0.0, 0.0, -200.0, 0.0, 0.0, 0.0]);
        (vector(with.displacement) - vector(without.displacement)).norm()
    };
    let light = Arm::new(&six_axis(), &[]);
    assert!(seen(&light) > 1e-4 && seen(&light.clone().hiding(&Hidden::GravitySag(heavy()))) < 1e-6);
}

#[test]
fn a_lever_arm_adds_a_moment() {
    let at = [0.03, -0.02, 0.05];
    let arm = Arm::new(&six_axis(), &[]);
    let posed = arm.at(&POSE);
    let lever = posed.tool() * vector(at);
    let pull = Vector3::new(0.3, -0.2, 0.5);
    let moment = lever.cross(&pull);
    let shifted = arm.clone().hiding(&Hidden::LeverArm(at)).deflect(&POSE, &[0.3, -0.2, 0.5, 0.0, 0.0, 0.0]);
    let expected = posed.settle(&[0.3, -0.2, 0.5, moment.x, moment.y, moment.z]);
    let size = vector(expected.displacement).norm();
    assert_near(vector(shifted.displacement), vector(expected.displacement), 1e-5 * size);
    assert!(
        (vector(shifted.displacement) - vector(posed.settle(&[0.3, -0.2, 0.5, 0.0, 0.0, 0.0]).displacement)).norm()
            > 1e-3 * size
    );
}

#[test]
fn a_cable_shares_the_load() {
    // A joint about z with an arm of 1 m along x, and a cable across its end.
    let mut arm = five_axis();
    arm.joints.truncate(1);
    let joint = &mut arm.joints[0];
    (joint.theta, joint.d, joint.a, joint.alpha) = (0.0, 0.0, 1.0, 0.0);
    joint.compliance[0].value = 1e-7;
    arm.tool = Placement::default();
    let (stiffness, length) = (2e6, 3.0);
    let cable = Outside::Cable { link: 1, anchor: [1.0, -3.001, 0.0], stiffness, length };
    let tied = Arm::new(&arm, &[]).hiding(&Hidden::Outside(cable));
    let turned = |moment: f64| tied.deflect(&[0.0], &[0.0, 0.0, 0.0, 0.0, 0.0, moment]).rotation[2];
    // Beside the joint's 1e7 Nm/rad, the cable has its stiffness times 1 m
    // squared (and its tension of some 2 kN over its length, a thousandth).
    let expected = 100.0 / (1e7 + stiffness);
    assert!((turned(100.0) / expected - 1.0).abs() < 1e-3, "{}", turned(100.0));
    // Once it hangs loose it does nothing.
    let loose = Outside::Cable { link: 1, anchor: [1.0, -2.9, 0.0], stiffness, length };
    let loose = Arm::new(&arm, &[]).hiding(&Hidden::Outside(loose));
    let moved = loose.deflect(&[0.0], &[0.0, 0.0, 0.0, 0.0, 0.0, 100.0]).rotation[2];
    assert!((moved - 1e-5).abs() < 1e-18);
}

#[test]
fn a_mat_and_a_loose_pin_let_go_as_they_should() {
    let soft = Outside::SoftFoundation { compliance: 5e-8, knee: 2000.0 };
    let mat = Arm::new(&rigid(), &[]).hiding(&Hidden::Outside(soft));
    let turned = mat.deflect(&POSE, &[0.0, 0.0, 0.0, 300.0, 400.0, 500.0]).rotation;
    let factor = 5e-8 / 1_f64.hypot(500.0 / 2000.0);
    assert_near(vector(turned), Vector3::new(300.0, 400.0, 0.0) * factor, 1e-9);
    let pin = Arm::new(&rigid(), &[]).hiding(&Hidden::Outside(Outside::LooseFlange { gap: 2e-4, knee: 10.0 }));
    let x = pin.at(&POSE).tool().column(0).into_owned();
    let pull = Vector3::new(50.0, -80.0, 30.0);
    let moved = pin.deflect(&POSE, &[pull.x, pull.y, pull.z, 0.0, 0.0, 0.0]).displacement;
    let along = pull.dot(&x);
    assert_near(vector(moved), x * (1e-4 * along / along.hypot(10.0)), 1e-15);
}

#[test]
fn what_has_a_memory_shows_it_within_a_visit() {
    // Up and down again: the second half of the ramp is not the first.
    let lag = |row: &[Row]| (vector(row[4].displacement) - vector(row[0].displacement)).norm();
    let elastic = small(six_axis(), Hidden::LostMotion { joint: 2, gap: 1e-4, knee: 20.0 }).run();
    let plays = Hidden::Hysteresis { joint: 2, operators: vec![(50.0, 1e-7)] };
    let viscous = Outside::ViscousJoint { joint: 2, compliance: 1e-7, constant: 90.0 };
    let [plays, viscous] = [plays, Hidden::Outside(viscous)].map(|hidden| small(six_axis(), hidden).run());
    let largest = |rows: &[Row]| rows.chunks(5).map(lag).fold(0.0, f64::max);
    assert_eq!(largest(&elastic.rows), 0.0);
    assert!(largest(&plays.rows) > 5e-6 && largest(&viscous.rows) > 5e-6);
    // Warmth softens from row to row.
    let warming = Hidden::Outside(Outside::WarmingJoint { joint: 2, per_kelvin: 0.1 });
    assert!(largest(&small(six_axis(), warming).run().rows) > 1e-6);
}

/// Every kind, for what has to hold for all.
fn all() -> Vec<Hidden> {
    let ground = Mount::Ground;
    let mut all = vec![
        Hidden::Elastic(Effect::TransverseCompliance { joint: 3, value: 6e-7 }),
        Hidden::LostMotion { joint: 2, gap: 1e-4, knee: 20.0 },
        Hidden::Hysteresis { joint: 2, operators: vec![(50.0, 1e-7)] },
        Hidden::PoseDependentCompliance { joint: 2, cos: [0.2, 0.1], sin: [0.1, 0.0] },
        Hidden::JointZeroOffset { joint: 3, offset: 0.02 },
        Hidden::DhError { of: DhColumn::A, row: 2, by: 0.02 },
        Hidden::TransmissionError { joint: 2, order: 1, sin: 0.01, cos: 0.0 },
        Hidden::GravitySag(heavy()),
        Hidden::LoadCellMisalignment { turn: [0.1, 0.0, 0.0], mount: ground },
        Hidden::LoadCellBias { force: [20.0, 0.0, 0.0], mount: ground },
        Hidden::LoadCellScale { scale: [0.1, 0.0, 0.0], mount: ground },
        Hidden::LeverArm([0.02, 0.0, 0.0]),
        Hidden::TrackerMisalignment([0.1, 0.0, 0.0]),
        Hidden::ThermalDrift { rate: [1e-4, 0.0, 0.0], follows: Follows::Time },
        Hidden::Creep { share: 0.02, onset: 10.0 },
        Hidden::Outliers { share: 0.1, size: 1e-4 },
        Hidden::BaseSlip { shift: [1e-4, 0.0, 0.0], turn: [0.0; 3], when: 0.5 },
        Hidden::ReflectorSlip { shift: [1e-4, 0.0, 0.0], when: 0.5 },
    ];
    let outside = [
        Outside::ViscousJoint { joint: 2, compliance: 1e-7, constant: 90.0 },
        Outside::Cable { link: 3, anchor: [-1.0, 0.0, 2.0], stiffness: 1e5, length: 0.2 },
        Outside::LinkGrowth { link: 2, per_kelvin: 23e-6 },
        Outside::SoftFoundation { compliance: 5e-8, knee: 1000.0 },
        Outside::CrossDependence { joint: 2, of: 3, cos: 0.3, sin: 0.1 },
        Outside::LooseFlange { gap: 1e-4, knee: 50.0 },
        Outside::LooseTaper { gap: 2e-4, knee: 50.0 },
        Outside::HardeningBearing { joint: 2, compliance: 2e-7, knee: 300.0 },
        Outside::WarmingJoint { joint: 2, per_kelvin: 0.05 },
        Outside::OneSided { joint: 2, added: 1e-7 },
        Outside::GainOfAngle { joint: 1, gain: 0.1 },
        Outside::BentCell { bend: 0.1 },
        Outside::LoadFriction { share: 0.05 },
    ];
    all.extend(outside.map(Hidden::Outside));
    all
}

#[test]
fn nothing_hidden_changes_poses_loads_or_noise() {
    let scenario = Scenario { poses: 3, unloaded_first: true, ..Scenario::new(six_axis(), Vec::new(), 5) };
    let plain = scenario.run();
    for hidden in all() {
        let run = scenario.clone().hiding(hidden.clone()).run();
        let mut differs = false;
        for (one, other) in run.rows.iter().zip(&plain.rows) {
            assert_eq!((&one.q, one.acting, one.time), (&other.q, other.acting, other.time), "{hidden:?}");
            let noise = |row: &Row| vector(row.displacement) - vector(row.exact_displacement);
            assert_near(noise(one), noise(other), 1e-17);
            differs |= one.exact_displacement != other.exact_displacement || one.wrench != other.wrench;
        }
        assert!(differs, "{hidden:?} does nothing");
    }
}

#[test]
fn half_the_size_does_half() {
    for hidden in all() {
        // Those that gravity or a cable bends the arm by are in no proportion.
        if matches!(hidden, Hidden::GravitySag(_) | Hidden::Outside(Outside::Cable { .. })) {
            continue;
        }
        let scenario =
            Scenario { poses: 3, unloaded_first: true, noise: 0.0, ..Scenario::new(six_axis(), Vec::new(), 5) };
        let plain = scenario.run();
        let does = |factor: f64| -> Vec<f64> {
            let run = scenario.clone().hiding(hidden.scaled(factor)).run();
            let change = |(one, other): (&Row, &Row)| {
                let moved = (vector(one.displacement) - vector(other.displacement)) * 1e6;
                let cell = force(&one.wrench) - force(&other.wrench);
                [moved.x, moved.y, moved.z, cell.x, cell.y, cell.z]
            };
            run.rows.iter().zip(&plain.rows).flat_map(change).collect()
        };
        let (one, two) = (does(0.01), does(0.02));
        let largest = two.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        for (one, two) in one.iter().zip(&two) {
            assert!((2.0 * one - two).abs() < 5e-3 * largest + 1e-9, "{hidden:?}: {one} {two}");
        }
    }
}
