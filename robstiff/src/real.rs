//! The scalars that generated code computes with.

use core::ops::Neg;

use nalgebra::{ClosedAddAssign, ClosedMulAssign, ClosedSubAssign, SVector};
use num_traits::{One, Zero};

use crate::{blocks, columns, trig};

/// A scalar that generated code can compute with: `f32`, `f64`, several of
/// them side by side ([`Lanes`](crate::Lanes)), with derivatives
/// ([`Dual`](crate::Dual)), and whatever else brings these few operations. For a
/// scalar of your own add `num-traits` to your dependencies: its `Zero` and `One` are
/// among them.
pub trait Real:
    nalgebra::Scalar + Copy + Zero + One + Neg<Output = Self> + ClosedAddAssign + ClosedSubAssign + ClosedMulAssign
{
    /// The nearest value to a constant of the description.
    fn of(value: f64) -> Self;

    /// Sine and cosine of an angle in rad.
    ///
    /// Those of `f64` are within 1.4e-15 of the truth, those of `f32` within 8e-7, however large
    /// the angle is: up to 1.6e6 and 3000 rad within 6.5e-16 and 3.3e-7 (of batches within
    /// 1.8e-16 and 9.4e-8). They take least time up to 3.236 rad (185 degrees). With the feature
    /// `platform-trig` they are the platform's (without the feature `std`, those of the crate
    /// libm), of angles that are [`wrapped`](Self::wrapped). An infinity or a NaN gives NaN.
    fn sin_cos(self) -> (Self, Self);

    /// Sines and cosines of several angles in rad, one pose's for instance:
    /// a scalar that computes them side by side is faster than one by one.
    #[inline]
    fn sin_cos_all<const K: usize>(angles: [Self; K]) -> [(Self, Self); K] {
        angles.map(Self::sin_cos)
    }

    /// An angle (rad) of more than 32 rad (five turns) less the whole turns nearest to it, any
    /// other angle as it is. Sine and cosine stay the same, those of sums with other angles, too:
    /// but a sum with a large angle would be rounded to the places that such an angle has.
    /// An infinity gives NaN.
    ///
    /// The default changes nothing.
    #[inline]
    fn wrapped(self) -> Self {
        self
    }

    /// Sines and cosines of angles (rad) that are sums of joint coordinates, or of whole
    /// multiples of them, and of constants: `angles` adds them. Coordinates of many turns are
    /// [`wrapped`](Self::wrapped) before, so that no place is lost in sums.
    ///
    /// Sums of up to 32 rad are rounded as any, which loses 2e-15 rad at most in `f64` and 1e-6 rad
    /// in `f32`. Beyond, nothing is lost but what a coordinate does not hold: its last place is
    /// 1e-10 rad at 1e6 rad in `f64`, and 1e-4 rad at 1000 rad in `f32`.
    #[inline(always)]
    fn sin_cos_of_sums<const N: usize, const K: usize>(
        q: &SVector<Self, N>,
        angles: impl Fn(&SVector<Self, N>) -> [Self; K],
    ) -> [(Self, Self); K] {
        Self::sin_cos_all(angles(&q.map(Self::wrapped)))
    }

    /// [`sin_cos_of_sums`](Self::sin_cos_of_sums), each times its factor, `(sin, cos)`. With
    /// factors that the compiler sees, those of `f64` and `f32` take as long as without: the
    /// constants that they are computed with are multiplied, or the angles before. Errors are
    /// those of [`sin_cos`](Self::sin_cos) times the factors, and the roundings of these
    /// products.
    #[inline(always)]
    fn scaled_sin_cos_of_sums<const N: usize, const K: usize>(
        q: &SVector<Self, N>,
        angles: impl Fn(&SVector<Self, N>) -> [Self; K],
        factors: [(Self, Self); K],
    ) -> [(Self, Self); K] {
        let mut all = Self::sin_cos_of_sums(q, angles);
        for ((sin, cos), (by_sin, by_cos)) in all.iter_mut().zip(factors) {
            *sin *= by_sin;
            *cos *= by_cos;
        }
        all
    }

    /// `self * factor + summand`; in one instruction, with one rounding, where
    /// the target has it.
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        self * factor + summand
    }

    /// Turns a compliance about z, all four of its blocks: what generated code
    /// calls where most entries are not zero, for scalars that hold the blocks
    /// in the lanes of a vector.
    ///
    /// Rows: the entries xx, xy, yy, xz and yz of displacement per force, of
    /// rotation per moment, of displacement per moment, and of that transposed.
    #[inline(always)]
    fn turn_blocks(rows: [[Self; 4]; 5], sin_cos: (Self, Self)) -> [[Self; 4]; 5] {
        blocks::turn(rows, sin_cos)
    }

    /// Whether four numbers side by side are scaled and added in one
    /// instruction: generated code then computes frames column by column.
    const COLUMNS: bool = false;

    /// A column of a homogeneous matrix times a factor.
    #[inline(always)]
    fn scaled(column: [Self; 4], factor: Self) -> [Self; 4] {
        columns::scaled(column, factor)
    }

    /// `column + other * factor`.
    #[inline(always)]
    fn plus_scaled(column: [Self; 4], other: [Self; 4], factor: Self) -> [Self; 4] {
        columns::plus_scaled(column, other, factor)
    }

    /// The product of two columns, entry by entry.
    #[inline(always)]
    fn product(column: [Self; 4], other: [Self; 4]) -> [Self; 4] {
        columns::product(column, other)
    }

    /// `column + other * by`, entry by entry.
    #[inline(always)]
    fn plus_product(column: [Self; 4], other: [Self; 4], by: [Self; 4]) -> [Self; 4] {
        columns::plus_product(column, other, by)
    }

    /// The column with y, z, x for its first three entries.
    #[inline(always)]
    fn cycled([x, y, z, w]: [Self; 4]) -> [Self; 4] {
        [y, z, x, w]
    }

    /// The column with 0 for its last entry, of which turns may make -0.
    #[inline(always)]
    fn direction(column: [Self; 4]) -> [Self; 4] {
        columns::direction(column)
    }

    /// The square root.
    fn sqrt(self) -> Self;

    /// `1 / self`.
    fn recip(self) -> Self;

    /// 1 with the sign of the number, for zero that of the zero.
    /// [`Dual`](crate::Dual) tells by it which of two numbers is the larger, and
    /// takes the slopes of that.
    ///
    /// The default takes a root, and of zero it is not a number; a scalar that
    /// can compare does better.
    #[inline]
    fn signum(self) -> Self {
        self * (self * self).sqrt().recip()
    }

    /// The larger of two numbers.
    #[inline]
    fn max(self, other: Self) -> Self {
        let apart = self - other;
        (self + other + (apart * apart).sqrt()) * Self::of(0.5)
    }

    /// The smaller of two numbers.
    #[inline]
    fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }
}

macro_rules! real {
    ($float:ident, $turn:ident, $sqrt:path) => {
        impl Real for $float {
            #[inline(always)]
            fn of(value: f64) -> Self {
                value as Self
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                trig::sin_cos(self)
            }

            #[inline(always)]
            fn sin_cos_all<const K: usize>(angles: [Self; K]) -> [(Self, Self); K] {
                trig::sin_cos_of_sums(angles, |angles| angles, None)
            }

            #[inline(always)]
            fn wrapped(self) -> Self {
                trig::wrapped(self)
            }

            #[inline(always)]
            fn sin_cos_of_sums<const N: usize, const K: usize>(
                q: &SVector<Self, N>,
                angles: impl Fn(&SVector<Self, N>) -> [Self; K],
            ) -> [(Self, Self); K] {
                trig::sin_cos_of_sums(q.data.0[0], move |q| angles(&SVector::from(q)), None)
            }

            #[inline(always)]
            fn scaled_sin_cos_of_sums<const N: usize, const K: usize>(
                q: &SVector<Self, N>,
                angles: impl Fn(&SVector<Self, N>) -> [Self; K],
                factors: [(Self, Self); K],
            ) -> [(Self, Self); K] {
                trig::sin_cos_of_sums(q.data.0[0], move |q| angles(&SVector::from(q)), Some(factors))
            }

            #[inline(always)]
            fn mul_add(self, factor: Self, summand: Self) -> Self {
                trig::mul_add::<Self, { trig::FUSED }>(self, factor, summand)
            }

            #[inline(always)]
            fn turn_blocks(rows: [[Self; 4]; 5], sin_cos: (Self, Self)) -> [[Self; 4]; 5] {
                blocks::$turn(rows, sin_cos)
            }

            const COLUMNS: bool = cfg!(all(target_feature = "avx", target_feature = "fma"));

            #[inline(always)]
            fn scaled(column: [Self; 4], factor: Self) -> [Self; 4] {
                columns::$float::scaled(column, factor)
            }

            #[inline(always)]
            fn plus_scaled(column: [Self; 4], other: [Self; 4], factor: Self) -> [Self; 4] {
                columns::$float::plus_scaled(column, other, factor)
            }

            #[inline(always)]
            fn product(column: [Self; 4], other: [Self; 4]) -> [Self; 4] {
                columns::$float::product(column, other)
            }

            #[inline(always)]
            fn plus_product(column: [Self; 4], other: [Self; 4], by: [Self; 4]) -> [Self; 4] {
                columns::$float::plus_product(column, other, by)
            }

            #[inline(always)]
            fn direction(column: [Self; 4]) -> [Self; 4] {
                columns::$float::direction(column)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                #[cfg(feature = "std")]
                return $float::sqrt(self);
                #[cfg(not(feature = "std"))]
                return $sqrt(self);
            }

            #[inline(always)]
            fn recip(self) -> Self {
                1.0 / self
            }

            #[inline(always)]
            fn signum(self) -> Self {
                $float::signum(self)
            }

            // One instruction, unlike the float's own, which look for NaN.
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
        }
    };
}

real!(f32, turn_f32, libm::sqrtf);
real!(f64, turn_f64, libm::sqrt);
