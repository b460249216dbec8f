//! `f32`: 1024 places in 8 KiB.
//!
//! So near a place that `sin r = t = r`: the term in `r^3`, 4.8e-9 at most, is a tenth
//! of what numbers are rounded by.
#![expect(unsafe_code, reason = "numbers come from memory and go there by pointers")]

use core::arch::x86_64::*;
use core::f64::consts::TAU;

use super::turned;

// All numbers from benches/polynomials/minimax.py.

const STEPS_PER_RADIAN: f32 = 162.974_66;
const STEP: [f32; 2] = [0.006_135_923_3, -1.707_476_1e-10];
/// 1.5 times the first number whose neighbours are 1 apart.
const WHOLE: f32 = 12_582_912.0;
/// More steps, back or forth, than are in the domain.
const STEPS: u32 = 1 << 19;
const SHIFT: f32 = WHOLE + STEPS as f32;

/// Places in a turn.
const PLACES: usize = 1024;
const QUARTER: usize = PLACES / 4;

/// Aligned, so that no place is half in one line of the cache and half in the next.
#[repr(align(64))]
struct Circle([[f32; 2]; PLACES]);

/// Halves of the sine and the cosine of every place.
static CIRCLE: Circle = {
    let mut places = [[0.0; 2]; PLACES];
    let mut k = 0;
    while k < PLACES {
        let [sin, cos] = turned(half_sine(k % QUARTER), half_sine(QUARTER - k % QUARTER), k / QUARTER);
        places[k] = [sin as f32, cos as f32];
        k += 1;
    }
    Circle(places)
};

/// Of a place in the first quarter, by Taylor's series in twice the precision.
const fn half_sine(place: usize) -> f64 {
    let x = TAU / PLACES as f64 * place as f64;
    let (mut term, mut sum, mut n) = (x, x, 1.0);
    while n < 21.0 {
        term *= -x * x / ((n + 1.0) * (n + 2.0));
        sum += term;
        n += 2.0;
    }
    sum / 2.0
}

/// The multiples of pi/512 nearest to the angles, each with [`SHIFT`]; false if some angle is out of the domain
/// or a NaN.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(crate) fn shift_each<const K: usize>(angles: &[f32; K], shifted: &mut [f32; K]) -> bool {
    const { assert!(K.is_multiple_of(8), "whole vectors") }
    // Within the domain, the bits are those of `WHOLE` but for the last.
    let mut strange = _mm256_setzero_ps();
    for (angles, shifted) in angles.as_chunks::<8>().0.iter().zip(shifted.as_chunks_mut::<8>().0) {
        // SAFETY: eight numbers.
        let x = unsafe { _mm256_loadu_ps(angles.as_ptr()) };
        let eight = _mm256_fmadd_ps(x, splat(STEPS_PER_RADIAN), splat(SHIFT));
        strange = _mm256_or_ps(strange, _mm256_xor_ps(eight, splat(WHOLE)));
        // SAFETY: room for eight numbers.
        unsafe { _mm256_storeu_ps(shifted.as_mut_ptr(), eight) };
    }
    let beyond = _mm256_set1_epi32(!(2 * STEPS as i32 - 1));
    _mm256_testz_si256(_mm256_castps_si256(strange), beyond) == 1
}

/// Sines and cosines; in the cosines' place stands what [`shift_each`] made of the angles.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(crate) fn sin_cos_each<const K: usize>(angles: &[f32; K], sines: &mut [f32; K], cosines: &mut [f32; K]) {
    const { assert!(K.is_multiple_of(8), "whole vectors") }
    let vectors = angles.as_chunks::<8>().0.iter().zip(sines.as_chunks_mut::<8>().0);
    for ((angles, sines), cosines) in vectors.zip(cosines.as_chunks_mut::<8>().0) {
        let places = cosines.map(|shifted| shifted.to_bits() as usize % PLACES);
        // SAFETY: eight numbers each.
        let (x, shifted) = unsafe { (_mm256_loadu_ps(angles.as_ptr()), _mm256_loadu_ps(cosines.as_ptr())) };
        let (sin, cos) = sin_cos(x, shifted, places);
        // SAFETY: room for eight numbers each.
        unsafe {
            _mm256_storeu_ps(sines.as_mut_ptr(), sin);
            _mm256_storeu_ps(cosines.as_mut_ptr(), cos);
        }
    }
}

#[inline]
#[target_feature(enable = "avx2")]
fn splat(number: f32) -> __m256 {
    _mm256_set1_ps(number)
}

/// Sines and cosines of eight angles near `places`; `shifted` is the steps and the shift.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn sin_cos(x: __m256, shifted: __m256, places: [usize; 8]) -> (__m256, __m256) {
    let k = _mm256_sub_ps(shifted, splat(SHIFT));
    let r = _mm256_fnmadd_ps(k, splat(STEP[1]), _mm256_fnmadd_ps(k, splat(STEP[0]), x));

    let (half_s, half_c) = look_up(places);
    let (s, c) = (_mm256_add_ps(half_s, half_s), _mm256_add_ps(half_c, half_c));
    // The large numbers last: then the sums before hardly round.
    (_mm256_fmadd_ps(r, _mm256_fnmadd_ps(r, half_s, c), s), _mm256_fnmadd_ps(r, _mm256_fmadd_ps(r, half_c, s), c))
}

/// Halves of the sines and of the cosines.
#[inline]
#[target_feature(enable = "avx2")]
fn look_up(places: [usize; 8]) -> (__m256, __m256) {
    let [a, b, c, d, e, f, g, h] = places.map(|place| CIRCLE.0[place].as_ptr().cast());
    // SAFETY: two numbers each, as many bytes as one `f64`.
    let two = |low, high| unsafe { _mm_castpd_ps(_mm_loadh_pd(_mm_load_sd(low), high)) };
    let (left, right) = (_mm256_set_m128(two(e, f), two(a, b)), _mm256_set_m128(two(g, h), two(c, d)));
    (_mm256_shuffle_ps::<0b10_00_10_00>(left, right), _mm256_shuffle_ps::<0b11_01_11_01>(left, right))
}
