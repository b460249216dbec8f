//! `import`: descriptions from URDF files.

mod common;

use std::fs;
use std::path::Path;

use common::{fail, folder, inside, json, keys, run, succeed};

fn arm() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/commands/files/arm.urdf").to_str().unwrap().to_owned()
}

#[test]
fn an_arm_is_imported_and_can_be_used() {
    let folder = folder("import");
    let (out, told) = (inside(&folder, "arm.yaml"), inside(&folder, "told.json"));
    let ran = run(&["import", &arm(), "--tip", "cutter_tip", "--out", &out, "--json", &told]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("2 angles such as 1.5708 are taken as"), "{}", ran.err);
    assert!(ran.out.contains("6 joints from base_link to cutter_tip"), "{}", ran.out);
    let document = json(&told);
    assert_eq!(keys(&document), ["robot", "base", "tip", "joints", "poses", "largest_difference"]);
    assert!(document["largest_difference"].as_f64().unwrap() < 1e-9);
    let page = succeed(&["show", &out]);
    assert!(page.contains("MillingArm180"), "{page}");
}

/// The crate that reads it has a copy for its own tests, which go without this one's files.
#[test]
fn the_arm_of_the_pages_is_the_one_that_is_tested() {
    assert_eq!(fs::read_to_string(arm()).unwrap(), include_str!("../../../robots/src/urdf/arm.urdf"));
}

#[test]
fn what_cannot_be_imported_is_explained_and_not_written() {
    let folder = folder("import-refused");
    let out = inside(&folder, "arm.yaml");
    let said = fail(1, &["import", &arm(), "--out", &out]);
    assert!(said.contains("the tree has several ends") && said.contains("`cutter_tip` (behind 6 joints)"), "{said}");
    let broken = inside(&folder, "broken.urdf");
    fs::write(&broken, fs::read_to_string(arm()).unwrap().replace("0 0 0.78", "0 0 high")).unwrap();
    let said = fail(1, &["import", &broken, "--tip", "flange", "--out", &out]);
    assert!(said.contains("`high` is not a finite number") && said.contains("broken.urdf:"), "{said}");
    assert!(!Path::new(&out).exists());
}

#[test]
fn a_description_with_compliances_in_it_is_not_replaced() {
    let folder = folder("import-again");
    let out = inside(&folder, "arm.yaml");
    let import = ["import", &arm(), "--tip", "cutter_tip", "--out", &out];
    // The first finds nothing there, the second itself.
    assert_eq!([run(&import).code, run(&import).code], [0, 0]);
    let imported = fs::read_to_string(&out).unwrap();
    let edited = format!("{imported}# compliances by hand\n");
    fs::write(&out, &edited).unwrap();
    let said = run(&import);
    assert_eq!((said.code, said.out.as_str()), (1, ""));
    assert!(
        said.err.contains("arm.yaml is there already, and would be overwritten; choose another file"),
        "{}",
        said.err
    );
    assert_eq!(fs::read_to_string(&out).unwrap(), edited);
    assert_eq!(run(&[&import[..], &["--force"]].concat()).code, 0);
    assert_eq!(fs::read_to_string(&out).unwrap(), imported);
}

#[test]
fn axes_that_are_almost_parallel_are_refused() {
    let folder = folder("import-nearly");
    let (nearly, out) = (inside(&folder, "nearly.urdf"), inside(&folder, "nearly.yaml"));
    // 1e-8 rad: the axes meet a hundred thousand kilometres away.
    let text = fs::read_to_string(arm()).unwrap().replacen("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 1e-8\"/>", 1);
    fs::write(&nearly, text).unwrap();
    let ran = run(&["import", &nearly, "--tip", "flange", "--out", &out]);
    assert_eq!(ran.code, 1, "{}", ran.out);
    assert!(ran.err.contains("almost parallel"), "{}", ran.err);
    assert!(!Path::new(&out).exists());
}
