//! Corrections against transfer functions and limits that are known.

use nalgebra::Complex;

use super::*;
use robstiff::{Effect, Generic};
use robstiff_robots::samples;

const FREE: Limits = Limits { size: f64::INFINITY, rate: f64::INFINITY, hold: 0.0 };

fn controller(servo: Servo) -> Controller {
    Controller { sensing: Sensing::Force, step: 1e-3, delay: 3e-3, servo, limits: FREE, damping: 1e-12 }
}

fn pose() -> SVector<f64, 5> {
    SVector::from([0.3, -0.4, 0.5, 0.2, 1.2])
}

fn wrench() -> Vector6<f64> {
    Vector6::new(150.0, -200.0, 300.0, 0.0, 0.0, 0.0)
}

fn robot() -> Generic<5> {
    Generic::new(&samples::five_axis()).unwrap()
}

/// The same with every joint that much softer.
fn softer(by: f64) -> Generic<5> {
    let mut description = samples::five_axis();
    description.joints.iter_mut().flat_map(|joint| &mut joint.compliance).for_each(|part| part.value *= by);
    Generic::new(&description).unwrap()
}

#[expect(clippy::unnecessary_wraps, reason = "a sensor that is never silent")]
fn truly(_: f64, wrench: &Vector6<f64>) -> Option<Vector6<f64>> {
    Some(*wrench)
}

fn transfer(servo: Servo, frequency: f64) -> Complex<f64> {
    let s = Complex::new(0.0, TAU * frequency);
    match servo {
        Servo::Ideal => Complex::new(1.0, 0.0),
        Servo::FirstOrder { bandwidth } => (s / (TAU * bandwidth) + 1.0).inv(),
        Servo::SecondOrder { frequency, damping } => {
            let x = s / (TAU * frequency);
            (x * x + x * (2.0 * damping) + 1.0).inv()
        }
    }
}

#[test]
fn what_is_left_is_what_the_transfer_function_says() {
    let servos = [
        Servo::Ideal,
        Servo::FirstOrder { bandwidth: 20.0 },
        Servo::SecondOrder { frequency: 15.0, damping: 0.7 },
        Servo::SecondOrder { frequency: 15.0, damping: 1.6 },
    ];
    for servo in servos {
        for frequency in [0.5, 3.0, 11.0, 40.0] {
            let controller = controller(servo);
            let robot = robot();
            let left = left_of_sine((&robot, &robot), &pose(), &controller, (&wrench(), frequency), truly);
            let half = 0.5 * TAU * frequency * controller.step;
            let held = half.sin() / half;
            let late = Complex::new(0.0, -TAU * frequency * controller.delay - half).exp();
            let expected = (Complex::new(1.0, 0.0) - transfer(servo, frequency) * late * held).norm();
            assert!((left.amplitude / expected - 1.0).abs() < 0.01, "{servo:?} {frequency}: {left:?} {expected}");
        }
    }
}

/// With damping far above 1 the slower pole is that of a first order, at
/// `frequency / (2 damping)`.
/// Where a force changes slowly, `1 - exp(-i w lag)` is left.
#[test]
fn what_is_left_of_a_slow_force_is_its_change_over_the_lag() {
    let servos = [
        Servo::Ideal,
        Servo::FirstOrder { bandwidth: 15.0 },
        Servo::SecondOrder { frequency: 15.0, damping: 0.7 },
        Servo::SecondOrder { frequency: 2.0, damping: 1.5 },
    ];
    for servo in servos {
        for delay in [0.0, 0.3] {
            let controller = Controller { delay, ..controller(servo) };
            let frequency = 0.01 / controller.lag();
            let left =
                left_of_sine((&robot(), &robot()), &pose(), &controller, (&wrench(), frequency), truly).amplitude;
            assert!((left / (TAU * 0.01) - 1.0).abs() < 0.02, "{servo:?} {delay}: {left}");
        }
    }
}

#[test]
fn the_effort_is_known_before() {
    let sine = |servo| Effort::of_sine(&controller(servo), 5.0);
    let heavy = sine(Servo::SecondOrder { frequency: 15.0, damping: 1e9 });
    let first = sine(Servo::FirstOrder { bandwidth: 7.5e-9 });
    assert!((heavy.duration / first.duration - 1.0).abs() < 1e-9, "{heavy:?} {first:?}");
    assert!(sine(Servo::SecondOrder { frequency: 15.0, damping: 1e200 }).duration > 1e100);
    let ideal = sine(Servo::Ideal);
    assert!((ideal.duration - 0.2 - 2.0).abs() < 1e-12, "{ideal:?}");
    let (_, timeline) = square();
    let slow = Controller { step: 0.01, ..controller(Servo::Ideal) };
    let effort = Effort::along(&slow, timeline.duration());
    let seen = simulate_along((&robot(), &robot()), &timeline, &slow, truly);
    assert_eq!(seen.len() as f64, effort.instants());
}

#[test]
fn without_delay_the_error_of_the_model_is_left() {
    let ideal = Controller { step: 1e-5, delay: 0.0, ..controller(Servo::Ideal) };
    let (truth, model) = (robot(), softer(0.9));
    let left = left_of_sine((&truth, &model), &pose(), &ideal, (&wrench(), 20.0), truly);
    assert!((left.amplitude - 0.1).abs() < 1e-3 && (left.rms - 0.1).abs() < 1e-3, "{left:?}");
    let left = left_of_sine((&truth, &truth), &pose(), &ideal, (&wrench(), 20.0), truly);
    assert!(left.rms < 2e-3, "{left:?}");
}

#[test]
fn encoders_need_no_model_of_gears_and_do_not_see_links() {
    let ideal = Controller { sensing: Sensing::Encoders, step: 1e-5, delay: 0.0, ..controller(Servo::Ideal) };
    let wrong = softer(0.3);
    let left = left_of_sine((&robot(), &wrong), &pose(), &ideal, (&wrench(), 20.0), truly);
    assert!(left.rms < 2e-3, "{left:?}");
    let mut tilting = samples::five_axis();
    tilting.effects = vec![Effect::TransverseCompliance { joint: 3, value: 6e-7 }];
    let tilting = Generic::new(&tilting).unwrap();
    let left = left_of_sine((&tilting, &wrong), &pose(), &ideal, (&wrench(), 20.0), truly);
    let (whole, gears) = (tilting.deflection(&pose(), &wrench()), robot().deflection(&pose(), &wrench()));
    let unseen = (whole - gears).fixed_rows::<3>(0).norm() / whole.fixed_rows::<3>(0).norm();
    assert!(unseen > 0.05 && (left.amplitude - unseen).abs() < 3e-3, "{left:?} {unseen}");
}

#[test]
fn what_a_gear_keeps_after_the_load_is_taken_back() {
    let mut rubbing = samples::five_axis();
    let play = |joint| Effect::Hysteresis {
        joint,
        radius1: 40.0,
        weight1: 1e-6,
        radius2: 90.0,
        weight2: 5e-7,
        radius3: 0.0,
        weight3: 0.0,
    };
    rubbing.effects = vec![play(1), play(2), play(3)];
    let rubbing = Generic::new(&rubbing).unwrap();
    // Up, to nothing, the other way, and to nothing again.
    let samples = [0.0, 1.0, 0.0, 0.0, -0.6, 0.0, 0.0].into_iter().zip(0..).map(|(part, at)| (f64::from(at), part));
    let timeline = Timeline::at_pose(&pose(), samples.map(|(time, part)| (time, wrench() * part))).unwrap();
    let free = robot();
    for sensing in [Sensing::Force, Sensing::Encoders] {
        let ideal = Controller { sensing, step: 1e-3, delay: 0.0, ..controller(Servo::Ideal) };
        let seen = simulate_along((&rubbing, &rubbing), &timeline, &ideal, truly);
        let worst = |of: fn(&Instant) -> Vector3<f64>, seen: &[Instant]| {
            seen.iter().map(|seen| of(seen).norm()).fold(0.0, f64::max)
        };
        let aside: Vec<Instant> = seen.iter().filter(|seen| !seen.in_cut).copied().collect();
        let (whole, kept) = (worst(|seen| seen.uncorrected, &seen), worst(|seen| seen.uncorrected, &aside));
        assert!(kept > 0.05 * whole, "{kept} {whole}");
        let left = worst(|seen| seen.corrected, &seen);
        assert!(left < 3e-3 * whole, "{sensing:?} {left} {kept} {whole}");
        // A model that does not know of it leaves it.
        if sensing == Sensing::Force {
            let seen = simulate_along((&rubbing, &free), &timeline, &ideal, truly);
            let aside: Vec<Instant> = seen.iter().filter(|seen| !seen.in_cut).copied().collect();
            assert!((worst(|seen| seen.corrected, &aside) / kept - 1.0).abs() < 0.1);
        }
    }
}

#[test]
fn size_and_rate_are_limited_and_a_silent_sensor_is_let_go() {
    let limits = Limits { size: 1e-4, rate: 0.01, hold: 0.05 };
    let controller = Controller { limits, delay: 0.0, ..controller(Servo::Ideal) };
    let robot = robot();
    let moves = robot.jacobian(&pose()).fixed_rows::<3>(0).into_owned();
    let silent_from = 0.2;
    let seen = simulate(
        (&robot, &robot),
        &pose(),
        &controller,
        0.5,
        |_| wrench() * 10.0,
        |time, wrench| (time < silent_from).then_some(*wrench),
    );
    let corrections: Vec<_> = seen.iter().map(|seen| (seen.time, seen.corrected - seen.uncorrected)).collect();
    // If all joints moved it the same way.
    let reach = moves.column_iter().map(|column| column.norm()).sum::<f64>();
    for pair in corrections.windows(2) {
        assert!((pair[1].1 - pair[0].1).norm() <= reach * limits.rate * controller.step * 1.001);
        assert!(pair[0].1.norm() <= reach * limits.size * 1.001);
    }
    let at = |time: f64| corrections.iter().find(|(t, _)| *t >= time).unwrap().1;
    assert!(at(0.19).norm() > 1e-5);
    assert_eq!(at(silent_from + 0.9 * limits.hold), at(0.19));
    assert_eq!(at(0.45).norm(), 0.0);
    // First by the speed, then by the size, and by nothing while the last correction stays.
    let held_back = |time: f64| seen.iter().find(|seen| seen.time > time).unwrap().held_back;
    assert!(held_back(0.001).by_rate && held_back(0.001).by_size);
    assert_eq!(held_back(0.19), HeldBack { by_size: true, by_rate: false });
    assert_eq!(held_back(silent_from + 0.5 * limits.hold), HeldBack::default());
    assert_eq!(held_back(0.45), HeldBack::default());
}

#[test]
#[should_panic(expected = "a limit is not negative")]
fn a_limit_is_not_negative() {
    let wrong = Controller { limits: Limits { size: -1e-3, rate: 0.01, hold: 0.05 }, ..controller(Servo::Ideal) };
    simulate((&robot(), &robot()), &pose(), &wrong, 0.1, |_| wrench(), truly);
}

#[test]
fn a_delay_longer_than_the_cut_corrects_nothing() {
    for sensing in [Sensing::Force, Sensing::Encoders] {
        let late = Controller { sensing, delay: 0.5, ..controller(Servo::Ideal) };
        let seen = simulate((&robot(), &robot()), &pose(), &late, 0.4, |_| wrench(), truly);
        assert_eq!(seen.len(), 400 * Effort::at_pose(&late, 0.4).points);
        assert!(seen.iter().all(|seen| seen.corrected == seen.uncorrected && seen.uncorrected.norm() > 1e-5));
    }
    // With the end of the delay within the cut, from then on.
    let late = Controller { delay: 0.3, ..controller(Servo::Ideal) };
    let seen = simulate((&robot(), &robot()), &pose(), &late, 0.4, |_| wrench(), truly);
    let at = |time: f64| seen.iter().find(|seen| seen.time > time).unwrap();
    assert_eq!(at(0.299).corrected, at(0.299).uncorrected);
    assert!(at(0.301).corrected.norm() < 1e-6 * at(0.301).uncorrected.norm());
}

#[test]
fn a_correction_beyond_its_size_stops_there() {
    let robot = robot();
    let whole = back(&robot, &pose(), &wrench(), 1e-12, &mut State::new());
    // Half of what the joint that moves most wants.
    let size = 0.5 * whole.amax();
    assert!(whole.iter().any(|joint| joint.abs() < size));
    let limits = Limits { size, ..FREE };
    let held = Controller { limits, delay: 0.0, ..controller(Servo::Ideal) };
    let seen = simulate((&robot, &robot), &pose(), &held, 0.05, |_| wrench(), truly);
    let moves = robot.jacobian(&pose()).fixed_rows::<3>(0).into_owned();
    let expected = moves * whole.map(|joint| joint.clamp(-size, size));
    let last = seen.last().unwrap();
    assert!((last.corrected - last.uncorrected - expected).norm() < 1e-15);
    assert!(last.corrected.norm() > 0.05 * last.uncorrected.norm());
}

#[test]
fn encoders_that_fall_silent_are_held_and_withdrawn_at_the_speed_allowed() {
    let robot = robot();
    let whole = joint_turns(&robot, &pose(), &wrench(), &State::new());
    let (silent_from, rate) = (0.2, 0.01);
    let limits = Limits { size: 1.0, rate, hold: 0.05 };
    let controller = Controller { sensing: Sensing::Encoders, limits, delay: 0.0, ..controller(Servo::Ideal) };
    let reading = |time: f64, wrench: &Vector6<f64>| (time < silent_from).then_some(*wrench);
    let seen = simulate((&robot, &robot), &pose(), &controller, 0.5, |_| wrench(), reading);
    let moves = robot.jacobian(&pose()).fixed_rows::<3>(0).into_owned();
    let at = |time: f64| seen.iter().find(|seen| seen.time > time).unwrap();
    let moved = |time: f64| at(time).corrected - at(time).uncorrected;
    // All joints have come to what they want, each at the same speed.
    assert!(whole.amax() / rate < 0.15, "{whole}");
    assert!((moved(0.15) + moves * whole).norm() < 1e-12);
    assert_eq!(moved(0.24), moved(0.15));
    // Some steps after the hold, each joint is that much nearer to nothing.
    let steps = 5;
    let back = rate * controller.step * f64::from(steps);
    let left = whole.map(|joint| joint.signum() * (joint.abs() - back).max(0.0));
    let time = silent_from + limits.hold + f64::from(steps) * controller.step;
    let one = rate * controller.step * moves.norm() * 5_f64.sqrt();
    assert!((moved(time) + moves * left).norm() < 1.5 * one, "{} {}", moved(time), -(moves * left));
    assert_eq!(moved(0.48), Vector3::zeros());
}

#[test]
fn noise_is_left_as_rms_and_not_as_amplitude() {
    let controller = controller(Servo::FirstOrder { bandwidth: 20.0 });
    let robot = robot();
    let quiet = left_of_sine((&robot, &robot), &pose(), &controller, (&wrench(), 2.0), truly);
    // Every other reading is off by a tenth of the force, this way and that.
    let mut sign = 1.0;
    let noisy = left_of_sine((&robot, &robot), &pose(), &controller, (&wrench(), 2.0), |_, now| {
        sign = -sign;
        Some(now + wrench() * (0.5 * sign))
    });
    assert!((noisy.amplitude / quiet.amplitude - 1.0).abs() < 0.01, "{noisy:?} {quiet:?}");
    assert!(noisy.rms > quiet.rms * 1.001, "{noisy:?} {quiet:?}");
}

/// A square, 10 mm/s, that is longer than what the controller takes to settle.
fn square() -> (Generic<5>, Timeline<5>) {
    let robot = robot();
    let corners = [[0.0, 0.0], [0.04, 0.0], [0.04, 0.04], [0.0, 0.04], [0.0, 0.0]];
    let inverse = crate::inverse::Inverse::new(&robot);
    let start = robot.transform(&pose());
    let point = |(k, [x, y]): (usize, [f64; 2])| {
        let mut at = start;
        (at[(0, 3)], at[(1, 3)]) = (at[(0, 3)] + x, at[(1, 3)] + y);
        let direction = nalgebra::Unit::new_normalize(at.fixed_view::<3, 1>(0, 0).into_owned());
        let position = at.fixed_view::<3, 1>(0, 3).into_owned();
        let target = crate::inverse::Target::axis(position, Vector3::x_axis(), direction);
        let q = inverse.nearest(&target, &pose()).unwrap();
        let feed = (k > 2).then_some(0.02);
        crate::path::PathPoint {
            line: k + 2,
            q,
            pose: at,
            tangent: None,
            s: 0.04 * k as f64,
            feed,
            rapid: false,
            spindle: None,
            tool: None,
            width: None,
            depth: None,
        }
    };
    let points = corners.into_iter().enumerate().map(point).collect();
    let path = crate::path::SolvedPath { points, jumps: vec![] };
    let wrenches = [wrench(), wrench() * 2.0, wrench(), -wrench(), wrench()];
    assert_eq!(Timeline::of_path(&path, &wrenches, None), Err(NoFeed { lines: vec![3, 4] }));
    (robot, Timeline::of_path(&path, &wrenches, Some(0.01)).unwrap())
}

#[test]
fn a_path_takes_its_time() {
    let (_, timeline) = square();
    assert!((timeline.duration() - 12.0).abs() < 1e-12);
    assert_eq!(timeline.times().collect::<Vec<_>>(), [0.0, 4.0, 8.0, 10.0, 12.0]);
    assert!((timeline.wrench(2.0) - wrench() * 1.5).norm() < 1e-9);
    assert!(timeline.wrench(9.0).norm() < 1e-9);
    assert_eq!(timeline.posture(-1.0), timeline.posture(0.0));
    assert_eq!(timeline.posture(99.0), timeline.posture(12.0));
    assert!((timeline.posture(9.0) * 2.0 - timeline.posture(8.0) - timeline.posture(10.0)).norm() < 1e-12);
}

#[test]
fn along_a_path_the_tool_is_brought_back_wherever_the_arm_is() {
    let (robot, timeline) = square();
    let ideal = Controller { step: 1e-3, delay: 0.0, ..controller(Servo::Ideal) };
    let seen = simulate_along((&robot, &robot), &timeline, &ideal, truly);
    for seen in &seen {
        let q = timeline.posture(seen.time);
        let expected = robot.deflection(&q, &timeline.wrench(seen.time)).fixed_rows::<3>(0).into_owned();
        assert!((seen.uncorrected - expected).norm() < 1e-15);
    }
    let worst = |of: fn(&Instant) -> Vector3<f64>| seen.iter().map(|seen| of(seen).norm()).fold(0.0, f64::max);
    // What a force of 600 N/s changes in a step.
    assert!(worst(|seen| seen.corrected) < 2e-3 * worst(|seen| seen.uncorrected));
    // A sensor that is lost for a second leaves the whole of it.
    let lost = |time: f64, wrench: &Vector6<f64>| (!(5.0..6.0).contains(&time)).then_some(*wrench);
    let seen = simulate_along((&robot, &robot), &timeline, &ideal, lost);
    let at = |time: f64| seen.iter().find(|seen| seen.time > time).unwrap();
    assert!((at(5.5).corrected - at(5.5).uncorrected).norm() < 1e-12);
    assert!(at(6.5).corrected.norm() < 2e-3 * at(6.5).uncorrected.norm());
}

#[test]
fn a_recorded_force_is_played_at_a_pose() {
    let samples = [(0.3, wrench()), (0.1, wrench() * 0.0), (0.2, wrench() * 3.0)];
    let timeline = Timeline::at_pose(&pose(), samples).unwrap();
    assert!((timeline.duration() - 0.2).abs() < 1e-12);
    assert!((timeline.wrench(0.05) - wrench() * 1.5).norm() < 1e-9);
    assert_eq!(timeline.posture(0.1), pose());
    assert_eq!(Timeline::at_pose(&pose(), []), None);
    assert_eq!(Timeline::at_pose(&pose(), [(f64::NAN, wrench())]), None);
}
