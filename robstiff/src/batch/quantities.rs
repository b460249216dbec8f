//! What is computed of a pose.

use core::ops::Range;

use nalgebra::{Matrix6, SVector, Vector3, Vector6};

use super::Float;
use super::joints::BLOCK;
use crate::robot::TRIANGLE;
use crate::{Real, Robot};

/// Something that is computed of a pose: `M` numbers, in any scalar that holds
/// a `T`.
pub trait Quantity<T: Float, const N: usize, const M: usize> {
    /// Reads what belongs to the poses of a block besides their coordinates.
    #[inline(always)]
    fn prepare(&mut self, _poses: Range<usize>) {}

    /// Hands over the numbers of a pose of the block, each once and as soon as it is known.
    fn put_numbers<S: Real>(&self, pose: usize, q: &SVector<S, N>, scalar: impl Fn(T) -> S, put: impl FnMut(usize, S));
}

/// What the caller gets: `M` numbers in a row.
pub trait Results<T, const M: usize> {
    /// Which number each entry is.
    const ENTRIES: &[usize];

    /// The entries in memory's order.
    fn entries(&mut self) -> &mut [T];
}

const IDENTITY: [usize; 21] = {
    let mut numbers = [0; 21];
    let mut k = 0;
    while k < 21 {
        numbers[k] = k;
        k += 1;
    }
    numbers
};

impl<T: Float> Results<T, 1> for T {
    const ENTRIES: &[usize] = &[0];

    #[inline(always)]
    fn entries(&mut self) -> &mut [T] {
        core::slice::from_mut(self)
    }
}

impl<T: Float> Results<T, 6> for Vector6<T> {
    const ENTRIES: &[usize] = &[0, 1, 2, 3, 4, 5];

    #[inline(always)]
    fn entries(&mut self) -> &mut [T] {
        &mut self.data.0[0]
    }
}

impl<T: Float> Results<T, 21> for [T; 21] {
    const ENTRIES: &[usize] = &IDENTITY;

    #[inline(always)]
    fn entries(&mut self) -> &mut [T] {
        self
    }
}

impl<T: Float> Results<T, 21> for Matrix6<T> {
    const ENTRIES: &[usize] = &ENTRY;

    #[inline(always)]
    fn entries(&mut self) -> &mut [T] {
        self.data.0.as_flattened_mut()
    }
}

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

/// The upper triangle of the compliance.
pub struct Triangle<'r, R> {
    pub robot: &'r R,
}

impl<T: Float, R: Robot<N>, const N: usize> Quantity<T, N, 21> for Triangle<'_, R> {
    #[inline(always)]
    fn put_numbers<S: Real>(&self, _: usize, q: &SVector<S, N>, _: impl Fn(T) -> S, put: impl FnMut(usize, S)) {
        self.robot.compliance_entries(q, put);
    }
}

pub struct Trace<'r, R> {
    pub robot: &'r R,
}

impl<T: Float, R: Robot<N>, const N: usize> Quantity<T, N, 1> for Trace<'_, R> {
    #[inline(always)]
    fn put_numbers<S: Real>(&self, _: usize, q: &SVector<S, N>, _: impl Fn(T) -> S, mut put: impl FnMut(usize, S)) {
        let compliance = self.robot.compliance(q);
        put(0, compliance[(0, 0)] + compliance[(1, 1)] + compliance[(2, 2)]);
    }
}

pub struct Directional<'r, R, T> {
    pub robot: &'r R,
    pub direction: Vector3<T>,
}

impl<T: Float, R: Robot<N>, const N: usize> Quantity<T, N, 1> for Directional<'_, R, T> {
    #[inline(always)]
    fn put_numbers<S: Real>(
        &self,
        _: usize,
        q: &SVector<S, N>,
        scalar: impl Fn(T) -> S,
        mut put: impl FnMut(usize, S),
    ) {
        let c = self.robot.compliance(q);
        let [x, y, z] = self.direction.data.0[0];
        let (x, y, z) = (scalar(x), scalar(y), scalar(z));
        let (xy, xz, yz) = (c[(0, 1)] * y, c[(0, 2)] * z, c[(1, 2)] * z);
        let along_x = c[(0, 0)].mul_add(x, xy + xy + xz + xz);
        let along_y = c[(1, 1)].mul_add(y, yz + yz);
        put(0, x.mul_add(along_x, y.mul_add(along_y, z * z * c[(2, 2)])));
    }
}

pub struct Deflection<'r, R, T> {
    pub robot: &'r R,
    pub wrench: Vector6<T>,
}

impl<T: Float, R: Robot<N>, const N: usize> Quantity<T, N, 6> for Deflection<'_, R, T> {
    #[inline(always)]
    fn put_numbers<S: Real>(&self, _: usize, q: &SVector<S, N>, scalar: impl Fn(T) -> S, put: impl FnMut(usize, S)) {
        put_deflection(self.robot, q, |i| scalar(self.wrench[i]), put);
    }
}

/// The deflection under a wrench of the pose's own.
pub struct Deflections<'r, R, T> {
    robot: &'r R,
    wrenches: &'r [Vector6<T>],
    block: [[T; BLOCK]; 6],
}

impl<'r, R, T: Float> Deflections<'r, R, T> {
    pub fn new(robot: &'r R, wrenches: &'r [Vector6<T>]) -> Self {
        Self { robot, wrenches, block: [[T::ZERO; BLOCK]; 6] }
    }
}

impl<T: Float, R: Robot<N>, const N: usize> Quantity<T, N, 6> for Deflections<'_, R, T> {
    #[inline(always)]
    fn prepare(&mut self, poses: Range<usize>) {
        for (pose, wrench) in self.wrenches[poses].iter().enumerate().take(BLOCK) {
            for i in 0..6 {
                self.block[i][pose] = wrench[i];
            }
        }
    }

    #[inline(always)]
    fn put_numbers<S: Real>(&self, pose: usize, q: &SVector<S, N>, scalar: impl Fn(T) -> S, put: impl FnMut(usize, S)) {
        put_deflection(self.robot, q, |i| scalar(self.block[i][pose]), put);
    }
}

#[inline(always)]
fn put_deflection<S: Real, const N: usize>(
    robot: &impl Robot<N>,
    q: &SVector<S, N>,
    wrench: impl Fn(usize) -> S,
    mut put: impl FnMut(usize, S),
) {
    let wrench = Vector6::new(wrench(0), wrench(1), wrench(2), wrench(3), wrench(4), wrench(5));
    let deflection = robot.deflection(q, &wrench);
    for i in 0..6 {
        put(i, deflection[i]);
    }
}
