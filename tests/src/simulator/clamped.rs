//! Axes loaded one by one, those before each clamped, as a user would write them
//! down: a moment turns the tool about the axis that is let go, and how far is
//! read from the tool.

use std::fmt::Write as _;

use nalgebra::Vector3;
use rand::RngExt;
use robstiff_robots::Description;

use super::noise::{Stream, normal};
use super::rig::Creep;
use super::{Arm, Hidden, Moment};

/// A campaign of clamped axes.
#[derive(Clone, Debug)]
pub struct Axes {
    /// The arm as it is.
    pub truth: Description,
    /// What else there is: of the joints, creep, and of the rig what `torque_bias`,
    /// `drift`, `wild` and `slips` say.
    pub hidden: Vec<Hidden>,
    /// The torques on every axis, in order, as shares of the largest.
    pub ramp: Vec<f64>,
    /// The largest torque on axes 1 to 3, and on the others (Nm).
    pub largest: [f64; 2],
    /// Of one reading (rad); a deflection is the difference of two.
    pub noise: f64,
    /// What acts besides the torque that is read (Nm).
    pub torque_bias: f64,
    /// What readings wander off by from row to row (rad).
    pub drift: f64,
    /// Rows, from 0, that are off by an angle (rad).
    pub wild: Vec<(usize, f64)>,
    /// Rows, from 0, before which the clamp of their axis slips by an angle (rad).
    pub slips: Vec<(usize, f64)>,
    /// Seed of everything random.
    pub seed: u64,
}

impl Axes {
    /// Two loops up, down, and to the other side, in eleven steps and nine, of
    /// which some are small: 20 rows an axis.
    pub fn new(truth: Description, seed: u64) -> Self {
        let first = [0.02, 0.1, 0.3, 0.6, 1.0, 0.7, 0.3, 0.05, -0.05, -0.3, -1.0];
        let second = [-0.6, -0.2, 0.03, 0.2, 0.5, 0.8, 0.4, 0.1, -0.1];
        Self {
            truth,
            hidden: Vec::new(),
            ramp: first.into_iter().chain(second).collect(),
            largest: [1500.0, 300.0],
            noise: 2e-6,
            torque_bias: 0.0,
            drift: 0.0,
            wild: Vec::new(),
            slips: Vec::new(),
            seed,
        }
    }

    /// The table of all axes.
    ///
    /// # Panics
    /// Where an axis does not turn.
    pub fn table(&self) -> String {
        let (mut noise, mut poses) = (Stream::Noise.of(self.seed), Stream::Poses.of(self.seed));
        let mut table = String::from("axis,torque [Nm],deflection [urad]\n");
        let joints = self.truth.joints.len();
        let mut row = 0;
        for axis in 1..=joints {
            let mut clamped = self.truth.clone();
            for (_, joint) in clamped.joints.iter_mut().enumerate().filter(|(index, _)| index + 1 != axis) {
                joint.compliance.clear();
            }
            let here = |hidden: &&Hidden| hidden.place() == format!("joint {axis}");
            let arm = self.hidden.iter().filter(here).fold(Arm::new(&clamped, &[]), Arm::hiding);
            let q: Vec<f64> = (0..joints).map(|_| poses.random_range(-0.9..0.9)).collect();
            let posed = arm.at(&q);
            // About the loaded axis, whichever way that is at this pose.
            let turned = Vector3::from(posed.settle(&[0.0, 0.0, 0.0, 60.0, 50.0, 70.0]).rotation);
            let along = turned.normalize();
            let (mut memory, mut creep) = (posed.rested(), Creep::new(&self.hidden));
            let first = row;
            let unloaded = self.noise * normal(&mut noise);
            for (count, share) in self.ramp.iter().enumerate() {
                let torque = share * self.largest[usize::from(axis > 3)];
                let moment = along * (torque + self.torque_bias);
                let settled = posed.settle_after(
                    &[0.0, 0.0, 0.0, moment.x, moment.y, moment.z],
                    &mut memory,
                    Moment { held: 60.0, warmer: 0.0 },
                );
                let moved = Vector3::from(settled.rotation);
                let (since, time) = (60.0 * count as f64, 60.0 * (count + 1) as f64);
                let grown = creep.as_mut().map_or_else(Vector3::zeros, |creep| creep.adds(&moved, since, time));
                let wild: f64 = self.wild.iter().filter(|(at, _)| *at == row).map(|(_, off)| off).sum();
                let slipped = self.slips.iter().filter(|(at, _)| (first..=row).contains(at));
                let slipped: f64 = slipped.map(|(_, off)| off).sum();
                let wandered = self.drift * (count + 1) as f64;
                let read = along.dot(&(moved + grown)) + wandered + wild + slipped + self.noise * normal(&mut noise)
                    - unloaded;
                writeln!(table, "{axis},{torque},{}", 1e6 * read).expect("a text");
                row += 1;
            }
        }
        table
    }
}
