//! Universal Robots' URScript: a function with the motions.
//!
//! A pose `p[x, y, z, rx, ry, rz]` is in m, its orientation a rotation vector in rad; `[q1, .., q6]` are
//! angles of the joints in rad. Poses stand in the robot's base, or by `pose_trans` in a frame of the
//! program. Nothing says the posture: of those that reach a pose the controller takes the nearest to where
//! the arm is. Lines take angles, too: the controller goes to where they bring the tool.

mod arguments;
mod literal;
mod read;
mod routines;
mod write;

use super::writing::fixed;
use super::{Position, Target};

pub use read::read;
pub use write::write;

/// Decimals of lengths (m) and of angles (rad): a tenth of a micrometre, at an arm's length, too.
const DECIMALS: usize = 7;

/// The numbers of a position, as they are written: x, y, z, rx, ry, rz, or the angles.
pub(super) fn numbers(position: &Position) -> Vec<String> {
    let numbers = match &position.target {
        Target::Joints(angles) => angles.clone(),
        Target::Pose(pose, _) => {
            let (at, turn) = (pose.translation.vector, pose.rotation.scaled_axis());
            at.iter().chain(turn.iter()).copied().collect()
        }
    };
    numbers.into_iter().map(|number| fixed(number, DECIMALS)).collect()
}
