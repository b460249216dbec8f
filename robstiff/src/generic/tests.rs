use nalgebra::{Matrix3, SymmetricEigen, Vector3, Vector6};
use robstiff_robots::Description;

use super::*;
use crate::samples::{arm, five_axis, linear_effects, odd, poses};

const LOAD: Vector6<f64> = Vector6::new(300.0, -500.0, 700.0, 40.0, -60.0, 80.0);

/// The Jacobian against central differences of the transform: the rotation
/// vector is read from the skew part of `dR R^T`.
fn check_jacobian<const N: usize>(description: &Description) {
    let robot = Generic::<N>::new(description).unwrap();
    let step = 1e-5;
    for q in poses() {
        let (jacobian, here) = (robot.jacobian(&q), robot.transform(&q));
        for i in 0..N {
            let mut aside = SVector::zeros();
            aside[i] = step;
            let slope = (robot.transform(&(q + aside)) - robot.transform(&(q - aside))) / (2.0 * step);
            let turn: Matrix3<f64> = slope.fixed_view::<3, 3>(0, 0) * here.fixed_view::<3, 3>(0, 0).transpose();
            let difference =
                Vector6::new(slope[(0, 3)], slope[(1, 3)], slope[(2, 3)], turn[(2, 1)], turn[(0, 2)], turn[(1, 0)]);
            let error = (jacobian.column(i) - difference).amax();
            assert!(error < 1e-9, "column {i} is off by {error:e}");
        }
    }
}

#[test]
fn jacobian_is_the_slope_of_the_transform() {
    check_jacobian::<5>(&five_axis());
    check_jacobian::<6>(&odd());
    let mut standard = odd();
    standard.convention = Convention::Standard;
    check_jacobian::<6>(&standard);
    let mut modified = five_axis();
    modified.convention = Convention::Modified;
    check_jacobian::<5>(&modified);
}

#[test]
fn placement_turns_about_fixed_axes() {
    let mut description = arm(Convention::Standard, &[[0.0; 5]]);
    description.base.rpy = [core::f64::consts::FRAC_PI_2, 0.0, core::f64::consts::FRAC_PI_2];
    let base = Generic::<1>::new(&description).unwrap().base();
    // Roll takes y to z; yaw leaves z where it is, and takes x to y.
    assert_eq!(base.column(1).xyz(), Vector3::z());
    assert_eq!(base.column(0).xyz(), Vector3::y());
}

#[test]
fn constant_right_angles_are_exact() {
    let robot = Generic::<5>::new(&five_axis()).unwrap();
    let tcp = robot.transform(&SVector::<f64, 5>::zeros());
    // At zero the upper arm stands up, the forearm reaches forward.
    assert_eq!(tcp[(1, 3)], 0.0);
    assert!((tcp[(0, 3)] - (0.41 + 1.1)).abs() < 1e-15);
    assert!((tcp[(2, 3)] - (0.865 + 1.0 + 0.25 + 0.3)).abs() < 1e-15);
    assert!(tcp.fixed_view::<3, 3>(0, 0).iter().all(|x| [-1.0, 0.0, 1.0].contains(x)));
}

#[test]
fn compliance_is_that_of_the_joints_through_the_jacobian() {
    let robot = Generic::<6>::new(&odd()).unwrap();
    for q in poses() {
        let jacobian = robot.jacobian(&q);
        let product = jacobian * SMatrix::from_diagonal(&robot.joint_compliance()) * jacobian.transpose();
        let compliance = robot.compliance(&q);
        assert!((compliance - product).amax() < 1e-14 * compliance.amax());
        // Virtual work: the load's is that of the joints' torques.
        let torques = robot.joint_torques(&q, &LOAD);
        let work: f64 = robot.joint_compliance().iter().zip(&torques).map(|(h, tau)| h * tau * tau).sum();
        assert!((LOAD.dot(&(compliance * LOAD)) - work).abs() < 1e-13 * work);
    }
}

#[test]
fn compliance_is_symmetric_and_never_negative() {
    let mut description = odd();
    description.effects = linear_effects();
    let robot = Generic::<6>::new(&description).unwrap();
    for q in poses() {
        let compliance = robot.compliance(&q);
        assert!((compliance - compliance.transpose()).amax() < 1e-15 * compliance.amax());
        let eigenvalues = SymmetricEigen::new(compliance).eigenvalues;
        assert!(eigenvalues.min() > -1e-14 * eigenvalues.max(), "{eigenvalues}");
    }
}

#[test]
fn linear_deflection_is_compliance_times_load() {
    let mut description = five_axis();
    description.effects = linear_effects();
    let robot = Generic::<5>::new(&description).unwrap();
    for q in poses() {
        let expected = robot.compliance(&q) * LOAD;
        assert!((robot.deflection(&q, &LOAD) - expected).amax() < 1e-14 * expected.amax());
    }
}

#[test]
fn hardening_fades_beyond_the_knee() {
    // One joint with a lever of 1 m: the force along y is the torque.
    let (h, added, knee) = (2e-7, 3e-7, 100.0);
    let mut description = arm(Convention::Standard, &[[0.0, 0.0, 1.0, 0.0, h]]);
    description.effects = std::vec![Effect::StiffnessNonlinearity { joint: 1, added, knee }];
    let robot = Generic::<1>::new(&description).unwrap();
    let q = SVector::zeros();
    let turn = |torque: f64| robot.deflection(&q, &Vector6::new(0.0, torque, 0.0, 0.0, 0.0, 0.0))[5];
    assert!((robot.compliance(&q)[(5, 5)] - (h + added)).abs() < 1e-21);
    assert!((turn(1e-3) / 1e-3 - (h + added)).abs() < 1e-15);
    assert!((turn(knee) - (h + added / f64::sqrt(2.0)) * knee).abs() < 1e-18);
    assert!((turn(1e6) - (h * 1e6 + added * knee)).abs() < 1e-9 * h * 1e6);
    assert_eq!(turn(-knee), -turn(knee));
}

#[test]
fn single_precision_is_near_double() {
    let mut description = five_axis();
    description.effects = linear_effects();
    let robot = Generic::<5>::new(&description).unwrap();
    for q in poses() {
        let expected = robot.compliance(&q);
        let narrow = robot.compliance(&q.map(f32::of)).map(f64::from);
        assert!((narrow - expected).amax() < 2e-6 * expected.amax());
    }
}

#[test]
fn another_number_of_joints_is_refused() {
    let error = Generic::<6>::new(&five_axis()).unwrap_err();
    assert_eq!(error, WrongJointCount { expected: 6, found: 5 });
    assert_eq!(std::format!("{error}"), "a robot with 6 joints was asked for, the description has 5");
}

#[test]
fn a_description_is_evaluated_once() {
    let mut calls = 0;
    let mut read = || {
        calls += 1;
        five_axis()
    };
    assert_eq!(crate::with_robot!(&read(), |robot| robot.joint_kinds().len()), 5);
    assert_eq!(calls, 1);
}
