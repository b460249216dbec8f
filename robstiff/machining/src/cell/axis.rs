//! What a description tells of the spindle's direction.

use nalgebra::{Unit, Vector3};
use robstiff_robots::{Convention, Description, Joint};

/// The axis of the TCP's frame from the spindle to the tip, where a description tells it; it is z then.
///
/// A `tool` with a turn of its own (`rpy`) has the spindle along its z. Without one, the spindle is taken
/// to go on along the axis of the last joint, where the z axis of the flange lies on that, and the tool
/// does not stand out beside it. An arm whose last joint tilts the spindle tells nothing.
pub fn axis_of(robot: &Description) -> Option<Unit<Vector3<f64>>> {
    let ([x, y, z], turn) = (robot.tool.xyz, robot.tool.rpy);
    let is_beside = x.hypot(y) > 0.0 && z <= x.hypot(y);
    let tells = turn != [0.0; 3] || !is_beside && robot.joints.last().is_some_and(|last| turns_flange(robot, last));
    tells.then(Vector3::z_axis)
}

/// Whether the z axis of the flange lies on the axis of the last joint.
fn turns_flange(robot: &Description, last: &Joint) -> bool {
    match robot.convention {
        // The length and the twist come behind the joint.
        Convention::Standard => last.a == 0.0 && last.alpha.sin().abs() < 1e-9,
        Convention::Modified => true,
    }
}
