//! A frame in another.

/// Where one frame stands in another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// The origin (m).
    pub xyz: [f64; 3],
    /// Roll, pitch, yaw about the fixed x, y, z axes (rad):
    /// `R = Rz(yaw) Ry(pitch) Rx(roll)`.
    pub rpy: [f64; 3],
}
