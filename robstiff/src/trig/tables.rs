//! Sines and cosines from tables in registers.
//!
//! Two registers of AVX-512 hold sixteen numbers, of which one instruction looks up
//! eight. With the sines of the multiples of pi/16 there,
//!
//! 1. `k` is the multiple of pi/16 nearest to the angle, by a number so large that
//!    only whole ones fit, and `r = x - k pi/16` (pi/16 in two parts);
//! 2. the last four bits of `k` find `S = sin(k pi/16)` and `C = cos(k pi/16)`, the
//!    fifth, half a turn more, changes the signs of both;
//! 3. `sin r = r + r z S(z)` and `cos r - 1 = z (z C(z) - 1/2)` with `z = r^2`, at
//!    most pi/32 away from 0, where half the coefficients do;
//! 4. `sin x = S + S (cos r - 1) + C sin r`, `cos x = C + C (cos r - 1) - S sin r`.
//!
//! Domain, error and symmetries are those of the module above: 25 operations a vector
//! of angles instead of 32. Gain: `benches/README.md`. Without this,
//! [`sin_cos_each`](super::sin_cos_each) is what remains.
#![expect(unsafe_code, reason = "numbers come from memory and go there by pointers")]

use core::arch::x86_64::*;

// All numbers from benches/polynomials/minimax.py.

const STEPS_PER_RADIAN: f64 = 5.092_958_178_940_651;
const STEP: [f64; 2] = [0.196_349_540_849_362_07, 7.654_042_494_670_958e-18];
/// 1.5 times the first number whose neighbours are 1 apart.
const WHOLE: f64 = 6_755_399_441_055_744.0;
/// More steps, back or forth, than are in the domain.
const STEPS: u64 = 1 << 23;
const SIN: [f64; 3] = [-0.166_666_666_666_212_66, 0.008_333_333_047_759_756, -0.000_198_361_634_171_422_17];
const COS: [f64; 3] = [0.041_666_666_666_590_094, -0.001_388_888_851_321_172_9, 2.479_586_799_355_841_3e-5];

/// Sines of the first eight multiples of pi/16, of the next eight, and the first with
/// the other sign, which are those of the eight after that.
const SINES: [[f64; 8]; 3] = {
    const FIRST: [f64; 8] = [
        0.0,
        0.195_090_322_016_128_28,
        0.382_683_432_365_089_8,
        0.555_570_233_019_602_2,
        core::f64::consts::FRAC_1_SQRT_2,
        0.831_469_612_302_545_2,
        0.923_879_532_511_286_7,
        0.980_785_280_403_230_4,
    ];
    let (mut next, mut negative) = ([1.0; 8], FIRST);
    let mut k = 1;
    while k < 8 {
        (next[k], negative[k]) = (FIRST[8 - k], -FIRST[k]);
        k += 1;
    }
    [FIRST, next, negative]
};

/// What [`sin_cos_each`](super::sin_cos_each) does, of whole vectors.
#[inline]
#[target_feature(enable = "avx512f")]
pub(crate) fn sin_cos_each<const K: usize>(angles: &[f64; K], sines: &mut [f64; K], cosines: &mut [f64; K]) -> bool {
    const { assert!(K.is_multiple_of(8), "whole vectors") }
    let mut strange = _mm512_setzero_si512();
    // Within the domain, the bits of a shifted angle are those of `WHOLE` but for the last.
    let (shift, whole) = (splat(WHOLE + STEPS as f64), _mm512_castpd_si512(splat(WHOLE)));
    let vectors = angles.as_chunks::<8>().0.iter().zip(sines.as_chunks_mut::<8>().0);
    for ((angles, sines), cosines) in vectors.zip(cosines.as_chunks_mut::<8>().0) {
        // SAFETY: eight numbers.
        let x = unsafe { _mm512_loadu_pd(angles.as_ptr()) };
        let shifted = _mm512_fmadd_pd(x, splat(STEPS_PER_RADIAN), shift);
        strange = _mm512_or_si512(strange, _mm512_xor_si512(_mm512_castpd_si512(shifted), whole));
        let (sin, cos) = sin_cos(x, shifted, shift);
        // SAFETY: room for eight numbers.
        unsafe {
            _mm512_storeu_pd(sines.as_mut_ptr(), sin);
            _mm512_storeu_pd(cosines.as_mut_ptr(), cos);
        }
    }
    _mm512_test_epi64_mask(strange, _mm512_set1_epi64(!(2 * STEPS as i64 - 1))) == 0
}

#[inline]
#[target_feature(enable = "avx512f")]
fn splat(number: f64) -> __m512d {
    _mm512_set1_pd(number)
}

/// Sines and cosines of eight angles; `shifted`, whose last bits are the steps, is the
/// steps and the shift.
#[inline]
#[target_feature(enable = "avx512f")]
fn sin_cos(x: __m512d, shifted: __m512d, shift: __m512d) -> (__m512d, __m512d) {
    let k = _mm512_sub_pd(shifted, shift);
    let r = _mm512_fnmadd_pd(k, splat(STEP[1]), _mm512_fnmadd_pd(k, splat(STEP[0]), x));
    let z = _mm512_mul_pd(r, r);
    let polynomial = |[a, b, c]: [f64; 3]| _mm512_fmadd_pd(z, _mm512_fmadd_pd(z, splat(c), splat(b)), splat(a));
    let sin_r = _mm512_fmadd_pd(_mm512_mul_pd(r, z), polynomial(SIN), r);
    let cos_r_less_1 = _mm512_mul_pd(z, _mm512_fmadd_pd(z, polynomial(COS), splat(-0.5)));

    let k = _mm512_castpd_si512(shifted);
    let half_turn = _mm512_slli_epi64::<59>(k);
    // Changes the sign where the first bit of `half_turn` is set.
    let signed = |number: __m512d| {
        const EXCLUSIVE_OR_OF_AND: i32 = 0x78;
        _mm512_castsi512_pd(_mm512_ternarylogic_epi64::<EXCLUSIVE_OR_OF_AND>(
            _mm512_castpd_si512(number),
            half_turn,
            _mm512_set1_epi64(i64::MIN),
        ))
    };
    // SAFETY: eight numbers each.
    let [first, next, negative] = SINES.each_ref().map(|eight| unsafe { _mm512_loadu_pd(eight.as_ptr()) });
    let s = signed(_mm512_permutex2var_pd(first, k, next));
    let c = signed(_mm512_permutex2var_pd(next, k, negative));
    // The large numbers last: then the sums before hardly round.
    (
        _mm512_add_pd(s, _mm512_fmadd_pd(c, sin_r, _mm512_mul_pd(s, cos_r_less_1))),
        _mm512_add_pd(c, _mm512_fnmadd_pd(s, sin_r, _mm512_mul_pd(c, cos_r_less_1))),
    )
}

/// [`sin_cos_each`] where the machine has AVX-512.
#[cfg(test)]
pub(crate) fn sin_cos_if_available<const K: usize>(angles: &[f64; K]) -> Option<([f64; K], [f64; K], bool)> {
    let (mut sines, mut cosines) = ([0.0; K], [0.0; K]);
    let is_usual = std::is_x86_feature_detected!("avx512f").then(|| {
        // SAFETY: the machine has AVX-512.
        unsafe { sin_cos_each(angles, &mut sines, &mut cosines) }
    })?;
    Some((sines, cosines, is_usual))
}
