//! Numbers side by side: a single one, or the lanes of a vector register.
//!
//! Of the batches' loops over single numbers the compiler makes vectors by
//! itself. In the few angles of one pose it does not see them: there they are
//! said to be vectors, with those of the crate `wide`.

use core::ops::{Add, Mul, Sub};

/// One number or several, which one operation computes with.
pub(crate) trait Abreast<F>: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// One of [`Float::NUMBERS`](super::float::Float::NUMBERS) in every lane.
    fn number(place: usize) -> Self;

    /// `self * a + b`, rounded once.
    fn fused(self, a: Self, b: Self) -> Self;

    /// The bits of both.
    fn or(self, other: Self) -> Self;

    /// Whether one of them has the sign of a negative number.
    fn is_negative_somewhere(self) -> bool;
}

/// `a * b + c`, rounded once if `FUSED`.
#[inline(always)]
pub(crate) fn mul_add<F, V: Abreast<F>, const FUSED: bool>(a: V, b: V, c: V) -> V {
    if FUSED { a.fused(b, c) } else { a * b + c }
}

/// Numbers side by side that are put there from an array.
pub(crate) trait Vector<F>: Abreast<F> {
    /// How many.
    const LANES: usize;

    /// The angles from `first` on; after the last one, that one again.
    fn gather<const K: usize>(angles: &[F; K], first: usize) -> Self;

    /// Writes `(sin, cos)` of the angles from `first` on.
    fn scatter<const K: usize>(sin: Self, cos: Self, out: &mut [(F, F); K], first: usize);
}

/// Numbers in pairs of neighbouring lanes, for the sine and the cosine of one
/// angle: both polynomials at once.
pub(crate) trait Pairs<F>: Vector<F> {
    /// The angles from `first` on, each twice.
    fn gather_pairs<const K: usize>(angles: &[F; K], first: usize) -> Self;

    /// Writes `(sin, cos)` of the angles from `first` on.
    fn scatter_pairs<const K: usize>(self, out: &mut [(F, F); K], first: usize);

    /// One of [`Float::NUMBERS`](super::float::Float::NUMBERS) for the sines, another for the cosines.
    fn numbers(sin: usize, cos: usize) -> Self;

    /// The sines' lanes of one, the cosines' of another.
    fn sides(sin: Self, cos: Self) -> Self;

    /// Its own numbers in the sines' lanes, 1 in the cosines'.
    fn sines_beside_ones(self) -> Self;
}

/// The vectors of the target. Those of AVX-512 would hold all angles of a pose
/// at once and take more time to fill, to compute with and to empty than two of
/// these (H_x 35 ns, with these 30).
pub(crate) mod target {
    macro_rules! target {
        ($cfg:meta, $single:ty, $double:ty) => {
            #[cfg($cfg)]
            #[expect(non_camel_case_types, reason = "named as what they hold")]
            pub type single = $single;
            #[cfg($cfg)]
            #[expect(non_camel_case_types, reason = "named as what they hold")]
            pub type double = $double;
        };
    }
    target!(target_feature = "avx", wide::f32x8, wide::f64x4);
    target!(
        all(not(target_feature = "avx"), any(target_feature = "sse2", target_feature = "neon")),
        wide::f32x4,
        wide::f64x2
    );
    target!(not(any(target_feature = "avx", target_feature = "sse2", target_feature = "neon")), f32, f64);
}
