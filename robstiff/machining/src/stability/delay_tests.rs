//! The lobes against the model itself: integrated in time, tooth by tooth, and by the count of
//! its roots.

use core::f64::consts::{PI, TAU};

use nalgebra::{Complex, Matrix3, Rotation3, Vector3};

use super::*;
use crate::milling::{Coefficients, Cut, CutFrame, Direction, EndMill, Engagement};

/// Random numbers (splitmix64), the same every time.
struct Draws(u64);

impl Draws {
    fn between(&mut self, from: f64, to: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        from + (to - from) * (bits >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Evenly in its logarithm.
    fn ratio(&mut self, from: f64, to: f64) -> f64 {
        self.between(from.ln(), to.ln()).exp()
    }

    fn turn(&mut self) -> Matrix3<f64> {
        let mut angle = || self.between(-PI, PI);
        *Rotation3::from_euler_angles(angle(), angle(), angle()).matrix()
    }
}

/// An arm by its matrices at the tool.
struct Arm {
    mass: Matrix3<f64>,
    dashpots: Matrix3<f64>,
    stiffness: Matrix3<f64>,
    modes: Modes,
}

impl Arm {
    /// Three springs across each other, a mass that is not the same in all directions.
    fn drawn(draws: &mut Draws, damping: f64) -> Self {
        let [turn, other] = [draws.turn(), draws.turn()];
        let mut diagonal = |from, to| Matrix3::from_diagonal(&Vector3::from_fn(|_, _| draws.ratio(from, to)));
        let stiffness = turn * diagonal(0.4e6, 4e6) * turn.transpose();
        let mass = other * diagonal(80.0, 200.0) * other.transpose();
        let compliance = stiffness.try_inverse().unwrap();
        let modes = Modes::new(&compliance, &mass, damping).unwrap();
        // 2 zeta Omega of every mode, in the coordinates of the tool.
        let back = Matrix3::from_column_slice(modes.shapes().as_slice()).try_inverse().unwrap();
        let rates = Matrix3::from_diagonal(&Vector3::from_column_slice(modes.frequencies())) * (2.0 * damping);
        Self { mass, dashpots: back.transpose() * rates * back, stiffness, modes }
    }

    /// The displacement of the tool by a force of the frequency (rad/s).
    fn response(&self, frequency: f64) -> Matrix3<Complex<f64>> {
        let real = self.stiffness - self.mass * (frequency * frequency);
        let imaginary = self.dashpots * frequency;
        real.zip_map(&imaginary, Complex::new).try_inverse().unwrap()
    }
}

fn drawn_cut(draws: &mut Draws) -> Cut {
    let teeth = draws.between(2.0, 7.0) as usize;
    let helix = draws.between(-0.7, 0.7);
    let mill = EndMill { diameter: 0.02, teeth, helix, corner: 0.0, runout: Vec::new() };
    let ktc = draws.between(200e6, 1000e6);
    let [krc, kac] = [draws.between(0.1, 0.6) * ktc, draws.between(0.0, 0.5) * ktc];
    let width = draws.between(0.004, 0.02);
    let direction = if draws.between(0.0, 1.0) < 0.5 { Direction::Up } else { Direction::Down };
    let coefficients = Coefficients { ktc, kte: 0.0, krc, kre: 0.0, kac, kae: 0.0 };
    let engagement = Engagement::of_width(direction, width, 0.02).unwrap();
    Cut { mill, coefficients, engagement, depth: 0.002, feed_per_tooth: 1e-4, speed: None }
}

/// How the force on the tool changes with the chip in each of so many parts of the time between
/// two teeth, per depth: every tooth with its angle, exact within the part.
pub(super) fn tooth_by_tooth(cut: &Cut, frame: &CutFrame, parts: usize) -> Vec<Matrix3<f64>> {
    let Coefficients { ktc, krc, kac, .. } = cut.coefficients;
    let kac = kac.copysign(cut.mill.helix);
    let pitch = TAU / cut.mill.teeth as f64;
    let axes = frame.matrix();
    let inside = |from: f64, to: f64| {
        // By Gauss, with three points; a tooth may enter or leave in this part.
        let [from, to] = [from.max(cut.engagement.entry), to.min(cut.engagement.exit)];
        let mut sum = Matrix3::zeros();
        for (at, weight) in [(-0.6_f64.sqrt(), 5.0), (0.0, 8.0), (0.6_f64.sqrt(), 5.0)] {
            let angle = 0.5 * (from + to) + 0.5 * at * (to - from);
            let [ahead, outward] =
                [Vector3::new(angle.cos(), -angle.sin(), 0.0), Vector3::new(angle.sin(), angle.cos(), 0.0)];
            let force = -ahead * ktc - outward * krc + Vector3::z() * kac;
            sum += force * outward.transpose() * (weight / 18.0 * (to - from).max(0.0));
        }
        sum
    };
    let step = pitch / parts as f64;
    let part = |k: usize| {
        let teeth = (0..cut.mill.teeth).map(|tooth| pitch * tooth as f64 + step * k as f64);
        let local: Matrix3<f64> = teeth.map(|angle| inside(angle, angle + step)).sum();
        axes * local * axes.transpose() / step
    };
    (0..parts).map(part).collect()
}

/// By how much a small movement has grown between a third and the end of a time (s): the
/// equation of motion by Runge and Kutta, with the displacements one tooth ago from memory.
/// `cutting` is how the force changes with the chip in each part of the time between two teeth
/// (N/m).
fn growth(arm: &Arm, cutting: &[Matrix3<f64>], period: f64, seconds: f64) -> f64 {
    let parts = cutting.len();
    let step = period / parts as f64;
    let inverse = arm.mass.try_inverse().unwrap();
    let [springs, dashpots] = [inverse * arm.stiffness, inverse * arm.dashpots];
    let pushed: Vec<Matrix3<f64>> = cutting.iter().map(|process| inverse * process).collect();
    let steps = (seconds / step) as usize;
    // Before it began, the tool was at rest.
    let mut past = vec![(Vector3::zeros(), Vector3::zeros()); parts + 1];
    past[parts] = (Vector3::new(1.0, -0.7, 0.4), Vector3::new(-20.0, 40.0, 30.0));
    let mut largest = [0.0_f64; 2];
    for k in 0..steps {
        let now = past.len() - 1;
        let (x, v) = past[now];
        let [(before, slow), (after, fast)] = [past[now - parts], past[now - parts + 1]];
        let middle = (before + after) * 0.5 + (slow - fast) * (step / 8.0);
        let force = |x: Vector3<f64>, v: Vector3<f64>, cut: Vector3<f64>| {
            pushed[k % parts] * (x - cut) - springs * x - dashpots * v
        };
        let (x1, v1) = (v, force(x, v, before));
        let (x2, v2) = (v + v1 * (0.5 * step), force(x + x1 * (0.5 * step), v + v1 * (0.5 * step), middle));
        let (x3, v3) = (v + v2 * (0.5 * step), force(x + x2 * (0.5 * step), v + v2 * (0.5 * step), middle));
        let (x4, v4) = (v + v3 * step, force(x + x3 * step, v + v3 * step, after));
        let x = x + (x1 + x2 * 2.0 + x3 * 2.0 + x4) * (step / 6.0);
        let v = v + (v1 + v2 * 2.0 + v3 * 2.0 + v4) * (step / 6.0);
        past.push((x, v));
        match (100 * k) / steps {
            33..50 => largest[0] = largest[0].max(x.norm()),
            83.. => largest[1] = largest[1].max(x.norm()),
            _ => {}
        }
    }
    largest[1] / largest[0]
}

/// How many movements grow, by the argument of
/// `det(I - a P G(i w) (1 - exp(-i w T)))` along the imaginary axis: it goes around zero once
/// for each, and has no poles to the right.
fn growing(arm: &Arm, process: &Matrix3<f64>, period: f64) -> usize {
    let at = |frequency: f64| {
        let delay = Complex::from(1.0) - Complex::new(0.0, -frequency * period).exp();
        let loops = process.map(Complex::from) * arm.response(frequency) * delay;
        (Matrix3::<Complex<f64>>::identity() - loops).determinant()
    };
    let first = arm.modes.frequencies()[0];
    let mut frequency = 0.0;
    let (mut value, mut turned) = (at(0.0), 0.0);
    // In steps in which it turns by little, also half way; the waves of the delay are seen.
    let longest = 0.2 / period;
    let mut step = longest.min(1e-3 * first);
    loop {
        let [half, whole] = [at(frequency + 0.5 * step), at(frequency + step)];
        let [one, other] = [(half / value).arg(), (whole / half).arg()];
        if one.abs().max(other.abs()) > 0.1 && step > 1e-10 * first {
            step *= 0.5;
            continue;
        }
        turned += one + other;
        (frequency, value) = (frequency + step, whole);
        if frequency > 2.0 * arm.modes.frequencies()[2] && (value - 1.0).norm() < 0.01 && {
            // From here on it stays near 1: the response falls with the square of the frequency.
            2.0 * (process.map(Complex::from) * arm.response(frequency)).norm() < 0.3
        } {
            break;
        }
        if one.abs().max(other.abs()) < 0.03 {
            step = (2.0 * step).min(longest).min(0.3 * arm.modes.damping()[0].min(0.1) * frequency.max(0.02 * first));
        }
    }
    let count = -(turned / PI).round();
    assert!(count >= 0.0 && (turned / PI + count).abs() < 0.02, "{turned}");
    count as usize
}

/// Teeth that pass far quicker than the arm moves, as the mean over the teeth asks for.
#[test]
fn a_simulation_in_time_tooth_by_tooth_agrees_within_five_percent() {
    let mut draws = Draws(51);
    let (mut cases, mut drawn) = (0, 0);
    while cases < 30 {
        drawn += 1;
        assert!(drawn < 300);
        let damping = draws.between(0.02, 0.05);
        let arm = Arm::drawn(&mut draws, damping);
        let cut = drawn_cut(&mut draws);
        let axis = draws.turn() * Vector3::z();
        let frame = CutFrame::new(&axis, &(draws.turn() * Vector3::x())).unwrap();
        let [first, last] = [arm.modes.frequencies()[0], arm.modes.frequencies()[2]];
        let period = TAU / last / draws.ratio(15.0, 60.0);
        let lobes = Lobes::new(&arm.modes, &process(&cut, &frame), 0.02).unwrap();
        let limits = lobes.limits(period);
        let Some(limit) = limits.limiting().filter(|limit| !limits.is_stable(1.05 * limit)) else { continue };
        cases += 1;
        let cutting = tooth_by_tooth(&cut, &frame, 16);
        let mean: Matrix3<f64> = cutting.iter().sum::<Matrix3<f64>>() / 16.0;
        let seconds = 30.0 / (damping * first);
        for (share, stable) in [(0.5, true), (0.95, true), (1.05, false)] {
            let at = |process: &Matrix3<f64>| process * (share * limit);
            let all = growth(&arm, &cutting.iter().map(at).collect::<Vec<_>>(), period, seconds);
            let averaged = growth(&arm, &[at(&mean); 16], period, seconds);
            assert_eq!(all < 1.0, stable, "case {cases}, {share} of {limit} m, teeth each {period} s: {all}");
            assert_eq!(averaged < 1.0, stable, "case {cases}, {share} of {limit} m, averaged: {averaged}");
        }
    }
}

/// Teeth as slow as the arm and slower, with many waves between two of them.
#[test]
fn a_simulation_in_time_with_the_mean_over_the_teeth_agrees_at_slow_teeth() {
    let mut draws = Draws(52);
    let mut cases = 0;
    for _ in 0..20 {
        let damping = draws.between(0.02, 0.05);
        let arm = Arm::drawn(&mut draws, damping);
        let frame = CutFrame::new(&(draws.turn() * Vector3::z()), &(draws.turn() * Vector3::x())).unwrap();
        let process = process(&drawn_cut(&mut draws), &frame);
        let [first, last] = [arm.modes.frequencies()[0], arm.modes.frequencies()[2]];
        let period = TAU / first * draws.ratio(0.1, 10.0);
        let limits = Lobes::new(&arm.modes, &process, 0.02).unwrap().limits(period);
        let Some(limit) = limits.limiting().filter(|limit| !limits.is_stable(1.05 * limit)) else { continue };
        cases += 1;
        let parts = (40.0 * period * last / TAU).ceil() as usize;
        let seconds = 40.0 / (damping * first) + 30.0 * period;
        for (share, stable) in [(0.95, true), (1.05, false)] {
            let grown = growth(&arm, &vec![process * (share * limit); parts], period, seconds);
            assert_eq!(grown < 1.0, stable, "{share} of {limit} m, teeth each {period} s: {grown}");
        }
    }
    assert!(cases > 12, "{cases}");
}

/// Teeth from far quicker to far slower than the arm.
#[test]
fn the_count_of_growing_movements_agrees() {
    let mut draws = Draws(7);
    let mut limited = 0;
    for case in 0..40 {
        let damping = draws.ratio(0.003, 0.2);
        let arm = Arm::drawn(&mut draws, damping);
        let cut = drawn_cut(&mut draws);
        let frame = CutFrame::new(&(draws.turn() * Vector3::z()), &(draws.turn() * Vector3::x())).unwrap();
        let process = process(&cut, &frame);
        let period = TAU / arm.modes.frequencies()[0] * draws.ratio(0.01, 20.0);
        let limits = Lobes::new(&arm.modes, &process, 0.1).unwrap().limits(period);
        let mut depths: Vec<(f64, bool)> = Vec::new();
        for _ in 0..6 {
            let depth = draws.ratio(1e-4, 0.1);
            depths.push((depth, limits.is_stable(depth)));
        }
        if let Some(limit) = limits.limiting() {
            depths.extend([0.5, 0.999, 1.001].map(|share| (share * limit, limits.is_stable(share * limit))));
            limited += 1;
        }
        for (depth, stable) in depths {
            let near = limits.unstable.iter().flatten().any(|bound| (bound / depth - 1.0).abs() < 1e-6);
            let count = growing(&arm, &(process * depth), period);
            assert!(near || (count == 0) == stable, "case {case}: {depth} m, {count} grow, {limits:?}");
        }
    }
    assert!(limited > 20, "{limited}");
}

/// The same for modes beside which the tool gives way without a mass: by the trapezoidal rule,
/// which solves for the force that is there at once.
fn growth_of_modes(modes: &Modes, process: &Matrix3<f64>, parts: usize, period: f64, seconds: f64) -> f64 {
    let step = period / parts as f64;
    let count = modes.frequencies().len();
    let shapes: Vec<Vector3<f64>> = modes.shapes().column_iter().map(|shape| shape.fixed_rows::<3>(0).into()).collect();
    let stiff = |mode: usize| modes.frequencies()[mode].powi(2);
    let damps = |mode: usize| 2.0 * modes.damping()[mode] * modes.frequencies()[mode];
    let weight = |mode: usize| 2.0 / step + damps(mode) + 0.5 * step * stiff(mode);
    let mut at_once = modes.massless;
    for (mode, shape) in shapes.iter().enumerate() {
        at_once += shape * shape.transpose() * (0.5 * step / weight(mode));
    }
    let solve = (Matrix3::identity() - at_once * process).try_inverse().unwrap();
    let (mut w, mut v) = (vec![0.0; count], vec![1.0; count]);
    let (mut force, mut past) = (Vector3::zeros(), vec![Vector3::zeros(); parts]);
    let steps = (seconds / step) as usize;
    let mut largest = [0.0_f64; 2];
    for k in 0..steps {
        let known = |mode: usize| {
            let pull = shapes[mode].dot(&force) - damps(mode) * v[mode] - stiff(mode) * w[mode];
            let half_way = w[mode] + 0.5 * step * v[mode];
            (v[mode] + 0.5 * step * pull + (2.0 / step + damps(mode)) * half_way) / weight(mode)
        };
        let free: Vec<f64> = (0..count).map(known).collect();
        let cut = past[past.len() - parts];
        let moved: Vector3<f64> = shapes.iter().zip(&free).map(|(shape, w)| shape * *w).sum();
        let x = solve * (moved - at_once * process * cut);
        force = process * (x - cut);
        for mode in 0..count {
            let next = free[mode] + 0.5 * step * shapes[mode].dot(&force) / weight(mode);
            v[mode] = 2.0 * (next - w[mode]) / step - v[mode];
            w[mode] = next;
        }
        past.push(x);
        match (100 * k) / steps {
            33..50 => largest[0] = largest[0].max(x.norm()),
            83.. => largest[1] = largest[1].max(x.norm()),
            _ => {}
        }
    }
    largest[1] / largest[0]
}

#[test]
fn a_simulation_in_time_agrees_where_something_has_no_mass() {
    let mut draws = Draws(53);
    let mut cases = 0;
    for softest in [1e-7, 3e-6].repeat(20) {
        let damping = draws.between(0.02, 0.05);
        let mut modes = Arm::drawn(&mut draws, damping).modes;
        let turn = draws.turn();
        let soft = Vector3::from_fn(|_, _| draws.ratio(1e-8, softest));
        modes.massless = turn * Matrix3::from_diagonal(&soft) * turn.transpose();
        modes.compliance += modes.massless;
        let frame = CutFrame::new(&(draws.turn() * Vector3::z()), &(draws.turn() * Vector3::x())).unwrap();
        let process = process(&drawn_cut(&mut draws), &frame);
        let [first, last] = [modes.frequencies()[0], modes.frequencies()[2]];
        let period = TAU / last / draws.ratio(0.5, 30.0);
        let limits = Lobes::new(&modes, &process, 0.02).unwrap().limits(period);
        let Some(limit) = limits.limiting().filter(|limit| !limits.is_stable(1.05 * limit)) else { continue };
        cases += 1;
        let parts = (60.0 * period * last / TAU).ceil().max(8.0) as usize;
        let seconds = 30.0 / (damping * first);
        for (share, stable) in [(0.95, true), (1.05, false)] {
            let grown = growth_of_modes(&modes, &(process * (share * limit)), parts, period, seconds);
            assert_eq!(grown < 1.0, stable, "{share} of {limit} m, teeth each {period} s: {grown}");
        }
    }
    assert!(cases > 20, "{cases}");
}
