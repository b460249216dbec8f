//! The noise of each pose, where poses differ in it: an arm that hangs far out
//! trembles, a tracker is less sure of what is far away.
//!
//! A pose has few rows, so its variance is drawn towards that of all poses by as much
//! as poses are alike: the empirical Bayes estimate (Smyth, Statistical Applications in
//! Genetics and Molecular Biology 3, 2004), here of logarithms, whose spread between
//! poses is that of DerSimonian and Laird (Controlled Clinical Trials 7, 1986).
//! It is taken from differences of neighbouring rows, which neither an unloaded reading
//! nor a slip moves.

use std::vec::Vec;

use super::{Scale, Visit};
use crate::probability::chi_square_tail;

/// The level at which poses differ in their noise.
const DIFFERS: f64 = 0.01;

/// The degrees of freedom that a difference of neighbours has, for they share rows
/// (von Neumann, Annals of Mathematical Statistics 12, 1941).
const OF_DIFFERENCE: f64 = 2.0 / 3.0;

/// Logarithms of the poses' variances over the common one: their mean, and the variance
/// that they have between them.
pub struct ByPose {
    mean: f64,
    between: f64,
    /// The share of the readings' freedom that the model has left.
    tells: f64,
}

/// The noise of a pose.
pub struct Noise {
    /// Its variance over the common one, at least 1.
    pub times: f64,
    /// How well that is known.
    pub freedom: f64,
}

/// A logarithm of a variance, with its own variance.
#[derive(Clone, Copy)]
struct Log {
    value: f64,
    variance: f64,
}

impl ByPose {
    /// What the rows used say; `None` where the poses do not differ.
    pub fn of(visits: &[Visit], scale: &Scale, tells: f64) -> Option<Self> {
        let count = visits.iter().map(|visit| visit.pose + 1).max()?;
        let of_pose = |pose: usize| Differences::of(visits, pose, None, scale).log(tells);
        let logs: Vec<Log> = (0..count).filter_map(of_pose).collect();
        let mean = |between: f64| {
            let weight = |log: &Log| 1.0 / (log.variance + between);
            logs.iter().map(|log| weight(log) * log.value).sum::<f64>() / logs.iter().map(weight).sum::<f64>()
        };
        let alike = mean(0.0);
        let spread: f64 = logs.iter().map(|log| (log.value - alike).powi(2) / log.variance).sum();
        let freedom = logs.len() as f64 - 1.0;
        if chi_square_tail(spread, freedom)? > DIFFERS {
            return None;
        }
        let weights: f64 = logs.iter().map(|log| 1.0 / log.variance).sum();
        let squares: f64 = logs.iter().map(|log| log.variance.powi(-2)).sum();
        let between = (spread - freedom) / (weights - squares / weights);
        (between > 0.0).then(|| Self { mean: mean(between), between, tells })
    }

    /// The noise of a visit's pose, if what a pattern says is wrong with the visit.
    pub fn noise(&self, visits: &[Visit], visit: usize, pattern: &[f64], scale: &Scale) -> Noise {
        let (value, variance) = self.log(visits, visit, Some(pattern), scale);
        Noise { times: value.exp().max(1.0), freedom: 2.0 / variance }
    }

    /// The variance at a visit's pose over the common one.
    pub fn times(&self, visits: &[Visit], visit: usize, scale: &Scale) -> f64 {
        self.log(visits, visit, None, scale).0.exp()
    }

    /// Its logarithm, and the variance of that.
    fn log(&self, visits: &[Visit], visit: usize, pattern: Option<&[f64]>, scale: &Scale) -> (f64, f64) {
        let wrong = pattern.map(|pattern| (visit, pattern));
        let own = Differences::of(visits, visits[visit].pose, wrong, scale).log(self.tells);
        // A pose that says nothing is one of them.
        own.map_or((self.mean, self.between), |log| {
            let together = log.variance + self.between;
            let value = (self.between * log.value + log.variance * self.mean) / together;
            (value, self.between * log.variance / together)
        })
    }
}

/// The squares of differences of neighbouring rows of a pose, over twice the common
/// variance.
#[derive(Default)]
struct Differences {
    sum: f64,
    count: usize,
}

impl Differences {
    /// Those of a pose, but for what a pattern says is wrong with one of the visits.
    fn of(visits: &[Visit], pose: usize, wrong: Option<(usize, &[f64])>, scale: &Scale) -> Self {
        let mut found = Self::default();
        // The last rows, of those that the pattern moves and of the others.
        let mut last = [None; 2];
        for (k, visit) in visits.iter().enumerate().filter(|(_, visit)| visit.pose == pose) {
            let pattern = wrong.filter(|(visit, _)| *visit == k).map(|(_, pattern)| pattern);
            // Visits of one row have each an unloaded reading of its own.
            let alone = visit.rows.len() == 1;
            let variance = if alone { 1.0 + visit.shared } else { 1.0 };
            if !alone {
                last = [None; 2];
            }
            for i in (0..visit.rows.len()).filter(|&i| visit.used[i]) {
                let moved = pattern.is_some_and(|pattern| pattern[i] != 0.0);
                let before = last[usize::from(moved)].replace(visit.residuals[i]);
                if let Some(before) = before {
                    let squares = (visit.residuals[i] - before).map(|length| length * length);
                    found.sum += squares.component_div(&scale.variance).sum() / (2.0 * variance);
                    found.count += 3;
                }
            }
        }
        found
    }

    /// The logarithm of their mean, of which few are biased.
    fn log(&self, tells: f64) -> Option<Log> {
        let freedom = OF_DIFFERENCE * tells * self.count as f64;
        let value = (self.sum / self.count as f64).ln() + 1.0 / freedom;
        value.is_finite().then(|| Log { value, variance: 2.0 / freedom * (1.0 + 1.0 / freedom) })
    }
}

#[cfg(test)]
mod tests {
    use std::vec;

    use nalgebra::Vector3;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::probability::normal;

    const ONE: Scale = Scale { variance: Vector3::new(1.0, 1.0, 1.0), freedom: 1e6, thirds: [1.0; 3] };

    /// Forty poses of two visits of five rows, each pose with a standard deviation.
    fn visits(deviation: impl Fn(usize) -> f64, seed: u64) -> Vec<Visit> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let visit = |k: usize| {
            let pose = k / 2;
            let mut reading = || Vector3::from_fn(|_, _| deviation(pose) * normal(&mut random));
            let unloaded = reading();
            let residuals = (0..5).map(|_| reading() - unloaded).collect();
            let (rows, used) = ((0..5).collect(), vec![true; 5]);
            Visit { pose, shared: 1.0, rows, used, residuals, loads: vec![], thirds: vec![0; 5] }
        };
        (0..80).map(visit).collect()
    }

    fn found(deviation: impl Fn(usize) -> f64 + Copy) -> Vec<ByPose> {
        (0..100).filter_map(|seed| ByPose::of(&visits(deviation, seed), &ONE, 1.0)).collect()
    }

    #[test]
    fn poses_of_one_noise_do_not_differ() {
        let found = found(|_| 1.0).len();
        assert!(found <= 4, "{found} of 100");
    }

    /// Half of them with twice the deviation: the logarithms of the variances have the
    /// mean `ln 2` and that for standard deviation.
    #[test]
    fn poses_that_differ_are_noticed() {
        let found = found(|pose| if pose % 2 == 0 { 1.0 } else { 2.0 });
        let of = |number: fn(&ByPose) -> f64| found.iter().map(number).sum::<f64>() / found.len() as f64;
        let (mean, deviation) = (of(|by_pose| by_pose.mean), of(|by_pose| by_pose.between).sqrt());
        assert!(found.len() >= 99, "{} of 100", found.len());
        let expected = core::f64::consts::LN_2;
        assert!((mean - expected).abs() < 0.1 && (deviation - expected).abs() < 0.1, "{mean} {deviation}");
    }

    #[test]
    fn a_noisy_pose_has_its_own_noise_and_a_quiet_one_that_of_all() {
        let visits = visits(|pose| if pose % 4 == 0 { 4.0 } else { 1.0 }, 1);
        let by_pose = ByPose::of(&visits, &ONE, 1.0).expect("they differ");
        let noise = |visit: usize| by_pose.noise(&visits, visit, &[0.0; 5], &ONE);
        let mean = |pose: usize| (0..10).map(|k| noise(8 * k + 2 * pose).times).sum::<f64>() / 10.0;
        let (noisy, quiet) = (mean(0), mean(1));
        assert!((10.0..20.0).contains(&noisy) && (1.0..1.3).contains(&quiet), "{noisy} {quiet}");
        // Better known than from 24 differences alone.
        assert!(noise(0).freedom > 16.0 && noise(0).freedom < 30.0, "{}", noise(0).freedom);
    }

    /// Rows that are off by the same are no noise.
    #[test]
    fn what_is_wrong_is_no_noise() {
        let whole = visits(|pose| if pose % 2 == 0 { 1.0 } else { 2.0 }, 2);
        let by_pose = ByPose::of(&whole, &ONE, 1.0).expect("they differ");
        for first in 0..5 {
            for pattern in [whole[6].from(first), whole[6].single(first)] {
                let mut slipped = whole.clone();
                for (left, share) in slipped[6].residuals.iter_mut().zip(&pattern) {
                    *left += Vector3::new(30.0, -20.0, 10.0) * *share;
                }
                let [with, without] = [&slipped, &whole].map(|visits| by_pose.noise(visits, 6, &pattern, &ONE));
                assert!((with.times - without.times).abs() < 1e-9 && with.freedom == without.freedom);
            }
        }
    }
}
