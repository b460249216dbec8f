//! A campaign's forward model fitted with any effects: nonlinear numbers in
//! their own form, by Gauss-Newton steps with all numbers together, and the
//! whole catalogue linearised at what comes out.

mod fresh;
mod held;
mod noise;
mod polish;
mod prepare;
mod solve;

use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use robstiff_robots::Description;

pub use self::noise::Known;
use self::solve::State;
use super::Options;
use super::catalogue::{Candidate, Number, Scene};
use super::isolated::Event;
use super::model::{Fitted, Named, Setting, Stored};
use super::point::Point;
use super::selection::Tests;
use super::slip::Moments;
use crate::campaign::Campaign;
use crate::identify::column::Column;
use crate::identify::normal::{Fit, Sign};
use crate::identify::prepare::Prepared;
use crate::identify::problem::{Problem, Weights};
use crate::identify::samples::Samples;
use robstiff::elements::Spring;

/// Everything that is needed to fit a campaign with effects of the catalogue.
pub struct Bench<'c> {
    campaign: &'c Campaign,
    pub(super) prepared: &'c Prepared<'c>,
    own: Rc<[Column]>,
    /// The columns of the description's numbers that are fitted.
    base: Rc<[usize]>,
    candidates: Rc<[Candidate]>,
    numbers: Rc<[Number]>,
    signs: Rc<[Sign]>,
    /// Full names of what these data cannot show at all.
    pub invisible: Vec<String>,
    /// What is wrong in single visits, when last looked at.
    pub events: Rc<[Event]>,
    /// Rows that are left out for it.
    pub left_out: Vec<bool>,
    /// How noisy the readings are, as far as is known.
    pub noise: Rc<Known>,
    /// Whether rows need only stand out from noise, not from structure.
    pub strict: bool,
    /// Whether rows of poses fitted to are wild, too, where the others of their own pose
    /// contradict them, as those of poses held out always are.
    pub by_own_pose: bool,
    /// Whether effects are tested where the model that has them stands, and not the one without.
    pub by_own_form: bool,
    /// Whether the candidates have those without a name among them, behind all others.
    wide: bool,
    /// Whether they have a reflector among them that sits elsewhere.
    elsewhere: bool,
    /// Where slips that all later rows keep may have begun.
    moments: Moments,
    settings: Solved<Setting<'c>>,
    /// The columns that were formed last.
    stored: Rc<RefCell<Stored>>,
    states: Solved<State>,
    tests: Tested,
    /// The readings that linear models are fitted to.
    readings: OnceCell<Rc<DVector<f64>>>,
}

/// What was found of models, or why not.
type Solved<T> = RefCell<HashMap<Vec<Named>, Result<Rc<T>, String>>>;

/// The tests against models, with so many draws and a seed.
type Tested = RefCell<HashMap<(Vec<Named>, usize, u64), Option<Rc<Tests>>>>;

impl<'c> Bench<'c> {
    /// The robot as declared.
    pub fn robot(&self) -> &Description {
        &self.campaign.robot
    }

    /// The campaign that candidates are looked for in.
    pub fn scene(&self) -> Scene<'_> {
        Scene {
            description: &self.campaign.robot,
            data: self.prepared.data,
            samples: &self.prepared.samples,
            compliance: self.prepared.values[..self.prepared.samples.joints()].to_vec(),
            moments: &self.moments,
            elsewhere: self.elsewhere,
        }
    }

    /// Whether there are so many rows that memory has to be spared.
    fn is_large(&self) -> bool {
        self.left_out.len() > MANY_ROWS
    }

    /// Lets go of the columns that were formed last, where they take much memory;
    /// those that are asked for are formed again.
    pub fn spare_memory(&self) {
        if self.is_large() {
            self.stored.borrow().borrow_mut().take();
        }
    }

    /// Forgets what was found of models, for they are others now.
    fn forget(&mut self) {
        self.settings.get_mut().clear();
        self.states.get_mut().clear();
        self.tests.get_mut().clear();
    }

    /// The candidates.
    pub fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    /// The full names of a model's effects.
    pub fn names(&self, named: &[Named]) -> Vec<String> {
        named.iter().map(|one| self.candidates[one.candidate].name()).collect()
    }

    /// The regression at a model's solution.
    ///
    /// # Errors
    /// Why the model is no physical one.
    pub fn at(&self, named: &[Named]) -> Result<Rc<Setting<'c>>, String> {
        if let Some(known) = self.settings.borrow().get(named) {
            return known.clone();
        }
        let found = self.setting(named).map(Rc::new);
        let mut settings = self.settings.borrow_mut();
        if settings.len() >= KEPT && self.is_large() {
            settings.retain(|named, _| named.is_empty());
        }
        settings.insert(named.to_vec(), found.clone());
        found
    }

    /// The tests of the whole catalogue against a model; `None` where it cannot
    /// be fitted.
    pub fn tests(&self, named: &[Named], options: &Options) -> Option<Rc<Tests>> {
        let key = (named.to_vec(), options.draws, options.seed);
        if let Some(known) = self.tests.borrow().get(&key) {
            return known.clone();
        }
        let found = self.at(named).ok().and_then(|setting| Tests::against(&setting, named, options)).map(Rc::new);
        let mut tests = self.tests.borrow_mut();
        if tests.len() >= KEPT && self.is_large() {
            tests.clear();
        }
        tests.insert(key, found.clone());
        found
    }

    /// A model at its solution.
    ///
    /// # Errors
    /// Why the model is no physical one.
    pub fn fit(&self, named: &[Named]) -> Result<Fitted, String> {
        self.at(named)?.fit(named)
    }

    /// A model at its solution, whether physics allows it or not: what is missing besides
    /// can drive its numbers beyond that.
    ///
    /// # Errors
    /// Why it cannot be fitted at all.
    pub fn fit_or_loosely(&self, named: &[Named]) -> Result<Fitted, String> {
        let setting = self.at(named)?;
        setting.fit(named).or_else(|why| setting.fit_loosely(named).ok_or(why))
    }

    /// A proposal with its nonlinear numbers in their own form; as it is where
    /// neither it nor the setting it was fitted in has any.
    pub fn refit(&self, setting: &Setting<'_>, proposed: &Fitted) -> Result<Fitted, String> {
        if setting.tangents.is_empty() && !self.is_nonlinear(&proposed.named) {
            return Ok(proposed.clone());
        }
        let state = self.state(&proposed.named)?;
        setting.judge(&proposed.named, state.fit.clone())
    }

    /// Whether a model has nonlinear numbers.
    pub fn is_nonlinear(&self, named: &[Named]) -> bool {
        !self.nonlinear(named).is_empty()
    }

    /// The columns of nonlinear numbers of a model, with the numbers.
    fn nonlinear(&self, named: &[Named]) -> Vec<(usize, &Number)> {
        let columns = named.iter().flat_map(|one| &self.candidates[one.candidate].variants[one.variant].columns);
        let numbers = columns.map(|&column| (column, &self.numbers[column - self.own.len()]));
        numbers.filter(|(_, number)| number.enters.is_some()).collect()
    }

    /// Whether a row is of a pose that is fitted to.
    pub fn is_fitted_to(&self, row: usize) -> bool {
        self.prepared.training[self.prepared.samples.rows[row].pose]
    }

    /// Whether a column is of one of the description's own numbers.
    pub fn is_base(&self, column: usize) -> bool {
        column < self.own.len()
    }

    /// How rows are weighed.
    pub fn weights(&self) -> Weights<'_> {
        Weights { covariance: &self.noise.covariance, training: &self.prepared.training, left_out: &self.left_out }
    }

    fn state(&self, named: &[Named]) -> Result<Rc<State>, String> {
        if let Some(known) = self.states.borrow().get(named) {
            return known.clone();
        }
        let found = self.solve(named).map(Rc::new);
        self.states.borrow_mut().insert(named.to_vec(), found.clone());
        found
    }

    /// The rows at a model's solution.
    fn point_at(&self, named: &[Named], State { setup, fit, .. }: &State) -> Point<'c> {
        let point = self.point(setup.clone());
        let elastic = self.prediction(&point, fit, &self.nonlinear(named));
        let declared: &Samples = &self.prepared.samples;
        point.with_model(declared, elastic, &self.springs(fit))
    }

    /// The places of the rows that are fitted to in what is stacked.
    fn fitted_to(&self) -> impl Iterator<Item = usize> {
        let (training, samples) = (&self.prepared.training, &self.prepared.samples);
        let is_fitted_to = |row: &usize| training[samples.rows[*row].pose] && !self.left_out[*row];
        let places = |row: usize| (row * samples.axes..(row + 1) * samples.axes).chain(samples.encoders_of(row));
        (0..samples.rows.len()).filter(is_fitted_to).flat_map(places)
    }

    /// How large a column is, whitened, over the rows that are fitted to at a point.
    fn size_at<'a>(&'a self, point: &'a Point<'c>) -> impl Fn(usize) -> f64 + 'a {
        let whitener = self.noise.covariance.whitener(&self.left_out);
        let places: Vec<usize> = self.fitted_to().collect();
        move |column| {
            let white = whitener.whitened(self.linear(point, column));
            places.iter().map(|&at| white[at] * white[at]).sum::<f64>().sqrt()
        }
    }

    /// The regression at a model's solution, with the whole catalogue.
    fn setting(&self, named: &[Named]) -> Result<Setting<'c>, String> {
        let state = self.state(named)?;
        let State { fit, tangents, readings, base, .. } = &*state;
        let point = self.point_at(named, &state);
        let besides = self.besides(named, &point, fit);
        let own = self.own.len() + self.numbers.len();
        self.spare_memory();
        let mut raw = Vec::with_capacity(readings.len() * (own + besides.len()));
        for column in 0..own {
            match tangents.iter().find(|(of, _)| *of == column) {
                Some((_, tangent)) => raw.extend_from_slice(tangent.as_slice()),
                None => raw.extend_from_slice(self.linear(&point, column).as_slice()),
            }
        }
        besides.iter().for_each(|column| raw.extend_from_slice(column.as_slice()));
        let raw = DMatrix::from_vec(readings.len(), own + besides.len(), raw);
        let weights = self.weights();
        let whitener = Rc::new(weights.covariance.whitener(weights.left_out));
        let readings = Rc::clone(readings);
        let problem = Problem::new(&point.samples, raw, readings, &self.prepared.correction, weights);
        let columns = Rc::new(RefCell::new(Some(problem.white)));
        *self.stored.borrow_mut() = Rc::clone(&columns);
        Ok(Setting {
            point,
            problem: problem.equations,
            columns,
            whitener,
            besides,
            candidates: Rc::clone(&self.candidates),
            numbers: Rc::clone(&self.numbers),
            signs: Rc::clone(&self.signs),
            base: base.clone(),
            own: Rc::clone(&self.own),
            joint_values: self.prepared.own[..self.prepared.samples.joints()].iter().map(|own| own.value).collect(),
            tangents: tangents.clone(),
            correction: self.prepared.correction.clone(),
            training: &self.prepared.training,
        })
    }

    /// The directions, stacked, of what the readings may have besides that no
    /// column of a model says.
    fn besides(&self, named: &[Named], point: &Point<'c>, fit: &Fit) -> Vec<DVector<f64>> {
        let mut found = Vec::new();
        for one in named {
            let variant = &self.candidates[one.candidate].variants[one.variant];
            let Some(unsure) = &variant.unsure else { continue };
            let value =
                |column: &usize| fit.columns.iter().position(|of| of == column).map_or(0.0, |at| fit.coefficients[at]);
            let examples = unsure(point, &variant.columns.iter().map(value).collect::<Vec<f64>>());
            if examples.is_empty() {
                continue;
            }
            let examples = DMatrix::from_columns(&examples);
            let parts = SymmetricEigen::new(examples.tr_mul(&examples));
            let whole = parts.eigenvalues.sum();
            let matter = (0..parts.eigenvalues.len()).filter(|&k| parts.eigenvalues[k] > OF_ALL * whole);
            found.extend(matter.map(|k| &examples * parts.eigenvectors.column(k)));
        }
        found
    }

    /// The springs of a model, each with its compliance.
    pub fn springs(&self, fit: &Fit) -> Vec<(Spring, f64)> {
        let held = self.prepared.own.iter().enumerate().filter(|(column, _)| !fit.columns.contains(column));
        let held = held.filter_map(|(_, number)| match number.column {
            Column::Spring(spring) => Some((spring, number.value)),
            Column::Knee { .. } | Column::Gap { .. } | Column::Play { .. } => None,
        });
        let fitted = fit.columns.iter().zip(fit.coefficients.iter());
        let fitted = fitted.filter_map(|(&column, &value)| Some((self.spring(column)?, value)));
        held.chain(fitted).collect()
    }
}

/// A direction with less than this share of all that may be besides is none.
const OF_ALL: f64 = 0.02;

/// Of a campaign with more rows than this, only so many regressions with the
/// whole catalogue are kept.
const MANY_ROWS: usize = 4000;
const KEPT: usize = 4;
