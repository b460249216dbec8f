//! `simulate`: a campaign from a scenario, which the other commands read.

mod common;

use std::fs;
use std::path::Path;

use common::{fail, folder, inside, json, keys, names, run, succeed};
use serde_json::Value;

/// Whether a class of a trace, named or suspected, has an effect in it.
fn is_found(trace: &Value, name: &str) -> bool {
    let all = ["effects", "suspected"].into_iter().flat_map(|key| trace[key].as_array().unwrap());
    all.flat_map(|effect| effect["class"].as_array().unwrap()).any(|member| member["name"] == name)
}

const SCENARIO: &str = "\
seed: 3
poses: {count: 30, floor: 100 mm, column: 600 mm}
visits: 2
ramp: [0.5, 1]
force: {bounds: [500 N, 1300 N]}
noise: {displacement: 8 um}
hidden: {effects: [{kind: transverse_compliance, at: joint 3, value: 8e-7 rad/Nm}]}
";

fn scenario(folder: &Path, text: &str) -> String {
    fs::write(folder.join("try.yaml"), text).unwrap();
    inside(folder, "try.yaml")
}

#[test]
fn what_is_simulated_is_traced() {
    let folder = folder("simulate");
    let (scenario, out) = (scenario(&folder, SCENARIO), inside(&folder, "out"));
    let told = inside(&folder, "told.json");
    let page = succeed(&["simulate", "kuka-kr270-r2700", &scenario, "--out", &out, "--json", &told]);
    assert!(page.contains("120 rows at 30 poses") && page.contains("  transverse_compliance@joint 3"), "{page}");
    assert_eq!(names(Path::new(&out)), ["campaign.yaml", "loads.csv", "robot.yaml", "truth.yaml"]);
    let told = json(&told);
    assert_eq!(keys(&told), ["robot", "rows", "poses", "seed", "hidden", "compliances"]);
    assert_eq!((&told["rows"], &told["hidden"][0]), (&120.into(), &"transverse_compliance@joint 3".into()));
    let campaign = format!("{out}/campaign.yaml");
    let traced = inside(&folder, "traced");
    let page = succeed(&["trace", &campaign, "--out", &traced]);
    assert!(is_found(&json(&format!("{traced}/trace.json")), "transverse_compliance@joint 3"), "{page}");
    // The truth predicts it to the noise of a displacement, the difference of two readings.
    let predicted = inside(&folder, "predicted.json");
    succeed(&["predict", &format!("{out}/truth.yaml"), &campaign, "--json", &predicted]);
    let rms = json(&predicted)["rms_um"].as_f64().unwrap();
    assert!((rms / (8.0 * 2_f64.sqrt()) - 1.0).abs() < 0.15, "{rms}");
}

#[test]
fn encoders_are_simulated_and_read() {
    let folder = folder("simulate-encoders");
    let text = SCENARIO
        .replace("[0.5, 1]", "[0.3, 0.6, 1]")
        .replace("{displacement: 8 um}", "{displacement: 8 um, encoders: 5 urad}");
    let (scenario, out) = (scenario(&folder, &text), inside(&folder, "out"));
    succeed(&["simulate", "kuka-kr270-r2700", &scenario, "--out", &out]);
    let loads = fs::read_to_string(folder.join("out/loads.csv")).unwrap();
    assert!(loads.lines().next().unwrap().contains(",q6 [deg],j1 [deg],"), "{loads:.200}");
    let traced = inside(&folder, "traced");
    succeed(&["trace", &format!("{out}/campaign.yaml"), "--out", &traced]);
    let traced = json(&format!("{traced}/trace.json"));
    assert!(is_found(&traced, "transverse_compliance@joint 3"), "{} {}", traced["effects"], traced["suspected"]);
    let encoders = traced["encoders"]["output"].as_array().unwrap();
    assert_eq!(encoders.len(), 6);
    for encoder in encoders {
        let noise = encoder["noise_urad"].as_f64().unwrap();
        assert!((noise / 5.0 - 1.0).abs() < 0.25, "{encoder}");
    }
}

/// What a tracker would read, from scenario to name.
#[test]
fn positions_are_simulated_and_traced() {
    let folder = folder("simulate-positions");
    let text = "kind: position\nseed: 2\nposes: {count: 60}\nnoise: {displacement: 30 um}\n\
                hidden: {effects: [{kind: joint_zero_offset, at: joint 3, value: 0.1 deg}]}\n";
    let (scenario, out) = (scenario(&folder, text), inside(&folder, "out"));
    let page = succeed(&["simulate", "kuka-kr270-r2700", &scenario, "--out", &out]);
    assert!(page.contains("60 rows at 60 poses") && page.contains("  joint_zero_offset@joint 3"), "{page}");
    assert_eq!(names(Path::new(&out)), ["campaign.yaml", "positions.csv", "robot.yaml", "truth.yaml"]);
    let campaign = format!("{out}/campaign.yaml");
    let traced = inside(&folder, "traced");
    let page = succeed(&["trace", &campaign, "--out", &traced]);
    assert!(
        page.contains("    joint_zero_offset@joint 3: offset = 0.0")
            || page.contains("    joint_zero_offset@joint 3: offset = 0.1"),
        "{page}"
    );
    assert!(page.contains("the error on unseen poses falls from "), "{page}");
    let rms = |robot: &str| {
        let predicted = inside(&folder, "predicted.json");
        succeed(&["predict", robot, &campaign, "--json", &predicted]);
        json(&predicted)["rms_um"].as_f64().unwrap()
    };
    let truth = rms(&format!("{out}/truth.yaml"));
    assert!((truth / 30.0 - 1.0).abs() < 0.2, "{truth}");
    // The robot that is written reads the positions as well as the true one.
    let written = rms(&format!("{traced}/robot.yaml"));
    assert!(written < 1.2 * truth, "{written} {truth}");
}

/// Displacements do not say where the tool is, but what is declared of that and is true no longer
/// shows in them.
#[test]
fn a_declared_zero_that_is_true_no_longer_is_replaced() {
    let folder = folder("simulate-stale");
    let text = SCENARIO.split("hidden:").next().unwrap().replace("[0.5, 1]", "[0.2, 0.6, 1]");
    let (scenario, out) = (scenario(&folder, &text), inside(&folder, "out"));
    succeed(&["simulate", "kuka-kr270-r2700", &scenario, "--out", &out]);
    let robot = format!("{out}/robot.yaml");
    let declared = "effects: [{kind: joint_zero_offset, at: joint 3, value: 30 mrad}]\n";
    fs::write(&robot, fs::read_to_string(&robot).unwrap() + declared).unwrap();
    let traced = inside(&folder, "traced");
    let page = succeed(&["trace", &format!("{out}/campaign.yaml"), "--out", &traced]);
    assert!(page.contains("declared of it is replaced: joint_zero_offset@joint 3 was 1.719 deg."), "{page}");
    let written = fs::read_to_string(format!("{traced}/robot.yaml")).unwrap();
    let value = written.split("at: joint 3, value: ").nth(1).expect("it is written").split(' ').next().unwrap();
    assert!(value.parse::<f64>().unwrap().abs() < 4e-3, "{written}");
}

#[test]
fn one_seed_gives_one_campaign_and_none_is_overwritten_unasked() {
    let folder = folder("simulate-twice");
    let (scenario, out) = (scenario(&folder, SCENARIO), inside(&folder, "out"));
    let arguments = ["simulate", "kuka-kr270-r2700", &scenario, "--out", &out];
    succeed(&arguments);
    let loads = fs::read_to_string(folder.join("out/loads.csv")).unwrap();
    assert!(fail(1, &arguments).contains("would be overwritten; choose another folder, or say --force"));
    succeed(&[&arguments[..], &["--force"]].concat());
    assert_eq!(fs::read_to_string(folder.join("out/loads.csv")).unwrap(), loads);
}

#[test]
fn mistakes_leave_nothing_behind() {
    let folder = folder("simulate-wrong");
    let scenario = scenario(&folder, &SCENARIO.replace("8 um", "8 N").replace("seed: 3", "sede: 3"));
    let out = inside(&folder, "out");
    let message = fail(1, &["simulate", "kuka-kr270-r2700", &scenario, "--out", &out]);
    assert!(message.contains("try.yaml:1:1") && message.contains("did you mean `seed`?"), "{message}");
    assert!(message.contains("try.yaml:6:23") && message.contains("`N` is a force"), "{message}");
    assert_eq!(run(&["simulate", "kuka-kr270-r2700", &scenario]).code, 2);
    assert_eq!(names(&folder), ["try.yaml"]);
}

#[test]
fn a_scatter_is_told_in_round_numbers() {
    let folder = folder("simulate-scatter");
    let scenario = inside(&folder, "scenario.yaml");
    let text =
        "seed: 1\nscatter: 0.29\nposes: {count: 3}\nforce: {bounds: [500 N, 900 N]}\nnoise: {displacement: 8 um}\n";
    fs::write(&scenario, text).unwrap();
    let out = folder.join("out");
    succeed(&["simulate", "kuka-kr270-r2700", &scenario, "--out", out.to_str().unwrap()]);
    let truth = fs::read_to_string(out.join("truth.yaml")).unwrap();
    assert!(truth.contains("off their declared compliance by up to 29 %"), "{truth}");
}

/// Declared noise far above what the readings show is not used, and not in silence.
#[test]
fn declared_noise_that_is_not_used_is_warned_of() {
    let folder = folder("simulate-noise");
    let (scenario, out) = (scenario(&folder, SCENARIO), inside(&folder, "out"));
    succeed(&["simulate", "kuka-kr270-r2700", &scenario, "--out", &out]);
    let campaign = format!("{out}/campaign.yaml");
    let (found, told) = (inside(&folder, "found"), inside(&folder, "told.json"));
    let said = "The declared noise of 80.0 um is not used: the readings show ";
    let warned = |is_said: bool| {
        let page = succeed(&["identify", &campaign, "--out", &found, "--json", &told]);
        assert!(page.contains(said) == is_said, "{page}");
        let document = json(&told);
        let warnings = document["warnings"].as_array().unwrap();
        assert_eq!(warnings.iter().any(|one| one.as_str().unwrap().starts_with(said)), is_said, "{warnings:?}");
    };
    warned(false);
    let text = fs::read_to_string(&campaign).unwrap();
    assert!(text.contains("displacement: 8 um"), "{text}");
    fs::write(&campaign, text.replace("displacement: 8 um", "displacement: 80 um")).unwrap();
    warned(true);
}
