//! Measured modes as files.

use core::f64::consts::TAU;

use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use robstiff_robots::ReadError;

use super::*;

const TABLE: &str = "\
modes:
  - {frequency: 15.2 Hz, damping: 0.03, stiffness: 0.8 N/um, direction: [0.7, -0.2, 0.1]}
  - {frequency: 18 Hz, damping: 0.02, stiffness: 1200 N/mm, direction: [0, 2, 0]}
frame: tool
";

fn parsed(text: &str) -> Result<ModesFile, ReadError> {
    ModesFile::parse("modes.yaml", text, Path::new(""))
}

#[test]
fn modes_are_read_in_the_frame_that_they_have() {
    let file = parsed(TABLE).unwrap();
    assert_eq!(file.frame, ModesFrame::Tool);
    let first = file.modes[0];
    assert!((first.frequency - 15.2 * TAU).abs() < 1e-12 && (first.stiffness - 0.8e6).abs() < 1e-6);
    assert_eq!((first.damping, first.direction), (0.03, Vector3::new(0.7, -0.2, 0.1)));
    // The second one moves the tool along y of its frame, which is x of the base here.
    let turned = Matrix3::new(0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    let modes = file.in_base(&turned).unwrap();
    assert_eq!(modes.damping(), [0.03, 0.02]);
    let shape = modes.shapes().column(1);
    assert!((shape[0] - 18.0 * TAU / 1.2e6_f64.sqrt()).abs() < 1e-12 && shape[1] == 0.0 && shape[2] == 0.0);
    let in_base = parsed(&TABLE.replace("frame: tool", "frame: base")).unwrap();
    assert_eq!(in_base.in_base(&turned), Modes::measured(&in_base.modes));
}

#[test]
fn mistakes_are_shown_where_they_are() {
    for (from, to, place, part) in [
        ("frame: tool", "frame: world", "modes.yaml:4:8", "`base`"),
        ("frame: tool\n", "", "modes.yaml:1:1", "`frame` is missing"),
        ("damping: 0.03", "damp: 0.03", "modes.yaml:2:26", "unknown field `damp`"),
        ("damping: 0.03", "damping: -0.03", "modes.yaml:2:35", "above 0 and below 1"),
        ("damping: 0.03", "damping: 3", "modes.yaml:2:35", "e.g. `0.03`, which is 3 %"),
        ("damping: 0.03, ", "", "modes.yaml:2:5", "`damping` is missing"),
        ("frequency: 15.2 Hz", "frequency: 15.2", "modes.yaml:2:17", "`frequency` has no unit; write e.g. `15.2 Hz`"),
        ("frequency: 15.2 Hz", "frequency: 0 Hz", "modes.yaml:2:17", "above zero"),
        ("0.8 N/um", "0.8", "modes.yaml:2:52", "`stiffness` has no unit; write e.g. `0.8 N/um`"),
        ("0.8 N/um", "-0.8 N/um", "modes.yaml:2:52", "stiffness"),
        ("0.8 N/um", "0.8 Nm/rad", "modes.yaml:2:52", "Nm/rad"),
        ("[0, 2, 0]", "[0, 0, 0]", "modes.yaml:3:", "points nowhere"),
        ("[0, 2, 0]", "[0, 2]", "modes.yaml:3:", "3 values"),
    ] {
        assert!(TABLE.contains(from), "{from}");
        let error = parsed(&TABLE.replace(from, to)).unwrap_err().to_string();
        let said = error.replace('\n', " ");
        let is_there = part.split("; ").all(|part| said.contains(part));
        assert!(error.contains(place) && is_there, "{from} -> {to}: {error}");
    }
    for (added, place, part) in [
        ("massless: [{stiffness: 8 N/um}]\n", "modes.yaml:5:12", "`direction` is missing"),
        ("massless: [{stiffness: -8 N/um, direction: [1, 0, 0]}]\n", "modes.yaml:5:24", "stiffness above zero"),
        ("responses: {file: mod.rs, measured: mobility}\n", "modes.yaml:1:1", "the modes are those of `responses`"),
    ] {
        let error = parsed(&format!("{TABLE}{added}")).unwrap_err().to_string();
        assert!(error.contains(part), "{added}: {error}");
        assert!(error.contains(place) || place == "modes.yaml:1:1", "{added}: {error}");
    }
    let error = parsed("modes: []\nframe: base\n").unwrap_err().to_string();
    assert!(error.contains("there is no mode"), "{error}");
}

#[test]
fn what_has_no_mass_adds_to_the_compliance() {
    let text = format!("{TABLE}massless: [{{stiffness: 20 N/um, direction: [0, 0, 2]}}]\n");
    let (with, without) = (parsed(&text).unwrap(), parsed(TABLE).unwrap());
    let turned = Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);
    let [with, without] = [with, without].map(|file| file.in_base(&turned).unwrap());
    // z of the tool is x of the base.
    let added = with.compliance() - without.compliance();
    assert!((added - Matrix3::from_diagonal(&Vector3::new(5e-8, 0.0, 0.0))).norm() < 1e-20, "{added}");
    assert_eq!((with.shapes(), with.mass()), (without.shapes(), None));
}

const RESPONSES: &str = "\
responses:
  file: hammer.csv
  measured: accelerance
  from: 5 Hz
  to: 60 Hz
  modes: 4
frame: tool
";

#[test]
fn mistakes_about_responses_are_shown_where_they_are() {
    let folder = std::env::temp_dir().join(format!("robstiff-responses-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let table = "frequency [Hz],xx_re,xx_im,yx_re,yx_im,zx_re,zx_im\n6,0,1,0,1,0,1\n7,0,1,0,1,0,1\n";
    std::fs::write(folder.join("hammer.csv"), table).unwrap();
    for (from, to, place, part) in [
        ("file: hammer.csv", "file: anvil.csv", "modes.yaml:2:9", "there is no file"),
        ("file: hammer.csv\n", "fill: hammer.csv\n", "modes.yaml:2:3", "unknown field `fill`"),
        ("accelerance", "acceleration", "modes.yaml:3:13", "did you mean `accelerance`?"),
        ("from: 5 Hz", "from: 5", "modes.yaml:4:9", "`from` has no unit; write e.g. `5 Hz`"),
        ("to: 60 Hz", "to: 4 Hz", "modes.yaml:5:7", "the band ends where it begins"),
        ("modes: 4", "modes: 0", "modes.yaml:6:10", "1 to 20 modes"),
        ("frame: tool\n", "", "modes.yaml:1:1", "`frame` is missing"),
        // Of what is right the table's lines are too few.
        ("modes: 4", "modes: 3", "modes.yaml:6:10", "3 modes need 11 lines, and 2 are in the band"),
        ("  modes: 4\n", "", "modes.yaml:2:3", "1 mode needs 7 lines"),
    ] {
        assert!(RESPONSES.contains(from), "{from}");
        let parsed = ModesFile::parse("modes.yaml", &RESPONSES.replace(from, to), &folder);
        let error = parsed.unwrap_err().to_string();
        let said = error.replace('\n', " ").replace("  |   = help: ", "; ");
        let is_there = part.split("; ").all(|part| said.contains(part));
        assert!(error.contains(place) && is_there, "{from} -> {to}: {error}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
