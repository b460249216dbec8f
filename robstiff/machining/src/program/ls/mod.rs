//! FANUC TP programs as text.
//!
//! W P R are turns about the fixed x, y, z, in degrees; CONFIG says the posture.
//! Joint 3 is counted from the ground, whatever joint 2 is: the `controller` of a
//! description says so. Frames are numbers; the controller alone knows where they
//! stand.

mod positions;
mod read;
mod write;

use super::writing::fixed;
use super::{Position, Target, angles};

pub use read::read;
pub use write::write;

/// Names of the parts of a pose.
const POSE: [&str; 6] = ["X", "Y", "Z", "W", "P", "R"];

/// Decimals of lengths (mm) and angles (degrees), as controllers print them.
const DECIMALS: usize = 3;

/// The numbers of a position, as they are written: X Y Z W P R or J1 and so on.
pub(super) fn numbers(position: &Position) -> Vec<String> {
    match &position.target {
        Target::Joints(angles) => angles.iter().map(|angle| fixed(angle.to_degrees(), DECIMALS)).collect(),
        Target::Pose(pose, _) => {
            let at = pose.translation.vector;
            let [r, p, w] = angles::to_abc(&pose.rotation).map(f64::to_degrees);
            [at.x * 1e3, at.y * 1e3, at.z * 1e3, w, p, r].map(|number| fixed(number, DECIMALS)).to_vec()
        }
    }
}
