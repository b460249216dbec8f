//! Robots at many poses.

use nalgebra::{SVector, Vector6};

use robstiff::Robot;
use robstiff::batch::{self, Grid};

/// Poses in a row: part of a grid in joint space, or a list.
#[derive(Clone, Copy, Debug)]
pub enum Poses<'p, const N: usize> {
    /// Part of a grid.
    Grid(Grid<'p, f64, N>),
    /// One by one.
    List(&'p [SVector<f64, N>]),
}

impl<const N: usize> Poses<'_, N> {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Grid(grid) => grid.len(),
            Self::List(list) => list.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A pose by its number (rad or m).
    ///
    /// # Panics
    /// If there are not so many.
    pub fn pose(&self, pose: usize) -> SVector<f64, N> {
        match self {
            Self::Grid(grid) => grid.pose(pose),
            Self::List(list) => list[pose],
        }
    }
}

/// What computes the elastostatics of an arm at many poses.
///
/// Every [`Robot`] does, through [`batch`]; what knows a robot in another form
/// may do it its own way.
pub trait Evaluate<const N: usize>: Sync {
    /// [`Robot::deflection`] at each pose under one wrench (N, Nm at the TCP in
    /// the base frame): m, rad.
    fn deflections(&self, poses: Poses<'_, N>, wrench: &Vector6<f64>, deflections: &mut [Vector6<f64>]);

    /// The same under a wrench of each pose's own.
    fn deflections_under(&self, poses: Poses<'_, N>, wrenches: &[Vector6<f64>], deflections: &mut [Vector6<f64>]);

    /// The upper triangles of [`Robot::compliance`] by rows at each pose.
    fn triangles(&self, poses: Poses<'_, N>, triangles: &mut [[f64; 21]]);
}

impl<R: Robot<N> + Sync, const N: usize> Evaluate<N> for R {
    fn deflections(&self, poses: Poses<'_, N>, wrench: &Vector6<f64>, deflections: &mut [Vector6<f64>]) {
        match poses {
            Poses::Grid(grid) => batch::deflection(self, grid, wrench, deflections),
            Poses::List(list) => batch::deflection(self, list, wrench, deflections),
        }
    }

    fn deflections_under(&self, poses: Poses<'_, N>, wrenches: &[Vector6<f64>], deflections: &mut [Vector6<f64>]) {
        match poses {
            Poses::Grid(grid) => batch::deflections(self, grid, wrenches, deflections),
            Poses::List(list) => batch::deflections(self, list, wrenches, deflections),
        }
    }

    fn triangles(&self, poses: Poses<'_, N>, triangles: &mut [[f64; 21]]) {
        match poses {
            Poses::Grid(grid) => batch::compliance_triangle(self, grid, triangles),
            Poses::List(list) => batch::compliance_triangle(self, list, triangles),
        }
    }
}
