//! Rigid frames and finite rotations.

use nalgebra::{Matrix3, Vector3};
use robstiff_robots::Placement;

/// Where one body stands in another: a turn, and the origin (m).
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub turn: Matrix3<f64>,
    pub origin: Vector3<f64>,
}

impl Frame {
    /// No turn, no shift.
    pub fn identity() -> Self {
        Self { turn: Matrix3::identity(), origin: Vector3::zeros() }
    }

    /// A turn by a rotation vector (rad) about the origin.
    pub fn turned(vector: Vector3<f64>) -> Self {
        Self { turn: exp(&vector), origin: Vector3::zeros() }
    }

    /// A shift (m) without a turn.
    pub fn shifted(by: Vector3<f64>) -> Self {
        Self { turn: Matrix3::identity(), origin: by }
    }

    /// A placement of a description.
    pub fn placed(at: &Placement) -> Self {
        let [roll, pitch, yaw] = at.rpy;
        let turn = exp(&(Vector3::z() * yaw)) * exp(&(Vector3::y() * pitch)) * exp(&(Vector3::x() * roll));
        Self { turn, origin: Vector3::from(at.xyz) }
    }

    /// A turn, without a shift, whose z axis points along `direction`, which is
    /// not zero. The other two axes are of no particular direction.
    pub fn facing(direction: &Vector3<f64>) -> Self {
        let z = direction.normalize();
        // The axis farthest from z makes the best conditioned perpendicular.
        let x = z.cross(&Vector3::ith(z.iamin(), 1.0)).normalize();
        Self { turn: Matrix3::from_columns(&[x, z.cross(&x), z]), origin: Vector3::zeros() }
    }

    /// The frame `next`, given in this one, seen from where this one is seen.
    pub fn then(&self, next: &Self) -> Self {
        Self { turn: self.turn * next.turn, origin: self.turn * next.origin + self.origin }
    }

    /// The turn the other way, about the same origin; only for pure turns.
    pub fn turned_back(&self) -> Self {
        Self { turn: self.turn.transpose(), origin: Vector3::zeros() }
    }
}

/// `sin(t) / t`, `(1 - cos t) / t^2` and `(t - sin t) / t^3` of the length `t`
/// of a rotation vector, from series where the closed forms cancel.
#[inline]
fn ratios(vector: &Vector3<f64>) -> [f64; 3] {
    // Each term of a series by the one before it. Springs turn in every round of every
    // load, so these are products and not quotients.
    const FIRST: [f64; 5] = [1.0 / 6.0, 1.0 / 20.0, 1.0 / 42.0, 1.0 / 72.0, 1.0 / 110.0];
    const SECOND: [f64; 5] = [1.0 / 12.0, 1.0 / 30.0, 1.0 / 56.0, 1.0 / 90.0, 1.0 / 132.0];
    const THIRD: [f64; 5] = [1.0 / 20.0, 1.0 / 42.0, 1.0 / 72.0, 1.0 / 110.0, 1.0 / 156.0];
    let square = vector.norm_squared();
    if square < 1e-2 {
        // The first terms left out are below 1e-17.
        let sum = |terms: [f64; 5]| terms.iter().rev().fold(0.0, |rest, term| (1.0 - rest) * (term * square));
        return [1.0 - sum(FIRST), 0.5 * (1.0 - sum(SECOND)), (1.0 - sum(THIRD)) / 6.0];
    }
    let angle = square.sqrt();
    let (sin, cos) = angle.sin_cos();
    [sin / angle, (1.0 - cos) / square, (angle - sin) / (square * angle)]
}

/// The rotation matrix of a rotation vector (rad).
pub(super) fn exp(vector: &Vector3<f64>) -> Matrix3<f64> {
    let [first, second, _] = ratios(vector);
    let (along, half) = (vector * first, vector * second);
    let [xx, yy, zz] = [half.x * vector.x, half.y * vector.y, half.z * vector.z];
    let [xy, yz, zx] = [half.x * vector.y, half.y * vector.z, half.z * vector.x];
    Matrix3::new(
        1.0 - (yy + zz),
        xy - along.z,
        zx + along.y,
        xy + along.z,
        1.0 - (zz + xx),
        yz - along.x,
        zx - along.y,
        yz + along.x,
        1.0 - (xx + yy),
    )
}

/// The rotation vector (rad) of a rotation matrix, for turns well below pi.
pub(super) fn log(turn: &Matrix3<f64>) -> Vector3<f64> {
    // Small turns live in the skew part alone, which so keeps all its digits.
    let skew = Vector3::new(turn.m32 - turn.m23, turn.m13 - turn.m31, turn.m21 - turn.m12) * 0.5;
    let sin = skew.norm();
    if sin == 0.0 { skew } else { skew * (sin.atan2((turn.trace() - 1.0) * 0.5) / sin) }
}

/// What a moment, given in the frame before the turn by `vector`, does along
/// the three components of `vector`: its virtual work per change of each.
///
/// Away from zero these are not the moment's own components, for a change of a
/// rotation vector is not a small turn about the same axis.
pub(super) fn work_on(vector: &Vector3<f64>, moment: &Vector3<f64>) -> Vector3<f64> {
    let [_, second, third] = ratios(vector);
    let once = vector.cross(moment);
    moment - once * second + vector.cross(&once) * third
}

/// A wrench seen from a frame with these axes.
pub(super) fn in_frame(axes: &Matrix3<f64>, wrench: &[f64; 6]) -> [f64; 6] {
    let turned = |first: usize| axes.tr_mul(&Vector3::from_column_slice(&wrench[first..first + 3]));
    let (force, moment) = (turned(0), turned(3));
    [force.x, force.y, force.z, moment.x, moment.y, moment.z]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_meet_closed_forms() {
        // On both sides of the switch at a length of 0.1.
        for angle in [0.02_f64, 0.09999, 0.10001, 1.3] {
            let vector = Vector3::new(0.6, 0.0, -0.8) * angle;
            let (sin, cos) = angle.sin_cos();
            let [first, second, third] = ratios(&vector);
            assert!((first - sin / angle).abs() < 1e-15);
            assert!((second - (1.0 - cos) / angle.powi(2)).abs() < 1e-12);
            assert!((third - (angle - sin) / angle.powi(3)).abs() < 1e-11);
        }
    }

    #[test]
    fn log_undoes_exp() {
        for vector in [Vector3::new(3e-9, -2e-9, 1e-9), Vector3::new(0.3, -1.1, 0.7), Vector3::zeros()] {
            let turn = exp(&vector);
            assert!((turn * turn.transpose() - Matrix3::identity()).norm() < 1e-15);
            assert!((log(&turn) - vector).norm() < 1e-15);
        }
    }

    #[test]
    fn work_is_that_of_the_turn() {
        // The virtual turn from differences of whole rotations.
        let vector = Vector3::new(0.4, -0.7, 0.2);
        let moment = Vector3::new(5.0, 3.0, -4.0);
        let step = 1e-6;
        for axis in 0..3 {
            let change = Vector3::ith(axis, step);
            let turn = log(&(exp(&(vector + change)) * exp(&(vector - change)).transpose()));
            let work = moment.dot(&turn) / (2.0 * step);
            assert!((work_on(&vector, &moment)[axis] - work).abs() < 1e-8);
        }
    }

    #[test]
    fn facing_is_a_rotation() {
        for direction in [Vector3::x() * 2.0, Vector3::new(0.1, -3.0, 1.0), -Vector3::z()] {
            let turn = Frame::facing(&direction).turn;
            assert!((turn.determinant() - 1.0).abs() < 1e-14);
            assert!((turn * Vector3::z() * direction.norm() - direction).norm() < 1e-14);
        }
    }
}
