//! A robot's joint axes where all coordinates are zero, and turns about them.
//!
//! The pose of the tool is a product of turns about these axes, in the base
//! frame, and of the pose at zero (Brockett 1984), whatever the convention of
//! the DH table.

use nalgebra::{Matrix3, Matrix4, SVector, UnitComplex, Vector3};

use super::target::translation;
use robstiff::{JointKind, Robot};

/// The axis of a revolute joint in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Its unit vector.
    pub direction: Vector3<f64>,
    /// A point on it (m).
    pub point: Vector3<f64>,
}

/// A turn, as its cosine and sine: closed forms need no angles until the end.
pub type Turn = UnitComplex<f64>;

impl Axis {
    /// A vector turned about the axis' direction (Rodrigues).
    pub fn turn(&self, vector: &Vector3<f64>, by: Turn) -> Vector3<f64> {
        let along = self.direction * self.direction.dot(vector);
        along + (vector - along) * by.re + self.direction.cross(vector) * by.im
    }

    /// The columns of a matrix turned.
    pub fn turn_all(&self, matrix: &Matrix3<f64>, by: Turn) -> Matrix3<f64> {
        Matrix3::from_columns(&[0, 1, 2].map(|k| self.turn(&matrix.column(k).into_owned(), by)))
    }

    /// The turn about the axis that brings one vector to another, each seen
    /// along the axis; `None` where one of them is on it.
    pub fn turn_between(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> Option<Turn> {
        let from = from - self.direction * self.direction.dot(from);
        let (sin, cos) = (self.direction.dot(&from.cross(to)), from.dot(to));
        let (square, size) = (sin * sin + cos * cos, from.norm_squared());
        let length = square.sqrt();
        (size > 1e-24 && square > 1e-24 * to.norm_squared() * size)
            .then(|| Turn::from_cos_sin_unchecked(cos / length, sin / length))
    }

    /// The two turns about the axis after which a vector's part along `other`
    /// is `value`, or those that bring it nearest to that; `None` where every
    /// turn gives the same.
    pub fn turns_towards(&self, vector: &Vector3<f64>, other: &Vector3<f64>, value: f64) -> Option<[Turn; 2]> {
        let along = self.direction * self.direction.dot(vector);
        let cos = other.dot(&(vector - along));
        let sin = other.dot(&self.direction.cross(vector));
        let value = value - other.dot(&along);
        let length = (cos * cos + sin * sin).sqrt();
        if length <= 1e-12 * vector.norm() * other.norm() {
            return None;
        }
        let across = ((length - value) * (length + value)).max(0.0).sqrt();
        let middle = Turn::from_cos_sin_unchecked(cos / length, sin / length);
        let half = Turn::from_cos_sin_unchecked((value / length).clamp(-1.0, 1.0), across / length);
        Some([middle * half, middle * half.inverse()])
    }
}

/// The axes of an arm of revolute joints where all coordinates are zero, and
/// the pose of the tool there; `None` if a joint slides.
pub fn axes<const N: usize, R: Robot<N>>(robot: &R) -> Option<([Axis; N], Matrix4<f64>)> {
    axes_behind::<N, N, R>(robot, 0)
}

/// The same of the last `M` joints, those behind the first so many.
pub fn axes_behind<const N: usize, const M: usize, R: Robot<N>>(
    robot: &R,
    first: usize,
) -> Option<([Axis; M], Matrix4<f64>)> {
    if robot.joint_kinds()[first..].contains(&JointKind::Prismatic) {
        return None;
    }
    let zero = SVector::<f64, N>::zeros();
    let (pose, jacobian) = (robot.transform(&zero), robot.jacobian(&zero));
    let tcp = translation(&pose);
    let axes = core::array::from_fn(|i| {
        let i = i + first;
        let direction: Vector3<f64> = jacobian.fixed_view::<3, 1>(3, i).into_owned();
        let velocity: Vector3<f64> = jacobian.fixed_view::<3, 1>(0, i).into_owned();
        Axis { direction, point: tcp + direction.cross(&velocity) }
    });
    Some((axes, pose))
}

/// The point nearest to two axes, and how far apart they are (m); `None` for
/// parallel ones.
pub fn meeting(one: &Axis, other: &Axis) -> Option<(Vector3<f64>, f64)> {
    let across = one.direction.cross(&other.direction);
    let square = across.norm_squared();
    if square < 1e-6 {
        return None;
    }
    let apart = other.point - one.point;
    let on_one = one.point + one.direction * (apart.cross(&other.direction).dot(&across) / square);
    let on_other = other.point + other.direction * (apart.cross(&one.direction).dot(&across) / square);
    Some(((on_one + on_other) * 0.5, (on_one - on_other).norm()))
}
