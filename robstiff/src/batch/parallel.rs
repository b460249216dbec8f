//! The same on all cores, in pieces that keep a core busy for some
//! microseconds. Each function panics as its namesake does.

use nalgebra::{Matrix6, SVector, Vector3, Vector6};
use rayon::prelude::*;

use super::Float;
use crate::Robot;

/// Poses in a piece: large against what handing it out costs.
const PIECE: usize = 1024;

fn pieces<T: Float, R: Send, const N: usize>(
    poses: &[SVector<T, N>],
    results: &mut [R],
    run: impl Fn(&[SVector<T, N>], &mut [R]) + Sync,
) {
    assert_eq!(poses.len(), results.len(), "there must be as many results as poses");
    poses.par_chunks(PIECE).zip(results.par_chunks_mut(PIECE)).for_each(|(poses, results)| run(poses, results));
}

/// [`compliance`](super::compliance) on all cores.
pub fn compliance<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: &[SVector<T, N>],
    compliances: &mut [Matrix6<T>],
) {
    pieces(poses, compliances, |poses, results| super::compliance(robot, poses, results));
}

/// [`compliance_triangle`](super::compliance_triangle) on all cores.
pub fn compliance_triangle<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: &[SVector<T, N>],
    triangles: &mut [[T; 21]],
) {
    pieces(poses, triangles, |poses, results| super::compliance_triangle(robot, poses, results));
}

/// [`translational_trace`](super::translational_trace) on all cores.
pub fn translational_trace<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: &[SVector<T, N>],
    traces: &mut [T],
) {
    pieces(poses, traces, |poses, results| super::translational_trace(robot, poses, results));
}

/// [`directional_compliance`](super::directional_compliance) on all cores.
pub fn directional_compliance<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: &[SVector<T, N>],
    direction: &Vector3<T>,
    compliances: &mut [T],
) {
    pieces(poses, compliances, |poses, results| super::directional_compliance(robot, poses, direction, results));
}

/// [`deflection`](super::deflection) on all cores.
pub fn deflection<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: &[SVector<T, N>],
    wrench: &Vector6<T>,
    deflections: &mut [Vector6<T>],
) {
    pieces(poses, deflections, |poses, results| super::deflection(robot, poses, wrench, results));
}
