//! The regression of absolute positions, at a point.
//!
//! A kinematic model is not linear in its numbers, so it is fitted by the method of
//! Gauss and Newton: at the numbers so far every one has a column, what its unit does
//! to the readings, and the readings are such that coefficients are the numbers
//! themselves. Where the robot stands in the frame that positions are read in is
//! part of every model: its first six columns are a shift of what is read and a
//! turn about its middle.
//!
//! Readings have one variance and no unloaded reading in common, so nothing is
//! whitened. The rows of a pose are a block: what the model lacks they have in
//! common, and how well the robot comes back to where it was.

use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Vector3};

use super::model::{Enters, Model, State};
use crate::campaign::Positions;
use crate::identify::normal::{Fit, Normal, Sign};
use crate::identify::problem::{Block, Equations, Problem};

/// How many numbers say where the robot stands: the first columns.
pub const STANDS: usize = 6;

/// Steps of Gauss and Newton; each takes an error to some square of it, and from
/// degrees to nanometres takes four or five.
const STEPS: usize = 12;

/// A step that moves no point by more is none (m).
const STILL: f64 = 1e-10;

/// The rows that a model is fitted to.
#[derive(Clone, Debug)]
pub struct Rows {
    /// Of each pose, whether it is fitted to; the others are held out.
    pub training: Rc<[bool]>,
    /// Of each row, whether it is left out of everything.
    pub left_out: Vec<bool>,
}

impl Rows {
    /// Whether a row of the positions is fitted to.
    pub fn has(&self, row: usize, data: &Positions) -> bool {
        self.training[data.rows[row].pose] && !self.left_out[row]
    }
}

/// Positions with what may explain them.
#[derive(Clone)]
pub struct Regression<'c> {
    /// The positions.
    pub data: &'c Positions,
    /// The model that numbers enter.
    pub start: Model,
    /// The numbers.
    pub numbers: Vec<Enters>,
    /// The sign of each.
    pub signs: Vec<Sign>,
}

/// A fit of some numbers.
#[derive(Clone)]
pub struct Solved {
    /// The numbers with their values, and where the robot stands.
    pub state: State,
    /// Where the robot stands, then the numbers, and their fit.
    pub problem: Problem,
    /// The same in place.
    pub fit: Fit,
    /// The signs of its columns.
    pub signs: Vec<Sign>,
}

impl Regression<'_> {
    /// Fits some numbers, beginning with a state. `None` where the rows do not tell
    /// them from each other or from where the robot stands, or steps lead out of all numbers.
    pub fn solve(&self, chosen: &[usize], start: &State, rows: &Rows) -> Option<Solved> {
        let mut state = start.clone();
        for (number, value) in state.values.iter_mut().enumerate() {
            if !chosen.contains(&number) {
                *value = 0.0;
            }
        }
        let columns: Vec<usize> = (0..STANDS + chosen.len()).collect();
        let signs = self.signs_of(chosen);
        for _ in 0..STEPS {
            let (problem, middle) = self.at(&state, chosen, rows);
            let fit = problem.total.solve_signed(&columns, &signs)?;
            if !fit.coefficients.iter().all(|value| value.is_finite()) {
                return None;
            }
            let before = DVector::from_fn(columns.len(), |k, _| match k.checked_sub(STANDS) {
                Some(k) => state.values[chosen[k]],
                None => 0.0,
            });
            let moved = (&problem.white * (&fit.coefficients - &before)).amax();
            let three = |from: usize| fit.coefficients.fixed_rows::<3>(from).into_owned();
            state.registration = state.registration.moved(three(0), three(3), &middle);
            for (k, &number) in chosen.iter().enumerate() {
                state.values[number] = fit.coefficients[STANDS + k];
            }
            if moved < STILL {
                return Some(Solved { state, problem, fit, signs });
            }
        }
        // What does not converge is as good as its last step.
        let (problem, _) = self.at(&state, chosen, rows);
        let fit = problem.total.solve_signed(&columns, &signs)?;
        Some(Solved { state, problem, fit, signs })
    }

    /// The signs of where the robot stands and of some numbers.
    pub fn signs_of(&self, chosen: &[usize]) -> Vec<Sign> {
        let numbers = chosen.iter().map(|&number| self.signs[number]);
        core::iter::repeat_n(Sign::Free, STANDS).chain(numbers).collect()
    }

    /// The regression at a state on where the robot stands and some numbers, with the
    /// point that the robot turns about.
    pub fn at(&self, state: &State, chosen: &[usize], rows: &Rows) -> (Problem, Vector3<f64>) {
        let placed = self.placed(state);
        let middle = placed.iter().sum::<Vector3<f64>>() / placed.len().max(1) as f64;
        let columns = self.columns(state, chosen, &middle);
        let mut readings = DVector::zeros(3 * placed.len());
        for (row, placed) in placed.iter().enumerate() {
            let left = Vector3::from(self.data.rows[row].position) - placed;
            readings.fixed_rows_mut::<3>(3 * row).copy_from(&left);
        }
        for (k, &number) in chosen.iter().enumerate() {
            readings.axpy(state.values[number], &columns.column(STANDS + k), 1.0);
        }
        (self.problem(columns, readings, rows), middle)
    }

    /// Where what is read is at a state, in the frame that it is read in (m).
    pub fn placed(&self, state: &State) -> Vec<Vector3<f64>> {
        let points = state.model(&self.start, &self.numbers).points(self.data);
        let moved = points.into_iter().enumerate().map(|(row, point)| point + state.beside(&self.numbers, row));
        moved.map(|point| state.registration.placed(&point)).collect()
    }

    /// What a unit of each does to the readings at a state, stacked: of where the robot
    /// stands, turned about a point, and of some numbers.
    pub fn columns(&self, state: &State, chosen: &[usize], middle: &Vector3<f64>) -> DMatrix<f64> {
        let placed = self.placed(state);
        let mut columns = DMatrix::zeros(3 * placed.len(), STANDS + chosen.len());
        for (row, placed) in placed.iter().enumerate() {
            for k in 0..3 {
                columns[(3 * row + k, k)] = 1.0;
                let turned = Vector3::ith(k, 1.0).cross(&(placed - middle));
                columns.fixed_view_mut::<3, 1>(3 * row, 3 + k).copy_from(&turned);
            }
        }
        let model = state.model(&self.start, &self.numbers);
        for (k, &number) in chosen.iter().enumerate() {
            columns.set_column(STANDS + k, &self.column(&model, state, number));
        }
        columns
    }

    /// The regression of a fit with columns besides, which come behind its own.
    pub fn with_columns(&self, solved: &Solved, more: &DMatrix<f64>, rows: &Rows) -> Problem {
        let own = &solved.problem.white;
        let mut white = own.clone().resize_horizontally(own.ncols() + more.ncols(), 0.0);
        white.columns_mut(own.ncols(), more.ncols()).copy_from(more);
        self.problem(white, (*solved.problem.readings).clone(), rows)
    }

    /// What a unit of a number does to the readings at a state, stacked.
    fn column(&self, model: &Model, state: &State, number: usize) -> DVector<f64> {
        let turn = state.registration.turn;
        let mut column = DVector::zeros(3 * self.data.rows.len());
        let mut set = |row: usize, moved: Vector3<f64>| {
            column.fixed_rows_mut::<3>(3 * row).copy_from(&(turn * moved));
        };
        match &self.numbers[number] {
            Enters::Reading(moved) => moved.rows.iter().enumerate().for_each(|(row, moved)| set(row, *moved)),
            Enters::Model(enters, step) => {
                let moved = |by: f64| {
                    let mut model = model.clone();
                    enters(&mut model, by);
                    model.points(self.data)
                };
                let (more, less) = (moved(*step), moved(-step));
                let slopes = more.iter().zip(&less).map(|(more, less)| (more - less) / (2.0 * step));
                slopes.enumerate().for_each(|(row, slope)| set(row, slope));
            }
        }
        column
    }

    fn problem(&self, white: DMatrix<f64>, readings: DVector<f64>, rows: &Rows) -> Problem {
        let mut by_pose = vec![Vec::new(); self.data.poses.len()];
        for (i, row) in self.data.rows.iter().enumerate().filter(|&(i, _)| !rows.left_out[i]) {
            by_pose[row.pose].push(i);
        }
        let block = |(pose, rows): (usize, Vec<usize>)| {
            let stacked = rows.iter().flat_map(|row| 3 * row..3 * row + 3).collect();
            Block { pose, rows, stacked }
        };
        let blocks = by_pose.into_iter().enumerate().filter(|(_, rows)| !rows.is_empty()).map(block);
        let (blocks, held_out): (Vec<Block>, Vec<Block>) = blocks.partition(|block| rows.training[block.pose]);
        let stacked: Vec<usize> = blocks.iter().flat_map(|block| block.stacked.iter().copied()).collect();
        let total = Normal::of_rows(&white, &readings, &stacked);
        let readings = Rc::new(readings);
        let equations = Equations {
            white_readings: Rc::clone(&readings),
            readings,
            axes: 3,
            shared: 0.0,
            blocks: blocks.into(),
            held_out: held_out.into(),
            total,
        };
        Problem { equations, white }
    }
}
