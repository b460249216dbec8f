//! What a compliance matrix leaves out at large loads: the arm has moved when
//! it carries the load, so levers and directions are those of the moved arm.
//!
//! At 800 N this is some 0.1-0.2 % of the displacement, a few micrometres: too
//! little to model, enough to look like an effect in a good campaign. The
//! tests therefore see readings from which the part due to the joints, which
//! carry most of the compliance, has been taken.

use std::vec::Vec;

use nalgebra::{DVector, Rotation3, Unit, Vector3, Vector6};
use robstiff_robots::Description;

use super::laws::turned_by_laws;
use super::samples::{Sample, Samples};
use crate::JointKind;

/// The moved arm is closer to its equilibrium by a factor of some 1e-3 with
/// each pass; after two what is left is far below a nanometre.
const PASSES: usize = 2;

/// The displacement of the marker through the joints with the load in
/// equilibrium at the moved arm, less the linear one `J H_q J^T F`; stacked
/// like [`Samples::readings`], zero for rotations (their second order, some
/// microradians, is below every sensor's noise). `compliance` holds one number
/// a joint (rad/Nm or m/N).
pub fn beyond_linear(samples: &Samples, compliance: &[f64]) -> DVector<f64> {
    let moves = |row: &Sample| {
        let still = std::vec![0.0; compliance.len()];
        let first = yielding(samples, row, compliance, &still);
        let linear: Vector3<f64> = (0..compliance.len())
            .map(|joint| {
                let (axis, through) = axis_of(row, joint);
                match samples.joint_kinds[joint] {
                    JointKind::Revolute => axis.cross(&(marker(row) - through)) * first[joint],
                    JointKind::Prismatic => axis * first[joint],
                }
            })
            .sum();
        let mut moved = first.clone();
        for _ in 0..PASSES {
            moved = yielding(samples, row, compliance, &moved);
        }
        (first, moved, linear)
    };
    let by_tool = |row: &Sample| {
        let (_, moved, linear) = moves(row);
        let full = carried(samples, row, &moved, compliance.len(), marker(row)) - marker(row);
        let mut six = Vector6::zeros();
        six.fixed_rows_mut::<3>(0).copy_from(&(full - linear));
        six
    };
    let beyond: Vec<Vec<f64>> = match samples.encoders.is_empty() {
        true => Vec::new(),
        false => {
            let of_row = |row| {
                let (first, moved, _) = moves(row);
                moved.iter().zip(first).map(|(moved, first)| moved - first).collect()
            };
            samples.rows.iter().map(of_row).collect()
        }
    };
    samples.stacked_with(|_, row| by_tool(row), |at, k| beyond[at][samples.encoders[k] - 1])
}

/// The samples with the second order, and what declared laws of joints do, taken
/// from their readings, so that these are linear in the load as far as the
/// description, whose compliances are of about the right size, accounts for them.
pub fn straightened(samples: &Samples, description: &Description) -> Samples {
    let compliance: Vec<f64> = description.joints.iter().map(robstiff_robots::Joint::compliance).collect();
    let beyond = beyond_linear(samples, &compliance) + turned_by_laws(description, samples);
    samples.clone().less(&beyond)
}

/// The joints' deflections under the load when they have already moved.
fn yielding(samples: &Samples, row: &Sample, compliance: &[f64], moved: &[f64]) -> std::vec::Vec<f64> {
    let force: Vector3<f64> = row.wrench.fixed_rows::<3>(0).into_owned();
    let moment: Vector3<f64> = row.wrench.fixed_rows::<3>(3).into_owned();
    let tcp = row.tcp.fixed_view::<3, 1>(0, 3).into_owned();
    let tcp = carried(samples, row, moved, compliance.len(), tcp);
    let torque = |joint: usize| {
        let (axis, through) = axis_of(row, joint);
        // The joints before it carry an axis along.
        let tip = carried(samples, row, moved, joint, through + axis);
        let through = carried(samples, row, moved, joint, through);
        let axis = tip - through;
        match samples.joint_kinds[joint] {
            JointKind::Revolute => axis.dot(&((tcp - through).cross(&force) + moment)),
            JointKind::Prismatic => axis.dot(&force),
        }
    };
    (0..compliance.len()).map(|joint| compliance[joint] * torque(joint)).collect()
}

/// Where a point behind the first `joints` joints goes when they move: the
/// product of exponentials about the axes of the unloaded arm.
fn carried(samples: &Samples, row: &Sample, moved: &[f64], joints: usize, point: Vector3<f64>) -> Vector3<f64> {
    (0..joints).rev().fold(point, |point, joint| {
        let (axis, through) = axis_of(row, joint);
        match samples.joint_kinds[joint] {
            JointKind::Revolute => {
                let turn = Rotation3::from_axis_angle(&Unit::new_unchecked(axis), moved[joint]);
                through + turn * (point - through)
            }
            JointKind::Prismatic => point + axis * moved[joint],
        }
    })
}

fn marker(row: &Sample) -> Vector3<f64> {
    row.tcp.fixed_view::<3, 1>(0, 3) + row.marker
}

fn axis_of(row: &Sample, joint: usize) -> (Vector3<f64>, Vector3<f64>) {
    let frame = &row.joint_frames[joint];
    (frame.fixed_view::<3, 1>(0, 2).into_owned(), frame.fixed_view::<3, 1>(0, 3).into_owned())
}
