//! Against the simulator: rigid bodies, finite turns and the equilibrium of the
//! deformed arm, with no Jacobian anywhere.
//!
//! A deflection under a load that turns by `phi` misses that of the deformed
//! arm by about `phi` of itself. Loads are small here, and half the difference
//! between a load and its opposite cancels that miss: what is left is of the
//! order `phi^2`, and the simulator's own 1e-15 rad.

use nalgebra::{Matrix4, Rotation3, SVector, Vector3, Vector6};
use robstiff::elements::deformed;
use robstiff::{Convention, Effect, Generic, Robot, State};
use robstiff_codegen::{Function, symbolic};
use robstiff_robots::Description;
use robstiff_tests::arms::{EveryEffect, Rv130hsc, description};
use robstiff_tests::for_every_arm;
use robstiff_tests::judge::{Sizes, trials};
use robstiff_tests::simulator::{Arm, Hidden, five_axis, six_axis};

/// How far the softest element turns under the loads of these tests (rad).
const SMALL: f64 = 1e-6;

for_every_arm!(stands_where_the_simulated_arm_stands);
for_every_arm!(moves_as_the_simulated_arm);

fn stands_where_the_simulated_arm_stands<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    if !Arm::knows(&description) {
        // Held against statics and differences in `laws.rs`.
        return;
    }
    let arm = Arm::new(&description, &[]);
    for (q, _) in trials::<N>(300, 30) {
        let transform = robot.transform(&q);
        let found = transform.fixed_view::<3, 1>(0, 3);
        let reach = Sizes::of(&description, q.as_slice()).reach;
        assert!((found - Vector3::from(arm.tcp(q.as_slice()))).amax() < 1e-14 * reach, "{file}");
    }
}

fn moves_as_the_simulated_arm<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    if !Arm::knows(&description) {
        return;
    }
    for (q, wrench) in trials::<N>(40, 31) {
        let wrench = small(&description, q.as_slice(), &wrench);
        assert_settles(file, &description, q.as_slice(), &wrench, &robot.deflection(&q, &wrench));
    }
}

/// The wrench, so much smaller that nothing turns by more than about [`SMALL`].
fn small(description: &Description, q: &[f64], wrench: &Vector6<f64>) -> Vector6<f64> {
    let sizes = Sizes::of(description, q);
    if sizes.softest == 0.0 { *wrench } else { wrench * (SMALL / (sizes.softest * sizes.torque(wrench))) }
}

/// Asserts that the simulated arm settles as predicted under a small wrench.
fn assert_settles(name: &str, description: &Description, q: &[f64], wrench: &Vector6<f64>, predicted: &Vector6<f64>) {
    let reach = Sizes::of(description, q).reach;
    let settled = settled(&Arm::new(description, &[]), q, wrench);
    for (what, row, size) in [("displacement", 0, SMALL * reach), ("rotation", 3, SMALL)] {
        let (settled, predicted) = (settled.fixed_rows::<3>(row), predicted.fixed_rows::<3>(row));
        let off = (settled - predicted).norm();
        let allowed = 1e-6 * predicted.norm() + 1e-8 * size;
        assert!(
            off <= allowed,
            "{name}, {what}: {predicted}settled at {settled}off by {off:e}, allowed are {allowed:e}"
        );
    }
}

/// Half the difference between what a wrench does and what its opposite does.
fn settled(arm: &Arm, q: &[f64], wrench: &Vector6<f64>) -> Vector6<f64> {
    let arm = arm.at(q);
    let one_way = |wrench: Vector6<f64>| {
        let settled = arm.settle(&wrench.into());
        Vector6::from_iterator(settled.displacement.into_iter().chain(settled.rotation))
    };
    (one_way(*wrench) - one_way(-wrench)) * 0.5
}

/// Each effect alone, on arms of both conventions, some with a sliding joint:
/// the generator's functions interpreted, for there are too many to compile.
#[test]
fn every_effect_alone_moves_as_simulated() {
    let effects = |sliding: bool| {
        let mut effects = vec![
            Effect::TransverseCompliance { joint: 1, value: 3e-7 },
            Effect::TransverseCompliance { joint: 3, value: 6e-7 },
            Effect::TransverseCompliance { joint: 5, value: 1e-6 },
            Effect::LinkCompliance { link: 2, bending: 7e-7, torsion: 0.0 },
            Effect::LinkCompliance { link: 2, bending: 0.0, torsion: 7e-7 },
            Effect::LinkCompliance { link: 3, bending: 3e-7, torsion: 8e-7 },
            Effect::BaseCompliance { tilt: 2e-7, translation: 0.0 },
            Effect::BaseCompliance { tilt: 0.0, translation: 3e-7 },
            Effect::ToolCompliance { rotation: 9e-7, translation: 0.0 },
            Effect::ToolCompliance { rotation: 0.0, translation: 4e-7 },
            Effect::JointCoupling { joints: [1, 2], value: 1e-7 },
            Effect::JointCoupling { joints: [4, 5], value: -1e-7 },
            // Knees that are in the midst of the small torques here.
            Effect::StiffnessNonlinearity { joint: 2, added: 8e-7, knee: 0.1 },
            Effect::StiffnessNonlinearity { joint: 4, added: -1e-7, knee: 0.05 },
        ];
        if !sliding {
            effects.push(Effect::JointCoupling { joints: [2, 3], value: -2e-7 });
        }
        effects
    };
    let slider = Description { effects: Vec::new(), ..description("modified-slider.yaml") };
    let modified = Description { convention: Convention::Modified, ..six_axis() };
    for (name, arm, sliding) in [
        ("five axes", five_axis(), false),
        ("six axes", six_axis(), false),
        ("modified", modified, false),
        ("slider", slider, true),
    ] {
        for effect in effects(sliding) {
            let arm = Description { effects: vec![effect], ..arm.clone() };
            let function = Function::of(|g| symbolic::deflection(g, &arm));
            let without =
                Function::of(|g| symbolic::deflection(g, &Description { effects: Vec::new(), ..arm.clone() }));
            for (q, wrench) in trials::<8>(10, 32) {
                let q = &q.as_slice()[..arm.joints.len()];
                let wrench = small(&arm, q, &wrench);
                let predicted = function.evaluate(q, wrench.as_slice());
                assert_ne!(predicted, without.evaluate(q, wrench.as_slice()), "{name}, {effect} does nothing");
                assert_settles(&format!("{name}, {effect}"), &arm, q, &wrench, &Vector6::from_column_slice(&predicted));
            }
        }
    }
}

/// What small deflections leave out is of second order in the load: twice the
/// load, four times the miss.
#[test]
fn the_miss_is_of_second_order() {
    fn check<const N: usize>(robot: impl Robot<N>, file: &str, q: SVector<f64, N>) {
        let description = description(file);
        let arm = Arm::new(&description, &[]).at(q.as_slice());
        let wrench = Vector6::new(300.0, -400.0, 500.0, 20.0, 30.0, -10.0);
        let miss = |share: f64| {
            let wrench = wrench * share;
            let moved = robot.deflection(&q, &wrench);
            let settled = Vector3::from(arm.settle(&wrench.into()).displacement);
            ((settled - moved.fixed_rows::<3>(0)).norm(), settled.norm())
        };
        let ((one, _), (two, moved)) = (miss(1.0), miss(2.0));
        assert!((two / one - 4.0).abs() < 0.1, "{file}: {}", two / one);
        assert!(two / moved < 1e-2, "{file}: {}", two / moved);
    }
    check(Rv130hsc, "rv130hsc.yaml", SVector::from([0.3, -0.4, 0.5, 0.6, 1.2]));
    check(EveryEffect, "every-effect.yaml", SVector::from([0.4, -1.1, 0.7, 0.9, -0.8, 1.3]));
}

/// Where a load takes the frame of the TCP, on a robot that was never loaded before.
fn at_rest<const N: usize>(
    robot: &impl Robot<N>,
    q: &SVector<f64, N>,
    load: impl Fn(&Matrix4<f64>) -> Vector6<f64>,
) -> Matrix4<f64> {
    deformed(robot, q, load, &mut State::new()).tcp
}

/// Where the load is carried by the arm that it has deformed, nothing is missed but
/// that a link is one screw and not a curve: under 200 kg and moments of a long tool,
/// each effect alone, arms of both conventions.
#[test]
fn heavy_loads_are_carried_by_the_deformed_arm() {
    fn check<const N: usize>(arm: &Description, effect: Effect) {
        let arm = Description { effects: vec![effect], ..arm.clone() };
        let robot = Generic::<N>::new(&arm).expect("as many joints");
        let allowed = if matches!(effect, Effect::LinkCompliance { .. }) { 3e-7 } else { 1e-10 };
        let simulated = Arm::new(&arm, &[]);
        let mut linear: f64 = 0.0;
        for (q, _) in trials::<N>(10, 33) {
            let wrench = Vector6::new(300.0, -200.0, -2000.0, 200.0, -300.0, 100.0);
            let settled = simulated.at(q.as_slice()).settle(&wrench.into());
            let (still, found) = (robot.transform(&q), at_rest(&robot, &q, |_| wrench));
            let expected = Vector3::from(settled.displacement);
            let moved = (found - still).fixed_view::<3, 1>(0, 3).into_owned();
            assert!((moved - expected).norm() < allowed, "{effect}: off by {:e}", (moved - expected).norm());
            let turned = Rotation3::new(settled.rotation.into()) * still.fixed_view::<3, 3>(0, 0);
            assert!((found.fixed_view::<3, 3>(0, 0) - turned).amax() < allowed, "{effect}: {found}");
            linear = linear.max((robot.deflection(&q, &wrench).fixed_rows::<3>(0) - expected).norm());
        }
        assert!(linear > 1e-6, "{effect}: {linear:e}");
    }
    let modified = Description { convention: Convention::Modified, ..six_axis() };
    for effect in [
        Effect::TransverseCompliance { joint: 3, value: 6e-7 },
        Effect::LinkCompliance { link: 2, bending: 2e-7, torsion: 3e-7 },
        Effect::BaseCompliance { tilt: 2e-7, translation: 3e-8 },
        Effect::ToolCompliance { rotation: 9e-7, translation: 4e-8 },
        Effect::JointCoupling { joints: [2, 3], value: -2e-7 },
        Effect::StiffnessNonlinearity { joint: 2, added: 8e-7, knee: 500.0 },
    ] {
        check::<5>(&five_axis(), effect);
        check::<6>(&six_axis(), effect);
        check::<6>(&modified, effect);
    }
}

/// A weight that hangs beside the TCP turns with the tool, and its lever arm with it.
#[test]
fn a_load_beside_the_tool_moves_with_it() {
    let (arm, at) = (five_axis(), Vector3::new(0.3, -0.2, 0.4));
    let robot = Generic::<5>::new(&arm).expect("five joints");
    let simulated = Arm::new(&arm, &[]).hiding(&Hidden::LeverArm(at.into()));
    let mut without: f64 = 0.0;
    for (q, _) in trials::<5>(10, 34) {
        let force = Vector3::new(0.0, 0.0, -2000.0);
        let settled = simulated.at(q.as_slice()).settle(&[0.0, 0.0, force.z, 0.0, 0.0, 0.0]);
        let expected = Vector3::from(settled.displacement);
        let still = robot.transform(&q);
        let hangs = |tcp: &Matrix4<f64>| {
            let moment = (tcp.fixed_view::<3, 3>(0, 0) * at).cross(&force);
            Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
        };
        let moved = |tcp: Matrix4<f64>| (tcp - still).fixed_view::<3, 1>(0, 3) - expected;
        let off = moved(at_rest(&robot, &q, hangs)).norm();
        assert!(off < 1e-10, "{off:e}");
        without = without.max(moved(at_rest(&robot, &q, |_| hangs(&still))).norm());
    }
    assert!(without > 1e-7, "{without:e}");
}
