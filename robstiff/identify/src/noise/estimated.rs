//! What the contrasts of a campaign say of its noise, where so much is free at each pose.

use super::contrasts::{Chunk, Level};
use super::outliers::{self, Outlier};
use super::reml::{Share, count, profile, share, sums};
use super::tails::{self, Tails};
use super::{FEWEST, NOISELESS, WILD};
use crate::probability::{chi_square_tail, fisher_tail, told};

/// What contrasts say.
pub struct Estimated {
    /// How much is free.
    pub level: Level,
    /// The contrasts.
    pub chunks: Vec<Chunk>,
    axes: usize,
    /// `lambda`.
    pub shared: f64,
    /// What is known of it.
    pub share: Option<Share>,
    /// The variance of each axis (m^2, rad^2).
    pub variances: Vec<f64>,
}

impl Estimated {
    /// `None` where there are too few contrasts.
    pub fn at(level: Level, chunks: Vec<Chunk>, axes: usize) -> Option<Self> {
        if count(&chunks) < FEWEST {
            return None;
        }
        let share = share(&chunks, axes);
        let single = chunks.iter().all(|chunk| chunk.shares.iter().all(|share| (share - 1.0).abs() < 1e-6));
        let shared = match share {
            // Neither no unloaded reading in common nor a whole one is ruled out.
            Some(Share { interval: [from, to], .. }) if from == 0.0 && to >= 1.0 => 1.0,
            Some(share) => share.value.min(1.0),
            // Every row has its own: what is shared and what is not are one.
            None if single => 0.0,
            None => 1.0,
        };
        let variances = profile(&chunks, axes, shared).variances;
        if variances[..3].iter().all(|variance| *variance < NOISELESS * NOISELESS) {
            return None;
        }
        Some(Self { level, chunks, axes, shared, share, variances })
    }

    /// The probability of contrasts as much larger than those with more freed,
    /// were they noise alike.
    pub fn hides_structure(&self, freer: &Self) -> Option<f64> {
        // An uncertain share is no evidence against the fewer.
        let shared = self.share.map_or(self.shared, |share| share.interval[1].min(1.0));
        let of = |chunks: &[Chunk]| (sums(chunks, self.axes, shared), count(chunks) as f64);
        beyond_noise(of(&self.chunks), of(&freer.chunks))
    }

    /// The readings that are outlying.
    pub fn wild(&self) -> Vec<Outlier> {
        if self.variances.iter().any(|&variance| variance <= 0.0) {
            return Vec::new();
        }
        outliers::find(&self.chunks, self.axes, self.shared, &self.variances, WILD)
    }

    /// The tails of what is left.
    pub fn tails(&self) -> Option<Tails> {
        tails::tails(&self.chunks, self.axes, self.shared, &self.variances)
    }
}

/// The probability, were all of it noise, that the sums of squares of each axis are so
/// much larger than those with more freed, each of so many contrasts an axis: an F test
/// of each axis, for each has a variance of its own, and all together by Fisher's method
/// (Statistical Methods for Research Workers, 4th ed., 1932, section 21.1). An axis that
/// was not read, all of whose readings are zero, says nothing.
pub fn beyond_noise((all, contrasts): (Vec<f64>, f64), (freer, fewer): (Vec<f64>, f64)) -> Option<f64> {
    let freedom = [contrasts - fewer, fewer];
    let of_axis = |(all, freer): (&f64, &f64)| {
        let ratio = (all - freer).max(0.0) / freedom[0] / (freer / freedom[1]);
        Some(-2.0 * told(fisher_tail(ratio, freedom)?).ln())
    };
    let read = all.iter().zip(&freer).filter(|(all, _)| **all > 0.0);
    let statistics: Vec<f64> = read.map(of_axis).collect::<Option<_>>()?;
    chi_square_tail(statistics.iter().sum(), 2.0 * statistics.len() as f64)
}

/// Bartlett's test (Proceedings of the Royal Society A 160, 1937) of equal
/// variances with as many degrees of freedom each.
pub fn bartlett(variances: &[f64], freedom: f64) -> Option<f64> {
    let count = variances.len() as f64;
    let mean = variances.iter().sum::<f64>() / count;
    if variances.iter().any(|&variance| variance <= 0.0) || freedom <= 0.0 {
        return None;
    }
    let statistic = freedom * variances.iter().map(|variance| (mean / variance).ln()).sum::<f64>();
    let correction = 1.0 + (count + 1.0) / (3.0 * count * freedom);
    chi_square_tail(statistic / correction, count - 1.0)
}
