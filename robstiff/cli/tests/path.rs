//! `path`: joint coordinates of a tool path, in and out.

mod common;

use std::fs;
use std::path::Path;

use common::{fail, file, folder, inside, json, keys, run, succeed};

fn pocket() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/commands/files/pocket.csv").to_str().unwrap().to_owned()
}

#[test]
fn a_pocket_is_solved_written_and_read_again() {
    let folder = folder("path");
    let (out, told) = (inside(&folder, "solved.csv"), inside(&folder, "told.json"));
    let page = succeed(&["path", "rv130hsc", &pocket(), "--tool-axis", "x", "--out", &out, "--json", &told]);
    let points = fs::read_to_string(pocket()).unwrap().lines().count() - 1;
    assert!(page.contains(&format!("{points} points")) && page.contains("all reached (closed form)"), "{page}");
    assert!(!page.contains("changes its posture"), "{page}");
    let document = json(&told);
    assert_eq!(keys(&document), ["robot", "closed_form", "length_m", "points", "jumps"]);
    let first = &document["points"][0];
    assert!((first["position_m"][0].as_f64().unwrap() - 1.5).abs() < 1e-9);
    assert!((first["feed_m_per_s"].as_f64().unwrap() - 0.06).abs() < 1e-15);

    let again = inside(&folder, "again.csv");
    let ran = run(&["path", "rv130hsc", &out, "--out", &again]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("the joint coordinates are used, not the poses"), "{}", ran.err);
    let numbers = |file: &str| -> Vec<f64> {
        let text = fs::read_to_string(file).unwrap();
        text.lines().skip(1).flat_map(|line| line.split(',').map(|field| field.parse().unwrap())).collect()
    };
    for (one, other) in numbers(&out).iter().zip(numbers(&again)) {
        assert!((one - other).abs() < 2e-6, "{one} {other}");
    }
}

#[test]
fn unreachable_points_are_named_and_nothing_is_written() {
    let folder = folder("path-unreachable");
    let far = inside(&folder, "far.csv");
    fs::write(&far, fs::read_to_string(pocket()).unwrap().replace("1520,0,", "5520,0,")).unwrap();
    let out = inside(&folder, "solved.csv");
    let said = fail(1, &["path", "abb-irb6640-185-280", &far, "--out", &out]);
    assert!(said.contains("far.csv:3:1") && said.contains("out of reach"), "{said}");
    assert!(said.contains("points cannot be reached"), "{said}");
    assert!(!Path::new(&out).exists());
}

#[test]
fn a_path_is_placed_and_begun_as_asked() {
    let at = ["--place", "-100 mm, 200 mm, 0, 0, 0, 10 deg"];
    let page = succeed(&["path", "kuka-kr270-r2700", &pocket(), at[0], at[1], "--start", "0,-90 deg,90 deg,0,0,0"]);
    assert!(page.contains("all reached"), "{page}");
    let said = fail(2, &["path", "kuka-kr270-r2700", &pocket(), "--place", "1,2,3"]);
    assert!(said.contains("--place gives 3 numbers, six are needed"), "{said}");
    let said = fail(2, &["path", "kuka-kr270-r2700", &pocket(), "--start", "0,0"]);
    assert!(said.contains("--start gives 2 joint coordinates"), "{said}");
}

#[test]
fn a_cut_deviates_breaks_a_tolerance_and_is_corrected() {
    let folder = folder("path-cut");
    let (out, told) = (inside(&folder, "corrected.csv"), inside(&folder, "told.json"));
    let cut = ["--cut", &file("roughing.yaml"), "--against", &file("fast.yaml"), "--tolerance", "20 um"];
    let arm = ["path", "rv130hsc", &pocket(), "--tool-axis", "x"];
    let page = succeed(&[&arm[..], &cut, &["--compensate", "--out", &out, "--json", &told]].concat());
    for part in
        ["distance from the path", "tolerance 20.0 um: broken at", "there the error comes from joint", "Two cuts"]
    {
        assert!(page.contains(part), "{part}\n{page}");
    }
    let deviation = &json(&told)["deviation"];
    let shares = deviation["shares"].as_array().unwrap();
    let sum: f64 = shares.iter().map(|share| share["share"].as_f64().unwrap()).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    let worst = deviation["distance"]["worst_m"].as_f64().unwrap();
    for point in deviation["corrected"]["points"].as_array().unwrap() {
        assert!(point["remaining_m"].as_f64().unwrap() < 0.02 * worst);
    }
    let all = &deviation["corrected"]["left_if_wrong"]["all"];
    for (which, expected) in [("softer", 0.1 / 1.1), ("stiffer", 0.1 / 0.9)] {
        assert!((all[which]["rms"].as_f64().unwrap() - expected).abs() < 0.01, "{all}");
    }
    let cuts = deviation["compared"].as_array().unwrap();
    let [rate, error] =
        ["removal_m3_per_s", "error_m"].map(|key| cuts[1][key].as_f64().unwrap() / cuts[0][key].as_f64().unwrap());
    assert!((rate - 1.0).abs() < 1e-9 && (0.4..0.6).contains(&error), "{rate} {error}");

    // What is written is read again, and can be looked at.
    let ran = run(&["path", "rv130hsc", &out]);
    assert!(ran.code == 0 && !ran.err.contains("is not used"), "{}", ran.err);
    let page = inside(&folder, "page.html");
    succeed(&["view", "rv130hsc", "--path", &out, "--column", "deviation", "--out", &page]);
}

#[test]
fn forces_that_do_not_fit_the_path_are_refused() {
    let folder = folder("path-forces");
    let forces = inside(&folder, "forces.csv");
    let with = |text: &str| {
        fs::write(&forces, text).unwrap();
        ["path", "kuka-kr270-r2700", &pocket(), "--forces", &forces].map(str::to_owned)
    };
    let arguments = with("Fx,Fy,Fz\n1,2,3\n");
    let said = fail(1, &arguments.each_ref().map(String::as_str));
    assert!(said.contains("here is 1 row, the path has 40 points"), "{said}");
    let arguments = with("Fx,Fy\n1,2\n");
    let said = fail(1, &arguments.each_ref().map(String::as_str));
    assert!(said.contains("the column `Fz` is missing"), "{said}");
    let arguments = with("s [m],Fx [N],Fy [N],Fz [kN]\n0,100,0,-0.2\n5,100,0,-0.2\n");
    let page = succeed(&arguments.each_ref().map(String::as_str));
    assert!(page.contains("Deviation under"), "{page}");
    let said = fail(2, &["path", "kuka-kr270-r2700", &pocket(), "--compensate"]);
    assert!(said.contains("--compensate needs a force"), "{said}");
}

#[test]
fn every_point_that_cannot_be_corrected_is_named() {
    let folder = folder("path-uncorrectable");
    let (forces, out) = (inside(&folder, "forces.csv"), inside(&folder, "out.csv"));
    // The first two points are hardly pushed, all others by metres.
    let rows = [["100,0,-200\n"; 2].concat(), "0,1e7,-1e7\n".repeat(38)].concat();
    fs::write(&forces, format!("Fx [N],Fy [N],Fz [N]\n{rows}")).unwrap();
    let path = ["path", "kuka-kr270-r2700", &pocket(), "--forces", &forces, "--compensate", "--out", &out];
    let said = fail(1, &path);
    assert_eq!(said.matches("--> ").count(), 10, "{said}");
    assert!(said.trim_end().ends_with("38 of 40 points cannot be corrected: lines 4 to 41"), "{said}");
    assert!(!Path::new(&out).exists());
}

#[test]
fn points_without_a_force_are_in_no_mean() {
    let folder = folder("path-air");
    let (forces, told) = (inside(&folder, "forces.csv"), inside(&folder, "told.json"));
    let [before, after] = [9, 20].map(|count| "0,0,0\n".repeat(count));
    fs::write(&forces, format!("Fx [N],Fy [N],Fz [N]\n{before}{}{after}", "80,-60,-20\n".repeat(11))).unwrap();
    let path = ["path", "rv130hsc", &pocket(), "--tool-axis", "x", "--forces", &forces, "--json", &told];
    let page = succeed(&[&path[..], &["--tolerance", "50 um"]].concat());
    let told = &json(&told)["deviation"];
    assert!(page.contains("[um], over the 11 of 40 points with a force\n"), "{page}");
    assert!(page.contains("broken at 3 of the 11 points judged, of 40\n"), "{page}");
    assert_eq!(told["points_with_force"], 11);
    // Under one force the arm is off by nearly as much at each of the eleven.
    let [mean, worst] = ["mean_m", "worst_m"].map(|key| told["distance"][key].as_f64().unwrap());
    assert!(mean > 0.95 * worst, "{told}");
}

#[test]
fn an_arm_that_lags_out_of_the_cut_breaks_no_tolerance() {
    let folder = folder("path-lag");
    let [forces, told, robot] = ["forces.csv", "told.json", "robot.yaml"].map(|name| inside(&folder, name));
    let of_catalogue = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/kuka-kr270-r2700.yaml");
    let lag =
        |joint: u8| format!("  - {{kind: hysteresis, at: joint {joint}, radius1: 100 Nm, weight1: 1e-6 rad/Nm}}\n");
    let effects = [1, 2, 3].map(lag).concat();
    fs::write(&robot, format!("{}\neffects:\n{effects}", fs::read_to_string(of_catalogue).unwrap())).unwrap();
    let rows = ["100,800,-300\n".repeat(4), "0,0,0\n".repeat(36)].concat();
    fs::write(&forces, format!("Fx,Fy,Fz\n{rows}")).unwrap();
    let path = ["path", &robot, &pocket(), "--forces", &forces, "--tolerance", "0.05 mm", "--json", &told];
    let page = run(&path).out;
    assert!(page.contains("broken at 4 of the 4 points judged, of 40\n"), "{page}");
    let told = &json(&told)["deviation"];
    let stretches = told["tolerance"]["stretches"].as_array().unwrap();
    let lines: Vec<_> = stretches.iter().map(|each| (each["lines"].to_string(), each["holds"].clone())).collect();
    assert_eq!(lines, [("[2,5]".to_owned(), false.into()), ("[6,41]".to_owned(), true.into())]);
    assert!(stretches[1]["worst_m"].is_null() && told["tolerance"]["judged"] == 4, "{told}");
    // The lag itself stays to be seen.
    assert!(told["points"][6]["error_m"].as_f64().unwrap().abs() > 5e-5, "{told}");
}

/// A tool that plunges has no wall that could be off.
#[test]
fn a_tolerance_is_told_of_the_points_that_have_an_error() {
    let folder = folder("path-judged");
    let [path, forces, told] = ["path.csv", "forces.csv", "told.json"].map(|name| inside(&folder, name));
    let tolerance = |size: &str, sideways: &[&str]| {
        let down = [".70", ".68", ".66"].map(|z| format!("1.7,0,{z},0,0,-1\n")).concat();
        fs::write(&path, format!("x,y,z,ux,uy,uz\n{down}{}", sideways.concat())).unwrap();
        fs::write(&forces, format!("Fx,Fy,Fz\n{}", "0,0,300\n".repeat(3 + sideways.len()))).unwrap();
        let asked = ["path", "kuka-kr270-r2700", &path, "--forces", &forces, "--tolerance", size, "--json", &told];
        let page = succeed(&asked);
        let tolerance = json(&told)["deviation"]["tolerance"].clone();
        (page, tolerance)
    };
    let (page, of_none) = tolerance("1 um", &[]);
    assert!(page.contains("\ntolerance 1.0 um: no point has an error to judge\n"), "{page}");
    assert!(of_none["holds"].is_null() && of_none["judged"] == 0, "{of_none}");
    assert!(of_none["stretches"][0]["worst_m"].is_null(), "{of_none}");
    let sideways = ["1.7,0.02,.66,0,0,-1\n", "1.7,0.04,.66,0,0,-1\n"];
    let (page, broken) = tolerance("1 um", &sideways);
    assert!(page.contains("broken at 3 of the 3 points judged, of 5\n"), "{page}");
    assert!(broken["holds"] == false && broken["judged"] == 3, "{broken}");
    let (page, held) = tolerance("5 mm", &sideways);
    assert!(page.contains("holds at the 3 of 5 points judged\n"), "{page}");
    assert_eq!(held["holds"], true);
}

/// What `stability` says in one pose is what `path` says at that place.
#[test]
fn chatter_along_a_path_is_that_of_each_pose() {
    let folder = folder("path-chatter");
    let [path, told, limits, modes, cut] =
        ["path.csv", "told.json", "limits.json", "modes.yaml", "cut.yaml"].map(|name| inside(&folder, name));
    let docs = |file: &str| {
        let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/commands/files");
        fs::read_to_string(files.join(file)).unwrap()
    };
    fs::write(&modes, docs("modes.yaml")).unwrap();
    let points: String = (0..4).map(|k| format!("{},0,600,0,0,-1\n", 1500 + 20 * k)).collect();
    fs::write(&path, format!("x [mm],y [mm],z [mm],ux,uy,uz\n{points}")).unwrap();
    let robot = "kuka-kr270-r2700";
    let along = |depth: &str| {
        fs::write(&cut, docs("roughing.yaml").replace("depth: 2 mm", &format!("depth: {depth}"))).unwrap();
        let arguments = ["path", robot, &path, "--tool-axis", "x", "--cut", &cut, "--modes", &modes, "--json", &told];
        (succeed(&arguments), json(&told))
    };
    let (said, shallow) = along("2 mm");
    assert!(said.contains("The arm chatters at none of 4 places"), "{said}");
    let q: Vec<String> = shallow["points"][1]["q"].as_array().unwrap().iter().map(ToString::to_string).collect();
    let at = ["stability", robot, &cut, "--at", &q.join(","), "--tool-axis", "x", "--modes", &modes, "--json", &limits];
    succeed(&at);
    // The first feed is along x of the base frame.
    let limit = json(&limits)["feeds"][0]["limiting_depth_m"].as_f64().unwrap();
    let place = |told: &serde_json::Value| told["chatter"]["places"][1].clone();
    assert!((place(&shallow)["margin"].as_f64().unwrap() * 2e-3 / limit - 1.0).abs() < 1e-6, "{limit}");
    let (said, deep) = along("6 mm");
    assert!(said.contains("The arm chatters at 4 of 4 places, 60 of 60 mm"), "{said}");
    assert!((place(&deep)["margin"].as_f64().unwrap() * 6e-3 / limit - 1.0).abs() < 1e-6, "{deep}");
    assert!(place(&deep)["mended_rad_per_s"].as_f64().unwrap() > 9000.0 * core::f64::consts::TAU / 60.0);

    let no_masses = ["path", robot, &path, "--tool-axis", "x", "--cut", &cut, "--damping", "0.02"];
    assert!(fail(1, &no_masses).contains("--modes MODES.yaml"));
    assert!(fail(2, &["path", robot, &path, "--tool-axis", "x", "--modes", &modes]).contains("--modes needs a force"));
}
