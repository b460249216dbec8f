//! Which joint coordinates a quantity needs, and in what form.

use core::ops::{Add, AddAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use nalgebra::SVector;
use num_traits::{One, Zero};

use crate::Real;

/// A set of joint coordinates: bit `j` for the value of joint `j`, bit 32 more
/// for its sine and cosine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Needs(u64);

impl Needs {
    /// Those, and what a number was computed from.
    #[inline(always)]
    pub fn add(&mut self, number: Traced) {
        self.0 |= number.value;
    }

    #[inline(always)]
    pub fn value(self, joint: usize) -> bool {
        self.0 & bit(joint) != 0
    }

    #[inline(always)]
    pub fn sin_cos(self, joint: usize) -> bool {
        self.0 & (bit(joint) << 32) != 0
    }
}

/// From joint 31 on, joints share a bit: more is needed then, not less.
#[inline(always)]
fn bit(joint: usize) -> u64 {
    1 << if joint < 31 { joint } else { 31 }
}

/// A number that is none, but knows what it was computed from. Code that has no
/// loops and branches is computed with these by the compiler.
///
/// It behaves as [`Known`](super::known::Known): sums of angles are angles.
#[derive(Clone, Copy, Debug)]
pub struct Traced {
    /// What the number itself is computed from.
    value: u64,
    /// What its sine and cosine are computed from.
    sin_cos: u64,
    /// Whether these are known.
    is_angle: bool,
}

impl Traced {
    /// What depends on no joint.
    pub const NUMBER: Self = Self::number(0);

    /// The coordinate of a joint.
    #[inline(always)]
    pub fn joint(joint: usize) -> Self {
        Self { value: bit(joint), sin_cos: bit(joint) << 32, is_angle: true }
    }

    #[inline(always)]
    const fn number(value: u64) -> Self {
        Self { value, sin_cos: value, is_angle: false }
    }

    #[inline(always)]
    fn sum(self, other: Self) -> Self {
        let value = self.value | other.value;
        if self.is_angle || other.is_angle {
            // The sine of a number depends on its value.
            Self { value, sin_cos: self.sin_cos | other.sin_cos, is_angle: true }
        } else {
            Self::number(value)
        }
    }

    #[inline(always)]
    fn with(self, other: Self) -> Self {
        Self::number(self.value | other.value)
    }
}

/// Nothing is known to be equal, so that no comparison leaves anything out.
impl PartialEq for Traced {
    #[inline(always)]
    fn eq(&self, _: &Self) -> bool {
        false
    }
}

macro_rules! operator {
    ($($trait:ident $method:ident $assign:ident $assign_method:ident |$a:ident, $b:ident| $result:expr;)*) => {$(
        impl $trait for Traced {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ($a, $b) = (self, other);
                $result
            }
        }

        impl $assign for Traced {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    )*};
}

operator! {
    Add add AddAssign add_assign |a, b| a.sum(b);
    Sub sub SubAssign sub_assign |a, b| a.sum(b);
    Mul mul MulAssign mul_assign |a, b| a.with(b);
}

impl Neg for Traced {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self
    }
}

impl Zero for Traced {
    #[inline(always)]
    fn zero() -> Self {
        Self::NUMBER
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        false
    }
}

impl One for Traced {
    #[inline(always)]
    fn one() -> Self {
        Self::NUMBER
    }
}

impl Real for Traced {
    #[inline(always)]
    fn of(_: f64) -> Self {
        Self::NUMBER
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        (Self::number(self.sin_cos), Self::number(self.sin_cos))
    }

    #[inline(always)]
    fn sin_cos_all<const K: usize>(angles: [Self; K]) -> [(Self, Self); K] {
        // Not `map`, which is not always inlined.
        let mut out = [(Self::NUMBER, Self::NUMBER); K];
        for i in 0..K {
            out[i] = angles[i].sin_cos();
        }
        out
    }

    #[inline(always)]
    fn sin_cos_of_sums<const N: usize, const K: usize>(
        q: &SVector<Self, N>,
        angles: impl Fn(&SVector<Self, N>) -> [Self; K],
    ) -> [(Self, Self); K] {
        Self::sin_cos_all(angles(q))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::number(self.value)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        Self::number(self.value)
    }
}
