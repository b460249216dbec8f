//! How unsure numbers are for those of the table that a model leaves at zero.
//!
//! A number that is not named counts as zero in the fit of the others, and if it is not, they
//! are off by what they take up of it. A table's twists and lengths that hardly tell from each
//! other (that of a wrist's axis and the length before it) take up all, many times what noise
//! does to them. That nothing was found significant does not make a number zero, least of all
//! where most others of the table are off. So standard deviations are of all models together, by
//! how likely each is (Hoeting, Madigan, Raftery and Volinsky, Statistical Science 14, 1999,
//! 382-417): each number that is left at zero is off with some probability, and then by as much
//! as the named ones are.
//!
//! The prior of a number is a spike at zero and a slab, a normal distribution (Mitchell and
//! Beauchamp, Journal of the American Statistical Association 83, 1988, 1023-1032). How many are
//! off at all, and by how much, the table says itself (empirical Bayes): the slab is as wide as
//! the named numbers of that unit, by their median, or as what one reading says of it where
//! that is narrower or none is named, as Schwarz's criterion has it; how many, by expectation
//! and maximisation over the named ones and what is left of the readings. Where one of twenty
//! is named, the others are hardly off; where most are, these are, too.
//!
//! The readings say of all of them together what they are: each has the normal prior with which
//! it alone would have the second moment that spike and slab give it. Values stay those of the
//! model that is told; what the others would shift them by counts as spread.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::bench::{Bench, Model};
use crate::identify::normal::{Fit, Scaled, Sign};
use crate::identify::positions::regression::STANDS;
use crate::identify::problem::Problem;
use crate::identify::uncertainty::shifts;
use crate::trace::catalogue::{DH_ERROR, JOINT_ZERO_OFFSET, Kind};

/// Kinds whose numbers are the table's: an arm as built has all of them a little off.
static OF_TABLE: [&Kind; 2] = [&JOINT_ZERO_OFFSET, &DH_ERROR];

/// Steps of expectation and maximisation; each takes the share of numbers that are off nearer.
const STEPS: usize = 50;

/// Times the median of normal numbers' sizes is their standard deviation.
const OF_MEDIAN: f64 = 1.482_602;

/// Numbers of the table that a model leaves at zero.
pub struct LeftAtZero {
    /// The numbers: those that the positions tell from the model's, and from each other.
    pub numbers: Vec<usize>,
    /// By how much each would be off were it off, as far as named ones of its unit say it:
    /// one standard deviation.
    sizes: Vec<Option<f64>>,
    /// How many numbers of the table the model has.
    named: usize,
}

impl LeftAtZero {
    /// Those of a model.
    pub fn by(bench: &Bench<'_>, model: &Model) -> Self {
        let own = bench.prepared.own.len();
        let seen = bench.prepared.seen().into_iter();
        let declared = seen.filter(|&number| is_of_table(&bench.prepared.own[number].name));
        let of = |candidate: usize| bench.candidates[candidate].variants.iter().flat_map(|form| &form.columns);
        let is_table = |candidate: &usize| OF_TABLE.contains(&bench.candidates[*candidate].kind);
        let is_named = |candidate: usize| model.named.iter().any(|one| one.candidate == candidate);
        let (named, rest): (Vec<usize>, Vec<usize>) =
            (0..bench.candidates.len()).filter(is_table).partition(|&candidate| is_named(candidate));
        let numbers = |candidates: Vec<usize>| candidates.into_iter().flat_map(of).map(|column| column - STANDS);
        let named: Vec<usize> = declared.chain(numbers(named)).collect();
        let chosen = bench.chosen(&model.named);
        let mut left = bench.independent(&chosen.iter().copied().chain(numbers(rest)).collect::<Vec<_>>());
        left.retain(|number| !chosen.contains(number));
        let unit = |number: usize| match number.checked_sub(own) {
            Some(number) => bench.numbers[number].unit,
            None => bench.prepared.own[number].unit,
        };
        let size = |&number: &usize| {
            let alike = named.iter().filter(|&&other| unit(other) == unit(number));
            median(alike.map(|&other| model.solved.state.values[other].abs()).collect()).map(|size| OF_MEDIAN * size)
        };
        Self { sizes: left.iter().map(size).collect(), numbers: left, named: named.len() }
    }

    /// The covariance that they give to the coefficients of a fit; `first` is their first
    /// column in its regression.
    pub fn covariance(&self, problem: &Problem, fit: &Fit, signs: &[Sign], first: usize) -> DMatrix<f64> {
        let columns: Vec<usize> = (first..first + self.numbers.len()).collect();
        let shifts = shifts(problem, fit, signs, &columns);
        // What the fit leaves of them, and of the readings along them.
        let cross =
            DMatrix::from_fn(fit.columns.len(), columns.len(), |i, k| problem.total.gram[(fit.columns[i], columns[k])]);
        let gram = problem.total.gram_of(&columns) - cross.tr_mul(&shifts);
        let moment = problem.total.moment_of(&columns) - cross.tr_mul(&fit.coefficients);
        let variance = problem.variance(fit);
        // Where nothing at all is left of the readings, they are at zero.
        let told = (variance > 0.0 && !columns.is_empty()).then(|| (gram / variance, moment / variance));
        let moments = told.and_then(|(gram, moment)| self.second_moments(&gram, &moment, problem.total.rows as f64));
        moments
            .map_or_else(|| DMatrix::zeros(signs.len(), signs.len()), |moments| &shifts * moments * shifts.transpose())
    }

    /// The second moments of the numbers about zero, by what so many readings say of them: a
    /// Gram matrix and the moment along it, in units of the readings' variance.
    fn second_moments(&self, gram: &DMatrix<f64>, moment: &DVector<f64>, readings: f64) -> Option<DMatrix<f64>> {
        let alone = |k: usize| Alone::new(gram[(k, k)], moment[k], self.sizes[k], readings);
        let each: Vec<Alone> = (0..self.numbers.len()).map(alone).collect();
        let share = self.share_off(&each);
        let known = DVector::from_iterator(each.len(), each.iter().map(|one| one.known(share)));
        let spread = Scaled::of(&(gram + DMatrix::from_diagonal(&known)))?.inverse();
        let mean = &spread * moment;
        Some(spread + &mean * mean.transpose())
    }

    /// The share of the table's numbers that are off: of those the readings can show, the named
    /// ones, and others as likely as they are off; with half a number before any is known.
    fn share_off(&self, each: &[Alone]) -> f64 {
        let all = (self.named + each.len() + 1) as f64;
        (0..STEPS).fold(0.5, |share, _| {
            let off: f64 = each.iter().map(|one| one.is_off(share)).sum();
            (self.named as f64 + 0.5 + off) / all
        })
    }
}

/// What readings say of a number that is left at zero, were it the only one.
struct Alone {
    /// Its value by the readings.
    value: f64,
    /// The variance of that.
    variance: f64,
    /// The variance of its slab.
    slab: f64,
}

impl Alone {
    fn new(gram: f64, moment: f64, size: Option<f64>, readings: f64) -> Self {
        let variance = gram.recip();
        let of_reading = readings * variance;
        Self { value: moment * variance, variance, slab: size.map_or(of_reading, |size| of_reading.min(size * size)) }
    }

    /// How much of its value by the readings is left beside the slab.
    fn kept(&self) -> f64 {
        self.slab / (self.slab + self.variance)
    }

    /// How likely it is off, where so many are.
    fn is_off(&self, share: f64) -> f64 {
        let for_zero =
            (self.variance + self.slab).ln() - self.variance.ln() - self.kept() * self.value.powi(2) / self.variance;
        let odds = (1.0 - share) / share * (0.5 * for_zero).exp();
        1.0 / (1.0 + odds)
    }

    /// One over the variance of the normal prior that gives it the second moment of spike and
    /// slab.
    fn known(&self, share: f64) -> f64 {
        let (kept, square) = (self.kept(), self.value.powi(2));
        let second = self.is_off(share) * (kept * self.variance + kept * kept * square);
        // `kept^2 square + kept variance = second`.
        let root = (self.variance.powi(2) + 4.0 * square * second).sqrt();
        let kept = 2.0 * second / (self.variance + root);
        (1.0 - kept) / (kept * self.variance)
    }
}

/// Whether a number of a description, by its name, is the table's.
fn is_of_table(name: &str) -> bool {
    OF_TABLE.iter().any(|kind| name.split('@').next() == Some(kind.name))
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let (below, above) = (values.get(values.len().checked_sub(1)? / 2)?, values.get(values.len() / 2)?);
    Some(0.5 * (below + above))
}
