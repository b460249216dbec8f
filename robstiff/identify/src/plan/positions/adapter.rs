//! From the regression of absolute positions to what planning asks for; the only place
//! in planning that knows how numbers become positions.
//!
//! What is read next is read with the robot where it stands, in the frame that the
//! tracker has: where that is, the campaign knows only so well, so it stays among the
//! numbers, as what nobody asks for.

use std::boxed::Box;
use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, Vector3};

use super::source::rivals;
use crate::campaign::{Campaign, PositionRow, Positions};
use crate::identify::Error;
use crate::identify::positions::model::{Enters, Model, Moved, State};
use crate::identify::positions::regression::Regression;
use crate::plan::regressors::{PAYLOADS, REACH, ROTATION_NOISE, Regressors, Sensor, Visit};
use crate::plan::rivals::{Group, Rivals};
use crate::trace::Trace;
use crate::trace::positions::bench::Bench;

/// A traced campaign of positions, with the numbers that planning looks at.
pub struct Adapter<'c> {
    campaign: &'c Campaign,
    data: &'c Positions,
    /// The model that the numbers enter, the numbers, and where they are.
    start: Model,
    numbers: Vec<Enters>,
    state: State,
    /// The point that the robot's stand turns about (m).
    middle: Vector3<f64>,
    known: DMatrix<f64>,
    read: usize,
    noise: f64,
    rotation_noise: f64,
}

impl<'c> Adapter<'c> {
    /// For a campaign and its trace, with groups of rivals.
    ///
    /// # Errors
    /// Positions that do not tell where the robot stands, or not the numbers of the
    /// trace.
    pub fn new(
        campaign: &'c Campaign,
        data: &'c Positions,
        trace: &Trace,
        groups: &[Group],
    ) -> Result<(Self, Rivals), Error> {
        let mut bench = Bench::new(campaign, data)?;
        let (rivals, kept, state) = rivals(&mut bench, trace, groups)?;
        let (problem, middle) = bench.regression.at(&state, &kept, &bench.rows);
        let of = |&number: &usize| (bench.regression.numbers[number].clone(), state.values[number]);
        let (numbers, values) = kept.iter().map(of).unzip();
        let adapter = Self {
            campaign,
            data,
            start: bench.regression.start.clone(),
            numbers,
            state: State { registration: state.registration, values },
            middle,
            known: problem.total.gram.clone(),
            read: problem.total.rows,
            noise: trace.noise,
            rotation_noise: campaign.noise.rotation.unwrap_or(ROTATION_NOISE),
        };
        Ok((adapter, rivals))
    }

    /// The rows of some visits; nothing is read yet.
    fn rows(&self, visits: &[Visit]) -> Positions {
        let mut rows = Vec::new();
        for (index, visit) in visits.iter().enumerate() {
            rows.extend(visit.payloads().into_iter().map(|payload| PositionRow {
                line: 0,
                pose: index,
                visit: index,
                time: None,
                temperature: None,
                q: visit.q.clone(),
                position: [0.0; 3],
                payload,
            }));
        }
        let names = || std::vec![String::new(); visits.len()];
        Positions { poses: names(), visits: names(), rows, ..self.data.clone() }
    }

    /// Where a reflector, so far from the one that is read (m, tool frame), is at some
    /// visits' rows, and what a unit of each number does to it, stacked.
    fn columns(&self, visits: &[Visit], aside: Vector3<f64>) -> (Vec<Vector3<f64>>, DMatrix<f64>) {
        let data = self.rows(visits);
        let seen = Model::new(&self.campaign.robot, &data).seen(&data);
        let later = |number: &Enters| match number {
            Enters::Model(..) => number.clone(),
            // The campaign is over: a drift is where it was, a slip has happened.
            Enters::Reading(moved) => Enters::Reading(Rc::new(Moved {
                rows: seen.iter().map(|seen| (moved.later)(seen)).collect(),
                later: Box::new(|_| Vector3::zeros()),
            })),
        };
        let mut start = self.start.clone();
        start.marker += aside;
        let numbers = self.numbers.iter().map(later).collect();
        let regression = Regression { data: &data, start, numbers, signs: Vec::new() };
        let all: Vec<usize> = (0..self.numbers.len()).collect();
        (regression.placed(&self.state), regression.columns(&self.state, &all, &self.middle))
    }

    /// What a reflector so far aside shows.
    fn at_a_reflector(&self, visits: &[Visit], aside: Vector3<f64>) -> Vec<DMatrix<f64>> {
        grams(&self.columns(visits, aside).1, visits)
    }

    /// What the rotation of the tool shows: that of three points of it about the one
    /// that is read.
    fn at_the_turned_tool(&self, visits: &[Visit]) -> Vec<DMatrix<f64>> {
        let (middle, columns) = self.columns(visits, Vector3::zeros());
        let mut turns = DMatrix::zeros(columns.nrows(), columns.ncols());
        for axis in 0..3 {
            let (points, moved) = self.columns(visits, Vector3::ith(axis, 1.0));
            for (row, (point, middle)) in points.iter().zip(&middle).enumerate() {
                let arm = point - middle;
                for k in 0..columns.ncols() {
                    let of = |columns: &DMatrix<f64>| columns.fixed_view::<3, 1>(3 * row, k).into_owned();
                    // Of a turn w the arms a, at right angles, have sum a x (w x a) = 2 w.
                    let turn = arm.cross(&(of(&moved) - of(&columns))) * (0.5 * self.noise / self.rotation_noise);
                    let mut sum = turns.fixed_view_mut::<3, 1>(3 * row, k);
                    sum += turn;
                }
            }
        }
        grams(&turns, visits)
    }
}

impl Regressors for Adapter<'_> {
    fn variance(&self) -> f64 {
        self.noise * self.noise
    }

    fn readings(&self, visits: &[Visit]) -> usize {
        self.read + 3 * visits.iter().map(|visit| visit.loads.len()).sum::<usize>()
    }

    fn sensors(&self) -> Vec<Sensor> {
        let loads = self.data.rows.iter().any(|row| row.payload > 0.0);
        [Sensor::Rotations, Sensor::Reflector].into_iter().chain(loads.then_some(Sensor::Payloads)).collect()
    }

    fn known(&self) -> DMatrix<f64> {
        self.known.clone()
    }

    fn information(&self, visits: &[Visit], besides: Option<Sensor>) -> Vec<DMatrix<f64>> {
        let here = |visits: &[Visit]| self.at_a_reflector(visits, Vector3::zeros());
        let further = match besides {
            Some(Sensor::Rotations) => self.at_the_turned_tool(visits),
            Some(Sensor::Reflector) => self.at_a_reflector(visits, Vector3::x() * REACH),
            Some(Sensor::Payloads) => {
                let payloads = |visit: &Visit| {
                    let greatest = visit.greatest();
                    let loads = PAYLOADS.iter().map(|share| greatest.map(|value| share * value)).collect();
                    Visit { q: visit.q.clone(), loads }
                };
                return here(&visits.iter().map(payloads).collect::<Vec<_>>());
            }
            // The others are sensors of displacements.
            _ => return here(visits),
        };
        here(visits).into_iter().zip(further).map(|(here, further)| here + further).collect()
    }
}

/// The information of each visit from its rows' columns, stacked; readings are
/// independent of each other.
fn grams(columns: &DMatrix<f64>, visits: &[Visit]) -> Vec<DMatrix<f64>> {
    let mut first = 0;
    let mut gram = |visit: &Visit| {
        let rows = columns.rows(first, 3 * visit.loads.len());
        first += rows.nrows();
        rows.tr_mul(&rows)
    };
    visits.iter().map(&mut gram).collect()
}
