//! The JSON Schema of measured modes.

use robstiff_robots::quantity::Dimension;
use robstiff_robots::schema::{Sign, described, document, list, object, quantity, some, text, word};
use serde_json::Value;

use super::file::{FIELDS, MODE};

/// The schema, for editors.
pub fn schema() -> Value {
    let schema = object(&FIELDS, &FIELDS, |field| match field {
        "modes" => described(some(mode()), "The modes of the tool on the arm"),
        _ => word(&["base", "tool"], "The frame of the directions"),
    });
    document("The modes of the tool on the arm, as measured in one pose", schema)
}

fn mode() -> Value {
    object(&MODE, &MODE, |field| match field {
        // In SI a stiffness of 0.8 is next to nothing, so the reader asks for units.
        "frequency" => text("The natural frequency with its unit, e.g. 15.2 Hz"),
        "damping" => quantity(Dimension::Number, Sign::Positive, "The damping ratio"),
        "stiffness" => {
            text("The stiffness of this mode at the tool, along its direction, with its unit, e.g. 0.8 N/um")
        }
        _ => described(
            list(quantity(Dimension::Number, Sign::Any, "A component"), 3),
            "Where it moves the tool; the length does not count",
        ),
    })
}
