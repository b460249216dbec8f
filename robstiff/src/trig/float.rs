//! What differs between `f32` and `f64`: constants, parts of pi/2, polynomials.

use core::ops::Neg;

use super::abreast::{Abreast, Pairs, target};
use super::payne_hanek;

/// Whether the target multiplies and adds in one instruction. Without it
/// `mul_add` would be a call of a slow function. It is not in `core`, so there
/// it is not used.
pub(crate) const FUSED: bool =
    cfg!(all(feature = "std", any(target_feature = "fma", all(target_arch = "aarch64", target_feature = "neon"))));

/// The largest angle (rad) of a pose that is computed with as it is: five turns.
pub(crate) const FEW_TURNS: f64 = 32.0;

/// A floating point number that [`sin_cos`](super::sin_cos) knows.
pub(crate) trait Float: Abreast<Self> + Neg<Output = Self> + PartialEq + 'static {
    /// A vector of the target, also for what is left when vectors are full.
    type Vector: Pairs<Self>;
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// What is computed with, in the order of [`places`].
    const NUMBERS: &'static [Self];
    /// In how many parts pi/2 is.
    const PARTS: usize;
    /// How many coefficients each of the two polynomials has.
    const TERMS: usize;
    /// How many each of the two of [whole angles](super::near) has.
    const NEAR_TERMS: usize;
    /// How far sines and cosines of poses' angles within the domain are off at most.
    #[cfg_attr(not(test), expect(dead_code, reason = "what the tests hold the functions to"))]
    const BOUND_OF_POSES: f64;
    /// The largest angle (rad) that multiples of pi/2 or 2 pi are taken away from in parts.
    const DOMAIN: Self;
    /// How far those of batches are off at most.
    #[cfg_attr(not(test), expect(dead_code, reason = "what the tests hold the functions to"))]
    const BOUND: f64;

    /// Whether it is an angle within the domain; false for a NaN.
    fn is_in_domain(self) -> bool;

    /// Whether it is an angle of few turns; false for a NaN.
    fn is_few_turns(self) -> bool;

    /// An angle beyond the domain, less whole turns: at most half a turn. Of an infinity or
    /// a NaN a NaN.
    fn without_turns(self) -> Self;

    /// In the first bit the last one of `shifted`: whether the quarter turns are odd.
    fn odd(shifted: Self) -> Self;

    /// The signs that a sine and a cosine get from as many quarter turns more as the
    /// last bits of `shifted` say, before they are exchanged: the bit before the last
    /// changes both, the last one, which is `odd`, that of the sine once more.
    fn signs(shifted: Self, odd: Self) -> (Self, Self);

    /// With the other sign where `signs` has one.
    fn change_signs(self, signs: Self) -> Self;

    /// The two exchanged where the quarter turns are odd.
    fn exchange(odd: Self, sin: Self, cos: Self) -> (Self, Self);

    /// Of an angle as [`quarters`](super::reduced::quarters) shifts it: bits that are 0
    /// where it is within the domain, and some not where it is not or is a NaN.
    fn strange(shifted: Self) -> Self;

    /// Whether all bits that [`strange`](Self::strange) left are 0.
    fn is_usual(self) -> bool;

    /// The platform's or libm's function: with the feature `platform-trig`.
    fn platform_sin_cos(self) -> (Self, Self);
}

/// Where a number stands in [`Float::NUMBERS`].
pub(crate) mod places {
    use super::Float;

    /// 2 / pi.
    pub const TWO_OVER_PI: usize = 0;
    /// A number so large that only whole ones fit: 1.5 times the first number
    /// whose neighbours are 1 apart, and as many quarter turns as are the domain.
    pub const SHIFT: usize = 1;
    /// 1.
    pub const ONE: usize = 2;
    /// -1/2.
    pub const MINUS_HALF: usize = 3;
    /// Half the square of the largest near angle, 3.236 rad: what `u` is measured from, and
    /// the largest `u`.
    pub const MIDDLE: usize = 4;
    /// The same with the other sign.
    pub const MINUS_MIDDLE: usize = 5;
    /// The square of the largest angle of few turns.
    pub const FEW_TURNS_SQUARED: usize = 6;
    /// 1 / (2 pi).
    pub const TURNS_PER_RADIAN: usize = 7;
    /// The parts of -pi/2.
    pub const PARTS: usize = 8;

    /// The parts of -2 pi.
    pub const fn turn<F: Float>() -> usize {
        PARTS + F::PARTS
    }

    /// The coefficients of `S` in `sin r = r + r z S(z)`.
    pub const fn sin<F: Float>() -> usize {
        turn::<F>() + F::PARTS
    }

    /// The coefficients of `C` in `cos r = 1 - z/2 + z^2 C(z)`.
    pub const fn cos<F: Float>() -> usize {
        sin::<F>() + F::TERMS
    }

    /// The coefficients of `S` in `sin x = x S(u)`.
    pub const fn near_sin<F: Float>() -> usize {
        cos::<F>() + F::TERMS
    }

    /// The coefficients of `C` in `cos x = C(u)`.
    pub const fn near_cos<F: Float>() -> usize {
        near_sin::<F>() + F::NEAR_TERMS
    }
}

/// Numbers once for each lane of a vector, in memory. The compiler, where it
/// sees that the lanes are equal, loads one and spreads it, with an instruction
/// of its own; a static of another crate it takes straight from memory, as an
/// operand. Gain: `benches/README.md`.
#[repr(align(64))]
pub(crate) struct Spread<F, const LANES: usize, const N: usize>(pub [[F; LANES]; N]);

macro_rules! float {
    (
        $float:ident, $bits:ident, $signed:ident, $module:ident, $lanes:literal, $platform:path,
        shift: $shift:expr, quarters: $quarters:literal, domain: $domain:expr, bound: $bound:expr,
        pi_over_2: [$($part:expr),*],
        sin: [$($sin:expr),*],
        cos: [$($cos:expr),*],
        middle: $middle:expr, bound_of_poses: $bound_of_poses:expr,
        near_sin: [$($near_sin:expr),*],
        near_cos: [$($near_cos:expr),*],
    ) => {
        pub(crate) mod $module {
            use super::Spread;

            pub(crate) const FEW_TURNS: $float = super::FEW_TURNS as $float;
            pub(crate) const NUMBERS: &[$float] = &[
                core::$float::consts::FRAC_2_PI, $shift, 1.0, -0.5, $middle, -$middle,
                FEW_TURNS * FEW_TURNS, core::$float::consts::FRAC_2_PI / 4.0,
                $(-$part,)* $(-4.0 * $part,)* $($sin,)* $($cos,)* $($near_sin,)* $($near_cos,)*
            ];

            /// Which bits the shift has while there are at most so many quarter turns,
            /// back or forth, and those of them that stay, less one: no sum with the
            /// shift differs in the first bit of the exponent alone, and where the bits
            /// have a gap the compiler tests them with one instruction, instead of
            /// comparing numbers. Gain: `benches/README.md`.
            pub(crate) const QUARTERS: ($bits, $bits) =
                (($shift as $float).to_bits() - $quarters, !(2 * $quarters - 1) & !(1 << ($bits::BITS - 2)));

            pub(crate) static SPREAD: Spread<$float, $lanes, { NUMBERS.len() }> = {
                let mut spread = [[0.0; $lanes]; NUMBERS.len()];
                let mut i = 0;
                while i < NUMBERS.len() {
                    spread[i] = [NUMBERS[i]; $lanes];
                    i += 1;
                }
                Spread(spread)
            };
        }

        impl Float for $float {
            type Vector = target::$module;
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const NUMBERS: &'static [Self] = $module::NUMBERS;
            const PARTS: usize = [$($part),*].len();
            const TERMS: usize = [$($sin),*].len();
            const NEAR_TERMS: usize = [$($near_sin),*].len();
            const BOUND_OF_POSES: f64 = $bound_of_poses;
            const DOMAIN: Self = $domain;
            const BOUND: f64 = $bound;

            #[inline(always)]
            fn is_in_domain(self) -> bool {
                self.abs() <= Self::DOMAIN
            }

            #[inline(always)]
            fn is_few_turns(self) -> bool {
                self.abs() <= $module::FEW_TURNS
            }

            #[inline(always)]
            fn without_turns(self) -> Self {
                payne_hanek::$float(self)
            }

            #[inline(always)]
            fn odd(shifted: Self) -> Self {
                Self::from_bits(shifted.to_bits() << ($bits::BITS - 1))
            }

            #[inline(always)]
            fn signs(shifted: Self, odd: Self) -> (Self, Self) {
                const TOP: $bits = 1 << ($bits::BITS - 1);
                let both = (shifted.to_bits() << ($bits::BITS - 2)) & TOP;
                (Self::from_bits(both ^ odd.to_bits()), Self::from_bits(both))
            }

            #[inline(always)]
            fn change_signs(self, signs: Self) -> Self {
                Self::from_bits(self.to_bits() ^ signs.to_bits())
            }

            #[inline(always)]
            fn exchange(odd: Self, sin: Self, cos: Self) -> (Self, Self) {
                let (odd, sin, cos) = (odd.to_bits(), sin.to_bits(), cos.to_bits());
                // A mask and not a choice: without SSE4.1 there is no other way.
                let exchange = (sin ^ cos) & ((odd as $signed) >> ($bits::BITS - 1)) as $bits;
                (Self::from_bits(sin ^ exchange), Self::from_bits(cos ^ exchange))
            }

            #[inline(always)]
            fn strange(shifted: Self) -> Self {
                Self::from_bits(shifted.to_bits() ^ $module::QUARTERS.0)
            }

            #[inline(always)]
            fn is_usual(self) -> bool {
                self.to_bits() & $module::QUARTERS.1 == 0
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

// All numbers from benches/polynomials/minimax.py.
//
// f64: 33 bits of pi/2, whose products with 20 bits of k are exact, and the
// rest. Error of the polynomials 2^-58 of the sine, 2^-64 of the cosine, of those of
// whole angles 2^-54 and 2^-53.
float! {
    f64, u64, i64, double, 4, libm::sincos,
    shift: 6_755_399_442_104_320.0, quarters: 0x10_0000, domain: 1.6e6, bound: 1.8e-16,
    pi_over_2: [1.570_796_326_734_125_6, 6.077_100_506_506_192e-11],
    sin: [
        -0.166_666_666_666_666_32, 0.008_333_333_333_322_472, -0.000_198_412_698_298_356_47,
        2.755_731_369_731_385_3e-6, -2.505_075_848_318_806_8e-8, 1.589_679_587_384_691_3e-10
    ],
    cos: [
        0.041_666_666_666_666_6, -0.001_388_888_888_887_445_7, 2.480_158_728_965_296_3e-5,
        -2.755_731_439_393_726e-7, 2.087_572_812_571_144e-9, -1.135_986_600_306_813_5e-11
    ],
    middle: 5.235_848, bound_of_poses: 6.5e-16,
    near_sin: [
        0.329_305_827_674_127_7, -0.094_228_718_572_198_86, 0.005_635_822_596_431_977,
        -0.000_147_124_634_478_504_13, 2.162_225_566_841_367e-6, -2.042_555_077_618_425e-8,
        1.346_248_312_991_311_5e-10, -6.547_386_721_134_336e-13, 2.447_332_459_622_405_2e-15,
        -7.254_783_722_331_333e-18, 1.746_192_367_898_084e-20
    ],
    near_cos: [
        -0.657_428_667_683_492_6, -0.164_652_913_837_063_99, 0.023_557_179_643_049_71,
        -0.000_939_303_766_071_900_4, 1.839_057_930_981_339e-5, -2.162_225_567_037_32e-7,
        1.702_129_231_305_496_2e-9, -9.616_057_742_514_533e-12, 4.092_116_901_843_382e-14,
        -1.360_226_718_137_778_9e-16, 3.627_067_546_238_003_3e-19
    ],
}

// f32: twice 11 bits of pi/2, exact with 11 bits of k, and the rest. Error of
// the polynomials 2^-28 of the sine, 2^-33 of the cosine, of those of whole angles
// 2^-25 each.
float! {
    f32, u32, i32, single, 8, libm::sincosf,
    shift: 12_584_960.0, quarters: 0x800, domain: 3000.0, bound: 9.4e-8,
    pi_over_2: [1.570_312_5, 4.837_513e-4, 7.549_79e-8],
    sin: [-0.166_666_55, 0.008_332_191, -0.000_195_185_99],
    cos: [0.041_666_646, -0.001_388_731_4, 2.443_315_8e-5],
    middle: 5.235_848, bound_of_poses: 3.3e-7,
    near_sin: [
        0.329_305_83, -0.094_228_72, 0.005_635_822_7, -0.000_147_124_64, 2.162_223_4e-6, -2.042_554_2e-8,
        1.347_588_7e-10, -6.551_668_4e-13
    ],
    near_cos: [
        -0.657_428_7, -0.164_652_91, 0.023_557_18, -0.000_939_303_8, 1.839_054_1e-5, -2.162_223_9e-7,
        1.704_370_6e-9, -9.624_225e-12
    ],
}
