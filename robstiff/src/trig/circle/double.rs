//! `f64`: 256 places in 4 KiB.
//!
//! With so near a place, `sin r` takes two coefficients.
#![expect(unsafe_code, reason = "numbers come from memory and go there by pointers")]

use core::arch::x86_64::*;
use core::f64::consts::FRAC_1_SQRT_2;

use super::turned;

// All numbers from benches/polynomials/minimax.py.

const STEPS_PER_RADIAN: f64 = 40.743_665_431_525_21;
const STEP: [f64; 2] = [0.024_543_692_606_170_26, 9.567_553_118_338_697e-19];
/// 1.5 times the first number whose neighbours are 1 apart.
const WHOLE: f64 = 6_755_399_441_055_744.0;
/// More steps, back or forth, than are in the domain.
const STEPS: u64 = 1 << 26;
const SHIFT: f64 = WHOLE + STEPS as f64;
const SIN: [f64; 2] = [-0.166_666_666_664_724_3, 0.008_333_291_688_910_827];

/// Places in a turn: as many as the last byte of a number can tell apart.
const PLACES: usize = 256;
const QUARTER: usize = PLACES / 4;

/// Sines of the places of the first quarter.
#[rustfmt::skip]
const SINES: [f64; QUARTER + 1] = [
    0.0, 0.024_541_228_522_912_288, 0.049_067_674_327_418_015, 0.073_564_563_599_667_43,
    0.098_017_140_329_560_6, 0.122_410_675_199_216_2, 0.146_730_474_455_361_75, 0.170_961_888_760_301_22,
    0.195_090_322_016_128_28, 0.219_101_240_156_869_8, 0.242_980_179_903_263_9, 0.266_712_757_474_898_37,
    0.290_284_677_254_462_4, 0.313_681_740_398_891_46, 0.336_889_853_392_220_05, 0.359_895_036_534_988_17,
    0.382_683_432_365_089_8, 0.405_241_314_004_989_86, 0.427_555_093_430_282_1, 0.449_611_329_654_606_6,
    0.471_396_736_825_997_64, 0.492_898_192_229_784_04, 0.514_102_744_193_221_8, 0.534_997_619_887_097_3,
    0.555_570_233_019_602_2, 0.575_808_191_417_845_3, 0.595_699_304_492_433_4, 0.615_231_590_580_626_8,
    0.634_393_284_163_645_5, 0.653_172_842_953_776_8, 0.671_558_954_847_018_4, 0.689_540_544_737_066_9,
    FRAC_1_SQRT_2, 0.724_247_082_951_466_9, 0.740_951_125_354_959_1, 0.757_208_846_506_484_6,
    0.773_010_453_362_737, 0.788_346_427_626_606_2, 0.803_207_531_480_644_9, 0.817_584_813_151_583_7,
    0.831_469_612_302_545_2, 0.844_853_565_249_707_1, 0.857_728_610_000_272_1, 0.870_086_991_108_711_5,
    0.881_921_264_348_355, 0.893_224_301_195_515_3, 0.903_989_293_123_443_3, 0.914_209_755_703_530_7,
    0.923_879_532_511_286_7, 0.932_992_798_834_738_8, 0.941_544_065_183_020_8, 0.949_528_180_593_036_7,
    0.956_940_335_732_208_8, 0.963_776_065_795_439_8, 0.970_031_253_194_544, 0.975_702_130_038_528_6,
    0.980_785_280_403_230_4, 0.985_277_642_388_941_2, 0.989_176_509_964_781, 0.992_479_534_598_71,
    0.995_184_726_672_196_9, 0.997_290_456_678_690_2, 0.998_795_456_205_172_4, 0.999_698_818_696_204_2,
    1.0,
];

/// Aligned, so that no place is half in one line of the cache and half in the next.
#[repr(align(64))]
struct Circle([[f64; 2]; PLACES]);

/// Halves of the sine and the cosine of every place.
static CIRCLE: Circle = {
    let mut places = [[0.0; 2]; PLACES];
    let mut k = 0;
    while k < PLACES {
        places[k] = turned(SINES[k % QUARTER] / 2.0, SINES[QUARTER - k % QUARTER] / 2.0, k / QUARTER);
        k += 1;
    }
    Circle(places)
};

/// The multiples of pi/128 nearest to the angles, each with [`SHIFT`]; false if some angle is out of the domain
/// or a NaN.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(crate) fn shift_each<const K: usize>(angles: &[f64; K], shifted: &mut [f64; K]) -> bool {
    const { assert!(K.is_multiple_of(4), "whole vectors") }
    // Within the domain, the bits are those of `WHOLE` but for the last.
    let mut strange = _mm256_setzero_pd();
    for (angles, shifted) in angles.as_chunks::<4>().0.iter().zip(shifted.as_chunks_mut::<4>().0) {
        // SAFETY: four numbers.
        let x = unsafe { _mm256_loadu_pd(angles.as_ptr()) };
        let four = _mm256_fmadd_pd(x, splat(STEPS_PER_RADIAN), splat(SHIFT));
        strange = _mm256_or_pd(strange, _mm256_xor_pd(four, splat(WHOLE)));
        // SAFETY: room for four numbers.
        unsafe { _mm256_storeu_pd(shifted.as_mut_ptr(), four) };
    }
    let beyond = _mm256_set1_epi64x(!(2 * STEPS as i64 - 1));
    _mm256_testz_si256(_mm256_castpd_si256(strange), beyond) == 1
}

/// Sines and cosines; in the cosines' place stands what [`shift_each`] made of the angles.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(crate) fn sin_cos_each<const K: usize>(angles: &[f64; K], sines: &mut [f64; K], cosines: &mut [f64; K]) {
    const { assert!(K.is_multiple_of(4), "whole vectors") }
    let vectors = angles.as_chunks::<4>().0.iter().zip(sines.as_chunks_mut::<4>().0);
    for ((angles, sines), cosines) in vectors.zip(cosines.as_chunks_mut::<4>().0) {
        let places = cosines.map(|shifted| usize::from(shifted.to_bits() as u8));
        // SAFETY: four numbers each.
        let (x, shifted) = unsafe { (_mm256_loadu_pd(angles.as_ptr()), _mm256_loadu_pd(cosines.as_ptr())) };
        let (sin, cos) = sin_cos(x, shifted, places);
        // SAFETY: room for four numbers each.
        unsafe {
            _mm256_storeu_pd(sines.as_mut_ptr(), sin);
            _mm256_storeu_pd(cosines.as_mut_ptr(), cos);
        }
    }
}

#[inline]
#[target_feature(enable = "avx2")]
fn splat(number: f64) -> __m256d {
    _mm256_set1_pd(number)
}

/// Sines and cosines of four angles near `places`; `shifted` is the steps and the shift.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn sin_cos(x: __m256d, shifted: __m256d, places: [usize; 4]) -> (__m256d, __m256d) {
    let k = _mm256_sub_pd(shifted, splat(SHIFT));
    let r = _mm256_fnmadd_pd(k, splat(STEP[1]), _mm256_fnmadd_pd(k, splat(STEP[0]), x));
    let z = _mm256_mul_pd(r, r);
    let rz = _mm256_mul_pd(r, z);
    let sin_r = _mm256_fmadd_pd(rz, _mm256_fmadd_pd(z, splat(SIN[1]), splat(SIN[0])), r);
    let t = _mm256_fmadd_pd(rz, splat(0.25), sin_r);

    let (half_s, half_c) = look_up(places);
    let (s, c) = (_mm256_add_pd(half_s, half_s), _mm256_add_pd(half_c, half_c));
    // The large numbers last: then the sums before hardly round.
    (
        _mm256_fmadd_pd(sin_r, _mm256_fnmadd_pd(t, half_s, c), s),
        _mm256_fnmadd_pd(sin_r, _mm256_fmadd_pd(t, half_c, s), c),
    )
}

/// Halves of the sines and of the cosines.
#[inline]
#[target_feature(enable = "avx2")]
fn look_up(places: [usize; 4]) -> (__m256d, __m256d) {
    const { assert!(align_of::<Circle>() >= 16 && size_of::<[f64; 2]>() == 16) }
    // SAFETY: a place is the two numbers that are read, 16 bytes, and every one is a
    // multiple of that behind the start of the circle, which is aligned to more.
    let [a, b, c, d] = places.map(|place| unsafe { _mm_load_pd(CIRCLE.0[place].as_ptr()) });
    let (even, odd) = (_mm256_set_m128d(c, a), _mm256_set_m128d(d, b));
    (_mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd))
}
