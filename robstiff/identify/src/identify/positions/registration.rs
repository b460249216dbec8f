//! Where a robot's base stands in the frame that its positions are read in.

use nalgebra::{Matrix4, Rotation3, SymmetricEigen, UnitQuaternion, Vector3};

/// A rigid motion from the base frame to the one that positions are read in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Registration {
    /// The turn.
    pub turn: Rotation3<f64>,
    /// The base's origin (m).
    pub at: Vector3<f64>,
}

/// Points that leave less than this of their size across a line do not tell how a
/// frame is turned about it.
const ON_A_LINE: f64 = 1e-6;

impl Registration {
    /// The motion that takes points nearest to readings, by least squares: the turn
    /// is the quaternion to the largest eigenvalue of a 4 x 4 matrix (Horn, Journal
    /// of the Optical Society of America A 4, 1987, 629-642). `None` where the points
    /// are on a line, or beyond all numbers.
    pub fn fitted(pairs: impl Iterator<Item = (Vector3<f64>, Vector3<f64>)> + Clone) -> Option<Self> {
        let count = pairs.clone().count().max(1) as f64;
        let sums = pairs.clone().fold((Vector3::zeros(), Vector3::zeros()), |(a, b), (x, y)| (a + x, b + y));
        let (centre, read) = (sums.0 / count, sums.1 / count);
        let mut product = nalgebra::Matrix3::zeros();
        let (mut size, mut spread) = (0.0, nalgebra::Matrix3::zeros());
        for (point, reading) in pairs {
            let (x, y) = (point - centre, reading - read);
            product += x * y.transpose();
            spread += x * x.transpose();
            size += x.norm_squared();
        }
        if !size.is_finite() || !product.iter().all(|value| value.is_finite()) {
            return None;
        }
        // The second largest extent of the points.
        let extents = SymmetricEigen::new(spread).eigenvalues;
        let across = size - extents.max() - extents.min();
        if across.is_nan() || across <= ON_A_LINE * ON_A_LINE * size {
            return None;
        }
        let s = |i: usize, j: usize| product[(i, j)];
        let (x, y, z) = (s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0));
        let (xy, xz, yz) = (s(0, 1) + s(1, 0), s(0, 2) + s(2, 0), s(1, 2) + s(2, 1));
        #[rustfmt::skip]
        let symmetric = Matrix4::new(
            s(0, 0) + s(1, 1) + s(2, 2), x, y, z,
            x, s(0, 0) - s(1, 1) - s(2, 2), xy, xz,
            y, xy, s(1, 1) - s(0, 0) - s(2, 2), yz,
            z, xz, yz, s(2, 2) - s(0, 0) - s(1, 1),
        );
        let eigen = SymmetricEigen::new(symmetric);
        let largest = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned();
        let quaternion = nalgebra::Quaternion::new(largest[0], largest[1], largest[2], largest[3]);
        let turn = UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix();
        Some(Self { turn, at: read - turn * centre })
    }

    /// A point of the base frame, in the other (m).
    pub fn placed(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.turn * point + self.at
    }

    /// A reading, in the base frame (m).
    pub fn in_base(&self, reading: &Vector3<f64>) -> Vector3<f64> {
        self.turn.inverse() * (reading - self.at)
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::vec::Vec;

    use super::*;

    #[test]
    fn a_motion_is_found_again() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        for _ in 0..200 {
            let mut three = |most: f64| Vector3::from_fn(|_, _| random.random_range(-most..most));
            let truth = Registration { turn: Rotation3::new(three(3.0)), at: three(5.0) };
            let points: Vec<Vector3<f64>> = (0..4).map(|_| three(1.0)).collect();
            let found = Registration::fitted(points.iter().map(|x| (*x, truth.placed(x)))).expect("no line");
            assert!((found.turn.matrix() - truth.turn.matrix()).amax() < 1e-12);
            assert!((found.at - truth.at).amax() < 1e-11);
            assert!((truth.in_base(&truth.placed(&points[0])) - points[0]).amax() < 1e-12);
        }
    }

    /// Points in a plane tell, points on a line do not.
    #[test]
    fn a_line_tells_no_turn() {
        let of = |point: fn(f64) -> Vector3<f64>| {
            Registration::fitted((0..9).map(move |k| (point(f64::from(k)), point(f64::from(k)))))
        };
        assert!(of(|x| Vector3::new(x, 2.0 * x, 1.0)).is_none());
        assert!(of(|x| Vector3::new(x, x * x, 1e200 * x)).is_none());
        let plane = of(|x| Vector3::new(x, x * x, 1.0)).expect("no line");
        assert!((plane.turn.matrix() - nalgebra::Matrix3::identity()).amax() < 1e-12);
    }
}
