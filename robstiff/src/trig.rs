//! Sines and cosines of several angles side by side.
//!
//! The platform's `sin` takes one angle, and takes most of the time of a
//! compliance. Here every angle goes the same way, without a branch or a
//! table, so that the angles of a pose, or of several poses, go into the lanes
//! of one vector ([`Abreast`]). Batches have tables where these are faster: with AVX2 in
//! memory (`circle.rs`), of `f64` with AVX-512 in registers (`tables.rs`). The way without:
//!
//! 1. `k`, the multiple of pi/2 nearest to the angle, by adding and
//!    subtracting a number so large that only whole ones fit ([`places::SHIFT`]);
//! 2. `r = x - k pi/2`, between -pi/4 and pi/4 (Cody and Waite): pi/2 in parts,
//!    the first ones so short that `k` times them is exact, so that only the
//!    last subtraction rounds;
//! 3. `sin r = r + r z S(z)` and `cos r = 1 + z (z C(z) - 1/2)` with `z = r^2`
//!    and the best polynomials of their length: for a single pose, which waits
//!    more than it computes, in steps that wait for each other as little as
//!    possible, for many poses with as few multiplications as possible;
//! 4. the last two bits of `k` set the signs of the two and exchange them.
//!
//! Both parts of the answer are within [`Float::BOUND`] of the truth for
//! angles up to [`Float::DOMAIN`]; `sin 0 = 0`, `cos 0 = 1`, and the symmetries
//! of sine and cosine hold exactly. An array with an angle beyond that, an
//! infinity or a NaN goes to the platform's functions, which costs one
//! comparison to find out: of the bits of the number that `k` is added to.
//!
//! Gain: `benches/README.md`. The feature `platform-trig` takes all this out.

mod abreast;
#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub(crate) mod circle;
mod float;
#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub(crate) mod tables;
#[cfg(all(test, feature = "std"))]
mod tests;

use abreast::{Abreast, Pairs, Vector};
use float::places;
pub(crate) use float::{FUSED, Float};

/// `a * b + c`, rounded once if `FUSED`.
#[inline(always)]
pub(crate) fn mul_add<F: Float, const FUSED: bool>(a: F, b: F, c: F) -> F {
    abreast::mul_add::<F, F, FUSED>(a, b, c)
}

/// The nearest multiples of pi/2, as the last bits of a large number.
#[inline(always)]
fn quarters<F: Float, V: Abreast<F>, const FUSED: bool>(x: V) -> V {
    abreast::mul_add::<F, V, FUSED>(x, V::number(places::TWO_OVER_PI), V::number(places::SHIFT))
}

/// The angles less those multiples of pi/2.
#[inline(always)]
fn reduced<F: Float, V: Abreast<F>, const FUSED: bool>(x: V, shifted: V) -> V {
    let k = shifted - V::number(places::SHIFT);
    let mut r = x;
    for part in 0..F::PARTS - 1 {
        r = abreast::mul_add::<F, V, FUSED>(k, V::number(places::PARTS + part), r);
    }
    // Not fused: this product does not wait for the others.
    r + k * V::number(places::PARTS + F::PARTS - 1)
}

/// A polynomial, the lowest coefficient first: pairs of terms, which do not
/// wait for each other, and then one step in `z^2` for each pair; of many angles
/// (`MANY`) term by term (Horner).
#[inline(always)]
fn polynomial<F: Float, V: Abreast<F>, const FUSED: bool, const MANY: bool>(
    coefficient: impl Fn(usize) -> V,
    z: V,
    z2: V,
) -> V {
    let mul_add = abreast::mul_add::<F, V, FUSED>;
    if MANY {
        let mut value = coefficient(F::TERMS - 1);
        for i in 1..F::TERMS {
            value = mul_add(value, z, coefficient(F::TERMS - 1 - i));
        }
        return value;
    }
    let pair = |i: usize| {
        let low = coefficient(i);
        if i + 1 < F::TERMS { mul_add(z, coefficient(i + 1), low) } else { low }
    };
    let mut i = (F::TERMS - 1) / 2 * 2;
    let mut value = pair(i);
    while i > 0 {
        i -= 2;
        value = mul_add(value, z2, pair(i));
    }
    value
}

/// Sines and cosines of angles within the domain.
///
/// `FUSED`: multiplies and adds in one instruction, which the target must have.
/// `MANY`: many angles follow each other, which do not wait for each other.
#[inline(always)]
pub(crate) fn within_domain<F: Float, V: Abreast<F>, const FUSED: bool, const MANY: bool>(x: V) -> (V, V) {
    let mul_add = abreast::mul_add::<F, V, FUSED>;
    let shifted = quarters::<F, V, FUSED>(x);
    let r = reduced::<F, V, FUSED>(x, shifted);
    let z = r * r;
    let z2 = z * z;
    // Once: of two such shifts the compiler makes a comparison of one. Gain: `benches/README.md`.
    let odd = V::odd(shifted);
    let (sign_of_sin, sign_of_cos) = V::signs(shifted, odd);
    let signed = r.change_signs(sign_of_sin);
    let sin_tail = polynomial::<F, V, FUSED, MANY>(|i| V::number(places::sin::<F>() + i), z, z2);
    let sin = mul_add(signed * z, sin_tail, signed);
    let cos_tail = polynomial::<F, V, FUSED, MANY>(|i| V::number(places::cos::<F>() + i), z, z2);
    let cos = if MANY {
        let cos = mul_add(z, mul_add(z, cos_tail, V::number(places::MINUS_HALF)), V::number(places::ONE));
        cos.change_signs(sign_of_cos)
    } else {
        // Both terms and not the sum, which all that follows waits for. Gain: `benches/README.md`.
        let most = mul_add(z, V::number(places::MINUS_HALF), V::number(places::ONE));
        mul_add(z2.change_signs(sign_of_cos), cos_tail, most.change_signs(sign_of_cos))
    };
    V::exchange(odd, sin, cos)
}

/// The same of angles that are there in pairs, sine and cosine side by side.
#[inline(always)]
fn pairs_within_domain<F: Float, V: Pairs<F>, const FUSED: bool>(x: V) -> V {
    let mul_add = abreast::mul_add::<F, V, FUSED>;
    let shifted = quarters::<F, V, FUSED>(x);
    let r = reduced::<F, V, FUSED>(x, shifted);
    let z = r * r;
    let z2 = z * z;
    let tail = polynomial::<F, V, FUSED, false>(|i| V::numbers(places::sin::<F>() + i, places::cos::<F>() + i), z, z2);
    let most = mul_add(z, V::number(places::MINUS_HALF), V::number(places::ONE));
    let signs = V::signs_of_pairs(shifted);
    let factor = V::sides(r, z).change_signs(signs);
    mul_add(z * factor, tail, V::sides(r, most).change_signs(signs)).exchange_pairs(V::odd(shifted))
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
        strange = strange.or(F::strange(quarters::<F, F, FUSED>(angles[i])));
        (sines[i], cosines[i]) = within_domain::<F, F, FUSED, true>(angles[i]);
    }
    strange.is_usual()
}

/// Sine and cosine of one angle.
#[inline]
pub(crate) fn sin_cos<F: Float>(angle: F) -> (F, F) {
    if cfg!(feature = "platform-trig") || !angle.is_in_domain() {
        return angle.platform_sin_cos();
    }
    within_domain::<F, F, FUSED, false>(angle)
}

/// Sines and cosines of several angles, `(sin, cos)` each.
///
/// Whole vectors of angles; of what is left, sines and cosines in one vector if
/// there is room, else one more vector filled up with the last angle.
///
/// Nothing here has its address taken on the way that is usual, so that angles
/// stay in registers, and results but for [`BY_MEMORY`]: numbers stored one by one
/// and loaded as a vector would have to wait for the cache.
#[inline(always)]
pub(crate) fn sin_cos_all<F: Float, const K: usize>(angles: [F; K]) -> [(F, F); K] {
    let lanes = F::Vector::LANES;
    let left = K % lanes;
    let in_pairs = if 2 * left <= lanes { left } else { 0 };
    let alone = K - in_pairs;
    let mut strange = F::Vector::number(0);
    for first in (0..alone).step_by(lanes) {
        let next = strangeness(F::Vector::gather(&angles, first));
        strange = if first == 0 { next } else { strange.or(next) };
    }
    if in_pairs > 0 {
        let last = strangeness(F::Vector::gather_pairs(&angles, alone));
        strange = if alone == 0 { last } else { strange.or(last) };
    }
    let within = !cfg!(feature = "platform-trig") && (K == 0 || strange.is_usual());
    // Both branches end in vectors. If they ended in numbers, the compiler would make other vectors of those.
    let mut vectors = [(F::Vector::number(0), F::Vector::number(0)); K];
    let mut pairs = F::Vector::number(0);
    if within {
        for first in (0..alone).step_by(lanes) {
            vectors[first / lanes] = within_domain::<F, F::Vector, FUSED, false>(F::Vector::gather(&angles, first));
        }
        if in_pairs > 0 {
            pairs = pairs_within_domain::<F, F::Vector, FUSED>(F::Vector::gather_pairs(&angles, alone));
        }
    } else {
        let copies = angles;
        let (sines, cosines) = one_by_one(&copies);
        for first in (0..alone).step_by(lanes) {
            vectors[first / lanes] = (F::Vector::gather(&sines, first), F::Vector::gather(&cosines, first));
        }
        if in_pairs > 0 {
            pairs = F::Vector::sides(F::Vector::gather_pairs(&sines, alone), F::Vector::gather_pairs(&cosines, alone));
        }
    }
    let mut out = [(F::ZERO, F::ZERO); K];
    for first in (0..alone).step_by(lanes) {
        let (sin, cos) = handed_on(vectors[first / lanes]);
        F::Vector::scatter(sin, cos, &mut out, first);
    }
    if in_pairs > 0 {
        handed_on(pairs).scatter_pairs(&mut out, alone);
    }
    out
}

/// Whether sines and cosines go to the algebra by way of memory, in programs that are
/// built for a machine with AVX-512 and not one of AMD's, which has SSE4a: what takes a
/// number out of a vector, or copies it into all lanes, takes a port of the products
/// there, a load does not. On AMD's the same costs H_x more than it saves.
/// Gain: `benches/README.md`.
const BY_MEMORY: bool = cfg!(all(target_feature = "avx512f", not(target_feature = "sse4a")));

#[inline(always)]
fn handed_on<V>(vectors: V) -> V {
    // It must be taken to have changed them in memory, so that they are loaded again.
    if BY_MEMORY { core::hint::black_box(vectors) } else { vectors }
}

#[inline(always)]
fn strangeness<F: Float, V: Vector<F>>(angles: V) -> V {
    V::strange(quarters::<F, V, FUSED>(angles))
}

#[cold]
#[inline(never)]
fn one_by_one<F: Float, const K: usize>(angles: &[F; K]) -> ([F; K], [F; K]) {
    let both = angles.map(F::platform_sin_cos);
    (both.map(|(sin, _)| sin), both.map(|(_, cos)| cos))
}
