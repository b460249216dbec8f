//! The schema of a description: it takes what the reader takes, and refuses what is wrong in shape.
#![cfg(feature = "schema")]

use std::fs;
use std::path::Path;

use robstiff_robots::document::Document;
use robstiff_robots::effect::CATALOGUE;
use robstiff_robots::{Description, catalogue, schema};
use serde_json::Value;

fn parsed(text: &str) -> Option<Value> {
    Document::parse("", text).ok().map(|document| schema::value_of(&document.root()))
}

fn validator() -> jsonschema::Validator {
    jsonschema::validator_for(&schema::robot()).unwrap()
}

fn assert_taken(name: &str, text: &str) {
    let value = parsed(text).unwrap_or_else(|| panic!("{name}"));
    let problems: Vec<String> =
        validator().iter_errors(&value).map(|error| format!("{}: {error}", error.instance_path())).collect();
    assert!(problems.is_empty(), "{name}: {problems:#?}");
}

#[test]
fn the_robots_of_the_catalogue_are_taken() {
    for (file, text) in catalogue::catalogue() {
        assert_taken(file, text);
    }
}

#[test]
fn the_robots_of_the_tests_are_taken() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/robots");
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "yaml") {
            assert_taken(&path.display().to_string(), &fs::read_to_string(&path).unwrap());
        }
    }
}

#[test]
fn every_spelling_of_a_quantity_that_is_read_is_taken() {
    for angle in ["90 deg", "pi/2", "-3*pi/4", "2pi", "- pi / 2", "\u{2212}pi/2", "50 urad", "50 \u{b5}rad", "1", ".5"]
    {
        let text = format!("name: A\nconvention: standard\njoints: [{{theta: \"{angle}\", a: 1 m}}]\n");
        Description::parse("", &text).unwrap_or_else(|problems| panic!("{problems}"));
        assert_taken(angle, &text);
    }
}

/// Files of `bad` whose shape is right: what is wrong in them follows from other fields, from
/// the numbers, or from how YAML is written, and only the reader knows it.
const RIGHT_IN_SHAPE: [&str; 18] = [
    "bare.yaml",
    "bare_effects.yaml",
    "coupling.yaml",
    "coupling_singular.yaml",
    "couplings.yaml",
    "endless_slide.yaml",
    "keyword.yaml",
    "no_length.yaml",
    "no_length_modified.yaml",
    "no_masses.yaml",
    "orders.yaml",
    "rigid.yaml",
    "sag.yaml",
    "sag_corrected.yaml",
    "softening.yaml",
    "stroke.yaml",
    "stroke_corrected.yaml",
    "weakened.yaml",
];

#[test]
fn what_is_wrong_in_shape_is_refused() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let validator = validator();
    let mut taken: Vec<String> = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "yaml") {
            continue;
        }
        // What is no YAML an editor says without a schema.
        let Some(value) = fs::read_to_string(&path).ok().and_then(|text| parsed(&text)) else { continue };
        if validator.is_valid(&value) {
            taken.push(path.file_name().unwrap().to_string_lossy().into_owned());
        }
    }
    taken.sort();
    assert_eq!(taken, RIGHT_IN_SHAPE);
}

#[test]
fn every_kind_of_effect_has_its_part() {
    let schema = schema::robot();
    let kinds = schema.pointer("/properties/effects/items/anyOf").unwrap().as_array().unwrap();
    assert_eq!(kinds.len(), CATALOGUE.len());
    for (part, about) in kinds.iter().zip(CATALOGUE) {
        assert_eq!(part["properties"]["kind"]["const"], about.kind);
        for parameter in about.parameters {
            let of = &part["properties"][parameter.name];
            assert!(of["description"].as_str().is_some_and(|what| what.starts_with(parameter.what)), "{of}");
            assert_eq!(of.get("default").and_then(Value::as_f64), parameter.default, "{}", parameter.name);
        }
    }
}

#[test]
fn slips_in_a_description_are_refused() {
    let validator = validator();
    let joints = |joint: &str| format!("name: A\nconvention: standard\njoints: [{joint}]\n");
    for (joint, is_right) in [
        ("{a: 1 m, compliance: 1e-7 rad/Nm}", true),
        ("{a: 1 m, compliance: {gear: 1e-7 rad/Nm, belt: 2 MNm/rad}}", true),
        ("{type: prismatic, limits: [0 m, 1 m], compliance: 50 N/um}", true),
        ("{a: 1 mn}", false),
        ("{lenght: 1 m}", false),
        ("{a: 1 m, compliance: 50 N/um}", false),
        ("{a: 1 m, compliance: -1e-7 rad/Nm}", false),
        ("{a: 1 m, compliance: {}}", false),
        ("{a: 1 m, limits: [0 deg]}", false),
        ("{type: prismatic, limits: [0 deg, 1 deg]}", false),
        ("{type: sliding}", false),
    ] {
        assert_eq!(validator.is_valid(&parsed(&joints(joint)).unwrap()), is_right, "{joint}");
    }
}
