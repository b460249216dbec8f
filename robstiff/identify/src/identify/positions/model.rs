//! Where a description says that the point is which is read.

use std::boxed::Box;
use std::rc::Rc;
use std::vec::Vec;

use nalgebra::{Matrix3, Matrix4, SVector, Vector3, Vector6};
use robstiff_robots::Description;
use robstiff_robots::effect::gravity_sag::GRAVITY;

use super::registration::Registration;
use crate::campaign::{PositionRow, Positions};
use robstiff::elements::{Torque, deformed};
use robstiff::{Robot, with_robot};

/// A model of absolute positions.
#[derive(Clone, Debug)]
pub struct Model {
    /// The robot.
    pub description: Description,
    /// The point that is read, in the tool frame (m).
    pub marker: Vector3<f64>,
    /// Where the payload hangs, in the tool frame (m).
    pub hook: Vector3<f64>,
    /// Joints that go where another's coordinate, or their own, takes them besides.
    pub followers: Vec<Follower>,
}

/// A joint that goes farther than it reads, by a share of how far a joint has gone.
#[derive(Clone, Copy, Debug)]
pub struct Follower {
    /// The joint, from 1.
    pub joint: usize,
    /// The one that it follows, from 1; itself where its encoder has a scale of its own.
    pub of: usize,
    /// The coordinate of that one at which it adds nothing (rad or m).
    pub from: f64,
    /// How much of what is beyond.
    pub share: f64,
}

/// The step of central differences of an angle (rad).
pub const ANGLE_STEP: f64 = 1e-5;
/// That of a length (m), whose curvature, as that of an angle, is the arm's.
pub const LENGTH_STEP: f64 = 1e-4;
/// That of a compliance (rad/Nm or m/N).
pub const COMPLIANCE_STEP: f64 = 1e-8;
/// That of a share.
pub const SHARE_STEP: f64 = 1e-3;

/// Changes a model by so much of a number.
pub type Change = Rc<dyn Fn(&mut Model, f64)>;

/// What a unit of a number does to a model.
#[derive(Clone)]
pub enum Enters {
    /// It changes the model; the second is the step of central differences, in its
    /// own unit.
    Model(Change, f64),
    /// It moves what is read, whatever the robot does.
    Reading(Rc<Moved>),
}

/// How far a unit of a number moves what is read, in the base frame.
pub struct Moved {
    /// Row by row.
    pub rows: Vec<Vector3<f64>>,
    /// What is read after all of them.
    pub later: LaterMoved,
}

/// How far what is read is moved (m), by where the arm has it.
pub type LaterMoved = Box<dyn Fn(&Seen) -> Vector3<f64>>;

/// What is read, as the arm has it, in the base frame.
pub struct Seen {
    /// The point that is read (m).
    pub point: Vector3<f64>,
    /// The tool's axes.
    pub tool: Matrix3<f64>,
}

impl Model {
    /// A description as it is, and the points as the campaign says.
    pub fn new(description: &Description, data: &Positions) -> Self {
        Self {
            description: description.clone(),
            marker: data.measured_at.into(),
            hook: data.payload_at.into(),
            followers: Vec::new(),
        }
    }

    /// The point at each row, in the base frame (m). The payload's weight, against z
    /// of the base frame, takes it where the arm carries it ([`deformed`]); the arm's
    /// own weight does so where the description says so (`gravity_sag`).
    pub fn points(&self, data: &Positions) -> Vec<Vector3<f64>> {
        self.seen(data).into_iter().map(|seen| seen.point).collect()
    }

    /// The same with the tool's axes.
    pub fn seen(&self, data: &Positions) -> Vec<Seen> {
        with_robot!(&self.description, |robot| self.seen_on(&robot, data))
    }

    fn seen_on<const N: usize>(&self, robot: &impl Robot<N>, data: &Positions) -> Vec<Seen> {
        let seen = |row: &PositionRow| {
            let q = self.coordinates(row);
            let tcp = match row.payload {
                0.0 => robot.transform(&q),
                _ => deformed(robot, &q, |tcp| self.weight(tcp, row), &mut robstiff::State::new()).tcp,
            };
            let tool = tcp.fixed_view::<3, 3>(0, 0).into_owned();
            Seen { point: tcp.transform_point(&self.marker.into()).coords, tool }
        };
        data.rows.iter().map(seen).collect()
    }

    /// What the payload, and the arm's own weight before it, put on the gear of each joint,
    /// row by row (Nm or N).
    pub fn torques(&self, data: &Positions) -> Vec<Vec<Torque>> {
        with_robot!(&self.description, |robot| self.torques_on(&robot, data))
    }

    fn torques_on<const N: usize>(&self, robot: &impl Robot<N>, data: &Positions) -> Vec<Vec<Torque>> {
        let torques = |row: &PositionRow| {
            let q = self.coordinates(row);
            let loads = robot.joint_torques(&q, &self.weight(&robot.transform(&q), row));
            robot.preload(&q).iter().zip(&loads).map(|(&preload, &load)| Torque { preload, load }).collect()
        };
        data.rows.iter().map(torques).collect()
    }

    /// The coordinates that the joints of a row have.
    fn coordinates<const N: usize>(&self, row: &PositionRow) -> SVector<f64, N> {
        let mut q = SVector::from_column_slice(&row.q);
        for follower in &self.followers {
            q[follower.joint - 1] += follower.share * (row.q[follower.of - 1] - follower.from);
        }
        q
    }

    /// The wrench of a payload at the TCP, in the base frame (N, Nm).
    fn weight(&self, tcp: &Matrix4<f64>, row: &PositionRow) -> Vector6<f64> {
        let force = Vector3::new(0.0, 0.0, -GRAVITY * row.payload);
        let moment = (tcp.fixed_view::<3, 3>(0, 0) * self.hook).cross(&force);
        Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
    }
}

/// Numbers of a model with their values, and where the robot stands in the frame
/// that positions are read in.
#[derive(Clone, Debug)]
pub struct State {
    /// Where the robot stands.
    pub registration: Registration,
    /// The value of every number; zero for those that are not part of the model.
    pub values: Vec<f64>,
}

impl State {
    /// The model with its numbers.
    pub fn model(&self, start: &Model, numbers: &[Enters]) -> Model {
        let mut model = start.clone();
        for (number, &value) in numbers.iter().zip(&self.values).filter(|(_, value)| **value != 0.0) {
            if let Enters::Model(enters, _) = number {
                enters(&mut model, value);
            }
        }
        model
    }

    /// What moves the reading of a row besides, in the base frame (m).
    pub fn beside(&self, numbers: &[Enters], row: usize) -> Vector3<f64> {
        let of = |(number, &value): (&Enters, &f64)| match number {
            Enters::Reading(moved) => moved.rows[row] * value,
            Enters::Model(..) => Vector3::zeros(),
        };
        numbers.iter().zip(&self.values).filter(|(_, value)| **value != 0.0).map(of).sum()
    }
}
