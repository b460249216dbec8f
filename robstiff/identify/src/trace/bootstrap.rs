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

use core::ops::Range;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::catalogue::{Candidate, Variant};
use crate::identify::normal::{Normal, Projected, Scaled, Sign};
use crate::identify::problem::Problem;

/// What a statistic gives up for each number beyond the first. At the tail
/// that decides (1 % over a few dozen candidates, 1e-4 each) the quantiles of
/// chi-square with one and two degrees of freedom are 15.1 and 18.4; without
/// this, large groups would set the bar for small ones.
const PER_EXTRA_PARAMETER: f64 = 3.3;

/// What the statistic of a variant gives up for its further numbers.
pub fn price(variant: &Variant) -> f64 {
    PER_EXTRA_PARAMETER * (variant.parameters - 1) as f64
}

/// A column of which less than this fraction is left when the null model is
/// projected out says nothing new.
const EXPLAINED: f64 = 1e-6;

/// Whether a test can be of all these columns: whether a null model leaves something of each, and
/// of each against the others.
pub fn tells_apart(total: &Normal, null: &[usize], tested: Range<usize>) -> bool {
    Remaining::new(total, null, tested).is_some_and(|left| {
        left.left.iter().all(|&left| left >= EXPLAINED) && Scaled::apart(&left.gram, EXPLAINED).is_some()
    })
}

/// Candidates against a null model.
pub struct ScoreTest {
    /// By candidate, its variants.
    groups: Vec<Vec<Option<Group>>>,
    /// What the null model leaves of their columns.
    remaining: Remaining,
    /// `Z^T y` with the null model projected out.
    score: DVector<f64>,
    /// Residual variance of the null model.
    variance: f64,
    blocks: Blocks,
}

/// The columns of a variant with the null model projected out.
struct Group {
    /// Local columns.
    columns: Vec<usize>,
    /// The inverse of their Gram matrix, which is as symmetric as that.
    inverse: DMatrix<f64>,
    /// Which of their numbers have to be positive.
    positive: Vec<bool>,
    /// What the statistic gives up for further numbers.
    price: f64,
}

impl Group {
    /// The columns of a variant that the null model leaves something of, each
    /// and against each other.
    fn new(test: &Remaining, variant: &Variant, signs: &[Sign]) -> Option<Self> {
        let columns = test.local(variant);
        // Not a number where a column is zero.
        if !columns.iter().all(|&k| test.left[k] >= EXPLAINED) {
            return None;
        }
        let gram = DMatrix::from_fn(columns.len(), columns.len(), |i, j| test.gram[(columns[i], columns[j])]);
        let inverse = Scaled::apart(&gram, EXPLAINED)?.inverse();
        let positive = variant.columns.iter().map(|&column| signs[column] == Sign::Nonnegative).collect();
        let price = price(variant);
        Some(Self { columns, inverse, positive, price })
    }

    /// What it gains, if with numbers of the right signs.
    fn statistic(&self, score: &[f64], variance: f64) -> Option<f64> {
        let mut gain = 0.0;
        let rows = self.inverse.as_slice().chunks_exact(self.columns.len());
        for ((row, &column), &positive) in rows.zip(&self.columns).zip(&self.positive) {
            let number: f64 = row.iter().zip(&self.columns).map(|(of, &k)| of * score[k]).sum();
            if positive && number <= 0.0 {
                return None;
            }
            gain += number * score[column];
        }
        Some(gain / variance - self.price)
    }
}

/// What a null model leaves of the candidates' columns.
pub struct Remaining {
    /// The problem's column of local column 0.
    first: usize,
    /// `Z^T Z` with the null model projected out.
    gram: DMatrix<f64>,
    /// Of each column, the fraction that is left.
    left: DVector<f64>,
    /// What of the null model each column is fitted by, a column each.
    shares: DMatrix<f64>,
}

impl Remaining {
    /// Of the columns `tested`, by the normal equations of all; `None` where the null model's
    /// are collinear.
    pub fn new(total: &Normal, null: &[usize], tested: Range<usize>) -> Option<Self> {
        Some(Self::of(&Scaled::of(&total.gram_of(null))?, total, null, tested))
    }

    /// The same with the null model's own equations at hand.
    fn of(factor: &Scaled, total: &Normal, null: &[usize], tested: Range<usize>) -> Self {
        let first = tested.start;
        let tested: Vec<usize> = tested.collect();
        let Projected { gram, shares } = total.projected(&tested, factor, null);
        let left = DVector::from_fn(tested.len(), |j, _| gram[(j, j)] / total.gram[(tested[j], tested[j])]);
        Self { first, gram, left, shares }
    }

    fn local(&self, variant: &Variant) -> Vec<usize> {
        variant.columns.iter().map(|column| column - self.first).collect()
    }

    /// How far the columns of one variant are from the span of another's, with
    /// the null model projected out of both: the fraction of their energy that
    /// is left, the largest over the columns (the squared sine of the largest
    /// principal angle, for one column).
    pub fn distance(&self, from: &Variant, to: &Variant) -> f64 {
        let (from, to) = (self.local(from), self.local(to));
        let inner = DMatrix::from_fn(to.len(), to.len(), |i, j| self.gram[(to[i], to[j])]);
        let Some(factor) = Scaled::of(&inner) else { return 1.0 };
        let outside = |&column: &usize| {
            let along = DVector::from_fn(to.len(), |k, _| self.gram[(to[k], column)]);
            1.0 - along.dot(&factor.solve(&along)) / self.gram[(column, column)]
        };
        from.iter().map(outside).fold(0.0, f64::max)
    }
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

/// What is tested against a null model.
pub struct Alternatives<'a> {
    /// The normal equations of all columns.
    pub total: &'a Normal,
    /// A column, whitened.
    pub white: &'a dyn Fn(usize) -> DVector<f64>,
    /// The candidates.
    pub candidates: &'a [Candidate],
    /// The signs of all columns.
    pub signs: &'a [Sign],
    /// The first column of a candidate.
    pub first: usize,
}

impl ScoreTest {
    /// The test of candidates against a null model, given with its regression and
    /// its columns among all. `None` where it cannot be fitted.
    pub fn new(problem: &Problem, null: &[usize], alternatives: &Alternatives<'_>) -> Option<Self> {
        let Alternatives { total, white, candidates, signs, first } = *alternatives;
        let own_columns: Vec<usize> = (0..null.len()).collect();
        let fit = problem.total.solve(&own_columns)?;
        let factor = Scaled::of(&problem.total.gram)?;
        let tested: Vec<usize> = (first..signs.len()).collect();
        let remaining = Remaining::of(&factor, total, null, first..signs.len());
        let score = total.moment_of(&tested) - remaining.shares.tr_mul(&total.moment_of(null));
        let freedom = total.rows.checked_sub(null.len()).filter(|&freedom| freedom > 0)? as f64;

        let half = nalgebra::Cholesky::new(factor.inverse())?.l();
        let count = problem.blocks.len();
        let mut energy = 0.0;
        let mut residuals = Vec::with_capacity(count);
        for block in problem.blocks.iter() {
            // A pose that alone sees a joint has no fit without it; its
            // residual then is that of the whole fit.
            let without = problem.solve_without(block, &own_columns, None);
            let coefficients = without.as_ref().unwrap_or(&fit.coefficients);
            let left = problem.block_residuals(block, &own_columns, coefficients);
            energy += left.norm_squared();
            residuals.push(left);
        }
        let of_block = |white: &[f64], p: usize| -> f64 {
            let block = problem.blocks[p].stacked.iter().zip(residuals[p].iter());
            block.map(|(&row, residual)| white[row] * residual).sum()
        };
        let mut null_scores = DMatrix::zeros(count, null.len());
        for (k, column) in problem.white.column_iter().enumerate() {
            let white = column.as_slice();
            null_scores.set_column(k, &DVector::from_fn(count, |p, _| of_block(white, p)));
        }
        // One column at a time: all of a large campaign's take much memory.
        let mut scores = DMatrix::zeros(count, tested.len());
        for (k, &column) in tested.iter().enumerate() {
            let white = white(column);
            scores.set_column(k, &DVector::from_fn(count, |p, _| of_block(white.as_slice(), p)));
        }
        scores -= &null_scores * &remaining.shares;
        let group = |variant: &Variant| Group::new(&remaining, variant, signs);
        let groups = candidates.iter().map(|candidate| candidate.variants.iter().map(group).collect()).collect();
        let blocks = Blocks { scores, null: null_scores * half, energy, freedom };
        Some(Self { groups, remaining, score, variance: fit.rss / freedom, blocks })
    }

    /// The same where the columns of all are at hand; candidates' start at
    /// `first`.
    pub fn among(
        problem: &Problem,
        candidates: &[Candidate],
        signs: &[Sign],
        first: usize,
        null: &[usize],
    ) -> Option<Self> {
        let white = |column: usize| problem.white.column(column).into_owned();
        let own = problem.with(null, problem.white.select_columns(null));
        Self::new(&own, null, &Alternatives { total: &problem.total, white: &white, candidates, signs, first })
    }

    /// The statistic of each candidate, and the variant that has it; `None`
    /// for those that have no physical variant which gains anything.
    pub fn statistics(&self) -> Vec<Option<(f64, usize)>> {
        let of = |group: &Option<Group>| group.as_ref()?.statistic(self.score.as_slice(), self.variance);
        let best = |groups: &Vec<Option<Group>>| {
            let gains = groups.iter().enumerate().filter_map(|(i, group)| Some((of(group)?, i)));
            gains.max_by(|a, b| a.0.total_cmp(&b.0))
        };
        self.groups.iter().map(best).collect()
    }

    /// A statistic of a variant where the variance is no less than some.
    pub fn against(&self, statistic: f64, variant: &Variant, least: f64) -> f64 {
        let price = price(variant);
        (statistic + price) * self.variance / self.variance.max(least) - price
    }

    /// The distribution of the largest statistic under the null model.
    pub fn reference(&self, draws: usize, seed: u64) -> Reference {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let signs = rademacher(&mut rng, draws, self.blocks.scores.nrows());
        let scores = self.blocks.scores.transpose() * signs.transpose();
        let absorbed = &signs * &self.blocks.null;
        let groups: Vec<&Group> = self.groups.iter().flatten().flatten().collect();
        let largest = (0..draws).map(|draw| {
            let variance = (self.blocks.energy - absorbed.row(draw).norm_squared()) / self.blocks.freedom;
            let score = &scores.as_slice()[draw * scores.nrows()..(draw + 1) * scores.nrows()];
            groups.iter().filter_map(|group| group.statistic(score, variance)).fold(0.0, f64::max)
        });
        Reference { largest: largest.collect() }
    }

    /// [`Remaining::distance`], beside the null model.
    pub fn distance(&self, from: &Variant, to: &Variant) -> f64 {
        self.remaining.distance(from, to)
    }
}

/// Random signs, one row a draw.
pub fn rademacher(rng: &mut ChaCha8Rng, draws: usize, blocks: usize) -> DMatrix<f64> {
    DMatrix::from_fn(draws, blocks, |_, _| if rng.next_u32() & 1 == 0 { 1.0 } else { -1.0 })
}
