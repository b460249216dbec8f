//! What the commands of machining say to input that cannot be meant.

mod common;

use std::fs;
use std::path::Path;

use common::{fail, folder, inside, json, names, run, succeed};

fn file(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/commands/files").join(name).to_str().unwrap().to_owned()
}

/// A file of the pages with some of its text replaced.
fn changed(folder: &Path, name: &str, [from, to]: [&str; 2]) -> String {
    let text = fs::read_to_string(file(name)).unwrap();
    assert!(text.contains(from), "{name} has no {from}");
    let path = inside(folder, name);
    fs::write(&path, text.replace(from, to)).unwrap();
    path
}

/// The arm of the pages' URDF file, all rigid.
fn rigid(folder: &Path) -> String {
    let arm = inside(folder, "arm.yaml");
    assert_eq!(run(&["import", &file("arm.urdf"), "--tip", "cutter_tip", "--out", &arm]).code, 0);
    arm
}

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

fn stability(folder: &Path, backlash: Option<(&str, &str)>) -> serde_json::Value {
    stability_of(folder, &file("roughing.yaml"), backlash)
}

/// The page's arm in a cut, with backlash in its first joints (arcmin, Nm).
fn stability_of(folder: &Path, cut: &str, backlash: Option<(&str, &str)>) -> serde_json::Value {
    let (robot, told) = (inside(folder, "robot.yaml"), inside(folder, "stability.json"));
    let mut text = robstiff_robots::catalogue::find("kuka-kr270-r2700").unwrap().trim_end().to_owned();
    if let Some((gap, knee)) = backlash {
        text += "\neffects:\n";
        for joint in 1..=3 {
            text += &format!("  - {{kind: lost_motion, at: joint {joint}, gap: {gap} arcmin, knee: {knee} Nm}}\n");
        }
    }
    fs::write(&robot, text).unwrap();
    let at = "0,-90 deg,90 deg,0,60 deg,0";
    let page = succeed(&["stability", &robot, cut, "--at", at, "--frequency", "15 Hz", "--json", &told]);
    assert_eq!(page.contains("under the mean force of the cut at"), backlash.is_some(), "{page}");
    json(&told)
}

/// Beyond depths at which it chatters a narrow window of stable ones does not count.
#[test]
fn a_feed_is_stable_where_every_depth_up_to_the_cuts_is() {
    let told = stability(&folder("machining-windows"), None);
    let feeds = told["feeds"].as_array().unwrap();
    let stable = |feed: &&serde_json::Value| feed["stable"].as_bool().unwrap();
    assert_eq!(feeds.iter().filter(stable).count(), 7);
    for feed in feeds {
        let limit = feed["limiting_depth_m"].as_f64();
        assert_eq!(stable(&feed), limit.is_none_or(|limit| limit > 0.002), "{feed}");
    }
    let at = "0,-90 deg,90 deg,0,60 deg,0";
    let deep = changed(&folder("machining-six"), "roughing.yaml", ["depth: 2 mm", "depth: 6 mm"]);
    let page = succeed(&["stability", "kuka-kr270-r2700", &deep, "--at", at, "--frequency", "15 Hz"]);
    assert!(page.contains("3 more are stable at 6 mm itself, but they chatter at less.\n"), "{page}");
    let slow = ["--speed", "1800 rpm", "--damping", "0.02"];
    let asked = ["stability", "kuka-kr270-r2700", &deep, "--at", at, "--frequency", "15 Hz"];
    let page = succeed(&[&asked[..], &slow].concat());
    assert!(page.contains("Best feed: 55 deg, along (0.497, -0.819, 0.287), to 6.73 mm.\n"), "{page}");
    let page = succeed(&[&asked[..], &["--speed", "1200 rpm"]].concat());
    assert!(page.contains("Up to 6 mm no feed is stable.\n"), "{page}");
}

/// The page's arm with a damping ratio of 0.02; what it told and what it printed.
fn damped(folder: &Path, more: &[&str]) -> (serde_json::Value, String) {
    let told = inside(folder, "stability.json");
    let at = "0,-90 deg,90 deg,0,60 deg,0";
    let asked = ["stability", "kuka-kr270-r2700", &file("roughing.yaml"), "--at", at, "--frequency", "15 Hz"];
    let page = succeed(&[&asked[..], &["--damping", "0.02", "--json", &told], more].concat());
    (json(&told), page)
}

/// The depth of a feed by its angle (deg) in mm, under a key.
fn depth(told: &serde_json::Value, angle: f64, key: &str) -> Option<f64> {
    let is_at = |feed: &&serde_json::Value| (feed["angle_rad"].as_f64().unwrap() - angle.to_radians()).abs() < 1e-9;
    let feed = told["feeds"].as_array().unwrap().iter().find(is_at).unwrap();
    feed[key].as_f64().map(|depth| 1e3 * depth)
}

/// Figures of an independent computation. Without the surface of the tooth before they were 4.37
/// and 0.277 mm at 90 and 180 degrees, at every speed.
#[test]
fn depths_are_those_on_the_surface_of_the_tooth_before() {
    let folder = folder("machining-regeneration");
    let (cut, _) = damped(&folder, &[]);
    let is = |found: Option<f64>, millimetres: f64| {
        let found = found.unwrap();
        assert!((found / millimetres - 1.0).abs() < 3e-3, "{found} {millimetres}");
    };
    is(depth(&cut, 90.0, "limiting_depth_m"), 1.92);
    is(depth(&cut, 180.0, "limiting_depth_m"), 5.98);
    is(depth(&cut, 90.0, "without_delay_m"), 4.37);
    is(depth(&cut, 180.0, "without_delay_m"), 0.277);
    for (speed, millimetres) in [("3000 rpm", 0.68), ("18000 rpm", 3.79)] {
        let (told, page) = damped(&folder, &["--speed", speed]);
        is(depth(&told, 90.0, "limiting_depth_m"), millimetres);
        is(depth(&told, 90.0, "without_delay_m"), 4.37);
        assert!(page.contains(&format!(" Hz, {speed}\n")), "{page}");
    }
}

#[test]
fn lobes_are_the_depths_at_other_speeds() {
    let folder = folder("machining-lobes");
    let (cut, page) = damped(&folder, &[]);
    let lobes = cut["lobes"].as_array().unwrap();
    let rpm = |speed: &serde_json::Value| speed.as_f64().unwrap() * 60.0 / std::f64::consts::TAU;
    let ends = [&lobes[0], lobes.last().unwrap()].map(|lobe| rpm(&lobe["speed_rad_per_s"]));
    assert!((ends[0] - 1800.0).abs() < 1e-6 && (ends[1] - 18000.0).abs() < 1e-6, "{ends:?}");
    // The best of the other speeds is in the table of the page.
    assert!(page.contains("best feed [deg]"), "{page}");
    let (told, _) = damped(&folder, &["--speeds", "3000, 9000 rpm", "--speed", "3000 rpm"]);
    let narrow = told["lobes"].as_array().unwrap();
    let limits = |lobe: &serde_json::Value| lobe["limiting_depth_m"].as_array().unwrap().clone();
    for (lobe, of) in [(&narrow[0], &told), (narrow.last().unwrap(), &cut)] {
        let feeds = of["feeds"].as_array().unwrap();
        assert_eq!(limits(lobe).len(), feeds.len());
        for (found, feed) in limits(lobe).iter().zip(feeds) {
            let [found, expected] = [found, &feed["limiting_depth_m"]].map(|depth| depth.as_f64().unwrap_or(0.02));
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {feed}");
        }
    }
    // At any speed it is no deeper than at each.
    for lobe in lobes.iter().chain(narrow) {
        for (found, feed) in limits(lobe).iter().zip(cut["feeds"].as_array().unwrap()) {
            let least = feed["at_any_speed_m"].as_f64().unwrap();
            assert!(found.as_f64().is_none_or(|depth| depth >= least * (1.0 - 1e-9)), "{found} {feed}");
        }
    }
    for wrong in ["9000", "9000, 3000 rpm", "0, 3000 rpm", "3000 rpm", "fast, slow"] {
        fail(2, &["stability", "kuka-kr270-r2700", &file("roughing.yaml"), "--speeds", wrong]);
    }
}

#[test]
fn a_depth_needs_a_spindle_speed() {
    let folder = folder("machining-speed");
    let cut = changed(&folder, "roughing.yaml", ["speed: 9000 rpm", ""]);
    let asked = ["stability", "kuka-kr270-r2700", &cut, "--frequency", "15 Hz"];
    let said = fail(1, &asked);
    assert!(said.contains(&format!("{cut} gives no `speed` of the spindle")), "{said}");
    assert!(said.contains("--speed \"9000 rpm\""), "{said}");
    succeed(&[&asked[..], &["--speed", "9000 rpm"]].concat());
    let said = fail(2, &[&asked[..], &["--speed", "9000"]].concat());
    assert!(said.contains("`9000` has no unit; write e.g. `9000 rpm`"), "{said}");
}

/// A table of the modes of one mass has its depths, also of an arm that yields nowhere itself.
#[test]
fn measured_modes_stand_in_place_of_the_mass() {
    let folder = folder("machining-modes");
    let (one, _) = damped(&folder, &[]);
    let numbers = |value: &serde_json::Value| -> Vec<f64> {
        value.as_array().unwrap().iter().map(|entry| entry.as_f64().unwrap()).collect()
    };
    // Of one mass alike in all directions, the modes are along the principal directions.
    let compliance: Vec<f64> = one["translational_compliance"].as_array().unwrap().iter().flat_map(numbers).collect();
    let principal = robstiff::nalgebra::Matrix3::from_row_slice(&compliance).symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| principal.eigenvalues[j].total_cmp(&principal.eigenvalues[i]));
    let hertz = numbers(&one["frequencies_Hz"]);
    let mut text = "frame: base\nmodes:\n".to_owned();
    for (mode, frequency) in order.into_iter().zip(&hertz) {
        let (stiffness, along) = (principal.eigenvalues[mode].recip(), principal.eigenvectors.column(mode));
        text += &format!(
            "  - {{frequency: {frequency} Hz, damping: 0.02, stiffness: {stiffness} N/m, direction: [{}, {}, {}]}}\n",
            along[0], along[1], along[2]
        );
    }
    let [table, told] = ["modes.yaml", "modes.json"].map(|name| inside(&folder, name));
    fs::write(&table, &text).unwrap();
    let at = "0,-90 deg,90 deg,0,60 deg,0";
    let cut = file("roughing.yaml");
    let asked = ["stability", "kuka-kr270-r2700", &cut, "--at", at, "--modes", &table];
    let page = succeed(&[&asked[..], &["--json", &told]].concat());
    assert!(page.contains(" Hz, as measured, damping ratio 0.02\n"), "{page}");
    let measured = json(&told);
    for angle in [0.0, 90.0, 180.0] {
        for key in ["limiting_depth_m", "at_any_speed_m", "without_delay_m"] {
            let [found, expected] = [&measured, &one].map(|told| depth(told, angle, key).unwrap());
            assert!((found / expected - 1.0).abs() < 1e-6, "{angle} {key}: {found} {expected}");
        }
    }
    // Of the arm the pose alone is asked.
    let rigid = rigid(&folder);
    succeed(&["stability", &rigid, &cut, "--tool-axis", "z", "--modes", &table]);

    fs::write(&table, text.replacen("damping: 0.02", "damping: 0.05", 1)).unwrap();
    let page = succeed(&[&asked[..], &["--json", &told]].concat());
    assert!(page.contains(", damping ratios 0.05, 0.02, 0.02\n"), "{page}");
    let unlike = json(&told);
    assert!(unlike["damping"].is_null() && numbers(&unlike["dampings"]) == [0.05, 0.02, 0.02], "{unlike}");

    for other in [["--frequency", "15 Hz"], ["--damping", "0.02"]] {
        let said = fail(2, &[&asked[..], &other].concat());
        assert!(said.contains("--modes") && said.contains(other[0]), "{said}");
    }
    fs::write(&table, text.replacen("damping: 0.02", "damping: -0.02", 1)).unwrap();
    let said = fail(1, &asked);
    assert!(said.contains("modes.yaml:3:") && said.contains("above 0 and below 1"), "{said}");
}

/// The modes of the sample's responses are those that it was made from, and what is printed of them is a table.
#[test]
fn responses_stand_in_place_of_the_modes() {
    let folder = folder("machining-responses");
    let [told, table, again, made] =
        ["told.json", "table.yaml", "again.json", "made.json"].map(|name| inside(&folder, name));
    let (cut, responses) = (file("roughing.yaml"), file("hammer.yaml"));
    let asked = ["stability", "kuka-kr270-r2700", &cut, "--at", "0,-90 deg,90 deg,0,60 deg,0", "--modes"];
    let page = succeed(&[&asked[..], &[&responses, "--json", &told]].concat());
    assert!(page.contains("Modes fitted to 6 responses at 226 lines from 5 to 50 Hz; they leave "), "{page}");
    let (printed, _) = page.split_once("modes:\n").unwrap().1.split_once("\n\n").unwrap();
    fs::write(&table, format!("modes:\n{printed}\n")).unwrap();
    succeed(&[&asked[..], &[&table, "--json", &again]].concat());
    let truth = fs::read_to_string(file("modes.yaml")).unwrap();
    let massless = "massless: [{stiffness: 7 N/um, direction: [0.3, 0.2, 0.9]}]\n";
    fs::write(&table, format!("{massless}{truth}")).unwrap();
    succeed(&[&asked[..], &[&table, "--json", &made]].concat());
    let [told, again, made] = [told, again, made].map(|path| json(&path));
    assert!(made["fit"].is_null() && told["fit"]["modes"].as_array().unwrap().len() == 3, "{}", told["fit"]);
    assert!((told["fit"]["left"].as_f64().unwrap() - 0.01).abs() < 3e-3, "{}", told["fit"]);
    for (found, expected) in told["fit"]["modes"].as_array().unwrap().iter().zip([14.6, 17.9, 28.3]) {
        assert!((found["frequency_Hz"].as_f64().unwrap() / expected - 1.0).abs() < 5e-3, "{found}");
    }
    for angle in [0.0, 30.0, 90.0, 180.0] {
        for key in ["limiting_depth_m", "at_any_speed_m", "without_delay_m"] {
            let [found, printed, expected] = [&told, &again, &made].map(|told| depth(told, angle, key));
            let Some(expected) = expected else {
                assert_eq!([found, printed], [None; 2], "{angle} {key}");
                continue;
            };
            let [found, printed] = [found, printed].map(Option::unwrap);
            assert!((found / printed - 1.0).abs() < 5e-3, "{angle} {key}: {found} {printed}");
            assert!((found / expected - 1.0).abs() < 0.05, "{angle} {key}: {found} {expected}");
        }
    }
    // They are not overwritten.
    let hammer = file("hammer.csv");
    let said = fail(1, &[&asked[..], &[&responses, "--json", &hammer]].concat());
    assert!(said.contains("hammer.csv is one of the files that were read"), "{said}");

    let [yaml, csv] = ["hammer.yaml", "hammer.csv"].map(|name| inside(&folder, name));
    let [text, values] = [&responses, &hammer].map(|path| fs::read_to_string(path).unwrap());
    fs::write(&csv, &values).unwrap();
    for (from, to, said) in [
        ("accelerance", "receptance", "hammer.csv:1:16"),
        ("  to: 50 Hz", "  to: 50 Hz\n  modes: 20", "hammer.yaml:6:10"),
        ("to: 50 Hz", "to: 5.5 Hz", "1 mode needs 7 lines, and 3 are in the band"),
    ] {
        fs::write(&yaml, text.replace(from, to)).unwrap();
        let complaint = fail(1, &[&asked[..], &[&yaml]].concat());
        assert!(complaint.contains(said), "{from}: {complaint}");
    }
}

/// Where nothing chatters up to the greatest depth there is no number, and no infinity.
#[test]
fn a_feed_without_a_limit_has_none() {
    let folder = folder("machining-no-limit");
    let (told, page) = damped(&folder, &["--speed", "1000000 rpm"]);
    for feed in told["feeds"].as_array().unwrap() {
        assert!(feed["limiting_depth_m"].is_null() && feed["without_delay_m"].is_number(), "{feed}");
        assert_eq!(feed["unstable_m"], serde_json::json!([]));
    }
    assert!(page.contains("Up to 2 mm every feed is stable.\nBest feed: 0 deg, along"), "{page}");
    assert!(page.contains("beyond 20 mm."), "{page}");
    let text = fs::read_to_string(inside(&folder, "stability.json")).unwrap();
    assert!(!text.to_lowercase().contains("inf"), "{text}");
    // Without damping all that the cut feeds chatters.
    let undamped = stability(&folder, None);
    assert_eq!(depth(&undamped, 90.0, "limiting_depth_m"), Some(0.0));
}

/// The slope at no torque, which no cut has, made the arm eight and thirty times as soft.
#[test]
fn backlash_that_the_cut_takes_up_does_not_make_an_arm_soft() {
    let folder = folder("machining-backlash");
    let softest = |told: &serde_json::Value| {
        let feeds = told["feeds"].as_array().unwrap();
        let softest = feeds.iter().map(|feed| feed["softest_N_per_m"].as_f64().unwrap());
        let (least, most) = softest.fold((f64::MAX, 0.0), |(least, most), k| (k.min(least), k.max(most)));
        [least, most]
    };
    // Without backlash it is the same for every feed.
    let without = stability(&folder, None);
    let [least, most] = softest(&without);
    assert!(least == most && (most - 1.233e6).abs() < 1e3, "{least} {most}");
    for (backlash, unloaded) in [(("0.5", "50"), 0.1622e6), (("1", "20"), 0.03579e6)] {
        let with = stability(&folder, Some(backlash));
        let [least, most] = softest(&with);
        assert!(least > 1.3 * unloaded && (2.5 * unloaded..1.233e6).contains(&most), "{backlash:?} {least} {most}");
        // The hammer finds the arm without load.
        assert!((with["frequencies_Hz"][0].as_f64().unwrap() - 15.0).abs() < 1e-9);
    }
    // A cut that presses harder leaves less of it.
    let cut = changed(&folder, "roughing.yaml", ["depth: 2 mm", "depth: 60 mm"]);
    let with = stability_of(&folder, &cut, Some(("1", "20")));
    assert!(softest(&with)[1] > 0.95 * most, "{:?}", softest(&with));
}

#[test]
fn a_cut_as_deep_as_nothing_is_refused() {
    let folder = folder("machining-deep");
    let cut = changed(&folder, "roughing.yaml", ["depth: 2 mm", "depth: 1e9 mm"]);
    let said = fail(1, &["forces", &cut]);
    assert!(said.contains("1000 times as deep as the tool is wide"), "{said}");
}

/// Nobody looked at the depth that is judged: no feed was stable there.
#[test]
fn the_depth_of_the_cut_is_among_those_looked_at() {
    let asked = ["stability", "kuka-kr270-r2700", &file("roughing.yaml"), "--frequency", "15 Hz", "--greatest"];
    let said = fail(2, &[&asked[..], &["1 mm"]].concat());
    assert!(said.contains("--greatest: 1 mm is less than the depth of the cut, 2 mm"), "{said}");
    let at = ["--at", "0,-90 deg,90 deg,0,60 deg,0"];
    let page = succeed(&[&asked[..], &["2 mm"], &at].concat());
    assert!(page.contains("Up to 2 mm, 7 of 72 directions of feed are stable."), "{page}");
}

/// Where the tool is along the base's x, the first feed is along y.
#[test]
fn the_picture_of_feeds_says_where_they_begin() {
    let folder = folder("machining-picture");
    let picture = inside(&folder, "limits.svg");
    for (wrist, along) in [("0", "(0.000, 1.000, 0.000)"), ("60 deg", "(0.866, 0.000, 0.500)")] {
        let at = format!("0,-90 deg,90 deg,0,{wrist},0");
        let cut = file("roughing.yaml");
        succeed(&["stability", "kuka-kr270-r2700", &cut, "--at", &at, "--frequency", "15 Hz", "--out", &picture]);
        let drawn = fs::read_to_string(&picture).unwrap();
        assert!(drawn.contains(&format!("0°: along {along} in the base frame")), "{drawn}");
        assert!(drawn.contains("Limiting depth of cut [mm] over the spindle speed [rpm]"), "{drawn}");
        assert!(!drawn.contains("NaN") && !drawn.contains("inf"), "{drawn}");
    }
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

#[test]
fn feeds_between_degrees_are_told_as_they_are() {
    let at = "0,-90 deg,90 deg,0,60 deg,0";
    let cut = file("roughing.yaml");
    let page = succeed(&["stability", "kuka-kr270-r2700", &cut, "--at", at, "--frequency", "15 Hz", "--feeds", "7"]);
    assert!(page.lines().any(|line| line.trim_start().starts_with("102.9 ")), "{page}");
    let said = fail(2, &["stability", "kuka-kr270-r2700", &cut, "--at", at, "--frequency", "15 Hz", "--feeds", "1"]);
    assert!(said.contains("a whole number from 4 to 3600 is expected here"), "{said}");
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
