//! The regression of absolute positions with the catalogue behind it, and the models
//! that are fitted with it.

use std::rc::Rc;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::offers::{Between, Form, Number, Offer, Possible, offers};
use super::rig::{Rig, reflector};
use crate::campaign::{Campaign, Positions};
use crate::identify::Error;
use crate::identify::covariance::NOISELESS;
use crate::identify::normal::{Fit, Scaled, Sign};
use crate::identify::positions::Prepared;
use crate::identify::positions::model::State;
use crate::identify::positions::regression::{Regression, Rows, STANDS, Solved};
use crate::identify::problem::{Problem, rms};
use crate::probability::schwarz;
use crate::trace::Options;
use crate::trace::bootstrap::ScoreTest;
use crate::trace::catalogue::{Candidate, Variant};
use crate::trace::model::{Named, all_but};

/// Positions with everything that may explain them, at a model.
#[derive(Clone)]
pub struct Bench<'c> {
    /// The positions and what they show of the description's own numbers.
    pub prepared: Prepared<'c>,
    /// The regression on all numbers, the description's own first.
    pub regression: Regression<'c>,
    /// What may be missing; columns of variants count from where the robot stands.
    pub candidates: Vec<Candidate>,
    /// The numbers of the candidates.
    pub numbers: Vec<Number>,
    /// The rows that are fitted to.
    pub rows: Rows,
    /// What moves the readings, whatever the robot does.
    pub(super) rig: Rc<Rig>,
    /// What numbers out of grids may be between those of the grid, by the form.
    pub(super) betweens: Vec<(Named, Between)>,
    /// Candidates that are not proposed for now.
    pub(super) barred: Vec<usize>,
    /// Whether the numbers of a form are possible together, of each candidate.
    possible: Vec<Possible>,
    /// All columns at the model: where the robot stands, then all numbers.
    problem: Problem,
    /// The sign of each column.
    signs: Vec<Sign>,
}

/// A model that was fitted in its own form.
#[derive(Clone)]
pub struct Model {
    /// The effects named, in the order of the catalogue.
    pub named: Vec<Named>,
    /// Its numbers and their fit.
    pub solved: Solved,
    /// Schwarz's criterion.
    pub bic: f64,
}

impl Model {
    /// Whether it leaves less than any noise: the readings were made by a program, and
    /// what is left is rounding.
    pub fn leaves_nothing(&self) -> bool {
        self.solved.fit.rss < self.solved.problem.total.rows as f64 * NOISELESS * NOISELESS
    }
}

/// A model by its linear fit, at another.
pub struct Proposed {
    /// The effects named, in the order of the catalogue.
    pub named: Vec<Named>,
    /// Schwarz's criterion, as far as the columns are those of the model.
    pub bic: f64,
    /// What it leaves, likewise (m^2).
    pub rss: f64,
}

impl<'c> Bench<'c> {
    /// The catalogue of a campaign, at the description as declared.
    ///
    /// # Errors
    /// Positions that do not tell where the robot stands.
    pub fn new(campaign: &Campaign, data: &'c Positions) -> Result<Self, Error> {
        let of_reflector = reflector().numbers.into_iter().map(|number| number.enters);
        let prepared = Prepared::with_kinematics(campaign, data, of_reflector)?;
        let rig = Rc::new(Rig::new(&campaign.robot, data));
        let regression = prepared.regression([]);
        let rows = prepared.rows.clone();
        let own: Vec<usize> = (0..regression.numbers.len()).collect();
        let (problem, _) = regression.at(&prepared.state(own.len()), &own, &rows);
        let signs = regression.signs_of(&own);
        let offered = offers(campaign, data, &rig);
        let mut bench = Self {
            prepared,
            regression,
            candidates: Vec::new(),
            numbers: Vec::new(),
            rows,
            rig,
            betweens: Vec::new(),
            barred: Vec::new(),
            possible: Vec::new(),
            problem,
            signs,
        };
        bench.offer(offered);
        bench.turn_to_state(&bench.prepared.state(bench.regression.numbers.len()));
        Ok(bench)
    }

    /// Adds to what may be missing.
    fn offer(&mut self, offers: impl IntoIterator<Item = Offer>) {
        for offer in offers {
            let candidate = self.candidates.len();
            let between = |(variant, form): (usize, &Form)| Some((Named { candidate, variant }, form.between.clone()?));
            self.betweens.extend(offer.forms.iter().enumerate().filter_map(between));
            self.possible.push(offer.possible);
            let first = STANDS + self.regression.numbers.len();
            let variant = |form: Form| {
                let columns = form.numbers.iter().map(|number| first + number).collect();
                // Marks are told, and cost nothing.
                let mut variant = Variant::new(columns, form.shape);
                variant.shape.extend(form.marks);
                variant
            };
            let variants = offer.forms.into_iter().map(variant).collect();
            self.candidates.push(Candidate { kind: offer.kind, place: offer.place, variants, check: None });
            for number in offer.numbers {
                self.regression.numbers.push(number.enters.clone());
                self.regression.signs.push(number.sign());
                self.signs.push(number.sign());
                self.numbers.push(number);
            }
        }
    }

    /// The same with more that may be missing, at a model, and that model there. To spare
    /// memory this one is without its columns until it is turned to a model again.
    pub fn widened(&mut self, model: &Model, more: impl IntoIterator<Item = Offer>) -> (Self, Model) {
        (self.problem, _) = self.regression.at(&model.solved.state, &[], &self.rows);
        let (mut wide, mut model) = (self.clone(), model.clone());
        wide.offer(more);
        model.solved.state.values.resize(wide.regression.numbers.len(), 0.0);
        wide.turn_to(&model);
        (wide, model)
    }

    /// The same with so many candidates only, and a state there.
    pub fn narrowed(mut self, candidates: usize, state: &State) -> (Self, State) {
        let gone = self.candidates.split_off(candidates);
        let columns = gone.iter().flat_map(|gone| &gone.variants).flat_map(|form| &form.columns);
        let (own, mut state) = (self.prepared.own.len(), state.clone());
        let numbers = columns.min().map_or(self.regression.numbers.len(), |first| first - STANDS);
        self.possible.truncate(candidates);
        self.numbers.truncate(numbers - own);
        self.regression.numbers.truncate(numbers);
        self.regression.signs.truncate(numbers);
        self.signs.truncate(STANDS + numbers);
        state.values.truncate(numbers);
        self.turn_to_state(&state);
        (self, state)
    }

    /// Turns to a model, and to the rows that it is fitted to.
    pub fn turn_to(&mut self, model: &Model) {
        self.turn_to_state(&model.solved.state);
    }

    fn turn_to_state(&mut self, state: &State) {
        let all: Vec<usize> = (0..self.regression.numbers.len()).collect();
        (self.problem, _) = self.regression.at(state, &all, &self.rows);
    }

    /// How many readings are fitted to.
    pub fn readings(&self) -> usize {
        self.problem.total.rows
    }

    /// The numbers of a model, the description's own first.
    pub fn chosen(&self, named: &[Named]) -> Vec<usize> {
        let effects = named.iter().flat_map(|&one| &self.variant(one).columns).map(|column| column - STANDS);
        self.prepared.seen().into_iter().chain(effects).collect()
    }

    /// The form of a named effect.
    pub fn variant(&self, one: Named) -> &Variant {
        &self.candidates[one.candidate].variants[one.variant]
    }

    /// The numbers of a named effect.
    pub fn numbers_of(&self, one: Named) -> impl Iterator<Item = &Number> {
        let own = STANDS + self.prepared.own.len();
        self.variant(one).columns.iter().map(move |column| &self.numbers[column - own])
    }

    /// Fits a model in its own form. `None` where the rows do not tell its numbers
    /// from each other, or they are not physical.
    pub fn solve(&self, named: &[Named], from: &State) -> Option<Model> {
        let chosen = self.chosen(named);
        let solved = self.regression.solve(&chosen, from, &self.rows)?;
        if !self.is_physical(named, &solved.fit.coefficients) {
            return None;
        }
        Some(Model { named: named.to_vec(), bic: self.bic(&solved.problem, named, &solved.fit), solved })
    }

    /// Whether the numbers of effects are possible, by the coefficients of a fit.
    pub(super) fn is_physical(&self, named: &[Named], coefficients: &DVector<f64>) -> bool {
        let own = STANDS + self.prepared.own.len();
        let seen = self.prepared.seen();
        // Joints come first among a description's own numbers.
        let compliance = |joint: usize| match seen.iter().position(|&number| number == joint - 1) {
            Some(at) => coefficients[STANDS + at],
            None => self.prepared.own[joint - 1].value,
        };
        let mut of_effects = coefficients.iter().skip(STANDS + seen.len()).copied();
        let possible = named.iter().all(|&one| {
            let columns = &self.variant(one).columns;
            let values: Vec<f64> = of_effects.by_ref().take(columns.len()).collect();
            let within = |(&column, &value): (&usize, &f64)| {
                let [least, most] = self.numbers[column - own].range;
                least < value && value < most
            };
            columns.iter().zip(&values).all(within) && (self.possible[one.candidate])(&values, &compliance)
        });
        possible && self.is_stable(named, coefficients)
    }

    /// Schwarz's criterion of a fit.
    fn bic(&self, problem: &Problem, named: &[Named], fit: &Fit) -> f64 {
        schwarz(fit.rss, problem.total.rows as f64, self.parameters(named) as f64)
    }

    /// How many numbers a model has.
    pub fn parameters(&self, named: &[Named]) -> usize {
        let of_effects: usize = named.iter().map(|&one| self.variant(one).parameters).sum();
        STANDS + self.prepared.seen().len() + of_effects
    }

    /// The columns of a model.
    fn columns(&self, named: &[Named]) -> Vec<usize> {
        (0..STANDS).chain(self.chosen(named).into_iter().map(|number| STANDS + number)).collect()
    }

    fn proposed(&self, mut named: Vec<Named>) -> Option<Proposed> {
        // One order for one set, so that it is the same model however come to.
        named.sort_unstable();
        let columns = self.columns(&named);
        let signs: Vec<Sign> = columns.iter().map(|&column| self.signs[column]).collect();
        let fit = self.problem.total.solve_signed(&columns, &signs)?;
        let physical = self.is_physical(&named, &fit.coefficients);
        physical.then(|| Proposed { bic: self.bic(&self.problem, &named, &fit), rss: fit.rss, named })
    }

    /// What a model leaves by its linear fit (m^2).
    pub fn rss(&self, named: &[Named]) -> Option<f64> {
        Some(self.proposed(named.to_vec())?.rss)
    }

    /// Every model with one effect more, each candidate in its best form, the best
    /// first.
    pub fn extended(&self, named: &[Named]) -> Vec<Proposed> {
        let is_named = |candidate: &usize| named.iter().any(|one| one.candidate == *candidate);
        let free = |candidate: &usize| !self.barred.contains(candidate) && !is_named(candidate);
        let best = |candidate| self.with(named, candidate);
        let mut found: Vec<Proposed> = (0..self.candidates.len()).filter(free).filter_map(best).collect();
        found.sort_by(|a, b| a.bic.total_cmp(&b.bic));
        found
    }

    /// The model with a candidate more, in its best form.
    pub fn with(&self, named: &[Named], candidate: usize) -> Option<Proposed> {
        let with = |variant| self.proposed([named, &[Named { candidate, variant }]].concat());
        let forms = (0..self.candidates[candidate].variants.len()).filter_map(with);
        forms.min_by(|a, b| a.bic.total_cmp(&b.bic))
    }

    /// Every model with one effect replaced, with the index of that, the best first.
    pub fn replaced(&self, named: &[Named]) -> Vec<(usize, Proposed)> {
        let without = |k: usize| {
            let (one, rest) = (named[k], all_but(named, k));
            let others = self.extended(&rest).into_iter();
            others.filter(move |other| !other.named.iter().any(|n| n.candidate == one.candidate)).map(move |m| (k, m))
        };
        let mut found: Vec<(usize, Proposed)> = (0..named.len()).flat_map(without).collect();
        found.sort_by(|(_, a), (_, b)| a.bic.total_cmp(&b.bic));
        found
    }

    /// Every model with one effect in another of its forms.
    pub fn reformed(&self, named: &[Named]) -> Vec<Proposed> {
        let others = |k: usize| {
            let Named { candidate, variant } = named[k];
            let forms = (0..self.candidates[candidate].variants.len()).filter(move |other| *other != variant);
            forms.filter_map(move |variant| {
                let mut named = named.to_vec();
                named[k] = Named { candidate, variant };
                self.proposed(named)
            })
        };
        (0..named.len()).flat_map(others).collect()
    }

    /// A model without the effects that are not worth their numbers.
    pub fn pruned(&self, mut model: Proposed) -> Proposed {
        loop {
            let without = |k: usize| {
                let rest = all_but(&model.named, k);
                self.proposed(rest)
            };
            let best = (0..model.named.len()).filter_map(without).min_by(|a, b| a.bic.total_cmp(&b.bic));
            match best.filter(|best| best.bic < model.bic) {
                Some(best) => model = best,
                None => return model,
            }
        }
    }

    /// All candidates against a model.
    pub fn test(&self, named: &[Named]) -> Option<ScoreTest> {
        let first = STANDS + self.prepared.own.len();
        ScoreTest::among(&self.problem, &self.candidates, &self.signs, first, &self.columns(named))
    }

    /// The family-wise p-value of an effect, that of the model without it.
    pub fn p_value(&self, named: &[Named], effect: usize, options: &Options) -> f64 {
        let (one, rest) = (named[effect], all_but(named, effect));
        let p = self.test(&rest).and_then(|test| {
            let (statistic, _) = test.statistics()[one.candidate]?;
            Some(test.reference(options.draws, options.seed).p_value(statistic))
        });
        p.unwrap_or(1.0)
    }

    /// Whether a candidate leaves something to see beyond the description's own numbers
    /// and where the robot stands.
    pub fn shows(&self, candidate: usize) -> bool {
        self.candidates[candidate].variants.iter().any(|form| form.columns.iter().any(|&column| self.is_seen(column)))
    }

    /// The same of a number by its column.
    pub fn is_seen(&self, column: usize) -> bool {
        let base = self.columns(&[]);
        let total = &self.problem.total;
        let Some(inverse) = total.inverse(&base) else { return true };
        let along = DVector::from_fn(base.len(), |k, _| total.gram[(base[k], column)]);
        let own = total.gram[(column, column)];
        own > 0.0 && own - along.dot(&(&inverse * &along)) > SEEN * own
    }

    /// Of some numbers those that the positions tell from the ones before them, and from
    /// another stand of the robot.
    pub fn independent(&self, numbers: &[usize]) -> Vec<usize> {
        let mut kept: Vec<usize> = (0..STANDS).collect();
        for number in numbers {
            kept.push(STANDS + number);
            if Scaled::apart(&self.problem.total.gram_of(&kept), SEEN).is_none() {
                kept.pop();
            }
        }
        kept.into_iter().skip(STANDS).map(|column| column - STANDS).collect()
    }

    /// The columns of some numbers, at the model.
    pub fn columns_of(&self, numbers: &[usize]) -> DMatrix<f64> {
        self.problem.white.select_columns(&numbers.iter().map(|number| STANDS + number).collect::<Vec<_>>())
    }

    /// The root mean square error on each pose fitted to, by the fit without it (m).
    pub fn left_out_rms(&self, solved: &Solved) -> f64 {
        let problem = &solved.problem;
        let mut left = (*problem.readings).clone();
        let columns = &solved.fit.columns;
        for block in problem.blocks.iter() {
            let without = problem.solve_without(block, columns, Some(&solved.signs));
            let coefficients = without.as_ref().unwrap_or(&solved.fit.coefficients);
            let own = problem.block_residuals(block, columns, coefficients);
            block.stacked.iter().zip(own.iter()).for_each(|(&i, &residual)| left[i] = residual);
        }
        rms(&left, 3, problem.blocks.iter().flat_map(|block| block.rows.iter().copied()))
    }

    /// The columns of a model as they are at it, with the readings, of some columns
    /// besides.
    pub fn with_columns(&self, model: &Model, more: &DMatrix<f64>) -> Problem {
        self.regression.with_columns(&model.solved, more, &self.rows)
    }
}

/// A column of which less than this is left says nothing of its own.
const SEEN: f64 = 1e-6;

/// Criteria closer than this are equal but for rounding.
pub const TIE: f64 = 1e-3;
