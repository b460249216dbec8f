//! Several poses abreast in one call of generated code.

use core::array;
use core::ops::{Add, AddAssign, Index, Mul, MulAssign, Neg, Sub, SubAssign};

use nalgebra::SVector;
use num_traits::{One, Zero};

use crate::{Real, trig};

/// `W` numbers that are computed with as one: a joint coordinate of `W` poses.
///
/// A plain array; every operation is a loop over it, which the compiler makes
/// vector instructions of. For many poses there is [`batch`](crate::batch).
///
/// ```
/// use robstiff::nalgebra::{Matrix6, SVector};
/// use robstiff::{Lanes, Robot};
///
/// robstiff::robot!("rv130hsc.yaml");
///
/// // Four poses that differ in the first joint.
/// let mut q = SVector::from([0.3, -0.4, 0.5, 0.0, 1.2].map(Lanes::<f64, 4>::splat));
/// q[0] = Lanes([0.0, 0.1, 0.2, 0.3]);
/// let compliances: Matrix6<Lanes<f64, 4>> = Rv130hsc.compliance(&q);
///
/// let third = Rv130hsc.compliance(&SVector::from([0.2, -0.4, 0.5, 0.0, 1.2]));
/// assert!((compliances.map(|entry| entry[2]) - third).amax() < 1e-13 * third.amax());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct Lanes<T, const W: usize>(pub [T; W]);

impl<T: Copy, const W: usize> Lanes<T, W> {
    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(value: T) -> Self {
        Self([value; W])
    }

    #[inline(always)]
    fn each(self, f: impl Fn(T) -> T) -> Self {
        Self(array::from_fn(|i| f(self.0[i])))
    }

    #[inline(always)]
    fn with(self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        Self(array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

/// The number in a lane.
impl<T, const W: usize> Index<usize> for Lanes<T, W> {
    type Output = T;

    #[inline(always)]
    fn index(&self, lane: usize) -> &T {
        &self.0[lane]
    }
}

macro_rules! operator {
    ($($trait:ident $method:ident $assign:ident $assign_method:ident)*) => {$(
        impl<T: Real, const W: usize> $trait for Lanes<T, W> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.with(other, T::$method)
            }
        }

        impl<T: Real, const W: usize> $assign for Lanes<T, W> {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    )*};
}

operator! {
    Add add AddAssign add_assign
    Sub sub SubAssign sub_assign
    Mul mul MulAssign mul_assign
}

impl<T: Real, const W: usize> Neg for Lanes<T, W> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.each(T::neg)
    }
}

impl<T: Real, const W: usize> Zero for Lanes<T, W> {
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(T::zero())
    }

    fn is_zero(&self) -> bool {
        self.0.iter().all(T::is_zero)
    }
}

impl<T: Real, const W: usize> One for Lanes<T, W> {
    #[inline(always)]
    fn one() -> Self {
        Self::splat(T::one())
    }
}

impl<T: Real, const W: usize> Real for Lanes<T, W> {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self::splat(T::of(value))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let pairs = T::sin_cos_all(self.0);
        (Self(pairs.map(|(sin, _)| sin)), Self(pairs.map(|(_, cos)| cos)))
    }

    #[inline(always)]
    fn wrapped(self) -> Self {
        self.each(T::wrapped)
    }

    /// With one comparison for all coordinates of all lanes.
    #[inline(always)]
    fn sin_cos_of_sums<const N: usize, const K: usize>(
        q: &SVector<Self, N>,
        angles: impl Fn(&SVector<Self, N>) -> [Self; K],
    ) -> [(Self, Self); K] {
        let few_turns = T::of(trig::FEW_TURNS);
        let mut largest = Self::splat(few_turns);
        for coordinate in q.iter() {
            // In this order a NaN is passed over.
            largest = coordinate.max(-*coordinate).max(largest);
        }
        let mut q = *q;
        if largest != Self::splat(few_turns) {
            q.apply(|coordinate| *coordinate = coordinate.wrapped());
        }
        Self::sin_cos_all(angles(&q))
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        Self(array::from_fn(|i| self.0[i].mul_add(factor.0[i], summand.0[i])))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.each(T::sqrt)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        self.each(T::recip)
    }

    #[inline(always)]
    fn signum(self) -> Self {
        self.each(T::signum)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.with(other, T::max)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.with(other, T::min)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector6;

    use super::*;
    use crate::Robot;

    crate::robot!("rv130hsc.yaml");

    #[test]
    fn every_lane_is_a_pose() {
        fn check<const W: usize>() {
            let pose = |lane: usize| {
                SVector::<f64, 5>::from_fn(|i, _| Real::sin_cos(1.7 * lane as f64 + 2.3 * i as f64).0 * 3.0)
            };
            let wrench = Vector6::new(300.0, -500.0, 700.0, 40.0, -60.0, 80.0);
            let q = SVector::<Lanes<f64, W>, 5>::from_fn(|i, _| Lanes(array::from_fn(|lane| pose(lane)[i])));
            let compliance = Rv130hsc.compliance(&q);
            let deflection = Rv130hsc.deflection(&q, &wrench.map(Lanes::splat));
            for lane in 0..W {
                let single = Rv130hsc.compliance(&pose(lane));
                assert!((compliance.map(|entry| entry[lane]) - single).amax() <= 1e-15 * single.amax());
                let single = Rv130hsc.deflection(&pose(lane), &wrench);
                assert!((deflection.map(|entry| entry[lane]) - single).amax() <= 1e-15 * single.amax());
            }
        }
        check::<1>();
        check::<3>();
        check::<4>();
        check::<8>();
    }

    #[test]
    fn operations_are_those_of_each_lane() {
        let (a, b) = (Lanes([1.0, -2.0, 4.0]), Lanes([0.5, 3.0, 0.25]));
        assert_eq!(a + b, Lanes([1.5, 1.0, 4.25]));
        assert_eq!(a - b, Lanes([0.5, -5.0, 3.75]));
        assert_eq!(a * b, Lanes([0.5, -6.0, 1.0]));
        assert_eq!(-a, Lanes([-1.0, 2.0, -4.0]));
        assert_eq!(a.mul_add(b, a), Lanes([1.5, -8.0, 5.0]));
        assert_eq!(Lanes([1.0, 4.0]).sqrt(), Lanes([1.0, 2.0]));
        assert_eq!(Lanes([1.0, 4.0]).recip(), Lanes([1.0, 0.25]));
        assert_eq!(a.max(b), Lanes([1.0, 3.0, 4.0]));
        assert_eq!(a.min(b), Lanes([0.5, -2.0, 0.25]));
        assert_eq!(a.signum(), Lanes([1.0, -1.0, 1.0]));
        let mut sum = Lanes::<f32, 2>::zero();
        sum += Lanes::one();
        sum -= Lanes([0.5, 1.0]);
        sum *= Lanes([2.0, 2.0]);
        assert_eq!(sum, Lanes([1.0, 0.0]));
        assert!(!sum.is_zero() && Lanes::<f32, 2>::zero().is_zero());
    }
}
