//! Is anything of the catalogue missing? A score test of every candidate at
//! once, calibrated by a wild cluster bootstrap of the largest statistic.
//!
//! The null model (joints and effects named so far, columns `M`) is projected
//! out of the readings and of the candidates' columns `Z`, so a candidate
//! competes with joint compliances that are fitted again. What it gains is the
//! fall of the residual sum of squares when it enters, over the residual
//! variance.
//!
//! Residuals of one pose hang together (everything the model lacks is a
//! function of pose and load), and poses do not share a variance, so neither F
//! nor chi-square tables apply. Instead the null is imposed and whole poses
//! change sign together: `y* = X b + v_p e_p`, `v_p = +-1` (Cameron, Gelbach,
//! Miller, Review of Economics and Statistics 90, 2008, 414-427), with
//! residuals `e_p` of the fit *without* pose `p` (CR3), which makes up for the
//! pull of a pose on its own fit and keeps the test honest with few poses. The
//! largest statistic over all candidates against its own distribution controls
//! the family-wise error (Westfall and Young, 1993).
//!
//! Every statistic is a function of per-pose scores, so that a draw is one
//! product of a row of signs with a small matrix.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector, DVectorView};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::candidate::{Candidate, Variant};
use crate::identify::normal::{Scaled, Sign};
use crate::identify::problem::Problem;

/// What a statistic gives up for each number beyond the first. At the tail
/// that decides (1 % over a few dozen candidates, 1e-4 each) the quantiles of
/// chi-square with one and two degrees of freedom are 15.1 and 18.4; without
/// this, large groups would set the bar for small ones.
const PER_EXTRA_PARAMETER: f64 = 3.3;

/// A column of which less than this fraction is left when the null model is
/// projected out says nothing new.
const EXPLAINED: f64 = 1e-6;

/// Candidates against a null model.
pub struct ScoreTest<'a> {
    candidates: &'a [Candidate],
    signs: &'a [Sign],
    /// The problem's column of local column 0.
    first: usize,
    /// `Z^T Z` with the null model projected out.
    gram: DMatrix<f64>,
    /// Of each column, the fraction the null model leaves.
    left: DVector<f64>,
    /// `Z^T y`, alike.
    score: DVector<f64>,
    /// Residual variance of the null model.
    variance: f64,
    blocks: Blocks,
}

/// What each pose adds to the scores of a bootstrap draw.
struct Blocks {
    /// One row a pose, one column a candidate's column.
    scores: DMatrix<f64>,
    /// The same for the null model's columns, made orthonormal.
    null: DMatrix<f64>,
    /// The sum of squares of the residuals that are drawn from.
    energy: f64,
    freedom: f64,
}

/// How large the largest statistic gets when nothing is missing.
pub struct Reference {
    largest: Vec<f64>,
}

impl Reference {
    /// The family-wise p-value of a statistic: never zero, since the data
    /// themselves are one of the draws under the null.
    pub fn p_value(&self, statistic: f64) -> f64 {
        let beyond = self.largest.iter().filter(|&&largest| largest >= statistic).count();
        (1 + beyond) as f64 / (1 + self.largest.len()) as f64
    }
}

impl<'a> ScoreTest<'a> {
    /// The test of candidates, whose columns start at `first`, against the
    /// model of the columns `null`; `signs` are those of all columns. `None`
    /// where the null model cannot be fitted.
    pub fn new(
        problem: &Problem,
        candidates: &'a [Candidate],
        signs: &'a [Sign],
        first: usize,
        null: &[usize],
    ) -> Option<Self> {
        let total = &problem.total;
        let fit = total.solve(null)?;
        let factor = Scaled::of(&total.gram_of(null))?;
        let tested: Vec<usize> = (first..problem.columns.len()).collect();
        let cross = DMatrix::from_fn(null.len(), tested.len(), |i, j| total.gram[(null[i], tested[j])]);
        let shares = factor.solve_columns(&cross);
        let gram = total.gram_of(&tested) - cross.tr_mul(&shares);
        let left = DVector::from_fn(tested.len(), |j, _| gram[(j, j)] / total.gram[(tested[j], tested[j])]);
        let score = total.moment_of(&tested) - shares.tr_mul(&total.moment_of(null));
        let freedom = total.rows.checked_sub(null.len()).filter(|&freedom| freedom > 0)? as f64;

        let half = nalgebra::Cholesky::new(factor.inverse())?.l();
        let count = problem.blocks.len();
        let mut scores = DMatrix::zeros(count, tested.len());
        let mut null_scores = DMatrix::zeros(count, null.len());
        let mut energy = 0.0;
        for (p, block) in problem.blocks.iter().enumerate() {
            let without = total.without(&block.normal).solve(null);
            // A pose that alone sees a joint has no fit without it; its
            // residual then is that of the whole fit.
            let coefficients = without.map_or_else(|| fit.coefficients.clone(), |fit| fit.coefficients);
            let own = block_scores(&block.normal, null, null, &coefficients);
            let theirs = block_scores(&block.normal, &tested, null, &coefficients) - shares.tr_mul(&own);
            scores.set_row(p, &theirs.transpose());
            null_scores.set_row(p, &own.transpose());
            energy += block.normal.rss(null, &coefficients);
        }
        let blocks = Blocks { scores, null: null_scores * half, energy, freedom };
        Some(Self { candidates, signs, first, gram, left, score, variance: fit.rss / freedom, blocks })
    }

    /// The statistic of each candidate, and the variant that has it; `None`
    /// for those that have no physical variant which gains anything.
    pub fn statistics(&self) -> Vec<Option<(f64, usize)>> {
        let of = |candidate: &Candidate| {
            let variants = candidate.variants.iter().enumerate();
            let gains =
                variants.filter_map(|(i, v)| Some((self.statistic(v, self.score.as_view(), self.variance)?, i)));
            gains.max_by(|a, b| a.0.total_cmp(&b.0))
        };
        self.candidates.iter().map(of).collect()
    }

    /// The distribution of the largest statistic under the null model.
    pub fn reference(&self, draws: usize, seed: u64) -> Reference {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let signs = rademacher(&mut rng, draws, self.blocks.scores.nrows());
        let scores = (&signs * &self.blocks.scores).transpose();
        let absorbed = &signs * &self.blocks.null;
        let largest = (0..draws).map(|draw| {
            let variance = (self.blocks.energy - absorbed.row(draw).norm_squared()) / self.blocks.freedom;
            let score = scores.column(draw);
            let variants = self.candidates.iter().flat_map(|candidate| &candidate.variants);
            let statistics = variants.filter_map(|variant| self.statistic(variant, score.as_view(), variance));
            statistics.fold(0.0, f64::max)
        });
        Reference { largest: largest.collect() }
    }

    /// What a variant gains, if with numbers of the right signs.
    fn statistic(&self, variant: &Variant, score: DVectorView<'_, f64>, variance: f64) -> Option<f64> {
        let local = |k: usize| variant.columns[k] - self.first;
        let allowed = |k: usize, number: f64| number > 0.0 || self.signs[variant.columns[k]] == Sign::Free;
        if (0..variant.columns.len()).any(|k| self.left[local(k)] < EXPLAINED) {
            return None;
        }
        let gain = if let [_] = variant.columns[..] {
            let (u, g) = (score[local(0)], self.gram[(local(0), local(0))]);
            allowed(0, u).then_some(u * u / g)?
        } else {
            let (i, j) = (local(0), local(1));
            let (a, b, c) = (self.gram[(i, i)], self.gram[(i, j)], self.gram[(j, j)]);
            let determinant = a * c - b * b;
            if determinant < EXPLAINED * a * c {
                return None;
            }
            let first = (c * score[i] - b * score[j]) / determinant;
            let second = (a * score[j] - b * score[i]) / determinant;
            (allowed(0, first) && allowed(1, second)).then_some(first * score[i] + second * score[j])?
        };
        Some(gain / variance - PER_EXTRA_PARAMETER * (variant.parameters - 1) as f64)
    }

    /// How far the columns of one variant are from the span of another's, with
    /// the null model projected out of both: the fraction of their energy that
    /// is left, the largest over the columns (the squared sine of the largest
    /// principal angle, for one column).
    pub fn distance(&self, from: &Variant, to: &Variant) -> f64 {
        let local = |variant: &Variant| -> Vec<usize> { variant.columns.iter().map(|c| c - self.first).collect() };
        let (from, to) = (local(from), local(to));
        let inner = DMatrix::from_fn(to.len(), to.len(), |i, j| self.gram[(to[i], to[j])]);
        let Some(factor) = Scaled::of(&inner) else { return 1.0 };
        let outside = |&column: &usize| {
            let along = DVector::from_fn(to.len(), |k, _| self.gram[(to[k], column)]);
            1.0 - along.dot(&factor.solve(&along)) / self.gram[(column, column)]
        };
        from.iter().map(outside).fold(0.0, f64::max)
    }
}

/// `X_p^T (y_p - N_p b)` of one block of rows, for some columns `X`.
fn block_scores(
    normal: &crate::identify::normal::Normal,
    columns: &[usize],
    null: &[usize],
    coefficients: &DVector<f64>,
) -> DVector<f64> {
    DVector::from_fn(columns.len(), |i, _| {
        let fitted: f64 = (0..null.len()).map(|k| normal.gram[(columns[i], null[k])] * coefficients[k]).sum();
        normal.moment[columns[i]] - fitted
    })
}

/// Random signs, one row a draw.
pub fn rademacher(rng: &mut ChaCha8Rng, draws: usize, blocks: usize) -> DMatrix<f64> {
    DMatrix::from_fn(draws, blocks, |_, _| if rng.next_u32() & 1 == 0 { 1.0 } else { -1.0 })
}
