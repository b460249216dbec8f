//! What the robot does under the loads, without noise.

use nalgebra::{Matrix3, SVector, Vector3};
use robstiff_robots::Description;
use std::vec::Vec;

use super::Scenario;
use crate::campaign::{Displacements, Frame};
use crate::elements::joint_turns;
use crate::identify::samples::Samples;
use crate::identify::second_order::beyond_linear;
use crate::{Robot, State};

/// Sets what an exact instrument reads in every row.
pub fn read(truth: &Description, scenario: &Scenario, data: &mut Displacements) {
    crate::with_robot!(truth, |robot| deflect(&robot, scenario, data));
}

fn deflect<const N: usize>(robot: &impl Robot<N>, scenario: &Scenario, data: &mut Displacements) {
    let mut samples = Samples::new(robot, data);
    if scenario.encoder_noise.is_some() {
        samples.encoders = (1..=N).collect();
    }
    let compliance: Vec<f64> = robot.joint_compliance().iter().copied().collect();
    let beyond = beyond_linear(&samples, &compliance);
    // The rows of a visit are one load sequence, on a robot that was never loaded.
    let (mut state, mut visit) = (State::new(), None);
    for (i, (row, sample)) in data.rows.iter_mut().zip(&samples.rows).enumerate() {
        if visit != Some(row.visit) {
            (state, visit) = (State::new(), Some(row.visit));
        }
        let q = SVector::<f64, N>::from_column_slice(&sample.q);
        row.encoders = scenario.encoder_noise.is_some().then(|| {
            let read = q + joint_turns(robot, &q, &sample.wrench, &state);
            read.iter().zip(samples.encoders_of(i)).map(|(read, at)| read + beyond[at]).collect()
        });
        let twist = robot.deflection_with(&q, &sample.wrench, &mut state);
        let turn: Vector3<f64> = twist.fixed_rows::<3>(3).into_owned();
        let moved = twist.fixed_rows::<3>(0) + turn.cross(&sample.marker) + beyond.fixed_rows::<3>(i * samples.axes);
        let frame: Matrix3<f64> = match data.measured_frame {
            Frame::Base => Matrix3::identity(),
            Frame::Tool => sample.tcp.fixed_view::<3, 3>(0, 0).transpose(),
        };
        row.displacement = (frame * moved).into();
        row.rotation = scenario.rotation_noise.is_some().then(|| (frame * turn).into());
    }
}
