//! A solved path as the stock sees it.

use nalgebra::{Matrix4, Unit, Vector3};

use super::survey::Step;
use crate::path::{PathPoint, SolvedPath};

/// The steps of a path. `place` is where the stock's frame stands in the base frame (homogeneous, 4 x 4, m), `axis` that
/// of the tool in the TCP's frame, from the spindle to the tip; `cutter` says which of the cutters a
/// point has.
///
/// # Panics
/// If the place is not a pose.
pub fn steps<const N: usize>(
    path: &SolvedPath<N>,
    place: &Matrix4<f64>,
    axis: Unit<Vector3<f64>>,
    cutter: impl Fn(&PathPoint<N>) -> usize,
) -> Vec<Step> {
    let to_stock = place.try_inverse().expect("a pose has an inverse");
    let step = |point: &PathPoint<N>| {
        let pose = to_stock * point.pose;
        let tip = pose.fixed_view::<3, 1>(0, 3).into_owned();
        let axis = -(pose.fixed_view::<3, 3>(0, 0) * axis.into_inner());
        Step { tip, axis: Unit::new_normalize(axis), rapid: point.rapid, cutter: cutter(point) }
    };
    path.points.iter().map(step).collect()
}
