//! Sines and cosines of several angles side by side.
//!
//! The platform's `sin` takes one angle, and takes most of the time of a
//! compliance. Here every angle goes the same way, without a branch or a
//! table, so that the compiler puts the angles of a pose, or of several poses,
//! into the lanes of one vector:
//!
//! 1. `k`, the multiple of pi/2 nearest to the angle, by adding and
//!    subtracting a number so large that only whole ones fit ([`Float::SHIFT`]);
//! 2. `r = x - k pi/2`, between -pi/4 and pi/4 (Cody and Waite): pi/2 in parts,
//!    the first ones so short that `k` times them is exact, so that only the
//!    last subtraction rounds;
//! 3. `sin r = r + r z S(z)` and `cos r = 1 + z (z C(z) - 1/2)` with `z = r^2`
//!    and the best polynomials of their length;
//! 4. the last two bits of `k` exchange the two and set their signs.
//!
//! Both parts of the answer are within [`Float::BOUND`] of the truth for
//! angles up to [`Float::DOMAIN`]; `sin 0 = 0`, `cos 0 = 1`, and the symmetries
//! of sine and cosine hold exactly. An array with an angle beyond that, an
//! infinity or a NaN goes to the platform's functions, which cost one
//! comparison to find out.
//!
//! Gain: `benches/README.md`. The feature `platform-trig` takes all this out.

use core::hint::black_box;

mod float;
#[cfg(all(test, feature = "std"))]
mod tests;

pub(crate) use float::{FUSED, Float, mul_add};

/// Sine and cosine of an angle within the domain.
///
/// `FUSED`: multiplies and adds in one instruction, which the target must have.
#[inline(always)]
pub(crate) fn within_domain<F: Float, const FUSED: bool>(x: F) -> (F, F) {
    let (r, shifted) = reduce::<F, FUSED>(x);
    of_reduced::<F, FUSED>(r, shifted)
}

/// Steps 1 and 2: `r`, and `k` in the last bits of a large number.
#[inline(always)]
fn reduce<F: Float, const FUSED: bool>(x: F) -> (F, F) {
    let shifted = mul_add::<F, FUSED>(x, F::TWO_OVER_PI, F::SHIFT);
    (F::reduce::<FUSED>(x, shifted - F::SHIFT), shifted)
}

/// Steps 3 and 4.
#[inline(always)]
fn of_reduced<F: Float, const FUSED: bool>(r: F, shifted: F) -> (F, F) {
    let z = r * r;
    let sin = mul_add::<F, FUSED>(r * z, F::sin_tail::<FUSED>(z), r);
    let cos = mul_add::<F, FUSED>(z, mul_add::<F, FUSED>(z, F::cos_tail::<FUSED>(z), -F::HALF), F::ONE);
    F::turn_quarters(shifted, sin, cos)
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
    within_domain::<F, FUSED>(angle)
}

/// Sines and cosines of several angles, `(sin, cos)` each.
///
/// The angles fill whole vectors: a rest that goes alone costs as much as a
/// vector. Whatever the rest of the vector holds, it is no angle out of the
/// domain.
#[inline(always)]
pub(crate) fn sin_cos_all<F: Float, const K: usize>(angles: [F; K]) -> [(F, F); K] {
    if K > 1 && F::WIDTH > 1 {
        match K.next_multiple_of(F::WIDTH) {
            2 => return padded::<F, K, 2>(angles),
            4 => return padded::<F, K, 4>(angles),
            6 => return padded::<F, K, 6>(angles),
            8 => return padded::<F, K, 8>(angles),
            10 | 12 => return padded::<F, K, 12>(angles),
            14 | 16 => return padded::<F, K, 16>(angles),
            _ => {}
        }
    }
    angles.map(sin_cos)
}

#[inline(always)]
fn padded<F: Float, const K: usize, const P: usize>(angles: [F; K]) -> [(F, F); K] {
    if cfg!(feature = "platform-trig") || !all_within_domain(&angles) {
        return one_by_one(&angles);
    }
    let mut reduced = [[F::ZERO; P]; 2];
    for i in 0..P {
        (reduced[0][i], reduced[1][i]) = reduce::<F, FUSED>(angles[if i < K { i } else { K - 1 }]);
    }
    let [sines, cosines] = side_by_side(&reduced);
    core::array::from_fn(|i| (sines[i], cosines[i]))
}

/// Whole vectors of angles, `[sines, cosines]`.
///
/// A loop whose length the compiler does not know, because it unrolls what it
/// knows, and then finds half of the vectors only. Not inlined, for all robots
/// with about as many joints.
#[inline(never)]
fn side_by_side<F: Float, const P: usize>([reduced, shifted]: &[[F; P]; 2]) -> [[F; P]; 2] {
    let mut out = [[F::ZERO; P]; 2];
    let [sines, cosines] = &mut out;
    // The length in whole vectors: no rest that goes alone.
    let n = black_box(P / F::WIDTH).min(P / F::WIDTH) * F::WIDTH;
    for i in 0..n {
        (sines[i], cosines[i]) = of_reduced::<F, FUSED>(reduced[i], shifted[i]);
    }
    out
}

#[cold]
#[inline(never)]
fn one_by_one<F: Float, const K: usize>(angles: &[F; K]) -> [(F, F); K] {
    angles.map(F::platform_sin_cos)
}
