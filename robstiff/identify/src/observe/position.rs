//! Absolute positions of a point of the tool, read by something that stands anywhere.

use nalgebra::{DMatrix, DVector, Isometry3, Vector3, Vector6};
use robstiff::JointKind;
use robstiff_robots::Description;
use robstiff_robots::effect::gravity_sag::GRAVITY;

use super::clock::{Clock, in_visit};
use super::elastic::{Loaded, Sequence, asides, stacked, sum, yielding};
use super::equilibrium::{beyond_linear, own_springs};
use super::registration::registration;
use super::{Observation, Readings, as_declared, changed, step_of};
use crate::campaign::{Frame, PositionRow, Positions};
use crate::model::arm::Screw;
use crate::model::{Arm, At, Parameter, Rig, Stand, Term, Weight, World};

/// A campaign of absolute positions.
pub struct Position<'c> {
    data: &'c Positions,
    readings: Readings,
    world: World,
    kinds: Vec<JointKind>,
    /// Where the arm stands as declared, row by row.
    declared: Vec<Stand>,
    sequence: Sequence,
    clock: Clock,
    /// Whether any row has a payload.
    pub payloads: bool,
}

impl<'c> Position<'c> {
    /// Of a campaign on the arm of a description. Where the robot stands begins where the declared
    /// arm fits best.
    pub fn new(robot: &Description, data: &'c Positions) -> Self {
        let kinds: Vec<JointKind> = robot.joints.iter().map(|joint| joint.kind).collect();
        let arm = Arm::of(robot);
        let declared: Vec<Stand> = data.rows.iter().map(|row| arm.stand(&row.q, &[])).collect();
        let mut rig = Rig::declared((Frame::Base, data.payload_at), (Frame::Base, data.measured_at));
        let points: Vec<Vector3<f64>> = declared.iter().map(|stand| stand.tcp.at + rig.marker(&stand.tcp)).collect();
        let read: Vec<Vector3<f64>> = data.rows.iter().map(|row| row.position.into()).collect();
        rig.stand = registration(&points, &read);
        rig.middle = middle_of(&read);
        let times: Vec<Option<f64>> = data.rows.iter().map(|row| row.time).collect();
        let temperatures: Vec<Option<f64>> = data.rows.iter().map(|row| row.temperature).collect();
        let visit: Vec<usize> = data.rows.iter().map(|row| row.visit).collect();
        let mut clock = Clock::new(&times, &temperatures);
        let middle = declared.iter().map(|stand| stand.tcp.at).sum::<Vector3<f64>>() / declared.len().max(1) as f64;
        clock.place = declared.iter().map(|stand| stand.tcp.at - middle).collect();
        let heaviest = data.rows.iter().map(|row| row.payload).fold(0.0, f64::max);
        clock.load = data.rows.iter().map(|row| if heaviest > 0.0 { row.payload / heaviest } else { 0.0 }).collect();
        let weight = Weight::of(robot);
        let weights = |joint: usize| declared.iter().map(|stand| weight.torque(stand, &kinds, joint)).collect();
        let weights: Vec<Vec<f64>> = (0..kinds.len()).map(weights).collect();
        let sequence = Sequence {
            preload: weights.iter().map(|of| of.iter().map(|torque| torque * weight.preload).collect()).collect(),
            weight: weights,
            q: (0..kinds.len()).map(|joint| data.rows.iter().map(|row| row.q[joint]).collect()).collect(),
            in_visit: in_visit(&visit, &times),
            visit: visit.clone(),
        };
        let readings = Readings {
            values: DVector::from_iterator(3 * read.len(), read.iter().flat_map(|point| point.iter().copied())),
            width: 3,
            reported: 3,
            channels: vec![0; 3],
            block: data.rows.iter().map(|row| row.pose).collect(),
            blocks: data.poses.len(),
            stratum: vec![0; data.poses.len()],
            visit,
            force: vec![Vector3::zeros(); read.len()],
            lines: data.rows.iter().map(|row| row.line).collect(),
            differences: false,
        };
        Self { data, readings, world: World { arm, rig }, kinds, declared, sequence, clock, payloads: heaviest > 0.0 }
    }

    fn rows(&self) -> usize {
        self.data.rows.len()
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
            growing: 1.0,
            place: self.clock.place[row],
            stand: &self.declared[row],
        }
    }

    /// By how much the joints stand aside, row by row; empty where none does.
    fn asides(&self, parameters: &[Parameter], values: &[f64]) -> Vec<Vec<Vector3<f64>>> {
        asides(parameters, values, self.kinds.len(), &mut |of| {
            (0..self.rows()).for_each(|row| of(&self.at(row)));
        })
    }

    /// The payload of each row over the heaviest.
    pub fn loads(&self) -> &[f64] {
        &self.clock.load
    }

    /// The torque of the payloads on each joint (from 0) of the arm as declared, through all rows (Nm or N).
    pub fn torques(&self) -> Vec<Vec<f64>> {
        self.loaded(&self.world, &[]).torques
    }

    /// The arm of a world under its payloads, its joints aside by so much.
    fn loaded(&self, world: &World, asides: &[Vec<Vector3<f64>>]) -> Loaded {
        let none = Vec::new();
        let stand = |(row, of): (usize, &PositionRow)| world.arm.stand(&of.q, asides.get(row).unwrap_or(&none));
        let stands: Vec<Stand> = self.data.rows.iter().enumerate().map(stand).collect();
        let wrench = |(stand, row): (&Stand, &PositionRow)| {
            world.rig.wrench(&stand.tcp, &[0.0, 0.0, -GRAVITY * row.payload, 0.0, 0.0, 0.0])
        };
        let wrenches = stands.iter().zip(&self.data.rows).map(wrench).collect();
        Loaded::new(&self.kinds, stands, (0..self.rows()).collect(), wrenches)
    }

    /// The point that is read at each row of the arm of a description, as it is declared, in the base
    /// frame (m).
    pub fn points(&self, robot: &Description) -> Vec<Vector3<f64>> {
        let mut world = self.world.clone();
        (world.rig.stand, world.rig.middle) = (Isometry3::identity(), Vector3::zeros());
        let read = as_declared(self, &world, robot);
        (0..self.rows()).map(|row| read.fixed_rows::<3>(3 * row).into_owned()).collect()
    }

    /// What large loads make of the arm's shape at the point that is read; nothing where no row has one.
    fn second_order(
        &self,
        asides: &[Vec<Vector3<f64>>],
        world: &World,
        parameters: &[Parameter],
        values: &[f64],
    ) -> DVector<f64> {
        if !self.payloads {
            return DVector::zeros(3 * self.rows());
        }
        let world = changed(world, parameters, values);
        let own = own_springs(parameters, values, self.kinds.len());
        let loaded = self.loaded(&world, asides);
        stacked(self.rows(), 3, |row, numbers| {
            let aside = asides.get(row).map_or([].as_slice(), Vec::as_slice);
            let rest = (&loaded.stands[row], self.data.rows[row].q.as_slice(), aside);
            let beyond = beyond_linear(&world, (&self.kinds, &own), rest, &loaded.wrenches[row], &loaded.twists[row]);
            let moved: Vector3<f64> = beyond.moved.fixed_rows::<3>(0).into_owned();
            numbers.copy_from_slice(world.rig.direction(&moved).as_slice());
        })
    }

    /// What is read with the joints aside by so much, but for what large loads make of the arm's shape.
    fn predict_with(
        &self,
        asides: &[Vec<Vector3<f64>>],
        world: &World,
        parameters: &[Parameter],
        values: &[f64],
    ) -> DVector<f64> {
        let world = changed(world, parameters, values);
        let loaded = self.loaded(&world, asides);
        let yields = self.payloads.then(|| sum(parameters, values, (&loaded, &self.sequence), &[]));
        let direct: Vec<_> = parameters
            .iter()
            .zip(values)
            .filter_map(|(parameter, &value)| match &parameter.term {
                Term::Reading(of) if value != 0.0 => Some((of, value)),
                _ => None,
            })
            .collect();
        stacked(self.rows(), 3, |row, numbers| {
            let twist = yields.as_ref().map_or_else(Vector6::zeros, |yields| yields.twists[row]);
            let mut read = world.rig.position(&self.point(&world, &loaded.stands[row], &twist));
            for (of, value) in &direct {
                read += world.rig.direction(&(of(&self.at(row)) * *value));
            }
            numbers.copy_from_slice(read.as_slice());
        })
    }

    /// The point that is read at a row, displaced by a twist of the tool centre point (m).
    fn point(&self, world: &World, stand: &Stand, twist: &Vector6<f64>) -> Vector3<f64> {
        let marker = world.rig.marker(&stand.tcp);
        let turn: Vector3<f64> = twist.fixed_rows::<3>(3).into_owned();
        stand.tcp.at + marker + twist.fixed_rows::<3>(0) + turn.cross(&marker)
    }
}

impl Observation for Position<'_> {
    fn readings(&self) -> &Readings {
        &self.readings
    }

    fn world(&self) -> &World {
        &self.world
    }

    fn predict(&self, world: &World, parameters: &[Parameter], values: &[f64]) -> DVector<f64> {
        let asides = self.asides(parameters, values);
        self.predict_with(&asides, world, parameters, values) + self.second_order(&asides, world, parameters, values)
    }

    fn columns(&self, world: &World, parameters: &[Parameter], values: &[f64], of: &[usize]) -> DMatrix<f64> {
        let here = changed(world, parameters, values);
        let asides = self.asides(parameters, values);
        let loaded = self.loaded(&here, &asides);
        let levers: Vec<Vector3<f64>> =
            loaded.stands.iter().map(|stand| self.point(&here, stand, &Vector6::zeros())).collect();
        // How the point moves for a unit by which a joint stands aside.
        let aside = |joint: usize, axis: usize, row: usize| {
            let frame = &loaded.stands[row].joints[joint - 1];
            let slides = axis == 2 && self.kinds[joint - 1] == JointKind::Prismatic;
            Screw { axis: frame.axis(axis), through: frame.at, slides }.at(&levers[row])
        };
        let mut columns = DMatrix::zeros(3 * self.rows(), of.len());
        for (k, &which) in of.iter().enumerate() {
            let parameter = &parameters[which];
            let column = match &parameter.term {
                Term::Spring(_) | Term::Law(..) | Term::Laws(_) | Term::Hardening(..) => {
                    let part = yielding(&parameter.term, &loaded, &self.sequence, &[]);
                    part.map(|part| {
                        stacked(self.rows(), 3, |row, numbers| {
                            let zero = self.point(&here, &loaded.stands[row], &Vector6::zeros());
                            let moved = self.point(&here, &loaded.stands[row], &part.twists[row]) - zero;
                            numbers.copy_from_slice(here.rig.direction(&moved).as_slice());
                        })
                    })
                }
                Term::Aside(joint, axis, of) => Some(stacked(self.rows(), 3, |row, numbers| {
                    let moved = aside(*joint, *axis, row) * of(&self.at(row));
                    numbers.copy_from_slice(here.rig.direction(&moved).as_slice());
                })),
                Term::Asides(of) => Some(stacked(self.rows(), 3, |row, numbers| {
                    let of_joint = |joint| aside(joint, 2, row) * of(&self.at(row), joint);
                    let moved: Vector3<f64> = (1..=self.kinds.len()).map(of_joint).sum();
                    numbers.copy_from_slice(here.rig.direction(&moved).as_slice());
                })),
                Term::Reading(of) => Some(stacked(self.rows(), 3, |row, numbers| {
                    numbers.copy_from_slice(here.rig.direction(&of(&self.at(row))).as_slice());
                })),
                Term::Gain(_) | Term::Creep(_) => Some(DVector::zeros(3 * self.rows())),
                Term::Table(joint, number) => Some(stacked(self.rows(), 3, |row, numbers| {
                    let moved = loaded.stands[row].screws[joint - 1][*number].at(&levers[row]);
                    numbers.copy_from_slice(here.rig.direction(&moved).as_slice());
                })),
                Term::World(_) => None,
            };
            let column = column.unwrap_or_else(|| {
                let step = step_of(parameter);
                let shifted = |by: f64| {
                    let mut values = values.to_vec();
                    values[which] += by;
                    self.predict_with(&asides, world, parameters, &values)
                };
                (shifted(step) - shifted(-step)) / (2.0 * step)
            });
            columns.set_column(k, &column);
        }
        columns
    }

    fn each(&self, of: &mut dyn FnMut(&At<'_>)) {
        (0..self.rows()).for_each(|row| of(&self.at(row)));
    }
}

/// The middle of points, coordinate by coordinate the median: a few that are far off do not move it.
fn middle_of(points: &[Vector3<f64>]) -> Vector3<f64> {
    Vector3::from_fn(|k, _| {
        let mut along: Vec<f64> = points.iter().map(|point| point[k]).collect();
        along.sort_by(f64::total_cmp);
        along.get(along.len() / 2).copied().unwrap_or(0.0)
    })
}
