//! Derivatives from the same generated code.

use core::array;
use core::ops::{Add, AddAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use crate::Real;

/// A number and its derivatives with respect to `K` variables, exact to
/// rounding: how a compliance changes with the joint coordinates.
///
/// ```
/// use robstiff::nalgebra::SVector;
/// use robstiff::{Dual, Robot};
///
/// robstiff::robot!("rv130hsc.yaml");
///
/// let q = SVector::from([0.3_f64, -0.4, 0.5, 0.0, 1.2]);
/// let compliance = Rv130hsc.compliance(&Dual::variables(q));
/// // How the compliance along x changes with joint 2 (m/N per rad):
/// let slope = compliance[(0, 0)].slopes[1];
///
/// let step = SVector::from([0.0, 1e-5, 0.0, 0.0, 0.0]);
/// let difference = (Rv130hsc.compliance(&(q + step)) - Rv130hsc.compliance(&(q - step))) / 2e-5;
/// assert!((slope - difference[(0, 0)]).abs() < 1e-9 * compliance[(0, 0)].value);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T, const K: usize = 1> {
    /// The number.
    pub value: T,
    /// Its derivative with respect to each variable.
    pub slopes: [T; K],
}

impl<T: Real, const K: usize> Dual<T, K> {
    /// A number that depends on no variable.
    #[inline]
    pub fn constant(value: T) -> Self {
        Self { value, slopes: [T::zero(); K] }
    }

    /// The variable with this index.
    ///
    /// # Panics
    /// If there are not that many variables.
    #[inline]
    pub fn variable(value: T, index: usize) -> Self {
        let mut variable = Self::constant(value);
        variable.slopes[index] = T::one();
        variable
    }

    /// `f` of this number, from its value and its slope here.
    #[inline]
    fn chain(self, value: T, slope: T) -> Self {
        Self { value, slopes: self.slopes.map(|own| own * slope) }
    }
}

impl<T: Real, const K: usize> Dual<T, K> {
    /// Every joint coordinate of a pose as a variable of its own.
    #[inline]
    pub fn variables(q: nalgebra::SVector<T, K>) -> nalgebra::SVector<Self, K> {
        nalgebra::SVector::from_fn(|i, _| Self::variable(q[i], i))
    }
}

impl<T: Real, const K: usize> Add for Dual<T, K> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slopes: array::from_fn(|k| self.slopes[k] + other.slopes[k]) }
    }
}

impl<T: Real, const K: usize> Sub for Dual<T, K> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slopes: array::from_fn(|k| self.slopes[k] - other.slopes[k]) }
    }
}

impl<T: Real, const K: usize> Mul for Dual<T, K> {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let slopes = array::from_fn(|k| self.slopes[k].mul_add(other.value, self.value * other.slopes[k]));
        Self { value: self.value * other.value, slopes }
    }
}

impl<T: Real, const K: usize> Neg for Dual<T, K> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { value: -self.value, slopes: self.slopes.map(T::neg) }
    }
}

impl<T: Real, const K: usize> AddAssign for Dual<T, K> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Real, const K: usize> SubAssign for Dual<T, K> {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<T: Real, const K: usize> MulAssign for Dual<T, K> {
    #[inline]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<T: Real, const K: usize> Zero for Dual<T, K> {
    #[inline]
    fn zero() -> Self {
        Self::constant(T::zero())
    }

    fn is_zero(&self) -> bool {
        self.value.is_zero() && self.slopes.iter().all(T::is_zero)
    }
}

impl<T: Real, const K: usize> One for Dual<T, K> {
    #[inline]
    fn one() -> Self {
        Self::constant(T::one())
    }
}

impl<T: Real, const K: usize> Real for Dual<T, K> {
    #[inline]
    fn of(value: f64) -> Self {
        Self::constant(T::of(value))
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    #[inline]
    fn sin_cos_all<const A: usize>(angles: [Self; A]) -> [(Self, Self); A] {
        let values = T::sin_cos_all(angles.map(|angle| angle.value));
        array::from_fn(|i| {
            let (sin, cos) = values[i];
            (angles[i].chain(sin, cos), angles[i].chain(cos, -sin))
        })
    }

    #[inline]
    fn wrapped(self) -> Self {
        Self { value: self.value.wrapped(), ..self }
    }

    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, (root + root).recip())
    }

    #[inline]
    fn recip(self) -> Self {
        let inverse = self.value.recip();
        self.chain(inverse, -(inverse * inverse))
    }

    #[inline]
    fn signum(self) -> Self {
        Self::constant(self.value.signum())
    }

    /// With the slopes of the number that is larger.
    #[inline]
    fn max(self, other: Self) -> Self {
        let ahead = (self.value - other.value).signum();
        let half = T::of(0.5);
        let slope = |own: T, its: T| (own + its + ahead * (own - its)) * half;
        let slopes = array::from_fn(|k| slope(self.slopes[k], other.slopes[k]));
        Self { value: self.value.max(other.value), slopes }
    }
}

#[cfg(all(test, feature = "generic"))]
mod tests {
    use nalgebra::{Matrix6, SVector, Vector6};

    use super::*;
    use crate::samples::{linear_effects, odd, poses};
    use crate::{Effect, Generic, Lanes, Robot};

    #[test]
    fn slopes_are_those_of_central_differences() {
        let mut description = odd();
        description.effects = linear_effects();
        description.effects.push(Effect::StiffnessNonlinearity { joint: 5, added: 2e-6, knee: 300.0 });
        let robot = Generic::<6>::new(&description).unwrap();
        let wrench = Vector6::new(300.0, -500.0, 700.0, 40.0, -60.0, 80.0);
        let step = 1e-5;
        for q in poses::<6>() {
            let variables = Dual::variables(q);
            let compliance = robot.compliance(&variables);
            let deflection = robot.deflection(&variables, &wrench.map(Dual::constant));
            assert!((compliance.map(|entry| entry.value) - robot.compliance(&q)).amax() == 0.0);
            for i in 0..6 {
                let mut aside = SVector::zeros();
                aside[i] = step;
                let slope: Matrix6<f64> =
                    (robot.compliance(&(q + aside)) - robot.compliance(&(q - aside))) / (2.0 * step);
                assert!(
                    (compliance.map(|entry| entry.slopes[i]) - slope).amax()
                        < 1e-8 * compliance.map(|entry| entry.value).amax()
                );
                let slope =
                    (robot.deflection(&(q + aside), &wrench) - robot.deflection(&(q - aside), &wrench)) / (2.0 * step);
                assert!(
                    (deflection.map(|entry| entry.slopes[i]) - slope).amax()
                        < 1e-8 * deflection.map(|entry| entry.value).amax()
                );
            }
        }
    }

    #[test]
    fn duals_of_lanes_of_floats() {
        let x = Dual::<Lanes<f64, 2>>::variable(Lanes([0.25, 4.0]), 0);
        let mut y = x.recip() * x.sqrt() - x;
        y += Dual::one();
        y -= Dual::of(1.0);
        y *= Dual::one();
        // y = x^(-1/2) - x
        assert_eq!(y.value, Lanes([1.75, -3.5]));
        assert_eq!(y.slopes, [Lanes([-5.0, -1.0625])]);
        assert!(Dual::<f64, 3>::zero().is_zero() && !y.is_zero());
        // The slopes follow the number that was taken.
        let (x, z) = (Dual::<Lanes<f64, 2>>::variable(Lanes([0.25, 4.0]), 0), Dual::of(1.0));
        assert_eq!((x.max(z).value, x.max(z).slopes), (Lanes([1.0, 4.0]), [Lanes([0.0, 1.0])]));
        assert_eq!((x.min(z).value, x.min(z).slopes), (Lanes([0.25, 1.0]), [Lanes([1.0, 0.0])]));
    }
}
