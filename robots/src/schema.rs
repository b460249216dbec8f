//! JSON Schemas (draft 7, which editors read best) of the files that people write.
//!
//! They are made of what the readers check with: the catalogue of effects, the
//! units, the names of fields. A schema knows shapes, names and units; what follows
//! from other fields or other files only the reader knows.

mod effects;

use serde_json::{Map, Value, json};

use crate::description::MOST_JOINTS;
use crate::dimension::Dimension;
use crate::document::Node;
use crate::effect::Convention;
use crate::read::{CONTROLLER, JOINT, LINK, PENDANT, PLACEMENT, ROBOT};
use crate::units::UNITS;

/// A document as an editor reads it, to hold it against a schema; `null` in place of what is no value of
/// JSON.
pub fn value_of(node: &Node<'_>) -> Value {
    if node.is_map() {
        let map = node.any_map("");
        map.iter().flat_map(|map| map.fields().map(|(name, node)| (name.to_owned(), value_of(&node)))).collect()
    } else if node.is_sequence() {
        node.sequence().iter().flatten().map(value_of).collect()
    } else if node.is_number() {
        node.quantity(Dimension::Number).map_or(Value::Null, Value::from)
    } else {
        node.text().map_or(Value::Null, Value::from)
    }
}

/// What signs a quantity may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Any.
    Any,
    /// Zero or more.
    NotNegative,
    /// More than zero.
    Positive,
}

/// A schema with what it is, as editors show it.
pub fn described(schema: Value, what: &str) -> Value {
    with(schema, "description", what)
}

/// A schema with the value that a field has where it is left out.
pub fn default(schema: Value, value: impl Into<Value>) -> Value {
    with(schema, "default", value)
}

fn with(mut schema: Value, key: &str, value: impl Into<Value>) -> Value {
    schema[key] = value.into();
    schema
}

/// A whole document.
pub fn document(title: &str, body: Value) -> Value {
    let mut document = json!({ "$schema": "http://json-schema.org/draft-07/schema#", "title": title });
    if let (Some(document), Value::Object(body)) = (document.as_object_mut(), body) {
        document.extend(body);
    }
    document
}

/// A map of the fields that a reader takes, in its order; `describe` gives the schema of each.
pub fn object(fields: &[&str], required: &[&str], describe: impl Fn(&str) -> Value) -> Value {
    let properties: Map<String, Value> = fields.iter().map(|&field| (field.into(), describe(field))).collect();
    let mut object = json!({ "type": "object", "properties": properties, "additionalProperties": false });
    if !required.is_empty() {
        object["required"] = json!(required);
    }
    object
}

/// A list of exactly `count` values.
pub fn list(item: Value, count: usize) -> Value {
    json!({ "type": "array", "items": item, "minItems": count, "maxItems": count })
}

/// A list of at least one value.
pub fn some(item: Value) -> Value {
    json!({ "type": "array", "items": item, "minItems": 1 })
}

/// One of some words.
pub fn word(words: &[&str], what: &str) -> Value {
    json!({ "enum": words, "description": what })
}

/// A text.
pub fn text(what: &str) -> Value {
    json!({ "type": "string", "description": what })
}

/// A whole number from one to another.
pub fn whole(least: u64, most: Option<u64>, what: &str) -> Value {
    let mut whole = json!({ "type": "integer", "minimum": least, "description": what });
    if let Some(most) = most {
        whole["maximum"] = json!(most);
    }
    whole
}

/// Either of two.
pub fn either(one: Value, other: Value) -> Value {
    json!({ "anyOf": [one, other] })
}

/// A quantity: a number in SI, or a text with a unit.
pub fn quantity(dimension: Dimension, sign: Sign, what: &str) -> Value {
    let number = match sign {
        Sign::Any => json!({ "type": "number" }),
        Sign::NotNegative => json!({ "type": "number", "minimum": 0 }),
        Sign::Positive => json!({ "type": "number", "exclusiveMinimum": 0 }),
    };
    let units: Vec<&str> = units(dimension).collect();
    let told = match units.first() {
        None => what.into(),
        Some(si) => format!("{what} [{si} without a unit; or {}]", units.join(", ")),
    };
    json!({
        "description": told,
        "anyOf": [number, { "type": "string", "pattern": pattern(dimension, sign) }],
    })
}

fn units(dimension: Dimension) -> impl Iterator<Item = &'static str> {
    UNITS.iter().filter(move |unit| unit.dimension == dimension).map(|unit| unit.name)
}

/// What a text with a quantity looks like; a micro sign stands for `u`, a printed minus for `-`.
fn pattern(dimension: Dimension, sign: Sign) -> String {
    let signs = if sign == Sign::Any { "[-+\u{2212}]?" } else { "[+]?" };
    let number = "([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+\u{2212}]?[0-9]+)?";
    let units: Vec<String> = units(dimension).map(|unit| unit.replace('u', "[u\u{b5}\u{3bc}]")).collect();
    let unit = if units.is_empty() { String::new() } else { format!("({})?", units.join("|")) };
    let of_pi = match dimension {
        Dimension::Angle => format!("|\\s*({number}\\s*\\*?)?\\s*(pi|\u{3c0})\\s*(/\\s*{number})?\\s*(rad)?"),
        _ => String::new(),
    };
    format!("^\\s*{signs}({number}\\s*{unit}{of_pi})\\s*$")
}

/// The schema of a robot's description.
pub fn robot() -> Value {
    let schema = object(&ROBOT, &["name", "convention", "joints"], |field| match field {
        "name" => json!({
            "type": "string",
            "pattern": "^[A-Z][A-Za-z0-9]*$",
            "description": "The name of the robot, in upper camel case: it becomes the Rust type",
        }),
        "description" => text("One line on what the robot is"),
        "source" => text("Where every number comes from; what is a surrogate, and why"),
        "convention" => word(
            &[Convention::Standard.word(), Convention::Modified.word()],
            "The Denavit-Hartenberg convention of the table",
        ),
        "base" => described(placement(), "Frame 0 in the base frame; left out, it is the base frame"),
        "tool" => described(placement(), "The tool centre point in the flange frame; left out, it is the flange"),
        "joints" => json!({
            "type": "array",
            "minItems": 1,
            "maxItems": MOST_JOINTS,
            "items": joint(),
            "description": "The DH table, one row a joint, from the base to the flange",
        }),
        "links" => json!({
            "type": "array",
            "maxItems": MOST_JOINTS,
            "items": link(),
            "description": "The body that moves with each joint, `{}` where nothing is known",
        }),
        "effects" => described(self::effects(), "What measurements added to the compliance of the joints"),
        "controller" => described(controller(), "How the controller sees the robot"),
        _ => json!({}),
    });
    document("A robot: its geometry and how it gives way", schema)
}

/// The schema of a list of effects, as descriptions and scenarios write it.
pub fn effects() -> Value {
    json!({ "type": "array", "items": effects::effect() })
}

/// The schema of `{xyz: [..], rpy: [..]}`.
pub fn placement() -> Value {
    object(&PLACEMENT, &[], |field| match field {
        "xyz" => {
            described(list(quantity(Dimension::Length, Sign::Any, "A coordinate"), 3), "The origin; left out, zero")
        }
        _ => described(
            list(quantity(Dimension::Angle, Sign::Any, "An angle"), 3),
            "Turns about the fixed axes x, then y, then z; left out, zero",
        ),
    })
}

/// A row of the table: its limits and compliance have the units of its type.
fn joint() -> Value {
    let of = |kind: &str| {
        let (coordinate, compliance) = match kind {
            "prismatic" => (Dimension::Length, Dimension::LinearCompliance),
            _ => (Dimension::Angle, Dimension::Compliance),
        };
        let part = || quantity(compliance, Sign::NotNegative, "How far the joint yields; a stiffness is inverted");
        json!({ "properties": {
            "limits": described(
                list(quantity(coordinate, Sign::Any, "A limit of the coordinate"), 2),
                "The lower and the upper limit of the coordinate",
            ),
            "compliance": {
                "description": "The compliance; left out, the joint is rigid. Named parts add up",
                "anyOf": [part(), { "type": "object", "minProperties": 1, "additionalProperties": part() }],
            },
        }})
    };
    let row = |dimension, what| default(quantity(dimension, Sign::Any, what), 0);
    let mut joint = object(&JOINT, &[], |field| match field {
        "type" => default(word(&["revolute", "prismatic"], "Whether the joint turns or slides"), "revolute"),
        "theta" => row(Dimension::Angle, "The angle about z"),
        "d" => row(Dimension::Length, "The offset along z"),
        "a" => row(Dimension::Length, "The length along x"),
        "alpha" => row(Dimension::Angle, "The twist about x"),
        _ => json!(true),
    });
    joint["if"] = json!({ "properties": { "type": { "const": "prismatic" } }, "required": ["type"] });
    joint["then"] = of("prismatic");
    joint["else"] = of("revolute");
    joint
}

fn link() -> Value {
    object(&LINK, &[], |field| match field {
        "mass" => default(quantity(Dimension::Mass, Sign::NotNegative, "The mass"), 0),
        _ => described(
            list(quantity(Dimension::Length, Sign::Any, "A coordinate"), 3),
            "The centre of mass in the frame of the joint's row; left out, its origin",
        ),
    })
}

fn controller() -> Value {
    object(&CONTROLLER, &[], |field| match field {
        "joints" => json!({
            "type": "array",
            "minItems": 1,
            "maxItems": MOST_JOINTS,
            "items": pendant(),
            "description": "How joint coordinates follow from the pendant's, `{}` where they are the same",
        }),
        "world" => described(placement(), "The controller's world in the base frame; left out, it is the base frame"),
        "flange" => described(placement(), "The controller's flange in the flange frame; left out, it is that frame"),
        _ => text("The description that the controller solves with; left out, this one without effects"),
    })
}

/// `q = offset + sign (t + sum of factor t_j)`.
fn pendant() -> Value {
    object(&PENDANT, &[], |field| match field {
        "sign" => {
            default(json!({ "enum": [1, -1], "description": "-1 where the two count in opposite directions" }), 1)
        }
        "offset" => default(
            either(
                quantity(Dimension::Angle, Sign::Any, "The coordinate where the pendant shows 0"),
                quantity(Dimension::Length, Sign::Any, "The coordinate where the pendant shows 0"),
            ),
            0,
        ),
        _ => json!({
            "type": "object",
            "minProperties": 1,
            "patternProperties": { "^t[1-7]$": { "type": "number" } },
            "additionalProperties": false,
            "description": "What the pendant's coordinates of joints before this one add, each with its factor",
        }),
    })
}
