//! What is computed of a pose.

use nalgebra::{Matrix6, SVector, Vector3, Vector6};

use super::Float;
use crate::{Real, Robot};

/// Something that is computed of a pose: `M` numbers, from which the result is
/// put together.
pub trait Quantity<T: Float, const N: usize, const M: usize> {
    /// What the caller gets.
    type Result;

    /// The numbers, in any scalar that holds a `T`.
    fn numbers<S: Real>(&self, q: &SVector<S, N>, scalar: impl Fn(T) -> S) -> [S; M];

    /// The result.
    fn result(numbers: [T; M]) -> Self::Result;
}

/// Row and column of the entries of the upper triangle, by rows.
const TRIANGLE: [(usize, usize); 21] = {
    let mut entries = [(0, 0); 21];
    let (mut k, mut i) = (0, 0);
    while i < 6 {
        let mut j = i;
        while j < 6 {
            entries[k] = (i, j);
            (k, j) = (k + 1, j + 1);
        }
        i += 1;
    }
    entries
};

/// Where the entry of a full matrix, by columns, is in the triangle.
const ENTRY: [usize; 36] = {
    let mut places = [0; 36];
    let mut k = 0;
    while k < 21 {
        let (i, j) = TRIANGLE[k];
        (places[6 * i + j], places[6 * j + i]) = (k, k);
        k += 1;
    }
    places
};

#[inline(always)]
fn triangle<S: Real>(compliance: &Matrix6<S>) -> [S; 21] {
    // Not `map`, which is not always inlined.
    let mut entries = [S::zero(); 21];
    for (k, entry) in entries.iter_mut().enumerate() {
        *entry = compliance[TRIANGLE[k]];
    }
    entries
}

pub struct Compliance<'r, R> {
    pub robot: &'r R,
}

impl<T: Float, R: Robot<N>, const N: usize> Quantity<T, N, 21> for Compliance<'_, R> {
    type Result = Matrix6<T>;

    #[inline(always)]
    fn numbers<S: Real>(&self, q: &SVector<S, N>, _: impl Fn(T) -> S) -> [S; 21] {
        triangle(&self.robot.compliance(q))
    }

    #[inline(always)]
    fn result(numbers: [T; 21]) -> Matrix6<T> {
        let mut full = [[T::ZERO; 6]; 6];
        for (j, column) in full.iter_mut().enumerate() {
            for (i, entry) in column.iter_mut().enumerate() {
                *entry = numbers[ENTRY[6 * j + i]];
            }
        }
        Matrix6::from(full)
    }
}

pub struct Triangle<'r, R> {
    pub robot: &'r R,
}

impl<T: Float, R: Robot<N>, const N: usize> Quantity<T, N, 21> for Triangle<'_, R> {
    type Result = [T; 21];

    #[inline(always)]
    fn numbers<S: Real>(&self, q: &SVector<S, N>, _: impl Fn(T) -> S) -> [S; 21] {
        triangle(&self.robot.compliance(q))
    }

    #[inline(always)]
    fn result(numbers: [T; 21]) -> [T; 21] {
        numbers
    }
}

pub struct Trace<'r, R> {
    pub robot: &'r R,
}

impl<T: Float, R: Robot<N>, const N: usize> Quantity<T, N, 1> for Trace<'_, R> {
    type Result = T;

    #[inline(always)]
    fn numbers<S: Real>(&self, q: &SVector<S, N>, _: impl Fn(T) -> S) -> [S; 1] {
        let compliance = self.robot.compliance(q);
        [compliance[(0, 0)] + compliance[(1, 1)] + compliance[(2, 2)]]
    }

    #[inline(always)]
    fn result([trace]: [T; 1]) -> T {
        trace
    }
}

pub struct Directional<'r, R, T> {
    pub robot: &'r R,
    pub direction: Vector3<T>,
}

impl<T: Float, R: Robot<N>, const N: usize> Quantity<T, N, 1> for Directional<'_, R, T> {
    type Result = T;

    #[inline(always)]
    fn numbers<S: Real>(&self, q: &SVector<S, N>, scalar: impl Fn(T) -> S) -> [S; 1] {
        let c = self.robot.compliance(q);
        let [x, y, z] = self.direction.data.0[0];
        let (x, y, z) = (scalar(x), scalar(y), scalar(z));
        let (xy, xz, yz) = (c[(0, 1)] * y, c[(0, 2)] * z, c[(1, 2)] * z);
        let along_x = c[(0, 0)].mul_add(x, xy + xy + xz + xz);
        let along_y = c[(1, 1)].mul_add(y, yz + yz);
        [x.mul_add(along_x, y.mul_add(along_y, z * z * c[(2, 2)]))]
    }

    #[inline(always)]
    fn result([compliance]: [T; 1]) -> T {
        compliance
    }
}

pub struct Deflection<'r, R, T> {
    pub robot: &'r R,
    pub wrench: Vector6<T>,
}

impl<T: Float, R: Robot<N>, const N: usize> Quantity<T, N, 6> for Deflection<'_, R, T> {
    type Result = Vector6<T>;

    #[inline(always)]
    fn numbers<S: Real>(&self, q: &SVector<S, N>, scalar: impl Fn(T) -> S) -> [S; 6] {
        let [fx, fy, fz, mx, my, mz] = self.wrench.data.0[0];
        let force = (scalar(fx), scalar(fy), scalar(fz));
        let moment = (scalar(mx), scalar(my), scalar(mz));
        let wrench = Vector6::new(force.0, force.1, force.2, moment.0, moment.1, moment.2);
        self.robot.deflection(q, &wrench).data.0[0]
    }

    #[inline(always)]
    fn result(numbers: [T; 6]) -> Vector6<T> {
        Vector6::from(numbers)
    }
}
