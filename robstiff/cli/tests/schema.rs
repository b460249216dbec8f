//! `schema`: every file that people write here is taken by the schema of its kind, and what is wrong in
//! shape is refused.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{folder, inside, json, succeed};
use robstiff_robots::document::Document;
use robstiff_robots::schema::value_of;
use serde_json::Value;

const KINDS: [&str; 7] = ["robot", "campaign", "scenario", "cut", "modes", "map", "cell"];

fn validator(kind: &str) -> jsonschema::Validator {
    let schema: Value = serde_json::from_str(&succeed(&["schema", kind])).unwrap();
    jsonschema::validator_for(&schema).unwrap_or_else(|problem| panic!("{kind}: {problem}"))
}

fn parsed(text: &str) -> Value {
    value_of(&Document::parse("", text).unwrap_or_else(|problems| panic!("{text}\n{problems}")).root())
}

/// What kind of file it is, by its fields.
fn kind_of(file: &Value) -> Option<&'static str> {
    let has = |field: &str| file.get(field).is_some();
    match () {
        // A list of records of forces has no schema.
        () if has("records") => None,
        () if has("observations") => Some("campaign"),
        () if has("convention") => Some("robot"),
        () if has("seed") && has("poses") => Some("scenario"),
        () if has("depth") || has("measured") && has("speed") => Some("cut"),
        () if has("modes") || has("responses") => Some("modes"),
        () if has("robot") && has("spindle") => Some("cell"),
        () if has("positions") || has("joints") => Some("map"),
        () => None,
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// All files of an ending in a folder and below.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("bad") {
            found.extend(files(&path, ending));
        } else if path.extension().is_some_and(|own| own == ending) {
            found.push(path);
        }
    }
    found
}

/// The blocks of YAML in a page.
fn blocks(page: &str) -> impl Iterator<Item = &str> {
    page.split("```yaml\n").skip(1).map(|rest| rest.split("```").next().unwrap())
}

#[test]
fn what_is_shown_and_shipped_is_taken() {
    let validators = KINDS.map(validator);
    let mut texts: Vec<(String, String)> = Vec::new();
    for folder in ["robots", "tests/robots", "robstiff/docs/commands/files"] {
        let own = files(&root().join(folder), "yaml");
        texts.extend(own.into_iter().map(|path| (path.display().to_string(), fs::read_to_string(path).unwrap())));
    }
    for page in files(&root().join("robstiff/docs"), "md") {
        let text = fs::read_to_string(&page).unwrap();
        texts.extend(blocks(&text).map(|block| (page.display().to_string(), block.to_owned())));
    }
    let mut counts = [0; KINDS.len()];
    for (place, text) in texts {
        // A block may be a part of a file, or leave out what is not its matter.
        let Ok(document) = Document::parse("", &text) else { continue };
        let value = value_of(&document.root());
        let Some(kind) = kind_of(&value).filter(|_| !text.contains("..")) else { continue };
        let of = KINDS.iter().position(|known| *known == kind).unwrap();
        let problems: Vec<String> =
            validators[of].iter_errors(&value).map(|error| format!("{}: {error}", error.instance_path())).collect();
        assert!(problems.is_empty(), "{kind} in {place}: {problems:#?}\n{text}");
        counts[of] += 1;
    }
    println!("{counts:?}");
    assert!(counts[0] >= 20 && counts.iter().all(|count| *count > 0), "{counts:?}");
}

#[test]
fn what_is_wrong_in_shape_is_refused() {
    const CAMPAIGN: &str = "robot: rv130hsc\nobservations: loads.csv\nkind: displacement\n";
    const SCENARIO: &str = "seed: 1\nposes: {count: 40}\nforce: {bounds: [500 N, 1300 N]}\n";
    const CUT: &str = "tool: {diameter: 16 mm, teeth: 3}\nmilling: slot\nmaterial: al7075-t6\nfeed: 0.1 mm/tooth\n";
    const MODES: &str = "frame: base\n";
    const MAP: &str = "force: 500 N\n";
    const CELL: &str = "robot: rv130hsc\nspindle: {axis: x}\n";
    let cases = [
        ("campaign", CAMPAIGN, "noise: {displacement: 8 um}", "noise: {displacement: 8 N}"),
        ("campaign", CAMPAIGN, "measured: {frame: tool, at: [0, 0, 120 mm]}", "measured: {frame: flange}"),
        ("campaign", CAMPAIGN, "holdout: {fraction: 0.25, seed: 3}", "holdout: {seed: 3}"),
        ("campaign", CAMPAIGN, "columns: {q1: Achse 1}", "colums: {q1: Achse 1}"),
        ("scenario", SCENARIO, "noise: {displacement: 8 um}", "noise: 8 um"),
        ("scenario", SCENARIO, "noise: {displacement: 8 um, stated: no}", "noise: {displacement: 8 um, stated: never}"),
        ("cut", CUT, "depth: 2 mm", "depth: 2 N"),
        ("cut", CUT, "depth: 2 mm\nspeed: 9000 rpm", "depth: -2 mm"),
        (
            "cut",
            CUT,
            "depth: 2 mm\nkienzle: {material: 42crmo4, radial: 0.3}",
            "depth: 2 mm\nkienzle: {material: 42crmo, radial: 0.3}",
        ),
        (
            "cut",
            CUT,
            "depth: 2 mm\nkienzle: {kc11: 1990 N/mm2, mc: 0.26, radial: 0.3}",
            "depth: 2 mm\nkienzle: {kc11: 1990 N/mm2, mc: 0.26}",
        ),
        (
            "modes",
            MODES,
            "modes: [{frequency: 15.2 Hz, damping: 0.03, stiffness: 0.8 N/um, direction: [1, 0, 0]}]",
            "modes: [{frequency: 15.2 Hz, damping: 0.03, stiffness: 0.8, direction: [1, 0, 0]}]",
        ),
        (
            "modes",
            MODES,
            "responses: {file: hammer.csv, measured: accelerance, from: 5 Hz, modes: 4}",
            "responses: {file: hammer.csv, measured: acceleration, from: 5 Hz, modes: 4}",
        ),
        (
            "modes",
            "frame: base\nmodes: [{frequency: 15.2 Hz, damping: 0.03, stiffness: 0.8 N/um, direction: [1, 0, 0]}]\n",
            "massless: [{stiffness: 20 N/um, direction: [0, 0, 1]}]",
            "responses: {file: hammer.csv, measured: accelerance}",
        ),
        ("map", MAP, "joints: [0, {from: 0 deg, to: 90 deg, count: 50}]", "joints: [0, {from: 0 deg, to: 90 deg}]"),
        (
            "map",
            MAP,
            "positions: {x: 1 m, y: 0, z: {from: 0 m, to: 1 m, count: 9}}\ntool: {direction: [0, 0, -1]}",
            "positions: {x: 1 m, y: 0}\ntool: {direction: [0, 0, -1]}",
        ),
        ("cell", CELL, "tools: {T1: {length: 120 mm, teeth: 3}}", "tools: {T1: {diameter: 16 mm}}"),
        ("cell", CELL, "tools: {T1: {length: 120 mm}}", "tools: {mill: {length: 120 mm}}"),
        ("cell", CELL, "work: {xyz: [1 m, 0, 0], rpy: [0, 0, 90 deg]}", "work: {xyz: [1 m, 0, 0 N]}"),
        ("cell", CELL, "work: {G54: {xyz: [1 m, 0, 0]}, G59.3: {}}", "work: {G55: {xyz: [1 m, 0, 0]}}"),
        ("cell", CELL, "joint_speeds: [90 deg/s, 2 m/s]", "joint_speeds: [90 deg]"),
        ("cell", CELL, "program: {machine: table A C, tcp: on}", "program: {machine: table A C, tcp: maybe}"),
    ];
    let validators = KINDS.map(validator);
    for (kind, rest, right, wrong) in cases {
        let validator = &validators[KINDS.iter().position(|known| *known == kind).unwrap()];
        for (line, is_right) in [(right, true), (wrong, false)] {
            let text = format!("{rest}{line}\n");
            assert_eq!(validator.is_valid(&parsed(&text)), is_right, "{kind}:\n{text}");
        }
    }
}

#[test]
fn a_schema_is_written_to_a_file() {
    let folder = folder("schema");
    let file = inside(&folder, "campaign.schema.json");
    let said = succeed(&["schema", "campaign", "--out", &file]);
    assert!(said.contains("campaign.schema.json"), "{said}");
    assert_eq!(json(&file)["additionalProperties"], Value::Bool(false));
}
