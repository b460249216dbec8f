//! G-code and APT in place of a table.

mod common;

use std::fs;

use common::{fail, folder, inside, json, run, succeed};

const PART: &str = "%\n(SLOT)\nG21 G17 G40 G90 G94\nT2 M6\nS6000 M3\nG0 X0 Y0 Z30\nZ0\nG1 X60 F1200\nG3 X80 Y20 I0 J20\nG1 Y60\n\
    G0 Z30\nX0 Y0\nM30\n%\n";
const APT: &str = "UNITS/MM\nSPINDL/6000,RPM,CLW\nRAPID\nGOTO/0,0,30\nRAPID\nGOTO/0,0,0\nFEDRAT/1200,MMPM\nGOTO/60,0,0\n\
    MOVARC/60,20,0,0,0,1,20,ANGLE,90\nGOTO/80,20,0\nGOTO/80,60,0\nRAPID\nGOTO/80,60,30\nRAPID\nGOTO/0,0,30\nFINI\n";
const PLACE: [&str; 2] = ["--place", "1500 mm, 0, 800 mm, 0, 0, 0"];
const CUT: &str = "tool: {diameter: 20 mm, teeth: 4, helix: 30 deg}\nmaterial: al7075-t6\nmilling: down\nwidth: 8 mm\n\
    depth: 2 mm\nfeed: 0.05 mm/tooth\nspeed: 6000 rpm\n";

#[test]
fn a_program_is_solved_cut_and_corrected() {
    let folder = folder("programs");
    let (cut, told) = (inside(&folder, "cut.yaml"), inside(&folder, "told.json"));
    fs::write(&cut, CUT).unwrap();
    let mut lengths = Vec::new();
    for (name, text) in [("slot.ngc", PART), ("slot.apt", APT)] {
        let part = inside(&folder, name);
        fs::write(&part, text).unwrap();
        let arm = ["path", "kuka-kr270-r2700", &part, PLACE[0], PLACE[1], "--json", &told];
        let out = inside(&folder, &format!("{name}.csv"));
        let page =
            succeed(&[&arm[..], &["--cut", &cut, "--tolerance", "1 um", "--compensate", "--out", &out]].concat());
        assert!(page.contains("(4 by rapids)") && page.contains("with a force"), "{page}");
        let document = json(&told);
        let points = document["points"].as_array().unwrap();
        let pushed = document["deviation"]["points"].as_array().unwrap();
        for (point, pushed) in points.iter().zip(pushed) {
            let is_pushed = pushed["wrench"][0].as_f64().unwrap() != 0.0;
            assert_eq!(is_pushed, !point["rapid"].as_bool().unwrap(), "{point}");
        }
        let last = if name == "slot.ngc" { 12 } else { 15 };
        assert_eq!(points.last().unwrap()["line"], last);
        lengths.push(document["length_m"].as_f64().unwrap());
        // Read again it has its rapids.
        let again = run(&["path", "kuka-kr270-r2700", &out, "--cut", &cut]);
        assert!(again.code == 0 && again.out.contains("(4 by rapids)"), "{}{}", again.out, again.err);
    }
    assert!((lengths[0] - lengths[1]).abs() < 1e-9, "{lengths:?}");
    let part = inside(&folder, "slot.ngc");
    let page = succeed(&["online", "kuka-kr270-r2700", &part, PLACE[0], PLACE[1], "--cut", &cut]);
    assert!(page.contains("slot.ngc under"), "{page}");
}

#[test]
fn what_is_not_followed_is_shown_and_nothing_is_written() {
    let folder = folder("programs-wrong");
    let (part, out) = (inside(&folder, "part.nc"), inside(&folder, "out.csv"));
    fs::write(&part, "G21 G0 X0 Y0 Z0\nG41 D1\nG1 X#5 F100\n").unwrap();
    let said = fail(1, &["path", "kuka-kr270-r2700", &part, "--out", &out]);
    assert!(said.contains("part.nc:2:1") && said.contains("part.nc:3:4"), "{said}");
    assert!(!std::path::Path::new(&out).exists());
    fs::write(&part, "G21 G0 X0 Y0 Z0 B5\n").unwrap();
    let said = fail(1, &["path", "kuka-kr270-r2700", &part]);
    assert!(said.contains("part.nc:1:17") && said.contains("--machine xyzac-trt"), "{said}");
    let said = fail(2, &["path", "kuka-kr270-r2700", "points.csv", "--arc-tolerance", "1 um"]);
    assert!(said.contains("--arc-tolerance is for G-code"), "{said}");
    let said = fail(2, &["path", "kuka-kr270-r2700", &part, "--machine", "hexapod"]);
    assert!(said.contains("`table A C`"), "{said}");
    let said = fail(2, &["path", "kuka-kr270-r2700", &part, "--offset", "G60=0,0,0"]);
    assert!(said.contains("G59.3"), "{said}");
}

#[test]
fn rotary_axes_and_offsets_are_those_of_the_options() {
    let folder = folder("programs-five");
    let (part, told) = (inside(&folder, "five.ngc"), inside(&folder, "told.json"));
    fs::write(&part, "G21 G55 G0 X0 Y0 Z0 B0\nG1 X10 B30 F600\n").unwrap();
    let arm = ["path", "kuka-kr270-r2700", &part, PLACE[0], PLACE[1], "--json", &told];
    succeed(&[&arm[..], &["--machine", "head B", "--tcp", "on", "--offset", "G55=0, 100 mm, 0"]].concat());
    let points = json(&told)["points"].clone();
    let last = points.as_array().unwrap().last().unwrap().clone();
    for (axis, expected) in [1.51, 0.1, 0.8].into_iter().enumerate() {
        assert!((last["position_m"][axis].as_f64().unwrap() - expected).abs() < 1e-9, "{last}");
    }
}
