//! What differs between `f32` and `f64`: constants, parts of pi/2, polynomials.

use core::ops::{Add, Mul, Neg, Sub};

/// Whether the target multiplies and adds in one instruction. Without it
/// `mul_add` would be a call of a slow function. It is not in `core`, so there
/// it is not used.
pub(crate) const FUSED: bool =
    cfg!(all(feature = "std", any(target_feature = "fma", all(target_arch = "aarch64", target_feature = "neon"))));

/// The size of a vector that the compiler will use; AVX-512 gets two of them.
const VECTOR_BYTES: usize = if cfg!(target_feature = "avx") { 32 } else { 16 };

/// A floating point number that [`sin_cos`](super::sin_cos) knows.
pub(crate) trait Float:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// How many go into a vector of the target.
    const WIDTH: usize = VECTOR_BYTES / size_of::<Self>();
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

    /// `self * a + b`, rounded once.
    fn fused(self, a: Self, b: Self) -> Self;

    /// `x - k pi/2`.
    fn reduce<const FUSED: bool>(x: Self, k: Self) -> Self;

    /// `S` in `sin r = r + r z S(z)`.
    fn sin_tail<const FUSED: bool>(z: Self) -> Self;

    /// `C` in `cos r = 1 - z/2 + z^2 C(z)`.
    fn cos_tail<const FUSED: bool>(z: Self) -> Self;

    /// Sine and cosine of as many quarter turns more as the last bits of
    /// `shifted` say: the last bit exchanges the two, the one before is the
    /// sine's sign, and the cosine's is that of a quarter turn more.
    fn turn_quarters(shifted: Self, sin: Self, cos: Self) -> (Self, Self);

    /// False for a NaN.
    fn is_within_domain(self) -> bool;

    /// The platform's or libm's function.
    fn platform_sin_cos(self) -> (Self, Self);
}

/// `a * b + c`, rounded once if `FUSED`.
#[inline(always)]
pub(crate) fn mul_add<F: Float, const FUSED: bool>(a: F, b: F, c: F) -> F {
    if FUSED { a.fused(b, c) } else { a * b + c }
}

macro_rules! float {
    (
        $float:ident, $bits:ident, $signed:ident, $fma:path, $platform:path,
        shift: $shift:expr, domain: $domain:expr, bound: $bound:expr,
        pi_over_2: [$($part:expr),*],
        sin: [$($sin:expr),*],
        cos: [$($cos:expr),*],
    ) => {
        impl Float for $float {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const TWO_OVER_PI: Self = core::$float::consts::FRAC_2_PI;
            const SHIFT: Self = $shift;
            const DOMAIN: Self = $domain;
            const BOUND: f64 = $bound;

            #[inline(always)]
            fn fused(self, a: Self, b: Self) -> Self {
                #[cfg(feature = "std")]
                return self.mul_add(a, b);
                #[cfg(not(feature = "std"))]
                return $fma(self, a, b);
            }

            #[inline(always)]
            fn reduce<const FUSED: bool>(x: Self, k: Self) -> Self {
                $(let x = mul_add::<Self, FUSED>(-k, $part, x);)*
                x
            }

            #[inline(always)]
            fn sin_tail<const FUSED: bool>(z: Self) -> Self {
                horner::<Self, FUSED, _>([$($sin),*], z)
            }

            #[inline(always)]
            fn cos_tail<const FUSED: bool>(z: Self) -> Self {
                horner::<Self, FUSED, _>([$($cos),*], z)
            }

            #[inline(always)]
            fn turn_quarters(shifted: Self, sin: Self, cos: Self) -> (Self, Self) {
                const TOP: $bits = 1 << ($bits::BITS - 1);
                let (last, before) = (shifted.to_bits() << ($bits::BITS - 1), shifted.to_bits() << ($bits::BITS - 2));
                let (sin, cos) = (sin.to_bits(), cos.to_bits());
                // Masks and not a choice: without SSE4.1 there is no other way.
                let exchange = (sin ^ cos) & ((last as $signed) >> ($bits::BITS - 1)) as $bits;
                let (sin_sign, cos_sign) = (before & TOP, (last ^ before) & TOP);
                (Self::from_bits(sin ^ exchange ^ sin_sign), Self::from_bits(cos ^ exchange ^ cos_sign))
            }

            #[inline(always)]
            fn is_within_domain(self) -> bool {
                self.abs() <= Self::DOMAIN
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

/// A polynomial, the lowest coefficient first.
#[inline(always)]
fn horner<F: Float, const FUSED: bool, const N: usize>(coefficients: [F; N], z: F) -> F {
    let mut value = coefficients[N - 1];
    for i in (0..N - 1).rev() {
        value = mul_add::<F, FUSED>(value, z, coefficients[i]);
    }
    value
}

// All numbers from benches/polynomials/minimax.py.
//
// f64: 33 bits of pi/2, whose products with 20 bits of k are exact, and the
// rest. Error of the polynomials 2^-58 of the sine, 2^-64 of the cosine.
float! {
    f64, u64, i64, libm::fma, libm::sincos,
    shift: 6_755_399_441_055_744.0, domain: 1e6, bound: 1.6e-16,
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
    f32, u32, i32, libm::fmaf, libm::sincosf,
    shift: 12_582_912.0, domain: 3000.0, bound: 9e-8,
    pi_over_2: [1.570_312_5, 4.837_513e-4, 7.549_79e-8],
    sin: [-0.166_666_55, 0.008_332_191, -0.000_195_185_99],
    cos: [0.041_666_646, -0.001_388_731_4, 2.443_315_8e-5],
}
