//! From the regression of displacements to what planning asks for; the only place in
//! planning that knows how numbers become displacements.

use std::rc::Rc;
use std::string::String;
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Matrix4, Vector3, Vector6};
use robstiff_robots::effect::Place as Part;

use super::source::{Kept, Source, start};
use crate::campaign::{Campaign, Displacements, Frame, Observation};
use crate::identify::Error;
use crate::identify::column::Column;
use crate::identify::covariance::Covariance;
use crate::identify::prepare::Prepared;
use crate::identify::samples::{Sample, Samples};
use crate::identify::setup::Setup;
use crate::identify::whitening::{reading_of, whiten};
use crate::plan::regressors::{ENCODER_NOISE, LEVELS, REACH, ROTATION_NOISE, Regressors, Sensor, Visit, tool_turn};
use crate::plan::rivals::{Group, Rivals};
use crate::trace::bench::Bench;
use crate::trace::catalogue::{Scene, catalogue};
use crate::trace::point::Point;
use crate::trace::slip::Moments;
use crate::trace::{Place, Trace};
use robstiff::elements::{Geometry, Spring};

/// A traced campaign, with the numbers that planning looks at.
pub struct Adapter<'c> {
    campaign: &'c Campaign,
    /// The campaign's frames and points, with those of its rows that load each
    /// joint most, and their visits: the catalogue takes its grids of torques
    /// from them.
    anchors: Displacements,
    /// The time of the last reading (s).
    last: f64,
    compliance: Vec<f64>,
    /// The forward model at what was traced: its setup, its springs, and all its
    /// elastic numbers.
    setup: Setup,
    springs: Vec<(Spring, f64)>,
    elastic: Vec<(Kept, f64)>,
    kept: Vec<Kept>,
    known: DMatrix<f64>,
    read: usize,
    /// How noisy what is read at the tool is, and how it hangs together.
    covariance: Covariance,
    noise: f64,
    rotation_noise: f64,
}

impl<'c> Adapter<'c> {
    /// For a campaign that was made ready and its trace, with groups of rivals.
    ///
    /// # Errors
    /// Why the description's own model cannot be fitted.
    pub fn new(
        campaign: &'c Campaign,
        prepared: &'c Prepared<'c>,
        trace: &Trace,
        groups: &[Group],
    ) -> Result<(Self, Rivals), Error> {
        // What the trace found wrong in single rows has no part in a fit.
        let lines: Vec<usize> = trace.effects.iter().flat_map(|named| named.lines.iter().copied()).collect();
        let wild: Vec<usize> =
            (0..).zip(&prepared.data.rows).filter(|(_, row)| lines.contains(&row.line)).map(|(i, _)| i).collect();
        let bench = Bench::new(campaign, prepared).map_err(Error::NotShown)?.leaving_out(&wild);
        let everything = catalogue(&bench.scene(), prepared.own.len(), false);
        let source = Source { bench: &bench, prepared, everything: &everything };
        let (rivals, model, columns) = source.rivals(campaign, trace, groups)?;
        let setting = bench.at(&model).map_err(Error::NotShown)?;
        let fitted = bench.fit(&model).map_err(Error::NotShown)?;
        let numbers = fitted.fit.columns.iter().zip(fitted.fit.coefficients.iter());
        let is_elastic = |column: usize| {
            let number = column.checked_sub(prepared.own.len()).map(|k| &setting.numbers[k]);
            number.is_none_or(|number| number.elastic && number.enters.is_none())
        };
        let elastic = numbers.filter(|(column, _)| is_elastic(**column));
        let elastic = elastic.map(|(&column, &value)| (source.kept(column), value)).collect();
        let problem = setting.on(&columns);
        // How far the joints sag is a row's own.
        let setup = Setup { sag: None, loads: Vec::new(), ..setting.point.setup.clone() };
        let adapter = Self {
            campaign,
            anchors: anchors(prepared),
            last: prepared.data.rows.iter().filter_map(|row| row.time).fold(0.0, f64::max),
            compliance: bench.scene().compliance,
            setup,
            springs: bench.springs(&fitted.fit),
            elastic,
            kept: columns.iter().map(|&column| source.kept(column)).collect(),
            known: problem.total.gram.clone(),
            read: problem.total.rows,
            covariance: prepared.covariance.clone(),
            noise: trace.noise,
            rotation_noise: campaign.noise.rotation.unwrap_or(ROTATION_NOISE),
        };
        Ok((adapter, rivals))
    }

    /// The rows of some visits, behind the anchors.
    fn rows(&self, visits: &[Visit], further_out: f64) -> Displacements {
        let mut data = self.anchors.clone();
        let anchors = &self.anchors.rows;
        // Every pose that is counted has a row.
        let next = |of: &dyn Fn(&Observation) -> usize| anchors.iter().map(of).max().map_or(0, |last| last + 1);
        let (mut pose, sequences) = (next(&|row| row.pose), next(&|row| row.visit));
        for (index, visit) in visits.iter().enumerate() {
            // What follows each other at one pose is one pose.
            if index > 0 && visits[index - 1].q != visit.q {
                pose += 1;
            }
            let tool = tool_turn(&self.campaign.robot, &visit.q);
            let out = tool * Vector3::new(0.0, 0.0, further_out);
            for load in &visit.loads {
                let force = Vector3::from_column_slice(&load[..3]);
                let moment = Vector3::from_column_slice(&load[3..]) + out.cross(&force);
                let frame =
                    if data.wrench_frame == Frame::Tool { tool.transpose() } else { nalgebra::Matrix3::identity() };
                let (force, moment) = (frame * force, frame * moment);
                data.rows.push(Observation {
                    line: 0,
                    pose,
                    visit: sequences + index,
                    time: anchors.first().and_then(|row| row.time).map(|_| self.last),
                    temperature: anchors.first().and_then(|row| row.temperature),
                    q: visit.q.clone(),
                    wrench: [force.x, force.y, force.z, moment.x, moment.y, moment.z],
                    displacement: [0.0; 3],
                    encoders: None,
                    motors: None,
                    rotation: Some([0.0; 3]),
                });
            }
        }
        data.poses.resize(pose + 1, String::new());
        data.visits.resize(sequences + visits.len(), String::new());
        data.rows.iter_mut().for_each(|row| row.rotation = Some([0.0; 3]));
        data
    }

    /// What a unit of each number does to some visits' rows, six numbers a row
    /// (m, rad), and the rows; without the anchors.
    fn columns(&self, visits: &[Visit], further_out: f64) -> (Samples, DMatrix<f64>) {
        let (robot, data) = (&self.campaign.robot, self.rows(visits, further_out));
        let declared = Rc::new(Samples::of_description(robot, &data));
        let scene = Scene {
            description: robot,
            data: &data,
            samples: &declared,
            compliance: self.compliance.clone(),
            moments: &Moments::default(),
            elsewhere: true,
        };
        let everything = catalogue(&scene, 0, false);
        let column = |point: &Point<'_>, kept: &Kept| match kept {
            Kept::Own(column) => point.samples.column(*column),
            Kept::Of(kind, place, which) => start(&everything, kind, *place, 0).map_or_else(
                || DVector::zeros(6 * data.rows.len()),
                |first| (everything.numbers[first + which].regressor)(point),
            ),
        };
        let bare = Point::bare(robot, &data, &declared, self.setup.clone());
        let mut elastic = DVector::zeros(6 * data.rows.len());
        for (kept, value) in &self.elastic {
            elastic.axpy(*value, &column(&bare, kept), 1.0);
        }
        let point = bare.with_model(&declared, elastic, &self.springs);
        let anchors = self.anchors.rows.len();
        let (first, rows) = (6 * anchors, 6 * (data.rows.len() - anchors));
        let mut columns = DMatrix::zeros(rows, self.kept.len());
        for (k, kept) in self.kept.iter().enumerate() {
            columns.set_column(k, &column(&point, kept).rows(first, rows));
        }
        let mut samples = Rc::unwrap_or_clone(point.samples);
        samples.rows.drain(..anchors);
        (samples, columns)
    }

    /// What is read at the tool.
    fn at_the_tool(&self, visits: &[Visit], covariance: &Covariance, further_out: f64) -> Vec<DMatrix<f64>> {
        let (samples, columns) = self.columns(visits, further_out);
        let (rows, axes) = (samples.rows.len(), covariance.axes());
        let of_axis = |i: usize, k: usize| columns[(i / axes * 6 + i % axes, k)];
        let mut stacked = DMatrix::from_fn(rows * axes, columns.ncols(), of_axis);
        covariance.whitener_of(&samples.rows, &of_rows(visits)).whiten(&mut stacked);
        grams(&stacked, axes, visits)
    }

    /// What is read elsewhere on the robot, `count` numbers a row.
    fn elsewhere(
        &self,
        visits: &[Visit],
        count: usize,
        read: impl Fn(&Geometry<'_, f64>, &[(usize, Vector6<f64>)]) -> Vec<f64>,
    ) -> Vec<DMatrix<f64>> {
        let (samples, columns) = self.columns(visits, 0.0);
        let mut stacked = DMatrix::zeros(samples.rows.len() * count, self.kept.len());
        for (i, row) in samples.rows.iter().enumerate() {
            let geometry = samples.geometry(row);
            for (k, kept) in self.kept.iter().enumerate() {
                let at_marker: Vector6<f64> = columns.fixed_view::<6, 1>(6 * i, k).into_owned();
                let values = read(&geometry, &parts(&geometry, row, kept, &at_marker));
                stacked.view_mut((i * count, k), (count, 1)).copy_from_slice(&values);
            }
        }
        // In the unit of displacements: a row is the difference of two readings of that noise.
        whiten(&mut stacked, &of_rows(visits), count, self.covariance.shared);
        stacked *= reading_of(self.covariance.shared);
        grams(&stacked, count, visits)
    }
}

/// The visits with the rows that load each joint most, poses and visits counted
/// anew.
fn anchors(prepared: &Prepared<'_>) -> Displacements {
    let samples = &prepared.samples;
    let most = |joint: usize| {
        let torques = samples.torques(joint);
        (0..torques.len()).max_by(|&a, &b| torques[a].abs().total_cmp(&torques[b].abs()))
    };
    let visits: Vec<usize> = (1..=samples.joints()).filter_map(most).map(|row| samples.rows[row].visit).collect();
    let mut rows: Vec<Observation> =
        prepared.data.rows.iter().filter(|row| visits.contains(&row.visit)).cloned().collect();
    let (mut poses, mut sequences) = (Vec::new(), Vec::new());
    for row in &mut rows {
        row.pose = index_of(&mut poses, row.pose);
        row.visit = index_of(&mut sequences, row.visit);
    }
    let &Displacements { wrench_frame, wrench_at, measured_frame, measured_at, .. } = prepared.data;
    let (poses, visits) = (Vec::new(), Vec::new());
    Displacements { wrench_frame, wrench_at, measured_frame, measured_at, poses, visits, rows }
}

/// The place of a number among those met before.
fn index_of(met: &mut Vec<usize>, number: usize) -> usize {
    met.iter().position(|&other| other == number).unwrap_or_else(|| {
        met.push(number);
        met.len() - 1
    })
}

impl Regressors for Adapter<'_> {
    fn variance(&self) -> f64 {
        self.noise * self.noise
    }

    fn readings(&self, visits: &[Visit]) -> usize {
        self.read + self.covariance.axes() * visits.iter().map(|visit| visit.loads.len()).sum::<usize>()
    }

    fn sensors(&self) -> Vec<Sensor> {
        let rotations = (self.covariance.axes() == 3).then_some(Sensor::Rotations);
        let elsewhere = (0..=self.campaign.robot.joints.len()).map(Sensor::Markers);
        rotations.into_iter().chain([Sensor::Encoders, Sensor::Lever, Sensor::Levels]).chain(elsewhere).collect()
    }

    fn known(&self) -> DMatrix<f64> {
        self.known.clone()
    }

    fn information(&self, visits: &[Visit], besides: Option<Sensor>) -> Vec<DMatrix<f64>> {
        if visits.is_empty() {
            return Vec::new();
        }
        let tool = || self.at_the_tool(visits, &self.covariance, 0.0);
        let further = match besides {
            None => return tool(),
            Some(Sensor::Rotations) => {
                let covariance = self.covariance.clone().with_rotations(self.noise / self.rotation_noise);
                return self.at_the_tool(visits, &covariance, 0.0);
            }
            Some(Sensor::Levels) => {
                let levels = |visit: &Visit| {
                    let greatest = visit.greatest();
                    let loads = LEVELS.iter().map(|share| greatest.map(|value| share * value));
                    Visit { q: visit.q.clone(), loads: loads.collect() }
                };
                let visits: Vec<Visit> = visits.iter().map(levels).collect();
                return self.at_the_tool(&visits, &self.covariance, 0.0);
            }
            Some(Sensor::Lever) => self.at_the_tool(visits, &self.covariance, REACH),
            // Positions alone are read at a reflector.
            Some(Sensor::Reflector | Sensor::Payloads) => return tool(),
            Some(Sensor::Markers(body)) => self.elsewhere(visits, 9, |geometry, parts| markers(geometry, parts, body)),
            Some(Sensor::Encoders) => {
                let (weight, joints) = (self.noise / ENCODER_NOISE, self.campaign.robot.joints.len());
                self.elsewhere(visits, joints, |geometry, parts| {
                    let mut turns = vec![0.0; joints];
                    for (place, twist) in parts {
                        // What turns a gear turns it about its axis alone.
                        let Some(joint) = place.checked_sub(1).filter(|joint| *joint < joints) else { continue };
                        let of_gear = geometry.joint_twist(joint + 1);
                        let amount = twist.dot(&of_gear) / of_gear.norm_squared();
                        if (twist - of_gear * amount).norm() <= 1e-6 * twist.norm() {
                            turns[joint] += weight * amount;
                        }
                    }
                    turns
                })
            }
        };
        tool().into_iter().zip(further).map(|(tool, further)| tool + further).collect()
    }
}

/// The visit of each row.
fn of_rows(visits: &[Visit]) -> Vec<usize> {
    visits.iter().enumerate().flat_map(|(index, visit)| core::iter::repeat_n(index, visit.loads.len())).collect()
}

/// The information of each visit from its rows' whitened columns, stacked.
fn grams(stacked: &DMatrix<f64>, axes: usize, visits: &[Visit]) -> Vec<DMatrix<f64>> {
    let mut first = 0;
    let mut gram = |visit: &Visit| {
        let count = visit.loads.len() * axes;
        let rows = stacked.rows(first, count);
        first += count;
        rows.tr_mul(&rows)
    };
    visits.iter().map(&mut gram).collect()
}

/// What a unit of a number does, as twists of the TCP, each with the number of
/// joints before the place where it happens. `read` is what it does at the
/// marker.
fn parts(geometry: &Geometry<'_, f64>, row: &Sample, kept: &Kept, read: &Vector6<f64>) -> Vec<(usize, Vector6<f64>)> {
    let joints = geometry.joint_frames.len();
    let turn: Vector3<f64> = read.fixed_rows::<3>(3).into_owned();
    let mut twist = *read;
    twist.fixed_rows_mut::<3>(0).copy_from(&(read.fixed_rows::<3>(0) - turn.cross(&row.marker)));
    let gear = |joint: usize, by: usize| {
        let torque = geometry.joint_twist(by).dot(&row.wrench);
        (joint, geometry.joint_twist(joint) * torque)
    };
    let place = match kept {
        Kept::Own(Column::Spring(Spring::Coupling([i, j]))) => return vec![gear(*i, *j), gear(*j, *i)],
        Kept::Own(Column::Knee { joint, .. } | Column::Gap { joint, .. } | Column::Play { joint, .. }) => *joint,
        Kept::Own(Column::Spring(spring)) => match *spring {
            Spring::Joint(i) | Spring::Transverse(i) | Spring::LinkBending(i) | Spring::LinkTorsion(i) => i,
            Spring::BaseTilt | Spring::BaseTranslation => 0,
            Spring::ToolRotation | Spring::ToolTranslation => joints + 1,
            Spring::Coupling(_) => unreachable!("it has two places"),
        },
        Kept::Of(_, Place::Part(Part::Joints([i, j])), _) => return vec![gear(*i, *j), gear(*j, *i)],
        Kept::Of(_, Place::Part(Part::Base), _) => 0,
        Kept::Of(_, Place::Part(Part::Joint(i) | Part::Link(i)), _) => *i,
        // The tool; and what changes all readings is taken for nothing that
        // another place would show.
        Kept::Of(..) => joints + 1,
    };
    vec![(place, twist)]
}

/// The displacements of three markers about the far end of the body behind
/// `body` joints.
fn markers(geometry: &Geometry<'_, f64>, parts: &[(usize, Vector6<f64>)], body: usize) -> Vec<f64> {
    let origin = |frame: &Matrix4<f64>| -> Vector3<f64> { frame.fixed_view::<3, 1>(0, 3).into_owned() };
    let end = origin(geometry.joint_frames.get(body).unwrap_or(&geometry.flange));
    let mut read = Vec::with_capacity(9);
    for axis in 0..3 {
        let lever = end + Vector3::ith(axis, REACH) - origin(&geometry.tcp);
        let seen = parts.iter().filter(|(place, _)| *place <= body);
        let moved = seen.map(|(_, twist)| twist.fixed_rows::<3>(0) + twist.fixed_rows::<3>(3).cross(&lever));
        read.extend(moved.sum::<Vector3<f64>>().iter());
    }
    read
}
