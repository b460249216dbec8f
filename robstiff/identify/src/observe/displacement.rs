//! Displacements under measured loads: loaded minus unloaded.

use std::collections::BTreeMap;
use std::rc::Rc;

use nalgebra::{DMatrix, DVector, Vector3, Vector6};
use robstiff::JointKind;
use robstiff_robots::Description;

use super::clock::{Clock, in_visit};
use super::elastic::{Loaded, Sequence, Shares, Yielding, asides, grown_by, growths, stacked, sum, yielding};
use super::encoders::Encoders;
use super::equilibrium::{Beyond, beyond_linear, own_springs};
use super::{Observation, Readings, changed, step_of};
use crate::campaign::{Displacements, Observation as Row};
use crate::model::arm::Frame;
use crate::model::weight::Weight;
use crate::model::{Arm, At, Parameter, Rig, Stand, Term, World};

/// A second order that is a larger share than this of the linear displacements is of numbers in another unit: no arm
/// that machines comes to a tenth of it.
const MOST: f64 = 0.1;

/// A campaign of displacements.
pub struct Displacement<'c> {
    data: &'c Displacements,
    readings: Readings,
    world: World,
    kinds: Vec<JointKind>,
    /// The joint coordinates of each station, and the station of each row.
    stations: Vec<&'c [f64]>,
    station: Vec<usize>,
    /// Where the arm stands as declared, a station each.
    declared: Vec<Stand>,
    sequence: Sequence,
    clock: Clock,
    /// The directions that are read, in the frame of the file.
    directions: Vec<Vector3<f64>>,
    /// Whether rotations are read.
    turns: bool,
    /// The joints (from 1) whose angle is read behind the gear.
    pub encoders: Vec<usize>,
}

impl<'c> Displacement<'c> {
    /// Of a campaign on the arm of a description.
    pub fn new(robot: &Description, data: &'c Displacements) -> Self {
        Self::reading(robot, data, Encoders::of(data))
    }

    /// The same with other encoders than those that the rows have readings of.
    pub fn reading(robot: &Description, data: &'c Displacements, encoders: Encoders) -> Self {
        let kinds: Vec<JointKind> = robot.joints.iter().map(|joint| joint.kind).collect();
        let arm = Arm::of(robot);
        let (mut stations, mut station): (Vec<&[f64]>, Vec<usize>) = (Vec::new(), Vec::new());
        for row in &data.rows {
            match station.last().filter(|&&last| stations[last] == row.q.as_slice()) {
                Some(&last) => station.push(last),
                None => {
                    station.push(stations.len());
                    stations.push(&row.q);
                }
            }
        }
        let declared: Vec<Stand> = stations.iter().map(|q| arm.stand(q, &[])).collect();
        let turns = data.rows.iter().all(|row| row.rotation.is_some()) && !data.rows.is_empty();
        let Encoders { joints: encoders, turned, given } = encoders;
        let directions: Vec<Vector3<f64>> = data.directions.iter().copied().map(Vector3::from).collect();
        let rig = Rig::declared((data.wrench_frame, data.wrench_at), (data.measured_frame, data.measured_at));
        let weight = Weight::of(robot);
        let weights = |joint: usize| -> Vec<f64> {
            let at_station: Vec<f64> = declared.iter().map(|stand| weight.torque(stand, &kinds, joint)).collect();
            station.iter().map(|&at| at_station[at]).collect()
        };
        let weights: Vec<Vec<f64>> = (0..kinds.len()).map(weights).collect();
        let times: Vec<Option<f64>> = data.rows.iter().map(|row| row.time).collect();
        let temperatures: Vec<Option<f64>> = data.rows.iter().map(|row| row.temperature).collect();
        let visit: Vec<usize> = data.rows.iter().map(|row| row.visit).collect();
        let sequence = Sequence {
            preload: weights.iter().map(|of| of.iter().map(|torque| torque * weight.preload).collect()).collect(),
            weight: weights,
            q: (0..kinds.len()).map(|joint| data.rows.iter().map(|row| row.q[joint]).collect()).collect(),
            in_visit: in_visit(&visit, &times),
            visit: visit.clone(),
        };
        let forces: Vec<Vector3<f64>> = data
            .rows
            .iter()
            .zip(&station)
            .map(|(row, &at)| rig.wrench(&declared[at].tcp, &row.wrench).fixed_rows::<3>(0).into_owned())
            .collect();
        let largest = (forces.iter().map(|f| f.norm_squared()).sum::<f64>() / forces.len().max(1) as f64).sqrt();
        let forces: Vec<Vector3<f64>> = forces.iter().map(|f| f / if largest > 0.0 { largest } else { 1.0 }).collect();
        let mut clock = Clock::new(&times, &temperatures);
        clock.load = forces.iter().map(|force| force.norm()).collect();
        let middle = station.iter().map(|&at| declared[at].tcp.at).sum::<Vector3<f64>>() / station.len().max(1) as f64;
        clock.place = station.iter().map(|&at| declared[at].tcp.at - middle).collect();
        let width = directions.len() + if turns { 3 } else { 0 } + encoders.len();
        let channels = (0..directions.len()).map(|_| 0).chain((0..if turns { 3 } else { 0 }).map(|_| 1));
        let channels = channels.chain((0..encoders.len()).map(|k| 2 + k)).collect();
        let mut observation = Self {
            readings: Readings {
                values: DVector::zeros(0),
                width,
                reported: directions.len(),
                channels,
                block: data.rows.iter().map(|row| row.pose).collect(),
                blocks: data.poses.len(),
                stratum: vec![0; data.poses.len()],
                visit,
                force: forces,
                lines: data.rows.iter().map(|row| row.line).collect(),
                differences: true,
            },
            data,
            world: World { arm, rig },
            kinds,
            stations,
            station,
            declared,
            sequence,
            clock,
            directions,
            turns,
            encoders,
        };
        observation.readings.values = stacked(data.rows.len(), width, |i, numbers| {
            let row = &data.rows[i];
            let read = Vector6::from_iterator(row.displacement.into_iter().chain(row.rotation.unwrap_or_default()));
            // What the motors let through is no deflection.
            let stand = &observation.declared[observation.station[i]];
            let of_motors = given.get(i).map_or_else(Vector6::zeros, |given| {
                let screw = |joint: usize| stand.joint_screw(joint, observation.kinds[joint]).twist_at(&stand.tcp.at);
                given.iter().enumerate().map(|(joint, by)| screw(joint) * *by).sum()
            });
            let world = &observation.world;
            let seen = observation.seen(world, &of_motors, &stand.tcp, i);
            observation.put(&(read - seen), numbers);
            let first = numbers.len() - observation.encoders.len();
            numbers[first..].iter_mut().enumerate().for_each(|(k, number)| *number = turned[i][k]);
        });
        observation
    }

    /// A twist of the tool centre point as the file has it of the point that is read.
    fn seen(&self, world: &World, twist: &Vector6<f64>, tcp: &Frame, row: usize) -> Vector6<f64> {
        let marker = world.rig.marker(tcp);
        let turn: Vector3<f64> = twist.fixed_rows::<3>(3).into_owned();
        let mut at_marker = *twist;
        let mut moved = at_marker.fixed_rows_mut::<3>(0);
        moved += turn.cross(&marker);
        world.rig.seen(&at_marker, tcp, &self.declared[self.station[row]].tcp)
    }

    /// Puts what is read of a displacement into the numbers of a row.
    fn put(&self, seen: &Vector6<f64>, numbers: &mut [f64]) {
        let moved: Vector3<f64> = seen.fixed_rows::<3>(0).into_owned();
        for (number, direction) in numbers.iter_mut().zip(&self.directions) {
            *number = direction.dot(&moved);
        }
        if self.turns {
            let from = self.directions.len();
            (0..3).for_each(|k| numbers[from + k] = seen[3 + k]);
        }
    }

    /// What laws of joints need to know of all rows.
    pub fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    /// The displacement that stacked readings have of a row, in the frame of the file (m); zero across what is read.
    pub fn moved(&self, stacked: &DVector<f64>, row: usize) -> Vector3<f64> {
        let read = stacked.rows(row * self.readings.width, self.directions.len());
        self.directions.iter().zip(read.iter()).map(|(along, read)| along * *read).sum()
    }

    /// A vector as it is read at a row, in the base frame.
    pub fn in_base(&self, row: usize, read: &Vector3<f64>) -> Vector3<f64> {
        self.world.rig.in_base(read, &self.declared[self.station[row]].tcp)
    }

    fn rows(&self) -> usize {
        self.data.rows.len()
    }

    /// Whether the load of a row is larger than that of the row before in its visit (1), or not (-1).
    fn growing(&self, row: usize) -> f64 {
        let follows = row > 0 && self.sequence.visit[row - 1] == self.sequence.visit[row];
        if follows && self.clock.load[row] < self.clock.load[row - 1] { -1.0 } else { 1.0 }
    }

    fn at<'a>(&'a self, row: usize) -> At<'a> {
        At {
            row,
            q: &self.data.rows[row].q,
            before: &self.data.rows[row.saturating_sub(1)].q,
            time: self.clock.time[row],
            in_visit: self.sequence.in_visit[row],
            warmer: self.clock.warmer[row],
            load: self.clock.load[row],
            growing: self.growing(row),
            place: self.clock.place[row],
            stand: &self.declared[self.station[row]],
        }
    }

    /// The arm of a world under the loads of all rows.
    pub fn loaded(&self, world: &World, parameters: &[Parameter], values: &[f64]) -> Loaded {
        let mut firsts: Vec<usize> = Vec::with_capacity(self.stations.len());
        for (row, &at) in self.station.iter().enumerate() {
            if at == firsts.len() {
                firsts.push(row);
            }
        }
        let asides = asides(parameters, values, self.kinds.len(), &mut |of| {
            firsts.iter().for_each(|&row| of(&self.at(row)));
        });
        let none = Vec::new();
        let stand = |(at, q): (usize, &&[f64])| world.arm.stand(q, asides.get(at).unwrap_or(&none));
        let stands: Vec<Stand> = self.stations.iter().enumerate().map(stand).collect();
        let wrench = |(row, &at): (&Row, &usize)| world.rig.wrench(&stands[at].tcp, &row.wrench);
        let wrenches = self.data.rows.iter().zip(&self.station).map(wrench).collect();
        Loaded::new(&self.kinds, stands, self.station.clone(), wrenches)
    }

    /// What the arm's yielding reads, stacked.
    fn read(&self, world: &World, loaded: &Loaded, yielding: &Yielding) -> DVector<f64> {
        stacked(self.rows(), self.readings.width, |row, numbers| {
            let stand = &loaded.stands[loaded.station[row]];
            self.put(&self.seen(world, &yielding.twists[row], &stand.tcp, row), numbers);
            let first = numbers.len() - self.encoders.len();
            for (number, turns) in numbers[first..].iter_mut().zip(&yielding.turns) {
                *number = turns[row];
            }
        })
    }

    /// What adds to the readings at a row, in the base frame (m).
    fn read_directly(&self, of: &dyn Fn(&At<'_>) -> Vector3<f64>) -> DVector<f64> {
        stacked(self.rows(), self.readings.width, |row, numbers| {
            let moved = self.world.rig.as_filed(&of(&self.at(row)), &self.declared[self.station[row]].tcp);
            numbers.iter_mut().zip(&self.directions).for_each(|(number, along)| *number = along.dot(&moved));
        })
    }

    fn growths(&self, parameters: &[Parameter], values: &[f64]) -> Vec<(Shares, f64)> {
        growths(parameters, values, &self.sequence, &mut |of| self.each(of))
    }

    /// What the arm's yielding reads, to first order.
    pub fn yielded(&self, world: &World, parameters: &[Parameter], values: &[f64]) -> DVector<f64> {
        let world = changed(world, parameters, values);
        let loaded = self.loaded(&world, parameters, values);
        let yielding = sum(parameters, values, (&loaded, &self.sequence), &self.encoders);
        self.read(&world, &loaded, &yielding.grown(&self.growths(parameters, values)))
    }

    /// The prediction but for what large loads make of the arm's shape.
    fn predict_at(&self, world: &World, parameters: &[Parameter], values: &[f64]) -> DVector<f64> {
        let mut read = self.yielded(world, parameters, values);
        for (parameter, &value) in parameters.iter().zip(values).filter(|(_, value)| **value != 0.0) {
            if let Term::Reading(of) = &parameter.term {
                read += self.read_directly(&**of) * value;
            }
        }
        read
    }

    /// What a unit of a parameter adds to what is read, by a difference of both sides.
    fn slope(&self, world: &World, (parameters, values): (&[Parameter], &[f64]), which: usize) -> DVector<f64> {
        let step = step_of(&parameters[which]);
        let shifted = |by: f64| {
            let mut values = values.to_vec();
            values[which] += by;
            self.yielded(world, parameters, &values)
        };
        (shifted(step) - shifted(-step)) / (2.0 * step)
    }

    /// What large loads make of the arm's shape; nothing where by these springs it is [too much](MOST) in most rows.
    pub fn second_order(&self, world: &World, parameters: &[Parameter], values: &[f64]) -> DVector<f64> {
        let world = changed(world, parameters, values);
        let own = own_springs(parameters, values, self.kinds.len());
        let loaded = self.loaded(&world, &[], &[]);
        let of_row = |row: usize| {
            let at = loaded.station[row];
            let rest = (&loaded.stands[at], self.data.rows[row].q.as_slice(), [].as_slice());
            let beyond = beyond_linear(&world, (&self.kinds, &own), rest, &loaded.wrenches[row], &loaded.twists[at]);
            let linear =
                own.iter().enumerate().map(|(joint, h)| loaded.twist(row, joint) * (h * loaded.torques[joint][row]));
            let linear: Vector6<f64> = linear.sum();
            let at_marker =
                linear.fixed_rows::<3>(0) + linear.fixed_rows::<3>(3).cross(&world.rig.marker(&loaded.stands[at].tcp));
            let length = beyond.moved.fixed_rows::<3>(0).norm();
            (length <= MOST * at_marker.norm(), beyond)
        };
        let beyond: Vec<(bool, Beyond)> = (0..self.rows()).map(of_row).collect();
        let is_known = 2 * beyond.iter().filter(|(is_small, _)| *is_small).count() > beyond.len();
        stacked(self.rows(), self.readings.width, |row, numbers| {
            let (_, beyond) = &beyond[row];
            if !is_known || !beyond.moved.iter().all(|number| number.is_finite()) {
                return;
            }
            let at = loaded.station[row];
            let declared = &self.declared[self.station[row]].tcp;
            self.put(&world.rig.seen(&beyond.moved, &loaded.stands[at].tcp, declared), numbers);
            let first = numbers.len() - self.encoders.len();
            for (number, &joint) in numbers[first..].iter_mut().zip(&self.encoders) {
                *number = beyond.turns[joint - 1];
            }
        })
    }
}

impl Observation for Displacement<'_> {
    fn readings(&self) -> &Readings {
        &self.readings
    }

    fn world(&self) -> &World {
        &self.world
    }

    fn predict(&self, world: &World, parameters: &[Parameter], values: &[f64]) -> DVector<f64> {
        self.predict_at(world, parameters, values) + self.second_order(world, parameters, values)
    }

    fn columns(&self, world: &World, parameters: &[Parameter], values: &[f64], of: &[usize]) -> DMatrix<f64> {
        let here = changed(world, parameters, values);
        let loaded = self.loaded(&here, parameters, values);
        let growths = self.growths(parameters, values);
        let (mut whole, mut asides) = (None, BTreeMap::new());
        let mut columns = DMatrix::zeros(self.rows() * self.readings.width, of.len());
        for (k, &which) in of.iter().enumerate() {
            let parameter = &parameters[which];
            let column = match &parameter.term {
                Term::Spring(_) | Term::Law(..) | Term::Laws(_) | Term::Hardening(..) => {
                    yielding(&parameter.term, &loaded, &self.sequence, &self.encoders)
                        .map(|part| self.read(&here, &loaded, &part.grown(&growths)))
                }
                Term::Reading(of) => Some(self.read_directly(&**of)),
                Term::Gain(_) | Term::Creep(_) => {
                    let whole =
                        whole.get_or_insert_with(|| sum(parameters, values, (&loaded, &self.sequence), &self.encoders));
                    grown_by(&parameter.term, &self.sequence, &mut |of| self.each(of))
                        .map(|shares| self.read(&here, &loaded, &whole.shared_by(&shares)))
                }
                // All turns about the axis of a joint go with that of its zero.
                Term::Aside(joint, 2, of) => {
                    let unit: &mut DVector<f64> = asides.entry(*joint).or_insert_with(|| {
                        let one = Parameter { term: Term::Aside(*joint, 2, Rc::new(|_| 1.0)), ..parameter.clone() };
                        let with_it = (&*[parameters, &[one]].concat(), &*[values, &[0.0]].concat());
                        self.slope(world, with_it, parameters.len())
                    });
                    let mut column = unit.clone();
                    column.as_mut_slice().chunks_mut(self.readings.width).enumerate().for_each(|(row, numbers)| {
                        let share = of(&self.at(row));
                        numbers.iter_mut().for_each(|number| *number *= share);
                    });
                    Some(column)
                }
                Term::Aside(..) | Term::Asides(_) | Term::Table(..) | Term::World(_) => None,
            };
            let column = column.unwrap_or_else(|| self.slope(world, (parameters, values), which));
            columns.set_column(k, &column);
        }
        columns
    }

    fn each(&self, of: &mut dyn FnMut(&At<'_>)) {
        (0..self.rows()).for_each(|row| of(&self.at(row)));
    }
}
