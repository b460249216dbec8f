//! What a compliance matrix leaves out at large loads: the arm has moved when
//! it carries the load, so levers and directions are those of the moved arm.
//!
//! At 800 N this is some 0.1-0.2 % of the displacement, a few micrometres: too
//! little to model, enough to look like an effect in a good campaign. The
//! tests therefore see readings from which the part due to the joints, which
//! carry most of the compliance, has been taken.

use std::vec::Vec;

use nalgebra::{DVector, Vector3, Vector6};
use robstiff_robots::Description;

use super::baseline::declared;
use super::samples::{Sample, Samples, stack};
use crate::elements::{Part, Rest, at_rest, displacement_at};

/// The displacement of the marker (m) and its rotation (rad) through the joints with
/// the load in equilibrium at the moved arm, less the linear ones `J H_q J^T F`;
/// stacked like [`Samples::readings`]. `compliance` holds one number a joint (rad/Nm
/// or m/N).
pub fn beyond_linear(samples: &Samples, compliance: &[f64]) -> DVector<f64> {
    let beyond: Vec<(Vector6<f64>, Vec<f64>)> = samples.rows.iter().map(|row| of_row(row, compliance)).collect();
    samples.stacked_with(|at, _| beyond[at].0, |at, k| beyond[at].1[samples.encoders[k] - 1])
}

/// Of one row, with the part of each joint's turn.
fn of_row(row: &Sample, compliance: &[f64]) -> (Vector6<f64>, Vec<f64>) {
    let joints: Vec<Part> = row.twists.iter().enumerate().map(|(joint, twist)| Part::Joint(joint, *twist)).collect();
    let turned = |torques: &[f64]| torques.iter().zip(compliance).map(|(torque, h)| torque * h).collect();
    let Rest { motion, turns, .. } = at_rest(&joints, |_| row.wrench, turned);
    let first: Vec<f64> = row.twists.iter().zip(compliance).map(|(twist, h)| h * twist.dot(&row.wrench)).collect();
    let linear: Vector6<f64> = row.twists.iter().zip(&first).map(|(twist, turn)| twist * *turn).sum();
    let [shift, turn]: [Vector3<f64>; 2] = [0, 3].map(|from| linear.fixed_rows::<3>(from).into_owned());
    let six = displacement_at(&motion, &row.marker) - stack(&(shift + turn.cross(&row.marker)), &turn);
    (six, turns.iter().zip(first).map(|(turn, first)| turn - first).collect())
}

/// The samples with the second order, and what declared laws of joints do, fitted or not,
/// taken from their readings, so that these are linear in the load as far as the
/// description, whose compliances are of about the right size, accounts for them.
pub fn straightened(samples: &Samples, description: &Description) -> Samples {
    let compliance: Vec<f64> = description.joints.iter().map(robstiff_robots::Joint::compliance).collect();
    let mut beyond = beyond_linear(samples, &compliance);
    for number in declared(description).into_iter().filter(|number| number.column.is_law()) {
        beyond.axpy(number.value, &samples.column(number.column), 1.0);
    }
    samples.clone().less(&beyond)
}
