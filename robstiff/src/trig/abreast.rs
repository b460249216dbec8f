//! Numbers side by side: a single one, or the lanes of a vector register.
//!
//! Of the batches' loops over single numbers the compiler makes vectors by
//! itself. In the few angles of one pose it does not see them: there they are
//! said to be vectors, with those of the crate `wide`.

use core::ops::{Add, Mul, Sub};

use super::float::Float;

/// One number or several, which one operation computes with.
pub(crate) trait Abreast<F>: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The same number in every lane.
    fn splat(x: F) -> Self;

    /// `self * a + b`, rounded once.
    fn fused(self, a: Self, b: Self) -> Self;

    /// Sine and cosine of as many quarter turns more as the last bits of
    /// `shifted` say. The last bit exchanges the two, one of them with a
    /// changed sign; the one before changes the signs of both.
    fn turn_quarters(shifted: Self, sin: Self, cos: Self) -> (Self, Self);

    /// Whether every lane is an angle within the domain; false for a NaN.
    fn is_within_domain(self) -> bool;
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

macro_rules! single {
    ($float:ident, $bits:ident, $signed:ident, $fma:path) => {
        impl Abreast<$float> for $float {
            #[inline(always)]
            fn splat(x: $float) -> Self {
                x
            }

            #[inline(always)]
            fn fused(self, a: Self, b: Self) -> Self {
                #[cfg(feature = "std")]
                return self.mul_add(a, b);
                #[cfg(not(feature = "std"))]
                return $fma(self, a, b);
            }

            #[inline(always)]
            fn turn_quarters(shifted: Self, sin: Self, cos: Self) -> (Self, Self) {
                const TOP: $bits = 1 << ($bits::BITS - 1);
                let last = shifted.to_bits() << ($bits::BITS - 1);
                let sign = (shifted.to_bits() << ($bits::BITS - 2)) & TOP;
                let (sin, cos) = (sin.to_bits() ^ last, cos.to_bits());
                // A mask and not a choice: without SSE4.1 there is no other way.
                let exchange = (sin ^ cos) & ((last as $signed) >> ($bits::BITS - 1)) as $bits;
                (Self::from_bits(sin ^ exchange ^ sign), Self::from_bits(cos ^ exchange ^ sign))
            }

            #[inline(always)]
            fn is_within_domain(self) -> bool {
                self.abs() <= Self::DOMAIN
            }
        }
    };
}

/// For targets without vectors.
impl<F: Float> Vector<F> for F {
    const LANES: usize = 1;

    #[inline(always)]
    fn gather<const K: usize>(angles: &[F; K], first: usize) -> Self {
        angles[first]
    }

    #[inline(always)]
    fn scatter<const K: usize>(sin: Self, cos: Self, out: &mut [(F, F); K], first: usize) {
        out[first] = (sin, cos);
    }
}

single!(f32, u32, i32, libm::fmaf);
single!(f64, u64, i64, libm::fma);

macro_rules! vectors {
    ($($vector:ident $bits:ident $float:ident $lanes:literal $width:literal)*) => {$(
        impl Abreast<$float> for wide::$vector {
            #[inline(always)]
            fn splat(x: $float) -> Self {
                wide::$vector::splat(x)
            }

            #[inline(always)]
            fn fused(self, a: Self, b: Self) -> Self {
                self.mul_add(a, b)
            }

            #[inline(always)]
            fn turn_quarters(shifted: Self, sin: Self, cos: Self) -> (Self, Self) {
                let top = wide::$bits::splat(1 << ($width - 1));
                let shifted = shifted.to_bits();
                let last = shifted << ($width - 1);
                let sin = Self::from_bits(sin.to_bits() ^ last);
                let sign = (shifted << ($width - 2)) & top;
                // A blend looks at the first bit only; without one, all bits.
                let exchange = if cfg!(target_feature = "sse4.1") {
                    Self::from_bits(last)
                } else {
                    Self::from_bits(wide::$bits::splat(0) - (shifted & wide::$bits::splat(1)))
                };
                let (sin, cos) = (exchange.select(cos, sin), exchange.select(sin, cos));
                (Self::from_bits(sin.to_bits() ^ sign), Self::from_bits(cos.to_bits() ^ sign))
            }

            #[inline(always)]
            fn is_within_domain(self) -> bool {
                self.abs().simd_le(Self::splat($float::DOMAIN)).all()
            }
        }

        impl Vector<$float> for wide::$vector {
            const LANES: usize = $lanes;

            #[inline(always)]
            fn gather<const K: usize>(angles: &[$float; K], first: usize) -> Self {
                let mut lanes = [0.0; $lanes];
                for (lane, own) in lanes.iter_mut().enumerate() {
                    *own = angles[if first + lane < K { first + lane } else { K - 1 }];
                }
                Self::new(lanes)
            }

            #[inline(always)]
            fn scatter<const K: usize>(sin: Self, cos: Self, out: &mut [($float, $float); K], first: usize) {
                let (sin, cos) = (sin.to_array(), cos.to_array());
                for lane in 0..$lanes {
                    if first + lane < K {
                        out[first + lane] = (sin[lane], cos[lane]);
                    }
                }
            }
        }
    )*};
}

/// The vectors of the target. Those of AVX-512 would hold all angles of a pose
/// at once and take more time to fill, to compute with and to empty than two of
/// these (H_x 35 ns, with these 30).
pub(crate) mod target {
    #[cfg(all(not(target_feature = "avx"), any(target_feature = "sse2", target_feature = "neon")))]
    pub use wide::{f32x4 as F32, f64x2 as F64};
    #[cfg(target_feature = "avx")]
    pub use wide::{f32x8 as F32, f64x4 as F64};
    #[cfg(not(any(target_feature = "avx", target_feature = "sse2", target_feature = "neon")))]
    pub use {f32 as F32, f64 as F64};
}

vectors! {
    f32x4 u32x4 f32 4 32
    f64x2 u64x2 f64 2 64
    f32x8 u32x8 f32 8 32
    f64x4 u64x4 f64 4 64
}
