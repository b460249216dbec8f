//! What loads the arm and what reads it.

use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3, Vector6};

use super::arm::{Frame, turn_by};
use crate::campaign;

/// The rig. What the file says of it is given; all else is what is wrong with it, and zero as
/// declared.
#[derive(Clone, Debug)]
pub struct Rig {
    /// The frame of forces and moments.
    pub wrench_frame: campaign::Frame,
    /// Where they act, in the tool frame (m).
    pub wrench_at: Vector3<f64>,
    /// The frame of what is read.
    pub measured_frame: campaign::Frame,
    /// The point that is read, in the tool frame (m).
    pub measured_at: Vector3<f64>,
    /// Where the load acts beside that point, in the tool frame (m).
    pub lever: Vector3<f64>,
    /// Where the reading is taken beside the point that the file says, in the tool frame (m).
    pub reflector: Vector3<f64>,
    /// The turn of the force (rad), in the base frame and in the tool frame.
    pub force_turn: [Vector3<f64>; 2],
    /// What the force is off by (N), likewise.
    pub force_bias: [Vector3<f64>; 2],
    /// By which share of itself each of its components is off, likewise.
    pub force_scale: [Vector3<f64>; 2],
    /// The turn of the readings (rad), in the base frame and in the tool frame.
    pub reading_turn: [Vector3<f64>; 2],
    /// By which share of itself a reading is off.
    pub reading_scale: f64,
    /// Where the robot stands in the frame of what reads absolute positions.
    pub stand: Isometry3<f64>,
    /// A small turn (rad) of that about [`middle`](Self::middle), and a small shift (m).
    pub stand_off: [Vector3<f64>; 2],
    /// About the middle of all readings (m).
    pub middle: Vector3<f64>,
}

/// What is in the base frame, and what is in the tool frame.
pub const BASE: usize = 0;
/// See [`BASE`].
pub const TOOL: usize = 1;

impl Rig {
    /// A rig as the file says.
    pub fn declared(wrench: (campaign::Frame, [f64; 3]), measured: (campaign::Frame, [f64; 3])) -> Self {
        let none = [Vector3::zeros(); 2];
        Self {
            wrench_frame: wrench.0,
            wrench_at: Vector3::from(wrench.1),
            measured_frame: measured.0,
            measured_at: Vector3::from(measured.1),
            lever: Vector3::zeros(),
            reflector: Vector3::zeros(),
            force_turn: none,
            force_bias: none,
            force_scale: none,
            reading_turn: none,
            reading_scale: 0.0,
            stand: Isometry3::identity(),
            stand_off: none,
            middle: Vector3::zeros(),
        }
    }

    /// The wrench at the tool centre point in the base frame (N, Nm) for what the file says of it.
    ///
    /// `f = turn ((1 + scale) f_file) + bias`, first in the base frame, then in the tool frame.
    pub fn wrench(&self, tcp: &Frame, file: &[f64; 6]) -> Vector6<f64> {
        let read = |k: usize| Vector3::new(file[k], file[k + 1], file[k + 2]);
        let into_base = match self.wrench_frame {
            campaign::Frame::Base => Matrix3::identity(),
            campaign::Frame::Tool => tcp.turn,
        };
        let (mut force, moment) = (into_base * read(0), into_base * read(3));
        for (frame, turn) in [(BASE, Matrix3::identity()), (TOOL, tcp.turn)] {
            if [&self.force_turn, &self.force_bias, &self.force_scale].iter().all(|of| is_zero(&of[frame])) {
                continue;
            }
            let inside = turn.transpose() * force;
            let scaled = inside + inside.component_mul(&self.force_scale[frame]);
            force = turn * (turn_by(&self.force_turn[frame]) * scaled + self.force_bias[frame]);
        }
        let arm = tcp.turn * (self.wrench_at + self.lever);
        let moment = moment + arm.cross(&force);
        Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
    }

    /// From the tool centre point to the point that is read, in the base frame (m).
    pub fn marker(&self, tcp: &Frame) -> Vector3<f64> {
        tcp.turn * (self.measured_at + self.reflector)
    }

    /// A displacement `[d; r]` of that point in the base frame as it is read in the frame of the
    /// file; `declared` is the tool as the controller knows it.
    pub fn seen(&self, twist: &Vector6<f64>, tcp: &Frame, declared: &Frame) -> Vector6<f64> {
        let turns = |vector: &Vector3<f64>| {
            if self.reading_turn.iter().all(is_zero) {
                return *vector;
            }
            let in_tool = tcp.turn * turn_by(&self.reading_turn[TOOL]) * tcp.turn.transpose();
            turn_by(&self.reading_turn[BASE]) * (in_tool * vector)
        };
        let see = |from: usize| turns(&twist.fixed_rows::<3>(from).into_owned()) * (1.0 + self.reading_scale);
        let (d, r) = (self.as_filed(&see(0), declared), self.as_filed(&see(3), declared));
        Vector6::new(d.x, d.y, d.z, r.x, r.y, r.z)
    }

    /// A vector of the base frame in the frame that the file has readings in; `declared` is the tool as
    /// the controller knows it.
    pub fn as_filed(&self, vector: &Vector3<f64>, declared: &Frame) -> Vector3<f64> {
        match self.measured_frame {
            campaign::Frame::Base => *vector,
            campaign::Frame::Tool => declared.turn.transpose() * vector,
        }
    }

    /// The converse of [`as_filed`](Self::as_filed).
    pub fn in_base(&self, filed: &Vector3<f64>, declared: &Frame) -> Vector3<f64> {
        match self.measured_frame {
            campaign::Frame::Base => *filed,
            campaign::Frame::Tool => declared.turn * filed,
        }
    }

    /// A point of the base frame in the frame of what reads absolute positions (m).
    pub fn position(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let [turn, shift] = &self.stand_off;
        let stood = self.stand * nalgebra::Point3::from(*point);
        let moved = self.middle + turn_by(turn) * (stood.coords - self.middle) + shift;
        self.middle + (moved - self.middle) * (1.0 + self.reading_scale)
    }

    /// A direction of the base frame likewise.
    pub fn direction(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        turn_by(&self.stand_off[0]) * (self.stand.rotation * vector) * (1.0 + self.reading_scale)
    }

    /// Takes the small turn and shift into where the robot stands, and leaves none.
    pub fn absorb(&mut self) {
        let [turn, shift] = self.stand_off;
        let about = Translation3::from(self.middle + shift)
            * UnitQuaternion::from_scaled_axis(turn)
            * Translation3::from(-self.middle);
        self.stand = about * self.stand;
        self.stand.rotation.renormalize();
        self.stand_off = [Vector3::zeros(); 2];
    }
}

/// Most of what may be wrong with a rig is zero, and is asked at every row.
fn is_zero(vector: &Vector3<f64>) -> bool {
    vector.iter().all(|x| *x == 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stand_that_is_absorbed_is_the_same() {
        let mut rig = Rig::declared((campaign::Frame::Base, [0.0; 3]), (campaign::Frame::Base, [0.0; 3]));
        rig.middle = Vector3::new(1.0, -2.0, 0.5);
        rig.stand = Isometry3::new(Vector3::new(0.3, 0.1, -0.2), Vector3::new(0.4, -0.2, 2.0));
        rig.stand_off = [Vector3::new(0.01, -0.02, 0.03), Vector3::new(0.1, 0.2, -0.1)];
        let point = Vector3::new(0.7, 0.8, 1.9);
        let before = rig.position(&point);
        rig.absorb();
        assert!((rig.position(&point) - before).norm() < 1e-14);
    }
}
