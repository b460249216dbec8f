//! The laws of joints and the errors of frames: what mechanics and the theory
//! of play operators say of them, on generated and on generic robots.

use nalgebra::{Matrix6, SVector, SymmetricEigen, Vector4, Vector6};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff::{Convention, DhEntry, Dual, Effect, Generic, Lanes, Real, Robot, State};
use robstiff_robots::{Description, Link};
use robstiff_tests::arms::{EveryEffect, EveryLaw, description};
use robstiff_tests::judge::{Sizes, trials};

const FILE: &str = "every-law.yaml";
const POSES: usize = 100;

/// The arm with every law, with only some of its effects.
fn with(keep: impl Fn(&Effect) -> bool) -> Generic<7> {
    let mut description = description(FILE);
    description.effects.retain(keep);
    Generic::new(&description).expect("seven joints")
}

fn with_effects(effects: &[Effect]) -> Generic<7> {
    Generic::new(&Description { effects: effects.to_vec(), ..description(FILE) }).expect("seven joints")
}

fn off(found: &Vector6<f64>, expected: &Vector6<f64>) -> f64 {
    (found - expected).amax() / expected.amax()
}

#[test]
fn backlash_is_odd_and_as_wide_as_its_gap() {
    let gap = 2e-4;
    let (plain, slack) = (with_effects(&[]), with_effects(&[Effect::LostMotion { joint: 4, gap, knee: 30.0 }]));
    for (q, wrench) in trials::<7>(POSES, 40) {
        let one = slack.deflection(&q, &wrench);
        assert_eq!(one, -slack.deflection(&q, &-wrench));
        // Far beyond the knee, from one side to the other: the gap.
        let (huge, column) = (wrench * 1e6, plain.jacobian(&q).column(3).into_owned());
        let swing = (slack.deflection(&q, &huge) - slack.deflection(&q, &-huge)) - plain.deflection(&q, &huge) * 2.0;
        let sign = column.dot(&wrench).signum();
        let rounding = 1e-13 * plain.deflection(&q, &huge).amax();
        assert!((swing - column * (gap * sign)).amax() < 1e-6 * gap * column.amax() + rounding);
        // At the knee, 71 % of half of it.
        let torque = column.dot(&wrench);
        let knee = wrench * (30.0 / torque);
        let beyond = slack.deflection(&q, &knee) - plain.deflection(&q, &knee);
        assert!(off(&beyond, &(column * (gap / 2.0 * 0.5_f64.sqrt()))) < 1e-9);
    }
}

#[test]
fn every_law_at_zero_load_has_the_compliance_as_its_slope() {
    for (q, wrench) in trials::<7>(POSES, 41) {
        let compliance = EveryLaw.compliance(&q);
        let none = Vector6::repeat(0.0);
        let slopes = EveryLaw.deflection(&q.map(Dual::<f64, 6>::constant), &Dual::variables(none));
        let slopes = Matrix6::from_fn(|i, j| slopes[i].slopes[j]);
        assert!((slopes - compliance).amax() < 1e-12 * compliance.amax());
        // And by central differences, well below every knee.
        let small = wrench * 1e-6;
        let difference = (EveryLaw.deflection(&q, &small) - EveryLaw.deflection(&q, &-small)) * 0.5;
        assert!(off(&difference, &(compliance * small)) < 1e-7);
    }
}

/// What is elastic has a potential, so the slope of the deflection is symmetric
/// under any load, and yields to any further one.
#[test]
fn the_tangent_under_load_is_symmetric_and_yields() {
    for (q, wrench) in trials::<7>(POSES, 42) {
        let slopes = EveryLaw.deflection(&q.map(Dual::<f64, 6>::constant), &Dual::variables(wrench));
        let tangent = Matrix6::from_fn(|i, j| slopes[i].slopes[j]);
        assert!((tangent - tangent.transpose()).amax() < 1e-13 * tangent.amax());
        let least = SymmetricEigen::new(tangent).eigenvalues.min();
        assert!(least > -1e-13 * tangent.amax(), "{least:e}");
    }
}

#[test]
fn the_compliance_changes_with_the_pose_as_by_differences() {
    let step = 1e-6;
    for (q, _) in trials::<7>(POSES, 43) {
        let compliance = EveryLaw.compliance(&Dual::variables(q));
        let largest = EveryLaw.compliance(&q).amax();
        for joint in 0..7 {
            let mut aside = SVector::zeros();
            aside[joint] = step;
            let difference = (EveryLaw.compliance(&(q + aside)) - EveryLaw.compliance(&(q - aside))) / (2.0 * step);
            let slope = compliance.map(|entry| entry.slopes[joint]);
            assert!((slope - difference).amax() < 1e-8 * largest, "joint {}", joint + 1);
        }
    }
}

#[test]
fn a_compliance_that_varies_has_its_mean_over_a_turn() {
    let effect = Effect::PoseDependentCompliance { joint: 3, cos1: 0.2, sin1: -0.1, cos2: 0.05, sin2: 0.15 };
    let (plain, varying) = (with_effects(&[]), with_effects(&[effect]));
    let torque = |robot: &Generic<7>, q: &SVector<f64, 7>| {
        // The turn of joint 3 alone, by its work on a wrench.
        let (own, column) = (robot.joint_compliance()[2], plain.jacobian(q).column(2).into_owned());
        let more = varying.compliance(q) - plain.compliance(q);
        let wrench = column / column.norm_squared();
        wrench.dot(&(more * wrench)) / own
    };
    for (mut q, _) in trials::<7>(10, 44) {
        let count = 16;
        let changes: Vec<f64> = (0..count)
            .map(|k| {
                q[2] = f64::from(k) * std::f64::consts::TAU / f64::from(count);
                torque(&varying, &q)
            })
            .collect();
        assert!(changes.iter().sum::<f64>().abs() < 1e-12);
        assert!((changes[0] - 0.25).abs() < 1e-12, "cos1 + cos2 at zero");
        assert!((changes[4] - (-0.1 - 0.05)).abs() < 1e-12, "sin1 - cos2 at 90 degrees");
    }
}

#[test]
fn a_fresh_state_is_the_virgin_curve() {
    for (q, wrench) in trials::<7>(POSES, 45) {
        let mut state = State::new();
        assert_eq!(EveryLaw.deflection_with(&q, &wrench, &mut state), EveryLaw.deflection(&q, &wrench));
        assert_ne!(state, State::new());
    }
    // A robot without hysteresis remembers nothing.
    for (q, wrench) in trials::<6>(POSES, 46) {
        let mut state = State::new();
        assert_eq!(EveryEffect.deflection_with(&q, &wrench, &mut state), EveryEffect.deflection(&q, &wrench));
        assert_eq!(state, State::new());
    }
}

/// Against the definition: a play operator is the torque as a pointer with so
/// much play drags it, followed here in small steps.
#[test]
fn play_operators_are_dragged() {
    let mut random = ChaCha8Rng::seed_from_u64(47);
    for (q, wrench) in trials::<7>(20, 47) {
        let mut state = State::new();
        let (mut share, mut dragged) = (0.0, [0.0_f64; 3]);
        for _ in 0..20 {
            let next: f64 = random.random_range(-1.5..1.5);
            EveryLaw.deflection_with(&q, &(wrench * next), &mut state);
            let steps = 200;
            for step in 1..=steps {
                let share = share + (next - share) * f64::from(step) / f64::from(steps);
                let torque = EveryLaw.joint_torques(&q, &(wrench * share))[2];
                for (pointer, radius) in dragged.iter_mut().zip([50.0, 200.0, 600.0]) {
                    let pulled = torque - *pointer;
                    if pulled.abs() > radius {
                        *pointer += pulled - radius * pulled.signum();
                    }
                }
            }
            share = next;
            for (found, expected) in state.plays[2].iter().zip(dragged) {
                assert!((found - expected).abs() < 1e-9, "{found} {expected}");
            }
        }
    }
}

/// A wrench that is not a number is seen in every play operator of a joint that it
/// turns: on a rigid joint, nothing else would tell.
#[test]
fn what_is_not_a_number_stays_none() {
    fn check<T: Real>(robot: &impl Robot<7>, q: &SVector<f64, 7>, wrench: &Vector6<T>, is_nan: impl Fn(&T) -> bool) {
        let q = q.map(T::of);
        let mut state = State::new();
        let moved = robot.deflection_with(&q, wrench, &mut state);
        assert!(moved.iter().chain(&state.plays[2]).chain(&state.plays[5][..1]).all(&is_nan));
        assert!(robot.deflection(&q, wrench).iter().all(is_nan));
    }
    for (q, _) in trials::<7>(POSES, 49) {
        let none = Vector6::repeat(f64::NAN);
        check(&EveryLaw, &q, &none, |number| number.is_nan());
        check(&EveryLaw, &q, &none.map(|_| f32::NAN), |number| number.is_nan());
        check(&EveryLaw, &q, &none.map(|none| Lanes([1.0, none])), |number| number.0.map(f64::is_nan) == [false, true]);
        check(&with(|_| true), &q, &none, |number| number.is_nan());
    }
}

/// Return-point memory: after an excursion and back, the deflection and all
/// that follows are as if it had not been.
#[test]
fn a_closed_cycle_closes() {
    for (q, wrench) in trials::<7>(POSES, 48) {
        let mut state = State::new();
        let mut load = |share: f64| EveryLaw.deflection_with(&q, &(wrench * share), &mut state);
        load(1.0);
        let low = load(-0.6);
        let inner = load(0.3);
        assert!(off(&load(-0.2), &inner) > 1e-3);
        assert!(off(&load(0.3), &inner) < 1e-13);
        assert!(off(&load(-0.6), &low) < 1e-13);
        // The inner excursions are forgotten: the outer loop closes as well.
        let before = load(1.0);
        load(-0.6);
        assert!(off(&load(1.0), &before) < 1e-13);
    }
}

/// Masing: a branch of the loop is the virgin curve at twice the scale.
#[test]
fn branches_are_the_virgin_curve_twice_as_large() {
    let robot = with(|effect| matches!(effect, Effect::Hysteresis { .. }));
    for (q, wrench) in trials::<7>(POSES, 49) {
        let mut state = State::new();
        let top = robot.deflection_with(&q, &wrench, &mut state);
        for share in [0.9, 0.5, 0.1, -0.3, -0.8, -1.0] {
            let down = robot.deflection_with(&q, &(wrench * share), &mut state);
            let virgin = robot.deflection(&q, &(wrench * ((1.0 - share) / 2.0)));
            assert!((top - down - virgin * 2.0).amax() < 1e-13 * top.amax());
        }
    }
}

/// A cycle of loads does no work on what is elastic, and loses some to play.
#[test]
fn only_play_takes_work() {
    let elastic = with(|effect| !matches!(effect, Effect::Hysteresis { .. }));
    let cycle = |robot: &dyn Fn(&Vector6<f64>, &mut State<7>) -> Vector6<f64>, wrench: &Vector6<f64>| {
        let mut state = State::new();
        let (mut work, count) = (0.0, 400);
        let load = |k: i32| wrench * (f64::from(k) * std::f64::consts::TAU / f64::from(count)).cos();
        let mut before = (load(0), robot(&load(0), &mut state));
        for k in 1..=count {
            let now = (load(k), robot(&load(k), &mut state));
            work += (before.0 + now.0).dot(&(now.1 - before.1)) / 2.0;
            before = now;
        }
        work
    };
    for (q, wrench) in trials::<7>(20, 50) {
        let stored = wrench.dot(&elastic.deflection(&q, &wrench));
        let lost = cycle(&|wrench, state| elastic.deflection_with(&q, wrench, state), &wrench);
        assert!(lost.abs() < 1e-13 * stored, "{lost:e} of {stored:e}");
        let lost = cycle(&|wrench, state| EveryLaw.deflection_with(&q, wrench, state), &wrench);
        assert!(lost > 1e-6 * stored, "{lost:e} of {stored:e}");
    }
}

/// Everything a robot calculates in one pose.
fn assert_same(one: &Generic<7>, other: &Generic<7>, at: &SVector<f64, 7>, there: &SVector<f64, 7>) {
    let wrench = Vector6::new(300.0, -500.0, 700.0, 40.0, -60.0, 80.0);
    let size = Sizes::of(&description(FILE), at.as_slice()).reach;
    assert!((one.transform(at) - other.transform(there)).amax() < 1e-14 * size);
    assert!((one.jacobian(at) - other.jacobian(there)).amax() < 1e-14 * size);
    let compliance = other.compliance(there);
    assert!((one.compliance(at) - compliance).amax() < 1e-12 * compliance.amax());
    assert!(off(&one.deflection(at, &wrench), &other.deflection(there, &wrench)) < 1e-12);
}

#[test]
fn errors_of_frames_are_frames_elsewhere() {
    let plain = with_effects(&[]);
    for (q, _) in trials::<7>(20, 51) {
        let aside = |joint: usize, by: f64| {
            let mut q = q;
            q[joint - 1] += by;
            q
        };
        let zero = with_effects(&[Effect::JointZeroOffset { joint: 4, value: 0.02 }]);
        assert_same(&zero, &plain, &q, &aside(4, 0.02));
        let theta = with_effects(&[Effect::DhError { entry: DhEntry::Theta(6), value: -0.03 }]);
        assert_same(&theta, &plain, &q, &aside(6, -0.03));
        // The rail: an offset along it is a coordinate.
        let d = with_effects(&[Effect::DhError { entry: DhEntry::D(1), value: 0.01 }]);
        assert_same(&d, &plain, &q, &aside(1, 0.01));
        let (sin, cos) = (2e-3, -3e-3);
        let wave = with_effects(&[Effect::TransmissionError { joint: 5, order: 12.0, sin, cos }]);
        let by = sin * (12.0 * q[4]).sin() + cos * (12.0 * q[4]).cos();
        assert_same(&wave, &plain, &q, &aside(5, by));
    }
    let mut longer = Description { effects: Vec::new(), ..description(FILE) };
    longer.joints[3].a += 0.002;
    longer.joints[4].alpha -= 0.001;
    let longer = Generic::<7>::new(&longer).expect("seven joints");
    let errors = with_effects(&[
        Effect::DhError { entry: DhEntry::A(4), value: 0.002 },
        Effect::DhError { entry: DhEntry::Alpha(5), value: -0.001 },
    ]);
    for (q, _) in trials::<7>(20, 52) {
        assert_same(&errors, &longer, &q, &q);
    }
}

/// The potential energy of an arm's links \[J\], by nothing but frames and masses.
fn potential_energy<const N: usize>(robot: &Generic<N>, links: &[Link], q: &SVector<f64, N>) -> f64 {
    let heights = links.iter().zip(robot.link_frames(q)).map(|(link, frame)| {
        let centre = frame * Vector4::from_fn(|k, _| link.center_of_mass.get(k).copied().unwrap_or(1.0));
        9.80665 * link.mass * centre.z
    });
    heights.sum()
}

/// Each joint yields to the slope of the arm's potential energy; frames,
/// Jacobian and compliance are those of the arm that stands there.
fn sags_by_the_slope_of_its_energy<const N: usize>(mut description: Description) {
    description.effects.retain(|effect| !matches!(effect, Effect::TransmissionError { .. }));
    let sagging = Generic::<N>::new(&description).expect("as many joints");
    let share = description.effects.iter().find_map(|effect| match effect {
        Effect::GravitySag { share } => Some(*share),
        _ => None,
    });
    description.effects.retain(|effect| !matches!(effect, Effect::GravitySag { .. }));
    let upright = Generic::<N>::new(&description).expect("as many joints");
    let mut most = 0.0_f64;
    for (q, wrench) in trials::<N>(POSES, 48) {
        let step = 1e-4;
        let stands = SVector::<f64, N>::from_fn(|joint, _| {
            let energy = |by: f64| {
                let mut q = q;
                q[joint] += by;
                potential_energy(&upright, &description.links, &q)
            };
            let slope = (energy(step) - energy(-step)) / (2.0 * step);
            q[joint] - share.expect("it sags") * description.joints[joint].compliance() * slope
        });
        most = most.max((stands - q).amax());
        assert!((sagging.transform(&q) - upright.transform(&stands)).amax() < 1e-9);
        assert!((sagging.jacobian(&q) - upright.jacobian(&stands)).amax() < 1e-9);
        let (one, other) = (sagging.deflection(&q, &wrench), upright.deflection(&stands, &wrench));
        assert!(off(&one, &other) < 1e-8, "{one} {other}");
    }
    assert!(most > 4e-4, "it hardly sags: {most}");
}

#[test]
fn an_arm_sags_by_the_slope_of_its_potential_energy() {
    let hanging = description("hanging.yaml");
    let modified = Description { convention: Convention::Modified, ..hanging.clone() };
    sags_by_the_slope_of_its_energy::<6>(hanging);
    sags_by_the_slope_of_its_energy::<6>(modified);
}
