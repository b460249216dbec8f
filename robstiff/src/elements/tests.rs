use std::{format, vec};

use super::*;
use crate::Generic;
use crate::samples::{arm, five_axis, linear_effects, odd, poses};

/// A link of length `LENGTH` along x between two joints, the TCP at its end.
const LENGTH: f64 = 1.5;

fn cantilever() -> Pose<2, f64> {
    let description = arm(Convention::Standard, &[[0.0, 0.0, LENGTH, 0.0, 0.0], [0.0; 5]]);
    Pose::of(&Generic::<2>::new(&description).unwrap(), &SVector::zeros())
}

#[test]
fn link_bends_like_a_cantilever() {
    let bending = cantilever().geometry().unit_compliance(Spring::LinkBending(1));
    // With the parameter L / EI = 1: L^3/3EI, L^2/2EI and L/EI at the tip.
    let (deflection, slope, turn) = (LENGTH * LENGTH / 3.0, LENGTH / 2.0, 1.0);
    #[rustfmt::skip]
    let expected = Matrix6::new(
        0.0, 0.0,        0.0,        0.0, 0.0,    0.0,
        0.0, deflection, 0.0,        0.0, 0.0,    slope,
        0.0, 0.0,        deflection, 0.0, -slope, 0.0,
        0.0, 0.0,        0.0,        0.0, 0.0,    0.0,
        0.0, 0.0,        -slope,     0.0, turn,   0.0,
        0.0, slope,      0.0,        0.0, 0.0,    turn,
    );
    assert!((bending - expected).amax() < 1e-15, "{bending}");
}

#[test]
fn link_twists_about_its_length() {
    let torsion = cantilever().geometry().unit_compliance(Spring::LinkTorsion(1));
    let mut expected = Matrix6::zeros();
    expected[(3, 3)] = 1.0;
    assert_eq!(torsion, expected);
}

#[test]
fn link_is_many_small_springs() {
    let robot = Generic::<6>::new(&odd()).unwrap();
    let springs = 2000;
    for q in poses() {
        let pose = Pose::of(&robot, &q);
        let geometry = pose.geometry();
        for link in [1, 2, 3] {
            let (near, far) = (origin(&geometry.joint_frames[link - 1]), origin(&geometry.joint_frames[link]));
            let e = (far - near).normalize();
            let u = e.cross(&Vector3::new(0.3, -0.5, 0.8)).normalize();
            let mut sum = Matrix6::zeros();
            for k in 0..springs {
                let point = near + (far - near) * ((f64::from(k) + 0.5) / f64::from(springs));
                let arm = origin(&geometry.tcp) - point;
                for u in [u, e.cross(&u)] {
                    let d = u.cross(&arm);
                    let s = Vector6::new(d.x, d.y, d.z, u.x, u.y, u.z);
                    sum += s * s.transpose() / f64::from(springs);
                }
            }
            let bending = geometry.unit_compliance(Spring::LinkBending(link));
            assert!((bending - sum).amax() < 1e-6 * sum.amax());
        }
    }
}

#[test]
fn link_without_length_adds_nothing() {
    // The odd robot's joints 4 and 5 meet in one point.
    let robot = Generic::<6>::new(&odd()).unwrap();
    for q in poses() {
        let pose = Pose::of(&robot, &q);
        assert_eq!(pose.geometry().unit_compliance(Spring::LinkBending(4)), Matrix6::zeros());
        assert_eq!(pose.geometry().unit_compliance(Spring::LinkTorsion(4)), Matrix6::zeros());
    }
}

/// A turn at a frame moves the TCP like a joint there would: the patterns
/// against `X C X^T` with `X = [[R, -[p - o]x R], [0, R]]`.
#[test]
fn patterns_are_compliances_moved_to_the_tool() {
    let robot = Generic::<6>::new(&odd()).unwrap();
    for q in poses() {
        let pose = Pose::of(&robot, &q);
        let geometry = pose.geometry();
        let moved = |frame: &Matrix4<f64>, diagonal: [f64; 6]| {
            let rotation = frame.fixed_view::<3, 3>(0, 0);
            let arm = origin(&geometry.tcp) - origin(frame);
            let mut x = Matrix6::zeros();
            x.fixed_view_mut::<3, 3>(0, 0).copy_from(&rotation);
            x.fixed_view_mut::<3, 3>(3, 3).copy_from(&rotation);
            x.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-arm.cross_matrix() * rotation));
            x * Matrix6::from_diagonal(&Vector6::from(diagonal)) * x.transpose()
        };
        let base = robot.base();
        let flange = robot.link_frames(&q)[5];
        let joint = joint_frame(&robot, &q, 3);
        assert_eq!(joint, robot.link_frames(&q)[2]);
        for (spring, frame, diagonal) in [
            (Spring::Transverse(3), joint, [0.0, 0.0, 0.0, 1.0, 1.0, 0.0]),
            (Spring::Joint(4), joint_frame(&robot, &q, 4), [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
            (Spring::Joint(3), joint, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
            (Spring::BaseTilt, base, [0.0, 0.0, 0.0, 1.0, 1.0, 0.0]),
            (Spring::BaseTranslation, base, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]),
            (Spring::ToolRotation, flange, [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
            (Spring::ToolTranslation, flange, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]),
        ] {
            let error = (geometry.unit_compliance(spring) - moved(&frame, diagonal)).amax();
            assert!(error < 1e-14, "{spring:?}: {error:e}");
        }
    }
}

#[test]
fn joint_frames_follow_the_convention() {
    let standard = Generic::<5>::new(&five_axis()).unwrap();
    let q = SVector::from([0.1, 0.2, 0.3, 0.4, 0.5]);
    assert_eq!(joint_frame(&standard, &q, 1), standard.base());
    assert_eq!(joint_frame(&standard, &q, 4), standard.link_frames(&q)[2]);
}

#[test]
fn coupling_is_an_entry_beside_the_diagonal() {
    let robot = Generic::<5>::new(&five_axis()).unwrap();
    for q in poses() {
        let pattern = Pose::of(&robot, &q).geometry().unit_compliance(Spring::Coupling([2, 4]));
        let mut entry = nalgebra::Matrix5::zeros();
        (entry[(1, 3)], entry[(3, 1)]) = (1.0, 1.0);
        let jacobian = robot.jacobian(&q);
        assert!((pattern - jacobian * entry * jacobian.transpose()).amax() < 1e-14);
    }
}

#[test]
fn contributions_add_up_and_are_named() {
    let mut description = five_axis();
    description.effects = linear_effects();
    let robot = Generic::<5>::new(&description).unwrap();
    for q in poses() {
        let whole = robot.compliance(&q);
        let force = Vector3::new(0.3, -0.4, 0.5);
        let (mut sum, mut along, mut shares) = (Matrix6::zeros(), 0.0, 0.0);
        for (_, part) in contributions(&robot, &q) {
            sum += part;
            along += share_along(&part, &whole, &force).unwrap();
            shares += share_of_translation(&part, &whole).unwrap();
        }
        assert!((sum - whole).amax() < 1e-14 * whole.amax());
        assert!((along - 1.0).abs() < 1e-13 && (shares - 1.0).abs() < 1e-13);
    }
    let names = contributions(&robot, &SVector::<f64, 5>::zeros()).map(|(element, _)| format!("{element}"));
    assert_eq!(names.skip(4).take(2).collect::<std::vec::Vec<_>>(), ["joint 5", "transverse_compliance@joint 3"]);
}

#[test]
fn rigid_robot_has_no_shares() {
    let rigid = Matrix6::<f64>::zeros();
    assert_eq!(share_along(&rigid, &rigid, &Vector3::x()), None);
    assert_eq!(share_of_translation(&rigid, &rigid), None);
}

#[test]
fn compliance_under_a_load_is_the_slope_of_the_deflection() {
    let mut description = five_axis();
    description.effects = vec![
        Effect::LostMotion { joint: 1, gap: 1e-4, knee: 40.0 },
        Effect::StiffnessNonlinearity { joint: 2, added: 3e-7, knee: 200.0 },
        Effect::TransverseCompliance { joint: 3, value: 2e-7 },
        Effect::PoseDependentCompliance { joint: 3, cos1: 0.2, sin1: 0.1, cos2: 0.0, sin2: 0.05 },
    ];
    let robot = Generic::<5>::new(&description).unwrap();
    let q = SVector::from([0.3, -0.4, 0.5, 0.2, 1.2]);
    let unloaded = robot.compliance(&q);
    assert!((compliance_under(&robot, &q, &Vector6::zeros()) - unloaded).amax() < 1e-14 * unloaded.amax());
    let load = Vector6::new(150.0, -80.0, 40.0, 3.0, -5.0, 2.0);
    let under = compliance_under(&robot, &q, &load);
    assert!((under - unloaded).amax() > 0.1 * unloaded.amax());
    for k in 0..6 {
        let step = Vector6::ith(k, 1e-2);
        let slope = (robot.deflection(&q, &(load + step)) - robot.deflection(&q, &(load - step))) / 2e-2;
        assert!((under.column(k) - slope).amax() < 1e-5 * under.amax(), "{k}");
    }
    // Small changes turn back within the radii of hysteresis.
    let hysteresis = |joint| Effect::Hysteresis {
        joint,
        radius1: 20.0,
        weight1: 4e-7,
        radius2: 0.0,
        weight2: 0.0,
        radius3: 0.0,
        weight3: 0.0,
    };
    description.effects.extend([hysteresis(1), hysteresis(2)]);
    let rubbing = Generic::<5>::new(&description).unwrap();
    assert!((compliance_under(&rubbing, &q, &load) - under).amax() < 1e-14 * under.amax());
}
