//! Measured modes as files.

use core::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

use super::*;

const TABLE: &str = "\
modes:
  - {frequency: 15.2 Hz, damping: 0.03, stiffness: 0.8 N/um, direction: [0.7, -0.2, 0.1]}
  - {frequency: 18 Hz, damping: 0.02, stiffness: 1200 N/mm, direction: [0, 2, 0]}
frame: tool
";

#[test]
fn modes_are_read_in_the_frame_that_they_have() {
    let file = ModesFile::parse("modes.yaml", TABLE).unwrap();
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
    let in_base = ModesFile::parse("modes.yaml", &TABLE.replace("frame: tool", "frame: base")).unwrap();
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
        let error = ModesFile::parse("modes.yaml", &TABLE.replace(from, to)).unwrap_err().to_string();
        let said = error.replace('\n', " ");
        let is_there = part.split("; ").all(|part| said.contains(part));
        assert!(error.contains(place) && is_there, "{from} -> {to}: {error}");
    }
    let error = ModesFile::parse("modes.yaml", "modes: []\nframe: base\n").unwrap_err().to_string();
    assert!(error.contains("there is no mode"), "{error}");
}
