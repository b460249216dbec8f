//! Where the tool is to be, and how far off it is.

use nalgebra::{Matrix3, Matrix4, Rotation3, Unit, UnitQuaternion, Vector3};

/// A pose of the tool centre point (TCP) in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The TCP (m).
    pub position: Vector3<f64>,
    /// The tool's orientation.
    pub orientation: Orientation,
}

/// How the tool is to be turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Orientation {
    /// In full: the TCP's frame in the base frame.
    Full(Rotation3<f64>),
    /// One axis of the tool is to point in a direction, the turn about it is
    /// free: what an arm of five axes can do.
    Axis {
        /// The axis in the TCP's frame.
        tool: Unit<Vector3<f64>>,
        /// Its direction in the base frame.
        direction: Unit<Vector3<f64>>,
    },
    /// Any: all that an arm of fewer than five axes can be asked for.
    Free,
}

impl Orientation {
    /// The same after a turn in the base frame.
    pub(crate) fn turned(self, turn: &Rotation3<f64>) -> Self {
        match self {
            Self::Full(rotation) => Self::Full(turn * rotation),
            Self::Axis { tool, direction } => Self::Axis { tool, direction: turn * direction },
            Self::Free => Self::Free,
        }
    }
}

/// How far a pose is from its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remaining {
    /// The distance of the TCP (m).
    pub distance: f64,
    /// The angle of the one turn to the orientation (rad).
    pub angle: f64,
}

impl Target {
    /// A pose in full, from a homogeneous 4 x 4 matrix (m).
    pub fn pose(pose: &Matrix4<f64>) -> Self {
        Self { position: translation(pose), orientation: Orientation::Full(rotation(pose)) }
    }

    /// A position (m), and the direction in the base frame of an axis of the
    /// TCP's frame.
    pub fn axis(position: Vector3<f64>, tool: Unit<Vector3<f64>>, direction: Unit<Vector3<f64>>) -> Self {
        Self { position, orientation: Orientation::Axis { tool, direction } }
    }

    /// The same target when the frame that it is given in stands at `place`
    /// (homogeneous, 4 x 4, m) in the base frame.
    #[must_use]
    pub fn placed(&self, place: &Matrix4<f64>) -> Self {
        let turn = rotation(place);
        Self { position: turn * self.position + translation(place), orientation: self.orientation.turned(&turn) }
    }

    /// How far a pose of the TCP (homogeneous, 4 x 4, m) is from this target.
    pub fn remaining(&self, pose: &Matrix4<f64>) -> Remaining {
        let (shift, turn) = self.apart(pose);
        Remaining { distance: shift.norm(), angle: turn.norm() }
    }

    /// The translation (m) and the rotation vector (rad) in the base frame that
    /// bring a pose of the TCP to this target.
    pub(crate) fn apart(&self, pose: &Matrix4<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let current: Matrix3<f64> = pose.fixed_view::<3, 3>(0, 0).into_owned();
        let turn = match &self.orientation {
            Orientation::Full(rotation) => rotation_vector(&(rotation.matrix() * current.transpose())),
            Orientation::Axis { tool, direction } => turn_between(&(current * tool.as_ref()), direction),
            Orientation::Free => Vector3::zeros(),
        };
        (self.position - translation(pose), turn)
    }
}

/// The last column of a homogeneous matrix.
pub(super) fn translation(pose: &Matrix4<f64>) -> Vector3<f64> {
    pose.fixed_view::<3, 1>(0, 3).into_owned()
}

/// The rotation of a homogeneous matrix.
pub(super) fn rotation(pose: &Matrix4<f64>) -> Rotation3<f64> {
    Rotation3::from_matrix_unchecked(pose.fixed_view::<3, 3>(0, 0).into_owned())
}

/// The rotation vector of a rotation. nalgebra's own takes the arc cosine of the
/// trace, which has lost small angles.
fn rotation_vector(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let odd = Vector3::new(
        rotation[(2, 1)] - rotation[(1, 2)],
        rotation[(0, 2)] - rotation[(2, 0)],
        rotation[(1, 0)] - rotation[(0, 1)],
    ) * 0.5;
    let (sin, cos) = (odd.norm(), 0.5 * (rotation.trace() - 1.0));
    if sin > 1e-6 {
        odd * (sin.atan2(cos) / sin)
    } else if cos > 0.0 {
        odd
    } else {
        // Half a turn has no odd part to tell its axis by.
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*rotation)).scaled_axis()
    }
}

/// The shortest rotation vector from one direction to another; between
/// opposite ones about any axis across.
fn turn_between(from: &Vector3<f64>, to: &Vector3<f64>) -> Vector3<f64> {
    let across = from.cross(to);
    let (sin, cos) = (across.norm(), from.dot(to));
    if sin > 1e-9 {
        across * (sin.atan2(cos) / sin)
    } else if cos > 0.0 {
        across
    } else {
        any_across(from) * core::f64::consts::PI
    }
}

/// A unit vector across another vector.
pub(super) fn any_across(vector: &Vector3<f64>) -> Vector3<f64> {
    let mut unit = Vector3::zeros();
    unit[vector.iamin()] = 1.0;
    vector.cross(&unit).normalize()
}
