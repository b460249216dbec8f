//! A campaign's forward model fitted with any effects: nonlinear numbers in
//! their own form, by Gauss-Newton steps with all numbers together, and the
//! whole catalogue linearised at what comes out.

mod noise;
mod polish;
mod solve;

use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::rc::Rc;
use std::string::String;
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, SymmetricEigen};

pub use self::noise::Known;
use self::solve::State;
use super::Options;
use super::catalogue::{Candidate, Catalogue, LIKELY, Number, Scene, Variant, catalogue};
use super::isolated;
use super::model::{Fitted, Named, Setting, Stored};
use super::point::Point;
use super::selection::Tests;
use super::slip::{Moment, likeliest_slip};
use crate::campaign::Campaign;
use crate::elements::Parameter;
use crate::identify::normal::{Fit, Sign};
use crate::identify::prepare::Prepared;
use crate::identify::problem::{Problem, Weights};
use crate::identify::samples::{Column, Samples};

/// Everything that is needed to fit a campaign with effects of the catalogue.
pub struct Bench<'c> {
    campaign: &'c Campaign,
    prepared: &'c Prepared<'c>,
    own: Rc<[Column]>,
    candidates: Rc<[Candidate]>,
    numbers: Rc<[Number]>,
    signs: Rc<[Sign]>,
    /// Full names of what these data cannot show at all.
    pub invisible: Vec<String>,
    /// Rows that are left out, for they are wild.
    pub left_out: Vec<bool>,
    /// How noisy the readings are, as far as is known.
    pub noise: Rc<Known>,
    /// Whether rows need only stand out from noise, not from structure.
    pub strict: bool,
    /// Where a slip that all later rows keep may have begun.
    moments: Vec<Moment>,
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

/// Moments at which a slip is looked for besides the likeliest, so that the
/// tests know of the search.
const MOMENTS: usize = 8;

impl<'c> Bench<'c> {
    /// The bench of a prepared campaign.
    ///
    /// # Errors
    /// Why not even the description's own model can be fitted.
    pub fn new(campaign: &'c Campaign, prepared: &'c Prepared<'c>) -> Result<Self, String> {
        let rows = prepared.samples.rows.len();
        let mut bench = Self::bare(campaign, prepared);
        let evenly = |count: usize, before: bool| {
            (1..=count).map(move |k| Moment { row: (k * rows / (count + 1)).clamp(1, rows), before })
        };
        // What the likeliest will be take the first places.
        bench.moments = evenly(LIKELY, false).chain(evenly(MOMENTS, false)).chain(evenly(MOMENTS, true)).collect();
        bench.set_up()?;
        Ok(bench)
    }

    /// The bench of a prepared campaign with nothing in its catalogue: it fits
    /// the description's own model.
    pub fn bare(campaign: &'c Campaign, prepared: &'c Prepared<'c>) -> Self {
        Self {
            campaign,
            prepared,
            own: prepared.own.iter().map(|number| number.column).collect(),
            candidates: Rc::new([]),
            numbers: Rc::new([]),
            signs: prepared.signs().into(),
            invisible: Vec::new(),
            left_out: vec![false; prepared.samples.rows.len()],
            noise: Rc::new(Known::of(prepared)),
            strict: false,
            moments: Vec::new(),
            settings: RefCell::default(),
            stored: Rc::default(),
            states: RefCell::default(),
            tests: RefCell::default(),
            readings: OnceCell::new(),
        }
    }

    /// The campaign that candidates are looked for in.
    pub fn scene(&self) -> Scene<'_> {
        Scene {
            description: &self.campaign.robot,
            data: self.prepared.data,
            samples: &self.prepared.samples,
            compliance: self.prepared.values[..self.prepared.samples.joints()].to_vec(),
            moments: &self.moments,
        }
    }

    /// Forms the catalogue, without what the data cannot show.
    fn set_up(&mut self) -> Result<(), String> {
        self.forget();
        let Catalogue { candidates, numbers, invisible } = catalogue(&self.scene(), self.own.len());
        let signs = self.prepared.signs().into_iter().chain(numbers.iter().map(Number::sign));
        self.signs = signs.collect();
        self.numbers = numbers.into();
        self.candidates = candidates.into();
        self.invisible = invisible;

        let setting = self.at(&[])?;
        let base = setting.fit(&[])?;
        let noise = (base.fit.rss / setting.problem.freedom(&base.fit)).sqrt();
        let gram = &setting.problem.total.gram;
        let largest = setting.base.iter().map(|&j| gram[(j, j)].sqrt()).fold(0.0, f64::max);
        let visible = |&column: &usize| {
            let (number, size) = (&self.numbers[column - self.own.len()], gram[(column, column)].sqrt());
            match number.range[1].is_finite() {
                // Even the most of it moves all readings together by less than
                // the noise of one.
                true => size * number.range[1] > noise,
                false => size > ZERO * largest,
            }
        };
        let (mut kept, mut lost) = (Vec::new(), Vec::new());
        for candidate in self.candidates.iter() {
            let is_seen = |variant: &&Variant| variant.columns.iter().all(visible);
            let variants: Vec<Variant> = candidate.variants.iter().filter(is_seen).cloned().collect();
            match variants.is_empty() {
                true => lost.push(candidate.name()),
                false => kept.push(Candidate { variants, ..candidate.clone() }),
            }
        }
        self.candidates = kept.into();
        self.invisible.extend(lost);
        self.settings.get_mut().clear();
        self.tests.get_mut().clear();
        Ok(())
    }

    /// Looks again, with a model, for rows that are wild and for the moment at
    /// which a slip may have begun; whether anything changed.
    ///
    /// # Errors
    /// Why the description's own model cannot be fitted without such rows.
    pub fn look_again(&mut self, named: &[Named]) -> Result<bool, String> {
        let mut changed = false;
        for _ in 0..ROUNDS {
            let setting = self.at(named)?;
            let fitted = setting.fit(named)?;
            let wild = isolated::events(&setting, &fitted, self.strict);
            let mut left_out = vec![false; self.left_out.len()];
            wild.iter().flat_map(|event| &event.rows).for_each(|&row| left_out[row] = true);
            let moments = self.likely_slips(named);
            let moves = moments.iter().any(|moment| !self.moments[..LIKELY].contains(moment));
            if left_out == self.left_out && !moves {
                break;
            }
            drop(setting);
            changed = true;
            self.left_out = left_out;
            self.moments[..moments.len()].copy_from_slice(&moments);
            // Which forms of which candidates are seen stays as it was.
            let (kept, invisible) = (Rc::clone(&self.candidates), self.invisible.clone());
            self.set_up()?;
            self.invisible = invisible;
            let moved = |candidate: &Candidate| {
                let same = self.candidates.iter().find(|other| other.name() == candidate.name());
                let is_slip = candidate.kind == &super::catalogue::BASE_SLIP;
                same.filter(|_| is_slip).unwrap_or(candidate).clone()
            };
            self.candidates = kept.iter().map(moved).collect();
            self.numbers = self.refined_numbers(0..self.candidates.len());
            self.forget();
        }
        Ok(changed)
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

    /// Where slips that all later rows keep may have begun: what a model says,
    /// and what it says without one of its effects, which may be in place of a
    /// slip or be one.
    fn likely_slips(&self, named: &[Named]) -> Vec<Moment> {
        let slips = |one: &Named| self.candidates[one.candidate].kind == &super::catalogue::BASE_SLIP;
        let mut models: Vec<Vec<Named>> = Vec::new();
        if !named.iter().any(slips) {
            models.push(named.to_vec());
        }
        for k in 0..named.len() {
            let mut rest = named.to_vec();
            rest.remove(k);
            if !rest.iter().any(slips) {
                models.push(rest);
            }
        }
        let mut moments: Vec<Moment> = Vec::new();
        for named in models {
            let Ok(setting) = self.at(&named) else { continue };
            let Ok(fitted) = setting.fit(&named) else { continue };
            moments.extend(likeliest_slip(&setting, &fitted).filter(|moment| !moments.contains(moment)));
        }
        moments.truncate(LIKELY);
        moments
    }

    /// The candidates.
    pub fn candidates(&self) -> &[Candidate] {
        &self.candidates
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

    /// The regression at a model's solution, with the whole catalogue.
    fn setting(&self, named: &[Named]) -> Result<Setting<'c>, String> {
        let State { setup, fit, tangents, readings, base } = &*self.state(named)?;
        let nonlinear = self.nonlinear(named);
        let declared: &Samples = &self.prepared.samples;
        let point = self.point(setup.clone());
        let elastic = self.prediction(&point, fit, &nonlinear);
        let point = point.with_model(declared, elastic, &self.linear_parameters(fit));
        let count = self.own.len() + self.numbers.len();
        self.spare_memory();
        let mut raw = DMatrix::zeros(readings.len(), count);
        for column in 0..count {
            let tangent = tangents.iter().find(|(of, _)| *of == column);
            match tangent {
                Some((_, tangent)) => raw.set_column(column, tangent),
                None => raw.set_column(column, &self.linear(&point, column)),
            }
        }
        let besides = self.besides(named, &point, fit);
        let mut raw = raw.resize_horizontally(count + besides.len(), 0.0);
        besides.iter().enumerate().for_each(|(k, column)| raw.set_column(count + k, column));
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
            joint_values: self.prepared.values[..declared.joints()].to_vec(),
            tangents: tangents.clone(),
            correction: self.prepared.correction.clone(),
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

    /// The numbers of a model in which its compliance is linear.
    pub fn linear_parameters(&self, fit: &Fit) -> Vec<(Parameter, f64)> {
        let held = self.prepared.own.iter().enumerate().filter(|(column, _)| !fit.columns.contains(column));
        let held = held.filter_map(|(_, number)| match number.column {
            Column::Linear(parameter) => Some((parameter, number.value)),
            Column::Knee { .. } => None,
        });
        let fitted = fit.columns.iter().zip(fit.coefficients.iter());
        let fitted = fitted.filter_map(|(&column, &value)| Some((self.parameter(column)?, value)));
        held.chain(fitted).collect()
    }
}

/// A direction with less than this share of all that may be besides is none.
const OF_ALL: f64 = 0.02;

/// A column this small against the largest of a joint is zero but for rounding.
const ZERO: f64 = 1e-7;

/// Leaving rows out changes what the others look like; it settles at once or
/// was no matter of single rows.
const ROUNDS: usize = 4;

/// Of a campaign with more rows than this, only so many regressions with the
/// whole catalogue are kept.
const MANY_ROWS: usize = 4000;
const KEPT: usize = 4;
