//! Measured modes: against the model of one mass, and published cases of milling.

use core::f64::consts::{PI, TAU};

use nalgebra::{Complex, DMatrix, DVector, Matrix3, Rotation3, Vector3};

use super::delay_tests::tooth_by_tooth;
use super::tests::cut;
use super::*;
use crate::milling::{Coefficients, Cut, CutFrame, Direction, EndMill, Engagement};

/// What a modal test would find of these modes.
fn table_of(modes: &Modes) -> Vec<MeasuredMode> {
    let each = modes.shapes().column_iter().zip(modes.frequencies().iter().zip(modes.damping()));
    let measured = each.map(|(shape, (frequency, damping))| MeasuredMode {
        frequency: *frequency,
        damping: *damping,
        stiffness: (frequency / shape.norm()).powi(2),
        direction: Vector3::new(shape[0], shape[1], shape[2]) * 3.0,
    });
    // In any order.
    let mut table: Vec<MeasuredMode> = measured.collect();
    table.reverse();
    table
}

#[test]
fn a_table_of_the_modes_of_one_mass_has_its_limits() {
    let turn = *Rotation3::from_euler_angles(0.4, -0.7, 1.1).matrix();
    let compliance = turn * Matrix3::from_diagonal(&Vector3::new(2e-6, 1.5e-6, 1.1e-6)) * turn.transpose();
    let mass = Matrix3::new(120.0, 10.0, 0.0, 10.0, 90.0, -5.0, 0.0, -5.0, 150.0);
    let modes = Modes::new(&compliance, &mass, 0.03).unwrap();
    let table = Modes::measured(&table_of(&modes)).unwrap();
    assert!((table.compliance() - compliance).norm() < 1e-12 * compliance.norm());
    assert!((table.mass().unwrap() - mass).norm() < 1e-9 * mass.norm());
    let same = |one: &Limits, other: &Limits| {
        assert_eq!(one.unstable.len(), other.unstable.len(), "{one:?} {other:?}");
        for (one, other) in one.unstable.iter().flatten().zip(other.unstable.iter().flatten()) {
            assert!((one / other - 1.0).abs() < 1e-7, "{one} {other}");
        }
    };
    let mut limited = 0;
    for feed in [Vector3::x(), Vector3::y(), Vector3::new(1.0, -2.0, 0.0)] {
        let down = Engagement::of_width(Direction::Down, 0.005, 0.02).unwrap();
        let process = process(&cut(down), &CutFrame::new(&-Vector3::z(), &feed).unwrap());
        same(&table.limits(&process, 0.02), &modes.limits(&process, 0.02));
        let [found, expected] = [&table, &modes].map(|modes| Lobes::new(modes, &process, 0.02).unwrap());
        for rpm in [300.0, 3000.0, 9000.0] {
            let [found, expected] = [&found, &expected].map(|lobes| lobes.limits(60.0 / (4.0 * rpm)));
            same(&found, &expected);
            limited += expected.unstable.len();
        }
    }
    assert!(limited > 4, "{limited}");
}

/// The first mode is damped well, the second is not: what holds the first does not hold both.
#[test]
fn each_mode_has_its_own_damping() {
    let mode = |hertz: f64, damping, stiffness, direction| MeasuredMode {
        frequency: TAU * hertz,
        damping,
        stiffness,
        direction,
    };
    let process = rank_one(1e9, &Vector3::x_axis(), &Vector3::y_axis());
    let [x, y] = [Vector3::new(1.0, 0.4, 0.0), Vector3::new(-0.5, 1.0, 0.0)];
    for dampings in [[0.3, 1e-3], [1e-3, 0.3], [0.02, 0.02]] {
        let table = [mode(15.0, dampings[0], 0.8e6, x), mode(15.4, dampings[1], 0.9e6, y)];
        let modes = Modes::measured(&table).unwrap();
        assert_eq!(modes.damping(), dampings);
        let mut depth = 1e-8;
        while depth < 1.0 && modes.is_stable(&(process * depth)) {
            depth *= 1.001;
        }
        let limit = modes.limits(&process, 1.0).limiting().unwrap();
        assert!((limit / depth - 1.0).abs() < 2e-3, "{dampings:?} {limit} {depth}");
        // A chip that is cut along one mode alone is limited by the damping of that one:
        // 2 zeta (1 + zeta) k / p.
        for measured in table {
            let along = nalgebra::Unit::new_normalize(measured.direction);
            let alone = Modes::measured(&[measured]).unwrap();
            let found = Lobes::new(&alone, &rank_one(1e9, &along, &along), 1.0).unwrap().at_any_speed().unwrap();
            let expected = 2.0 * measured.damping * (1.0 + measured.damping) * measured.stiffness / 1e9;
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        }
    }
}

#[test]
fn what_is_no_mode_is_refused() {
    let good = MeasuredMode { frequency: 90.0, damping: 0.03, stiffness: 1e6, direction: Vector3::x() };
    assert!(Modes::measured(&[good, good]).is_some());
    for wrong in [
        MeasuredMode { frequency: 0.0, ..good },
        MeasuredMode { damping: -0.01, ..good },
        MeasuredMode { damping: 0.0, ..good },
        MeasuredMode { stiffness: f64::INFINITY, ..good },
        MeasuredMode { direction: Vector3::zeros(), ..good },
        MeasuredMode { direction: Vector3::repeat(f64::NAN), ..good },
    ] {
        assert_eq!(Modes::measured(&[good, wrong]), None, "{wrong:?}");
    }
    assert_eq!(Modes::measured(&[]), None);
}

/// The largest Floquet multiplier of the modes in a cut at a depth: by how much a small movement
/// grows from one tooth to the next, with every tooth at its angle. By semi-discretisation
/// (Insperger and Stepan, Updated semi-discretization method for periodic delay-differential
/// equations with discrete delay, International Journal for Numerical Methods in Engineering 61
/// (2004) 117-141): the displacement one tooth ago is the mean of two in each part of the time
/// between two teeth, the rest is exact.
fn multiplier(modes: &Modes, cut: &Cut, frame: &CutFrame, depth: f64, parts: usize, teeth: usize) -> f64 {
    let count = modes.frequencies().len();
    let step = cut.tooth_period().unwrap() / parts as f64;
    let shapes = modes.shapes();
    let steps: Vec<DMatrix<f64>> = tooth_by_tooth(cut, frame, parts)
        .into_iter()
        .map(|process| {
            let force = shapes.transpose() * process * depth;
            let mut all = DMatrix::zeros(2 * count + 3, 2 * count + 3);
            for mode in 0..count {
                let frequency = modes.frequencies()[mode];
                all[(mode, count + mode)] = 1.0;
                all[(count + mode, mode)] = -frequency * frequency;
                all[(count + mode, count + mode)] = -2.0 * modes.damping()[mode] * frequency;
            }
            let mut acceleration = all.view_mut((count, 0), (count, count));
            acceleration += &force * shapes;
            all.view_mut((count, 2 * count), (count, 3)).copy_from(&-force);
            (all * step).exp().rows(0, 2 * count).into_owned()
        })
        .collect();
    let mut state = DVector::from_fn(2 * count + 3, |i, _| if i < count { 1.0 } else { 0.0 });
    let mut past = vec![Vector3::zeros(); parts + 1];
    let mut sizes = Vec::with_capacity(teeth);
    for _ in 0..teeth {
        for (k, step) in steps.iter().enumerate() {
            // `past[k]` is what was there one tooth ago.
            let moved = (past[k] + past[k + 1]) * 0.5;
            state.rows_mut(2 * count, 3).copy_from(&moved);
            let next = step * &state;
            past[k] = Vector3::from_fn(|row, _| (0..count).map(|mode| shapes[(row, mode)] * state[mode]).sum());
            if k == 0 {
                past[parts] = past[0];
            }
            state.rows_mut(0, 2 * count).copy_from(&next);
        }
        let energy = |mode: usize| (state[mode] * modes.frequencies()[mode]).hypot(state[count + mode]);
        sizes.push((0..count).map(energy).fold(0.0, f64::max).ln());
    }
    let most = |part: &[f64]| part.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let half = teeth / 2;
    ((most(&sizes[teeth - 20..]) - most(&sizes[half - 20..half])) / (teeth - half) as f64).exp()
}

/// A cut of two teeth with these coefficients (Pa), at a speed of the spindle (rpm).
fn two_teeth(ktc: f64, krc: f64, diameter: f64, engagement: Engagement, rpm: f64) -> Cut {
    let mill = EndMill { diameter, teeth: 2, helix: 0.0, corner: 0.0, runout: Vec::new() };
    let coefficients = Coefficients { ktc, kte: 0.0, krc, kre: 0.0, kac: 0.0, kae: 0.0 };
    Cut { mill, coefficients, engagement, depth: 1e-3, feed_per_tooth: 1e-4, speed: Some(rpm * TAU / 60.0) }
}

/// Along the feed, across it, and into the tool.
fn along_x() -> CutFrame {
    CutFrame::new(&-Vector3::z(), &Vector3::x()).unwrap()
}

/// Ding, Zhu, Zhang, Ding, A full-discretization method for prediction of milling stability,
/// International Journal of Machine Tools and Manufacture 50 (2010) 502-509: one mode along the
/// feed, 922 Hz, 0.011, 0.03993 kg, in a slot at 5000 rpm. The largest multipliers that they
/// print are .8192, 1.0726, 1.2197 and 1.4040 at .2, .5, .7 and 1 mm: the limit is between the
/// first two.
#[test]
fn a_published_slot_has_its_multipliers_and_its_limit() {
    let frequency = 922.0 * TAU;
    let mode =
        MeasuredMode { frequency, damping: 0.011, stiffness: 0.03993 * frequency * frequency, direction: Vector3::x() };
    let modes = Modes::measured(&[mode]).unwrap();
    let slot = two_teeth(6e8, 2e8, 0.01, Engagement::SLOT, 5000.0);
    for (depth, printed) in [(0.2e-3, 0.8192), (0.5e-3, 1.0726), (0.7e-3, 1.2197), (1e-3, 1.4040)] {
        let found = multiplier(&modes, &slot, &along_x(), depth, 400, 600);
        assert!((found / printed - 1.0).abs() < 3e-3, "{depth} {found} {printed}");
    }
    let lobes = Lobes::new(&modes, &process(&slot, &along_x()), 0.01).unwrap();
    let limit = lobes.limits(slot.tooth_period().unwrap()).limiting().unwrap();
    assert!((0.2e-3..0.5e-3).contains(&limit), "{limit}");
    // Two teeth in a slot cut one after the other: their mean is good to some ten percent.
    let [below, above] = [0.9, 1.2].map(|share| multiplier(&modes, &slot, &along_x(), share * limit, 400, 600));
    assert!(below < 1.0 && above > 1.0, "{limit} {below} {above}");
}

/// Frequency (Hz), damping ratio and stiffness (N/m) of the two modes along the feed and across
/// it of an end mill with two teeth, 31.75 mm wide, in aluminium: J. Li, Manufacturing Automation
/// Laboratory, University of British Columbia (github.com/leekunhwee/Dynamics,
/// Cutting/Stability/FrequencyDomain/Milling/General/ScriptStiffnessFD.m).
const ALONG: [[f64; 3]; 2] =
    [[456.780_432, 0.111_705_399, 7.933_097_18e6], [1_448.889_14, 0.017_037_009_6, 14.691_778_4e6]];
const ACROSS: [[f64; 3]; 2] =
    [[516.518_189, 0.024_579_632_7, 9.374_613_81e6], [1_408.448_14, 0.031_357_601_9, 12.406_389_1e6]];
/// Its cutting coefficients (Pa) there.
const TANGENTIAL: f64 = 1_319.4e6;
const RADIAL: f64 = 788.8e6;

/// The response along one direction by its modes.
fn response(modes: &[[f64; 3]], frequency: f64) -> Complex<f64> {
    let part = |[hertz, damping, stiffness]: &[f64; 3]| {
        let ratio = frequency / (TAU * hertz);
        (Complex::new(1.0 - ratio * ratio, 2.0 * damping * ratio) * stiffness).inv()
    };
    modes.iter().map(part).sum()
}

/// The limiting depth (m) and the phase between two waves, of both roots, by the equations of
/// Altintas and Budak, CIRP Annals 44/1 (1995) 357-362.
fn printed(engagement: Engagement, frequency: f64) -> [(f64, f64); 2] {
    let kr = RADIAL / TANGENTIAL;
    let factors = |phi: f64| {
        let (s, c) = (2.0 * phi).sin_cos();
        [c - 2.0 * kr * phi + kr * s, -s - 2.0 * phi + kr * c, -s + 2.0 * phi + kr * c, -c - 2.0 * kr * phi - kr * s]
    };
    let [exit, entry] = [engagement.exit, engagement.entry].map(factors);
    let [xx, xy, yx, yy] = [0, 1, 2, 3].map(|i| 0.5 * (exit[i] - entry[i]));
    let [gx, gy] = [response(&ALONG, frequency), response(&ACROSS, frequency)];
    let (a0, a1) = (gx * gy * (xx * yy - xy * yx), gx * xx + gy * yy);
    let root = (a1 * a1 - a0 * 4.0).sqrt();
    [root, -root].map(|root| {
        let lambda = -(a1 + root) / (a0 * 2.0);
        let kappa = lambda.im / lambda.re;
        let depth = -TAU * lambda.re / (2.0 * TANGENTIAL) * (1.0 + kappa * kappa);
        (depth, PI - 2.0 * kappa.atan())
    })
}

/// The least limiting depth at a time between two teeth by those equations.
fn printed_limit(engagement: Engagement, period: f64) -> f64 {
    let turns = |frequency: f64, root: usize| (frequency * period - printed(engagement, frequency)[root].1) / TAU;
    let mut least = f64::INFINITY;
    for root in 0..2 {
        for k in 0..60_000 {
            let (mut low, mut high) = (TAU * (20.0 + 0.05 * f64::from(k)), TAU * (20.0 + 0.05 * f64::from(k + 1)));
            let [from, to] = [turns(low, root), turns(high, root)];
            // Not where the arctangent jumps, or the roots change places.
            if from.floor() == to.floor() || (to - from).abs() > 0.2 {
                continue;
            }
            let target = from.max(to).floor();
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if (turns(middle, root) < target) == (from < target) { low = middle } else { high = middle }
            }
            let depth = printed(engagement, low)[root].0;
            if depth > 0.0 {
                least = least.min(depth);
            }
        }
    }
    least
}

/// Half immersion, down milling: the equations as printed, and the model with every tooth at its
/// angle. No limit is printed with these modes, so the second stands for it.
#[test]
fn a_published_end_mill_has_the_limits_of_the_published_equations() {
    let measured = |[hertz, damping, stiffness]: [f64; 3], direction| MeasuredMode {
        frequency: TAU * hertz,
        damping,
        stiffness,
        direction,
    };
    let along = ALONG.map(|mode| measured(mode, Vector3::x()));
    let across = ACROSS.map(|mode| measured(mode, Vector3::y()));
    let modes = Modes::measured(&[along, across].concat()).unwrap();
    let down = Engagement::of_width(Direction::Down, 0.5 * 31.75e-3, 31.75e-3).unwrap();
    let at = |rpm: f64| two_teeth(TANGENTIAL, RADIAL, 31.75e-3, down, rpm);
    let lobes = Lobes::new(&modes, &process(&at(9500.0), &along_x()), 0.03).unwrap();
    let mut limits = Vec::new();
    for rpm in [5000.0, 8000.0, 9500.0, 12_000.0, 14_000.0] {
        let cut = at(rpm);
        let period = cut.tooth_period().unwrap();
        let limit = lobes.limits(period).limiting().unwrap();
        let printed = printed_limit(down, period);
        assert!((limit / printed - 1.0).abs() < 1e-6, "{rpm} rpm: {limit} {printed}");
        let [below, above] = [0.9, 1.12].map(|share| multiplier(&modes, &cut, &along_x(), share * limit, 200, 300));
        assert!(below < 1.0 && above > 1.0, "{rpm} rpm: {limit} {below} {above}");
        limits.push(limit);
    }
    // At 14,000 rpm the teeth pass at the pace of the modes at 450 Hz.
    assert!(limits[4] > 4.0 * limits[2], "{limits:?}");
}
