//! `export`: URDF files from descriptions.

mod common;

use std::fs;
use std::path::Path;

use common::{fail, folder, inside, json, keys, run, succeed};

fn arm() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/commands/files/arm.urdf").to_str().unwrap().to_owned()
}

#[test]
fn a_calibrated_arm_is_exported_and_imported_again() {
    let folder = folder("export");
    let [yaml, urdf, again, told] =
        ["arm.yaml", "calibrated.urdf", "again.yaml", "told.json"].map(|name| inside(&folder, name));
    assert_eq!(run(&["import", &arm(), "--tip", "cutter_tip", "--out", &yaml]).code, 0);
    let effects = "effects:\n  - {kind: joint_zero_offset, at: joint 2, value: 0.02 deg}\n  - {kind: dh_error, at: d4, value: 0.8 mm}\n";
    fs::write(&yaml, fs::read_to_string(&yaml).unwrap() + effects).unwrap();
    let export = ["export", &yaml, "--urdf", &arm(), "--tip", "cutter_tip", "--out", &urdf, "--json", &told];
    let page = succeed(&export);
    assert!(page.contains("6 joints from base_link to cutter_tip, the file agrees with the description"), "{page}");
    let document = json(&told);
    assert_eq!(
        keys(&document),
        ["robot", "base", "tip", "joints", "tool", "exact_angles", "poses", "largest_difference"]
    );
    assert!(document["largest_difference"].as_f64().unwrap() < 1e-12);
    assert!((document["joints"][1]["turn_rad"].as_f64().unwrap() - 0.02_f64.to_radians()).abs() < 1e-12);
    assert!((document["joints"][4]["shift_m"].as_f64().unwrap() - 0.8e-3).abs() < 1e-12);
    // The exported file is another robot's, whose table has the corrections in it.
    assert_eq!(run(&["import", &urdf, "--tip", "cutter_tip", "--out", &again]).code, 0);
    let frames = |yaml: &str| {
        let page = succeed(&["show", yaml, "--at", "10 deg, -20 deg, 30 deg, 40 deg, 50 deg, 60 deg"]);
        let (_, page) = page.split_once("Tool centre point at").unwrap();
        page.lines().take(6).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(frames(&yaml), frames(&again));
}

#[test]
fn what_cannot_be_exported_is_explained_and_not_written() {
    let folder = folder("export-refused");
    let (yaml, out) = (inside(&folder, "arm.yaml"), inside(&folder, "out.urdf"));
    assert_eq!(run(&["import", &arm(), "--tip", "flange", "--out", &yaml]).code, 0);
    let said = fail(1, &["export", &yaml, "--urdf", &arm(), "--out", &out]);
    assert!(said.contains("the tree has several ends") && said.contains("arm.urdf:4:3"), "{said}");
    let said = fail(1, &["export", "rv130hsc", "--urdf", &arm(), "--tip", "flange", "--out", &out]);
    assert!(
        said.contains("6 moving joints from `base_link` to `flange`, 5 moving joints in the description"),
        "{said}"
    );
    // The fourth joint counts the other way round.
    let said = fail(1, &["export", "kuka-kr270-r2700", "--urdf", &arm(), "--tip", "flange", "--out", &out]);
    assert!(said.contains("at zero the description turns what the joint"), "{said}");
    let copy = inside(&folder, "copy.urdf");
    fs::copy(arm(), &copy).unwrap();
    let said = fail(1, &["export", &yaml, "--urdf", &copy, "--tip", "flange", "--out", &copy]);
    assert!(said.contains("is one of the files that were read"), "{said}");
    assert!(!Path::new(&out).exists());
}
