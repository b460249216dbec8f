//! How much is known after some measurements.
//!
//! With the information matrix `M = sum X^T V^-1 X` of all numbers (`V` the
//! covariance of the readings), and `S` the Schur complement that is left of it
//! for some numbers when the others are fitted:
//!
//! - *D*: `log det S` of the model, beside what nobody asks for; the volume of its
//!   confidence ellipsoid.
//! - *Ds*: `log det S` of the effects' numbers (of the whole model where there
//!   are none).
//! - *T*, for a pair of rivals: what the wrong one leaves of the readings if the
//!   other, at its size `b`, is the truth and everything is fitted again:
//!   `b^T S b`, the expected difference in chi-square (Atkinson and Fedorov,
//!   Biometrika 62, 1975). Of several pairs the harmonic mean counts, which is
//!   ruled by the least clear one.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::rivals::{Contest, Rivals};

/// What a plan is to be best at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// All numbers.
    D,
    /// The effects' numbers.
    Ds,
    /// Telling rivals apart.
    T,
    /// Telling rivals apart first, and all numbers.
    Compound,
}

/// The weight of telling apart in [`Criterion::Compound`].
const TELLING_APART: f64 = 0.7;

/// Patterns that differ by less than this fraction of their energy over all
/// poses and loads are one: a thousandth of what is read is beyond what the model of an arm
/// is exact to.
const EXACT: f64 = 1e-6;

/// Rivals that are no further apart (chi-square) are not told apart at all.
const NOTHING: f64 = 1e-12;

/// What keeps a factorisation going where numbers are collinear, as a fraction
/// of their energy; far below [`EXACT`].
const RIDGE: f64 = 1e-10;

/// What is known, by an information matrix.
#[derive(Clone, Debug)]
pub struct Judge {
    /// One over the size of each number's column, so that no unit rules.
    scale: DVector<f64>,
    /// What every model has and nobody asks for.
    nuisance: Vec<usize>,
    /// The model: the description's numbers and the effects named.
    model: Vec<usize>,
    /// Those of the effects, within the model.
    effects: Vec<usize>,
    contests: Vec<Contest>,
    /// The columns that the models of all contests have: they are eliminated once for all of them.
    common: Vec<usize>,
    /// The other columns of contests.
    further: Vec<usize>,
    /// The pairs that the criterion counts.
    pairs: Vec<usize>,
    variance: f64,
}

/// The scaled information of the further columns.
struct Reduced {
    matrix: DMatrix<f64>,
    /// What keeps factorisations of it going.
    ridge: DVector<f64>,
}

impl Judge {
    /// For rivals, with what is known already and the variance of a reading
    /// (m^2).
    pub fn new(known: &DMatrix<f64>, rivals: &Rivals, variance: f64) -> Self {
        let size = |k: usize| if known[(k, k)] > 0.0 { known[(k, k)].sqrt().recip() } else { 1.0 };
        let in_all = |k: &usize| rivals.pairs.iter().all(|contest| contest.core.contains(k));
        let (common, further) = (0..known.nrows()).partition(in_all);
        Self {
            common,
            further,
            scale: DVector::from_fn(known.nrows(), |k, _| size(k)),
            nuisance: rivals.nuisance.clone(),
            model: rivals.model.iter().map(|number| number.column).collect(),
            effects: rivals.effects.clone(),
            contests: rivals.pairs.clone(),
            pairs: (0..rivals.pairs.len()).collect(),
            variance,
        }
    }

    /// The same with only some pairs counted.
    pub fn with_pairs(self, pairs: Vec<usize>) -> Self {
        Self { pairs, ..self }
    }

    /// The pairs that differ at all in `everything` that could be measured.
    pub fn separable(&self, everything: &DMatrix<f64>) -> Vec<usize> {
        let differs = |&k: &usize| self.angle(everything, k).sin().powi(2) > EXACT;
        (0..self.contests.len()).filter(differs).collect()
    }

    /// The angle between what two rivals show (rad), with the rest fitted again.
    pub fn angle(&self, information: &DMatrix<f64>, pair: usize) -> f64 {
        let (contest, reduced) = (&self.contests[pair], self.reduced(information));
        let one = |truth: usize| {
            let whole = self.left(&reduced, contest, truth, &contest.core);
            let left = self.left(&reduced, contest, truth, contest.without(truth));
            (left / whole.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
        };
        one(0).min(one(1)).sqrt().asin()
    }

    /// The separation of each pair (sigmas): see [`super::Pair::now`].
    pub fn separations(&self, information: &DMatrix<f64>) -> Vec<f64> {
        let reduced = self.reduced(information);
        (0..self.contests.len()).map(|k| self.chi_square(&reduced, k).sqrt()).collect()
    }

    /// The expected difference in chi-square, for the less clear truth.
    fn chi_square(&self, reduced: &Reduced, pair: usize) -> f64 {
        let contest = &self.contests[pair];
        let one = |truth: usize| self.left(reduced, contest, truth, contest.without(truth));
        one(0).min(one(1)) / self.variance
    }

    /// `b^T S b` of the truth's readings, when the numbers `rest` are fitted.
    fn left(&self, reduced: &Reduced, contest: &Contest, truth: usize, rest: &[usize]) -> f64 {
        let Reduced { matrix, ridge } = reduced;
        let rival = &contest.rivals[truth];
        let place = |column: &usize| self.further.binary_search(column).ok();
        let own = rival.columns.iter().zip(&rival.values);
        let own: Vec<(usize, f64)> = own.filter_map(|(c, b)| Some((place(c)?, b / self.scale[*c]))).collect();
        let rest: Vec<usize> = rest.iter().filter_map(place).collect();
        let along = |i: usize| -> f64 { own.iter().map(|&(c, b)| matrix[(i, c)] * b).sum() };
        let energy: f64 = own.iter().map(|&(c, b)| b * along(c)).sum();
        let cross = DVector::from_fn(rest.len(), |k, _| along(rest[k]));
        let of_rest = DMatrix::from_fn(rest.len(), rest.len(), |i, j| {
            matrix[(rest[i], rest[j])] + if i == j { ridge[rest[i]] } else { 0.0 }
        });
        let Some(factor) = of_rest.cholesky() else { return 0.0 };
        (energy - cross.dot(&factor.solve(&cross))).max(0.0)
    }

    /// The scaled information of the further columns, with the common ones fitted again.
    fn reduced(&self, information: &DMatrix<f64>) -> Reduced {
        let gram = |i: usize, j: usize| information[(i, j)] * self.scale[i] * self.scale[j];
        let (common, further) = (&self.common, &self.further);
        let own = DMatrix::from_fn(further.len(), further.len(), |i, j| gram(further[i], further[j]));
        let ridge = own.diagonal().map(|value| RIDGE * value + f64::MIN_POSITIVE);
        let Some(factor) = self.of(information, common).cholesky() else { return Reduced { matrix: own, ridge } };
        let mut beside = DMatrix::from_fn(common.len(), further.len(), |i, j| gram(common[i], further[j]));
        factor.l_dirty().solve_lower_triangular_mut(&mut beside);
        Reduced { matrix: own - beside.tr_mul(&beside), ridge }
    }

    /// The scaled information of some numbers.
    fn of(&self, information: &DMatrix<f64>, numbers: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(numbers.len(), numbers.len(), |i, j| {
            let (a, b) = (numbers[i], numbers[j]);
            let value = information[(a, b)] * self.scale[a] * self.scale[b];
            if i == j { value * (1.0 + RIDGE) + f64::MIN_POSITIVE } else { value }
        })
    }

    /// One standard deviation of each number of the model, in its order, from the
    /// noise alone.
    pub fn stds(&self, information: &DMatrix<f64>) -> Vec<f64> {
        let inverse = self.of(information, &[&self.model[..], &self.nuisance].concat()).try_inverse();
        let std = |k: usize| {
            let variance = inverse.as_ref().map_or(f64::INFINITY, |inverse| inverse[(k, k)] * self.variance);
            variance.sqrt() * self.scale[self.model[k]]
        };
        (0..self.model.len()).map(std).collect()
    }

    /// `log det` of the scaled information of some numbers.
    fn log_det(&self, information: &DMatrix<f64>, numbers: &[usize]) -> f64 {
        let Some(factor) = self.of(information, numbers).cholesky() else { return f64::NEG_INFINITY };
        2.0 * factor.l_dirty().diagonal().iter().map(|pivot| pivot.ln()).sum::<f64>()
    }

    /// The value of what is known; more is better. A criterion that has nothing
    /// to say (no effects, no rivals) leaves it to D.
    pub fn value(&self, criterion: Criterion, information: &DMatrix<f64>) -> f64 {
        let beside = |numbers: &[usize], others: &[usize]| {
            self.log_det(information, &[numbers, others].concat()) - self.log_det(information, others)
        };
        let d = || beside(&self.model, &self.nuisance) / self.model.len().max(1) as f64;
        let t = || {
            let reduced = self.reduced(information);
            let chi_square = |&k: &usize| self.chi_square(&reduced, k).max(NOTHING);
            let inverse: f64 = self.pairs.iter().map(|k| chi_square(k).recip()).sum();
            (self.pairs.len() as f64 / inverse).ln()
        };
        match criterion {
            Criterion::Ds if !self.effects.is_empty() => {
                let of_others = self.model.iter().copied().filter(|k| !self.effects.contains(k));
                let others: Vec<usize> = of_others.chain(self.nuisance.iter().copied()).collect();
                beside(&self.effects, &others) / self.effects.len() as f64
            }
            Criterion::T if !self.pairs.is_empty() => t(),
            Criterion::Compound if !self.pairs.is_empty() => TELLING_APART * t() + (1.0 - TELLING_APART) * d(),
            _ => d(),
        }
    }
}
