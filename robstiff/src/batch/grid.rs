//! Grids in joint space.

use core::ops::Range;

use nalgebra::SVector;

use super::Float;
use super::instructions::Instructions;
use super::joints::{BLOCK, Joints};
use super::needs::Needs;
use super::source::{Filled, Source};
use crate::trig;

/// From so many coordinates of the first joint on, a block keeps to a row.
const ROW: usize = 32;

/// All poses that can be made of some coordinates of each joint.
///
/// The first joint changes fastest: with `n` coordinates of the first joint and
/// `m` of the second, pose `i + n * (j + m * k)` has the first joint's
/// coordinate `i`, the second's `j`, the third's `k`. Sines and cosines are
/// computed once a coordinate. What the first joint has no part in, most of a
/// compliance, is computed once for up to 64 of its coordinates, so a grid is
/// cheapest where the first joint has many; but any number will do, one or
/// none too.
///
/// A grid is a view, as a slice is: it can be copied, and of a large one the
/// results can be had [part](Self::part) by part.
///
/// ```
/// use robstiff::batch::{self, Grid};
///
/// robstiff::robot!("rv130hsc.yaml");
///
/// let base: Vec<f64> = (0..100).map(|i| 0.02 * i as f64).collect();
/// let coordinates = [&base[..], &[-0.6, -0.4, -0.2], &[0.3, 0.5], &[0.0], &[1.2, 1.4]];
/// let mut tables = vec![0.0; Grid::table_len(&coordinates)];
/// let grid = Grid::new(coordinates, &mut tables);
/// assert_eq!(grid.len(), 1200);
///
/// // In parts of 256 poses: the largest of all traces.
/// let (mut traces, mut largest) = ([0.0; 256], 0.0_f64);
/// for start in (0..grid.len()).step_by(256) {
///     let part = grid.part(start..grid.len().min(start + 256));
///     batch::translational_trace(&Rv130hsc, part, &mut traces[..part.len()]);
///     largest = traces[..part.len()].iter().fold(largest, |largest, trace| largest.max(*trace));
/// }
/// assert!(largest > 1e-6);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Grid<'t, T, const N: usize> {
    axes: [Axis<'t, T>; N],
    start: usize,
    end: usize,
}

/// The coordinates of a joint.
#[derive(Clone, Copy, Debug)]
struct Axis<'t, T> {
    values: &'t [T],
    sines: &'t [T],
    cosines: &'t [T],
}

impl<'t, T: Float, const N: usize> Grid<'t, T, N> {
    /// How many numbers [`new`](Self::new) needs room for: two a coordinate.
    pub fn table_len(coordinates: &[&[T]; N]) -> usize {
        coordinates.iter().map(|axis| 2 * axis.len()).sum()
    }

    /// A grid of the coordinates of each joint (rad or m). Their sines and
    /// cosines are written to `tables`, so that nothing is allocated.
    ///
    /// # Panics
    /// If `tables` has not the length that [`table_len`](Self::table_len) says,
    /// or if there are more poses than a `usize` can count.
    pub fn new(coordinates: [&'t [T]; N], tables: &'t mut [T]) -> Self {
        assert_eq!(tables.len(), Self::table_len(&coordinates), "the tables hold two numbers a coordinate");
        let (mut rest, mut end) = (tables, 1_usize);
        let axes = coordinates.map(|values| {
            let (sines, behind) = core::mem::take(&mut rest).split_at_mut(values.len());
            let (cosines, behind) = behind.split_at_mut(values.len());
            rest = behind;
            for (i, value) in values.iter().enumerate() {
                (sines[i], cosines[i]) = trig::sin_cos(*value);
            }
            end = end.checked_mul(values.len()).expect("a usize counts the poses");
            Axis { values, sines, cosines }
        });
        Self { axes, start: 0, end }
    }

    /// How many poses it has.
    pub fn len(&self) -> usize {
        self.end - self.start
    }

    /// Whether it has no pose.
    pub fn is_empty(&self) -> bool {
        self.start == self.end
    }

    /// A pose by its number.
    ///
    /// # Panics
    /// If there are not so many.
    pub fn pose(&self, pose: usize) -> SVector<T, N> {
        assert!(pose < self.len(), "there are {} poses", self.len());
        let at = self.coordinates(self.start + pose);
        SVector::from_fn(|joint, _| self.axes[joint].values[at[joint]])
    }

    /// The poses in a range, as a grid of their own.
    ///
    /// # Panics
    /// If there are not so many.
    pub fn part(&self, poses: Range<usize>) -> Self {
        assert!(poses.start <= poses.end && poses.end <= self.len(), "there are {} poses", self.len());
        Self { axes: self.axes, start: self.start + poses.start, end: self.start + poses.end }
    }

    /// Which coordinate of each joint a pose of the whole grid has.
    fn coordinates(&self, mut pose: usize) -> [usize; N] {
        self.axes.map(|axis| {
            let at = pose % axis.values.len();
            pose /= axis.values.len();
            at
        })
    }
}

/// The poses of a grid, block after block.
pub struct Steps<'t, T, const N: usize> {
    grid: Grid<'t, T, N>,
    /// Which coordinate of each joint comes next.
    at: [usize; N],
    /// The coordinate that a joint has in the whole block.
    settled: [Option<usize>; N],
    /// The first joint with more than one coordinate.
    fastest: usize,
}

impl<'t, T: Float, const N: usize> Steps<'t, T, N> {
    pub fn new(grid: Grid<'t, T, N>) -> Self {
        let at = if grid.is_empty() { [0; N] } else { grid.coordinates(grid.start) };
        let fastest = grid.axes.iter().position(|axis| axis.values.len() > 1).unwrap_or(0);
        Self { grid, at, settled: [None; N], fastest }
    }

    /// So many coordinates of the fastest joint further, which does not go
    /// beyond its last.
    fn advance(&mut self, count: usize) {
        let mut carry = count;
        for (at, axis) in self.at.iter_mut().zip(&self.grid.axes).skip(self.fastest) {
            *at += carry;
            if *at < axis.values.len() {
                return;
            }
            (*at, carry) = (0, 1);
        }
    }

    /// How many poses differ in the fastest joint alone, at most `count`.
    fn run(&self, count: usize) -> usize {
        if N == 0 { count } else { count.min(self.grid.axes[self.fastest].values.len() - self.at[self.fastest]) }
    }

    /// Part of a row, the first joint in the lanes.
    fn row(&mut self, count: usize, needs: Needs, joints: &mut Joints<T, N>) {
        for joint in 1..N {
            let (axis, at) = (&self.grid.axes[joint], self.at[joint]);
            joints.values[joint][0] = axis.values[at];
            joints.sines[joint][0] = axis.sines[at];
            joints.cosines[joint][0] = axis.cosines[at];
            wrap(joint, needs, &mut joints.values[joint][..1]);
        }
        let (axis, at) = (&self.grid.axes[0], self.at[0]);
        joints.values[0][..count].copy_from_slice(&axis.values[at..at + count]);
        joints.sines[0][..count].copy_from_slice(&axis.sines[at..at + count]);
        joints.cosines[0][..count].copy_from_slice(&axis.cosines[at..at + count]);
        wrap(0, needs, &mut joints.values[0][..count]);
        self.advance(count);
    }

    /// All joints in the lanes.
    fn each(&mut self, count: usize, needs: Needs, joints: &mut Joints<T, N>) {
        let mut lane = 0;
        while lane < count {
            let run = self.run(count - lane);
            let lanes = lane..lane + run;
            for joint in 0..N {
                let (axis, at) = (&self.grid.axes[joint], self.at[joint]);
                let fill = |from: &[T], to: &mut [T; BLOCK]| {
                    if joint == self.fastest {
                        to[lanes.clone()].copy_from_slice(&from[at..at + run]);
                    } else {
                        to[lanes.clone()].fill(from[at]);
                    }
                };
                if joint != self.fastest && self.settled[joint] == Some(at) {
                    continue;
                }
                self.settled[joint] = (run == BLOCK).then_some(at);
                if needs.value(joint) {
                    fill(axis.values, &mut joints.values[joint]);
                    wrap(joint, needs, &mut joints.values[joint][lanes.clone()]);
                }
                if needs.sin_cos(joint) {
                    fill(axis.sines, &mut joints.sines[joint]);
                    fill(axis.cosines, &mut joints.cosines[joint]);
                }
            }
            self.advance(run);
            lane += run;
        }
    }
}

/// Coordinates of many turns less whole ones, for multiples of them: a joint turns if it is asked
/// for its value beside its sine.
#[inline(always)]
fn wrap<T: Float>(joint: usize, needs: Needs, values: &mut [T]) {
    if needs.value(joint) && needs.sin_cos(joint) {
        values.iter_mut().for_each(|value| *value = trig::wrapped(*value));
    }
}

impl<T: Float, const N: usize> Source<T, N> for Steps<'_, T, N> {
    const ROWS: bool = true;

    fn poses(&self) -> usize {
        self.grid.len()
    }

    fn pose(&self, pose: usize) -> SVector<T, N> {
        self.grid.pose(pose)
    }

    #[inline(always)]
    fn fill<const FUSED: bool>(
        &mut self,
        first: usize,
        needs: Needs,
        joints: &mut Joints<T, N>,
        _: impl Instructions,
    ) -> Filled {
        let count = BLOCK.min(self.grid.len() - first);
        if self.fastest == 0 && N > 0 && self.grid.axes[0].values.len() >= ROW {
            let count = self.run(count);
            self.row(count, needs, joints);
            return Filled::Row(count);
        }
        self.each(count, needs, joints);
        Filled::Each(count)
    }
}
