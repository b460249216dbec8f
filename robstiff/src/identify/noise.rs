//! The noise of a reading, from readings that were repeated.

use super::covariance::Covariance;
use super::covariance::contrasts::Level;
use super::samples::Samples;

/// A sum of squares due to noise alone, and its degrees of freedom.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PureError {
    /// The sum of squares of displacements, whitened (m^2).
    pub sum: f64,
    /// Its degrees of freedom.
    pub freedom: usize,
}

impl PureError {
    /// The variance of one reading, if enough was repeated to say.
    pub fn variance(&self) -> Option<f64> {
        (self.freedom >= FEWEST_REPETITIONS).then(|| self.sum / self.freedom as f64)
    }
}

/// With fewer degrees of freedom a variance is uncertain by half and more
/// (`sqrt(2 / 10)` is 45 %), and says too little to judge a model by.
const FEWEST_REPETITIONS: usize = 10;

/// What rows of one pose under one load differ by, on the poses for which
/// `of_pose` holds. Each pose gets a free displacement per load, fitted by
/// generalised least squares: any model of the robot in which the load alone
/// decides is inside that, so what it leaves is noise (or something that is not a
/// function of the load, such as hysteresis and drift).
pub fn repetitions(samples: &Samples, covariance: &Covariance, of_pose: impl Fn(usize) -> bool) -> PureError {
    covariance.pure_error(samples, Level::Repeated, of_pose)
}
