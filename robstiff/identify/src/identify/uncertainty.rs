//! How sure coefficients are: a covariance that is robust against what the rows
//! of a pose have in common, with few poses accounted for.
//!
//! What a model lacks is common to the rows of a pose, so a standard deviation
//! from the residuals of single rows would be too small. The sandwich takes the
//! poses themselves for witnesses, `V = M sum_p (X_p^T A_p e_p) (..)^T M` with
//! `M = (X^T X)^-1` and `A_p = (I - X_p M X_p^T)^-1/2`, which makes up for the
//! pull of a pose on its own fit (CR2; Bell and McCaffrey, Survey Methodology 28,
//! 2002, 169-181). Few poses, or a few that decide, leave `V` itself uncertain:
//! it is that of Student's distribution with the degrees of freedom of
//! Satterthwaite, `(sum l)^2 / sum l^2` over the eigenvalues `l` of what `V` is
//! as a quadratic form in independent readings (Pustejovsky and Tipton, Journal
//! of Business and Economic Statistics 36, 2018, 672-683).
//!
//! With hardly more readings than coefficients what is left says nothing: nearly
//! all is fitted. Of displacements noise that the campaign declares counts as much as
//! ten more readings do, and no coefficient is reported surer than it
//! alone would let it be, had each reading that and no more. Not so of positions:
//! what a tracker reads has in it by how much the robot misses a pose, which is
//! more, and which no campaign declares.
//!
//! What is reported is the standard deviation of the normal distribution that has
//! the same 95 % interval: `V^1/2` times the quantile of Student's distribution
//! over that of the normal one. So the 95 % interval is 1.96 of it on either
//! side, whatever the number of poses.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::normal::{Fit, Scaled, Sign};
use super::problem::{Block, Problem};
use crate::probability::{WITHIN, student};

/// With fewer poses than this for each coefficient the sandwich has no basis;
/// the residual variance then has to do.
const POSES_PER_COEFFICIENT: usize = 2;

/// Fewer degrees of freedom are taken for so many: below, Satterthwaite's
/// approximation is poor, and an interval says next to nothing.
const FEWEST: f64 = 3.0;

/// Declared noise is taken to be known to about a quarter, as the variance of so many
/// readings is (`1 / sqrt(2 * 10)` is 22 %).
const DECLARED: f64 = 10.0;

/// Of what a pose alone decides, this share of its readings' variance is left
/// by the fit or less.
const ALONE: f64 = 1e-9;

/// The covariance of a fit's coefficients; `signs` are those of its columns, `noise` that
/// of a whitened reading (m), where it is declared. A coefficient that is held at zero by
/// its sign has none.
pub fn covariance(problem: &Problem, fit: &Fit, signs: &[Sign], noise: Option<f64>) -> DMatrix<f64> {
    covariance_with(problem, fit, signs, &std::vec![0.0; signs.len()], noise)
}

/// The same where it is known of some coefficients beforehand that they are near
/// their value: `known` holds one over their variance, 0 where nothing is.
pub fn covariance_with(
    problem: &Problem,
    fit: &Fit,
    signs: &[Sign],
    known: &[f64],
    noise: Option<f64>,
) -> DMatrix<f64> {
    let free = free(fit, signs);
    let mut whole = DMatrix::zeros(signs.len(), signs.len());
    // Where all are held there is nothing to be sure of.
    let part = (!free.is_empty()).then(|| of_free(problem, fit, &free, known, noise)).flatten();
    let Some(part) = part else { return whole };
    for (i, &row) in free.iter().enumerate() {
        for (j, &column) in free.iter().enumerate() {
            whole[(row, column)] = part[(i, j)];
        }
    }
    whole
}

/// By how much each of some columns would shift the coefficients of a fit, a
/// column each, were it there once; those that are held at zero stay.
pub fn shifts(problem: &Problem, fit: &Fit, signs: &[Sign], columns: &[usize]) -> DMatrix<f64> {
    let free = free(fit, signs);
    let fitted: Vec<usize> = free.iter().map(|&k| fit.columns[k]).collect();
    let mut shifts = DMatrix::zeros(fit.columns.len(), columns.len());
    let Some(inverse) = problem.total.inverse(&fitted) else { return shifts };
    for (k, &column) in columns.iter().enumerate() {
        let along = DVector::from_fn(fitted.len(), |i, _| problem.total.gram[(fitted[i], column)]);
        let shift = &inverse * along;
        free.iter().zip(&shift).for_each(|(&row, &by)| shifts[(row, k)] = by);
    }
    shifts
}

/// The covariance that columns which are held at a value give to the coefficients of a fit,
/// each with the standard deviation of what it may be off by, or of what the readings would
/// say of it, whichever is less; `noise` is as of [`covariance`].
pub fn of_held(
    problem: &Problem,
    fit: &Fit,
    signs: &[Sign],
    held: &[(usize, f64)],
    noise: Option<f64>,
) -> DMatrix<f64> {
    let gram = &problem.total.gram;
    let (variance, _) = of_reading(problem, fit, noise);
    let columns: Vec<usize> = held.iter().map(|&(column, _)| column).collect();
    let shifts = shifts(problem, fit, signs, &columns);
    let of_one = |(k, &(column, spread)): (usize, &(usize, f64))| {
        let shift = shifts.column(k);
        // Of a column at zero nothing shifts its own coefficient.
        let taken: f64 = fit.columns.iter().zip(shift.iter()).map(|(&other, by)| by * gram[(other, column)]).sum();
        let alone = gram[(column, column)] - taken;
        let of_readings = if alone > 0.0 { variance / alone } else { f64::INFINITY };
        shift * shift.transpose() * of_readings.min(spread * spread)
    };
    held.iter().enumerate().map(of_one).fold(DMatrix::zeros(signs.len(), signs.len()), |sum, one| sum + one)
}

/// The coefficients of a fit, by place, that are not held at zero by their sign.
fn free(fit: &Fit, signs: &[Sign]) -> Vec<usize> {
    let held = |&k: &usize| signs[k] == Sign::Nonnegative && fit.coefficients[k] == 0.0;
    (0..signs.len()).filter(|k| !held(k)).collect()
}

/// The variance of a whitened reading (m^2), and the degrees of freedom that it is known
/// with: by what a fit leaves, and by the noise that is declared.
fn of_reading(problem: &Problem, fit: &Fit, noise: Option<f64>) -> (f64, f64) {
    let freedom = problem.freedom(fit);
    let Some(noise) = noise else { return (problem.variance(fit), freedom) };
    let (declared, all) = (noise * noise, freedom + DECLARED);
    (((fit.rss + DECLARED * declared) / all).max(declared), all)
}

fn of_free(problem: &Problem, fit: &Fit, free: &[usize], known: &[f64], noise: Option<f64>) -> Option<DMatrix<f64>> {
    let columns: Vec<usize> = free.iter().map(|&k| fit.columns[k]).collect();
    let (variance, freedom) = of_reading(problem, fit, noise);
    let known = DVector::from_fn(free.len(), |i, _| known[free[i]] * variance);
    let gram = problem.total.gram_of(&columns) + DMatrix::from_diagonal(&known);
    let inverse = Scaled::of(&gram)?.inverse();
    let plain = || &inverse * (variance * (student(freedom.max(FEWEST)) / WITHIN).powi(2));
    if problem.blocks.len() < POSES_PER_COEFFICIENT * columns.len() {
        return Some(plain());
    }
    let half = nalgebra::Cholesky::new(inverse.clone())?.l();
    let residuals = problem.white_residuals(&fit.columns, &fit.coefficients);
    let (mut scores, mut shares) = (Vec::new(), Vec::new());
    for block in problem.blocks.iter() {
        let pull = Pull::new(problem, block, &columns, &half);
        let own = DVector::from_fn(block.stacked.len(), |i, _| residuals[block.stacked[i]]);
        scores.push(pull.design.tr_mul(&pull.adjusted(&DMatrix::from_column_slice(own.len(), 1, own.as_slice()))));
        shares.push(pull.adjusted(&pull.design));
    }
    let meat: DMatrix<f64> = scores.iter().map(|score| score * score.transpose()).sum();
    let meat = meat + DMatrix::from_diagonal(&(known * variance));
    let sandwich = &inverse * meat * &inverse;
    // By pose, `X_p^T A_p A_p X_p` and `X_p^T A_p X_p`.
    let squares: Vec<DMatrix<f64>> = shares.iter().map(|share| share.tr_mul(share)).collect();
    let crossed: Vec<DMatrix<f64>> = problem
        .blocks
        .iter()
        .zip(&shares)
        .map(|(block, share)| of_block(problem, block, &columns).tr_mul(share))
        .collect();
    let factor = DVector::from_fn(columns.len(), |k, _| {
        let along = inverse.column(k).into_owned();
        let told = student(satterthwaite(&along, &squares, &crossed, &inverse).max(FEWEST)) / WITHIN;
        let least = noise.map_or(0.0, |noise| noise * noise * inverse[(k, k)]);
        told.max((least / sandwich[(k, k)].max(f64::MIN_POSITIVE)).sqrt())
    });
    Some(DMatrix::from_fn(columns.len(), columns.len(), |i, j| sandwich[(i, j)] * factor[i] * factor[j]))
}

/// The degrees of freedom of the variance of the coefficients along a vector
/// `M c`: of the quadratic form with the entries `v_p^T (I - X M X^T) v_q`, `v_p =
/// A_p X_p M c`.
fn satterthwaite(
    along: &DVector<f64>,
    squares: &[DMatrix<f64>],
    crossed: &[DMatrix<f64>],
    inverse: &DMatrix<f64>,
) -> f64 {
    let own: Vec<f64> = squares.iter().map(|square| along.dot(&(square * along))).collect();
    let seen: Vec<DVector<f64>> = crossed.iter().map(|cross| cross * along).collect();
    let taken: Vec<DVector<f64>> = seen.iter().map(|seen| inverse * seen).collect();
    // Off the diagonal they are `-s_p^T M s_q`, whose squares sum to the square
    // of `M sum s s^T` but for those of one pose.
    let sum: DMatrix<f64> = seen.iter().map(|seen| seen * seen.transpose()).sum();
    let product = inverse * sum;
    let (mut trace, mut squared) = (0.0, (&product * &product).trace());
    for ((own, seen), taken) in own.iter().zip(&seen).zip(&taken) {
        let pulled = seen.dot(taken);
        let diagonal = own - pulled;
        trace += diagonal;
        squared += diagonal * diagonal - pulled * pulled;
    }
    trace * trace / squared.max(f64::MIN_POSITIVE)
}

fn of_block(problem: &Problem, block: &Block, columns: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(block.stacked.len(), columns.len(), |i, j| problem.white[(block.stacked[i], columns[j])])
}

/// The pull of a pose on its own fit.
struct Pull {
    design: DMatrix<f64>,
    /// `X_p M^1/2 U`, with the eigenvectors `U` of `M^1/2 X_p^T X_p M^1/2`.
    directions: DMatrix<f64>,
    /// What `A_p - I` is along each: `((1 - s)^-1/2 - 1) / s` for the eigenvalue
    /// `s`.
    weights: DVector<f64>,
}

impl Pull {
    /// `half` is a square root of `M`.
    fn new(problem: &Problem, block: &Block, columns: &[usize], half: &DMatrix<f64>) -> Self {
        let design = of_block(problem, block, columns);
        let scaled = &design * half;
        let eigen = SymmetricEigen::new(scaled.tr_mul(&scaled));
        let weights = eigen.eigenvalues.map(|s| match (s > ALONE, 1.0 - s > ALONE) {
            (false, _) => 0.5,
            (true, true) => ((1.0 - s).sqrt().recip() - 1.0) / s,
            // Nothing is left along it.
            (true, false) => -1.0 / s,
        });
        Self { design, directions: scaled * eigen.eigenvectors, weights }
    }

    /// `A_p` times a matrix.
    fn adjusted(&self, of: &DMatrix<f64>) -> DMatrix<f64> {
        let mut along = self.directions.tr_mul(of);
        for mut column in along.column_iter_mut() {
            column.component_mul_assign(&self.weights);
        }
        of + &self.directions * along
    }
}

/// The correlations in a covariance; zero with a coefficient that does not
/// vary.
pub fn correlation(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let std = covariance.diagonal().map(f64::sqrt);
    DMatrix::from_fn(std.len(), std.len(), |i, j| {
        let scale = std[i] * std[j];
        if scale > 0.0 { covariance[(i, j)] / scale } else { f64::from(u8::from(i == j)) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However many degrees of freedom there are, it comes to an end, and to the
    /// right one: the quantiles to 1e-9, by the incomplete beta function of mpmath.
    #[test]
    fn quantiles_are_those_of_few_and_of_many_degrees_of_freedom() {
        let known = [(2.0, 4.302_652_730), (100.0, 1.983_971_519), (1e3, 1.962_339_081), (1e4, 1.960_201_240)];
        for (freedom, quantile) in known {
            assert!((student(freedom) - quantile).abs() < 1e-8, "{freedom}");
        }
        for (freedom, quantile) in [(10_001.0, 1.960_201_216), (1e5, 1.959_987_708), (1e6, 1.959_966_357)] {
            assert!((student(freedom) - quantile).abs() < 1e-7, "{freedom}");
        }
        for freedom in [1e8, 1e300, f64::INFINITY] {
            assert!((student(freedom) - WITHIN).abs() < 1e-7, "{freedom}");
        }
    }
}
