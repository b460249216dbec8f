//! What the robot does under the loads, without noise.

use nalgebra::{Matrix3, SVector, Vector3};
use robstiff_robots::Description;
use std::vec::Vec;

use super::Scenario;
use crate::campaign::{Displacements, Frame};
use crate::elements::{parameters, turn};
use crate::identify::samples::{Sample, Samples, turn_of_joint};
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
        let twist = robot.deflection_with(&q, &sample.wrench, &mut state);
        let turn: Vector3<f64> = twist.fixed_rows::<3>(3).into_owned();
        let moved = twist.fixed_rows::<3>(0) + turn.cross(&sample.marker) + beyond.fixed_rows::<3>(i * samples.axes);
        let frame: Matrix3<f64> = match data.measured_frame {
            Frame::Base => Matrix3::identity(),
            Frame::Tool => sample.tcp.fixed_view::<3, 3>(0, 0).transpose(),
        };
        row.displacement = (frame * moved).into();
        row.rotation = scenario.rotation_noise.is_some().then(|| (frame * turn).into());
        row.encoders = scenario.encoder_noise.is_some().then(|| {
            let turns = turns(robot, sample, &state).into_iter().zip(samples.encoders_of(i));
            turns.zip(&row.q).map(|((turn, at), q)| q + turn + beyond[at]).collect()
        });
    }
}

/// By how much each joint turns (rad or m) under the load of a row, to first order,
/// with the state after it.
fn turns<const N: usize>(robot: &impl Robot<N>, sample: &Sample, state: &State<N>) -> [f64; N] {
    let compliance = robot.joint_compliance();
    let torque = |joint: usize| sample.twists[joint - 1].dot(&sample.wrench);
    core::array::from_fn(|i| {
        let joint = i + 1;
        let springs = robot.effects().iter().flat_map(parameters);
        let by_springs: f64 = springs.map(|(spring, value)| value * turn_of_joint(spring, joint, torque)).sum();
        let laws = robot.effects().iter().filter(|effect| effect.row() == Some(joint));
        let by_laws: f64 =
            laws.filter_map(|effect| turn(effect, compliance[i], sample.q[i], torque(joint), state.plays[i])).sum();
        compliance[i] * torque(joint) + by_springs + by_laws
    })
}
