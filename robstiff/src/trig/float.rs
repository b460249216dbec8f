//! What differs between `f32` and `f64`: constants, parts of pi/2, polynomials.

use core::ops::Neg;

use super::abreast::{Abreast, Vector, mul_add, target};

/// Whether the target multiplies and adds in one instruction. Without it
/// `mul_add` would be a call of a slow function. It is not in `core`, so there
/// it is not used.
pub(crate) const FUSED: bool =
    cfg!(all(feature = "std", any(target_feature = "fma", all(target_arch = "aarch64", target_feature = "neon"))));

/// A floating point number that [`sin_cos`](super::sin_cos) knows.
pub(crate) trait Float: Abreast<Self> + Neg<Output = Self> {
    /// A vector of the target.
    type Vector: Vector<Self>;
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// 1/2.
    const HALF: Self;
    /// 2 / pi.
    const TWO_OVER_PI: Self;
    /// 1.5 times the first number whose neighbours are 1 apart.
    const SHIFT: Self;
    /// The largest angle (rad) that is not left to the platform.
    const DOMAIN: Self;
    /// How far sines and cosines within the domain are off at most.
    #[cfg_attr(not(all(test, feature = "std")), expect(dead_code, reason = "what the tests hold the functions to"))]
    const BOUND: f64;

    /// `x - k pi/2`.
    fn reduce<V: Abreast<Self>, const FUSED: bool>(x: V, k: V) -> V;

    /// `S` in `sin r = r + r z S(z)`, from `z` and its square.
    fn sin_tail<V: Abreast<Self>, const FUSED: bool>(z: V, z2: V) -> V;

    /// `C` in `cos r = 1 - z/2 + z^2 C(z)`, from `z` and its square.
    fn cos_tail<V: Abreast<Self>, const FUSED: bool>(z: V, z2: V) -> V;

    /// The platform's or libm's function.
    fn platform_sin_cos(self) -> (Self, Self);
}

macro_rules! float {
    (
        $float:ident, $vector:path, $platform:path,
        shift: $shift:expr, domain: $domain:expr, bound: $bound:expr,
        pi_over_2: [$($part:expr),*],
        sin: [$($sin:expr),*],
        cos: [$($cos:expr),*],
    ) => {
        impl Float for $float {
            type Vector = $vector;
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const TWO_OVER_PI: Self = core::$float::consts::FRAC_2_PI;
            const SHIFT: Self = $shift;
            const DOMAIN: Self = $domain;
            const BOUND: f64 = $bound;

            #[inline(always)]
            fn reduce<V: Abreast<Self>, const FUSED: bool>(x: V, k: V) -> V {
                $(let x = mul_add::<Self, V, FUSED>(k, V::splat(-$part), x);)*
                x
            }

            #[inline(always)]
            fn sin_tail<V: Abreast<Self>, const FUSED: bool>(z: V, z2: V) -> V {
                polynomial::<Self, V, FUSED, _>([$($sin),*], z, z2)
            }

            #[inline(always)]
            fn cos_tail<V: Abreast<Self>, const FUSED: bool>(z: V, z2: V) -> V {
                polynomial::<Self, V, FUSED, _>([$($cos),*], z, z2)
            }

            #[cold]
            fn platform_sin_cos(self) -> (Self, Self) {
                #[cfg(feature = "std")]
                return $float::sin_cos(self);
                #[cfg(not(feature = "std"))]
                return $platform(self);
            }
        }
    };
}

/// A polynomial, the lowest coefficient first: pairs of terms, which do not
/// wait for each other, and then one step in `z^2` for each pair.
#[inline(always)]
fn polynomial<F: Float, V: Abreast<F>, const FUSED: bool, const N: usize>(coefficients: [F; N], z: V, z2: V) -> V {
    let pair = |i: usize| {
        let low = V::splat(coefficients[i]);
        if i + 1 < N { mul_add::<F, V, FUSED>(z, V::splat(coefficients[i + 1]), low) } else { low }
    };
    let mut i = (N - 1) / 2 * 2;
    let mut value = pair(i);
    while i > 0 {
        i -= 2;
        value = mul_add::<F, V, FUSED>(value, z2, pair(i));
    }
    value
}

// All numbers from benches/polynomials/minimax.py.
//
// f64: 33 bits of pi/2, whose products with 20 bits of k are exact, and the
// rest. Error of the polynomials 2^-58 of the sine, 2^-64 of the cosine.
float! {
    f64, target::F64, libm::sincos,
    shift: 6_755_399_441_055_744.0, domain: 1e6, bound: 1.8e-16,
    pi_over_2: [1.570_796_326_734_125_6, 6.077_100_506_506_192e-11],
    sin: [
        -0.166_666_666_666_666_32, 0.008_333_333_333_322_472, -0.000_198_412_698_298_356_47,
        2.755_731_369_731_385_3e-6, -2.505_075_848_318_806_8e-8, 1.589_679_587_384_691_3e-10
    ],
    cos: [
        0.041_666_666_666_666_6, -0.001_388_888_888_887_445_7, 2.480_158_728_965_296_3e-5,
        -2.755_731_439_393_726e-7, 2.087_572_812_571_144e-9, -1.135_986_600_306_813_5e-11
    ],
}

// f32: twice 11 bits of pi/2, exact with 11 bits of k, and the rest. Error of
// the polynomials 2^-28 of the sine, 2^-33 of the cosine.
float! {
    f32, target::F32, libm::sincosf,
    shift: 12_582_912.0, domain: 3000.0, bound: 9.4e-8,
    pi_over_2: [1.570_312_5, 4.837_513e-4, 7.549_79e-8],
    sin: [-0.166_666_55, 0.008_332_191, -0.000_195_185_99],
    cos: [0.041_666_646, -0.001_388_731_4, 2.443_315_8e-5],
}
