//! The JSON Schema of a cut.

use robstiff_robots::quantity::Dimension;
use robstiff_robots::schema::{Sign, default, described, document, list, object, quantity, text, whole, word};
use serde_json::{Value, json};

use super::coefficients::materials;
use super::file::FIELDS;
use super::kienzle::kienzle_materials;

/// The schema, for editors.
pub fn schema() -> Value {
    let mut schema = object(&FIELDS, &[], |field| match field {
        "name" => text("What the cut is called"),
        "tool" => tool(),
        "material" => {
            let ids: Vec<String> = materials().into_iter().map(|material| material.id).collect();
            json!({ "enum": ids, "description": "A material of the table, for a first estimate" })
        }
        "coefficients" => coefficients(),
        "kienzle" => kienzle(),
        "milling" => word(&["up", "down", "slot"], "How the teeth meet the material"),
        "width" => quantity(Dimension::Length, Sign::Positive, "The radial width of the cut"),
        "engagement" => described(
            list(quantity(Dimension::Angle, Sign::NotNegative, "An angle from the normal of the cut"), 2),
            "Where a tooth enters and leaves, in place of `milling` and `width`",
        ),
        "depth" => quantity(Dimension::Length, Sign::Positive, "The axial depth of the cut"),
        "feed" => quantity(Dimension::FeedPerTooth, Sign::Positive, "The feed of a tooth"),
        "feed_speed" => quantity(Dimension::Speed, Sign::Positive, "The speed of the feed, in place of `feed`"),
        "speed" => quantity(Dimension::RotationalSpeed, Sign::Positive, "The speed of the spindle"),
        _ => measured(),
    });
    schema["anyOf"] = json!([{ "required": ["measured"] }, { "required": ["tool", "depth"] }]);
    document("A cut: the force of a tool, by a model or as measured", schema)
}

fn tool() -> Value {
    let schema =
        object(&["diameter", "teeth", "helix", "corner", "runout"], &["diameter", "teeth"], |field| match field {
            "diameter" => quantity(Dimension::Length, Sign::Positive, "The diameter"),
            "teeth" => whole(1, Some(100), "How many teeth it has"),
            "helix" => default(quantity(Dimension::Angle, Sign::Any, "The helix angle"), 0),
            "corner" => default(
                quantity(
                    Dimension::Length,
                    Sign::NotNegative,
                    "The radius of the corner, half the diameter of a ball nose",
                ),
                0,
            ),
            _ => described(
                json!({ "type": "array", "items": quantity(Dimension::Length, Sign::Any, "A tooth") }),
                "How far each tooth stands out, in the order in which they cut",
            ),
        });
    described(schema, "The end mill")
}

fn coefficients() -> Value {
    let along = |what: &str| {
        let schema = object(&["cutting", "edge"], &["cutting"], |field| match field {
            "cutting" => quantity(Dimension::Pressure, Sign::Any, "The force per chip area"),
            _ => default(quantity(Dimension::LineForce, Sign::Any, "The force per length of the edge"), 0),
        });
        described(schema, what)
    };
    let schema = object(&["tangential", "radial", "axial"], &["tangential", "radial"], |field| match field {
        "tangential" => along("Along the cutting speed"),
        "radial" => along("Towards the axis of the tool"),
        _ => along("Along the axis of the tool"),
    });
    described(schema, "What the material resists with, in place of `material`")
}

fn kienzle() -> Value {
    let fields = ["material", "kc11", "mc", "radial", "axial"];
    let schema = object(&fields, &["radial"], |field| match field {
        "material" => {
            let ids: Vec<String> = kienzle_materials().into_iter().map(|material| material.id).collect();
            json!({ "enum": ids, "description": "A material of the table, in place of `kc11` and `mc`" })
        }
        "kc11" => quantity(Dimension::Pressure, Sign::Positive, "The specific cutting force of a chip of 1 mm"),
        "mc" => quantity(Dimension::Number, Sign::NotNegative, "How it falls with the thickness of the chip"),
        "radial" => quantity(Dimension::Number, Sign::Any, "The radial force as a part of the tangential one"),
        _ => default(quantity(Dimension::Number, Sign::Any, "The axial force as a part of the tangential one"), 0),
    });
    described(schema, "The specific cutting force after Kienzle, in place of `material`")
}

fn measured() -> Value {
    let schema = object(&["file", "frame", "on"], &["file", "frame", "on"], |field| match field {
        "file" => text("The table of forces: its path from this file"),
        "frame" => word(&["cut", "base", "tool"], "The frame of its components"),
        _ => word(&["tool", "workpiece"], "What the forces act on"),
    });
    described(schema, "Forces that were measured, in place of a model")
}
