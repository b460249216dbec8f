//! Sines and cosines of several angles side by side.
//!
//! The platform's `sin` takes one angle, and takes most of the time of a
//! compliance. Here every angle goes the same way, without a branch or a
//! table, so that the angles of a pose, or of several poses, go into the lanes
//! of one vector ([`Abreast`]):
//!
//! 1. `k`, the multiple of pi/2 nearest to the angle, by adding and
//!    subtracting a number so large that only whole ones fit ([`Float::SHIFT`]);
//! 2. `r = x - k pi/2`, between -pi/4 and pi/4 (Cody and Waite): pi/2 in parts,
//!    the first ones so short that `k` times them is exact, so that only the
//!    last subtraction rounds;
//! 3. `sin r = r + r z S(z)` and `cos r = 1 + z (z C(z) - 1/2)` with `z = r^2`
//!    and the best polynomials of their length, in steps that wait for each
//!    other as little as possible: a single pose waits more than it computes;
//! 4. the last two bits of `k` exchange the two and set their signs.
//!
//! Both parts of the answer are within [`Float::BOUND`] of the truth for
//! angles up to [`Float::DOMAIN`]; `sin 0 = 0`, `cos 0 = 1`, and the symmetries
//! of sine and cosine hold exactly. An array with an angle beyond that, an
//! infinity or a NaN goes to the platform's functions, which cost one
//! comparison to find out.
//!
//! Gain: `benches/README.md`. The feature `platform-trig` takes all this out.

mod abreast;
mod float;
#[cfg(all(test, feature = "std"))]
mod tests;

use abreast::{Abreast, Vector};
pub(crate) use float::{FUSED, Float};

/// `a * b + c`, rounded once if `FUSED`.
#[inline(always)]
pub(crate) fn mul_add<F: Float, const FUSED: bool>(a: F, b: F, c: F) -> F {
    abreast::mul_add::<F, F, FUSED>(a, b, c)
}

/// Sines and cosines of angles within the domain.
///
/// `FUSED`: multiplies and adds in one instruction, which the target must have.
#[inline(always)]
pub(crate) fn within_domain<F: Float, V: Abreast<F>, const FUSED: bool>(x: V) -> (V, V) {
    let mul_add = abreast::mul_add::<F, V, FUSED>;
    let shifted = mul_add(x, V::splat(F::TWO_OVER_PI), V::splat(F::SHIFT));
    let r = F::reduce::<V, FUSED>(x, shifted - V::splat(F::SHIFT));
    let z = r * r;
    let z2 = z * z;
    let sin = mul_add(r * z, F::sin_tail::<V, FUSED>(z, z2), r);
    let most = mul_add(z, V::splat(-F::HALF), V::splat(F::ONE));
    let cos = mul_add(z2, F::cos_tail::<V, FUSED>(z, z2), most);
    V::turn_quarters(shifted, sin, cos)
}

/// Whether all angles are within the domain; false for a NaN.
#[inline(always)]
pub(crate) fn all_within_domain<F: Float, const K: usize>(angles: &[F; K]) -> bool {
    let mut within = true;
    for angle in angles {
        within &= angle.is_within_domain();
    }
    within
}

/// Sine and cosine of one angle.
#[inline]
pub(crate) fn sin_cos<F: Float>(angle: F) -> (F, F) {
    if cfg!(feature = "platform-trig") || !angle.is_within_domain() {
        return angle.platform_sin_cos();
    }
    within_domain::<F, F, FUSED>(angle)
}

/// Sines and cosines of several angles, `(sin, cos)` each.
///
/// Whole vectors of angles, the last one filled up with the last angle: a rest
/// that goes alone costs as much as a vector.
///
/// Nothing here has its address taken on the way that is usual, so that angles
/// and results stay in registers: numbers stored one by one and loaded as a
/// vector would have to wait for the cache.
#[inline(always)]
pub(crate) fn sin_cos_all<F: Float, const K: usize>(angles: [F; K]) -> [(F, F); K] {
    let mut out = [(F::ZERO, F::ZERO); K];
    let mut within = !cfg!(feature = "platform-trig");
    for first in (0..K).step_by(F::Vector::LANES) {
        within = within && F::Vector::gather(&angles, first).is_within_domain();
    }
    if within {
        for first in (0..K).step_by(F::Vector::LANES) {
            let (sin, cos) = within_domain::<F, F::Vector, FUSED>(F::Vector::gather(&angles, first));
            F::Vector::scatter(sin, cos, &mut out, first);
        }
    } else {
        let copies = angles;
        out.copy_from_slice(&one_by_one(&copies));
    }
    out
}

#[cold]
#[inline(never)]
fn one_by_one<F: Float, const K: usize>(angles: &[F; K]) -> [(F, F); K] {
    angles.map(F::platform_sin_cos)
}
