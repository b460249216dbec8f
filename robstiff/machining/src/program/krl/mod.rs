//! KUKA Robot Language: `.src` with the motions, `.dat` with declared points.
//!
//! A B C are turns about z, the new y and the new x, in degrees; status S and turn T
//! say the posture. Lines move with `$VEL.CP` (m/s), joints with a share of their
//! fastest.

mod aggregate;
mod read;
mod routines;
mod state;
mod write;

use nalgebra::{Isometry3, Translation3};

use super::writing::fixed;
use super::{Position, Target, angles};

pub use read::read;
pub use write::{Options, write};

/// The types that positions have.
const POSITIONS: [&str; 5] = ["E6POS", "POS", "E6AXIS", "AXIS", "FRAME"];

/// Names of the axes of a pose, in order.
const POSE: [&str; 6] = ["X", "Y", "Z", "A", "B", "C"];

/// Names of the robot's axes.
const AXES: [&str; 6] = ["A1", "A2", "A3", "A4", "A5", "A6"];

/// Names of the axes beyond the robot's.
const EXTERNAL: [&str; 6] = ["E1", "E2", "E3", "E4", "E5", "E6"];

/// Decimals of lengths (mm) and of angles (degrees).
const LENGTH: usize = 4;
const ANGLE: usize = 5;

/// The numbers of a position in the order of [`POSE`] or [`AXES`], as they are written.
pub(super) fn numbers(position: &Position) -> Vec<String> {
    match &position.target {
        Target::Joints(angles) => angles.iter().map(|angle| fixed(angle.to_degrees(), ANGLE)).collect(),
        Target::Pose(pose, _) => pose_numbers(pose).to_vec(),
    }
}

fn pose_numbers(pose: &Isometry3<f64>) -> [String; 6] {
    let at = pose.translation.vector;
    let turn = angles::to_abc(&pose.rotation).map(|angle| fixed(angle.to_degrees(), ANGLE));
    let [a, b, c] = turn;
    let [x, y, z] = [at.x, at.y, at.z].map(|length| fixed(length * 1e3, LENGTH));
    [x, y, z, a, b, c]
}

/// The pose of X, Y, Z (mm), A, B, C (degrees).
fn pose([x, y, z, a, b, c]: [f64; 6]) -> Isometry3<f64> {
    let at = Translation3::new(x * 1e-3, y * 1e-3, z * 1e-3);
    Isometry3::from_parts(at, angles::from_abc([a, b, c].map(f64::to_radians)))
}
