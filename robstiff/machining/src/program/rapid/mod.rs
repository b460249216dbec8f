//! ABB RAPID: modules with routines and data.
//!
//! Orientations are quaternions, the scalar first; confdata say the posture by
//! quarter turns of axes 1, 4 and 6, and cfx. Each motion names its speed, zone, tool
//! and work object.

mod data;
mod read;
mod statements;
mod write;

use super::writing::fixed;
use super::{Position, Target, angles};

pub use read::read;
pub use write::write;

/// Speeds that the controller knows (mm/s): `v5` and so on.
const SPEEDS: [u32; 25] = [
    5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000, 2500, 3000, 4000, 5000,
    6000, 7000,
];

/// Zones that the controller knows: name and the distance of the TCP (mm).
const ZONES: [(&str, f64); 14] = [
    ("z0", 0.3),
    ("z1", 1.0),
    ("z5", 5.0),
    ("z10", 10.0),
    ("z15", 15.0),
    ("z20", 20.0),
    ("z30", 30.0),
    ("z40", 40.0),
    ("z50", 50.0),
    ("z60", 60.0),
    ("z80", 80.0),
    ("z100", 100.0),
    ("z150", 150.0),
    ("z200", 200.0),
];

/// Decimals of lengths (mm), of parts of quaternions and of angles (degrees).
const LENGTH: usize = 4;
const QUATERNION: usize = 8;
const ANGLE: usize = 5;

/// The numbers of a position, as they are written: x, y, z, q1 to q4, or the angles.
pub(super) fn numbers(position: &Position) -> Vec<String> {
    match &position.target {
        Target::Joints(angles) => angles.iter().map(|angle| fixed(angle.to_degrees(), ANGLE)).collect(),
        Target::Pose(pose, _) => pose_numbers(pose).to_vec(),
    }
}

fn pose_numbers(pose: &nalgebra::Isometry3<f64>) -> [String; 7] {
    let at = pose.translation.vector;
    let [x, y, z] = [at.x, at.y, at.z].map(|length| fixed(length * 1e3, LENGTH));
    let [q1, q2, q3, q4] = angles::to_wxyz(&pose.rotation).map(|part| fixed(part, QUATERNION));
    [x, y, z, q1, q2, q3, q4]
}
