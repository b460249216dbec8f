//! What visits would show, by the observations and the noise of the campaign that was traced.
//!
//! The visits are made a campaign like the one that was traced: the same frames, points and sensors,
//! at the end of it. What depends on when something is read, or on the loads and places of the
//! campaign as a whole, stays as it was there.

use std::rc::Rc;

use nalgebra::{DMatrix, Vector3};

use super::first::unread;
use super::regressors::{ENCODER_NOISE, LEVELS, PAYLOADS, REACH, ROTATION_NOISE, Regressors, Sensor, Visit};
use super::rivals::{Group, Rivals};
use super::source::Source;
use crate::campaign::{Campaign, Data, Displacements, PositionRow, Positions};
use crate::fit::case::Case;
use crate::identify::Error;
use crate::model::{At, Parameter, Term, World};
use crate::observe::displacement::Displacement;
use crate::observe::position::Position;
use crate::observe::{Observation, Readings};
use crate::regression::gram::of_each_block;
use crate::regression::noise::{DISCREPANCIES, Noise};
use crate::trace::Trace;

/// A traced campaign, with the numbers that planning looks at.
pub struct Shown<'c> {
    campaign: &'c Campaign,
    source: Source,
    world: World,
    noise: Noise,
    /// The discrepancy.
    kappa: f64,
    end: End,
    /// How many numbers the campaign reads.
    read: usize,
    /// Whether every row has an unloaded reading that no other has: it is in the noise of the row.
    is_alone: bool,
    /// The joints (from 1) whose angle is read behind the gear.
    encoders: Vec<usize>,
}

/// What visits read beyond what the campaign does, and where.
#[derive(Clone, Default)]
struct Rigged {
    /// By how much the load acts elsewhere, in the tool frame (m).
    load: Vector3<f64>,
    /// By how much the reading is taken elsewhere, in the tool frame (m).
    reading: Vector3<f64>,
    rotations: bool,
    encoders: bool,
}

impl<'c> Shown<'c> {
    /// For a campaign and its trace, with groups of rivals; and these with their columns.
    ///
    /// # Errors
    /// A trace of another campaign; a campaign that does not show the model's numbers.
    pub fn new(campaign: &'c Campaign, trace: &Trace, groups: &[Group]) -> Result<(Self, Rivals), Error> {
        let case = Case::new(campaign, &campaign.robot);
        let mut engine = case.engine(&campaign.robot);
        let (kappa, best) = match &trace.basis {
            Some(basis) if basis.resume(&mut engine) => (basis.kappa, basis.best.clone()),
            Some(_) => {
                return Err(Error::OtherCampaign("the trace is of another campaign: this one has other rows".into()));
            }
            // Where the campaign cannot tell what is missing, it shows the description's own numbers.
            None => {
                let hidden = || Error::NotShown("these data show none of the robot's numbers".into());
                engine.fit_alone().ok_or_else(hidden)?;
                (0, Vec::new())
            }
        };
        let source = Source::new(&engine, (kappa, &best), trace, groups)?;
        let readings = engine.observation.readings();
        let visits = readings.visit.iter().max().map_or(0, |last| last + 1);
        let mut end = End { rows: readings.rows(), warmer: 0.0, middle: Vector3::zeros(), load: usual(&campaign.data) };
        engine.observation.each(&mut |at| {
            end.warmer = at.warmer;
            end.middle = at.stand.tcp.at - at.place;
        });
        let shown = Self {
            campaign,
            world: engine.point.world.clone(),
            noise: engine.noise.clone(),
            kappa: DISCREPANCIES[kappa],
            end,
            read: case.rows(true).len() * readings.width,
            is_alone: visits == readings.rows(),
            encoders: case.encoders.clone(),
            source,
        };
        let rivals = shown.source.rivals.clone();
        Ok((shown, rivals))
    }

    /// The information of each visit.
    fn at(&self, visits: &[Visit], rigged: &Rigged) -> Vec<DMatrix<f64>> {
        let (readings, noise, columns) = self.columns(visits, rigged);
        of_each_block(&readings, &noise, &columns, self.kappa)
    }

    /// What a unit of each number does to what visits read, with the readings and their noise.
    fn columns(&self, visits: &[Visit], rigged: &Rigged) -> (Readings, Noise, DMatrix<f64>) {
        let mut world = self.world.clone();
        world.rig.wrench_at += rigged.load;
        world.rig.measured_at += rigged.reading;
        let robot = &self.campaign.robot;
        let data = self.data(visits, rigged);
        let end = End { load: usual(&data) / self.end.load, ..self.end };
        match &data {
            Data::Displacement(data) => self.read_by(&Displacement::new(robot, data), &world, &end, rigged),
            Data::Position(data) => self.read_by(&Position::new(robot, data), &world, &end, rigged),
            Data::Clamped(_) => unreachable!("no visits follow a campaign of clamped axes"),
        }
    }

    fn read_by(
        &self,
        observation: &dyn Observation,
        world: &World,
        end: &End,
        rigged: &Rigged,
    ) -> (Readings, Noise, DMatrix<f64>) {
        let Source { values, kept, .. } = &self.source;
        let parameters: Vec<Parameter> = self.source.parameters.iter().map(|parameter| end.of(parameter)).collect();
        let mut readings = observation.readings().clone();
        readings.force.iter_mut().for_each(|force| *force *= end.load);
        if self.noise.growth > 0.0 {
            readings.values = observation.predict(world, &parameters, values);
        }
        let columns = observation.columns(world, &parameters, values, kept);
        let noise = self.noise_of(&readings, rigged);
        (readings, noise, columns)
    }

    /// The noise of visits: that of the campaign, without any outliers.
    fn noise_of(&self, readings: &Readings, rigged: &Rigged) -> Noise {
        let mut noise = Noise::plain(readings, 1.0);
        noise.growth = self.noise.growth;
        noise.level = self.noise.level;
        let size = self.source.variance.sqrt();
        let visits = readings.visit.iter().max().map_or(0, |last| last + 1);
        // Of one row, the noise of the campaign is that of both its readings.
        let both = if self.is_alone && readings.differences { core::f64::consts::SQRT_2 } else { 1.0 };
        if both > 1.0 && visits < readings.rows() {
            noise.weights.fill(2.0);
            noise.shared = 0.5;
        } else {
            noise.shared = self.noise.shared;
        }
        for (channel, scale) in noise.scales.iter_mut().enumerate().skip(1) {
            let joint = channel.checked_sub(2).map(|k| self.joints_read(rigged)[k]);
            let known = match joint {
                None => self.reads_rotations().then(|| self.noise.scales[1]),
                Some(joint) => self.encoders.iter().position(|of| *of == joint).map(|k| self.noise.scales[2 + k]),
            };
            let likely = if joint.is_some() { ENCODER_NOISE } else { self.rotation_noise() };
            *scale = known.unwrap_or(size / (likely * both));
        }
        noise
    }

    /// One sigma of a rotation reading (rad).
    fn rotation_noise(&self) -> f64 {
        self.campaign.noise.rotation.unwrap_or(ROTATION_NOISE)
    }

    fn reads_rotations(&self) -> bool {
        matches!(&self.campaign.data, Data::Displacement(data) if data.rows.iter().all(|row| row.rotation.is_some()))
    }

    /// The joints (from 1) whose angle visits read behind the gear.
    fn joints_read(&self, rigged: &Rigged) -> Vec<usize> {
        if rigged.encoders { (1..=self.campaign.robot.joints.len()).collect() } else { self.encoders.clone() }
    }

    /// A campaign of visits, each a pose of its own, of which nothing was read.
    fn data(&self, visits: &[Visit], rigged: &Rigged) -> Data {
        match &self.campaign.data {
            Data::Displacement(data) => {
                let made = self.displacements(data, visits, rigged);
                Data::Displacement(made)
            }
            Data::Position(data) => Data::Position(positions(data, visits, rigged)),
            Data::Clamped(rows) => Data::Clamped(rows.clone()),
        }
    }

    fn displacements(&self, data: &Displacements, visits: &[Visit], rigged: &Rigged) -> Displacements {
        let robot = &self.campaign.robot;
        let filed = |visit: &Visit| Visit { q: visit.q.clone(), loads: visit.loads_in(data.wrench_frame, robot) };
        let filed: Vec<Visit> = visits.iter().map(filed).collect();
        let mut made = unread(&filed);
        made.wrench_frame = data.wrench_frame;
        made.measured_frame = data.measured_frame;
        made.wrench_at = (Vector3::from(data.wrench_at) + rigged.load).into();
        made.measured_at = (Vector3::from(data.measured_at) + rigged.reading).into();
        let turns = rigged.rotations || self.reads_rotations();
        let encoders = self.joints_read(rigged);
        for row in &mut made.rows {
            row.rotation = turns.then_some([0.0; 3]);
            // An encoder that differs from its motor is read.
            let turned = |(k, q): (usize, &f64)| q + if encoders.contains(&(k + 1)) { 1.0 } else { 0.0 };
            row.encoders = (!encoders.is_empty()).then(|| row.q.iter().enumerate().map(turned).collect());
        }
        made
    }

    /// How the tool turns, read beside its position.
    fn turned(&self, visits: &[Visit]) -> Vec<DMatrix<f64>> {
        let (readings, noise, middle) = self.columns(visits, &Rigged::default());
        // Of a turn w the moves w x a of three arms a, at right angles and of one metre, have the squares
        // 2 w^2 together.
        let weight = (0.5 * self.source.variance).sqrt() / self.rotation_noise();
        let along = |axis: usize| {
            let reading = Vector3::ith(axis, 1.0);
            let (.., moved) = self.columns(visits, &Rigged { reading, ..Rigged::default() });
            of_each_block(&readings, &noise, &((moved - &middle) * weight), 0.0)
        };
        (0..3).map(along).reduce(added).unwrap_or_default()
    }
}

/// Where the campaign ended, for visits that follow.
#[derive(Clone, Copy)]
struct End {
    /// How many rows there were.
    rows: usize,
    /// By how much it was warmer then than on average (K).
    warmer: f64,
    /// The middle of all tool centre points (m).
    middle: Vector3<f64>,
    /// The usual load, of visits over that of the campaign.
    load: f64,
}

impl End {
    /// A row of visits as one of the campaign.
    fn at<'a>(&self, at: &At<'a>) -> At<'a> {
        At {
            row: self.rows,
            time: 1.0,
            warmer: self.warmer,
            load: at.load * self.load,
            place: at.stand.tcp.at - self.middle,
            ..*at
        }
    }

    /// A parameter of the campaign for rows of visits.
    fn of(self, parameter: &Parameter) -> Parameter {
        let term = match parameter.term.clone() {
            Term::Aside(joint, axis, of) => Term::Aside(joint, axis, Rc::new(move |at| of(&self.at(at)))),
            Term::Reading(of) => Term::Reading(Rc::new(move |at| of(&self.at(at)))),
            Term::Gain(of) => Term::Gain(Rc::new(move |at| of(&self.at(at)))),
            other => other,
        };
        Parameter { term, ..parameter.clone() }
    }
}

/// The load that rows are measured by: the root mean square of all forces (N), or the greatest payload
/// (kg); one where nothing loads the arm.
fn usual(data: &Data) -> f64 {
    let usual = match data {
        Data::Displacement(data) => {
            let sum: f64 = data.rows.iter().map(|row| row.wrench[..3].iter().map(|f| f * f).sum::<f64>()).sum();
            (sum / data.rows.len().max(1) as f64).sqrt()
        }
        Data::Position(data) => data.rows.iter().map(|row| row.payload).fold(0.0, f64::max),
        Data::Clamped(_) => 0.0,
    };
    if usual > 0.0 { usual } else { 1.0 }
}

fn positions(data: &Positions, visits: &[Visit], rigged: &Rigged) -> Positions {
    let names: Vec<String> = (1..=visits.len()).map(|visit| visit.to_string()).collect();
    let mut rows = Vec::new();
    for (index, visit) in visits.iter().enumerate() {
        for payload in visit.payloads() {
            rows.push(PositionRow {
                line: rows.len() + 2,
                pose: index,
                visit: index,
                time: None,
                temperature: None,
                q: visit.q.clone(),
                position: [0.0; 3],
                payload,
            });
        }
    }
    Positions {
        payload_at: data.payload_at,
        measured_at: (Vector3::from(data.measured_at) + rigged.reading).into(),
        poses: names.clone(),
        visits: names,
        rows,
    }
}

/// The visits with other loads, as shares of their greatest.
fn with_shares(visits: &[Visit], shares: &[f64]) -> Vec<Visit> {
    let with = |visit: &Visit| {
        let greatest = visit.greatest();
        let loads = shares.iter().map(|share| greatest.map(|value| share * value)).collect();
        Visit { q: visit.q.clone(), loads }
    };
    visits.iter().map(with).collect()
}

fn added(one: Vec<DMatrix<f64>>, other: Vec<DMatrix<f64>>) -> Vec<DMatrix<f64>> {
    one.into_iter().zip(other).map(|(one, other)| one + other).collect()
}

impl Regressors for Shown<'_> {
    fn variance(&self) -> f64 {
        self.source.variance
    }

    fn readings(&self, visits: &[Visit]) -> usize {
        let width = 3 + if self.reads_rotations() { 3 } else { 0 } + self.encoders.len();
        self.read + width * visits.iter().map(|visit| visit.loads.len()).sum::<usize>()
    }

    fn sensors(&self) -> Vec<Sensor> {
        match &self.campaign.data {
            Data::Displacement(_) => {
                let rotations = (!self.reads_rotations()).then_some(Sensor::Rotations);
                let encoders = (self.encoders.len() < self.campaign.robot.joints.len()).then_some(Sensor::Encoders);
                rotations.into_iter().chain(encoders).chain([Sensor::Lever, Sensor::Levels]).collect()
            }
            Data::Position(data) => {
                let loads = data.rows.iter().any(|row| row.payload > 0.0);
                [Sensor::Rotations, Sensor::Reflector].into_iter().chain(loads.then_some(Sensor::Payloads)).collect()
            }
            Data::Clamped(_) => Vec::new(),
        }
    }

    fn known(&self) -> DMatrix<f64> {
        self.source.known.clone()
    }

    fn likely(&self) -> DMatrix<f64> {
        self.source.likely.clone()
    }

    fn information(&self, visits: &[Visit], besides: Option<Sensor>) -> Vec<DMatrix<f64>> {
        let plain = Rigged::default();
        let here = |visits: &[Visit]| self.at(visits, &plain);
        if visits.is_empty() {
            return Vec::new();
        }
        match (besides, &self.campaign.data) {
            (None, _) => here(visits),
            (Some(Sensor::Rotations), Data::Position(_)) => added(here(visits), self.turned(visits)),
            (Some(Sensor::Rotations), _) => self.at(visits, &Rigged { rotations: true, ..plain }),
            (Some(Sensor::Encoders), _) => self.at(visits, &Rigged { encoders: true, ..plain }),
            (Some(Sensor::Lever), _) => {
                let out = Vector3::z() * REACH;
                added(here(visits), self.at(visits, &Rigged { load: out, reading: out, ..plain }))
            }
            (Some(Sensor::Reflector), _) => {
                added(here(visits), self.at(visits, &Rigged { reading: Vector3::x() * REACH, ..plain }))
            }
            (Some(Sensor::Levels), _) => here(&with_shares(visits, &LEVELS)),
            (Some(Sensor::Payloads), _) => here(&with_shares(visits, &PAYLOADS)),
        }
    }
}

#[cfg(test)]
mod tests;
