//! Angles whose sines and cosines are known.

use core::ops::{Add, AddAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use nalgebra::SVector;
use num_traits::{One, Zero};

use super::Float;
use crate::{Real, trig};

/// A number that brings its sine and cosine along, so that trigonometry is a
/// pass of its own: with it in the same loop as the algebra, neither fits into
/// the registers. Sums and differences of such angles, and of one with a number,
/// know theirs by the addition theorem, and where nobody asks, the compiler drops
/// it all. Any other number computes them when asked.
///
/// `FUSED`: the code around has an instruction that multiplies and adds.
#[derive(Clone, Copy, Debug)]
pub struct Known<T, const FUSED: bool> {
    pub value: T,
    /// Sine and cosine of the number less `apart`.
    sin_cos: (T, T),
    is_known: bool,
    /// Those numbers of the sum whose sines nobody knows yet. They are computed
    /// when somebody asks, not in every sum: the compiler, which inlines all sums
    /// before it sees which of them are of angles, would take four times as long.
    apart: T,
    is_apart: bool,
}

impl<T: Float, const FUSED: bool> Known<T, FUSED> {
    #[inline(always)]
    pub fn number(value: T) -> Self {
        Self { value, sin_cos: (T::ZERO, T::ONE), is_known: false, apart: value, is_apart: true }
    }

    #[inline(always)]
    pub fn angle(value: T, sin: T, cos: T) -> Self {
        Self { value, sin_cos: (sin, cos), is_known: true, apart: T::ZERO, is_apart: false }
    }
}

impl<T: Float, const FUSED: bool> PartialEq for Known<T, FUSED> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

#[inline(always)]
fn mul_add<T: Float, const FUSED: bool>(a: T, b: T, c: T) -> T {
    trig::mul_add::<T, FUSED>(a, b, c)
}

/// Sine and cosine of a sum.
#[inline(always)]
fn addition_theorem<T: Float, const FUSED: bool>((s, c): (T, T), (t, d): (T, T)) -> (T, T) {
    (mul_add::<T, FUSED>(s, d, c * t), mul_add::<T, FUSED>(c, d, -(s * t)))
}

impl<T: Float, const FUSED: bool> Add for Known<T, FUSED> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let value = self.value + other.value;
        let sin_cos = match (self.is_known, other.is_known) {
            (false, false) => return Self::number(value),
            (true, false) => self.sin_cos,
            (false, true) => other.sin_cos,
            (true, true) => addition_theorem::<T, FUSED>(self.sin_cos, other.sin_cos),
        };
        let apart = match (self.is_apart, other.is_apart) {
            (true, false) => self.apart,
            (false, true) => other.apart,
            _ => self.apart + other.apart,
        };
        Self { value, sin_cos, is_known: true, apart, is_apart: self.is_apart || other.is_apart }
    }
}

impl<T: Float, const FUSED: bool> Neg for Known<T, FUSED> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let (sin, cos) = self.sin_cos;
        Self { value: -self.value, sin_cos: (-sin, cos), apart: -self.apart, ..self }
    }
}

impl<T: Float, const FUSED: bool> Sub for Known<T, FUSED> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<T: Float, const FUSED: bool> Mul for Known<T, FUSED> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::number(self.value * other.value)
    }
}

macro_rules! assign {
    ($($trait:ident $method:ident $operation:ident)*) => {$(
        impl<T: Float, const FUSED: bool> $trait for Known<T, FUSED> {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                *self = self.$operation(other);
            }
        }
    )*};
}

assign! { AddAssign add_assign add  SubAssign sub_assign sub  MulAssign mul_assign mul }

impl<T: Float, const FUSED: bool> Zero for Known<T, FUSED> {
    #[inline(always)]
    fn zero() -> Self {
        Self::number(T::ZERO)
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.value == T::ZERO
    }
}

impl<T: Float, const FUSED: bool> One for Known<T, FUSED> {
    #[inline(always)]
    fn one() -> Self {
        Self::number(T::ONE)
    }
}

impl<T: Float, const FUSED: bool> Real for Known<T, FUSED> {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self::number(T::of(value))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = match (self.is_known, self.is_apart) {
            (true, false) => self.sin_cos,
            (true, true) => {
                let apart = if !cfg!(feature = "platform-trig") && self.apart.is_in_domain() {
                    // Of a constant, this costs nothing: the compiler does it.
                    trig::within_domain::<T, FUSED>(self.apart)
                } else {
                    trig::sin_cos(self.apart)
                };
                addition_theorem::<T, FUSED>(self.sin_cos, apart)
            }
            (false, _) => trig::sin_cos(self.value),
        };
        (Self::number(sin), Self::number(cos))
    }

    #[inline(always)]
    fn sin_cos_all<const K: usize>(angles: [Self; K]) -> [(Self, Self); K] {
        // Not `map`, which is not always inlined.
        let mut out = [(Self::zero(), Self::zero()); K];
        for i in 0..K {
            out[i] = angles[i].sin_cos();
        }
        out
    }

    /// The sine of each coordinate is known, so no sum is rounded.
    #[inline(always)]
    fn sin_cos_of_sums<const N: usize, const K: usize>(
        q: &SVector<Self, N>,
        angles: impl Fn(&SVector<Self, N>) -> [Self; K],
    ) -> [(Self, Self); K] {
        Self::sin_cos_all(angles(q))
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        Self::number(mul_add::<T, FUSED>(self.value, factor.value, summand.value))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::number(Real::sqrt(self.value))
    }

    #[inline(always)]
    fn recip(self) -> Self {
        Self::number(Real::recip(self.value))
    }

    #[inline(always)]
    fn signum(self) -> Self {
        Self::number(Real::signum(self.value))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::number(Real::max(self.value, other.value))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::number(Real::min(self.value, other.value))
    }
}
