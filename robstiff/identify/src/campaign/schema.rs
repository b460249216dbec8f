//! The JSON Schema of a campaign file.

use robstiff_robots::quantity::Dimension;
use robstiff_robots::schema::{Sign, default, described, document, either, list, object, quantity, text, whole, word};
use serde_json::{Value, json};

use super::read::FIELDS;

/// The schema, for editors.
pub fn schema() -> Value {
    let schema = object(&FIELDS, &["robot", "observations", "kind"], |field| match field {
        "name" => text("What the campaign is called"),
        "date" => text("When it was measured, for the report"),
        "operator" => text("Who measured, for the report"),
        "robot" => text("The robot's description: its path from this file, or a robot of the catalogue"),
        "observations" => text("The table of what was measured: its path from this file"),
        "sheet" => text("Of a spreadsheet with several sheets, the one with the table"),
        "kind" => word(
            &["displacement", "position", "clamped"],
            "What was read: displacements under loads, absolute positions, or axes loaded one by one",
        ),
        "columns" => json!({
            "type": "object",
            "additionalProperties": { "type": "string" },
            "description": "Columns that the table has under other names, e.g. {q1: \"Achse 1\"}",
        }),
        "wrench" => place("Where the loads act, and in which frame they are given"),
        "measured" => measured(),
        "noise" => described(
            object(&["displacement", "rotation"], &[], |field| match field {
                "displacement" => quantity(Dimension::Length, Sign::Positive, "Of one axis of a position"),
                _ => quantity(Dimension::Angle, Sign::Positive, "Of one axis of a rotation"),
            }),
            "One sigma of a reading; estimated where it is left out",
        ),
        _ => holdout(),
    });
    document("A campaign: what was measured on a robot", schema)
}

fn measured() -> Value {
    let schema = object(&["frame", "at", "along"], &[], |field| match field {
        "along" => described(
            list(quantity(Dimension::Number, Sign::Any, "A component"), 3),
            "The direction in that frame in which a single gauge reads the column `d`",
        ),
        field => of_place(field),
    });
    described(schema, "Where displacements or positions are read, and in which frame they are given")
}

/// The schema of `{frame: base, at: tcp}`.
pub fn place(what: &str) -> Value {
    described(object(&["frame", "at"], &[], of_place), what)
}

fn of_place(field: &str) -> Value {
    match field {
        "frame" => default(word(&["base", "tool"], "The frame of the components"), "base"),
        _ => {
            let point = list(quantity(Dimension::Length, Sign::Any, "A coordinate"), 3);
            default(described(either(json!({ "const": "tcp" }), point), "The point, in the tool frame"), "tcp")
        }
    }
}

/// The schema of what is kept from the fit.
pub fn holdout() -> Value {
    let schema = object(&["fraction", "seed"], &["fraction"], |field| match field {
        "fraction" => quantity(Dimension::Number, Sign::Positive, "The share of the poses, between 0 and 1"),
        _ => default(whole(0, None, "The seed of the draw"), 0),
    });
    described(schema, "Whole poses that no fit sees, to judge by")
}
