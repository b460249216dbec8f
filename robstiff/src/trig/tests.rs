//! Against a reference in twice the precision, over the whole domain.

use std::f64::consts::FRAC_PI_2;

use super::*;

/// A number as the sum of two `f64`, the second below the last place of the
/// first: 106 bits.
#[derive(Clone, Copy)]
struct Pair(f64, f64);

impl Pair {
    /// Exact sum (Knuth).
    fn sum(a: f64, b: f64) -> Self {
        let s = a + b;
        let t = s - a;
        Self(s, (a - (s - t)) + (b - t))
    }

    /// Exact product.
    fn product(a: f64, b: f64) -> Self {
        let p = a * b;
        Self(p, f64::mul_add(a, b, -p))
    }

    fn plus(self, other: Self) -> Self {
        let Self(s, t) = Self::sum(self.0, other.0);
        Self::sum(s, t + (self.1 + other.1))
    }

    fn times(self, other: Self) -> Self {
        let Self(p, e) = Self::product(self.0, other.0);
        Self::sum(p, e + (self.0 * other.1 + self.1 * other.0))
    }

    fn over(self, divisor: f64) -> Self {
        let q = self.0 / divisor;
        let rest = self.plus(Self::product(-q, divisor));
        Self::sum(q, rest.0 / divisor)
    }

    fn negative(self) -> Self {
        Self(-self.0, -self.1)
    }
}

/// Sine and cosine by Taylor's series, after reduction with 160 bits of pi/2.
fn reference(x: f64) -> [Pair; 2] {
    let k = (x / FRAC_PI_2).round();
    let mut r = Pair(x, 0.0);
    for part in [FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33] {
        r = r.plus(Pair::product(-k, part));
    }
    let series = |first: Pair, from: f64| {
        let (mut term, mut sum, mut n) = (first, first, from);
        while n < 30.0 {
            term = term.times(r).times(r).negative().over((n + 1.0) * (n + 2.0));
            sum = sum.plus(term);
            n += 2.0;
        }
        sum
    };
    let (s, c) = (series(r, 1.0), series(Pair(1.0, 0.0), 0.0));
    match k.rem_euclid(4.0) {
        0.0 => [s, c],
        1.0 => [c, s.negative()],
        2.0 => [s.negative(), c.negative()],
        _ => [c.negative(), s],
    }
}

/// Angles dense near zero, at random all over the domain, and at and next to
/// multiples of pi/4, as far as the domain goes.
fn angles(domain: f64) -> impl Iterator<Item = f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let dense = (-20_000..=20_000).map(|i| f64::from(i) * 1e-3 * core::f64::consts::FRAC_1_SQRT_2);
    let anywhere: std::vec::Vec<f64> = (0..100_000)
        .map(|i| {
            let range = [domain, 1000.0, 10.0, 1e-3][i % 4];
            (2.0 * random() - 1.0) * range
        })
        .collect();
    let last = domain / (FRAC_PI_2 / 2.0);
    let marks = (0..20_000).map(move |i| {
        let k = if i < 3000 { f64::from(i) } else { (last * f64::from(i) / 20_000.0).floor() };
        k * FRAC_PI_2 / 2.0
    });
    let near = marks.flat_map(|x| [x, x.next_up(), x.next_down(), x + 1e-9, x - 1e-6, -x]);
    let edge = [domain, -domain, domain.next_down(), f64::MIN_POSITIVE, 1e-310, 1e-17, 1e-8];
    dense.chain(anywhere).chain(near).chain(edge).filter(move |x| x.abs() <= domain)
}

/// The largest near angle.
const NEAR: f64 = 3.236;

/// The angles of a pose's way: all that are near, and some from all over the domain.
fn angles_of_poses(domain: f64) -> impl Iterator<Item = f64> {
    let dense = (-400_000..=400_000).map(|i| NEAR * f64::from(i) / 400_000.0);
    let beyond = [NEAR.next_up(), -NEAR.next_up()];
    dense.chain(beyond).chain(angles(domain))
}

/// What a pose makes of one of its angles.
fn of_poses<F: Float, const FUSED: bool>(x: F) -> (F, F) {
    let is_near = !near::room::<F, F>(x).is_negative_somewhere();
    near::sin_cos::<F, F, FUSED>(if is_near { x } else { near::wrapped::<F, F, FUSED>(x) })
}

/// The largest error of angles' sines and cosines, absolute and in units in the last
/// place of results beyond a quarter.
fn worst_of(all: impl Iterator<Item = (f64, (f64, f64))>) -> [f64; 2] {
    let (mut absolute, mut places) = (0.0_f64, 0.0_f64);
    for (x, (s, c)) in all {
        for (ours, Pair(high, low)) in [s, c].into_iter().zip(reference(x)) {
            let error = ((ours - high) - low).abs();
            absolute = absolute.max(error);
            if high.abs() > 0.25 {
                places = places.max(error / (high.abs().next_up() - high.abs()));
            }
        }
    }
    [absolute, places]
}

#[test]
fn double_precision_is_as_near_as_stated() {
    let within = |sin_cos: fn(f64) -> (f64, f64)| worst_of(angles(f64::DOMAIN).map(|x| (x, sin_cos(x))));
    let of_poses_within =
        |sin_cos: fn(f64) -> (f64, f64)| worst_of(angles_of_poses(f64::DOMAIN).map(|x| (x, sin_cos(x))));
    for (name, [absolute, places], bound, most) in [
        ("plain", within(within_domain::<f64, false>), f64::BOUND, 1.6),
        ("fused", within(within_domain::<f64, true>), f64::BOUND, 1.6),
        ("of poses, plain", of_poses_within(of_poses::<f64, false>), f64::BOUND_OF_POSES, f64::INFINITY),
        ("of poses, fused", of_poses_within(of_poses::<f64, true>), f64::BOUND_OF_POSES, f64::INFINITY),
    ] {
        std::println!("{name}: {absolute:e}, {places:.3} ulp");
        assert!(absolute <= bound, "{name}: off by {absolute:e}");
        assert!(places <= most, "{name}: {places} units in the last place");
    }
}

/// Eight angles, their sines and cosines, and whether these mean something.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
type Eight = ([f64; 8], [f64; 8], bool);

/// Holds sines from a table to what is stated, of eight angles at once. The largest error in units in the last place
/// of `f64`; `None` where the machine has not the instructions.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
fn check_table(name: &str, domain: f64, bound: f64, sin_cos: impl Fn(&[f64; 8]) -> Option<Eight>) -> Option<f64> {
    if sin_cos(&[0.0; 8]).is_none() {
        std::println!("skipped: this machine has no instructions for sines from a table {name}");
        return None;
    }
    let available = |eight: &[f64; 8]| sin_cos(eight).expect("it is available");
    // Only numbers that an `f32` holds too, where it is about these.
    let round = |x: f64| if domain > f64::from(f32::DOMAIN) { x } else { f64::from(x as f32) };
    let angles: std::vec::Vec<f64> = angles(domain).map(round).filter(|x| x.abs() <= domain).collect();
    let mut all = std::vec::Vec::new();
    for eight in angles.as_chunks::<8>().0 {
        let (sines, cosines, is_usual) = available(eight);
        assert!(is_usual, "{name}: {eight:?}");
        let (of_negative_sines, of_negative_cosines, _) = available(&eight.map(|x| -x));
        assert_eq!((of_negative_sines.map(|s| -s), of_negative_cosines), (sines, cosines), "{name}: {eight:?}");
        all.extend((0..8).map(|lane| (eight[lane], (sines[lane], cosines[lane]))));
    }
    let [absolute, places] = worst_of(all.into_iter());
    std::println!("{name}: {absolute:e}");
    assert!(absolute <= bound, "{name}: off by {absolute:e}");
    for strange in [1.1 * domain, -3e8, 1e22, f64::MAX, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for lane in 0..8 {
            let mut eight = [0.3; 8];
            eight[lane] = strange;
            assert!(!available(&eight).2, "{name}: {strange}, lane {lane}");
        }
    }
    let (sines, cosines, _) = available(&[0.0; 8]);
    assert_eq!((sines, cosines), ([0.0; 8], [1.0; 8]), "{name}");
    Some(places)
}

/// By the two passes over a table of the circle, in the numbers of one of its modules, where the machine has AVX2.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
macro_rules! circle {
    ($float:ident, $module:ident) => {
        |angles: &[f64; 8]| {
            use std::is_x86_feature_detected as has;
            let angles = angles.map(|x| x as $float);
            let (mut sines, mut cosines) = ([0.0; 8], [0.0; 8]);
            // SAFETY: the machine has AVX2 and FMA.
            let is_usual = (has!("avx2") && has!("fma")).then(|| unsafe {
                let is_usual = circle::$module::shift_each(&angles, &mut cosines);
                circle::$module::sin_cos_each(&angles, &mut sines, &mut cosines);
                is_usual
            })?;
            Some((sines.map(f64::from), cosines.map(f64::from), is_usual))
        }
    };
}

#[test]
#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[expect(unsafe_code, reason = "only the machine knows which instructions it has")]
fn tables_are_as_near_as_stated() {
    check_table("of the circle, f32", f32::DOMAIN.into(), f32::BOUND, circle!(f32, single));
    // Numbers from the table may be larger than the result, and so is what they are rounded by.
    let places = check_table("of the circle, f64", f64::DOMAIN, f64::BOUND, circle!(f64, double));
    assert!(places.is_none_or(|places| places <= 2.0), "{places:?} units in the last place");
    let places = check_table("in registers, f64", f64::DOMAIN, f64::BOUND, tables::sin_cos_if_available);
    assert!(places.is_none_or(|places| places <= 2.0), "{places:?} units in the last place");
}

#[test]
fn single_precision_is_as_near_as_stated() {
    let worst = |angles: &mut dyn Iterator<Item = f64>, sin_cos: fn(f32) -> (f32, f32)| {
        let angles = angles.map(|x| x as f32).filter(|x| x.is_in_domain());
        worst_of(angles.map(|x| {
            let (sin, cos) = sin_cos(x);
            (f64::from(x), (f64::from(sin), f64::from(cos)))
        }))[0]
    };
    let within = |sin_cos| worst(&mut angles(f32::DOMAIN.into()), sin_cos);
    let of_poses_within = |sin_cos| worst(&mut angles_of_poses(f32::DOMAIN.into()), sin_cos);
    for (name, absolute, bound) in [
        ("plain", within(within_domain::<f32, false>), f32::BOUND),
        ("fused", within(within_domain::<f32, true>), f32::BOUND),
        ("of poses, plain", of_poses_within(of_poses::<f32, false>), f32::BOUND_OF_POSES),
        ("of poses, fused", of_poses_within(of_poses::<f32, true>), f32::BOUND_OF_POSES),
    ] {
        std::println!("f32 {name}: {absolute:e}");
        assert!(absolute <= bound, "f32 {name}: off by {absolute:e}");
    }
}

#[test]
fn reference_is_the_platforms_to_a_place() {
    for x in angles(f64::DOMAIN).step_by(7) {
        let [s, c] = reference(x);
        assert!((s.0 - x.sin()).abs() < 2e-16 && (c.0 - x.cos()).abs() < 2e-16, "{x:e}");
    }
}

#[test]
fn zero_and_symmetry_are_exact() {
    assert_eq!(sin_cos(0.0_f64), (0.0, 1.0));
    assert_eq!(sin_cos(0.0_f32), (0.0, 1.0));
    for x in angles(f64::DOMAIN).step_by(3) {
        let (s, c) = sin_cos(x);
        assert_eq!(sin_cos(-x), (-s, c), "{x:e}");
        let (s, c) = sin_cos(x as f32);
        assert_eq!(sin_cos(-x as f32), (-s, c), "{x:e}");
    }
}

#[test]
fn side_by_side_is_one_by_one() {
    fn check<F: Float + core::fmt::Debug, const K: usize>(angle: impl Fn(usize) -> F) {
        // The sine of what is known when compiled is the compiler's, not the platform's.
        let angles: [F; K] = core::hint::black_box(core::array::from_fn(angle));
        let all = sin_cos_of_sums(angles, |angles| angles, None);
        // The compiler may vectorise, but not round in another way.
        assert_eq!(all, angles.map(sin_cos), "{angles:?}");
        // A power of two rounds nothing, wherever it is multiplied by.
        let by = |i: usize| [F::ONE, F::ONE + F::ONE, -(F::ONE + F::ONE)][i % 3];
        let factors = core::array::from_fn(|i| (by(i), by(i / 3)));
        let scaled = sin_cos_of_sums(angles, |angles| angles, Some(factors));
        let each = core::array::from_fn(|i| (all[i].0 * factors[i].0, all[i].1 * factors[i].1));
        assert_eq!(scaled, each, "{angles:?}");
    }
    macro_rules! counts {
        ($($k:literal)*) => {$(
            // All near, some, and as far as the domain goes, either way.
            check::<f64, $k>(|i| 0.2 * i as f64 - 3.0);
            check::<f32, $k>(|i| 0.2 * i as f32 - 3.0);
            check::<f64, $k>(|i| 1.7 * i as f64 - 5.0);
            check::<f32, $k>(|i| 1.7 * i as f32 - 5.0);
            check::<f64, $k>(|i| [f64::DOMAIN, -f64::DOMAIN, 1e-310][i % 3]);
            check::<f32, $k>(|i| [f32::DOMAIN, -f32::DOMAIN, 1e-40][i % 3]);
            // Which of them is not near does not matter, nor whether one is.
            for far in 0..17 {
                check::<f64, $k>(|i| if i == far { -3.24 } else { [3.236, 1e-310, -0.0][i % 3] });
                check::<f32, $k>(|i| if i == far { 3.24 } else { [-3.236, 1e-40, -0.0][i % 3] });
            }
        )*};
    }
    counts!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 30);
}
