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
use robstiff::elements::{Part, Rest, at_rest, displacement_at};

/// A second order that is a larger share than this of the linear displacements is of numbers
/// in another unit: no arm that machines comes to a tenth of it.
pub const MOST: f64 = 0.1;

/// Compliances that make displacements so many times as large as they are, or more, are not
/// of the right size: forces in kilograms, or stiffness per arcmin, make them so.
pub const TOO_LARGE: f64 = 2.0;

/// The displacement of the marker (m) and its rotation (rad) through the joints with
/// the load in equilibrium at the moved arm, less the linear ones `J H_q J^T F`;
/// stacked like [`Samples::readings`]. `compliance` holds one number a joint (rad/Nm
/// or m/N). Zero where it is [too much](MOST) in half of the rows, and in rows where it is
/// beyond all numbers.
pub fn beyond_linear(samples: &Samples, compliance: &[f64]) -> DVector<f64> {
    let beyond: Vec<Beyond> = samples.rows.iter().map(|row| of_row(row, compliance)).collect();
    let is_known = 2 * beyond.iter().filter(|of| of.share <= MOST).count() > beyond.len();
    let of = |at: usize| Some(&beyond[at]).filter(|of| is_known && of.share.is_finite());
    samples.stacked_with(
        |at, _| of(at).map_or_else(Vector6::zeros, |of| of.moved),
        |at, k| of(at).map_or(0.0, |of| of.turns[samples.encoders[k] - 1]),
    )
}

/// The second order of a row.
struct Beyond {
    /// Of the marker (m) and its rotation (rad).
    moved: Vector6<f64>,
    /// Of each joint's turn (rad or m).
    turns: Vec<f64>,
    /// Its share of the linear displacement of the marker, both in m: with rotations, in rad,
    /// it would be another one in other units.
    share: f64,
}

fn of_row(row: &Sample, compliance: &[f64]) -> Beyond {
    let joints: Vec<Part> = row.twists.iter().enumerate().map(|(joint, twist)| Part::Joint(joint, *twist)).collect();
    let turned = |torques: &[f64]| torques.iter().zip(compliance).map(|(torque, h)| torque * h).collect();
    let Rest { motion, turns, .. } = at_rest(&joints, |_| row.wrench, turned);
    let first: Vec<f64> = row.twists.iter().zip(compliance).map(|(twist, h)| h * twist.dot(&row.wrench)).collect();
    let linear: Vector6<f64> = row.twists.iter().zip(&first).map(|(twist, turn)| twist * *turn).sum();
    let [shift, turn]: [Vector3<f64>; 2] = [0, 3].map(|from| linear.fixed_rows::<3>(from).into_owned());
    let linear = stack(&(shift + turn.cross(&row.marker)), &turn);
    let moved = displacement_at(&motion, &row.marker) - linear;
    let length = |of: &Vector6<f64>| of.fixed_rows::<3>(0).norm();
    let share = if length(&moved) == 0.0 { 0.0 } else { length(&moved) / length(&linear) };
    Beyond { moved, turns: turns.iter().zip(first).map(|(turn, first)| turn - first).collect(), share }
}

/// The samples with the second order, and what declared laws of joints do, fitted or not,
/// taken from their readings, so that these are linear in the load as far as the
/// description accounts for them. Where its compliances are [too large](TOO_LARGE) by the
/// poses for which `of_pose` holds, the second order is that of such as are not.
pub fn straightened(samples: &Samples, description: &Description, of_pose: impl Fn(usize) -> bool) -> Samples {
    let mut compliance: Vec<f64> = description.joints.iter().map(robstiff_robots::Joint::compliance).collect();
    let size = size(samples, &compliance, of_pose);
    if size * TOO_LARGE < 1.0 {
        compliance.iter_mut().for_each(|compliance| *compliance *= size);
    }
    let mut beyond = beyond_linear(samples, &compliance);
    for number in declared(description).into_iter().filter(|number| number.column.is_law()) {
        beyond.axpy(number.value, &samples.column(number.column), 1.0);
    }
    samples.clone().less(&beyond)
}

/// How many times as large displacements are as joints of such compliances make them: the
/// median of the rows, which an outlying one does not move; 0 where they go the other way.
fn size(samples: &Samples, compliance: &[f64], of_pose: impl Fn(usize) -> bool) -> f64 {
    let of_row = |row: &Sample| {
        let linear: Vector6<f64> = row.twists.iter().zip(compliance).map(|(s, h)| s * (h * s.dot(&row.wrench))).sum();
        let turn: Vector3<f64> = linear.fixed_rows::<3>(3).into_owned();
        let moved = linear.fixed_rows::<3>(0) + turn.cross(&row.marker);
        let length = moved.norm();
        (length > 0.0).then(|| row.displacement.dot(&(moved / length)) / length)
    };
    let rows = samples.rows.iter().filter(|row| of_pose(row.pose));
    let mut sizes: Vec<f64> = rows.filter_map(of_row).collect();
    let middle = sizes.len() / 2;
    if sizes.is_empty() { 1.0 } else { sizes.select_nth_unstable_by(middle, f64::total_cmp).1.max(0.0) }
}
