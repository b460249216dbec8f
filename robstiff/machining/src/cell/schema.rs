//! The JSON Schema of a cell.

use robstiff_robots::quantity::Dimension;
use robstiff_robots::schema::{
    Sign, default, described, document, either, list, object, placement, quantity, some, text, whole, word,
};
use serde_json::{Value, json};

use super::read::{FIELDS, PROGRAM, SPINDLE, STOCK, TOOL};
use crate::nc::OFFSETS;

/// The schema, for editors.
pub fn schema() -> Value {
    let schema = object(&FIELDS, &["robot"], |field| match field {
        "name" => text("What the cell is called"),
        "robot" => text("The robot's description: its path from this file, or the name of a robot in the catalogue"),
        "spindle" => spindle(),
        "tools" => json!({
            "type": "object",
            "minProperties": 1,
            "patternProperties": { "^[Tt]?[0-9]+$": tool() },
            "additionalProperties": false,
            "description": "The tools by their numbers, `T1` and so on",
        }),
        "tool" => json!({
            "type": "string",
            "pattern": "^[Tt]?[0-9]+$",
            "description": "The tool in the spindle where the path names none",
        }),
        "work" => work(),
        "stock" => described(
            object(&STOCK, &STOCK, |field| match field {
                "from" => corner("The lower corner"),
                _ => corner("The upper corner"),
            }),
            "The stock: a box along the axes of the work frame",
        ),
        "joint_speeds" => described(
            some(either(
                quantity(Dimension::RotationalSpeed, Sign::Positive, "How fast the joint turns at most"),
                quantity(Dimension::Speed, Sign::Positive, "How fast the joint slides at most"),
            )),
            "How fast each joint can move",
        ),
        "cut" => text("The cut: its path from this file"),
        _ => program(),
    });
    document("A cell: a robot with its spindle, tools and workpiece", schema)
}

fn corner(what: &str) -> Value {
    described(list(quantity(Dimension::Length, Sign::Any, "A coordinate"), 3), what)
}

fn spindle() -> Value {
    let frame = placement();
    let schema = object(&SPINDLE, &["axis"], |field| match field {
        "axis" => word(&["x", "y", "z", "-x", "-y", "-z"], "From the nose to the tip, in the frame of the nose"),
        "speeds" => described(
            list(quantity(Dimension::RotationalSpeed, Sign::Positive, "A speed"), 2),
            "The least and the highest speed",
        ),
        field => frame["properties"][field].clone(),
    });
    described(schema, "The spindle: the frame of its nose in the flange frame; left out, the tool of the description")
}

fn tool() -> Value {
    object(&TOOL, &["length"], |field| match field {
        "name" => text("What the tool is called"),
        "length" => quantity(Dimension::Length, Sign::Positive, "From the nose of the spindle to the tip"),
        "diameter" => quantity(Dimension::Length, Sign::Positive, "The diameter"),
        "corner_radius" => {
            quantity(Dimension::Length, Sign::NotNegative, "The radius of the corners; half of the diameter is a ball")
        }
        _ => whole(1, Some(100), "How many teeth it has"),
    })
}

fn work() -> Value {
    let names = &OFFSETS[1..];
    let named = object(names, &["G54"], |_| placement());
    let schema = either(placement(), named);
    described(schema, "Where the frame of the path stands in the base frame; or the frames of G54 to G59.3")
}

fn program() -> Value {
    let schema = object(&PROGRAM, &[], |field| match field {
        "machine" => text("The rotary axes, the carrying one first: `table A C`, `head C B`, `head B table -C`"),
        "center" => corner("Where the axes of the table meet, in the path's frame; needed without TCP"),
        "pivot_length" => quantity(
            Dimension::Length,
            Sign::Positive,
            "From where the axes of the head meet to the tip; needed without TCP",
        ),
        "tcp" => word(&["on", "off"], "Whether coordinates are those of the tip, whatever the program's codes say"),
        _ => default(quantity(Dimension::Length, Sign::Positive, "How far chords may be off arcs"), "0.01 mm"),
    });
    described(schema, "How programs of machine tools are read")
}
