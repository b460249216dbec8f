//! How noisy the readings of a campaign are, and how they hang together.
//!
//! The rows of one axis and one visit have the covariance `v_a (I + lambda 1 1^T)`:
//! each axis its own variance `v_a`, in the frame it was measured in, and a share
//! `lambda` of the unloaded reading that a visit's rows have in common. Readings tell it
//! themselves, before any model of the robot ([`estimation`]).

pub mod contrasts;
mod estimated;
mod estimation;
pub mod outliers;
pub mod reml;
mod repeated;
pub mod samples;
pub mod straight;
pub mod tails;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use nalgebra::{DMatrix, Matrix3, Vector3};

use self::contrasts::{Chunk, Level, contrasts};
use self::reml::{count, sums};
use self::repeated::PureError;
use self::samples::{Sample, Samples};
use crate::campaign::{Frame, Noise};

pub use outliers::Outlier;
pub use reml::Share;
pub use tails::Tails;

/// Level at which more is freed at a pose.
pub const NESTED: f64 = 0.01;

/// Level at which axes have variances of their own.
pub const EQUAL_AXES: f64 = 0.05;

/// Family-wise level at which a reading is outlying.
pub const WILD: f64 = 0.01;

/// With fewer contrasts an axis a variance is uncertain by half and more
/// (`sqrt(2 / 10)` is 45 %).
const FEWEST: usize = 10;

/// Readings nearer than this to each other have no noise (m, or rad): they were made by a
/// program.
pub const NOISELESS: f64 = 1e-9;

/// Noise declared so many times as large as readings show is not theirs: from 30 degrees
/// of freedom on, the fewest asked for, chance makes it so once in 1e11.
const FAR_ABOVE: f64 = 3.0;

/// Where a covariance is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Contrasts within poses, with so much free at each.
    Contrasts(Level),
    /// Nothing: equal axes, and one unloaded reading a visit.
    Assumed,
}

/// The covariance of a campaign's readings.
#[derive(Clone, Debug)]
pub struct Covariance {
    /// The standard deviation of what a row has to itself: x, y, z (m), and
    /// where rotations are read rx, ry, rz (rad), in the frame measured.
    pub own: Vec<f64>,
    /// `lambda`: the variance of an unloaded reading over that.
    pub shared: f64,
    /// What the contrasts that are free of a linear response say of it.
    pub share: Option<Share>,
    /// Where it is from.
    pub basis: Basis,
    /// Contrasts of one axis.
    pub freedom: usize,
    /// The probability of variances as unequal as those of x, y, z, were they
    /// equal.
    pub equal_axes: Option<f64>,
    /// Whether the axes have variances of their own.
    pub unequal: bool,
    /// The readings that were set aside.
    pub outliers: Vec<Outlier>,
    visits: Vec<usize>,
    /// From the base frame to that measured in, a row each.
    turns: Option<Arc<[Matrix3<f64>]>>,
}

impl Covariance {
    /// Equal axes, one unloaded reading a visit; how noisy is not known.
    pub(crate) fn assumed(samples: &Samples, frame: Frame, declared: Noise) -> Self {
        let displacement = declared.displacement.unwrap_or(1.0);
        let rotation = declared.rotation.filter(|_| declared.displacement.is_some()).unwrap_or(displacement);
        Self {
            own: (0..samples.axes).map(|axis| if axis < 3 { displacement } else { rotation }).collect(),
            shared: 1.0,
            share: None,
            basis: Basis::Assumed,
            freedom: 0,
            equal_axes: None,
            unequal: false,
            outliers: Vec::new(),
            visits: samples.visits(),
            turns: (frame == Frame::Tool).then(|| samples.rows.iter().map(to_tool).collect()),
        }
    }

    /// Axes per row.
    pub fn axes(&self) -> usize {
        self.own.len()
    }

    /// One sigma of one axis of one displacement reading (m): a displacement is
    /// the difference of two, however they are shared. `None` where it is but
    /// assumed.
    pub fn reading(&self) -> Option<f64> {
        (self.basis != Basis::Assumed).then(|| self.reference(0..3))
    }

    /// Whether declared noise of a displacement reading (m) is another instrument's, or in
    /// another unit: far above what the readings say. Less than they say may be right, for
    /// what is no function of the load makes them differ, too; and readings [made by a
    /// program](NOISELESS) say nothing of an instrument.
    pub(crate) fn is_far_below(&self, declared: f64) -> bool {
        self.reading().is_some_and(|reading| reading > NOISELESS && FAR_ABOVE * reading < declared)
    }

    /// What displacements leave where so much is free at each pose for which
    /// `of_pose` holds, without the rows for which `without` holds, whitened. A model of the robot that is free of no more
    /// leaves at least as much of the same rows.
    pub(crate) fn pure_error(
        &self,
        samples: &Samples,
        level: Level,
        of_pose: impl Fn(usize) -> bool,
        without: impl Fn(usize) -> bool,
    ) -> PureError {
        let chunks = contrasts(samples, &self.measured(samples), level, of_pose, without);
        let reference = self.reference(0..3);
        let of_chunk = |chunk: &Chunk| -> (f64, usize) {
            let chunk = core::slice::from_ref(chunk);
            let sums = sums(chunk, 3, self.shared);
            let sum = sums.iter().zip(&self.own).map(|(sum, own)| sum * (reference / own).powi(2)).sum();
            (sum, 3 * count(chunk))
        };
        PureError::of(chunks.iter().map(of_chunk))
    }

    /// The variance of a sum of readings of one axis with the given weights, a
    /// pair of row and weight each (m^2, rad^2).
    pub(crate) fn variance(&self, axis: usize, weights: &[(usize, f64)]) -> f64 {
        let own: f64 = weights.iter().map(|(_, weight)| weight * weight).sum();
        let mut visits: Vec<(usize, f64)> = Vec::new();
        for &(row, weight) in weights {
            let visit = self.visits[row];
            match visits.iter_mut().find(|(known, _)| *known == visit) {
                Some((_, sum)) => *sum += weight,
                None => visits.push((visit, weight)),
            }
        }
        let common: f64 = visits.iter().map(|(_, sum)| sum * sum).sum();
        self.own[axis].powi(2) * (own + self.shared * common)
    }

    /// The root mean square of the readings' sigma over some axes.
    fn reference(&self, axes: core::ops::Range<usize>) -> f64 {
        let count = axes.len() as f64;
        let mean = self.own[axes].iter().map(|own| own * own).sum::<f64>() / count;
        mean.sqrt() * reading_of(self.shared)
    }

    /// The readings in the frame measured in, a row each.
    fn measured(&self, samples: &Samples) -> DMatrix<f64> {
        let mut readings = DMatrix::zeros(samples.rows.len(), samples.axes);
        for row in 0..samples.rows.len() {
            let read = samples.reading(row);
            for first in (0..samples.axes).step_by(3) {
                let three = Vector3::from_column_slice(&read[first..first + 3]);
                let turned = self.turns.as_ref().map_or(three, |turns| turns[row] * three);
                (0..3).for_each(|k| readings[(row, first + k)] = turned[k]);
            }
        }
        readings
    }
}

/// The noise of a reading over that which a row has to itself: the row is the difference of
/// a loaded and an unloaded reading, of which `shared` is `lambda`.
fn reading_of(shared: f64) -> f64 {
    (0.5 * (1.0 + shared)).sqrt()
}

/// What whitening takes from every row of a visit of `rows` rows: this factor
/// times the visit's mean; `shared` is `lambda`.
pub fn mean_share(rows: usize, shared: f64) -> f64 {
    1.0 - (1.0 / (1.0 + shared * rows as f64)).sqrt()
}

/// From the base frame to that of the tool.
fn to_tool(row: &Sample) -> Matrix3<f64> {
    row.tcp.turn.transpose()
}
