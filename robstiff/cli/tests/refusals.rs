//! What is refused, where, and before which work.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{copy, fail, folder, inside, json, run, succeed};

fn file(name: &str) -> String {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/commands/files").join(name);
    path.to_str().unwrap().to_owned()
}

/// Writes a file into a folder; its path.
fn write(folder: &Path, name: &str, text: &str) -> String {
    fs::write(folder.join(name), text).unwrap();
    inside(folder, name)
}

#[test]
fn nothing_is_planned_after_clamped_axes() {
    let folder = folder("refused-plan");
    write(&folder, "axes.csv", "axis,torque [Nm],deflection [urad]\n1,100,30\n1,200,61\n1,-300,-90\n");
    let robot = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/rv130hsc.yaml");
    let text = format!("robot: {}\nobservations: axes.csv\nkind: clamped\n", robot.display());
    let campaign = write(&folder, "campaign.yaml", &text);
    let said = fail(1, &["plan", &campaign]);
    assert!(said.contains("campaign.yaml: planning needs a campaign of kind"), "{said}");
    assert!(said.contains("what clamped axes leave open `trace` tells"), "{said}");
    let said = fail(1, &["predict", "rv130hsc", &campaign]);
    assert!(said.contains("is what `trace` tells as declared"), "{said}");
    // Axes of which nothing was read are not rigid.
    write(&folder, "axes.csv", "axis,torque [Nm],deflection [urad]\n1,100,0\n1,200,0\n");
    let said = fail(1, &["identify", &campaign, "--out", &inside(&folder, "out")]);
    assert!(said.contains("every deflection is zero") && !folder.join("out").exists(), "{said}");
}

#[test]
fn a_dash_is_no_file() {
    for arguments in [&["show", "-"][..], &["predict", "rv130hsc", "-"], &["map", "rv130hsc", "-"]] {
        let said = fail(1, arguments);
        assert_eq!(said, "error: `-` does not stand for standard input; name a file\n", "{arguments:?}");
    }
    let said = fail(2, &["show", "rv130hsc", "--json", "-"]);
    let expected = "`-` does not stand for standard output, where the text for people goes; name a file";
    assert!(said.contains(expected), "{said}");
    let said = fail(2, &["emit", "rv130hsc", "--out", "-"]);
    assert!(said.contains("without `--out` the code goes to standard output; leave it out"), "{said}");
}

#[test]
fn a_map_without_two_coordinates_is_no_picture() {
    let folder = folder("refused-map");
    let map = write(&folder, "line.yaml", "joints: [{from: -60 deg, to: 60 deg, count: 5}, -1, 0.5, 0, 1]\n");
    let picture = inside(&folder, "line.svg");
    let said = fail(2, &["map", "rv130hsc", &map, "--svg", &picture]);
    assert!(said.contains("needs two coordinates that vary") && said.contains("line.yaml 1 does"), "{said}");
}

#[test]
fn a_scenario_is_refused_at_its_place() {
    let folder = folder("refused-scenario");
    let of = |region: &str, force: &str| {
        let text = format!(
            "seed: 1\nposes: {{count: 5{region}}}\nforce: {{bounds: [{force}]}}\nnoise: {{displacement: 8 um}}\n"
        );
        let scenario = write(&folder, "try.yaml", &text);
        fail(1, &["simulate", "kuka-kr270-r2700", &scenario, "--out", &inside(&folder, "out")])
    };
    let said = of(", floor: 90 m", "500 N, 900 N");
    assert!(said.contains("try.yaml:2:26  (poses.floor)") && said.contains("a lower `floor`"), "{said}");
    let said = of("", "1e12, 1e13");
    assert!(
        said.contains("try.yaml:3:17  (force.bounds)") && said.contains("beyond anything that is measured"),
        "{said}"
    );
    assert!(!folder.join("out").exists());
}

#[test]
fn what_is_no_description_is_not_replaced() {
    let folder = folder("refused-robot");
    let campaign = copy(&folder);
    let out = folder.join("out");
    fs::create_dir(&out).unwrap();
    let mine = write(&out, "robot.yaml", "name: Mine\njoints: [oh\n");
    for command in ["identify", "trace"] {
        let said = fail(1, &[command, &campaign, "--out", out.to_str().unwrap()]);
        assert!(said.contains("is no description of a robot, and would be overwritten"), "{said}");
    }
    assert_eq!(fs::read_to_string(mine).unwrap(), "name: Mine\njoints: [oh\n");
}

#[test]
fn forces_name_the_row_where_they_end() {
    let folder = folder("refused-forces");
    let pocket = file("pocket.csv");
    let with = |forces: &str| {
        let forces = write(&folder, "forces.csv", forces);
        fail(1, &["path", "kuka-kr270-r2700", &pocket, "--forces", &forces])
    };
    let said = with("Fx [N],Fy [N],Fz [N]\n1,2,3\n");
    assert!(said.contains("forces.csv:2:1") && said.contains("here is 1 row, the path has 40 points"), "{said}");
    let said = with("s [mm],Fx [N],Fy [N],Fz [N]\n0,1,2,3\n100,1,2,3\n");
    assert!(said.contains("forces.csv:3:1") && said.contains("the forces end at s = 100.000 mm"), "{said}");
}

/// No advice that would lose a number.
#[test]
fn a_comma_too_many_is_no_decimal_comma() {
    let folder = folder("refused-comma");
    let with = |row: &str| {
        let path = write(&folder, "path.csv", &format!("x [mm],y [mm],z [mm],ux,uy,uz,feed [mm/min]\n{row}\n"));
        fail(1, &["path", "kuka-kr270-r2700", &path])
    };
    let said = with("1500,5,0,600,0,0,-1,3600");
    assert!(said.contains("path.csv:2:") && !said.contains("write `5.0") && !said.contains("write `0.600`"), "{said}");
    assert!(with("1500,5,600,0,0,-1,3600,").contains("leave out the comma at the end"));
    assert!(with("1500.0,5.0,600,250,0,0,-1.0,3600").contains("a decimal comma? write `600.250`"));
}

#[test]
fn a_path_in_degrees_is_asked_about() {
    let folder = folder("asked-degrees");
    let path = write(&folder, "path.csv", "q1,q2,q3,q4,q5,q6\n0,-90,90,0,60,0\n");
    let page = inside(&folder, "page.html");
    let ran = run(&["view", "kuka-kr270-r2700", "--path", &path, "--out", &page]);
    assert_eq!(ran.code, 0);
    assert!(ran.err.contains("are the angles in degrees? write `q2 [deg]`"), "{}", ran.err);
}

#[test]
fn one_unit_is_that_of_all_three_components() {
    let folder = folder("unit-of-three");
    let of = |force: &str| {
        let told = inside(&folder, "told.json");
        succeed(&["online", "rv130hsc", "--force", force, "--frequencies", "5 Hz", "--json", &told]);
        json(&told)["wrench"].clone()
    };
    assert_eq!(of("0.15, -0.2, 0.3 kN"), of("150 N, -200 N, 300 N"));
    let pocket = [&file("pocket.csv"), "--tool-axis", "x", "--cut", &file("roughing.yaml")];
    succeed(&[&["online", "rv130hsc", "--step", "12, 4ms", "--lost", "1, 0.5 s"][..], &pocket].concat());
    let said = fail(2, &["online", "rv130hsc", "--force", "150, -200, 300"]);
    assert!(said.contains("`150` has no unit; write e.g. `150 N`"), "{said}");
    let said = fail(2, &["plan", "campaign.yaml", "--poses", "-1"]);
    assert!(said.contains("a whole number from 1 to 200 is expected here"), "{said}");
}

#[test]
fn an_option_without_effect_is_refused() {
    let folder = folder("refused-options");
    let joints = write(&folder, "joints.csv", "q1,q2,q3,q4,q5\n0,-0.5,0.5,0,1\n0.1,-0.5,0.5,0,1\n");
    let said = fail(2, &["path", "rv130hsc", &joints, "--place", "1 m, 0, 0, 0, 0, 0"]);
    assert!(said.contains("joints.csv gives joint coordinates, which stand in no frame"), "{said}");
    let said = fail(2, &["path", "rv130hsc", &joints, "--start", "0,0,0,0,0"]);
    assert!(said.contains("--start: ") && said.contains("which are taken as they are"), "{said}");
    let force = ["--force", "0, 0, -400 N"];
    for option in [["--feed", "600 mm/min"], ["--toward", "0,1,0"], ["--spindle-axis", "x"], ["--tool-axis", "x"]] {
        let said = fail(2, &[&["online", "rv130hsc"][..], &force, &option].concat());
        assert!(said.contains(option[0]), "{said}");
    }
    let forces = write(&folder, "forces.csv", "Fx,Fy,Fz\n0,0,100\n0,0,100\n");
    for option in [&["--peak"][..], &["--against", &file("fast.yaml")]] {
        let said = fail(2, &[&["path", "rv130hsc", &joints, "--forces", &forces][..], option].concat());
        assert!(said.contains(option[0]), "{said}");
    }
    write(&folder, "record.csv", "t [s],Fx,Fy,Fz\n0,0,0,0\n1,100,50,-20\n2,0,0,0\n");
    let record = write(&folder, "record.yaml", "measured: {file: record.csv, frame: base, on: tool}\n");
    let said = fail(2, &["online", "rv130hsc", "--cut", &record, "--frequencies", "5 Hz"]);
    assert!(said.contains("--frequencies: ") && said.contains("which are played once"), "{said}");
    let page = inside(&folder, "page.html");
    let said = fail(2, &["view", "rv130hsc", "--at", "0,0,0,0,0", "--column", "feed", "--out", &page]);
    assert!(said.contains("--column"), "{said}");
    let view = ["view", "rv130hsc", "--campaign", &file("tracker.yaml"), "--column", "feed", "--out", &page];
    let said = fail(2, &view);
    assert!(said.contains("--column") && !folder.join("page.html").exists(), "{said}");
}

#[test]
fn two_texts_in_one_file_are_refused_before_the_work() {
    let folder = folder("refused-twice");
    let campaign = copy(&folder);
    let out = inside(&folder, "out");
    for name in ["report.html", "robot.yaml"] {
        let json = format!("{out}/{name}");
        let said = fail(2, &["trace", &campaign, "--out", &out, "--json", &json]);
        assert!(said.contains("would be written twice"), "{said}");
    }
    let robot = format!("{out}/robot.yaml");
    let said = fail(2, &["identify", &campaign, "--out", &out, "--json", &robot]);
    assert!(said.contains("robot.yaml would be written twice"), "{said}");
    let (page, same) = (inside(&folder, "page.html"), format!("{}/./page.html", folder.display()));
    let said = fail(2, &["view", "rv130hsc", "--out", &page, "--json", &same]);
    assert!(said.contains("would be written twice") && !folder.join("page.html").exists(), "{said}");
}

/// At a force as along a path.
#[test]
fn a_control_step_that_nobody_would_wait_for_is_wrong_usage() {
    for load in
        [&["--force", "0, 0, -400 N"][..], &[&file("pocket.csv"), "--tool-axis", "x", "--cut", &file("roughing.yaml")]]
    {
        let said = fail(2, &[&["online", "rv130hsc", "--step", "1e-9 s"][..], load].concat());
        assert!(said.contains("give a longer --step"), "{said}");
    }
}

#[test]
fn what_cannot_be_planned_names_its_campaign() {
    let folder = folder("refused-rows");
    let campaign = copy(&folder);
    let loads = fs::read_to_string(folder.join("loads.csv")).unwrap();
    write(&folder, "loads.csv", &loads.lines().take(2).map(|line| format!("{line}\n")).collect::<String>());
    let said = fail(1, &["plan", &campaign, "--floor", "90 m"]);
    assert!(said.starts_with(&format!("error: {campaign}: ")), "{said}");
}
