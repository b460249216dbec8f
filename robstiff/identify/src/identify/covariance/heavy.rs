//! Whether noise has heavier tails than the normal distribution, by quantiles, which
//! readings that do not belong hardly move: tails show in many readings, outlying ones are
//! few.

use std::vec::Vec;

use statrs::distribution::{Continuous, ContinuousCDF, Normal, StudentsT};

use super::tails::GRID;

/// The quantiles of absolute residuals that are compared.
const QUANTILES: [f64; 2] = [0.5, 0.95];

/// The level at which tails are heavier than normal ones.
const HEAVIER: f64 = 0.01;

/// The degrees of freedom of Student's distribution that has the tails of residuals,
/// given as squares over a common variance; `None` where normal ones may have them.
/// `tells` is the share of their freedom that a model has left.
pub fn freedom_of_tails(squares: &[f64], tells: f64) -> Option<f64> {
    let mut sorted: Vec<f64> = squares.iter().map(|square| square.sqrt()).collect();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().saturating_sub(1) as f64;
    let [middle, high] = QUANTILES.map(|share| sorted.get((share * last).round() as usize).copied());
    let ratio = (high? / middle?).ln();
    let normal = Normal::standard();
    let of_normal = ratio_of(&normal);
    // Of quantiles, in logarithms (David, Order Statistics, 1981, 9.2).
    let [a, b] = QUANTILES.map(|share| {
        let quantile = normal.inverse_cdf(0.5 + 0.5 * share);
        (share, 2.0 * quantile * normal.pdf(quantile))
    });
    let covariance = |(p, dp): (f64, f64), (q, dq): (f64, f64)| p * (1.0 - q) / (dp * dq);
    let variance = covariance(a, a) + covariance(b, b) - 2.0 * covariance(a, b);
    let deviate = (ratio - of_normal) / (variance / (tells * sorted.len() as f64)).sqrt();
    if normal.sf(deviate) > HEAVIER || !deviate.is_finite() {
        return None;
    }
    let off = |freedom: f64| (ratio_of(&student(freedom)) - ratio).abs();
    GRID.into_iter().min_by(|a, b| off(*a).total_cmp(&off(*b)))
}

/// The square of the scale of Student's distribution over the variance that a median
/// gives where the residuals are taken for normal ones.
pub fn scale_of_tails(freedom: f64) -> f64 {
    (Normal::standard().inverse_cdf(0.75) / student(freedom).inverse_cdf(0.75)).powi(2)
}

/// The logarithm of the ratio of the quantiles.
fn ratio_of(distribution: &impl ContinuousCDF<f64, f64>) -> f64 {
    let [middle, high] = QUANTILES.map(|share| distribution.inverse_cdf(0.5 + 0.5 * share));
    (high / middle).ln()
}

fn student(freedom: f64) -> StudentsT {
    StudentsT::new(0.0, 1.0, freedom).expect("a degree of freedom is positive")
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::probability::normal;

    /// Squares of Student's variates, of normal ones where `freedom` is 0.
    fn squares(count: usize, freedom: usize, seed: u64) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let one = |_| {
            let square = normal(&mut random).powi(2);
            let of: f64 = (0..freedom).map(|_| normal(&mut random).powi(2)).sum();
            if freedom == 0 { square } else { square * freedom as f64 / of }
        };
        (0..count).map(one).collect()
    }

    /// Of 1000 at one in 100, with a few outlying ones left among them.
    #[test]
    fn normal_noise_has_no_heavy_tails() {
        for count in [60, 600] {
            let heavy = |seed: &u64| {
                let mut all = squares(count, 0, *seed);
                all[0] = 1e4;
                freedom_of_tails(&all, 1.0).is_some()
            };
            let heavy = (0..1000).filter(heavy).count();
            assert!(heavy <= 30, "{heavy} of 1000 with {count}");
        }
    }

    /// Without what is far out, as it is when this is asked.
    #[test]
    fn heavy_tails_are_known() {
        let of = |seed| {
            let mut left = squares(900, 3, seed);
            left.retain(|square| *square < 16.0);
            freedom_of_tails(&left, 1.0)
        };
        let found: Vec<f64> = (0..100).filter_map(of).collect();
        let like = found.iter().filter(|freedom| **freedom <= 8.0).count();
        assert!(like >= 95, "{like} of {} in 100", found.len());
    }

    #[test]
    fn the_scale_is_that_of_the_median() {
        for freedom in [3, 8] {
            let mut all = squares(40_001, freedom, 5);
            all.sort_by(f64::total_cmp);
            let by_median = all[20_000] / Normal::standard().inverse_cdf(0.75).powi(2);
            let scale = by_median * scale_of_tails(freedom as f64);
            assert!((scale - 1.0).abs() < 0.03, "{scale} with {freedom}");
        }
    }
}
