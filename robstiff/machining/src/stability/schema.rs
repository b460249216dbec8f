//! The JSON Schema of measured modes.

use robstiff_robots::quantity::Dimension;
use robstiff_robots::schema::{Sign, described, document, list, object, quantity, some, text, whole, word};
use serde_json::{Value, json};

use super::file::{FIELDS, MEASURED, MODE, RESPONSES, SPRING};
use super::responses::MOST_MODES;

/// The schema, for editors.
pub fn schema() -> Value {
    let mut schema = object(&FIELDS, &["frame"], |field| match field {
        "modes" => described(some(mode()), "The modes of the tool on the arm"),
        "massless" => json!({
            "type": "array",
            "items": spring(),
            "description": "What gives way at once: the modes that are quicker than those of the table",
        }),
        "responses" => described(responses(), "The measured frequency responses, to which modes are fitted"),
        _ => word(&["base", "tool"], "The frame of the directions"),
    });
    schema["oneOf"] = json!([
        { "required": ["modes"] },
        { "required": ["responses"], "properties": { "massless": false } },
    ]);
    document("The modes of the tool on the arm, as measured in one pose", schema)
}

fn mode() -> Value {
    object(&MODE, &MODE, |field| match field {
        // In SI a stiffness of 0.8 is next to nothing, so the reader asks for units.
        "frequency" => text("The natural frequency with its unit, e.g. 15.2 Hz"),
        "damping" => quantity(Dimension::Number, Sign::Positive, "The damping ratio"),
        _ => of_spring(field),
    })
}

fn spring() -> Value {
    object(&SPRING, &SPRING, of_spring)
}

fn of_spring(field: &str) -> Value {
    match field {
        "stiffness" => text("The stiffness at the tool, along the direction, with its unit, e.g. 0.8 N/um"),
        _ => described(
            list(quantity(Dimension::Number, Sign::Any, "A component"), 3),
            "Where the tool moves; the length does not count",
        ),
    }
}

fn responses() -> Value {
    object(&RESPONSES, &["file", "measured"], |field| match field {
        "file" => text("The table of the responses, by its path from the folder of this file"),
        "measured" => word(&MEASURED, "Whether displacement, velocity or acceleration by a force was measured"),
        "from" => text("The frequency from which on the responses are taken, with its unit, e.g. 5 Hz"),
        "to" => text("The frequency up to which the responses are taken, with its unit, e.g. 60 Hz"),
        _ => whole(1, Some(MOST_MODES as u64), "How many modes there are; left out, as the responses tell"),
    })
}
