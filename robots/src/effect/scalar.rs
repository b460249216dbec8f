//! The scalars that a law is written over, so that numbers and symbols use the
//! same formula.

use core::ops::{Add, Mul, Neg, Sub};

/// What a formula of the catalogue computes with: the runtime's numbers, the
/// generator's symbols, and either with a derivative ([`Tangent`]).
pub trait Scalar: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> {
    /// `self * factor`.
    fn times(self, factor: f64) -> Self;

    /// `self + summand`.
    fn plus(self, summand: f64) -> Self;

    /// The square root.
    fn sqrt(self) -> Self;

    /// `1 / self`.
    fn recip(self) -> Self;

    /// The larger of the two.
    fn max(self, other: Self) -> Self;

    /// The smaller of the two.
    fn min(self, other: Self) -> Self;

    /// 1 with the sign of the number.
    fn signum(self) -> Self;
}

/// A scalar and its derivative with respect to one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangent<S> {
    /// The value.
    pub value: S,
    /// Its derivative.
    pub slope: S,
}

impl<S: Scalar> Tangent<S> {
    /// A value that does not depend on the variable.
    pub fn constant(value: S) -> Self {
        Self { value, slope: value.times(0.0) }
    }
}

impl<S: Scalar> Add for Tangent<S> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl<S: Scalar> Sub for Tangent<S> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl<S: Scalar> Mul for Tangent<S> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, slope: self.slope * other.value + self.value * other.slope }
    }
}

impl<S: Scalar> Neg for Tangent<S> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

impl<S: Scalar> Scalar for Tangent<S> {
    fn times(self, factor: f64) -> Self {
        Self { value: self.value.times(factor), slope: self.slope.times(factor) }
    }

    fn plus(self, summand: f64) -> Self {
        Self { value: self.value.plus(summand), slope: self.slope }
    }

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self { value: root, slope: self.slope * root.times(2.0).recip() }
    }

    fn recip(self) -> Self {
        let inverse = self.value.recip();
        Self { value: inverse, slope: -(self.slope * inverse * inverse) }
    }

    fn max(self, other: Self) -> Self {
        let ahead = (self.value - other.value).signum() * (self.slope - other.slope);
        Self { value: self.value.max(other.value), slope: (self.slope + other.slope + ahead).times(0.5) }
    }

    fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }

    fn signum(self) -> Self {
        Self::constant(self.value.signum())
    }
}
