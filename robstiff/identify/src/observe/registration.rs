//! Where a robot stands in the frame that its positions are read in.

use nalgebra::{Isometry3, Matrix3, Rotation3, SymmetricEigen, Translation3, UnitQuaternion, Vector3};

/// Points that leave less than this of their size across a line do not tell how a frame is turned
/// about it.
const ON_A_LINE: f64 = 1e-6;

/// The motion that takes points nearest to others by least squares (Arun, Huang and Blostein, IEEE
/// Trans. PAMI 9, 1987; Umeyama 1991 for the reflection); none where numbers are not finite.
pub fn registration(points: &[Vector3<f64>], read: &[Vector3<f64>]) -> Isometry3<f64> {
    let (from, to) = (mean(points), mean(read));
    let spread: Matrix3<f64> = points.iter().zip(read).map(|(p, r)| (p - from) * (r - to).transpose()).sum();
    if !spread.iter().all(|number| number.is_finite()) {
        return Isometry3::identity();
    }
    let parts = spread.svd(true, true);
    let (Some(u), Some(v)) = (parts.u, parts.v_t.map(|v| v.transpose())) else { return Isometry3::identity() };
    let sign = (v * u.transpose()).determinant().signum();
    let turn = v * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * u.transpose();
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
    Isometry3::from_parts(Translation3::from(to - turn * from), turn)
}

/// What is said of points that do not.
pub const NOT_SPREAD: &str =
    "the positions do not tell where the robot stands: they are fewer than three, or on a line by its description";

/// Whether points tell how a frame is turned: they are three or more, finite, and not on a line.
pub fn are_spread(points: &[Vector3<f64>]) -> bool {
    let middle = mean(points);
    let spread: Matrix3<f64> = points.iter().map(|p| (p - middle) * (p - middle).transpose()).sum();
    if !spread.iter().all(|number| number.is_finite()) {
        return false;
    }
    let extents = SymmetricEigen::new(spread).eigenvalues;
    extents.sum() - extents.max() - extents.min() > ON_A_LINE * ON_A_LINE * extents.sum()
}

fn mean(points: &[Vector3<f64>]) -> Vector3<f64> {
    points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn a_motion_is_found_again() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        for _ in 0..200 {
            let mut three = |most: f64| Vector3::from_fn(|_, _| random.random_range(-most..most));
            let truth = Isometry3::new(three(5.0), three(3.0));
            let points: Vec<Vector3<f64>> = (0..4).map(|_| three(1.0)).collect();
            let read: Vec<Vector3<f64>> =
                points.iter().map(|x| truth.rotation * x + truth.translation.vector).collect();
            let found = registration(&points, &read);
            assert!((found.to_homogeneous() - truth.to_homogeneous()).amax() < 1e-11);
        }
    }

    /// Points in a plane tell, points on a line do not.
    #[test]
    fn a_line_tells_no_turn() {
        let spread = |point: fn(f64) -> Vector3<f64>| {
            are_spread(&(0..9).map(|k| point(f64::from(k))).collect::<Vec<Vector3<f64>>>())
        };
        assert!(!spread(|x| Vector3::new(x, 2.0 * x, 1.0)));
        assert!(!spread(|x| Vector3::new(x, x * x, 1e200 * x)));
        assert!(spread(|x| Vector3::new(x, x * x, 1.0)));
        assert!(!are_spread(&[Vector3::x(), Vector3::y()]));
    }
}
