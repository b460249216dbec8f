//! What the commands of machining say to input that cannot be meant.

mod common;

use std::fs;

use common::{changed, fail, file, folder, inside, json, names, rigid, run, succeed};

#[test]
fn quantities_without_a_unit_are_refused() {
    let (pocket, cut) = (file("pocket.csv"), file("roughing.yaml"));
    let path = ["path", "rv130hsc", &pocket, "--tool-axis", "x", "--cut", &cut, "--tolerance"];
    let said = fail(2, &[&path[..], &["0.1"]].concat());
    assert!(said.contains("`0.1` has no unit; write e.g. `0.1 mm`"), "{said}");
    let said = fail(2, &[&path[..], &["-0.1 mm"]].concat());
    assert!(said.contains("a length above zero is expected here"), "{said}");
    let said = fail(2, &["path", "rv130hsc", &pocket, "--place", "0, 0, 0, 0, 0, 40"]);
    assert!(said.contains("--place: `40` has no unit; write e.g. `40 deg`"), "{said}");
    let said = fail(2, &["online", "rv130hsc", &pocket, "--tool-axis", "x", "--cut", &cut, "--step", "4"]);
    assert!(said.contains("`4` has no unit; write e.g. `4 ms`"), "{said}");
    let said = fail(2, &["map", "kuka-kr270-r2700", &file("table.yaml"), "--place", "400 x 300 x 0"]);
    assert!(said.contains("has no unit"), "{said}");
}

#[test]
fn options_that_would_be_ignored_are_refused() {
    let pocket = file("pocket.csv");
    let path = ["path", "rv130hsc", &pocket, "--tool-axis", "x"];
    let said = fail(2, &[&path[..], &["--force-frame", "tool"]].concat());
    assert!(said.contains("required arguments were not provided"), "{said}");
    let fast = file("fast.yaml");
    for more in [&["--surface", "face"][..], &["--spindle-axis", "-z"], &["--peak"], &["--against", &fast]] {
        let said = fail(2, &[&path[..], more].concat());
        assert!(said.contains(&format!("{} needs a force: give `--cut CUT.yaml`", more[0])), "{more:?}: {said}");
    }
    let cut = file("roughing.yaml");
    fail(2, &[&path[..], &["--cut", &cut, "--force-frame", "tool"]].concat());
    fail(2, &["path", "rv130hsc", &pocket, "--tool-axis", "--x"]);
}

#[test]
fn a_cut_without_units_is_doubted() {
    let folder = folder("machining-units");
    let cut = changed(&folder, "roughing.yaml", ["depth: 2 mm", "depth: 2"]);
    let ran = run(&["forces", &cut]);
    assert_eq!(ran.code, 0);
    assert!(ran.err.contains("`depth` has no unit and is taken in m: is it in mm?"), "{}", ran.err);
    assert!(ran.out.contains("2000 mm deep") && ran.out.contains("9000 rpm"), "{}", ran.out);
    assert_eq!(run(&["forces", &file("roughing.yaml")]).err, "");
    // Of a measured force there is the speed alone.
    fs::write(folder.join("record.csv"), "t [s],Fx,Fy,Fz\n0,0,0,0\n0.001,100,50,-20\n").unwrap();
    let cut = inside(&folder, "measured.yaml");
    fs::write(&cut, "speed: 9000\nmeasured: {file: record.csv, frame: cut, on: tool}\n").unwrap();
    let ran = run(&["forces", &cut]);
    assert!(ran.err.contains("`speed` has no unit and is taken in rad/s: is it in rpm?"), "{}", ran.err);
}

#[test]
fn a_path_at_another_feed_than_its_cut_is_told() {
    let folder = folder("machining-feed");
    let cut = file("roughing.yaml");
    let slow = changed(&folder, "pocket.csv", [",3600", ",1200"]);
    for command in ["path", "online"] {
        let ran = run(&[command, "rv130hsc", &slow, "--tool-axis", "x", "--cut", &cut]);
        assert_eq!(ran.code, 0, "{}", ran.err);
        assert!(ran.err.contains("pocket.csv:2: the path's feed is 1200 mm/min"), "{}", ran.err);
        assert!(ran.err.contains("3600 mm/min"), "{}", ran.err);
        let ran = run(&[command, "rv130hsc", &file("pocket.csv"), "--tool-axis", "x", "--cut", &cut]);
        assert_eq!(ran.err, "");
    }
}

#[test]
fn an_arm_that_does_not_yield_is_told() {
    let folder = folder("machining-rigid");
    let arm = rigid(&folder);
    let (cut, pocket, table) = (file("roughing.yaml"), file("pocket.csv"), file("table.yaml"));
    for asked in [
        &["stability", &arm, &cut, "--frequency", "15 Hz"][..],
        &["stability", &arm, &cut],
        &["online", &arm, &pocket, "--cut", &cut],
        &["online", &arm, "--force", "0, 0, -400 N"],
        &["path", &arm, &pocket, "--cut", &cut, "--compensate"],
        &["map", &arm, &table, "--place", "400 x 300 x 0 mm"],
    ] {
        let said = fail(1, asked);
        assert!(said.contains("MillingArm180 is rigid, nothing moves its tool"), "{asked:?}: {said}");
    }
    let page = inside(&folder, "page.html");
    let ran = run(&["view", &arm, "--out", &page]);
    assert!(ran.err.contains("MillingArm180 is rigid"), "{}", ran.err);
    let ran = run(&["map", &arm, &table]);
    assert!(ran.err.contains("MillingArm180 is rigid"), "{}", ran.err);
}

#[test]
fn a_cut_along_the_tool_has_no_direction() {
    let folder = folder("machining-point");
    let first: Vec<String> = fs::read_to_string(file("pocket.csv")).unwrap().lines().take(2).map(Into::into).collect();
    let path = inside(&folder, "point.csv");
    fs::write(&path, first.join("\n")).unwrap();
    let out = inside(&folder, "out.csv");
    let cut = file("roughing.yaml");
    let said = fail(1, &["path", "rv130hsc", &path, "--tool-axis", "x", "--cut", &cut, "--out", &out]);
    assert!(said.contains("has no direction anywhere"), "{said}");
    assert_eq!(names(&folder), ["point.csv"]);
}

#[test]
fn recorded_forces_along_fixed_axes_need_no_direction() {
    let folder = folder("machining-drill");
    let [path, cut, told, out] = ["down.csv", "drill.yaml", "told.json", "side.json"].map(|name| inside(&folder, name));
    fs::write(&path, "x,y,z,ux,uy,uz\n1.7,0,0.70,0,0,-1\n1.7,0,0.68,0,0,-1\n").unwrap();
    fs::write(folder.join("thrust.csv"), "Fx,Fy,Fz\n0,0,300\n").unwrap();
    let arm = "kuka-kr270-r2700";
    // The joints are all at 0: the tool points along x.
    let online = ["online", arm, "--at", "0,0,0,0,0,0", "--toward", "1,0,0", "--cut", &cut];
    for frame in ["base", "tool"] {
        fs::write(&cut, format!("measured: {{file: thrust.csv, frame: {frame}, on: tool}}\n")).unwrap();
        succeed(&["path", arm, &path, "--cut", &cut, "--surface", "face", "--json", &told]);
        let told = &json(&told)["deviation"];
        assert_eq!((&told["points_with_force"], told["lines_without_direction"].to_string()), (&2.into(), "[]".into()));
        // Where there is no wall, it has no error.
        let side = ["path", arm, &path, "--cut", &cut, "--surface", "side", "--against", &cut, "--json", &out];
        let said = succeed(&side);
        let told = &json(&out)["deviation"];
        assert!(told["error"].is_null() && told["distance"]["worst_m"].as_f64().unwrap() > 0.0, "{told}");
        assert!(told["compared"][0]["error_m"].is_null() && told["compared"][0]["distance_m"].is_number(), "{told}");
        let of_wall = said.lines().find(|line| line.trim_start().starts_with("error of the wall")).unwrap();
        assert_eq!(of_wall.split_whitespace().filter(|word| *word == "-").count(), 3, "{of_wall}");
        succeed(&online);
    }
    fs::write(&cut, "measured: {file: thrust.csv, frame: cut, on: tool}\n").unwrap();
    let said = fail(1, &["path", arm, &path, "--cut", &cut]);
    assert!(said.contains("has no direction anywhere"), "{said}");
    assert!(fail(2, &online).contains("--toward goes along the tool's axis"));
}

/// Fifteen revolutions from a sample to the next would be one angle.
#[test]
fn a_record_that_does_not_resolve_a_revolution_is_told() {
    let folder = folder("machining-coarse");
    let [cut, out] = ["cut.yaml", "out.csv"].map(|name| inside(&folder, name));
    fs::write(folder.join("dyn.csv"), "t [s],Fx,Fy,Fz\n0,0,0,0\n0.1,100,50,-20\n0.2,120,60,-22\n0.3,0,0,0\n").unwrap();
    fs::write(&cut, "speed: 9000 rpm\nmeasured: {file: dyn.csv, frame: cut, on: workpiece}\n").unwrap();
    let page = succeed(&["forces", &cut]);
    assert!(page.contains("does not resolve a revolution: it is shorter, or coarser"), "{page}");
    let of_feed = page.lines().find(|line| line.trim_start().starts_with("feed")).unwrap();
    assert_eq!(of_feed.split_whitespace().collect::<Vec<_>>(), ["feed", "-55.0", "-120.0", "0.0"], "{page}");
    let said = fail(1, &["forces", &cut, "--csv", &out]);
    assert!(said.contains("so nobody can tell what a revolution is"), "{said}");
    assert_eq!(names(&folder), ["cut.yaml", "dyn.csv"]);
}

#[test]
fn a_path_that_is_not_solved_is_not_drawn() {
    let folder = folder("machining-unsolved");
    let page = inside(&folder, "page.html");
    let said = fail(1, &["view", "rv130hsc", "--path", &file("pocket.csv"), "--out", &page]);
    assert!(said.contains("no joint coordinates `q1` ..") && said.contains("robstiff path"), "{said}");
    let solved = inside(&folder, "solved.csv");
    let cut = file("roughing.yaml");
    let path = ["path", "rv130hsc", &file("pocket.csv"), "--tool-axis", "x", "--cut", &cut, "--out", &solved];
    succeed(&path);
    let said = succeed(&["view", "rv130hsc", "--path", &solved, "--column", "deviation [um]", "--out", &page]);
    assert!(said.contains("deviation: "), "{said}");
}

#[test]
fn a_path_that_is_corrected_already_is_told() {
    let folder = folder("machining-corrected");
    let (corrected, cut, pocket) = (inside(&folder, "corrected.csv"), file("roughing.yaml"), file("pocket.csv"));
    let path = ["path", "rv130hsc", &pocket, "--tool-axis", "x", "--cut", &cut, "--compensate", "--out", &corrected];
    succeed(&path);
    let ran = run(&["path", "rv130hsc", &corrected, "--tool-axis", "x", "--cut", &cut, "--compensate"]);
    assert_eq!(ran.code, 0);
    assert!(ran.err.contains("the path is corrected already"), "{}", ran.err);
}

#[test]
fn the_three_ways_to_a_deflection_agree() {
    let folder = folder("machining-agree");
    let (solved, seen) = (inside(&folder, "solved.csv"), inside(&folder, "seen.json"));
    let cut = file("roughing.yaml");
    succeed(&["path", "rv130hsc", &file("pocket.csv"), "--tool-axis", "x", "--cut", &cut, "--out", &solved]);
    let text = fs::read_to_string(&solved).unwrap();
    let (header, row) = (text.lines().next().unwrap(), text.lines().nth(20).unwrap());
    let field = |name: &str| {
        let at = header.split(',').position(|column| column == name).unwrap();
        row.split(',').nth(at).unwrap().to_owned()
    };
    let q: Vec<String> = (1..=5).map(|k| format!("{} deg", field(&format!("q{k} [deg]")))).collect();
    let force = ["Fx [N]", "Fy [N]", "Fz [N]"].map(&field);
    let page = inside(&folder, "page.html");
    let at = ["--at", &q.join(","), "--force", &format!("{} N", force.join(" N, "))];
    succeed(&[&["view", "rv130hsc", "--out", &page, "--json", &seen], &at[..]].concat());
    let viewed = json(&seen)["value"]["most"].as_f64().unwrap();
    assert!((viewed / field("deviation [um]").parse::<f64>().unwrap() - 1.0).abs() < 1e-4, "{viewed}");

    let cell = inside(&folder, "cell.yaml");
    let mut joints: Vec<String> = q.iter().map(|q| format!("  - {q}\n")).collect();
    joints[3] = "  - {from: 0 deg, to: 1 deg, count: 2}\n".to_owned();
    fs::write(&cell, format!("force: [{} N]\njoints:\n{}", force.join(" N, "), joints.concat())).unwrap();
    let mapped = inside(&folder, "cell.csv");
    succeed(&["map", "rv130hsc", &cell, "--csv", &mapped]);
    let text = fs::read_to_string(&mapped).unwrap();
    let value: f64 = text.lines().nth(1).unwrap().split(',').nth(1).unwrap().parse().unwrap();
    assert!((value / viewed - 1.0).abs() < 1e-5, "{text} {viewed}");
}

#[test]
fn a_cut_as_deep_as_nothing_is_refused() {
    let folder = folder("machining-deep");
    let cut = changed(&folder, "roughing.yaml", ["depth: 2 mm", "depth: 1e9 mm"]);
    let said = fail(1, &["forces", &cut]);
    assert!(said.contains("1000 times as deep as the tool is wide"), "{said}");
}

#[test]
fn one_greatest_force_is_told_everywhere() {
    let folder = folder("machining-peak");
    let told = inside(&folder, "told.json");
    for samples in ["360", "4"] {
        let page = succeed(&["forces", &file("roughing.yaml"), "--samples", samples, "--json", &told]);
        let peak = json(&told)["peak_N"].as_f64().unwrap();
        assert!(page.contains(&format!("greatest force {peak:.1} N")), "{peak}\n{page}");
    }
}

/// What is said of the second cut names that one.
#[test]
fn the_cut_to_compare_with_is_looked_at_as_well() {
    let folder = folder("machining-against");
    let (cut, pocket) = (file("roughing.yaml"), file("pocket.csv"));
    let path = ["path", "rv130hsc", &pocket, "--tool-axis", "x", "--cut", &cut, "--against"];
    fs::write(folder.join("record.csv"), "Fx,Fy,Fz\n100,50,-20\n").unwrap();
    let record = inside(&folder, "record.yaml");
    fs::write(&record, "measured: {file: record.csv, frame: cut, on: tool}\n").unwrap();
    let said = fail(1, &[&path[..], &[&record, "--peak"]].concat());
    assert!(said.starts_with(&format!("error: {record}: the record has neither")), "{said}");

    let (down, along_base) = (inside(&folder, "down.csv"), inside(&folder, "base.yaml"));
    fs::write(&down, "x,y,z,ux,uy,uz\n1.7,0,0.70,0,0,-1\n1.7,0,0.68,0,0,-1\n").unwrap();
    fs::write(&along_base, "measured: {file: record.csv, frame: base, on: tool}\n").unwrap();
    let said = fail(1, &["path", "kuka-kr270-r2700", &down, "--cut", &along_base, "--against", &record]);
    assert!(said.contains(&format!("so {record} has no direction anywhere")), "{said}");
}

/// The pocket's 8 mm of the cut's file are a slot for the most part; tools by number, columns by hand.
#[test]
fn a_stock_says_what_is_met() {
    let folder = folder("machining-stock");
    let (cut, pocket, told, out) =
        (file("roughing.yaml"), file("pocket.csv"), inside(&folder, "told.json"), inside(&folder, "out.csv"));
    let arm = ["path", "rv130hsc", &pocket, "--tool-axis", "x", "--cut", &cut];
    let stock = ["--stock", "1420, -60, 590 .. 1580, 60, 602 mm", "--json", &told, "--out", &out];
    let ran = run(&[&arm[..], &stock].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("line 2: the path begins in the stock"), "{}", ran.err);
    assert!(
        ran.out.contains("cm3 are cut from the stock") && ran.out.contains("depth 2.00 mm in the mean"),
        "{}",
        ran.out
    );
    let told = json(&told);
    let engagement = &told["deviation"]["engagement"];
    let widths: Vec<f64> =
        engagement["segments"].as_array().unwrap().iter().filter_map(|segment| segment["width_m"].as_f64()).collect();
    let slots = widths.iter().filter(|width| **width > 0.018).count();
    assert!(slots > widths.len() / 2 && widths.iter().all(|width| *width < 0.0203), "{widths:?}");
    // There and back again: the way back from line 3 is in the air.
    let back = &engagement["segments"][2];
    assert_eq!((back["line"].as_u64(), back["met"].as_str()), (Some(4), Some("air")));
    let written = fs::read_to_string(&out).unwrap();
    assert!(written.lines().next().unwrap().contains(",ae [mm],ap [mm],Fx [N]"), "{written}");

    let said = fail(2, &[&arm[..], &["--stock", "1400, -80, 590 .. 1600, 80, 590 mm"]].concat());
    assert!(said.contains("the box has no volume"), "{said}");
    let said = fail(2, &[&arm[..], &["--cut-of", &format!("2 = {cut}")]].concat());
    assert!(said.contains("has no tool 2"), "{said}");
    let wide = changed(
        &folder,
        "pocket.csv",
        ["uz,feed [mm/min]\n1500,0,600,0,0,-1,3600", "uz,ae [mm]\n1500,0,600,0,0,-1,25"],
    );
    for command in ["path", "online"] {
        let said = fail(1, &[command, "rv130hsc", &wide, "--tool-axis", "x", "--cut", &cut]);
        assert!(said.contains("wider than its tool, 20 mm") && said.contains("pocket.csv:2:1"), "{said}");
    }
}
