//! The errors of clamped axes.

use robstiff_identify::campaign::{Campaign, ClampedRow};
use robstiff_identify::identify::without_laws;
use robstiff_identify::trace::Trace;

use super::content::without_effects;
use crate::report::content::PoseError;

/// The errors of every axis, as the report has those of poses (urad or um).
pub fn errors(trace: &Trace, campaign: &Campaign, rows: &[ClampedRow]) -> Vec<PoseError> {
    let less = without_laws(&campaign.robot, rows);
    let declared = |name: &str| {
        let of_axis = less.iter().filter(|row| format!("axis {}", row.axis) == name);
        rms(of_axis.map(|row| row.deflection - campaign.robot.joints[row.axis - 1].compliance() * row.torque))
    };
    // What both descriptions have is taken from the same readings.
    let without = without_effects(trace, &campaign.robot);
    let [with, without] = [&trace.description, &without].map(|robot| without_laws(robot, rows));
    let contribution = |name: &str| {
        let of_axis = with.iter().zip(&without).filter(|(row, _)| format!("axis {}", row.axis) == name);
        rms(of_axis.map(|(with, without)| without.deflection - with.deflection))
    };
    let error = |one: &robstiff_identify::trace::PoseError| PoseError {
        id: one.pose.clone(),
        declared: 1e6 * declared(&one.pose),
        identified: 1e6 * one.before,
        after: 1e6 * one.after,
        contribution: 1e6 * contribution(&one.pose),
        held_out: one.held_out,
        // Of an axis a few of many rows.
        wild: false,
    };
    trace.pose_errors.iter().map(error).collect()
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let squares: Vec<f64> = values.map(|value| value * value).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}
