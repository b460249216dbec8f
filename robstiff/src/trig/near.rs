//! The way of a pose: polynomials of whole angles.
//!
//! 1. Of angles of at most 3.236 rad (185 degrees), where joints mostly are, nothing is taken
//!    away. If one of a pose is larger, whole turns are taken from all ([`wrapped`]), in parts
//!    as quarters are by [`reduced`](super::reduced); they change neither sines nor cosines.
//! 2. `sin x = x S(u)` and `cos x = C(u)` with `u = x^2 - m`, `m` half the square of the
//!    largest near angle. For `u` is as far below 0 as above, the terms of both polynomials
//!    fall quickly and nothing large cancels; in powers of `x^2` they would be up to 5, for
//!    results of 1.
//!
//! A single pose waits for its sines and cosines: here for six operations in a row (20 cycles
//! where a fused one takes 4), whereas quarters, shorter polynomials, signs and an exchange
//! take some 48, and more operations besides. Gain: `benches/README.md`.

use super::abreast::{self, Abreast, Pairs};
use super::float::{FUSED, Float, places};
use super::reduced::less_multiples;

/// `u` of angles.
#[inline(always)]
fn measured<F: Float, V: Abreast<F>, const FUSED: bool>(x: V) -> V {
    abreast::mul_add::<F, V, FUSED>(x, x, V::number(places::MINUS_MIDDLE))
}

/// Negative where an angle is not near; of a NaN either, for polynomials make a NaN of it.
#[inline(always)]
pub(super) fn room<F: Float, V: Abreast<F>>(x: V) -> V {
    V::number(places::MIDDLE) - measured::<F, V, FUSED>(x)
}

/// The same of angles of many turns.
#[inline(always)]
pub(super) fn room_in_few_turns<F: Float, V: Abreast<F>>(x: V) -> V {
    V::number(places::FEW_TURNS_SQUARED) - x * x
}

/// Angles of the domain less whole turns, of near ones none: at most pi.
#[inline(always)]
pub(super) fn wrapped<F: Float, V: Abreast<F>, const FUSED: bool>(x: V) -> V {
    let turns = abreast::mul_add::<F, V, FUSED>(x, V::number(places::TURNS_PER_RADIAN), V::number(places::SHIFT));
    less_multiples::<F, V, FUSED>(x, turns, places::turn::<F>())
}

/// A polynomial in `u`, the lowest coefficient first: by fours, each of which is two pairs,
/// so that nothing waits for more than it must (Estrin).
#[inline(always)]
fn polynomial<F: Float, V: Abreast<F>, const FUSED: bool>(coefficient: impl Fn(usize) -> V, u: V) -> V {
    let mul_add = abreast::mul_add::<F, V, FUSED>;
    let u2 = u * u;
    let u4 = u2 * u2;
    let pair = |first: usize| {
        let low = coefficient(first);
        if first + 1 < F::NEAR_TERMS { mul_add(u, coefficient(first + 1), low) } else { low }
    };
    let four = |first: usize| {
        if first + 2 < F::NEAR_TERMS { mul_add(u2, pair(first + 2), pair(first)) } else { pair(first) }
    };
    const { assert!(F::NEAR_TERMS > 4 && F::NEAR_TERMS <= 12) }
    // The compiler keeps this order. Gain: `benches/README.md`.
    let second = four(4);
    let rest = if F::NEAR_TERMS > 8 { mul_add(u4, four(8), second) } else { second };
    mul_add(u4, rest, four(0))
}

/// Sines and cosines of near or wrapped angles.
#[inline(always)]
pub(super) fn sin_cos<F: Float, V: Abreast<F>, const FUSED: bool>(x: V) -> (V, V) {
    let u = measured::<F, V, FUSED>(x);
    let sin = polynomial::<F, V, FUSED>(|i| V::number(places::near_sin::<F>() + i), u);
    let cos = polynomial::<F, V, FUSED>(|i| V::number(places::near_cos::<F>() + i), u);
    (x * sin, cos)
}

/// The same, each times a constant: of a sine it is the angle that is multiplied, which waits
/// for nothing, of a cosine the compiler multiplies the coefficients, for which it must see them.
#[inline(always)]
pub(super) fn scaled_sin_cos<F: Float, V: Pairs<F>, const FUSED: bool>(x: V, (by_sin, by_cos): (V, V)) -> (V, V) {
    let u = measured::<F, V, FUSED>(x);
    let sin = polynomial::<F, V, FUSED>(|i| V::number(places::near_sin::<F>() + i), u);
    let coefficient = |i| V::numbers(places::near_cos::<F>() + i, places::near_cos::<F>() + i) * by_cos;
    let cos = polynomial::<F, V, FUSED>(coefficient, u);
    ((x * by_sin) * sin, cos)
}

/// The same of angles that are there in pairs, sine and cosine side by side.
#[inline(always)]
pub(super) fn pairs<F: Float, V: Pairs<F>, const FUSED: bool>(x: V, by: Option<V>) -> V {
    let coefficient = |i| V::numbers(places::near_sin::<F>() + i, places::near_cos::<F>() + i);
    let both = polynomial::<F, V, FUSED>(coefficient, measured::<F, V, FUSED>(x));
    let sines_beside_ones = x.sines_beside_ones();
    both * by.map_or(sines_beside_ones, |by| sines_beside_ones * by)
}
