//! The scalars that generated code computes with.

use core::ops::Neg;

use nalgebra::{ClosedAddAssign, ClosedMulAssign, ClosedSubAssign};
use num_traits::{One, Zero};

/// A scalar that generated code can compute with: `f32`, `f64`, and whatever
/// else brings these few operations.
pub trait Real:
    nalgebra::Scalar + Copy + Zero + One + Neg<Output = Self> + ClosedAddAssign + ClosedSubAssign + ClosedMulAssign
{
    /// The nearest value to a constant of the description.
    fn of(value: f64) -> Self;

    /// Sine and cosine of an angle in rad.
    fn sin_cos(self) -> (Self, Self);

    /// Sines and cosines of several angles in rad, one pose's for instance:
    /// a scalar that computes them side by side is faster than one by one.
    #[inline]
    fn sin_cos_all<const K: usize>(angles: [Self; K]) -> [(Self, Self); K] {
        angles.map(Self::sin_cos)
    }

    /// The square root.
    fn sqrt(self) -> Self;

    /// `1 / self`.
    fn recip(self) -> Self;
}

macro_rules! real {
    ($float:ident, $sincos:path, $sqrt:path) => {
        impl Real for $float {
            #[inline]
            fn of(value: f64) -> Self {
                value as Self
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                #[cfg(feature = "std")]
                return $float::sin_cos(self);
                #[cfg(not(feature = "std"))]
                return $sincos(self);
            }

            #[inline]
            fn sqrt(self) -> Self {
                #[cfg(feature = "std")]
                return $float::sqrt(self);
                #[cfg(not(feature = "std"))]
                return $sqrt(self);
            }

            #[inline]
            fn recip(self) -> Self {
                1.0 / self
            }
        }
    };
}

real!(f32, libm::sincosf, libm::sqrtf);
real!(f64, libm::sincos, libm::sqrt);
