//! The JSON Schema of a scenario.

use robstiff_robots::quantity::Dimension;
use robstiff_robots::schema::{
    Sign, default, described, document, effects, either, list, object, quantity, some, text, whole, word,
};
use serde_json::{Value, json};

use super::read::{FIELDS, MOST};
use crate::campaign::schema::{holdout, place};

/// The schema, for editors.
pub fn schema() -> Value {
    let schema = object(&FIELDS, &["seed", "poses", "noise"], |field| match field {
        "name" => text("What the campaign is called"),
        "kind" => default(
            word(&["displacement", "position"], "What is read: displacements under loads, or absolute positions"),
            "displacement",
        ),
        "seed" => whole(0, None, "The seed of all that is drawn: one seed gives one campaign"),
        "poses" => poses(),
        "visits" => default(whole(1, Some(MOST as u64), "How often the arm comes to each pose"), 1),
        "ramp" => {
            let share = json!({ "type": "number", "minimum": -1, "maximum": 1 });
            described(some(share), "The loads of a visit in order, as shares of its greatest")
        }
        "force" => pull(Dimension::Force, "The forces"),
        "moment" => pull(Dimension::Torque, "The moments"),
        "payloads" => described(
            some(quantity(Dimension::Mass, Sign::NotNegative, "A payload")),
            "The payloads of each pose, where positions are read",
        ),
        "wrench" => place("Where the loads act, and in which frame they are given"),
        "measured" => place("Where displacements or positions are read, and in which frame they are given"),
        "noise" => noise(),
        "unloaded" => {
            default(word(&["shared", "separate"], "Whether the loads of a visit share an unloaded reading"), "shared")
        }
        "hidden" => described(
            object(&["effects"], &["effects"], |_| effects()),
            "What the arm has and its description is not told",
        ),
        "scatter" => default(
            json!({ "type": "number", "minimum": 0, "exclusiveMaximum": 1,
                "description": "Joints are up to this share softer or stiffer than declared" }),
            0,
        ),
        _ => holdout(),
    });
    document("A scenario: a campaign to be simulated", schema)
}

fn poses() -> Value {
    let coordinate = || {
        let what = "A joint coordinate";
        either(quantity(Dimension::Angle, Sign::Any, what), quantity(Dimension::Length, Sign::Any, what))
    };
    let pose = json!({ "type": "array", "items": coordinate() });
    let schema = object(&["count", "within", "floor", "column", "list"], &[], |field| match field {
        "count" => whole(1, Some(MOST as u64), "How many poses are drawn"),
        "within" => described(
            json!({ "type": "array", "items": list(coordinate(), 2) }),
            "The range of each joint; left out, its limits",
        ),
        "floor" => quantity(Dimension::Length, Sign::Any, "The least height of the tool centre point"),
        "column" => quantity(Dimension::Length, Sign::Any, "Its least distance from the vertical of the base"),
        _ => described(some(pose.clone()), "The poses themselves, in place of drawn ones"),
    });
    described(schema, "The poses: drawn, or listed")
}

fn pull(dimension: Dimension, what: &str) -> Value {
    let schema = object(&["bounds", "directions"], &["bounds"], |field| match field {
        "bounds" => described(
            list(quantity(dimension, Sign::NotNegative, "A size"), 2),
            "The least and the greatest size of a visit's greatest",
        ),
        _ => described(
            json!({ "type": "array", "items": list(json!({ "type": "number" }), 3) }),
            "The directions to choose from; left out, any",
        ),
    });
    described(schema, what)
}

fn noise() -> Value {
    let fields = ["displacement", "rotation", "encoders", "repeatability", "stated"];
    let schema = object(&fields, &["displacement"], |field| match field {
        "displacement" => {
            let one = || quantity(Dimension::Length, Sign::NotNegative, "Of one axis of a position");
            described(either(one(), list(one(), 3)), "Of a position; one number, or one an axis")
        }
        "rotation" => quantity(Dimension::Angle, Sign::NotNegative, "Of one axis of a rotation, where it is read"),
        "encoders" => {
            let angle = || quantity(Dimension::Angle, Sign::NotNegative, "Of a joint that turns");
            let length = || quantity(Dimension::Length, Sign::NotNegative, "Of a joint that slides");
            let each = json!({ "type": "array", "items": either(angle(), length()) });
            json!({ "description": "Of encoders behind the gears, where they are read", "anyOf": [angle(), length(), each] })
        }
        "repeatability" => quantity(Dimension::Length, Sign::NotNegative, "By how much a pose is missed each time"),
        _ => default(word(&["yes", "no"], "Whether the campaign file states the noise"), "yes"),
    });
    described(schema, "One sigma of each reading")
}
