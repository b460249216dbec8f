//! What is computed with abreast: single numbers, and the vectors of the crate `wide`.

use super::abreast::{Abreast, Pairs, Vector};
use super::float::{Float, double, single};

macro_rules! single {
    ($float:ident, $module:ident, $fma:path) => {
        impl Abreast<$float> for $float {
            #[inline(always)]
            fn number(place: usize) -> Self {
                Self::NUMBERS[place]
            }

            #[inline(always)]
            fn fused(self, a: Self, b: Self) -> Self {
                #[cfg(feature = "std")]
                return self.mul_add(a, b);
                #[cfg(not(feature = "std"))]
                return $fma(self, a, b);
            }

            #[inline(always)]
            fn or(self, other: Self) -> Self {
                Self::from_bits(self.to_bits() | other.to_bits())
            }

            #[inline(always)]
            fn is_negative_somewhere(self) -> bool {
                self.is_sign_negative()
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

/// A single number is a full vector: nothing is left.
impl<F: Float> Pairs<F> for F {
    #[inline(always)]
    fn gather_pairs<const K: usize>(angles: &[F; K], first: usize) -> Self {
        angles[first]
    }

    #[inline(always)]
    fn scatter_pairs<const K: usize>(self, _: &mut [(F, F); K], _: usize) {}

    #[inline(always)]
    fn numbers(sin: usize, _: usize) -> Self {
        F::number(sin)
    }

    #[inline(always)]
    fn sides(sin: Self, _: Self) -> Self {
        sin
    }

    #[inline(always)]
    fn sines_beside_ones(self) -> Self {
        self
    }
}

single!(f32, single, libm::fmaf);
single!(f64, double, libm::fma);

macro_rules! vectors {
    ($($vector:ident $float:ident $module:ident $lanes:literal)*) => {$(
        impl Abreast<$float> for wide::$vector {
            #[inline(always)]
            fn number(place: usize) -> Self {
                Self::new(*$module::SPREAD.0[place].first_chunk().expect("at least as many lanes"))
            }

            #[inline(always)]
            fn fused(self, a: Self, b: Self) -> Self {
                self.mul_add(a, b)
            }

            #[inline(always)]
            fn or(self, other: Self) -> Self {
                Self::from_bits(self.to_bits() | other.to_bits())
            }

            #[inline(always)]
            fn is_negative_somewhere(self) -> bool {
                self.to_bitmask() != 0
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

        impl Pairs<$float> for wide::$vector {
            #[inline(always)]
            fn gather_pairs<const K: usize>(angles: &[$float; K], first: usize) -> Self {
                let mut lanes = [0.0; $lanes];
                for (lane, own) in lanes.iter_mut().enumerate() {
                    *own = angles[if first + lane / 2 < K { first + lane / 2 } else { K - 1 }];
                }
                Self::new(lanes)
            }

            #[inline(always)]
            fn scatter_pairs<const K: usize>(self, out: &mut [($float, $float); K], first: usize) {
                let (pairs, _) = self.as_array().as_chunks::<2>();
                for (out, &[sin, cos]) in out[first..].iter_mut().zip(pairs) {
                    *out = (sin, cos);
                }
            }

            #[inline(always)]
            fn numbers(sin: usize, cos: usize) -> Self {
                let mut lanes = [0.0; $lanes];
                for (lane, own) in lanes.iter_mut().enumerate() {
                    *own = $module::NUMBERS[if lane % 2 == 0 { sin } else { cos }];
                }
                Self::new(lanes)
            }

            #[inline(always)]
            fn sides(sin: Self, cos: Self) -> Self {
                let (mut lanes, cos) = (sin.to_array(), cos.to_array());
                for lane in 0..$lanes / 2 {
                    lanes[2 * lane + 1] = cos[2 * lane + 1];
                }
                Self::new(lanes)
            }

            #[inline(always)]
            fn sines_beside_ones(self) -> Self {
                let mut lanes = self.to_array();
                for lane in 0..$lanes / 2 {
                    lanes[2 * lane + 1] = 1.0;
                }
                Self::new(lanes)
            }
        }
    )*};
}

vectors! {
    f32x4 f32 single 4
    f64x2 f64 double 2
    f32x8 f32 single 8
    f64x4 f64 double 4
}
