//! Sines and cosines of several angles side by side.
//!
//! The platform's `sin` takes one angle, and takes most of the time of a
//! compliance. Here all angles of a pose, or of several poses, go the same way, side by side
//! in the lanes of vectors ([`Abreast`]):
//!
//! - those of a pose, which waits more than it computes, into polynomials of whole angles
//!   ([`near`]), within [`Float::BOUND_OF_POSES`] of the truth. Joint coordinates of more than
//!   five turns lose whole turns before they are added ([`wrapped`]);
//! - those of batches into shorter polynomials of what is left when multiples of pi/2 are
//!   taken away ([`reduced`]), within [`Float::BOUND`], or into tables where these are
//!   faster: with AVX2 in memory (`circle.rs`), of `f64` with AVX-512 in registers
//!   (`tables.rs`);
//! - where one of a block of a batch is beyond [`Float::DOMAIN`], an infinity or a NaN, all of
//!   the block as those of poses. Beyond the domain whole turns are taken away in whole numbers
//!   (`payne_hanek.rs`), which is exact however large an angle is.
//!
//! Everywhere `sin 0 = 0`, `cos 0 = 1`, and the symmetries of sine and cosine hold exactly.
//!
//! Gain: `benches/README.md`. The feature `platform-trig` takes all this out.

mod abreast;
#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub(crate) mod circle;
mod float;
mod near;
mod payne_hanek;
mod reduced;
#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub(crate) mod tables;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod turns_tests;
mod vectors;

use abreast::{Abreast, Pairs, Vector};
pub(crate) use float::{FEW_TURNS, FUSED, Float};
pub(crate) use reduced::{sin_cos_each, within_domain};

/// `a * b + c`, rounded once if `FUSED`.
#[inline(always)]
pub(crate) fn mul_add<F: Float, const FUSED: bool>(a: F, b: F, c: F) -> F {
    abreast::mul_add::<F, F, FUSED>(a, b, c)
}

/// An angle of many turns less whole turns, any other as it is: its sine and cosine stay, but
/// it loses no place where something is added to it.
#[inline(always)]
pub(crate) fn wrapped<F: Float>(angle: F) -> F {
    if angle.is_few_turns() { angle } else { without_turns(angle) }
}

#[cold]
#[inline(never)]
fn without_turns<F: Float>(angle: F) -> F {
    if angle.is_in_domain() { near::wrapped::<F, F, FUSED>(angle) } else { angle.without_turns() }
}

/// Sine and cosine of one angle.
#[inline]
pub(crate) fn sin_cos<F: Float>(angle: F) -> (F, F) {
    if cfg!(feature = "platform-trig") {
        return wrapped(angle).platform_sin_cos();
    }
    if !near::room::<F, F>(angle).is_negative_somewhere() {
        return near::sin_cos::<F, F, FUSED>(angle);
    }
    near::sin_cos::<F, F, FUSED>(near::wrapped::<F, F, FUSED>(wrapped(angle)))
}

/// The angles of a pose in vectors: whole ones and, of what is left, each twice if there is
/// room for sines and cosines in one vector; else one more vector filled up with the last angle.
#[derive(Clone, Copy)]
struct Angles<F: Float, const K: usize> {
    whole: [F::Vector; K],
    in_pairs: F::Vector,
}

impl<F: Float, const K: usize> Angles<F, K> {
    const LANES: usize = <F::Vector as Vector<F>>::LANES;
    const IN_PAIRS: usize = if 2 * (K % Self::LANES) <= Self::LANES { K % Self::LANES } else { 0 };
    const ALONE: usize = K - Self::IN_PAIRS;
    const WHOLE: usize = Self::ALONE.div_ceil(Self::LANES);

    #[inline(always)]
    fn gather(angles: &[F; K]) -> Self {
        let mut gathered = Self { whole: [F::Vector::number(0); K], in_pairs: F::Vector::number(0) };
        for (i, vector) in gathered.whole.iter_mut().enumerate().take(Self::WHOLE) {
            *vector = F::Vector::gather(angles, i * Self::LANES);
        }
        if Self::IN_PAIRS > 0 {
            gathered.in_pairs = F::Vector::gather_pairs(angles, Self::ALONE);
        }
        gathered
    }

    #[inline(always)]
    fn map(mut self, each: impl Fn(F::Vector) -> F::Vector) -> Self {
        for vector in self.whole.iter_mut().take(Self::WHOLE) {
            *vector = each(*vector);
        }
        if Self::IN_PAIRS > 0 {
            self.in_pairs = each(self.in_pairs);
        }
        self
    }

    /// Sines and cosines of whole vectors, and the pairs of both, times constants if these
    /// are there.
    #[inline(always)]
    fn sin_cos(self, factors: Option<(Self, Self)>) -> ([F::Vector; K], [F::Vector; K], F::Vector) {
        let (mut sines, mut cosines, mut pairs) = (self.whole, self.whole, self.in_pairs);
        for i in 0..Self::WHOLE {
            (sines[i], cosines[i]) = match factors {
                None => near::sin_cos::<F, F::Vector, FUSED>(self.whole[i]),
                Some((by_sin, by_cos)) => {
                    near::scaled_sin_cos::<F, F::Vector, FUSED>(self.whole[i], (by_sin.whole[i], by_cos.whole[i]))
                }
            };
        }
        if Self::IN_PAIRS > 0 {
            let by = factors.map(|(by_sin, by_cos)| F::Vector::sides(by_sin.in_pairs, by_cos.in_pairs));
            pairs = near::pairs::<F, F::Vector, FUSED>(self.in_pairs, by);
        }
        (sines, cosines, pairs)
    }

    /// Whether some number of a vector has the sign of a negative one.
    #[inline(always)]
    fn is_negative_somewhere(self) -> bool {
        if Self::WHOLE == 0 {
            return Self::IN_PAIRS > 0 && self.in_pairs.is_negative_somewhere();
        }
        let mut bits = self.whole[0];
        // Not by an iterator, which is not unrolled.
        for i in 1..Self::WHOLE {
            bits = bits.or(self.whole[i]);
        }
        if Self::IN_PAIRS > 0 {
            bits = bits.or(self.in_pairs);
        }
        bits.is_negative_somewhere()
    }
}

/// Sines and cosines of several angles, `(sin, cos)` each, times constants if these are there.
/// The angles are sums of whole multiples of coordinates, and of constants, as `angles` adds
/// them.
///
/// Nothing here has its address taken on the way that is usual, so that angles
/// stay in registers, and results but for [`BY_MEMORY`]: numbers stored one by one
/// and loaded as a vector would have to wait for the cache.
#[inline(always)]
pub(crate) fn sin_cos_of_sums<F: Float, const N: usize, const K: usize>(
    coordinates: [F; N],
    angles: impl Fn([F; N]) -> [F; K],
    factors: Option<[(F, F); K]>,
) -> [(F, F); K] {
    let mut gathered = Angles::gather(&angles(coordinates));
    let are_near = !gathered.map(near::room).is_negative_somewhere();
    let are_many_turns = !are_near && gathered.map(near::room_in_few_turns).is_negative_somewhere();
    // Both branches end in vectors. If they ended in numbers, the compiler would make other vectors of those. The call
    // leads back to none of what is usual, and gets how angles are added as a value: else there would be a frame.
    let (sines, cosines, pairs) = if cfg!(feature = "platform-trig") || are_many_turns {
        let copies = coordinates;
        let (mut sines, mut cosines) = one_by_one(&copies, angles);
        if let Some(factors) = factors {
            for (i, (by_sin, by_cos)) in factors.into_iter().enumerate() {
                (sines[i], cosines[i]) = (sines[i] * by_sin, cosines[i] * by_cos);
            }
        }
        let (sines, cosines) = (Angles::gather(&sines), Angles::gather(&cosines));
        (sines.whole, cosines.whole, F::Vector::sides(sines.in_pairs, cosines.in_pairs))
    } else {
        if !are_near {
            gathered = gathered.map(near::wrapped::<F, F::Vector, FUSED>);
        }
        gathered.sin_cos(factors.map(|factors| {
            let (by_sin, by_cos) = (factors.map(|(by_sin, _)| by_sin), factors.map(|(_, by_cos)| by_cos));
            (Angles::gather(&by_sin), Angles::gather(&by_cos))
        }))
    };
    let mut out = [(F::ZERO, F::ZERO); K];
    for i in 0..Angles::<F, K>::WHOLE {
        let (sin, cos) = handed_on((sines[i], cosines[i]));
        F::Vector::scatter(sin, cos, &mut out, i * Angles::<F, K>::LANES);
    }
    if Angles::<F, K>::IN_PAIRS > 0 {
        handed_on(pairs).scatter_pairs(&mut out, Angles::<F, K>::ALONE);
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

#[cold]
#[inline(never)]
fn one_by_one<F: Float, const N: usize, const K: usize>(
    coordinates: &[F; N],
    angles: impl Fn([F; N]) -> [F; K],
) -> ([F; K], [F; K]) {
    let both = angles(coordinates.map(wrapped)).map(sin_cos);
    (both.map(|(sin, _)| sin), both.map(|(_, cos)| cos))
}
