//! Commands on axes that are loaded one by one, those before clamped.

mod common;

use std::fs;
use std::path::Path;

use common::{fail, folder, inside, json, measured, succeed};
use serde_json::Value;

#[test]
fn clamped_axes_are_identified_and_traced() {
    let folder = folder("clamped");
    let robot = fs::read_to_string(measured().join("../../rv130hsc.yaml")).unwrap();
    let robot = robot.replace("compliance: 78.0e-7 rad/Nm", "compliance: {gear: 60e-7 rad/Nm, belt: 20e-7 rad/Nm}");
    fs::write(folder.join("robot.yaml"), robot).unwrap();
    let campaign = inside(&folder, "campaign.yaml");
    fs::write(&campaign, "name: axis by axis\nrobot: robot.yaml\nobservations: axes.csv\nkind: clamped\n").unwrap();
    let rows = "axis,torque [Nm],deflection [urad]\n1,100,30\n1,200,60\n1,-300,-90\n5,10,78\n5,20,160\n";
    fs::write(folder.join("axes.csv"), rows).unwrap();
    let (out, path) = (inside(&folder, "out"), inside(&folder, "found.json"));
    let page = succeed(&["identify", &campaign, "--out", &out, "--json", &path]);
    assert!(page.contains("joint 2 does not show in these data"), "{page}");
    assert!(page.contains("joint 5: a load shows the sum of gear and belt, which keep their proportion"), "{page}");
    let parts = &robstiff_robots::Description::read(folder.join("out/robot.yaml")).unwrap().joints[4].compliance;
    assert!((parts[0].value - 6e-6).abs() < 1e-15 && (parts[1].value - 2e-6).abs() < 1e-15, "{parts:?}");
    let found = json(&path);
    assert!((found["compliances"][0]["value"].as_f64().unwrap() - 3e-7).abs() < 1e-18);
    assert_eq!(found["compliances"][1]["visibility"], "unseen");
    // Five rows tell no more than that; errors are angles.
    let page = succeed(&["trace", &campaign, "--out", &inside(&folder, "traced")]);
    assert!(page.contains("5 rows at 2 axes") && page.contains("error [urad]") && !page.contains(" um"), "{page}");
    let traced = json(&inside(&folder, "traced/trace.json"));
    assert_eq!(traced["verdict"], "insufficient");
    assert!(traced["before"]["identified"]["rms_urad"].is_number() && traced["noise_um"].is_null(), "{traced}");
    let report = fs::read_to_string(folder.join("traced/report.html")).unwrap();
    assert!(report.contains("\u{b5}rad") && !report.contains("\u{b5}m"));

    fs::write(folder.join("axes.csv"), "axis,torque,deflection\n1,0,3e-5\n2,0,0\n").unwrap();
    let message = fail(1, &["identify", &campaign, "--out", &inside(&folder, "unloaded")]);
    assert!(message.contains("every torque is zero"), "{message}");
    assert!(!folder.join("unloaded").exists());
}

/// The sentence about the rows that were left out agrees with the table.
#[test]
fn errors_of_clamped_axes_are_told_alike_everywhere() {
    let folder = folder("clamped-wild");
    fs::copy(measured().join("../../rv130hsc.yaml"), folder.join("robot.yaml")).unwrap();
    let campaign = inside(&folder, "campaign.yaml");
    fs::write(&campaign, "robot: robot.yaml\nobservations: axes.csv\nkind: clamped\n").unwrap();
    let mut rows = String::from("axis,torque [Nm],deflection [urad]\n");
    for k in 0..24 {
        // Of no pattern, from -6 to 6.
        let (noise, wild) = (f64::from(k * k * 5 % 13 - 6), if k == 17 { 400.0 } else { 0.0 });
        let torque = f64::from(100 * (k % 12 + 1));
        rows += &format!("{},{torque},{}\n", k / 12 + 1, 0.3 * torque + noise + wild);
    }
    fs::write(folder.join("axes.csv"), rows).unwrap();
    let out = inside(&folder, "out");
    let page = succeed(&["trace", &campaign, "--out", &out]);
    let traced = json(&inside(Path::new(&out), "trace.json"));
    assert_eq!(traced["effects"][0]["kind"], "outliers", "{page}");
    let rms = |stage: &Value| format!("{:.1}", stage["rms_urad"].as_f64().unwrap());
    let (before, after) = (rms(&traced["before"]["identified"]), rms(&traced["after"]));
    // A row left out does nothing to the others, and is in the errors before and after.
    assert_eq!(before, after, "{page}");
    assert!(page.contains("leaves out line 19; the errors above have it in"), "{page}");
    assert!(page.contains("Without it the error on fitted rows stays at "), "{page}");
    assert!(traced["effects"][0]["p_value"].as_f64().unwrap() > 0.0);
}
