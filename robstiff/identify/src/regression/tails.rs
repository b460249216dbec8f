//! Rows that are far off, and those that do not belong to the others.
//!
//! The noise is normal, contaminated with wider normal distributions (Lange, Little and Taylor, JASA 84, 1989). A row weighs
//! by the variance that is likely of it.

use statrs::function::gamma::ln_gamma;

use crate::probability::median;

/// By which factors the wider distributions are wider than the bulk. [`MORE`] times the last follows, up to the farthest
/// row.
const WIDER: [f64; 3] = [12.0, 60.0, 300.0];
/// See [`WIDER`].
const MORE: f64 = 5.0;

/// At most such a part of the rows is outlying: more of them are what the noise is like.
const MOST_OUTLYING: f64 = 0.1;
/// At least such a part may be.
const LEAST_OUTLYING: f64 = 1e-4;

/// Rounds until the part of the rows that is outlying is learned.
const ROUNDS: usize = 20;

/// The log-likelihood ratio from which on rows are reported as outlying: odds of three thousand.
const FOR_OUTLIERS: f64 = 8.0;
/// The one from which on they are beyond the tails of the others: odds of twenty.
const FOR_BEYOND: f64 = 3.0;

/// Of so many rows at most so many do not belong to the others.
pub fn most_apart(rows: usize) -> usize {
    ((MOST_OUTLYING * rows as f64) as usize).max(1)
}

/// Rows that do not belong to the others.
#[derive(Clone, Debug, Default)]
pub struct Apart {
    /// Those that are beyond the tails of the others.
    pub beyond: Vec<usize>,
    /// The log-likelihood ratio of outlying rows against none.
    pub for_outliers: f64,
    /// The log-likelihood ratio for any being beyond the tails.
    pub for_beyond: f64,
}

impl Apart {
    /// Those of which the odds leave no doubt.
    pub fn rows(&self) -> &[usize] {
        if self.for_outliers < FOR_OUTLIERS || self.for_beyond < FOR_BEYOND { &[] } else { &self.beyond }
    }

    /// The probability that they do not belong to the others.
    pub fn probability(&self) -> f64 {
        1.0 - (-self.for_beyond).exp()
    }
}

/// The weight of each row, and which do not belong to the others (by index), given the square of how far each is off
/// in so many axes, over a variance that all have. Where rows may be off by anything, such a row has no pull on the
/// others, however far it is off; else its weight is no less than that of the first of the wider distributions.
pub fn weigh(squares: &[f64], axes: f64, by_anything: bool) -> (Vec<f64>, Apart) {
    // The median of chi-square is its degrees of freedom less some 0.66.
    let bulk = median(squares.to_vec()) / (axes - 0.66).max(0.34);
    let squares: Vec<f64> = squares.iter().map(|square| if bulk > 0.0 { square / bulk } else { *square }).collect();
    let widths = if by_anything { widths(&squares) } else { WIDER[..1].to_vec() };
    // The logarithm of the density of each width over that of the bulk.
    let of_widths = |square: &f64| -> Vec<f64> {
        widths.iter().map(|width| 0.5 * square * (1.0 - 1.0 / (width * width)) - axes * width.ln()).collect()
    };
    let odds: Vec<Vec<f64>> = squares.iter().map(of_widths).collect();
    let any = |odds: &[f64]| log_sum(odds.iter().copied()) - (widths.len() as f64).ln();
    let outlying = |part: f64, odds: &[f64]| 1.0 / (1.0 + ((1.0 - part).ln() - part.ln() - any(odds)).exp());
    let mut part = LEAST_OUTLYING.max(0.01);
    for _ in 0..ROUNDS {
        let sum: f64 = odds.iter().map(|odds| outlying(part, odds)).sum();
        part = (sum / squares.len().max(1) as f64).clamp(LEAST_OUTLYING, MOST_OUTLYING);
    }
    let weight = |odds: &Vec<f64>| {
        let (outlying, all) = (outlying(part, odds), log_sum(odds.iter().copied()));
        let precision = |(width, odds): (&f64, &f64)| (odds - all).exp() / (width * width);
        1.0 - outlying + outlying * widths.iter().zip(odds).map(precision).sum::<f64>()
    };
    let ratio = |odds: &Vec<f64>| log_sum([(1.0 - part).ln(), part.ln() + any(odds)].into_iter());
    let (for_beyond, beyond) = beyond_tails(&squares, axes);
    let beyond = (0..squares.len()).filter(|&row| beyond[row]).collect();
    let apart = Apart { beyond, for_outliers: odds.iter().map(ratio).sum(), for_beyond };
    (odds.iter().map(weight).collect(), apart)
}

/// The degrees of freedom of the heavy-tailed distributions that are tried (the last is as good as
/// normal), and their sizes over that of the bulk.
const TAILS: [f64; 6] = [2.0, 3.0, 4.0, 6.0, 12.0, 1e3];
const TAIL_SIZES: [f64; 4] = [0.6, 0.75, 0.9, 1.05];

/// The parts of the rows that may be beyond the tails.
const PARTS_BEYOND: [f64; 3] = [0.003, 0.02, 0.08];

/// Which of some lengths squared, over the variance of the bulk, are beyond the tails of the others, and
/// the log-likelihood ratio for that: Student's distribution (Lange, Little and Taylor, JASA 84, 1989)
/// with some rows from a far wider normal one, against the likeliest without.
fn beyond_tails(squares: &[f64], axes: f64) -> (f64, Vec<bool>) {
    let tail = |square: f64, freedom: f64, size: f64| {
        ln_gamma(0.5 * (freedom + axes))
            - ln_gamma(0.5 * freedom)
            - axes * (0.5 * (core::f64::consts::PI * freedom).ln() + size.ln())
            - 0.5 * (freedom + axes) * (square / (freedom * size * size)).ln_1p()
    };
    let wide = |square: f64, wider: f64| {
        -axes * (0.5 * core::f64::consts::TAU.ln() + wider.ln()) - 0.5 * square / (wider * wider)
    };
    let widths = widths(squares);
    let any = |square: f64| log_sum(widths.iter().map(|&wider| wide(square, wider))) - (widths.len() as f64).ln();
    let mut wides: Vec<Vec<f64>> = vec![squares.iter().map(|&square| any(square)).collect()];
    wides.extend(WIDER.map(|wider| squares.iter().map(|&square| wide(square, wider)).collect()));
    let (mut without, mut best) = (f64::NEG_INFINITY, (f64::NEG_INFINITY, vec![false; squares.len()]));
    for freedom in TAILS {
        for size in TAIL_SIZES {
            let tails: Vec<f64> = squares.iter().map(|&square| tail(square, freedom, size)).collect();
            without = without.max(tails.iter().sum());
            for wide in &wides {
                for part in PARTS_BEYOND {
                    let pairs =
                        || wide.iter().zip(&tails).map(|(wide, tail)| (wide + part.ln(), tail + (-part).ln_1p()));
                    let sum: f64 = pairs().map(|(a, b)| a.max(b) + (-(a - b).abs()).exp().ln_1p()).sum();
                    if sum > best.0 {
                        best = (sum, pairs().map(|(far, near)| far > near).collect());
                    }
                }
            }
        }
    }
    (best.0 - without, best.1)
}

/// By which factors rows may be wider than the bulk of some lengths squared.
fn widths(squares: &[f64]) -> Vec<f64> {
    let farthest = squares.iter().copied().fold(0.0, f64::max).sqrt();
    let mut widths = WIDER.to_vec();
    let mut next = WIDER[2] * MORE;
    while next < farthest * MORE && next.is_finite() {
        widths.push(next);
        next *= MORE;
    }
    widths
}

/// The logarithm of the sum of numbers that are given by theirs.
fn log_sum(logs: impl Iterator<Item = f64> + Clone) -> f64 {
    let most = logs.clone().fold(f64::NEG_INFINITY, f64::max);
    most + logs.map(|one| (one - most).exp()).sum::<f64>().ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row pulls no more than one of the others, however far it is off.
    #[test]
    fn what_is_far_off_has_no_pull() {
        let near: Vec<f64> = (1..=19).map(|k| 0.3 * f64::from(k)).collect();
        for far in [1e2, 1e5, 1e8, 1e12] {
            let (weights, _) = weigh(&[&near[..], &[far]].concat(), 3.0, true);
            assert!(weights[..19].iter().all(|weight| *weight > 0.9), "{weights:?}");
            let pull = weights[19] * far;
            assert!((0.1..10.0).contains(&(pull / near[18])), "{far}: {pull}");
        }
    }

    /// Lengths squared of three axes at the middles of equal parts of a distribution: normal, and
    /// Student's with three degrees of freedom, where they are three times those of F with 3 and 3.
    #[test]
    fn tails_are_told_from_what_is_beyond_them() {
        use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor};
        let (normal, heavy) = (ChiSquared::new(3.0).unwrap(), FisherSnedecor::new(3.0, 3.0).unwrap());
        let middles = || (0..200).map(|k| (f64::from(k) + 0.5) / 200.0);
        let normal: Vec<f64> = middles().map(|p| normal.inverse_cdf(p)).collect();
        let heavy: Vec<f64> = middles().map(|p| 3.0 * heavy.inverse_cdf(p)).collect();
        for squares in [normal, heavy] {
            assert!(beyond_tails(&squares, 3.0).0 < 1.0);
            let far = [squares, vec![1e4, 9e3, 1.2e4]].concat();
            let (gain, which) = beyond_tails(&far, 3.0);
            assert!(gain > 5.0, "{gain}");
            let rows: Vec<usize> = (0..far.len()).filter(|&row| which[row]).collect();
            assert!(rows.ends_with(&[200, 201, 202]) && rows.len() < 6, "{rows:?}");
            // However far, and however differently.
            let (gain, which) = beyond_tails(&[&far[..200], &[1e12, 1e7]].concat(), 3.0);
            assert!(gain > 5.0 && which[200] && which[201], "{gain}");
        }
    }
}
