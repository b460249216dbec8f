//! What a campaign's rows read of a world, and how that changes with its parameters.
//!
//! Displacements, absolute positions and clamped axes are three observations of one world. Each
//! says what its readings would be for any values of the parameters, and what a unit of one of
//! them adds at these values: exactly for springs, laws, joints that stand aside and what adds to
//! a reading, by central differences for numbers of the arm and the rig.

pub mod clamped;
mod clock;
pub mod displacement;
pub mod elastic;
pub mod encoders;
pub mod equilibrium;
pub mod position;
pub mod registration;

use nalgebra::{DMatrix, DVector, Vector3};
use robstiff_robots::Description;

use crate::model::{At, Parameter, Term, World, described};

/// What was read, stacked row by row.
#[derive(Clone, Debug)]
pub struct Readings {
    /// The numbers, [`width`](Self::width) a row (m, rad).
    pub values: DVector<f64>,
    /// How many numbers a row has.
    pub width: usize,
    /// How many of these, the first ones, the error is reported of: three of a displacement or
    /// position, one of a clamped axis.
    pub reported: usize,
    /// The noise that each number of a row shares: 0 for what is reported, 1 for rotations, 2 and so on
    /// for encoders, one each.
    pub channels: Vec<usize>,
    /// The block of each row, from 0: its pose, or its part of a clamped axis's loads. Rows of a block
    /// share what is wrong with it, and are left out together.
    pub block: Vec<usize>,
    /// How many blocks there are.
    pub blocks: usize,
    /// What each block is of: folds leave out alike of each. All are of one, but for clamped axes,
    /// whose blocks are parts of an axis.
    pub stratum: Vec<usize>,
    /// The visit of each row.
    pub visit: Vec<usize>,
    /// The force on each row over the root mean square of all, in the base frame; zero where
    /// nothing loads the arm.
    pub force: Vec<Vector3<f64>>,
    /// The lines of the file that the rows stand on.
    pub lines: Vec<usize>,
    /// Whether a reading is the difference of a loaded and an unloaded one that the rows of a visit
    /// share.
    pub differences: bool,
}

impl Readings {
    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.lines.len()
    }

    /// The part of a stacked vector that is reported of a row, its length squared.
    pub fn square(&self, stacked: &DVector<f64>, row: usize) -> f64 {
        stacked.rows(row * self.width, self.reported).norm_squared()
    }

    /// The root mean square of one axis over some rows of a stacked vector; zero of none.
    pub fn rms(&self, stacked: &DVector<f64>, rows: impl IntoIterator<Item = usize>) -> f64 {
        let (sum, count) =
            rows.into_iter().fold((0.0, 0_usize), |(sum, count), row| (sum + self.square(stacked, row), count + 1));
        (sum / (count.max(1) * self.reported) as f64).sqrt()
    }
}

/// What a campaign reads of a world.
pub trait Observation {
    /// The readings.
    fn readings(&self) -> &Readings;

    /// The world as declared.
    fn world(&self) -> &World;

    /// What a world reads whose parameters have these values, stacked like the readings.
    fn predict(&self, world: &World, parameters: &[Parameter], values: &[f64]) -> DVector<f64>;

    /// What a unit of some parameters adds to the readings at these values, a column each.
    fn columns(&self, world: &World, parameters: &[Parameter], values: &[f64], of: &[usize]) -> DMatrix<f64>;

    /// Hands over where and when each row was read.
    fn each(&self, of: &mut dyn FnMut(&At<'_>));
}

/// What is read in a world on the arm of a description, as it is declared: the same that the observation
/// was made of.
pub fn as_declared(observation: &dyn Observation, world: &World, robot: &Description) -> DVector<f64> {
    let (parameters, values) = described::as_declared(robot);
    observation.predict(world, &parameters, &values)
}

/// The world with what its parameters change in it.
fn changed(world: &World, parameters: &[Parameter], values: &[f64]) -> World {
    let mut changed = world.clone();
    for (parameter, &value) in parameters.iter().zip(values).filter(|(_, value)| **value != 0.0) {
        match &parameter.term {
            Term::World(change) => change(&mut changed, value),
            Term::Table(joint, number) => changed.arm.rows[joint - 1].numbers[*number] += value,
            _ => {}
        }
    }
    changed
}

/// The step of central differences for a number in its unit: small against what it is likely to
/// be, large against rounding.
fn step_of(parameter: &Parameter) -> f64 {
    match parameter.unit {
        "N" => 0.1,
        "m" | "rad" => 1e-5,
        _ => 1e-4,
    }
}
