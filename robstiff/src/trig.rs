//! Sines and cosines of several angles side by side.
//!
//! The platform's `sin` takes one angle, and takes most of the time of a
//! compliance. Here all angles of a pose, or of several poses, go the same way, side by side
//! in the lanes of vectors ([`Abreast`]). Which way that is for one pose, a
//! single comparison tells:
//!
//! - where all of them are [`near`], polynomials of the angles as they are, within
//!   [`Float::NEAR_BOUND`] of the truth;
//! - where some are not, up to [`Float::DOMAIN`], polynomials of the angles less multiples of
//!   pi/2 ([`reduced`]), within [`Float::BOUND`];
//! - where one is beyond that, an infinity or a NaN, the platform's functions.
//!
//! Batches, which compute more than they wait, take all angles as [`reduced`] does, or have
//! tables where these are faster: with AVX2 in memory (`circle.rs`), of `f64` with AVX-512 in
//! registers (`tables.rs`).
//!
//! Everywhere `sin 0 = 0`, `cos 0 = 1`, and the symmetries of sine and cosine hold exactly.
//!
//! Gain: `benches/README.md`. The feature `platform-trig` takes all this out.

mod abreast;
#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub(crate) mod circle;
mod float;
mod near;
mod reduced;
#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub(crate) mod tables;
#[cfg(all(test, feature = "std"))]
mod tests;

use abreast::{Abreast, Pairs, Vector};
pub(crate) use float::{FUSED, Float};
pub(crate) use reduced::{sin_cos_each, within_domain};

/// `a * b + c`, rounded once if `FUSED`.
#[inline(always)]
pub(crate) fn mul_add<F: Float, const FUSED: bool>(a: F, b: F, c: F) -> F {
    abreast::mul_add::<F, F, FUSED>(a, b, c)
}

/// Sine and cosine of one angle.
#[inline]
pub(crate) fn sin_cos<F: Float>(angle: F) -> (F, F) {
    if !cfg!(feature = "platform-trig") {
        if !near::room::<F, F>(angle).is_negative_somewhere() {
            return near::sin_cos::<F, F, FUSED>(angle);
        }
        if angle.is_in_domain() {
            return within_domain::<F, F, FUSED>(angle);
        }
    }
    angle.platform_sin_cos()
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
    let mut room = F::Vector::number(0);
    for first in (0..alone).step_by(lanes) {
        let next = near::room(F::Vector::gather(&angles, first));
        room = if first == 0 { next } else { room.or(next) };
    }
    if in_pairs > 0 {
        let last = near::room(F::Vector::gather_pairs(&angles, alone));
        room = if alone == 0 { last } else { room.or(last) };
    }
    let are_near = !cfg!(feature = "platform-trig") && !room.is_negative_somewhere();
    // Both branches end in vectors. If they ended in numbers, the compiler would make other vectors of those.
    let mut vectors = [(F::Vector::number(0), F::Vector::number(0)); K];
    let mut pairs = F::Vector::number(0);
    if are_near {
        for first in (0..alone).step_by(lanes) {
            vectors[first / lanes] = near::sin_cos::<F, F::Vector, FUSED>(F::Vector::gather(&angles, first));
        }
        if in_pairs > 0 {
            pairs = near::pairs::<F, F::Vector, FUSED>(F::Vector::gather_pairs(&angles, alone));
        }
    } else {
        let copies = angles;
        let (sines, cosines) = far(&copies);
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

/// Sines and cosines of angles of which one or more are not near; a function of its own, so
/// that callers are not twice as long.
#[cold]
#[inline(never)]
fn far<F: Float, const K: usize>(angles: &[F; K]) -> ([F; K], [F; K]) {
    let mut both = [(F::ZERO, F::ZERO); K];
    if !cfg!(feature = "platform-trig") && angles.iter().all(|angle| angle.is_in_domain()) {
        // Whole vectors only: of the last one, some lanes compute the same.
        for first in (0..K).step_by(F::Vector::LANES) {
            let (sin, cos) = within_domain::<F, F::Vector, FUSED>(F::Vector::gather(angles, first));
            F::Vector::scatter(sin, cos, &mut both, first);
        }
    } else {
        both = angles.map(F::platform_sin_cos);
    }
    (both.map(|(sin, _)| sin), both.map(|(_, cos)| cos))
}
