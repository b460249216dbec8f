//! The JSON Schema of a map file.

use robstiff_robots::quantity::Dimension;
use robstiff_robots::schema::{
    Sign, default, described, document, either, list, object, placement, quantity, some, whole, word,
};
use serde_json::{Value, json};

use super::read::{FIELDS, MOST};

/// The schema, for editors.
pub fn schema() -> Value {
    let mut schema = object(&FIELDS, &[], |field| match field {
        "joints" => described(
            some(either(axis(Dimension::Angle), axis(Dimension::Length))),
            "A value or a range for each joint",
        ),
        "positions" => described(
            object(&["frame", "x", "y", "z"], &["x", "y", "z"], |field| match field {
                "frame" => described(placement(), "Where positions are counted from; left out, the base frame"),
                _ => axis(Dimension::Length),
            }),
            "A grid of positions of the tool centre point",
        ),
        "tool" => tool(),
        "force" => {
            let any = quantity(Dimension::Force, Sign::Positive, "A force in the worst direction");
            let along = list(quantity(Dimension::Force, Sign::Any, "A component"), 3);
            described(either(any, along), "The force at the tool centre point, in the base frame")
        }
        "moment" => described(
            list(quantity(Dimension::Torque, Sign::Any, "A component"), 3),
            "The moment there, in the base frame",
        ),
        _ => word(&["deviation", "stiffness", "compliance"], "What is computed of each cell"),
    });
    schema["oneOf"] = json!([{ "required": ["joints"] }, { "required": ["positions"] }]);
    document("A map of a robot's stiffness", schema)
}

/// A value, or a range of values.
fn axis(dimension: Dimension) -> Value {
    let end = |what| quantity(dimension, Sign::Any, what);
    let range = object(&["from", "to", "count"], &["from", "to", "count"], |field| match field {
        "from" => end("The first value"),
        "to" => end("The last value"),
        _ => whole(2, Some(MOST as u64), "How many values"),
    });
    either(end("A value"), range)
}

fn tool() -> Value {
    let schema = object(&["axis", "direction", "turn"], &["direction"], |field| match field {
        "axis" => default(word(&["x", "y", "z", "-x", "-y", "-z"], "The axis of the tool frame that is directed"), "z"),
        "direction" => described(list(json!({ "type": "number" }), 3), "Where it points, in the base frame"),
        _ => axis(Dimension::Angle),
    });
    described(schema, "How the tool stands at each position")
}
