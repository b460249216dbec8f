//! How well some columns account for the readings.
//!
//! With a prior `N(m, A)` for the numbers `b` of the columns and noise of covariance `s^2 S`, the
//! *evidence* is the likelihood of the readings `y` with `b` integrated out. Of the whitened columns
//! `Z` and readings a fit needs `G = Z^T Z`, `g = Z^T (y - Z m)` and `E = |y - Z m|^2`. The posterior
//! mean of `b - m` is `u = (G + s^2 A^-1)^-1 g`, and
//!
//! `ln p = -n/2 ln 2 pi s^2 - 1/2 ln |I + A^1/2 G A^1/2 / s^2| - (E - u^T g) / 2 s^2 - 1/2 ln |S|`,
//!
//! at the `s^2`, and the scales of learned priors, that make it largest (MacKay, Neural Computation
//! 4, 1992: the effective number of parameters `gamma`; Bishop, Pattern Recognition and Machine
//! Learning, 2006, 3.5). Where a number cannot be negative its prior is half-normal, which multiplies
//! the evidence by `2 Phi(z)` at the posterior's mean over its standard deviation. The evidence
//! prefers no model for having more columns: what they could have said and did not counts against
//! them.

use nalgebra::{DMatrix, DVector};
use statrs::function::erf::erfc;

use super::dense::Factor;
use super::gram::Gram;

/// What a number is likely to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// About what.
    pub mean: f64,
    /// The standard deviation, in its unit; of a learned one over the scale of its group.
    pub sd: f64,
    /// The group whose scale it shares, where that is learned.
    pub group: Option<usize>,
    /// Whether it cannot be negative.
    pub nonnegative: bool,
}

/// The scales of learned priors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scales {
    /// What each is likely to be: the middle of a log-normal prior.
    pub typical: Vec<f64>,
    /// What each is now.
    pub now: Vec<f64>,
}

impl Scales {
    /// Scales that begin with what they are likely to be.
    pub fn new(typical: Vec<f64>) -> Self {
        Self { now: typical.clone(), typical }
    }
}

/// No scale is learned to be more than so many times what is likely.
const MOST_LEARNED: f64 = 20.0;

/// What is known of the noise before: an inverse gamma prior of `s^2` about `size^2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoisePrior {
    /// The likely noise of one reading (m, rad).
    pub size: f64,
    /// As many readings say so.
    pub weight: f64,
}

/// A fit of some columns.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The log-evidence.
    pub evidence: f64,
    /// The columns, in the order of the numbers.
    pub columns: Vec<usize>,
    /// The posterior mean of each number.
    pub mean: DVector<f64>,
    /// The posterior standard deviation of each number.
    pub std: DVector<f64>,
    /// The variance of one reading.
    pub variance: f64,
    /// The sum of the squares of the whitened residuals.
    pub rss: f64,
    /// How many readings there are.
    pub count: f64,
    /// The scales of learned priors.
    pub scales: Scales,
    posterior: Posterior,
}

/// The posterior, over the priors' standard deviations.
#[derive(Clone, Debug)]
struct Posterior {
    factor: Factor,
    sd: Vec<f64>,
    /// `L^-1 A^1/2 (Z^T y - Z^T Z m) / s^2`.
    white: Vec<f64>,
    /// `y^T y / s^2` with the prior's means taken out.
    energy: f64,
}

/// What a fit begins with.
#[derive(Clone, Copy, Debug)]
pub struct Start<'a> {
    /// The variance of one reading.
    pub variance: f64,
    /// The scales of learned priors.
    pub scales: &'a Scales,
}

/// Fits some columns of a Gram matrix, in at most so many rounds for the noise and the scales.
///
/// None where the matrix is not finite.
pub fn fit(
    gram: &Gram,
    columns: &[usize],
    priors: &[Prior],
    noise: NoisePrior,
    start: Start<'_>,
    rounds: usize,
) -> Option<Fit> {
    let n = columns.len();
    let last = gram.matrix.ncols() - 1;
    let of = |k: usize| &priors[columns[k]];
    // Row by row, so that sums run along what lies side by side.
    let mut square = vec![0.0; n * n];
    for i in 0..n {
        let column = gram.matrix.column(columns[i]);
        columns.iter().enumerate().for_each(|(j, &other)| square[i * n + j] = column[other]);
    }
    let times = |v: &[f64], i: usize| -> f64 { square[i * n..(i + 1) * n].iter().zip(v).map(|(a, b)| a * b).sum() };
    let readings = gram.matrix.column(last);
    let mean: Vec<f64> = (0..n).map(|k| of(k).mean).collect();
    let of_mean: Vec<f64> = (0..n).map(|i| times(&mean, i)).collect();
    let moment: Vec<f64> = (0..n).map(|k| readings[columns[k]] - of_mean[k]).collect();
    let shift: f64 = (0..n).map(|k| mean[k] * (of_mean[k] - 2.0 * readings[columns[k]])).sum();
    let energy = (gram.matrix[(last, last)] + shift).max(0.0);
    let mut scales = start.scales.clone();
    let mut variance = start.variance;
    let prior = noise.weight * noise.size * noise.size;
    let (mut round, mut inverse) = (0, Vec::new());
    loop {
        let sd: Vec<f64> = (0..n).map(|k| of(k).sd * of(k).group.map_or(1.0, |group| scales.now[group])).collect();
        let factor =
            Factor::new(n, |i, j| square[i * n + j] * sd[i] * sd[j] / variance + if i == j { 1.0 } else { 0.0 })?;
        let mut white: Vec<f64> = (0..n).map(|k| moment[k] * sd[k] / variance).collect();
        factor.solve_lower(&mut white);
        let mut solved = white.clone();
        factor.solve_upper(&mut solved);
        let beta: Vec<f64> = (0..n).map(|k| solved[k] * sd[k]).collect();
        // How many of the numbers the readings say changes little with the noise alone.
        if round == 0 || !scales.now.is_empty() {
            inverse = factor.inverse_diagonal();
        }
        round += 1;
        let done = round >= rounds;
        // The residual sum of squares at the posterior's mean.
        let rss = energy - (0..n).map(|k| beta[k] * moment[k] + variance * solved[k] * solved[k]).sum::<f64>();
        let used: f64 = inverse.iter().map(|c| 1.0 - c).sum();
        let next = (rss.max(0.0) + prior) / (gram.count - used + noise.weight).max(1.0);
        let settled = (next / variance).ln().abs() < 1e-3 && round > 2;
        if done || settled {
            if round > 1 && scales.now.is_empty() {
                inverse = factor.inverse_diagonal();
            }
            let squares: f64 = white.iter().map(|w| w * w).sum();
            let mut evidence = -0.5 * gram.count * (core::f64::consts::TAU * variance).ln()
                - factor.log_det()
                - 0.5 * (energy / variance - squares)
                - 0.5 * gram.log_det
                - 0.5 * noise.weight * variance.ln()
                - 0.5 * prior / variance;
            for (now, typical) in scales.now.iter().zip(&scales.typical) {
                evidence -= 0.5 * (now / typical).ln().powi(2);
            }
            for k in 0..n {
                if of(k).nonnegative && of(k).mean == 0.0 {
                    evidence += log_share_above_zero(solved[k] / inverse[k].sqrt());
                }
            }
            let std = DVector::from_fn(n, |k, _| inverse[k].sqrt() * sd[k]);
            let mean = DVector::from_fn(n, |k, _| beta[k] + mean[k]);
            let posterior = Posterior { factor, sd, white, energy: energy / variance };
            let columns = columns.to_vec();
            let (rss, count) = (rss.max(0.0), gram.count);
            let fit = Fit { evidence, columns, mean, std, variance, rss, count, scales, posterior };
            return fit.evidence.is_finite().then_some(fit);
        }
        variance = next;
        for group in 0..scales.now.len() {
            let members = || (0..n).filter(|k| of(*k).group == Some(group));
            if members().next().is_none() {
                continue;
            }
            let typical = scales.typical[group];
            let sum: f64 = members().map(|k| (beta[k] / of(k).sd).powi(2)).sum();
            let used: f64 = members().map(|k| 1.0 - inverse[k]).sum();
            let next = ((sum + 0.5 * typical * typical) / (used + 0.5)).sqrt();
            scales.now[group] = next.min(MOST_LEARNED * typical);
        }
    }
}

/// A Gram matrix with some columns taken out, whose numbers are integrated over at a noise and at
/// scales, and the part of the log-evidence that they have. Fits of the rest are small then. Of the
/// matrix only what is `behind` those columns is to be asked for.
///
/// None where the matrix is not finite.
pub fn reduced(gram: &Gram, columns: &[usize], behind: usize, priors: &[Prior], at: Start<'_>) -> Option<(Gram, f64)> {
    let (n, wide) = (columns.len(), gram.matrix.ncols());
    let (last, height) = (wide - 1, wide - behind);
    let of = |k: usize| &priors[columns[k]];
    let sd: Vec<f64> = (0..n).map(|k| of(k).sd * of(k).group.map_or(1.0, |group| at.scales.now[group])).collect();
    let factor = Factor::new(n, |i, j| {
        gram.matrix[(columns[i], columns[j])] * sd[i] * sd[j] / at.variance + if i == j { 1.0 } else { 0.0 }
    })?;
    // The priors' means are taken out of the readings.
    let of_mean = |j: usize| -> f64 { (0..n).map(|k| gram.matrix[(columns[k], j)] * of(k).mean).sum() };
    let mut rest = gram.matrix.clone();
    let moved: f64 = (0..n).map(|k| of_mean(columns[k]) * of(k).mean).sum();
    rest[(last, last)] += moved - 2.0 * of_mean(last);
    let mut beside = DMatrix::from_fn(height, n, |j, k| {
        let own = gram.matrix[(behind + j, columns[k])] - if behind + j == last { of_mean(columns[k]) } else { 0.0 };
        own * sd[k] / at.variance.sqrt()
    });
    for j in behind..last {
        rest[(j, last)] -= of_mean(j);
        rest[(last, j)] = rest[(j, last)];
    }
    factor.solve_lower_transposed(&mut beside);
    let used: f64 = factor.inverse_diagonal().iter().map(|c| 1.0 - c).sum();
    rest.view_mut((behind, behind), (height, height)).gemm(-1.0, &beside, &beside.transpose(), 1.0);
    let mut part = -factor.log_det() - 0.5 * used * (core::f64::consts::TAU * at.variance).ln();
    for (now, typical) in at.scales.now.iter().zip(&at.scales.typical) {
        part -= 0.5 * (now / typical).ln().powi(2);
    }
    Some((Gram { matrix: rest, log_det: gram.log_det, count: gram.count - used }, part))
}

/// `ln 2 Phi(z)`, for very negative `z` too.
fn log_share_above_zero(z: f64) -> f64 {
    if z > -30.0 {
        erfc(-z / core::f64::consts::SQRT_2).ln()
    } else {
        // Phi(z) tends to the density over |z|.
        -0.5 * z * z - (-z).ln() - 0.5 * (core::f64::consts::FRAC_PI_2).ln()
    }
}

impl Fit {
    /// Where a column's number is; none where it has no part.
    pub fn place(&self, column: usize) -> Option<usize> {
        self.columns.iter().position(|of| *of == column)
    }

    /// The posterior mean of a column's number; zero where it has no part.
    pub fn value(&self, column: usize) -> f64 {
        self.place(column).map_or(0.0, |at| self.mean[at])
    }

    /// Which part of each number the readings say, and not what was likely before: together, how many of
    /// them they pay for.
    pub fn shares(&self) -> Vec<f64> {
        let share = |(std, sd): (&f64, &f64)| if *sd > 0.0 { 1.0 - (std / sd).powi(2) } else { 0.0 };
        self.std.iter().zip(&self.posterior.sd).map(share).collect()
    }

    /// The covariance of the numbers.
    pub fn covariance(&self) -> DMatrix<f64> {
        let Posterior { factor, sd, .. } = &self.posterior;
        let mut inverse = factor.inverse();
        inverse.iter_mut().enumerate().for_each(|(at, c)| *c *= sd[at % sd.len()] * sd[at / sd.len()]);
        inverse
    }

    /// About how much the log-evidence grows with some columns more, for each list of them: the noise
    /// as it is after them, the scales as they are. From one elimination for all.
    pub fn gains(&self, gram: &Gram, priors: &[Prior], lists: &[&[usize]]) -> Vec<f64> {
        let Posterior { factor, sd, white, energy } = &self.posterior;
        let last = gram.matrix.ncols() - 1;
        let (own, variance) = (&self.columns, self.variance);
        // Only columns that are asked for, each once.
        let mut asked: Vec<usize> = lists.iter().flat_map(|list| list.iter().copied()).collect();
        asked.sort_unstable();
        asked.dedup();
        let mut place = vec![usize::MAX; last];
        asked.iter().enumerate().for_each(|(at, &column)| place[column] = at);
        let mut beside =
            DMatrix::from_fn(asked.len(), own.len(), |j, k| gram.matrix[(asked[j], own[k])] * sd[k] / variance);
        factor.solve_lower_transposed(&mut beside);
        // A column that is asked for lies side by side.
        let beside = beside.transpose();
        // What is left of each column with the readings, whose prior means are taken out.
        let rest = |j: usize| {
            let column = gram.matrix.column(asked[j]);
            let of_mean: f64 = own.iter().map(|&i| column[i] * priors[i].mean).sum();
            let taken: f64 = beside.column(j).iter().zip(white).map(|(a, b)| a * b).sum();
            (column[last] - of_mean) / variance - taken
        };
        let rest: Vec<f64> = (0..asked.len()).map(rest).collect();
        let left = (energy - white.iter().map(|w| w * w).sum::<f64>()).max(f64::MIN_POSITIVE);
        let gain = |list: &&[usize]| {
            let sd = |k: usize| priors[list[k]].sd;
            let inner = Factor::new(list.len(), |i, j| {
                let own = gram.matrix[(list[i], list[j])] / variance;
                let taken = beside.column(place[list[i]]).dot(&beside.column(place[list[j]]));
                (own - taken) * sd(i) * sd(j) + if i == j { 1.0 } else { 0.0 }
            });
            let Some(inner) = inner else { return f64::NEG_INFINITY };
            let mut moment: Vec<f64> = (0..list.len()).map(|k| rest[place[list[k]]] * sd(k)).collect();
            inner.solve_lower(&mut moment);
            let taken: f64 = moment.iter().map(|m| m * m).sum();
            -0.5 * gram.count * (1.0 - taken / left).max(1e-9).ln() - inner.log_det()
        };
        lists.iter().map(gain).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gram(columns: &DMatrix<f64>, readings: &DVector<f64>) -> Gram {
        let last = columns.ncols();
        let mut all = columns.clone().resize_horizontally(last + 1, 0.0);
        all.set_column(last, readings);
        Gram { matrix: all.tr_mul(&all), log_det: 0.0, count: readings.len() as f64 }
    }

    /// The density of the readings themselves: normal, with the covariance that noise and columns
    /// together give them.
    fn density(columns: &DMatrix<f64>, readings: &DVector<f64>, priors: &[Prior], variance: f64) -> f64 {
        let n = readings.len();
        let mut covariance = DMatrix::identity(n, n) * variance;
        let mut rest = readings.clone();
        for (k, prior) in priors.iter().enumerate() {
            let column = columns.column(k);
            covariance += column * column.transpose() * prior.sd * prior.sd;
            rest -= column * prior.mean;
        }
        let log_det = covariance.determinant().ln();
        let energy = rest.dot(&covariance.cholesky().expect("positive").solve(&rest));
        -0.5 * (n as f64 * core::f64::consts::TAU.ln() + log_det + energy)
    }

    fn sample() -> (DMatrix<f64>, DVector<f64>, Vec<Prior>) {
        let columns = DMatrix::from_fn(12, 3, |i, j| (1.7 * i as f64 + 2.9 * (j * j) as f64).sin());
        let readings = DVector::from_fn(12, |i, _| (0.9 * i as f64).cos() + 0.4 * columns[(i, 1)]);
        let prior = |mean, sd| Prior { mean, sd, group: None, nonnegative: false };
        (columns, readings, vec![prior(0.3, 0.8), prior(0.0, 1.5), prior(-0.2, 0.5)])
    }

    #[test]
    fn the_evidence_is_the_density_of_the_readings() {
        let (columns, readings, priors) = sample();
        let scales = Scales::default();
        let start = Start { variance: 0.4, scales: &scales };
        let noise = NoisePrior { size: 1.0, weight: 0.0 };
        let fit = fit(&gram(&columns, &readings), &[0, 1, 2], &priors, noise, start, 1).expect("finite");
        assert!((fit.evidence - density(&columns, &readings, &priors, 0.4)).abs() < 1e-10);
    }

    /// Adding columns with the noise held gives what the larger fit has more, at the noise that is
    /// likeliest for each.
    #[test]
    fn gains_are_what_the_larger_fit_gains() {
        let (columns, readings, mut priors) = sample();
        // Only what is there already may be about another value than zero.
        priors[2].mean = 0.0;
        let gram = gram(&columns, &readings);
        let scales = Scales::default();
        let noise = NoisePrior { size: 1.0, weight: 0.0 };
        let at = |columns: &[usize]| {
            fit(&gram, columns, &priors, noise, Start { variance: 0.4, scales: &scales }, 1).expect("finite")
        };
        let (small, large) = (at(&[0]), at(&[0, 1, 2]));
        let found = small.gains(&gram, &priors, &[&[1, 2]])[0];
        let left = |fit: &Fit| fit.posterior.energy - fit.posterior.white.iter().map(|w| w * w).sum::<f64>();
        let log_det = |fit: &Fit| fit.posterior.factor.log_det();
        let expected = -0.5 * gram.count * (left(&large) / left(&small)).ln() - (log_det(&large) - log_det(&small));
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }

    /// Columns that are taken out first have the part that they have in the whole fit.
    #[test]
    fn what_is_taken_out_leaves_the_same_evidence() {
        let (columns, readings, priors) = sample();
        let gram = gram(&columns, &readings);
        let scales = Scales::default();
        let start = Start { variance: 0.4, scales: &scales };
        let noise = NoisePrior { size: 1.0, weight: 0.0 };
        let whole = fit(&gram, &[0, 1, 2], &priors, noise, start, 1).expect("finite");
        let (rest, part) = reduced(&gram, &[0, 1], 2, &priors, start).expect("finite");
        let small = fit(&rest, &[2], &priors, noise, start, 1).expect("finite");
        assert!((small.evidence + part - whole.evidence).abs() < 1e-9);
        assert!((small.value(2) - whole.value(2)).abs() < 1e-12);
    }

    #[test]
    fn what_cannot_be_negative_and_seems_so_counts_against() {
        assert!((log_share_above_zero(0.0)).abs() < 1e-12);
        assert!((log_share_above_zero(8.0) - 2_f64.ln()).abs() < 1e-9);
        let near = log_share_above_zero(-29.999) - log_share_above_zero(-30.001);
        assert!(near.abs() < 0.1 && log_share_above_zero(-40.0) < -800.0);
    }
}
