//! Results a pose on all cores, in pieces that keep a core busy for some
//! microseconds. Each function panics as its namesake does.
//!
//! ```
//! # #[cfg(feature = "rayon")] {
//! use robstiff::batch::{Grid, parallel};
//!
//! robstiff::robot!("rv130hsc.yaml");
//!
//! let turns: Vec<f64> = (0..100).map(|i| 0.03 * i as f64).collect();
//! let coordinates = [&turns[..], &turns[..50], &[0.5], &[0.0], &[1.2]];
//! let mut tables = vec![0.0; Grid::table_len(&coordinates)];
//! let grid = Grid::new(coordinates, &mut tables);
//! let mut traces = vec![0.0; grid.len()];
//! parallel::translational_trace(&Rv130hsc, grid, &mut traces);
//! # }
//! ```

use nalgebra::{Matrix6, Vector3, Vector6};
use rayon::prelude::*;

use super::poses::View;
use super::{Float, Poses};
use crate::Robot;

/// Poses in a piece: large against what handing it out costs.
const PIECE: usize = 1024;

/// Runs a function on the poses and results of each piece; it is told where
/// the piece starts.
fn pieces<V: View<T, N>, T: Float, R: Send, const N: usize>(
    poses: V,
    results: &mut [R],
    run: impl Fn(usize, V, &mut [R]) + Sync,
) {
    assert_eq!(poses.count(), results.len(), "there must be as many results as poses");
    results.par_chunks_mut(PIECE).enumerate().for_each(|(piece, results)| {
        let start = PIECE * piece;
        run(start, poses.cut(start..start + results.len()), results);
    });
}

/// [`compliance`](super::compliance) on all cores.
pub fn compliance<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    compliances: &mut [Matrix6<T>],
) {
    pieces(poses.view(), compliances, |_, poses, results| super::compliance(robot, poses, results));
}

/// [`compliance_triangle`](super::compliance_triangle) on all cores.
pub fn compliance_triangle<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    triangles: &mut [[T; 21]],
) {
    pieces(poses.view(), triangles, |_, poses, results| super::compliance_triangle(robot, poses, results));
}

/// [`translational_trace`](super::translational_trace) on all cores.
pub fn translational_trace<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    traces: &mut [T],
) {
    pieces(poses.view(), traces, |_, poses, results| super::translational_trace(robot, poses, results));
}

/// [`directional_compliance`](super::directional_compliance) on all cores.
pub fn directional_compliance<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    direction: &Vector3<T>,
    compliances: &mut [T],
) {
    pieces(poses.view(), compliances, |_, poses, results| {
        super::directional_compliance(robot, poses, direction, results);
    });
}

/// [`deflection`](super::deflection) on all cores.
pub fn deflection<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    wrench: &Vector6<T>,
    deflections: &mut [Vector6<T>],
) {
    pieces(poses.view(), deflections, |_, poses, results| super::deflection(robot, poses, wrench, results));
}

/// [`deflections`](super::deflections) on all cores.
pub fn deflections<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    wrenches: &[Vector6<T>],
    deflections: &mut [Vector6<T>],
) {
    let poses = poses.view();
    assert_eq!(wrenches.len(), poses.count(), "there must be as many wrenches as poses");
    pieces(poses, deflections, |start, poses, results| {
        super::deflections(robot, poses, &wrenches[start..start + results.len()], results);
    });
}
