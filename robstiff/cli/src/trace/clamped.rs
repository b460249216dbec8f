//! What is said of clamped axes: the same sentences and figures, of axes and of
//! angles instead of poses and lengths.

use robstiff::campaign::{Campaign, ClampedRow};
use robstiff::identify::clamped::without_laws;
use robstiff::trace::Trace;
use serde_json::Value;

use crate::report::content::PoseError;

/// Phrases about poses and micrometres, and what they are about clamped axes.
const PHRASES: [(&str, &str); 9] = [
    ("each pose predicted by the fit without it", "each row predicted by the fit without it"),
    ("unseen poses", "unseen rows"),
    ("fitted poses", "fitted rows"),
    (" poses", " axes"),
    (" pose ", " axis "),
    ("a displacement, the difference of two", "a deflection, the difference of two"),
    (" um", " urad"),
    ("[um]", "[urad]"),
    ("\u{b5}m", "\u{b5}rad"),
];

/// A text about poses as one about axes.
pub fn about_axes(text: &str) -> String {
    PHRASES.iter().fold(text.to_owned(), |text, (of_poses, of_axes)| text.replace(of_poses, of_axes))
}

/// The document with angles named as such: `rms_urad` in place of `rms_um`.
pub fn in_angles(document: Value) -> Value {
    match document {
        Value::Object(members) => {
            let named = |name: String| name.strip_suffix("_um").map(|name| format!("{name}_urad")).unwrap_or(name);
            Value::Object(members.into_iter().map(|(name, value)| (named(name), in_angles(value))).collect())
        }
        Value::Array(values) => Value::Array(values.into_iter().map(in_angles).collect()),
        value => value,
    }
}

/// The errors of every axis, as the report has those of poses \[urad\].
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
    };
    trace.pose_errors.iter().map(error).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn lengths_and_poses_become_angles_and_axes() {
        assert_eq!(about_axes("at 3 poses, 12.1 um on unseen poses"), "at 3 axes, 12.1 urad on unseen rows");
        let angles = in_angles(json!({"noise_um": 1, "before": [{"rms_um": 2}], "rows": 3}));
        assert_eq!(angles, json!({"noise_urad": 1, "before": [{"rms_urad": 2}], "rows": 3}));
    }
}
