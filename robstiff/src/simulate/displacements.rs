//! What the robot does under the loads, without noise.

use nalgebra::{Matrix3, Matrix4, Rotation3, SVector, UnitQuaternion, Vector3};
use robstiff_robots::Description;

use super::Scenario;
use crate::campaign::{Displacements, Frame};
use crate::elements::deformed;
use crate::identify::samples::Samples;
use crate::{Robot, State};

/// Sets what an exact instrument reads in every row.
pub fn read(truth: &Description, scenario: &Scenario, data: &mut Displacements) {
    crate::with_robot!(truth, |robot| deflect(&robot, scenario, data));
}

fn deflect<const N: usize>(robot: &impl Robot<N>, scenario: &Scenario, data: &mut Displacements) {
    let samples = Samples::new(robot, data);
    // The rows of a visit are one load sequence, on a robot that was never loaded.
    let (mut state, mut visit) = (State::new(), None);
    for (row, sample) in data.rows.iter_mut().zip(&samples.rows) {
        if visit != Some(row.visit) {
            (state, visit) = (State::new(), Some(row.visit));
        }
        let q = SVector::<f64, N>::from_column_slice(&sample.q);
        let under_load = deformed(robot, &q, |_| sample.wrench, &mut state);
        row.encoders = scenario.encoder_noise.is_some().then(|| (q + under_load.turns).as_slice().to_vec());
        let turned = rotation(&under_load.tcp) * rotation(&sample.tcp).transpose();
        let origin = |tcp: &Matrix4<f64>| tcp.fixed_view::<3, 1>(0, 3).into_owned();
        let moved = origin(&under_load.tcp) - origin(&sample.tcp) + (turned - Matrix3::identity()) * sample.marker;
        let turn: Vector3<f64> =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turned)).scaled_axis();
        let frame: Matrix3<f64> = match data.measured_frame {
            Frame::Base => Matrix3::identity(),
            Frame::Tool => rotation(&sample.tcp).transpose(),
        };
        row.displacement = (frame * moved).into();
        row.rotation = scenario.rotation_noise.is_some().then(|| (frame * turn).into());
    }
}

fn rotation(frame: &Matrix4<f64>) -> Matrix3<f64> {
    frame.fixed_view::<3, 3>(0, 0).into_owned()
}
