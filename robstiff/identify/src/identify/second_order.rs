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
use super::samples::Samples;
use crate::observe::equilibrium::Beyond;

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
    // By its share of the linear displacement, both in m: with rotations, in rad, it would be another
    // one in other units.
    let of_row = |row: usize| {
        let beyond = samples.beyond_linear(row, compliance);
        let length = beyond.moved.fixed_rows::<3>(0).norm();
        (if length == 0.0 { 0.0 } else { length / linear(samples, row, compliance).norm() }, beyond)
    };
    let beyond: Vec<(f64, Beyond)> = (0..samples.rows.len()).map(of_row).collect();
    let is_known = 2 * beyond.iter().filter(|(share, _)| *share <= MOST).count() > beyond.len();
    let of = |at: usize| Some(&beyond[at]).filter(|(share, _)| is_known && share.is_finite()).map(|(_, of)| of);
    samples.stacked_with(
        |at, _| of(at).map_or_else(Vector6::zeros, |of| of.moved),
        |at, k| of(at).map_or(0.0, |of| of.turns[samples.encoders[k] - 1]),
    )
}

/// The linear displacement of the marker by joints of such compliances (m).
fn linear(samples: &Samples, row: usize, compliance: &[f64]) -> Vector3<f64> {
    let (twists, sample) = (samples.twists(row), &samples.rows[row]);
    let twist: Vector6<f64> = twists.iter().zip(compliance).map(|(s, h)| s * (h * s.dot(&sample.wrench))).sum();
    sample.read(&twist).fixed_rows::<3>(0).into_owned()
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
    let of_row = |row: usize| {
        let moved = linear(samples, row, compliance);
        let length = moved.norm();
        (length > 0.0).then(|| samples.rows[row].displacement.dot(&(moved / length)) / length)
    };
    let rows = (0..samples.rows.len()).filter(|&row| of_pose(samples.rows[row].pose));
    let mut sizes: Vec<f64> = rows.filter_map(of_row).collect();
    let middle = sizes.len() / 2;
    if sizes.is_empty() { 1.0 } else { sizes.select_nth_unstable_by(middle, f64::total_cmp).1.max(0.0) }
}
