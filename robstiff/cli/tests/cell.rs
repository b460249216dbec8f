//! Cells, `--cell` in place of a robot's description: they do what the options do, and what is missing is asked for.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{Ran, fail, file, folder, inside, json, run, succeed};

fn write(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// The catalogue's robot with a tool of 100 mm along x, written into its description.
fn with_tool(folder: &Path) -> String {
    let text = robstiff_robots::catalogue::find("rv130hsc").unwrap();
    write(folder, "tooled.yaml", &format!("{}\ntool: {{xyz: [100 mm, 0 mm, 0 mm]}}\n", text.trim_end()))
}

const CELL: &str = "robot: rv130hsc\nspindle: {axis: x}\ntools: {T2: {length: 100 mm}}\n\
                    work: {xyz: [1500 mm, 0 mm, 500 mm], rpy: [0 deg, 0 deg, 30 deg]}\n";

const PLACE: &str = "1500 mm, 0, 500 mm, 0, 0, 30 deg";

#[test]
fn a_spindle_that_nobody_knows_the_direction_of_is_asked_for() {
    let (pocket, slot, cut) = (file("pocket.csv"), file("slot.ngc"), file("roughing.yaml"));
    let folder = folder("cell-axis");
    let joints = write(&folder, "joints.csv", "q1,q2,q3,q4,q5\n0,-0.5,0.5,0,1\n0.1,-0.5,0.5,0,1\n");
    let tooled = with_tool(&folder);
    let out = inside(&folder, "out.csv");
    for asked in [
        &["path", "rv130hsc", &pocket, "--out", &out][..],
        &["path", &tooled, &pocket, "--out", &out],
        &["path", "rv130hsc", &slot, "--place", PLACE, "--out", &out],
        &["path", "rv130hsc", &joints, "--cut", &cut, "--out", &out],
        &["online", "rv130hsc", &pocket, "--cut", &cut],
        &["online", "rv130hsc", "--cut", &cut],
        &["stability", "rv130hsc", &cut, "--frequency", "15 Hz"],
    ] {
        let said = fail(2, asked);
        assert!(said.contains("nothing says where the spindle of Rv130hsc points"), "{asked:?}: {said}");
        assert!(said.contains("-axis x`") && said.contains("`spindle: {axis: x}`"), "{said}");
    }
    assert!(!Path::new(&out).exists());
    // Joints are what they are.
    succeed(&["path", "rv130hsc", &joints]);
    // Where the last joint turns the flange, the spindle is along its axis.
    let said = succeed(&["path", "kuka-kr270-r2700", &pocket]);
    assert!(said.contains("tool along z of the TCP's frame"), "{said}");
}

#[test]
fn a_cell_does_what_the_options_do() {
    let folder = folder("cell-same");
    let (cell, tooled) = (write(&folder, "cell.yaml", CELL), with_tool(&folder));
    let [one, other] = ["one.json", "other.json"].map(|name| inside(&folder, name));
    let (slot, cut) = (file("slot.ngc"), file("roughing.yaml"));
    let by_cell = ["path", &slot, "--cell", &cell, "--cut", &cut, "--json", &one];
    let by_options = ["path", &tooled, &slot, "--cut", &cut, "--tool-axis", "x", "--place", PLACE, "--json", &other];
    let [by_cell, by_options] = [run(&by_cell), run(&by_options)];
    assert_eq!((by_cell.code, &by_cell.err), (0, &by_options.err));
    assert_eq!(by_cell.out.replace(&one, &other), by_options.out);
    assert_eq!(fs::read_to_string(&one).unwrap(), fs::read_to_string(&other).unwrap());
    assert_eq!(json(&one)["points"].as_array().unwrap().len(), json(&other)["points"].as_array().unwrap().len());
    // The cut may be the cell's.
    fs::copy(&cut, folder.join("roughing.yaml")).unwrap();
    let with_cut = write(&folder, "with-cut.yaml", &format!("{CELL}cut: roughing.yaml\n"));
    let of = |arguments: &[&str]| {
        let ran = run(arguments);
        assert_eq!(ran.code, 0, "{}", ran.err);
        ran.out
    };
    assert_eq!(
        of(&["online", &slot, "--cell", &with_cut]).replace(folder.join("roughing.yaml").to_str().unwrap(), &cut),
        of(&["online", &tooled, &slot, "--cut", &cut, "--tool-axis", "x", "--place", PLACE])
    );
    let at = ["--at", "0,-30 deg,60 deg,0,60 deg", "--frequency", "15 Hz"];
    assert_eq!(
        of(&[&["stability", "--cell", &with_cut][..], &at].concat()),
        of(&[&["stability", &tooled, &cut, "--tool-axis", "x"][..], &at].concat())
    );
    let [page, told, same] = ["page.html", "view.json", "same.json"].map(|name| inside(&folder, name));
    of(&["view", "--cell", &cell, "--at", at[1], "--out", &page, "--json", &told]);
    of(&["view", &tooled, "--at", at[1], "--out", &page, "--json", &same]);
    assert_eq!(json(&told), json(&same));
}

#[test]
fn options_beside_a_cell_count_or_are_refused() {
    let folder = folder("cell-options");
    let cell = write(&folder, "cell.yaml", CELL);
    let (slot, pocket) = (file("slot.ngc"), file("pocket.csv"));
    let place = "1500 mm, 0, 450 mm, 0, 0, 0";
    let [one, other] = ["one.json", "other.json"].map(|name| inside(&folder, name));
    succeed(&["path", &slot, "--cell", &cell, "--place", place, "--json", &one]);
    succeed(&["path", &with_tool(&folder), &slot, "--tool-axis", "x", "--place", place, "--json", &other]);
    assert_eq!(json(&one), json(&other));
    for axis in ["y", "-x"] {
        let said = fail(2, &["path", &slot, "--cell", &cell, "--tool-axis", axis]);
        assert!(said.contains("--tool-axis: ") && said.contains("the spindle is along x"), "{said}");
    }
    // A table may give the direction the other way round.
    let up = fs::read_to_string(&pocket).unwrap().replace(",0,0,-1", ",0,0,1");
    let up = write(&folder, "up.csv", &up);
    let base = "0, 0, 0, 0, 0, 0";
    succeed(&["path", &up, "--cell", &cell, "--tool-axis", "-x", "--place", base, "--json", &one]);
    succeed(&["path", &pocket, "--cell", &cell, "--place", base, "--json", &other]);
    assert_eq!(json(&one), json(&other));
    let said = fail(2, &["path", &slot, "--cell", &cell, "--center", "0, 0, 1 mm"]);
    assert!(said.contains("--center goes with `--machine`"), "{said}");
    // The robot is that of the cell.
    for asked in
        [&["path", "rv130hsc", &slot, "--cell", &cell][..], &["view", "rv130hsc", "--cell", &cell, "--out", &one]]
    {
        let said = fail(2, asked);
        assert!(said.contains("the cell names its robot: leave ROBOT.yaml out"), "{asked:?}: {said}");
    }
    assert!(fail(2, &["path", "--cell", &cell]).contains("no PATH is given"));
    assert!(fail(2, &["path"]).contains("ROBOT.yaml"));
    let said = fail(2, &["online", "--cell", &cell, "--place", base]);
    assert!(said.contains("--place goes with a path"), "{said}");
    let said = fail(2, &["online", &slot, "--cell", &cell, "--frequencies", "5 Hz"]);
    assert!(said.contains("--frequencies is for a pose, and "), "{said}");
}

#[test]
fn what_is_wrong_with_a_cell_is_said_at_its_place() {
    let folder = folder("cell-wrong");
    let of = |text: &str| fail(1, &["path", &file("slot.ngc"), "--cell", &write(&folder, "cell.yaml", text)]);
    let said = of(&CELL.replace("spindle:", "spindel:"));
    assert!(said.contains("did you mean `spindle`?") && said.contains("cell.yaml:2:1"), "{said}");
    let said = of(&CELL.replace("rv130hsc", "arms/none.yaml"));
    assert!(said.contains("there is no file ") && said.contains("cell.yaml:1:8"), "{said}");
    assert!(said.contains("arms/none.yaml") && said.contains("kuka-kr270-r2700"), "{said}");
    let said = of(&CELL.replace("T2", "T1"));
    assert!(said.contains("slot.ngc:") && said.contains("add `T2` to `tools`; there are T1"), "{said}");
    let said = fail(1, &["show", &write(&folder, "cell.yaml", CELL)]);
    assert!(said.contains("is a cell, not a robot's description"), "{said}");
    let said = fail(2, &["stability", "--cell", &inside(&folder, "cell.yaml"), "--frequency", "15 Hz"]);
    assert!(said.contains("no CUT.yaml is given, and no cell that names one"), "{said}");
}

/// An estimate is said to be one.
#[test]
fn a_rigid_arm_is_told_what_needs_its_compliances() {
    let folder = folder("cell-rigid");
    write(
        &folder,
        "arm.yaml",
        "name: Arm\nconvention: standard\njoints: [{d: 0.5 m, alpha: 90 deg}, {a: 1 m}, {a: 1 m}]\n",
    );
    let cell = write(&folder, "cell.yaml", "robot: arm.yaml\nspindle: {axis: x}\n");
    let said = fail(1, &["stability", &file("roughing.yaml"), "--cell", &cell, "--frequency", "15 Hz"]);
    assert!(said.contains("Arm is rigid") && said.contains("`robstiff stability` needs them"), "{said}");
    assert!(said.contains("`compliance: 3e-7 rad/Nm`") && said.contains("under `source:`"), "{said}");
}

/// What the cell has in it needs no compliances as long as nothing that depends on them is asked for.
#[test]
fn a_path_of_a_rigid_arm_leaves_the_cut_of_its_cell_out() {
    let folder = folder("cell-rigid-cut");
    let text = robstiff_robots::catalogue::find("kuka-kr270-r2700").unwrap();
    let rows = text.lines().map(|row| match row.split_once(", compliance") {
        Some((row, _)) => format!("{row}}}\n"),
        None => format!("{row}\n"),
    });
    write(&folder, "arm.yaml", &rows.collect::<String>());
    let cut = file("roughing.yaml");
    let cell = write(&folder, "cell.yaml", &format!("robot: arm.yaml\nspindle: {{axis: z}}\ncut: {cut}\n"));
    let pocket = file("pocket.csv");
    let ran = run(&["path", &pocket, "--cell", &cell]);
    assert!(ran.code == 0 && ran.err.contains("is rigid") && ran.err.contains("is left out"), "{}", ran.err);
    let said = fail(1, &["path", &pocket, "--cell", &cell, "--compensate"]);
    assert!(said.contains("`robstiff path` with a cut or forces needs them"), "{said}");
    let said = fail(1, &["path", &pocket, "--cell", &cell, "--cut", &cut]);
    assert!(said.contains("`robstiff path` with a cut or forces needs them"), "{said}");
}

#[test]
fn another_tool_in_the_spindle_than_in_the_cut_is_told() {
    let folder = folder("cell-diameter");
    let of = |diameter: &str| {
        let text = format!(
            "robot: kuka-kr270-r2700\nspindle: {{axis: z}}\ntools: {{T1: {{length: 100 mm, diameter: {diameter}}}}}\ncut: {}\n",
            file("roughing.yaml")
        );
        let ran = run(&["path", &file("pocket.csv"), "--cell", &write(&folder, "cell.yaml", &text)]);
        assert_eq!(ran.code, 0, "{}", ran.err);
        ran.err
    };
    let said = of("12 mm");
    assert!(said.contains("the tool in the spindle is 12") && said.contains("roughing.yaml 20"), "{said}");
    assert!(!of("20 mm").contains("the tool in the spindle"));
}

/// What a joint, a spindle or the stock does not allow is a warning, and the path is solved all the same.
#[test]
fn limits_of_the_cell_are_warned_of() {
    let folder = folder("cell-limits");
    let slow = "joint_speeds: [1 deg/s, 1 deg/s, 1 deg/s, 1 deg/s, 1 deg/s]\n";
    let stock = "stock: {from: [0 mm, 0 mm, -20 mm], to: [1 mm, 1 mm, -10 mm]}\n";
    let cell = CELL.replace("axis: x", "axis: x, speeds: [1000 rpm, 2000 rpm]");
    let ran =
        run(&["path", &file("slot.ngc"), "--cell", &write(&folder, "cell.yaml", &format!("{cell}{slow}{stock}"))]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    for part in ["spindle turns with 9550 rpm", "lies in the `stock`", "joint 1 would move at", "and can at 1.0 deg/s"]
    {
        assert!(ran.err.contains(part), "{part}: {}", ran.err);
    }
}

/// Its pocket begins below the top of its stock, which is all that is said against it.
#[test]
fn the_sample_works_and_cuts_from_its_stock() {
    let folder = folder("cell-sample");
    let files: PathBuf = Path::new(&file("cell.yaml")).parent().unwrap().to_owned();
    for name in ["cell.yaml", "pocket.csv", "roughing.yaml", "slot.ngc"] {
        fs::copy(files.join(name), folder.join(name)).unwrap();
    }
    let [cell, pocket] = ["cell.yaml", "pocket.csv"].map(|name| inside(&folder, name));
    let Ran { code, out, err } = run(&["path", &pocket, "--cell", &cell]);
    assert!(code == 0 && err.lines().count() == 1 && err.contains("begins in the stock"), "{err}");
    assert!(out.contains("all reached") && out.contains("tool along x"), "{out}");
    assert!(out.contains("are cut from the stock"), "{out}");
}
