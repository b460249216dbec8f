//! Any angle of the domain, less multiples of pi/2:
//!
//! 1. `k`, the multiple of pi/2 nearest to the angle, by adding and
//!    subtracting a number so large that only whole ones fit ([`places::SHIFT`]);
//! 2. `r = x - k pi/2`, between -pi/4 and pi/4 (Cody and Waite): pi/2 in parts,
//!    the first ones so short that `k` times them is exact, so that only the
//!    last subtraction rounds;
//! 3. `sin r = r + r z S(z)` and `cos r = 1 + z (z C(z) - 1/2)` with `z = r^2`
//!    and the best polynomials of their length, with as few multiplications as possible;
//! 4. the last two bits of `k` set the signs of the two and exchange them.

use super::abreast::{self, Abreast};
use super::float::{Float, places};

/// The nearest multiples of pi/2, as the last bits of a large number.
#[inline(always)]
pub(super) fn quarters<F: Float, const FUSED: bool>(x: F) -> F {
    abreast::mul_add::<F, F, FUSED>(x, F::number(places::TWO_OVER_PI), F::number(places::SHIFT))
}

/// Angles less the multiples that are the last bits of `shifted`, of what has its parts, with
/// the other sign, from place `parts` on.
#[inline(always)]
pub(super) fn less_multiples<F: Float, V: Abreast<F>, const FUSED: bool>(x: V, shifted: V, parts: usize) -> V {
    let k = shifted - V::number(places::SHIFT);
    let mut r = x;
    for part in 0..F::PARTS - 1 {
        r = abreast::mul_add::<F, V, FUSED>(k, V::number(parts + part), r);
    }
    // Not fused: this product does not wait for the others.
    r + k * V::number(parts + F::PARTS - 1)
}

/// A polynomial, the lowest coefficient first, term by term (Horner).
#[inline(always)]
fn polynomial<F: Float, const FUSED: bool>(coefficient: impl Fn(usize) -> F, z: F) -> F {
    let mut value = coefficient(F::TERMS - 1);
    for i in 1..F::TERMS {
        value = abreast::mul_add::<F, F, FUSED>(value, z, coefficient(F::TERMS - 1 - i));
    }
    value
}

/// Sine and cosine of an angle within the domain.
///
/// `FUSED`: multiplies and adds in one instruction, which the target must have.
#[inline(always)]
pub(crate) fn within_domain<F: Float, const FUSED: bool>(x: F) -> (F, F) {
    let mul_add = abreast::mul_add::<F, F, FUSED>;
    let shifted = quarters::<F, FUSED>(x);
    let r = less_multiples::<F, F, FUSED>(x, shifted, places::PARTS);
    let z = r * r;
    // Once: of two such shifts the compiler makes a comparison of one. Gain: `benches/README.md`.
    let odd = F::odd(shifted);
    let (sign_of_sin, sign_of_cos) = F::signs(shifted, odd);
    let signed = r.change_signs(sign_of_sin);
    let sin_tail = polynomial::<F, FUSED>(|i| F::number(places::sin::<F>() + i), z);
    let sin = mul_add(signed * z, sin_tail, signed);
    let cos_tail = polynomial::<F, FUSED>(|i| F::number(places::cos::<F>() + i), z);
    let cos = mul_add(z, mul_add(z, cos_tail, F::number(places::MINUS_HALF)), F::number(places::ONE));
    F::exchange(odd, sin, cos.change_signs(sign_of_cos))
}

/// Sines and cosines of many angles, in a loop that the compiler makes vectors of.
/// False if some angle is out of the domain or a NaN: then they mean nothing.
#[inline(always)]
pub(crate) fn sin_cos_each<F: Float, const FUSED: bool, const K: usize>(
    angles: &[F; K],
    sines: &mut [F; K],
    cosines: &mut [F; K],
) -> bool {
    let mut strange = F::ZERO;
    for i in 0..K {
        strange = strange.or(F::strange(quarters::<F, FUSED>(angles[i])));
        (sines[i], cosines[i]) = within_domain::<F, FUSED>(angles[i]);
    }
    strange.is_usual()
}
