//! The schema of an effect, from the catalogue.

use serde_json::{Value, json};

use super::{Sign, default, described, object, quantity};
use crate::dimension::Dimension;
use crate::effect::CATALOGUE;
use crate::effect::physics::{About, At, Parameter, Quantity, Range};

/// One of the kinds, each with the places and the numbers it takes.
pub fn effect() -> Value {
    json!({
        "type": "object",
        "required": ["kind", "at"],
        "properties": { "kind": { "enum": CATALOGUE.iter().map(|about| about.kind).collect::<Vec<_>>() } },
        "anyOf": CATALOGUE.iter().map(|about| of_kind(about)).collect::<Vec<_>>(),
    })
}

fn of_kind(about: &About) -> Value {
    let names: Vec<&str> = about.parameters.iter().map(|parameter| parameter.name).collect();
    let fields: Vec<&str> = ["kind", "at"].into_iter().chain(names.iter().copied()).collect();
    let needed = about.parameters.iter().filter(|parameter| parameter.default.is_none());
    let required: Vec<&str> = ["kind", "at"].into_iter().chain(needed.map(|parameter| parameter.name)).collect();
    let mut schema = object(&fields, &required, |field| match field {
        "kind" => json!({ "const": about.kind, "description": about.explanation }),
        "at" => json!({
            "type": "string",
            "pattern": places(about.at),
            "description": format!("Where it sits, e.g. {}", about.at.example()),
        }),
        _ => about.parameters.iter().find(|parameter| parameter.name == field).map_or_else(|| json!({}), number),
    });
    // Numbers that may all be left out are not all left out.
    if required.len() == 2 {
        schema["minProperties"] = json!(3);
    }
    schema
}

/// A pattern of the places that a kind sits at.
const fn places(at: At) -> &'static str {
    match at {
        At::Joint | At::TurningJoint => "^\\s*joint\\s+[0-9]+\\s*$",
        At::TurningJoints => "^\\s*joints\\s+[0-9]+\\s*,\\s*[0-9]+\\s*$",
        At::Link => "^\\s*link\\s+[0-9]+\\s*$",
        At::Base => "^\\s*base\\s*$",
        At::Tool => "^\\s*tool\\s*$",
        At::Entry => "^\\s*(a|alpha|d|theta)[0-9]+\\s*$",
        At::Robot => "^\\s*robot\\s*$",
    }
}

fn number(parameter: &Parameter) -> Value {
    let sign = match parameter.range {
        Range::Any => Sign::Any,
        Range::NotNegative => Sign::NotNegative,
        Range::Positive | Range::Whole(_) => Sign::Positive,
    };
    let what = parameter.what;
    let schema = match (parameter.quantity, parameter.range) {
        // A text that holds a number is read as one.
        (_, Range::Whole(most)) => json!({ "anyOf": [
            { "type": "number", "minimum": 1, "maximum": most, "multipleOf": 1 },
            { "type": "string", "pattern": "^\\s*[+]?[0-9]+(\\.0*)?([eE][+]?[0-9]+)?\\s*$" },
        ]}),
        (Quantity::Of(dimension), _) => quantity(dimension, sign, what),
        (Quantity::Entry, _) => {
            let of = |dimension| quantity(dimension, sign, what);
            json!({ "anyOf": [of(Dimension::Length), of(Dimension::Angle)] })
        }
    };
    let schema = match schema.get("description") {
        Some(_) => schema,
        None => described(schema, what),
    };
    let example = String::from(parameter.example);
    let mut schema = match parameter.default {
        Some(value) => default(schema, value),
        None => schema,
    };
    schema["examples"] = json!([example]);
    schema
}
