//! `identify`, `trace` and `predict`: commands on measurements.

mod common;

use std::fs;
use std::path::Path;

use common::{copy, fail, folder, inside, json, keys, measured, names, run, succeed};
use serde_json::Value;

/// The campaign that ships with the robots.
fn campaign() -> String {
    inside(&measured(), "campaign.yaml")
}

#[test]
fn identifies_joints_and_says_what_changed() {
    let folder = folder("identify");
    let (out, path) = (inside(&folder, "out"), inside(&folder, "found.json"));
    let page = succeed(&["identify", &campaign(), "--out", &out, "--json", &path]);
    assert!(page.contains("43 rows at 43 poses") && page.contains("beyond 25 %"), "{page}");
    assert_eq!(names(Path::new(&out)), ["robot.yaml"]);
    let found = json(&path);
    let compliances = found["compliances"].as_array().unwrap();
    assert_eq!(compliances.len(), 6);
    assert_eq!(
        keys(&compliances[0]),
        [
            "name",
            "declared",
            "value",
            "std",
            "unit",
            "visibility",
            "at_bound",
            "confounded_with",
            "deviation",
            "noteworthy"
        ]
    );
    // Least squares on these data, by hand: 8.61e5 Nm/rad.
    assert!((compliances[0]["value"].as_f64().unwrap().recip() / 8.61e5 - 1.0).abs() < 0.01);

    // The description that was written says what was found.
    let predicted = predicted(&inside(Path::new(&out), "robot.yaml"), &folder);
    let rms = found["identified"]["rms_um"].as_f64().unwrap();
    assert!((predicted["rms_um"].as_f64().unwrap() / rms - 1.0).abs() < 0.01);
}

/// What `predict` says of a robot on the campaign.
fn predicted(robot: &str, folder: &Path) -> Value {
    let path = inside(folder, "predicted.json");
    succeed(&["predict", robot, &campaign(), "--json", &path]);
    json(&path)
}

/// The shipped campaign with forces of the other sign: those whose columns begin so.
fn turned(folder: &Path, columns: &str) -> String {
    let campaign = copy(folder);
    let text = fs::read_to_string(folder.join("loads.csv")).unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let forces: Vec<usize> =
        (0..).zip(header.split(',')).filter(|(_, name)| name.starts_with(columns)).map(|(i, _)| i).collect();
    let turned = rows.lines().map(|row| {
        let turn = |(i, field): (usize, &str)| match (forces.contains(&i), field.strip_prefix('-')) {
            (false, _) => field.to_owned(),
            (true, Some(number)) => number.to_owned(),
            (true, None) => format!("-{field}"),
        };
        row.split(',').enumerate().map(turn).collect::<Vec<_>>().join(",")
    });
    fs::write(folder.join("loads.csv"), format!("{header}\n{}\n", turned.collect::<Vec<_>>().join("\n"))).unwrap();
    campaign
}

#[test]
fn a_joint_that_does_not_follow_its_load_is_at_its_bound() {
    let folder = folder("against-one");
    let campaign = turned(&folder, "Fz");
    let told = "joint 3 is at its bound 0, and written as rigid: the data do not follow the load on this joint";
    let (out, path) = (inside(&folder, "out"), inside(&folder, "found.json"));
    let page = succeed(&["identify", &campaign, "--out", &out, "--json", &path]);
    assert!(page.contains(told) && !page.contains("-100 %"), "{page}");
    let joint = &json(&path)["compliances"][2];
    assert_eq!((&joint["at_bound"], &joint["visibility"]), (&true.into(), &"seen".into()));
    assert!(joint["std"].is_null() && joint["deviation"].is_null());
}

/// Displacements of the wrong sign are no measurement of rigid joints.
#[test]
fn readings_against_the_loads_are_said_to_be() {
    let folder = folder("against");
    let campaign = turned(&folder, "F");
    let out = inside(&folder, "out");
    let said = fail(1, &["identify", &campaign, "--out", &out]);
    assert!(said.contains("campaign.yaml: the readings do not follow the loads: ") && said.contains("signs"), "{said}");
    assert!(!Path::new(&out).exists());
    let page = succeed(&["trace", &campaign, "--out", &out]);
    assert!(page.contains("The readings do not follow the loads: ") && page.contains("check the signs"), "{page}");
    let trace = json(&inside(Path::new(&out), "trace.json"));
    assert!(trace["warnings"][0].as_str().unwrap().starts_with("The readings do not follow the loads"), "{trace}");
    // Nothing of the arm is named by such readings.
    assert!(trace["effects"].as_array().unwrap().iter().all(|effect| effect["at"] == "rig"), "{page}");
}

/// Two columns exchanged in the shipped campaign.
#[test]
fn files_that_say_something_else_are_told_as_such() {
    let folder = folder("exchanged");
    let (campaign, out) = (copy(&folder), inside(&folder, "out"));
    let loads = folder.join("loads.csv");
    let text = fs::read_to_string(&loads).unwrap();
    fs::write(&loads, text.replacen("dx", "du", 1).replacen("dy", "dx", 1).replacen("du", "dy", 1)).unwrap();
    let said = "The files may say something else than what was measured: dx and dy exchanged; with that undone ";
    let path = inside(&folder, "found.json");
    let page = succeed(&["identify", &campaign, "--out", &out, "--json", &path]);
    let warned = json(&path)["warnings"][0].as_str().map(|warning| warning.starts_with(said));
    assert!(page.contains(said) && warned == Some(true), "{page}");
    let page = succeed(&["trace", &campaign, "--out", &out]);
    let warned = json(&inside(Path::new(&out), "trace.json"))["warnings"][0].as_str().map(|one| one.starts_with(said));
    assert!(page.contains(said) && warned == Some(true), "{page}");
}

/// Lengths in another unit than their header says make no description.
#[test]
fn readings_in_another_unit_are_refused() {
    let folder = folder("unit");
    let (campaign, out) = (copy(&folder), inside(&folder, "out"));
    let loads = folder.join("loads.csv");
    let text = fs::read_to_string(&loads).unwrap().replace("[m]", "[mm]");
    fs::write(&loads, text).unwrap();
    let said = fail(1, &["identify", &campaign, "--out", &out]);
    assert!(said.contains("000 times as stiff as declared: "), "{said}");
    assert!(said.contains("a displacement in mm taken for um") && !Path::new(&out).exists(), "{said}");
}

/// A force that is a thousand times too large leaves the others as they are.
#[test]
fn a_row_with_a_wrong_force_is_named() {
    let folder = folder("wrong-force");
    let (campaign, out) = (copy(&folder), inside(&folder, "out"));
    let right = succeed(&["identify", &campaign, "--out", &out]);
    let loads = folder.join("loads.csv");
    let text = fs::read_to_string(&loads).unwrap();
    let column = text.lines().next().unwrap().split(',').position(|name| name.starts_with("Fz")).unwrap();
    let wrong = (1..).zip(text.lines()).map(|(line, row)| {
        let field = |(i, field): (usize, &str)| match line == 20 && i == column {
            true => (1000.0 * field.parse::<f64>().unwrap()).to_string(),
            false => field.to_owned(),
        };
        row.split(',').enumerate().map(field).collect::<Vec<_>>().join(",")
    });
    fs::write(&loads, wrong.collect::<Vec<_>>().join("\n")).unwrap();
    // That it is far larger than all others is warned of.
    let said = run(&["identify", &campaign, "--out", &out]);
    let page = said.out;
    assert!(said.code == 0 && said.err.contains("line 20: a force of 470 kN"), "{}", said.err);
    let named = "line 20 does not belong, and has no part in the fit";
    assert!(page.contains(named) && !right.contains("not belong"), "{page}");
    assert!(!page.contains("at its bound"), "{page}");
}

/// Why a campaign shows no compliance, with its file.
#[test]
fn what_hides_every_compliance_is_told() {
    let folder = folder("nothing");
    let (campaign, out) = (copy(&folder), inside(&folder, "out"));
    let [plan, loads] = ["campaign.yaml", "loads.csv"].map(|name| fs::read_to_string(folder.join(name)).unwrap());
    let told = |plan: &str, loads: &str| {
        fs::write(folder.join("campaign.yaml"), plan).unwrap();
        fs::write(folder.join("loads.csv"), loads).unwrap();
        let said = run(&["identify", &campaign, "--out", &out]);
        assert_eq!((said.code, said.out.as_str()), (1, ""));
        assert!(said.err.contains("campaign.yaml: ") && !Path::new(&out).exists(), "{}", said.err);
        said.err
    };
    let (header, rows) = loads.split_once('\n').unwrap();
    let unloaded = rows.lines().map(|row| {
        let field = |(i, field): (usize, &str)| if (7..10).contains(&i) { "0".to_owned() } else { field.to_owned() };
        row.split(',').enumerate().map(field).collect::<Vec<_>>().join(",")
    });
    let unloaded = format!("{header}\n{}\n", unloaded.collect::<Vec<_>>().join("\n"));
    assert!(told(&plan, &unloaded).contains("every force and moment is zero: nothing pushes the arm"));
    let few = told(&plan, &loads.lines().take(3).collect::<Vec<_>>().join("\n"));
    assert!(few.contains("2 rows at 2 poses cannot tell the 6 compliances of the robot from each other"), "{few}");
    let noisy = told(&format!("{plan}\nnoise: {{displacement: 8}}\n"), &loads);
    assert!(noisy.contains("the noise of 8 m that the campaign declares hides all"), "{noisy}");
    let line = plan.lines().count() + 2;
    let warned = format!("warning: {campaign}: `displacement` of the noise on line {line} is 8 m, more than 10 mm");
    assert!(noisy.contains(&warned), "{noisy}");
}

#[test]
fn predicts_every_row() {
    let folder = folder("predict");
    let (path, table) = (inside(&folder, "error.json"), inside(&folder, "rows.csv"));
    let page = succeed(&["predict", "fanuc-r2000ic", &campaign(), "--json", &path, "--csv", &table]);
    assert!(page.contains("um rms"), "{page}");
    let error = json(&path);
    assert_eq!(keys(&error), ["rows", "rms_um", "p95_um", "max_um"]);
    assert!(page.contains("702.8 um at most (line 18)"), "{page}");
    assert_eq!(error["rows"], 43);
    let [rms, p95, max] = ["rms_um", "p95_um", "max_um"].map(|key| error[key].as_f64().unwrap());
    assert!(rms < p95 && p95 <= max);

    let table = fs::read_to_string(table).unwrap();
    let mut lines = table.lines();
    let head = lines.next().unwrap();
    assert!(head.starts_with("pose,visit,predicted_dx [um],") && head.ends_with(",residual_dz [um],line"), "{head}");
    let numbers = lines.map(|line| line.split(',').skip(8).map(|field| field.parse().unwrap()).collect::<Vec<f64>>());
    let rows: Vec<[f64; 4]> = numbers.map(|numbers| numbers.try_into().unwrap()).collect();
    assert!(rows.iter().zip(2..).all(|(row, line)| row[3] == f64::from(line)), "{rows:?}");
    let residuals: Vec<[f64; 3]> = rows.iter().map(|&[x, y, z, _]| [x, y, z]).collect();
    let squares: f64 = residuals.concat().iter().map(|residual| residual * residual).sum();
    assert!(((squares / (3.0 * 43.0)).sqrt() / rms - 1.0).abs() < 1e-6);
}

/// A column that is wrong is wrong in every row.
#[test]
fn a_problem_of_all_rows_is_shown_once_and_the_others_counted() {
    let folder = folder("many-problems");
    let campaign = copy(&folder);
    let loads = fs::read_to_string(folder.join("loads.csv")).unwrap();
    let rows = loads.lines().skip(1).map(|row| row.replacen(',', ",x", 1));
    let loads = [loads.lines().next().unwrap().to_owned()].into_iter().chain(rows).collect::<Vec<_>>().join("\n");
    fs::write(folder.join("loads.csv"), loads).unwrap();
    let said = fail(1, &["identify", &campaign, "--out", &inside(&folder, "out")]);
    assert_eq!(said.matches("error: ").count(), 1, "{said}");
    assert!(said.contains(".. and 42 more rows like it: lines 3-44"), "{said}");
}

#[test]
fn a_dash_is_no_file() {
    let said = fail(2, &["predict", "fanuc-r2000ic", &campaign(), "--json", "-"]);
    assert!(said.contains("`-` does not stand for standard output"), "{said}");
}

#[test]
fn traces_the_missing_effect_and_writes_everything() {
    let folder = folder("trace");
    let (out, path) = (inside(&folder, "out"), inside(&folder, "copy.json"));
    let page = succeed(&["trace", &campaign(), "--out", &out, "--json", &path]);
    assert!(page.contains("as declared") && page.contains("Verdict: "), "{page}");
    // What goes into the robot, and what is of the measurement, apart.
    let (robot, rig) = page.split_once("\nFaults of the measurement, corrected for, not written").unwrap();
    let rig = rig.split("\nSuspected").next().unwrap();
    assert!(rig.contains("lever_arm@rig: x = ") && !robot.contains("    lever_arm@rig"), "{page}");
    // What others found in these data: the tilt of joint 3, or what looks like it.
    let bends = |name: &str| page.contains(&format!("    {name}: "));
    assert!(bends("transverse_compliance@joint 3") || bends("link_compliance@link 3"), "{page}");
    assert!(page.contains("    probability ") && page.contains(" of the searches\n"), "{page}");
    // One sentence for what cannot be asked.
    assert_eq!(page.matches("further check").count(), 1, "{page}");
    let out = Path::new(&out);
    assert_eq!(names(out), ["report.html", "robot.yaml", "trace.json"]);
    let trace = json(&inside(out, "trace.json"));
    assert_eq!(trace, json(&path));
    assert_eq!(
        keys(&trace),
        [
            "robot",
            "rows",
            "poses",
            "noise_um",
            "before",
            "effects",
            "suspected",
            "after",
            "written",
            "verdict",
            "why",
            "unexplained",
            "nested",
            "warnings",
            "numbers",
            "rivals",
            "invisible",
            "triage",
            "next"
        ]
    );
    assert_eq!(keys(&trace["before"]), ["declared", "identified"]);
    assert_eq!(keys(&trace["before"]["declared"]), ["rms_um", "holdout_rms_um"]);
    assert_eq!(keys(&trace["after"]), ["rms_um", "holdout_rms_um"]);
    assert_eq!(keys(&trace["unexplained"]), ["fraction", "depends_on", "looks_like"]);
    let [effects, suspected] = ["effects", "suspected"].map(|key| trace[key].as_array().unwrap().clone());
    let effect = effects.iter().find(|effect| effect["kind"] == "lever_arm").unwrap();
    assert_eq!(
        keys(effect),
        [
            "kind",
            "at",
            "parameters",
            "probability",
            "class",
            "recurs",
            "p_value",
            "holdout_rms_um",
            "same_as",
            "partial",
            "lines"
        ]
    );
    assert!(effect["probability"].as_f64().unwrap() >= 0.95 && effect["recurs"].as_f64().unwrap() >= 0.8, "{effect}");
    assert_eq!(keys(&effect["class"][0]), ["name", "probability"]);
    assert_eq!(effect["class"][0]["name"], "lever_arm@rig");
    for one in &suspected {
        let expected = ["kind", "at", "parameters", "probability", "class", "recurs", "why_not"];
        assert_eq!(keys(one), expected);
        assert!(!one["why_not"].as_str().unwrap().is_empty(), "{one}");
    }
    assert_eq!(trace["nested"]["folds"], 5);
    assert_eq!(trace["nested"]["rms_um"], trace["after"]["holdout_rms_um"]);
    assert_eq!(keys(&effect["parameters"][0]), ["name", "value", "std", "unit"]);

    // The loop closes: the robot that was written is better than the declared
    // one, though the faults of the rig are still in the readings.
    let after = trace["after"]["rms_um"].as_f64().unwrap();
    let predicted = predicted(&inside(out, "robot.yaml"), &folder);
    let predicted = predicted["rms_um"].as_f64().unwrap();
    assert!(after < predicted && predicted < trace["before"]["declared"]["rms_um"].as_f64().unwrap());
    succeed(&["show", &inside(out, "robot.yaml")]);
    succeed(&["emit", &inside(out, "robot.yaml")]);

    let report = fs::read_to_string(out.join("report.html")).unwrap();
    for part in [
        "not written into the robot",
        "What is suspected",
        "How it was found",
        "class=\"arrow before\"",
        "class=\"arrow after\"",
        "Where the residuals are",
    ] {
        assert!(report.contains(part), "{part}");
    }
    assert!(report.contains("FanucR2000ic") && report.contains("<svg") && report.contains("verdict: "));
    let report = report.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    assert!(!report.contains("http:") && !report.contains("https:") && !report.contains("<script"));
    assert!(!report.contains("NaN"));
}

#[test]
fn one_seed_gives_one_result_over_an_older_one() {
    let folder = folder("seed");
    let out = inside(&folder, "out");
    let arguments = ["trace", &campaign(), "--out", &out, "--seed", "7"];
    let first = (succeed(&arguments), json(&inside(Path::new(&out), "trace.json")));
    let second = (succeed(&arguments), json(&inside(Path::new(&out), "trace.json")));
    assert_eq!(first, second);
    assert_eq!(names(Path::new(&out)).len(), 3);
}

#[test]
fn the_search_is_repeated_without_some_poses() {
    let folder = folder("nested");
    let out = inside(&folder, "out");
    let page = succeed(&["trace", &campaign(), "--nested", "2", "--out", &out]);
    let nested = &json(&inside(Path::new(&out), "trace.json"))["nested"];
    assert_eq!(keys(nested), ["folds", "rms_um", "identified_rms_um", "names"]);
    assert_eq!(nested["folds"], 2);
    assert_eq!(keys(&nested["names"][0]), ["name", "share"]);
    let report = fs::read_to_string(Path::new(&out).join("report.html")).unwrap();
    let errors = ["identified_rms_um", "rms_um"].map(|key| format!("{:.1}", nested[key].as_f64().unwrap()));
    for text in [&page, &report] {
        assert!(text.contains("The whole search was repeated 2 times"), "{text}");
        assert!(text.contains(&errors[0]) && text.contains(&errors[1]), "{errors:?}: {text}");
    }
}

/// Each pose by itself where there are no more of them than parts asked for.
#[test]
fn folds_that_cannot_be_are_refused() {
    let folder = folder("folds");
    let out = inside(&folder, "out");
    for folds in ["0", "1", "-2", "few"] {
        assert_eq!(run(&["trace", &campaign(), "--nested", folds, "--out", &out]).code, 2, "{folds}");
    }
    // What follows is no number of folds.
    let said = fail(2, &["trace", &campaign(), "--nested", "--out", &out, "--seed", "-3"]);
    assert!(said.contains("--seed"), "{said}");
    assert!(!Path::new(&out).exists());
}

#[test]
fn options_of_earlier_versions_are_wrong_usage() {
    for option in [&["--alpha", "0.05"][..], &["--draws", "499"], &["--correction"]] {
        let ran = run(&[&["trace", &campaign(), "--out", "nowhere"][..], option].concat());
        assert_eq!(ran.code, 2, "{option:?}");
    }
}

#[test]
fn what_is_wrong_with_a_table_is_said_where_it_is_and_nothing_is_written() {
    let folder = folder("wrong-table");
    let (campaign, out) = (copy(&folder), inside(&folder, "out"));
    let loads = fs::read_to_string(folder.join("loads.csv")).unwrap();
    fs::write(folder.join("loads.csv"), loads.replacen("-0.000686", "often", 1)).unwrap();
    for arguments in [
        &["identify", &campaign, "--out", &out][..],
        &["trace", &campaign, "--out", &out, "--json", &inside(&folder, "x.json")],
        &["predict", "fanuc-r2000ic", &campaign, "--csv", &inside(&folder, "rows.csv")],
    ] {
        let message = fail(1, arguments);
        assert!(message.contains("loads.csv:2:") && message.contains("often"), "{message}");
    }
    assert_eq!(names(&folder), ["campaign.yaml", "loads.csv", "robot.yaml"]);
}

#[test]
fn numbers_beyond_all_sums_are_told_where_they_are() {
    let folder = folder("too-large");
    let campaign = copy(&folder);
    let loads = fs::read_to_string(folder.join("loads.csv")).unwrap();
    fs::write(folder.join("loads.csv"), loads.replacen("-0.000686", "1e200", 1)).unwrap();
    let message = fail(1, &["predict", "fanuc-r2000ic", &campaign, "--json", &inside(&folder, "error.json")]);
    assert!(message.contains("`1e200` in SI units is too large") && message.contains("loads.csv:2:118"), "{message}");
    assert_eq!(names(&folder), ["campaign.yaml", "loads.csv", "robot.yaml"]);
}

#[test]
fn another_robot_is_refused_by_its_joints() {
    let message = fail(1, &["predict", "rv130hsc", &campaign()]);
    assert!(message.contains("6 joints") && message.contains('5'), "{message}");
}
