//! The noise of a reading, from readings that were repeated.

use crate::probability::chi_square_tail;

/// A sum of squares due to noise alone, and its degrees of freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PureError {
    /// The sum of squares of displacements, whitened (m^2).
    pub sum: f64,
    /// Its degrees of freedom, were the noise the same at all poses.
    pub freedom: usize,
    /// How many of these count as one, for poses differ in their noise
    /// (Satterthwaite); 1 where they do not.
    pub unequal: f64,
}

impl PureError {
    /// From the sums of squares of poses with their degrees of freedom.
    pub fn of(poses: impl Iterator<Item = (f64, usize)>) -> Self {
        let (mut sum, mut freedom, mut squares) = (0.0, 0, 0.0);
        for (of_pose, count) in poses {
            sum += of_pose;
            freedom += count;
            // A variance squared is too large by two of its degrees of freedom.
            squares += of_pose * of_pose / (count + 2) as f64;
        }
        let unequal = if sum > 0.0 { (squares * freedom as f64 / (sum * sum)).max(1.0) } else { 1.0 };
        Self { sum, freedom, unequal }
    }

    /// The probability of so much if one reading has this noise (m), by chi-square.
    pub fn tail_beside(&self, noise: f64) -> Option<f64> {
        chi_square_tail(self.sum / (noise * noise), self.freedom as f64)
    }

    /// The variance of one reading, if enough was repeated to say.
    pub fn variance(&self) -> Option<f64> {
        (self.freedom >= FEWEST_REPETITIONS).then(|| self.sum / self.freedom as f64)
    }
}

/// With fewer degrees of freedom a variance is uncertain by half and more
/// (`sqrt(2 / 10)` is 45 %), and says too little to judge a model by.
const FEWEST_REPETITIONS: usize = 10;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_that_differ_have_fewer_degrees_of_freedom() {
        let of = |variances: [f64; 2]| PureError::of((0..40).map(|k| (1e6 * variances[k % 2], 1_000_000)));
        // Of `v` and `9 v` in equal numbers: 2 (1 + 81) / (1 + 9)^2.
        assert!((of([1.0, 9.0]).unequal - 1.64).abs() < 1e-5 && of([1.0, 1.0]).unequal == 1.0);
        assert_eq!((of([2.0, 2.0]).freedom, PureError::of([].into_iter()).variance()), (40_000_000, None));
    }
}
