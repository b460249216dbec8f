//! A model at its solution: nonlinear numbers in their own form, by Gauss-Newton
//! steps with all numbers together.

use std::rc::Rc;
use std::string::String;
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::Bench;
use crate::identify::baseline::Visibility;
use crate::identify::column::Column;
use crate::identify::normal::{Fit, Sign};
use crate::identify::problem::Problem;
use crate::identify::setup::Setup;
use crate::trace::catalogue::Number;
use crate::trace::model::Named;
use crate::trace::point::Point;
use robstiff::elements::Spring;

/// A model at its solution.
pub struct State {
    /// What the nonlinear numbers make of the arm and the readings.
    pub setup: Setup,
    /// The coefficients.
    pub fit: Fit,
    /// What a unit of each nonlinear number does there, by its column.
    pub tangents: Vec<(usize, DVector<f64>)>,
    /// The readings that the coefficients are those of.
    pub readings: Rc<DVector<f64>>,
    /// The columns of the description's numbers that are fitted.
    pub base: Vec<usize>,
}

/// Gauss-Newton steps before a model counts as one that has no solution; two
/// to four do for what is physically possible.
const PASSES: usize = 24;

/// After so many, numbers may swing about their solution, as a lever does with a joint that
/// nothing but it turns: they then go half of each step.
const WHOLE: usize = 8;

/// A step that moves the predictions by less than this share of the noise of a
/// reading, all together, is none.
const SETTLED: f64 = 1e-2;

/// A joint that stands this many times the noise of a reading out, over all
/// readings and at its declared compliance, is turned.
const STANDS_OUT: f64 = 5.0;

/// Steps of central differences, as shares of what is physically possible.
const STEP: f64 = 1e-3;

impl<'c> Bench<'c> {
    /// The solution of a model by Gauss-Newton steps from file and description
    /// as declared.
    pub(super) fn solve(&self, named: &[Named]) -> Result<State, String> {
        let hidden = (0..self.own.len()).any(|column| self.is_hidden(column));
        let more = if hidden && self.is_nonlinear(named) { self.solve_with(named, true).ok() } else { None };
        more.map_or_else(|| self.solve_with(named, false), Ok)
    }

    /// The description's numbers that are fitted at a point. A joint that no load
    /// turned as the file and the description have it may well be turned as they
    /// are: by a force that acts beside its axis, say. Held at what was declared,
    /// it would spoil the rest.
    fn base_at(&self, point: &Point<'c>) -> Vec<usize> {
        let prepared = self.prepared;
        let Some(noise) = self.noise.covariance.reading() else { return self.base.to_vec() };
        let size = self.size_at(point);
        let is_turned = |column: usize| size(column) * prepared.own[column].value.abs() > STANDS_OUT * noise;
        let seen = |column: &usize| self.base.contains(column) || (self.is_hidden(*column) && is_turned(*column));
        (0..prepared.own.len()).filter(seen).collect()
    }

    /// Whether a number of the description is held because the data do not show it.
    fn is_hidden(&self, column: usize) -> bool {
        self.prepared.visibility[column] == Visibility::Unseen && !self.base.contains(&column)
    }

    /// The same with or without numbers of the description that are seen at the
    /// solution only.
    fn solve_with(&self, named: &[Named], more: bool) -> Result<State, String> {
        let nonlinear = self.nonlinear(named);
        let mut theta = vec![0.0; nonlinear.len()];
        let mut known: Option<Fit> = None;
        for pass in 0..PASSES {
            let share = if pass < WHOLE { 1.0 } else { 0.5 };
            let setup = self.setup(&nonlinear, &theta);
            let point = self.point(setup.clone());
            let base = if more { self.base_at(&point) } else { self.base.to_vec() };
            let effects = named.iter().flat_map(|one| &self.candidates[one.candidate].variants[one.variant].columns);
            let columns: Vec<usize> = base.iter().chain(effects).copied().collect();
            let place = |of: usize| columns.iter().position(|column| *column == of).expect("one of the model's");
            // As declared, and with the numbers fitted that the data can see there.
            let mut readings = match nonlinear.is_empty() {
                true => Rc::clone(self.readings.get_or_init(|| Rc::new(self.readings(&point, &base)))),
                false => Rc::new(self.readings(&point, &base)),
            };
            let is_linear = |column: &usize| nonlinear.iter().all(|(of, _)| of != column);
            let linear: Vec<usize> = columns.iter().copied().filter(is_linear).collect();
            let mut raw = DMatrix::zeros(readings.len(), columns.len());
            for &column in &linear {
                raw.set_column(place(column), &self.linear(&point, column));
            }
            let mut tangents = Vec::new();
            if !nonlinear.is_empty() {
                // They need coefficients, first those without them.
                let fit = match &known {
                    Some(fit) => fit,
                    None => {
                        let places: Vec<usize> = linear.iter().map(|&column| place(column)).collect();
                        let problem = self.regression(&point, raw.select_columns(&places), readings.clone());
                        &self.solved(&problem, &linear)?
                    }
                };
                tangents = self.tangents(&nonlinear, &theta, fit);
            }
            for ((column, tangent), &value) in tangents.iter().zip(&theta) {
                // A coefficient is the whole number, not a step from here.
                Rc::make_mut(&mut readings).axpy(value, tangent, 1.0);
                raw.set_column(place(*column), tangent);
            }
            let problem = self.regression(&point, raw, readings.clone());
            let fit = self.solved(&problem, &columns)?;
            let mut moves = DVector::zeros(problem.white_readings.len());
            let step = |((column, number), theta): (&(usize, &Number), &mut f64)| {
                let (at, most) = (place(*column), number.range[1]);
                // Not beyond what is possible on the way.
                let next = fit.coefficients[at].clamp(-most, most);
                moves.axpy(next - *theta, &problem.white.column(at), 1.0);
                *theta += share * (next - *theta);
            };
            nonlinear.iter().zip(&mut theta).for_each(step);
            let noise = problem.variance(&fit);
            if moves.norm_squared() <= SETTLED * SETTLED * noise {
                return Ok(State { setup, fit, tangents, readings, base });
            }
            known = Some(known.map_or_else(|| fit.clone(), |last| part_of_the_way(&last, &fit, share)));
        }
        Err(String::from("its numbers do not settle"))
    }

    /// The fit of a regression whose columns are these, in their order.
    fn solved(&self, problem: &Problem, columns: &[usize]) -> Result<Fit, String> {
        let signs: Vec<Sign> = columns.iter().map(|&column| self.signs[column]).collect();
        let all: Vec<usize> = (0..columns.len()).collect();
        let fit = problem.total.solve_signed(&all, &signs);
        let fit = fit.ok_or_else(|| String::from("not to be told from the rest of the model"))?;
        Ok(Fit { columns: columns.to_vec(), ..fit })
    }

    /// What a unit of each nonlinear number does where they have these values, with the
    /// coefficients of a fit; by its column.
    fn tangents(&self, nonlinear: &[(usize, &Number)], theta: &[f64], fit: &Fit) -> Vec<(usize, DVector<f64>)> {
        let tangent = |(k, &(column, number)): (usize, &(usize, &Number))| {
            let step = STEP * number.range[1];
            let [there, back] = [step, -step].map(|step| {
                let mut moved = theta.to_vec();
                moved[k] += step;
                self.prediction(&self.point(self.setup(nonlinear, &moved)), fit, nonlinear)
            });
            (column, (there - back) / (2.0 * step))
        };
        nonlinear.iter().enumerate().map(tangent).collect()
    }

    pub(super) fn setup(&self, nonlinear: &[(usize, &Number)], theta: &[f64]) -> Setup {
        let mut setup = Setup::as_declared(self.prepared.samples.joints());
        for ((_, number), &value) in nonlinear.iter().zip(theta) {
            if let Some(enters) = &number.enters {
                enters(&mut setup, value);
            }
        }
        setup
    }

    pub(super) fn point(&self, setup: Setup) -> Point<'c> {
        Point::bare(&self.campaign.robot, self.prepared.data, &self.prepared.samples, setup)
    }

    /// A column that is no tangent, at a point.
    pub(super) fn linear(&self, point: &Point<'c>, column: usize) -> DVector<f64> {
        match self.own.get(column) {
            Some(&own) => point.with_creep(point.samples.column(own)),
            None => self.numbers[column - self.own.len()].column(point),
        }
    }

    /// The readings at a point less what numbers do that are held, those of the
    /// description that are not among the columns fitted.
    pub(super) fn readings(&self, point: &Point<'c>, fitted: &[usize]) -> DVector<f64> {
        let all = point.samples.readings();
        let held = &all - self.prepared.readings_beside(&point.samples, fitted);
        all - point.with_creep(held)
    }

    /// What the arm does at a point, with the coefficients of a fit, numbers
    /// that are held included.
    pub(super) fn prediction(&self, point: &Point<'c>, fit: &Fit, nonlinear: &[(usize, &Number)]) -> DVector<f64> {
        let mut sum = point.samples.readings() - self.readings(point, &fit.columns);
        // Springs in one go.
        let mut springs = Vec::new();
        for (&column, &value) in fit.columns.iter().zip(fit.coefficients.iter()) {
            let is_nonlinear = nonlinear.iter().any(|(of, _)| *of == column);
            match self.spring(column) {
                Some(spring) if !is_nonlinear => springs.push((spring, value)),
                None if value != 0.0 && !is_nonlinear && self.is_elastic(column) => {
                    sum.axpy(value, &self.linear(point, column), 1.0);
                }
                _ => {}
            }
        }
        sum + point.with_creep(point.samples.under(&springs))
    }

    /// The spring whose compliance a column is of, where it is one.
    pub(super) fn spring(&self, column: usize) -> Option<Spring> {
        match self.own.get(column) {
            Some(Column::Spring(spring)) => Some(*spring),
            Some(Column::Knee { .. } | Column::Gap { .. } | Column::Play { .. }) => None,
            None => self.numbers[column - self.own.len()].spring,
        }
    }

    pub(super) fn is_elastic(&self, column: usize) -> bool {
        column < self.own.len() || self.numbers[column - self.own.len()].elastic
    }

    pub(super) fn regression(&self, point: &Point<'c>, raw: DMatrix<f64>, readings: Rc<DVector<f64>>) -> Problem {
        Problem::new(&point.samples, raw, readings, &self.prepared.correction, self.weights())
    }
}

/// The coefficients so much of the way from one fit to the next; all of it where they are
/// not of the same columns.
fn part_of_the_way(last: &Fit, next: &Fit, share: f64) -> Fit {
    let mut fit = next.clone();
    if last.columns == next.columns {
        fit.coefficients.axpy(1.0 - share, &(&last.coefficients - &next.coefficients), 1.0);
    }
    fit
}
