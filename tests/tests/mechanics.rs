//! Generated code against what mechanics says of any elastic arm: derivatives,
//! equilibrium, work, reciprocity, rank, and the limits of nonlinear joints.
//!
//! Nothing here is compared with another implementation of the same formulas.

use nalgebra::{Matrix3, Matrix4, Matrix6, SMatrix, SVector, UnitVector3, Vector3, Vector6};
use robstiff::analysis::{Stiffness, directional_stiffness, principal_directions, translational_stiffness};
use robstiff::elements::{Element, commanded_rates, contributions, share_along, share_of_translation};
use robstiff::robots::Place;
use robstiff::{Convention, Effect, JointKind, Robot};
use robstiff_tests::arms::{EveryEffect, FanucR2000ic, Pendulum, Rv130hsc, description};
use robstiff_tests::for_every_arm;
use robstiff_tests::judge::{Sizes, trials};

const POSES: usize = 300;

for_every_arm!(the_jacobian_is_the_derivative);
for_every_arm!(torques_hold_the_wrench);
for_every_arm!(compliance_is_symmetric_and_yields);
for_every_arm!(every_element_stores_its_work);
for_every_arm!(elements_and_shares_add_up);
for_every_arm!(loads_answer_each_other);
for_every_arm!(small_loads_see_the_compliance);
for_every_arm!(far_beyond_the_knee_the_joint_alone_yields);
for_every_arm!(stiffness_is_finite_everywhere);

fn turn(frame: &Matrix4<f64>) -> Matrix3<f64> {
    frame.fixed_view::<3, 3>(0, 0).into_owned()
}

fn origin(frame: &Matrix4<f64>) -> Vector3<f64> {
    frame.fixed_view::<3, 1>(0, 3).into_owned()
}

fn axis(frame: &Matrix4<f64>) -> Vector3<f64> {
    frame.fixed_view::<3, 1>(0, 2).into_owned()
}

fn force(wrench: &Vector6<f64>) -> Vector3<f64> {
    wrench.fixed_rows::<3>(0).into_owned()
}

/// The frame on whose z axis a joint, from 1, acts.
fn joint_frame<const N: usize>(robot: &impl Robot<N>, q: &SVector<f64, N>, joint: usize) -> Matrix4<f64> {
    match (robot.convention(), joint) {
        (Convention::Modified, _) => robot.link_frames(q)[joint - 1],
        (Convention::Standard, 1) => robot.base(),
        (Convention::Standard, _) => robot.link_frames(q)[joint - 2],
    }
}

fn is_linear<const N: usize>(robot: &impl Robot<N>) -> bool {
    let bends = |effect: &Effect| {
        matches!(effect, Effect::StiffnessNonlinearity { .. } | Effect::LostMotion { .. } | Effect::Hysteresis { .. })
    };
    !robot.effects().iter().any(bends)
}

/// Whether gears carry the arm's weight: their laws begin elsewhere than where the load is
/// zero. `preload` has tests of its own for that.
fn has_preload<const N: usize>(robot: &impl Robot<N>) -> bool {
    robot.effects().iter().any(|effect| matches!(effect, Effect::GravityPreload { .. }))
}

/// The translation in m and the rotation times the arm's reach in m.
fn in_metres(displacement: &Vector6<f64>, reach: f64) -> Vector6<f64> {
    displacement.component_mul(&Vector6::new(1.0, 1.0, 1.0, reach, reach, reach))
}

fn the_jacobian_is_the_derivative<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    let step = 1e-5;
    // The sag changes with the angles; `laws` has a test of its own for it.
    if robot.effects().iter().any(|effect| matches!(effect, Effect::GravitySag { .. })) {
        return;
    }
    for (q, _) in trials::<N>(POSES, 10) {
        let reach = Sizes::of(&description, q.as_slice()).reach;
        // The Jacobian is that of the joints' outputs, the derivative that of
        // the angles they are told.
        let rates = commanded_rates(&robot, &q);
        let jacobian = robot.jacobian(&q) * SMatrix::from_diagonal(&rates);
        let here = turn(&robot.transform(&q));
        for joint in 0..N {
            let moved = |by: f64| {
                let mut q = q;
                q[joint] += by;
                robot.transform(&q)
            };
            let derivative = (moved(step) - moved(-step)) / (2.0 * step);
            let spin = turn(&derivative) * here.transpose();
            let rotation = Vector3::new(spin[(2, 1)], spin[(0, 2)], spin[(1, 0)]);
            assert!((spin + spin.transpose()).amax() < 1e-9, "{file}: not a rotation");
            let column = jacobian.column(joint);
            assert!((column.fixed_rows::<3>(0) - origin(&derivative)).amax() < 1e-9 * reach, "{file}, joint {joint}");
            assert!((column.fixed_rows::<3>(3) - rotation).amax() < 1e-9, "{file}, joint {joint}");
        }
    }
}

/// `tau = J^T F`, and by statics: the moment about a joint's axis, or the
/// force along it.
fn torques_hold_the_wrench<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    for (q, wrench) in trials::<N>(POSES, 11) {
        let size = Sizes::of(&description, q.as_slice()).torque(&wrench);
        let torques = robot.joint_torques(&q, &wrench);
        assert!((torques - robot.jacobian(&q).transpose() * wrench).amax() <= 1e-14 * size, "{file}");
        for (i, torque) in torques.iter().enumerate() {
            let frame = joint_frame(&robot, &q, i + 1);
            let held = match robot.joint_kinds()[i] {
                JointKind::Revolute => axis(&frame).dot(&moment_at(&robot, &q, &wrench, &origin(&frame))),
                JointKind::Prismatic => axis(&frame).dot(&force(&wrench)),
            };
            assert!((torque - held).abs() <= 1e-14 * size, "{file}, joint {}: {torque} {held}", i + 1);
        }
    }
}

/// The moment of a wrench at the TCP about a point.
fn moment_at<const N: usize>(
    robot: &impl Robot<N>,
    q: &SVector<f64, N>,
    wrench: &Vector6<f64>,
    point: &Vector3<f64>,
) -> Vector3<f64> {
    let lever = origin(&robot.transform(q)) - point;
    wrench.fixed_rows::<3>(3) + lever.cross(&force(wrench))
}

fn compliance_is_symmetric_and_yields<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    for (q, _) in trials::<N>(POSES, 12) {
        let sizes = Sizes::of(&description, q.as_slice());
        let compliance = robot.compliance(&q);
        assert_eq!(compliance, compliance.transpose(), "{file}");
        let scale = Vector6::new(1.0, 1.0, 1.0, sizes.reach, sizes.reach, sizes.reach);
        let scaled = compliance.component_mul(&(scale * scale.transpose()));
        let least = scaled.symmetric_eigenvalues().min();
        assert!(least >= -1e-14 * sizes.compliance()[0], "{file}: {least:e}");
    }
}

/// `F^T C F` of every element from statics: its compliance times the square of
/// the moment or force that it carries.
fn every_element_stores_its_work<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    for (q, wrench) in trials::<N>(POSES, 13) {
        let sizes = Sizes::of(&description, q.as_slice());
        let size = sizes.softest * sizes.torque(&wrench).powi(2);
        let mut stored = 0.0;
        for (element, part) in contributions(&robot, &q) {
            let work = work(&robot, &q, &wrench, element);
            assert!((wrench.dot(&(part * wrench)) - work).abs() <= 1e-13 * size, "{file}, {element}");
            stored += work;
        }
        let done = wrench.dot(&(robot.compliance(&q) * wrench));
        assert!((done - stored).abs() <= 1e-13 * size, "{file}: {done} {stored}");
        if is_linear(&robot) {
            let done = wrench.dot(&robot.deflection(&q, &wrench));
            assert!((done - stored).abs() <= 1e-13 * size, "{file}: {done} {stored}");
        }
    }
}

fn work<const N: usize>(robot: &impl Robot<N>, q: &SVector<f64, N>, wrench: &Vector6<f64>, element: Element) -> f64 {
    let torque = |joint: usize| robot.joint_torques(q, wrench)[joint - 1];
    let moment = |point: &Vector3<f64>| moment_at(robot, q, wrench, point);
    let across = |moment: Vector3<f64>, axis: Vector3<f64>| moment.norm_squared() - moment.dot(&axis).powi(2);
    let pushed = force(wrench).norm_squared();
    // The slope of `tau / sqrt(1 + (tau / knee)^2)` where the weight of the arm has the gear.
    let slope = |joint: usize, knee: f64| (1.0 + (robot.preload(q)[joint - 1] / knee).powi(2)).powf(-1.5);
    match element {
        Element::Joint(joint) => robot.joint_compliance()[joint - 1] * torque(joint).powi(2),
        Element::Effect(effect) => match *effect {
            Effect::TransverseCompliance { joint, value } => {
                let frame = joint_frame(robot, q, joint);
                value * across(moment(&origin(&frame)), axis(&frame))
            }
            Effect::LinkCompliance { link, bending, torsion } => {
                let [near, far] = [link, link + 1].map(|joint| origin(&joint_frame(robot, q, joint)));
                let along = (far - near).normalize();
                // Gauss' two points: the moment is linear along the beam.
                let points = [-1.0, 1.0].map(|side| near + (far - near) * (0.5 + side / 12_f64.sqrt()));
                let bent = points.map(|point| across(moment(&point), along)).iter().sum::<f64>() / 2.0;
                bending * bent + torsion * moment(&near).dot(&along).powi(2)
            }
            Effect::BaseCompliance { tilt, translation } => {
                let base = robot.base();
                tilt * across(moment(&origin(&base)), axis(&base)) + translation * pushed
            }
            Effect::ToolCompliance { rotation, translation } => {
                let flange = robot.link_frames(q)[N - 1];
                rotation * moment(&origin(&flange)).norm_squared() + translation * pushed
            }
            Effect::JointCoupling { joints: [i, j], value } => 2.0 * value * torque(i) * torque(j),
            Effect::StiffnessNonlinearity { joint, added, knee } => added * slope(joint, knee) * torque(joint).powi(2),
            Effect::LostMotion { joint, gap, knee } => gap / (2.0 * knee) * slope(joint, knee) * torque(joint).powi(2),
            Effect::PoseDependentCompliance { joint, cos1, sin1, cos2, sin2 } => {
                let (angle, own) = (q[joint - 1], robot.joint_compliance()[joint - 1]);
                let (once, twice) = (angle.sin_cos(), (2.0 * angle).sin_cos());
                let change = cos1 * once.1 + sin1 * once.0 + cos2 * twice.1 + sin2 * twice.0;
                own * change * torque(joint).powi(2)
            }
            // Play operators stay under a small load; frames store nothing.
            Effect::Hysteresis { .. }
            | Effect::JointZeroOffset { .. }
            | Effect::DhError { .. }
            | Effect::TransmissionError { .. }
            | Effect::GravitySag { .. }
            | Effect::GravityPreload { .. } => 0.0,
        },
    }
}

fn elements_and_shares_add_up<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    for (q, wrench) in trials::<N>(POSES, 14) {
        let size = Sizes::of(&description, q.as_slice()).compliance()[0];
        let whole = robot.compliance(&q);
        let sum: Matrix6<f64> = contributions(&robot, &q).map(|(_, part)| part).sum();
        assert!((sum - whole).amax() <= 1e-14 * size, "{file}");
        assert_eq!(contributions(&robot, &q).count(), N + robot.effects().len(), "{file}");
        let parts = || contributions(&robot, &q).map(|(_, part)| part);
        if whole.amax() > 0.0 {
            let along: f64 = parts().filter_map(|part| share_along(&part, &whole, &force(&wrench))).sum();
            let mean: f64 = parts().filter_map(|part| share_of_translation(&part, &whole)).sum();
            // A direction in which the arm hardly yields has few digits.
            assert!((mean - 1.0).abs() < 1e-9 && (along - 1.0).abs() < 1e-6, "{file}: {mean} {along}");
        }
    }
}

/// Maxwell and Betti: one load does the same work along what another moves as
/// the other along what the one moves.
fn loads_answer_each_other<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    if !is_linear(&robot) {
        return;
    }
    for ((q, one), (_, other)) in trials::<N>(POSES, 15).zip(trials::<N>(POSES, 16)) {
        let sizes = Sizes::of(&description, q.as_slice());
        let size = sizes.softest * sizes.torque(&one) * sizes.torque(&other);
        let there = one.dot(&robot.deflection(&q, &other));
        let back = other.dot(&robot.deflection(&q, &one));
        assert!((there - back).abs() <= 1e-13 * size, "{file}: {there} {back}");
    }
}

/// The deflection is `H F`: always where the arm is linear, else for a load
/// that is far below the knees.
fn small_loads_see_the_compliance<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    if has_preload(&robot) {
        return;
    }
    let share = if is_linear(&robot) { 1.0 } else { 1e-8 };
    for (q, wrench) in trials::<N>(POSES, 17) {
        let (sizes, wrench) = (Sizes::of(&description, q.as_slice()), wrench * share);
        let size = sizes.softest * sizes.reach * sizes.torque(&wrench);
        let (found, expected) = (robot.deflection(&q, &wrench), robot.compliance(&q) * wrench);
        assert!(in_metres(&(found - expected), sizes.reach).amax() <= 1e-13 * size, "{file}");
    }
}

/// Under a huge load a nonlinear joint has only its own compliance left, that of
/// play operators that slide, and the turn that it took on the way.
fn far_beyond_the_knee_the_joint_alone_yields<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    if has_preload(&robot) {
        return;
    }
    for (q, wrench) in trials::<N>(POSES, 18) {
        let (sizes, wrench) = (Sizes::of(&description, q.as_slice()), wrench * 1e7);
        let (jacobian, torques) = (robot.jacobian(&q), robot.joint_torques(&q, &wrench));
        let mut expected = robot.compliance(&q) * wrench;
        for effect in robot.effects() {
            let Place::Joint(joint) = effect.place() else { continue };
            let torque = torques[joint - 1];
            let huge = |knee: f64| assert!(torque.abs() > 1e3 * knee, "{file}: the load is not huge");
            let turned = match *effect {
                Effect::StiffnessNonlinearity { added, knee, .. } => {
                    huge(knee);
                    added * (knee * torque.signum() - torque)
                }
                Effect::LostMotion { gap, knee, .. } => {
                    huge(knee);
                    gap / 2.0 * (torque.signum() - torque / knee)
                }
                Effect::Hysteresis { radius1, weight1, radius2, weight2, radius3, weight3, .. } => {
                    let pairs = [(radius1, weight1), (radius2, weight2), (radius3, weight3)];
                    assert!(torque.abs() > radius3, "{file}: the operators do not slide");
                    pairs.map(|(radius, weight)| weight * (torque - radius * torque.signum())).iter().sum()
                }
                _ => continue,
            };
            expected += jacobian.column(joint - 1) * turned;
        }
        let size = sizes.softest * sizes.reach * sizes.torque(&wrench);
        let off = in_metres(&(robot.deflection(&q, &wrench) - expected), sizes.reach).amax();
        assert!(off <= 1e-13 * size, "{file}: off by {:e}", off / size);
    }
}

/// Whatever the rank: numbers, and a stiffness that undoes the compliance.
fn stiffness_is_finite_everywhere<const N: usize>(robot: impl Robot<N>, file: &str) {
    // The outstretched pose, where axes coincide, and pose after pose.
    let poses = [SVector::zeros()].into_iter().chain(trials::<N>(POSES, 19).map(|(q, _)| q));
    for q in poses {
        let compliance = robot.compliance(&q);
        let stiffness = Stiffness::of(&compliance).unwrap_or_else(|| panic!("{file}: no stiffness"));
        assert!(stiffness.matrix().iter().all(|entry| entry.is_finite()), "{file}");
        let again = compliance * stiffness.matrix() * compliance;
        let off = (again - compliance).amax() / compliance.amax().max(f64::MIN_POSITIVE);
        let condition = compliance.norm() * stiffness.matrix().norm();
        assert!(off <= 1e-14 * condition, "{file}: off by {off:e} of {condition:e} at {q}");
        assert_eq!(stiffness.rank() == 6, matches!(stiffness, Stiffness::Full(_)));
        let principal = principal_directions(&compliance).expect("finite");
        assert!(principal.compliances.iter().all(|entry| entry.is_finite()), "{file}");
        for direction in [Vector3::x_axis(), UnitVector3::new_normalize(Vector3::new(0.3, -0.5, 0.7))] {
            assert!(directional_stiffness(&compliance, &direction).is_none_or(f64::is_finite), "{file}");
        }
        assert!(translational_stiffness(&compliance).is_none_or(|block| block.iter().all(|k| k.is_finite())), "{file}");
    }
}

#[test]
fn five_elastic_axes_yield_five_ways() {
    for (q, _) in trials::<5>(POSES, 20) {
        let compliance = Rv130hsc.compliance(&q);
        let Some(Stiffness::Deficient { rank: 5, pseudo_inverse }) = Stiffness::of(&compliance) else {
            panic!("not of rank 5 at {q}")
        };
        // The one wrench that no joint feels moves nothing.
        let jacobian = Rv130hsc.jacobian(&q);
        let silent = nalgebra::SymmetricEigen::new(jacobian * jacobian.transpose());
        let silent = silent.eigenvectors.column(silent.eigenvalues.imin()).into_owned();
        assert!((compliance * silent).amax() < 1e-14 * compliance.amax());
        // A force still moves the TCP: there is a stiffness to forces.
        let force = translational_stiffness(&compliance).expect("five axes move a point every way");
        let block = compliance.fixed_view::<3, 3>(0, 0) * force;
        assert!((block - Matrix3::identity()).amax() < 1e-8);
        // What can be moved is held by the wrench that moves it.
        let wrench = Vector6::new(1.0, -2.0, 3.0, 0.4, 0.5, -0.6);
        let moved = compliance * wrench;
        assert!((compliance * (pseudo_inverse * moved) - moved).amax() < 1e-9 * moved.amax());
    }
}

#[test]
fn six_elastic_axes_yield_every_way() {
    fn check<const N: usize>(robot: impl Robot<N>) {
        for (q, _) in trials::<N>(POSES, 21) {
            let compliance = robot.compliance(&q);
            let Some(Stiffness::Full(stiffness)) = Stiffness::of(&compliance) else { panic!("not full at {q}") };
            assert!((stiffness * compliance - Matrix6::identity()).amax() < 1e-6);
        }
    }
    check::<6>(FanucR2000ic);
    check::<6>(EveryEffect);
}

#[test]
fn aligned_axes_lose_a_direction() {
    // Of the arm with a spherical wrist at q5 = 0, where axes 4 and 6 are one.
    let q = SVector::from([0.3, 0.2, -0.4, 0.5, 0.0, 1.0]);
    assert_eq!(Stiffness::of(&FanucR2000ic.compliance(&q)).map(|stiffness| stiffness.rank()), Some(5));
}

#[test]
fn a_pendulum_is_its_spring() {
    // 2 arcmin/Nm at 1 m: along y, when it points along x.
    let compliance = Pendulum.compliance(&SVector::from([0.0]));
    let h = 2.0 / 60.0 * std::f64::consts::PI / 180.0;
    let mut expected = Matrix6::zeros();
    (expected[(1, 1)], expected[(5, 5)], expected[(1, 5)], expected[(5, 1)]) = (h, h, h, h);
    assert!((compliance - expected).amax() < 1e-18);
    assert_eq!(Stiffness::of(&compliance).map(|stiffness| stiffness.rank()), Some(1));
}
