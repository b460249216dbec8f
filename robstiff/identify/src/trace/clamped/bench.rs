//! The regression of clamped axes: rows, columns and models.

use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::axes::{Axes, OnAxes, OnAxesForm, SLIPPED_AXIS};
use crate::identify::clamped::regression::problem;
use crate::identify::covariance::NOISELESS;
use crate::identify::normal::{Fit, Sign};
use crate::identify::problem::Problem;
use crate::probability::schwarz;
use crate::trace::Options;
use crate::trace::bootstrap::ScoreTest;
use crate::trace::catalogue::{Candidate, KINDS, Kind, LOAD_CELL_BIAS, Variant};
use crate::trace::found::Place;
use crate::trace::model::{Fitted, Named, all_but};
use crate::trace::selection::WITHIN_REACH;
use robstiff_robots::effect::Place as Part;

/// Names of one axis beyond this are borrowed ones; those that all axes share are of each.
const MOST_EFFECTS: usize = 4;

/// How many of the best proposals are put to the tests in one step.
const PROPOSALS: usize = 3;

/// The rows with everything that may explain them.
pub struct Bench {
    /// The rows.
    pub axes: Axes,
    /// What may be missing.
    pub offers: Vec<(&'static Kind, OnAxes)>,
    /// The same as the tests have it.
    pub candidates: Vec<Candidate>,
    /// The sign of each column.
    pub signs: Vec<Sign>,
    /// The columns as measured; those of the loaded axes come first.
    pub raw: DMatrix<f64>,
    /// The regression, every row a block.
    pub problem: Problem,
    /// How many axes are loaded.
    pub base: usize,
}

impl Bench {
    /// The rows with what the catalogue does to them; forms keep the numbers out
    /// of grids that they had.
    pub fn new(axes: Axes, before: Option<&[(&'static Kind, OnAxes)]>) -> Self {
        // Of all rows, so that what is offered stays the same, and what a load does stays
        // where its reading is left out.
        let whole = axes.whole();
        let of = |kind: &&'static Kind| {
            let offers = axes.of_used(kind.on_axes.map_or_else(Vec::new, |offer| offer(&whole)));
            offers.into_iter().map(|one| (*kind, one)).collect::<Vec<_>>()
        };
        let mut offers: Vec<(&'static Kind, OnAxes)> = KINDS.iter().flat_map(of).collect();
        offers.retain(|(kind, one)| !axes.declares(kind, one.place));
        for ((_, one), (_, old)) in offers.iter_mut().zip(before.into_iter().flatten()) {
            one.forms.iter_mut().zip(&old.forms).for_each(|(form, old)| form.shape.clone_from(&old.shape));
        }
        let loaded: Vec<usize> = axes.loaded().collect();
        let torque = |&axis: &usize| super::axes_column(axes.rows.len(), &axes.rows_of(axis), axes.torques(axis));
        let mut columns: Vec<DVector<f64>> = loaded.iter().map(torque).collect();
        let mut signs = vec![Sign::Nonnegative; columns.len()];
        let mut candidates = Vec::new();
        for (kind, one) in &offers {
            let variant = |form: &OnAxesForm| {
                let first = columns.len();
                columns.extend((form.columns)(&form.values()));
                signs.extend(form.numbers.iter().map(|number| match number.range[0] >= 0.0 {
                    true => Sign::Nonnegative,
                    false => Sign::Free,
                }));
                let plain = Variant::new((first..columns.len()).collect(), form.shape.clone());
                // The row that it begins at is one more number out of a grid, where rows are
                // searched. The first row is as dear where lost motion shifts an axis as well.
                let slips = form.told.iter().find(|number| number.name == SLIPPED_AXIS);
                let is_dear =
                    slips.is_some_and(|axis| one.forms.len() > 1 || !axes.is_loaded_both_ways(axis.value as usize));
                let parameters = plain.parameters + usize::from(is_dear);
                Variant { within: form.within, likely: form.likely, parameters, ..plain }
            };
            let variants = one.forms.iter().map(variant).collect();
            candidates.push(Candidate { kind, place: one.place, variants, check: None });
        }
        let raw = DMatrix::from_columns(&columns);
        let problem = problem(&axes.rows, raw.clone());
        Self { base: loaded.len(), axes, offers, candidates, signs, raw, problem }
    }

    /// The columns of a model.
    pub fn columns(&self, named: &[Named]) -> Vec<usize> {
        let effects = named.iter().flat_map(|one| &self.candidates[one.candidate].variants[one.variant].columns);
        (0..self.base).chain(effects.copied()).collect()
    }

    /// The form of a named effect.
    pub fn form(&self, one: Named) -> &OnAxesForm {
        &self.offers[one.candidate].1.forms[one.variant]
    }

    /// The axis whose rows an effect moves; none where all axes share it.
    pub fn axis_of(&self, candidate: usize) -> Option<usize> {
        let (_, one) = &self.offers[candidate];
        match one.place {
            Place::Part(Part::Joint(axis)) => Some(axis),
            _ => one.forms[0].told.iter().find(|number| number.name == SLIPPED_AXIS).map(|axis| axis.value as usize),
        }
    }

    /// Whether an effect may be named beside others: as many as [`MOST_EFFECTS`] of an axis.
    pub fn has_room(&self, named: &[Named], candidate: usize) -> bool {
        let axis = self.axis_of(candidate);
        let beside = |one: &&Named| {
            let other = self.axis_of(one.candidate);
            other == axis || other.is_none()
        };
        named.iter().all(|one| one.candidate != candidate) && named.iter().filter(beside).count() < MOST_EFFECTS
    }

    /// The effects that may be named beside others.
    pub fn offered(&self, named: &[Named]) -> impl Iterator<Item = usize> {
        (0..self.candidates.len()).filter(move |&candidate| self.has_room(named, candidate))
    }

    /// Fits a model; `None` where physics does not allow it.
    pub fn fit(&self, named: &[Named]) -> Option<Fitted> {
        let columns = self.columns(named);
        let signs: Vec<Sign> = columns.iter().map(|&column| self.signs[column]).collect();
        let fit = self.problem.total.solve_signed(&columns, &signs)?;
        let numbers = named.iter().flat_map(|&one| &self.form(one).numbers);
        let values = fit.coefficients.iter().skip(self.base);
        let physical = numbers.zip(values).all(|(number, &value)| number.range[0] < value && value < number.range[1]);
        let bic = self.bic(fit.rss, named, 0);
        physical.then(|| Fitted { named: named.to_vec(), fit, bic, physical })
    }

    /// Schwarz's criterion of a model that leaves `rss` with `more` numbers besides
    /// its own.
    pub fn bic(&self, rss: f64, named: &[Named], more: usize) -> f64 {
        schwarz(rss, self.axes.rows.len() as f64, (self.parameters(named) + more) as f64)
    }

    /// How many numbers a model has, those out of grids counting each as one, but those of which
    /// is known beforehand what they are likely to be: data say little more of them.
    pub fn parameters(&self, named: &[Named]) -> usize {
        let known = |form: &OnAxesForm| form.likely.map_or(0, |_| form.shape.len());
        self.base + named.iter().map(|&one| self.variant(one).parameters - known(self.form(one))).sum::<usize>()
    }

    fn variant(&self, one: Named) -> &Variant {
        &self.candidates[one.candidate].variants[one.variant]
    }

    pub fn test(&self, named: &[Named]) -> Option<ScoreTest> {
        ScoreTest::among(&self.problem, &self.candidates, &self.signs, self.base, &self.columns(named))
    }

    /// What each candidate gains by a test, and the variant that does: no less than rounding is
    /// the noise of the axis that it moves, which is the same in rows of one torque and looks
    /// like a curve.
    pub fn statistics(&self, test: &ScoreTest) -> Vec<Option<(f64, usize)>> {
        let largest = self.axes.rounding.iter().copied().fold(0.0, f64::max);
        let against = |(candidate, found): (usize, Option<(f64, usize)>)| {
            let (statistic, variant) = found?;
            let least = self.axis_of(candidate).map_or(largest, |axis| self.axes.rounding[axis - 1]);
            Some((test.against(statistic, &self.candidates[candidate].variants[variant], least), variant))
        };
        test.statistics().into_iter().enumerate().map(against).collect()
    }

    /// The root mean square of each row's residual by the fit without it (rad).
    pub fn left_out_rms(&self, fit: &Fit) -> f64 {
        let signs: Vec<Sign> = fit.columns.iter().map(|&column| self.signs[column]).collect();
        let squares = self.problem.blocks.iter().map(|block| {
            let without = self.problem.solve_without(block, &fit.columns, Some(&signs));
            let row = block.rows[0];
            let with = without.as_ref().unwrap_or(&fit.coefficients).iter();
            let fitted: f64 = fit.columns.iter().zip(with).map(|(&column, b)| self.raw[(row, column)] * b).sum();
            (self.problem.readings[row] - fitted).powi(2)
        });
        (squares.sum::<f64>() / self.problem.blocks.len() as f64).sqrt()
    }

    /// Whether a fit leaves less than any noise: the readings were made by a program, and what
    /// is left is rounding.
    pub fn leaves_nothing(&self, fit: &Fit) -> bool {
        fit.rss < self.axes.rows.len() as f64 * NOISELESS * NOISELESS
    }

    /// What a fit leaves of the rows (rad).
    pub fn residuals(&self, fit: &Fit) -> DVector<f64> {
        let mut left = (*self.problem.readings).clone();
        for (&column, &value) in fit.columns.iter().zip(fit.coefficients.iter()) {
            left.axpy(-value, &self.raw.column(column), 1.0);
        }
        left
    }

    /// The best model with one effect more, by candidate, the best first.
    pub fn extended(&self, named: &[Named]) -> Vec<Fitted> {
        self.extended_by(named, |_| true)
    }

    /// The same with some of the candidates alone.
    pub fn extended_by(&self, named: &[Named], some: impl Fn(usize) -> bool) -> Vec<Fitted> {
        let best = |candidate: usize| {
            let with = |variant: usize| {
                let mut named = named.to_vec();
                named.push(Named { candidate, variant });
                named.sort_unstable();
                self.fit(&named)
            };
            let fits = (0..self.candidates[candidate].variants.len()).filter_map(with);
            fits.min_by(|a, b| a.bic.total_cmp(&b.bic))
        };
        let mut found: Vec<Fitted> = self.offered(named).filter(|&k| some(k)).filter_map(best).collect();
        found.sort_by(|a, b| a.bic.total_cmp(&b.bic));
        found
    }

    /// What a model could be taken for: every model with one effect replaced, with
    /// the index of that.
    pub fn replaced(&self, named: &[Named]) -> Vec<(usize, Fitted)> {
        let without = |k: usize| {
            let (one, rest) = (named[k], all_but(named, k));
            let others = self.extended(&rest).into_iter();
            others.filter(move |other| !other.named.iter().any(|n| n.candidate == one.candidate)).map(move |m| (k, m))
        };
        (0..named.len()).flat_map(without).collect()
    }

    /// The family-wise p-value of an effect of a model, that of the model without it.
    fn p_value(&self, named: &[Named], k: usize, options: &Options) -> f64 {
        let (one, rest) = (named[k], all_but(named, k));
        let p_value = || {
            let test = self.test(&rest)?;
            let (statistic, _) = self.statistics(&test)[one.candidate]?;
            Some(test.reference(options.draws, options.seed).p_value(statistic))
        };
        p_value().unwrap_or(1.0)
    }

    /// That of each effect.
    pub fn p_values(&self, named: &[Named], options: &Options) -> Vec<f64> {
        (0..named.len()).map(|k| self.p_value(named, k, options)).collect()
    }

    /// Whether every effect of a model is significant beside the others.
    pub fn is_significant(&self, named: &[Named], options: &Options) -> bool {
        (0..named.len()).all(|k| self.p_value(named, k, options) <= options.alpha)
    }

    /// The first of some models that passes every test.
    pub fn accepted(&self, proposals: &[Fitted], smaller: &Fitted, options: &Options) -> Option<Fitted> {
        let best = proposals.first()?.bic;
        let near = proposals.iter().take_while(|one| one.bic < best + WITHIN_REACH).take(PROPOSALS);
        let before = self.left_out_rms(&smaller.fit);
        let mut near = near.filter(|one| self.left_out_rms(&one.fit) < before);
        near.find(|one| self.is_significant(&one.named, options)).cloned()
    }

    /// The same with the compliances of a model, and its bias of the torque, in what effects
    /// do, which depends on them.
    pub fn with_numbers(&self, model: &Fitted) -> Self {
        let mut axes = self.axes.clone();
        let loaded: Vec<usize> = axes.loaded().collect();
        for (axis, &value) in loaded.into_iter().zip(model.fit.coefficients.iter()) {
            axes.compliance[axis - 1] = value;
        }
        let mut at = self.base;
        axes.bias = 0.0;
        for &one in &model.named {
            if self.candidates[one.candidate].kind == &LOAD_CELL_BIAS {
                axes.bias = model.fit.coefficients[at];
            }
            at += self.form(one).numbers.len();
        }
        Self::new(axes, Some(&self.offers))
    }
}
