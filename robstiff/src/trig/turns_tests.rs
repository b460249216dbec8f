//! Angles of many turns, against the platform's functions, which are right to a place.

use std::vec::Vec;

use super::*;

/// Numbers of every size up to the largest, and those that are nearest to whole turns, to half
/// and to quarter turns.
fn many_turns() -> impl Iterator<Item = f64> {
    let nearest = 6_381_956_970_095_103.0;
    let hard = [nearest * 2_f64.powi(799), nearest * 2_f64.powi(798), nearest * 2_f64.powi(797), f64::MAX, 1e22];
    let sizes = (0..=1000).flat_map(|k| {
        let size = 32.0 * 1.99_f64.powi(k);
        [1.0, 1.234_567_890_123, 1.999].map(|digits| size * digits)
    });
    let around = [FEW_TURNS, f64::DOMAIN, f64::from(f32::DOMAIN)];
    let around = around.into_iter().flat_map(|x| [x.next_down(), x, x.next_up(), 1.1 * x]);
    let all = sizes.chain(around).chain(hard).filter(|x| x.is_finite());
    all.flat_map(|x| [x, -x])
}

/// Those that an `f32` holds.
fn many_turns_of_single() -> impl Iterator<Item = f32> {
    let nearest = 16_367_173.0;
    let hard = [nearest * 2_f32.powi(74), nearest * 2_f32.powi(73), nearest * 2_f32.powi(72), f32::MAX];
    hard.into_iter().chain(many_turns().map(|x| x as f32).filter(|x| x.is_finite()))
}

#[test]
fn sines_are_as_near_as_stated_however_large_the_angle() {
    for x in many_turns() {
        let ((s, c), (sin, cos)) = (sin_cos(x), x.sin_cos());
        assert!((s - sin).abs() <= 1.4e-15 && (c - cos).abs() <= 1.4e-15, "{x:e}: {s}, {c} and not {sin}, {cos}");
        assert_eq!(sin_cos(-x), (-s, c), "{x:e}");
    }
    for x in many_turns_of_single() {
        let ((s, c), (sin, cos)) = (sin_cos(x), f64::from(x).sin_cos());
        let off = (f64::from(s) - sin).abs().max((f64::from(c) - cos).abs());
        assert!(off <= 8e-7, "{x:e}: {s}, {c} and not {sin}, {cos}");
        assert_eq!(sin_cos(-x), (-s, c), "{x:e}");
    }
}

/// The rest of whole turns has all its places, even where it is next to nothing.
#[test]
fn whole_turns_are_taken_away_exactly() {
    for x in many_turns() {
        let rest = wrapped(x);
        assert!(x.is_few_turns() || rest.abs() <= core::f64::consts::PI + 1e-9, "{x:e}: {rest}");
        assert_eq!(wrapped(-x), -rest);
        let (sin, cos) = x.sin_cos();
        assert!((rest.sin() - sin).abs() <= 7e-16 && (rest.cos() - cos).abs() <= 7e-16, "{x:e}: {rest}");
        if x.abs() > f64::DOMAIN && cos > 0.0 {
            assert!((rest.sin() / sin - 1.0).abs() <= 5e-16, "{x:e}: {rest:e}");
        }
    }
    for x in many_turns_of_single() {
        let rest = wrapped(x);
        let (sin, cos) = f64::from(x).sin_cos();
        let (s, c) = f64::from(rest).sin_cos();
        assert!((s - sin).abs() <= 5e-7 && (c - cos).abs() <= 5e-7, "{x:e}: {rest}");
        if x.abs() > f32::DOMAIN && cos > 0.0 {
            assert!((s / sin - 1.0).abs() <= 2e-7, "{x:e}: {rest:e}");
        }
    }
    for few in [0.0_f64, -0.0, 1e-310, 3.5, -32.0, 32.0] {
        assert_eq!(wrapped(few).to_bits(), few.to_bits());
    }
}

/// A sum with a large coordinate would be rounded to the places of that.
#[test]
fn sums_lose_no_places() {
    let sums = |[a, b, c]: [f64; 3]| [a, a + b, a - b + 0.25, b + b + c, c];
    let scale = [(2.0, 4.0); 5];
    let all: Vec<f64> = many_turns().filter(|x| x.abs() > FEW_TURNS).collect();
    for (k, &a) in all.iter().enumerate() {
        for [a, b, c] in [[a, 0.3, -0.2], [0.3, a, 1.0], [a, all[all.len() - 1 - k], a]] {
            let found = sin_cos_of_sums([a, b, c], sums, None);
            let scaled = sin_cos_of_sums([a, b, c], sums, Some(scale));
            // By the addition theorem, of sines of each.
            let turn = |(s, c): (f64, f64), (t, d): (f64, f64)| (s * d + c * t, c * d - s * t);
            let back = |(s, c): (f64, f64)| (-s, c);
            let [of_a, of_b, of_c] = [a, b, c].map(f64::sin_cos);
            let last = turn(turn(of_a, back(of_b)), 0.25_f64.sin_cos());
            let expected = [of_a, turn(of_a, of_b), last, turn(turn(of_b, of_b), of_c), of_c];
            for (((s, c), (sin, cos)), (t, d)) in found.into_iter().zip(expected).zip(scaled) {
                assert!((s - sin).abs() < 5e-15 && (c - cos).abs() < 5e-15, "{a:e}, {b:e}, {c:e}");
                assert!((t - 2.0 * sin).abs() < 2e-14 && (d - 4.0 * cos).abs() < 4e-14, "{a:e}, {b:e}, {c:e}");
            }
        }
    }
}

#[test]
fn no_angle_has_no_sine() {
    fn check<F: Float + core::fmt::Debug + Into<f64>>(none: [F; 3], [small, three, five]: [F; 3]) {
        let is_nan = |x: F| x != x;
        for none in none {
            assert!(is_nan(wrapped(none)));
            let (s, c) = sin_cos(none);
            assert!(is_nan(s) && is_nan(c), "{none:?}");
            for factors in [None, Some([(F::ONE, F::ONE), (three, five)])] {
                let [(s, c), (t, u)] = sin_cos_of_sums([none, small], |angles| angles, factors);
                assert!(is_nan(s) && is_nan(c), "{none:?}");
                // It spoils no others.
                let (by_sin, by_cos) = factors.map_or((F::ONE, F::ONE), |[_, factors]| factors);
                let (sin, cos) = sin_cos(small);
                let off = [t - sin * by_sin, u - cos * by_cos];
                assert!(off.into_iter().all(|off| off.into().abs() < 1e-6), "{t:?}, {u:?}");
            }
        }
    }
    check([f64::NAN, f64::INFINITY, f64::NEG_INFINITY], [0.0, 3.0, 5.0]);
    check([f32::NAN, f32::INFINITY, f32::NEG_INFINITY], [0.0, 3.0, 5.0]);
    check([f64::NAN.copysign(-1.0), 2.0 * f64::MAX, f64::NAN], [0.0, 3.0, 5.0]);
}
