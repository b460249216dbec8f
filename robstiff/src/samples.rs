//! Robots and poses for the tests.

use nalgebra::SVector;
pub use robstiff_robots::samples::{arm, five_axis, linear_effects, odd};

/// A few poses all over the workspace.
pub fn poses<const N: usize>() -> impl Iterator<Item = SVector<f64, N>> {
    robstiff_robots::samples::poses().map(SVector::from)
}
