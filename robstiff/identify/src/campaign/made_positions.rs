//! Campaigns of absolute positions for tests, from the model that is fitted to them, with their noise
//! declared: what is tested with them is the statistics, not the mechanics.

use std::format;
use std::vec;
use std::vec::Vec;

use nalgebra::{Isometry3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_robots::Description;

use super::made::campaign;
use super::{Campaign, Data, Noise, PositionRow, Positions};
use crate::observe::position::Position;
use crate::probability::normal;
use robstiff::Effect;

/// What is measured, and how well.
#[derive(Clone)]
pub struct Plan {
    pub robot: Description,
    pub hidden: Vec<Effect>,
    /// By how much the reflector is elsewhere than the file says (m).
    pub marker: [f64; 3],
    pub poses: usize,
    pub visits: usize,
    /// The payloads of each visit (kg).
    pub payloads: Vec<f64>,
    /// One sigma of a reading on each axis (m).
    pub noise: f64,
    /// One sigma of where the robot comes to at each visit (m).
    pub repeatability: f64,
    pub seed: u64,
}

impl Plan {
    pub fn new(robot: Description, seed: u64) -> Self {
        Self {
            robot,
            hidden: Vec::new(),
            marker: [0.0; 3],
            poses: 60,
            visits: 1,
            payloads: vec![0.0],
            noise: 3e-5,
            repeatability: 0.0,
            seed,
        }
    }

    pub fn run(&self) -> Campaign {
        self.run_with(|_, _| {})
    }

    /// Measures; `disturb` changes a row with its exact position, before noise comes
    /// to it.
    pub fn run_with(&self, mut disturb: impl FnMut(usize, &mut PositionRow)) -> Campaign {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let mut data = Positions {
            payload_at: [0.0; 3],
            measured_at: [0.02, -0.03, 0.15],
            poses: (0..self.poses).map(|pose| format!("{pose}")).collect(),
            visits: (0..self.visits * self.poses).map(|visit| format!("{visit}")).collect(),
            rows: Vec::new(),
        };
        let poses: Vec<Vec<f64>> = (0..self.poses)
            .map(|_| self.robot.joints.iter().map(|_| random.random_range(-1.2..1.2)).collect())
            .collect();
        for visit in 0..self.visits * self.poses {
            let pose = visit % self.poses;
            for &payload in &self.payloads {
                let line = data.rows.len() + 2;
                data.rows.push(PositionRow {
                    line,
                    pose,
                    visit,
                    time: Some(60.0 * line as f64),
                    temperature: Some(21.0 - 4.0 * (-(line as f64) / 60.0).exp_m1()),
                    q: poses[pose].clone(),
                    position: [0.0; 3],
                    payload,
                });
            }
        }
        let mut truth = self.robot.clone();
        truth.effects.extend(self.hidden.iter().copied());
        let points = {
            let mut read = data.clone();
            read.measured_at.iter_mut().zip(self.marker).for_each(|(at, off)| *at += off);
            Position::new(&truth, &read).points(&truth)
        };
        let mut three = |sigma: f64| Vector3::from_fn(|_, _| sigma * normal(&mut random));
        let turn = three(1.0);
        let tracker = Isometry3::new(three(3.0), turn);
        let mut comes_to = Vector3::zeros();
        for (i, row) in data.rows.iter_mut().enumerate() {
            if i % self.payloads.len() == 0 {
                comes_to = three(self.repeatability);
            }
            row.position = tracker.transform_point(&(points[i] + comes_to).into()).coords.into();
            disturb(i, row);
            row.position = (Vector3::from(row.position) + three(self.noise)).into();
        }
        let noise = self.noise.hypot(self.repeatability);
        let noise = Noise { displacement: (noise > 0.0).then_some(noise), rotation: None };
        Campaign { noise, ..campaign(self.robot.clone(), Data::Position(data)) }
    }
}
