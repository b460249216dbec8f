//! How well a description and a URDF file agree.

use robstiff::Robot;
use robstiff::nalgebra::{Matrix4, SVector};
use robstiff_robots::urdf::Chain;
use robstiff_robots::{Description, JointKind};

use crate::text::{count, significant};

/// Poses at which both are compared.
pub const POSES: usize = 1000;

/// The largest difference of an entry of the tool's frame, at poses within the
/// limits.
pub fn largest_difference<const N: usize>(robot: &impl Robot<N>, chain: &Chain) -> f64 {
    let ranges: Vec<[f64; 2]> = chain
        .joints
        .iter()
        .map(|joint| match (joint.kind, joint.limits) {
            (_, Some(limits)) => limits,
            (JointKind::Revolute, None) => [-std::f64::consts::PI, std::f64::consts::PI],
            (JointKind::Prismatic, None) => [-1.0, 1.0],
        })
        .collect();
    // The fractional parts of multiples of square roots are spread evenly.
    let root = |joint: usize| f64::from([2_u8, 3, 5, 7, 11, 13, 17, 19][joint % 8]).sqrt();
    let difference = |pose: usize| {
        let q = SVector::<f64, N>::from_fn(|i, _| {
            ranges[i][0] + (ranges[i][1] - ranges[i][0]) * (pose as f64 * root(i)).fract()
        });
        let expected: Matrix4<f64> = chain.pose(q.as_slice()).to_homogeneous();
        let apart = (robot.transform(&q) - expected).abs();
        // A NaN would be lost in a maximum.
        if apart.iter().any(|entry| entry.is_nan()) { f64::NAN } else { apart.max() }
    };
    (0..POSES).map(difference).fold(0.0, |most, apart| if apart > most || apart.is_nan() { apart } else { most })
}

/// The first line of a page: the joints of a chain, and by how much what `agrees` says does so.
pub fn heading(robot: &Description, chain: &Chain, agrees: &str, apart: f64) -> String {
    format!(
        "{}: {} from {} to {}, {agrees} within {} m at {POSES} poses\n\n",
        robot.name,
        count(robot.joints.len(), "joint"),
        chain.base,
        chain.tip,
        significant(apart.max(1e-16), 1),
    )
}
