//! A correction that is no physics, for people and for programs.

use robstiff_identify::trace::{Correction, Trace};
use serde_json::{Value, json};

use crate::json::{number, numbers};
use crate::text::{count, micrometres};

/// What came of looking for one.
pub fn sentence(found: Option<&Correction>) -> String {
    match found {
        Some(found) => format!(
            "A correction that is no physics, smooth functions of pose and load, would bring the error on {} that took \
             no part in it from {} to {} um; it explains nothing, is in `correction.json`, and is not part of the robot.",
            count(found.judged_on, "pose"),
            micrometres(found.unseen[0]),
            micrometres(found.unseen[1])
        ),
        None => "No correction: smooth functions of pose and load do not predict unseen poses better.".to_owned(),
    }
}

/// `correction.json`.
pub fn document(found: &Correction, trace: &Trace) -> Value {
    json!({
        "robot": trace.robot,
        "is_physics": false,
        "displacement": "to be added: each joint's Jacobian column times its torque times the sum of weights times features; a torque counts in its largest",
        "features": found.features,
        "weights": numbers(found.weights.iter().copied()),
        "ridge": number(found.ridge),
        "unseen_rms_um": {"without": number(1e6 * found.unseen[0]), "with": number(1e6 * found.unseen[1])},
        "judged_on_poses": found.judged_on,
        "q_range": found.range.iter().map(|range| numbers(*range)).collect::<Value>(),
        "largest_force_N": number(found.largest_force),
        "largest_torques": numbers(found.largest_torques.iter().copied()),
    })
}
