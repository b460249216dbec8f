//! The errors of clamped axes.

use robstiff::campaign::{Campaign, ClampedRow};
use robstiff::identify::without_laws;
use robstiff::trace::Trace;

use crate::report::content::PoseError;

/// The errors of every axis, as the report has those of poses (urad or um).
pub fn errors(trace: &Trace, campaign: &Campaign, rows: &[ClampedRow]) -> Vec<PoseError> {
    let less = without_laws(&campaign.robot, rows);
    let declared = |name: &str| {
        let of_axis = less.iter().filter(|row| format!("axis {}", row.axis) == name);
        let squares: Vec<f64> = of_axis
            .map(|row| (row.deflection - campaign.robot.joints[row.axis - 1].compliance() * row.torque).powi(2))
            .collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    };
    let error = |one: &robstiff::trace::PoseError| PoseError {
        id: one.pose.clone(),
        declared: 1e6 * declared(&one.pose),
        identified: 1e6 * one.before,
        after: 1e6 * one.after,
        contribution: 1e6 * (one.before.powi(2) - one.after.powi(2)).max(0.0).sqrt(),
        held_out: one.held_out,
        // Of an axis a few of many rows.
        wild: false,
    };
    trace.pose_errors.iter().map(error).collect()
}
