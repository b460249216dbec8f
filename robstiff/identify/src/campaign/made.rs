//! Campaigns for tests, of the model that is fitted to them: what is tested with them is the statistics,
//! not the mechanics.

use std::format;
use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use nalgebra::{DVector, Matrix3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_robots::Description;

use super::{Campaign, Data, Displacements, Frame, Noise, Observation as Row};
use crate::model::Arm;
use crate::observe::displacement::Displacement;
use crate::observe::{Observation, as_declared};
use crate::probability::normal;
use robstiff::Effect;
use robstiff_robots::samples::five_axis;

/// What is measured, and how well.
#[derive(Clone)]
pub struct Plan {
    pub robot: Description,
    /// What the description lacks.
    pub hidden: Vec<Effect>,
    pub poses: usize,
    pub visits: usize,
    /// The loads of a visit as shares of its greatest.
    pub ramp: Vec<f64>,
    /// Every second visit of a pose pulls the other way than the one before.
    pub there_and_back: bool,
    /// The direction of every load; none: another in every visit.
    pub line: Option<Vector3<f64>>,
    /// What acts where the file says this force (N).
    pub acts: fn(Vector3<f64>) -> Vector3<f64>,
    /// One sigma of a reading on each axis (m).
    pub noise: [f64; 3],
    /// The same of rotations (rad), where they are read.
    pub rotation_noise: Option<[f64; 3]>,
    /// Whether the rows of a visit share an unloaded reading.
    pub shares_unloaded: bool,
    /// The frame of displacements, in which the noise is.
    pub measured_frame: Frame,
    /// The points of load and reading, in the tool frame (m).
    pub at: [[f64; 3]; 2],
    pub seed: u64,
}

impl Plan {
    pub fn new(seed: u64) -> Self {
        Self {
            robot: five_axis(),
            hidden: Vec::new(),
            poses: 40,
            visits: 2,
            ramp: vec![0.35, 0.7, 1.0, 0.7, 0.35],
            there_and_back: false,
            line: None,
            acts: |force| force,
            noise: [1e-5; 3],
            rotation_noise: None,
            shares_unloaded: true,
            measured_frame: Frame::Base,
            at: [[0.0; 3]; 2],
            seed,
        }
    }

    pub fn run(&self) -> Campaign {
        self.run_with(|_, _| {})
    }

    /// Measures; `disturb` changes a row with its exact reading, in the base
    /// frame, before noise comes to it.
    pub fn run_with(&self, mut disturb: impl FnMut(usize, &mut Row)) -> Campaign {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let mut data = self.loaded(&mut random);
        let exact = self.exact(&data);
        let axes = if self.rotation_noise.is_some() { 6 } else { 3 };
        for (i, row) in data.rows.iter_mut().enumerate() {
            row.displacement = core::array::from_fn(|k| exact[axes * i + k]);
            row.rotation = row.rotation.map(|_| core::array::from_fn(|k| exact[axes * i + 3 + k]));
            disturb(i, row);
        }
        self.read(&mut data, &mut random);
        campaign(self.robot.clone(), Data::Displacement(data))
    }

    /// The rows with their poses and loads.
    fn loaded(&self, random: &mut ChaCha8Rng) -> Displacements {
        let mut data = Displacements {
            wrench_frame: Frame::Base,
            wrench_at: self.at[0],
            measured_frame: Frame::Base,
            directions: super::AXES.to_vec(),
            measured_at: self.at[1],
            poses: (0..self.poses).map(|pose| format!("{pose}")).collect(),
            visits: (0..self.visits * self.poses).map(|visit| format!("{visit}")).collect(),
            rows: Vec::new(),
        };
        let mut force = [0.0; 3];
        for visit in 0..self.visits * self.poses {
            let (pose, of_pose) = (visit / self.visits, visit % self.visits);
            let q = match of_pose {
                0 => self.robot.joints.iter().map(|_| random.random_range(-1.2..1.2)).collect(),
                _ => data.rows[data.rows.len() - 1].q.clone(),
            };
            force = if self.there_and_back && of_pose % 2 == 1 {
                force.map(|component: f64| -component)
            } else {
                let drawn = Vector3::from_fn(|_, _| normal(random));
                let direction = self.line.unwrap_or(drawn).normalize();
                (direction * random.random_range(500.0..1300.0)).into()
            };
            for share in &self.ramp {
                let line = data.rows.len() + 2;
                data.rows.push(Row {
                    line,
                    pose,
                    visit,
                    time: Some(60.0 * line as f64),
                    temperature: Some(21.0 - 4.0 * (-(line as f64) / 120.0).exp_m1()),
                    q: q.clone(),
                    wrench: [share * force[0], share * force[1], share * force[2], 0.0, 0.0, 0.0],
                    displacement: [0.0; 3],
                    rotation: self.rotation_noise.map(|_| [0.0; 3]),
                    encoders: None,
                    motors: None,
                });
            }
        }
        data
    }

    /// What the rows are exactly, in the base frame, stacked (m, rad).
    fn exact(&self, data: &Displacements) -> DVector<f64> {
        let mut acting = data.clone();
        for row in &mut acting.rows {
            let [x, y, z, mx, my, mz] = row.wrench;
            let [x, y, z] = (self.acts)(Vector3::new(x, y, z)).into();
            row.wrench = [x, y, z, mx, my, mz];
        }
        let mut truth = self.robot.clone();
        truth.effects.extend(self.hidden.iter().copied());
        let observation = Displacement::new(&truth, &acting);
        as_declared(&observation, observation.world(), &truth)
    }

    /// Turns exact rows into the frame they are read in, and adds noise.
    fn read(&self, data: &mut Displacements, random: &mut ChaCha8Rng) {
        let arm = Arm::of(&self.robot);
        let mut unloaded = [[0.0; 3]; 2];
        for (i, row) in data.rows.iter_mut().enumerate() {
            let turn = match self.measured_frame {
                Frame::Base => Matrix3::identity(),
                Frame::Tool => arm.stand(&row.q, &[]).tcp.turn.transpose(),
            };
            let mut reading = || {
                let turns = self.rotation_noise.unwrap_or_default();
                [self.noise, turns].map(|sigma| sigma.map(|sigma| sigma * normal(random)))
            };
            if i % self.ramp.len() == 0 || !self.shares_unloaded {
                unloaded = reading();
            }
            let loaded = reading();
            let noisy = |exact: [f64; 3], kind: usize| -> [f64; 3] {
                let turned = turn * Vector3::from(exact);
                core::array::from_fn(|k| turned[k] + loaded[kind][k] - unloaded[kind][k])
            };
            row.displacement = noisy(row.displacement, 0);
            row.rotation = row.rotation.map(|rotation| noisy(rotation, 1));
        }
        data.measured_frame = self.measured_frame;
    }
}

/// A campaign with nothing declared.
pub fn campaign(robot: Description, data: Data) -> Campaign {
    Campaign {
        name: "made".to_string(),
        date: String::new(),
        operator: String::new(),
        path: "".into(),
        robot_path: "".into(),
        observations_path: "".into(),
        robot,
        data,
        noise: Noise::default(),
        holdout: None,
        held_out: Vec::new(),
        warnings: Vec::<String>::new(),
    }
}

/// The displacements of a campaign made here.
pub fn displacements(campaign: &Campaign) -> &Displacements {
    match &campaign.data {
        Data::Displacement(data) => data,
        Data::Position(_) | Data::Clamped(_) => unreachable!("made of displacements"),
    }
}
