//! Orientations as controllers give them.

use nalgebra::{Rotation3, UnitQuaternion};

/// The rotation of KUKA's angles A, B, C (rad): about z, then the new y, then the
/// new x. FANUC's W, P, R are the same with `a = R`, `b = P`, `c = W`: about the
/// fixed x, y, z.
pub fn from_abc([a, b, c]: [f64; 3]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_euler_angles(c, b, a)
}

/// KUKA's angles A, B, C (rad) of a rotation, with B from -90 to 90 degrees.
///
/// Where B is 90 degrees, A alone is not determined; the three together give the
/// rotation to the last digits there, too.
pub fn to_abc(rotation: &UnitQuaternion<f64>) -> [f64; 3] {
    let matrix: Rotation3<f64> = rotation.to_rotation_matrix();
    let m = matrix.matrix();
    let horizontal = m[(0, 0)].hypot(m[(1, 0)]);
    let a = if horizontal > 1e-12 { m[(1, 0)].atan2(m[(0, 0)]) } else { 0.0 };
    let (sin, cos) = a.sin_cos();
    let b = (-m[(2, 0)]).atan2(cos * m[(0, 0)] + sin * m[(1, 0)]);
    // From what is left when A is undone: it makes up for its rounding near 90 degrees.
    let c = (sin * m[(0, 2)] - cos * m[(1, 2)]).atan2(cos * m[(1, 1)] - sin * m[(0, 1)]);
    [a, b, c]
}

/// The quaternion w, x, y, z of a rotation; of the two the one whose first part that
/// is not zero is positive.
pub fn to_wxyz(rotation: &UnitQuaternion<f64>) -> [f64; 4] {
    let parts = [rotation.w, rotation.i, rotation.j, rotation.k];
    let sign = parts.into_iter().find(|part| part.abs() > 1e-9).map_or(1.0, f64::signum);
    parts.map(|part| part * sign)
}
