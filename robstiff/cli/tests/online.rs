//! `online`: what a correction while cutting leaves.

mod common;

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use common::{fail, file, folder, inside, json, run, succeed};
use serde_json::Value;

/// The documents of a run along the pocket, with more options.
fn along(robot: &str, folder: &str, more: &[&str]) -> Value {
    let folder = folder_of(folder);
    let (told, pocket, cut) = (inside(&folder, "told.json"), file("pocket.csv"), file("roughing.yaml"));
    let arguments = ["online", robot, &pocket, "--tool-axis", "x", "--cut", &cut, "--json", &told];
    succeed(&[&arguments[..], more].concat());
    json(&told)
}

/// That of the robot as declared, which several tests compare with.
fn usual() -> &'static Value {
    static USUAL: OnceLock<Value> = OnceLock::new();
    USUAL.get_or_init(|| along("rv130hsc", "usual", &[]))
}

fn folder_of(name: &str) -> std::path::PathBuf {
    folder(&format!("online-{name}"))
}

/// What the force sensor with the true model, the one with a wrong model and
/// encoders leave, as parts of the root mean square without any.
fn left(document: &Value) -> [f64; 3] {
    let rms = |course: &Value| course["rms_m"].as_f64().unwrap();
    let without = rms(&document["without"]);
    [0, 1, 2].map(|k| rms(&document["control"][k]) / without)
}

#[test]
fn a_correction_helps_until_it_is_late() {
    let in_time = left(usual());
    assert!(in_time.iter().all(|left| *left < 0.15) && in_time[1] > in_time[0], "{in_time:?}");
    let late = left(&along("rv130hsc", "late", &["--delay", "200 ms"]));
    assert!(late.iter().zip(in_time).all(|(late, in_time)| *late > 2.0 * in_time), "{late:?}");
    let never = left(&along("rv130hsc", "never", &["--delay", "60 s"]));
    assert_eq!(never, [1.0; 3]);
}

#[test]
fn limits_leave_what_is_beyond_them() {
    let free = left(usual());
    let small = left(&along("rv130hsc", "small", &["--most", "0.01 mrad"]));
    assert!(small.iter().all(|left| (0.5..0.99).contains(left)), "{small:?}");
    let slow = left(&along("rv130hsc", "slow", &["--fastest", "1e-5 rad/s"]));
    assert!(slow.iter().zip(free).all(|(slow, free)| *slow > free + 0.05), "{slow:?}");
}

#[test]
fn a_limit_that_holds_back_is_told() {
    let folder = folder_of("held-back");
    let told = inside(&folder, "told.json");
    let sine = ["online", "rv130hsc", "--at", "0.3,-0.4,0.5,0.2,1.2", "--force", "150,-200,300 N", "--json", &told];
    let held = |name: &str, frequency: usize| json(&told)["control"][0][name][frequency].as_f64().unwrap();
    let page = succeed(&sine);
    assert!(!page.contains("holds the correction back"), "{page}");
    assert_eq!(held("held_back_by_most", 0), 0.0);
    let page = succeed(&[&sine[..], &["--most", "0.05 mrad"]].concat());
    assert!(page.contains("A limit holds the correction back\n  4 ms, force sensor: --most, at 0.2, 0.5,"), "{page}");
    assert!((0.3..1.0).contains(&held("held_back_by_most", 0)));
    let page = succeed(&[&sine[..], &["--fastest", "2e-3 rad/s"]].concat());
    assert!(page.contains("  4 ms, force sensor: --fastest, at") && page.contains("10 Hz\n"), "{page}");
    assert_eq!(held("held_back_by_fastest", 0), 0.0);
    assert!(held("held_back_by_fastest", 5) > 0.3);
    let told = along("rv130hsc", "held-back-along", &["--most", "0.01 mrad"]);
    assert!((0.3..=1.0).contains(&told["control"][0]["held_back_by_most"].as_f64().unwrap()));
    assert!(told["without"].get("held_back_by_most").is_none());
}

#[test]
fn encoders_do_not_see_what_is_behind_them() {
    let folder = folder_of("effects");
    let robot = inside(&folder, "robot.yaml");
    let text = robstiff_robots::catalogue::find("rv130hsc").unwrap();
    let effect = "effects:\n  - {kind: transverse_compliance, at: joint 3, value: 6e-7}\n";
    fs::write(&robot, format!("{}\n{effect}", text.trim_end())).unwrap();
    let [force, _, encoders] = left(&along(&robot, "bearing", &[]));
    assert!(encoders > force + 0.05, "{force} {encoders}");
}

#[test]
fn a_lost_sensor_costs_what_it_does_not_see() {
    let whole = usual();
    let lost = along("rv130hsc", "lost", &["--lost", "5 s, 2 s"]);
    assert_eq!(whole["without"]["rms_m"], lost["without"]["rms_m"]);
    for (with, without) in left(whole).into_iter().zip(left(&lost)) {
        // Two of thirteen seconds are as if there were no control.
        assert!((with * with + 2.0 / 13.3).sqrt() - without < 0.1 && without > with + 0.1, "{with} {without}");
    }
    let (pocket, cut) = (file("pocket.csv"), file("roughing.yaml"));
    let arguments = ["online", "rv130hsc", &pocket, "--tool-axis", "x", "--cut", &cut, "--lost", "99 s, 1 s"];
    let ran = run(&arguments);
    assert_eq!(ran.code, 0);
    assert!(ran.err.contains("ends after 13.28 s, before --lost begins"), "{}", ran.err);
}

/// With a delay of a second or more a correction is right again at whole periods; a half of the
/// force of a sine is gone where `2 sin(pi f T) = 1 / 2`.
#[test]
fn a_long_delay_is_not_mistaken_for_none() {
    let folder = folder_of("long-delay");
    let told = inside(&folder, "told.json");
    let sine = ["online", "rv130hsc", "--force", "0, 0, 400 N", "--frequencies", "1 Hz", "--json", &told];
    succeed(&[&sine[..], &["--delay", "1 s", "--step", "20 ms"]].concat());
    let control = &json(&told)["control"][0];
    // The position loops and half a step are late by 25 ms more.
    for (name, periods) in [("half_gone_to_Hz", 0.0804), ("less_left_to_Hz", 0.1667)] {
        let found = control[name].as_f64().unwrap() * 1.025 / periods;
        assert!((found - 1.0).abs() < 0.03, "{name}: {control}");
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let (pocket, cut) = (file("pocket.csv"), file("roughing.yaml"));
    let along = ["online", "rv130hsc", &pocket, "--tool-axis", "x", "--cut", &cut];
    let said = fail(1, &[&along[..], &["--step", "100 s"]].concat());
    assert!(said.contains("takes 13.28 s, less than a control step of 100 s"), "{said}");
    let said = fail(2, &[&along[..], &["--delay", "-1 ms"]].concat());
    assert!(said.contains("a time of 0 or more is expected here"), "{said}");
    let said = fail(2, &["online", "rv130hsc", "--force", "100, 0, 0 N", "--lost", "1 s, 1 s"]);
    assert!(said.contains("--lost needs a path or a record"), "{said}");
}

/// Along the pocket, the tool in the air but for some rows: points 10 to 20, lines 11 to 21.
fn in_the_air_but(folder: &Path, robot: &str) -> Value {
    let (forces, told) = (inside(folder, "forces.csv"), inside(folder, "told.json"));
    let row = |k: usize| if (10..=20).contains(&k) { "80,-60,-20\n" } else { "0,0,0\n" };
    let rows: String = (1..=40).map(row).collect();
    fs::write(&forces, format!("Fx [N],Fy [N],Fz [N]\n{rows}")).unwrap();
    let along = ["online", robot, &file("pocket.csv"), "--tool-axis", "x", "--forces", &forces, "--json", &told];
    let page = succeed(&along);
    assert!(page.contains("while there is a force:") && page.contains("worst outside"), "{page}");
    json(&told)
}

#[test]
fn time_in_the_air_does_not_dilute_what_is_left() {
    let folder = folder_of("air");
    let told = in_the_air_but(&folder, "rv130hsc");
    let number = |value: &Value| value.as_f64().unwrap();
    // From point 9, at line 10, to point 21 there is a force, of 40.
    let part = number(&told["with_force"]);
    let times: Vec<f64> = told["points"].as_array().unwrap().iter().map(|point| number(&point["t_s"])).collect();
    assert!((part - (times[20] - times[8]) / times[39]).abs() < 1e-3, "{part}");
    let without = &told["without"];
    assert!(number(&without["rms_m"]) > 0.8 * number(&without["worst_m"]), "{without}");
    assert_eq!(number(&without["worst_without_force_m"]), 0.0);
    // The worst is told by its line in the file, where the force is.
    let line = without["worst_before_line"].as_u64().unwrap();
    assert!((11..=22).contains(&line), "{line}");
    let at = told["points"].as_array().unwrap().iter().position(|point| point["line"] == line).unwrap();
    assert_eq!(without["since_m"][at], without["worst_m"]);
    assert_eq!(number(&without["worst_before_t_s"]), times[at]);
    // What a correction has not yet taken back when the tool leaves the cut.
    assert!(number(&told["control"][0]["worst_without_force_m"]) > 0.0);
}

#[test]
fn a_path_in_the_air_is_refused() {
    let folder = folder_of("nothing");
    let forces = inside(&folder, "forces.csv");
    fs::write(&forces, format!("Fx [N],Fy [N],Fz [N]\n{}", "0,0,0\n".repeat(40))).unwrap();
    let said = fail(1, &["online", "rv130hsc", &file("pocket.csv"), "--tool-axis", "x", "--forces", &forces]);
    assert!(said.contains("there is no force anywhere"), "{said}");
}

#[test]
fn what_nobody_would_wait_for_is_refused() {
    let sine = ["online", "rv130hsc", "--force", "100, 0, 0 N"];
    for (option, value, change) in [
        ("--frequencies", "1e-9 Hz", "give higher --frequencies"),
        ("--delay", "1000 s", "give a shorter --delay"),
        ("--bandwidth", "1e-6 Hz", "give a higher --bandwidth"),
        ("--loop-damping", "1e9", "a --loop-damping nearer to 1"),
        ("--loop-damping", "1e-7", "a --loop-damping nearer to 1"),
        ("--step", "1e-9 s", "give a longer --step"),
    ] {
        let said = fail(2, &[&sine[..], &[option, value]].concat());
        assert!(said.contains("points in time") && said.contains(change), "{option} {value}: {said}");
    }
    let (pocket, cut) = (file("pocket.csv"), file("roughing.yaml"));
    let said = fail(2, &["online", "rv130hsc", &pocket, "--tool-axis", "x", "--cut", &cut, "--step", "1e-9 s"]);
    assert!(said.contains("takes 13.28 s") && said.contains("give a longer --step"), "{said}");
}

/// Both follow the loads: encoders see what stays in the gears, and a model that is
/// the robot knows it.
#[test]
fn what_hysteresis_keeps_is_taken_back() {
    let folder = folder_of("hysteresis");
    let robot = inside(&folder, "robot.yaml");
    let text = robstiff_robots::catalogue::find("rv130hsc").unwrap();
    let effect = |joint| format!("  - {{kind: hysteresis, at: joint {joint}, radius1: 5 Nm, weight1: 1e-6 rad/Nm}}\n");
    fs::write(&robot, format!("{}\neffects:\n{}", text.trim_end(), [1, 2, 3].map(effect).concat())).unwrap();
    let told = in_the_air_but(&folder, &robot);
    // At the last point, long after the load, where the loops have come to rest.
    let last = |course: &Value| course["since_m"].as_array().unwrap().last().unwrap().as_f64().unwrap();
    let kept = last(&told["without"]);
    assert!(kept > 1e-6, "{kept}");
    for k in [0, 2] {
        assert!(last(&told["control"][k]) < 0.01 * kept, "{} {kept}", told["control"][k]["name"]);
    }
}

#[test]
fn the_name_of_a_model_is_one_field_of_the_table() {
    let folder = folder_of("names");
    let (model, csv) = (inside(&folder, "a,b.yaml"), inside(&folder, "left.csv"));
    fs::write(&model, robstiff_robots::catalogue::find("rv130hsc").unwrap()).unwrap();
    let sine = ["online", "rv130hsc", "--force", "100, 0, 0 N", "--model", &model, "--csv", &csv];
    succeed(&[&sine[..], &["--frequencies", "1 Hz"]].concat());
    let table = fs::read_to_string(&csv).unwrap();
    let header = table.lines().next().unwrap();
    assert!(header.starts_with("frequency [Hz],4 ms; force sensor [%],\"4 ms; force sensor; "), "{header}");
    assert!(header.ends_with("a,b.yaml [%]\",4 ms; encoders behind the gears [%]"), "{header}");
}
