//! What mechanics says of the equilibrium, checked from outside.

use nalgebra::Vector3;
use robstiff_robots::{Convention, Description, Effect, JointKind, Placement};

use super::{Arm, Hidden, Outside, five_axis, six_axis};

/// One pose of the six-axis arm, with no angle of a special size (rad).
const POSE: [f64; 6] = [0.4, -1.1, 0.7, 0.9, -0.8, 1.3];

fn every_effect() -> Vec<Effect> {
    vec![
        Effect::TransverseCompliance { joint: 3, value: 6e-7 },
        Effect::TransverseCompliance { joint: 1, value: 1e-7 },
        Effect::LinkCompliance { link: 2, bending: 7e-8, torsion: 1.2e-7 },
        Effect::LinkCompliance { link: 3, bending: 9e-8, torsion: 1.1e-7 },
        Effect::BaseCompliance { tilt: 2e-8, translation: 3e-9 },
        Effect::ToolCompliance { rotation: 3e-7, translation: 1e-8 },
        Effect::JointCoupling { joints: [5, 6], value: -1.2e-6 },
        Effect::StiffnessNonlinearity { joint: 2, added: 2e-7, knee: 700.0 },
        Effect::StiffnessNonlinearity { joint: 5, added: -1e-6, knee: 90.0 },
    ]
}

fn times(wrench: [f64; 6], factor: f64) -> [f64; 6] {
    wrench.map(|component| component * factor)
}

/// Whether two vectors agree to a share of the longer one.
fn near(one: [f64; 3], other: [f64; 3], share: f64) -> bool {
    let (one, other) = (Vector3::from(one), Vector3::from(other));
    (one - other).norm() <= share * one.norm().max(other.norm())
}

/// A rigid arm lying along x: two joints `length` apart, the TCP at the second.
fn stick(length: f64) -> Description {
    let mut arm = five_axis();
    arm.joints.truncate(2);
    for (joint, a) in arm.joints.iter_mut().zip([length, 0.0]) {
        (joint.theta, joint.d, joint.a, joint.alpha) = (0.0, 0.0, a, 0.0);
        joint.compliance.clear();
    }
    arm.tool = Placement::default();
    arm
}

#[test]
fn the_arms_stand_as_drawn() {
    let right = std::f64::consts::FRAC_PI_2;
    // Springs that carry no load are not there.
    for effects in [Vec::new(), every_effect()] {
        let tcp = |q: [f64; 6]| Arm::new(&six_axis(), &effects).tcp(&q);
        // Stretched upwards, and with the forearm level.
        assert!(near(tcp([0.0, -right, 0.0, 0.4, 0.0, 0.0]), [0.295, 0.0, 3.45], 1e-15));
        assert!(near(tcp([0.0, -right, right, 0.4, 0.0, 0.0]), [1.8, 0.0, 2.055], 1e-15));
        assert!(near(tcp([right, -right, right, 0.0, 0.0, 0.0]), [0.0, 1.8, 2.055], 1e-15));
    }
    // Upper arm up, elbow and fork head up, forearm ahead, spindle to the left.
    let tcp = Arm::new(&five_axis(), &every_effect()[..6]).tcp(&[0.0; 5]);
    assert!(near(tcp, [0.41 + 1.1, 0.12, 0.865 + 1.0 + 0.25 + 0.3], 1e-15));
}

#[test]
fn work_done_is_energy_stored() {
    // Loads well beyond what the gears take, so that the shape matters.
    let arm = [
        Hidden::LostMotion { joint: 3, gap: 3e-4, knee: 2000.0 },
        Hidden::Outside(Outside::SoftFoundation { compliance: 4e-8, knee: 9000.0 }),
        Hidden::Outside(Outside::LooseFlange { gap: 2e-4, knee: 3000.0 }),
        Hidden::Outside(Outside::LooseTaper { gap: 2e-4, knee: 600.0 }),
        Hidden::Outside(Outside::HardeningBearing { joint: 2, compliance: 1e-7, knee: 4000.0 }),
    ];
    let arm = arm.iter().fold(Arm::new(&six_axis(), &every_effect()), |arm, hidden| arm.hiding(hidden)).at(&POSE);
    let full = [9e3, -7e3, 1.2e4, 0.0, 0.0, 0.0];
    // The work of a dead load that grows: F d at the end, less what d grew by
    // while F did (Simpson over 40 steps).
    let along = |share: f64| -> f64 {
        let moved = arm.settle(&times(full, share)).displacement;
        moved.iter().zip(full).map(|(moved, force)| moved * force).sum()
    };
    let steps = 40;
    let weight = |step: usize| match step {
        0 | 40 => 1.0,
        odd if odd % 2 == 1 => 4.0,
        _ => 2.0,
    };
    let integral: f64 = (0..=steps).map(|step| weight(step) * along(step as f64 / 40.0)).sum::<f64>() / 120.0;
    let work = along(1.0) - integral;
    let energy = arm.settle(&full).energy;
    assert!(energy > 100.0 && (work / energy - 1.0).abs() < 1e-6, "{work} J {energy} J");
}

#[test]
fn small_loads_answer_each_other() {
    // Maxwell and Betti: what one unit load does along another, the other does
    // along the one. (The gears' knees are left out: they bend too early for
    // this many digits.)
    let arm = Arm::new(&six_axis(), &every_effect()[..7]).at(&POSE);
    let answer = |axis: usize| -> [f64; 6] {
        let unit = |size: f64| {
            let mut wrench = [0.0; 6];
            wrench[axis] = size;
            let settled = arm.settle(&wrench);
            [settled.displacement, settled.rotation].concat()
        };
        let (one, other) = (unit(1.0), unit(-1.0));
        std::array::from_fn(|index| (one[index] - other[index]) / 2.0)
    };
    let all: [[f64; 6]; 6] = std::array::from_fn(answer);
    for (i, row) in all.iter().enumerate() {
        assert!(row[i] > 0.0);
        for (j, value) in row.iter().enumerate() {
            assert!((value - all[j][i]).abs() < 1e-8 * (row[i] * all[j][j]).sqrt(), "{i} {j}: {value} {}", all[j][i]);
        }
    }
}

#[test]
fn a_beam_is_a_cantilever() {
    let (length, bending, torsion) = (1.3, 4e-6, 7e-6);
    let beam = Effect::LinkCompliance { link: 1, bending, torsion };
    // Also turned, for the beam has no preferred sides.
    for segments in [1, 4] {
        let arm = Arm::new(&stick(length), &[beam]).with_segments(segments);
        let settle = |wrench| arm.deflect(&[0.0, 0.8], &wrench);
        // Up at the tip turns it about -y, left about +z.
        let up = settle([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        assert!(near(up.displacement, [0.0, 0.0, length * length / 3.0 * bending], 1e-5));
        assert!(near(up.rotation, [0.0, -length / 2.0 * bending, 0.0], 1e-9));
        let left = settle([0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(near(left.displacement, [0.0, length * length / 3.0 * bending, 0.0], 1e-5));
        assert!(near(left.rotation, [0.0, 0.0, length / 2.0 * bending], 1e-9));
        let nod = settle([0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        assert!(near(nod.displacement, [0.0, 0.0, -length / 2.0 * bending], 1e-5));
        assert!(near(nod.rotation, [0.0, bending, 0.0], 1e-9));
        let twist = settle([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
        assert!(near(twist.rotation, [torsion, 0.0, 0.0], 1e-9));
        assert!(Vector3::from(twist.displacement).norm() < 1e-15);
        let pull = settle([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(Vector3::from(pull.displacement).norm() < 1e-15);
    }
}

#[test]
fn a_strongly_bent_beam_is_an_elastica() {
    // A cantilever under a dead load with F L^2 / EI = 1: from the elliptic
    // integrals (Mattiasson 1981) it goes down by 0.30172 L, in by 0.05643 L
    // and turns by 0.46135 rad.
    let beam = Effect::LinkCompliance { link: 1, bending: 1.0, torsion: 1.0 };
    let bent = |segments: usize| {
        let arm = Arm::new(&stick(1.0), &[beam]).with_segments(segments);
        arm.deflect(&[0.0, 0.0], &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    };
    let fine = bent(64);
    assert!((fine.displacement[2] - 0.30172).abs() < 1e-5, "{fine:?}");
    assert!((fine.displacement[0] + 0.05643).abs() < 1e-5, "{fine:?}");
    assert!((fine.rotation[1] + 0.46135).abs() < 1e-5, "{fine:?}");
    // Twice the segments, a fourth of the error or less.
    let error = |segments| (bent(segments).displacement[2] - fine.displacement[2]).abs();
    let errors = [1, 2, 4, 8].map(error);
    assert!(errors.windows(2).all(|pair| pair[1] < pair[0] / 3.5), "{errors:?}");
}

#[test]
fn segments_are_enough_for_an_arm() {
    let effects = [2, 3].map(|link| Effect::LinkCompliance { link, bending: 7e-8, torsion: 1.2e-7 });
    let arm = Arm::new(&six_axis(), &effects);
    let wrench = [800.0, -700.0, 600.0, 50.0, -80.0, 30.0];
    let (usual, fine) = (arm.deflect(&POSE, &wrench), arm.with_segments(40).deflect(&POSE, &wrench));
    assert!(near(usual.displacement, fine.displacement, 3e-8));
    assert!(near(usual.rotation, fine.rotation, 3e-8));
}

#[test]
fn superposition_fails_as_the_shape_changes() {
    // Without nonlinear gears the sum of two deflections misses that of the sum
    // of the loads by the square of the load, some 0.1 % of it at 800 N.
    let effects = &every_effect()[..7];
    let arm = Arm::new(&six_axis(), effects).at(&POSE);
    let one = [500.0, 0.0, -600.0, 0.0, 0.0, 0.0];
    let other = [0.0, 800.0, 0.0, 0.0, 0.0, 0.0];
    let miss = |size: f64| {
        let moved = |wrench| Vector3::from(arm.settle(&times(wrench, size)).displacement);
        let both = std::array::from_fn(|axis| one[axis] + other[axis]);
        ((moved(both) - moved(one) - moved(other)).norm(), moved(both).norm())
    };
    let ((small, _), (large, whole)) = (miss(1.0), miss(2.0));
    assert!((large / small - 4.0).abs() < 0.1, "{}", large / small);
    assert!((2e-4..2e-2).contains(&(large / whole)), "{}", large / whole);
}

#[test]
fn both_conventions_are_one_arm() {
    let standard = six_axis();
    let mut modified = Description { convention: Convention::Modified, ..standard.clone() };
    for (index, joint) in modified.joints.iter_mut().enumerate() {
        let before = index.checked_sub(1).map(|before| &standard.joints[before]);
        (joint.a, joint.alpha) = before.map_or((0.0, 0.0), |before| (before.a, before.alpha));
    }
    // Effects of joints 1, 4 and 6 and of links that end there sit elsewhere
    // along the axis in the other convention; these do not.
    let effects = every_effect();
    let effects: Vec<_> = [0, 2, 4, 5, 6, 7, 8].map(|index| effects[index]).into();
    let wrench = [300.0, -900.0, 500.0, 40.0, 60.0, -90.0];
    let deflect = |arm: &Description| Arm::new(arm, &effects).deflect(&POSE, &wrench);
    let (one, other) = (deflect(&standard), deflect(&modified));
    assert!(near(one.displacement, other.displacement, 1e-9));
    assert!(near(one.rotation, other.rotation, 1e-9));
}

#[test]
fn the_base_carries_everything_with_it() {
    let plain = five_axis();
    let base = Placement { xyz: [1.0, -2.0, 0.5], rpy: [0.3, -0.4, 0.9] };
    let moved = Description { base, ..plain.clone() };
    let turn = nalgebra::Rotation3::from_euler_angles(0.3, -0.4, 0.9);
    let (force, moment) = (Vector3::new(500.0, 300.0, -800.0), Vector3::new(30.0, -50.0, 20.0));
    let wrench = |force: Vector3<f64>, moment: Vector3<f64>| [force.x, force.y, force.z, moment.x, moment.y, moment.z];
    let effects = &every_effect()[..6];
    let one = Arm::new(&plain, effects).deflect(&POSE[..5], &wrench(force, moment));
    let other = Arm::new(&moved, effects).deflect(&POSE[..5], &wrench(turn * force, turn * moment));
    assert!(near((turn * Vector3::from(one.displacement)).into(), other.displacement, 1e-11));
    assert!(near((turn * Vector3::from(one.rotation)).into(), other.rotation, 1e-11));
    let tcp = turn * Vector3::from(Arm::new(&plain, &[]).tcp(&POSE[..5])) + Vector3::from(base.xyz);
    assert!(near(tcp.into(), Arm::new(&moved, &[]).tcp(&POSE[..5]), 1e-14));
}

#[test]
fn moments_turn_joints_by_their_law() {
    // Two parallel joints under a moment about them: no lever arm comes in.
    let mut arm = stick(1.0);
    arm.joints[0].compliance = vec![robstiff_robots::Part { name: "gear".into(), value: 3e-7 }];
    arm.joints[1].compliance = vec![robstiff_robots::Part { name: "gear".into(), value: 5e-7 }];
    let effects = [
        Effect::JointCoupling { joints: [1, 2], value: -2e-7 },
        Effect::StiffnessNonlinearity { joint: 2, added: 4e-7, knee: 100.0 },
    ];
    let arm = Arm::new(&arm, &effects);
    for moment in [1.0_f64, -75.0, 100.0, 2000.0] {
        let turned = arm.deflect(&[0.2, 0.3], &[0.0, 0.0, 0.0, 0.0, 0.0, moment]).rotation;
        let expected = 4e-7 * moment + 4e-7 * moment / (1.0 + (moment / 100.0).powi(2)).sqrt();
        assert!(near(turned, [0.0, 0.0, expected], 1e-10));
    }
}

#[test]
fn sliding_joints_slide() {
    let mut arm = stick(1.0);
    arm.joints[1].kind = JointKind::Prismatic;
    arm.joints[1].compliance = vec![robstiff_robots::Part { name: String::new(), value: 2e-8 }];
    let arm = Arm::new(&arm, &[]);
    assert_eq!(arm.tcp(&[0.0, 0.25]), [1.0, 0.0, 0.25]);
    let settled = arm.deflect(&[0.0, 0.25], &[10.0, 20.0, 300.0, 0.0, 5.0, 0.0]);
    assert!(near(settled.displacement, [0.0, 0.0, 6e-6], 1e-9));
    assert_eq!(settled.rotation, [0.0; 3]);
}

#[test]
fn tilt_has_no_preferred_direction() {
    // About x and y of the joint frame alike, and so the same wherever the
    // joint stands; nothing about its own axis.
    let arm = Arm::new(&stick(1.0), &[Effect::TransverseCompliance { joint: 1, value: 1e-6 }]);
    for angle in [0.0, 0.7, 2.0] {
        let settled = arm.deflect(&[angle, 0.0], &[30.0, -20.0, 400.0, 7.0, 0.0, 9.0]);
        assert!((settled.displacement[2] - (4e-4 + 7e-6 * angle.sin())).abs() < 2e-8, "{settled:?}");
        assert!(settled.rotation[2].abs() < 1e-15);
    }
}

#[test]
#[should_panic(expected = "does not fit")]
fn effects_that_do_not_fit_are_refused() {
    Arm::new(&five_axis(), &[Effect::LinkCompliance { link: 5, bending: 1e-7, torsion: 0.0 }]);
}

#[test]
#[should_panic(expected = "does not settle")]
fn an_arm_that_buckles_is_refused() {
    let tilt = Effect::TransverseCompliance { joint: 1, value: 1.0 };
    Arm::new(&stick(1.0), &[tilt]).deflect(&[0.0, 0.0], &[-50.0, 0.0, 20.0, 0.0, 0.0, 0.0]);
}
