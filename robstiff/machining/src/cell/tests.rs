//! Cells that are read, and what follows from them.

use std::path::Path;

use nalgebra::{Unit, Vector3};
use robstiff::Generic;
use robstiff_robots::{Description, catalogue};

use super::{Cell, axis_of};
use crate::nc::{Format, Options};
use crate::path::{Goal, ToolPath};

const SPINDLE: &str = "robot: rv130hsc\nspindle: {xyz: [50 mm, 0 mm, 20 mm], axis: x, speeds: [3000 rpm, 24000 rpm]}\n";
const TOOLS: &str = "tools:\n  T1: {length: 100 mm, diameter: 20 mm}\n  T2: {length: 140 mm}\n";

fn read(text: &str) -> Cell {
    Cell::parse("cell.yaml", text, Path::new("")).unwrap_or_else(|problems| panic!("{text}{problems}"))
}

fn refused(text: &str) -> String {
    Cell::parse("cell.yaml", text, Path::new("")).expect_err(text).to_string()
}

fn robot(text: &str) -> Description {
    Description::parse("arm.yaml", text).unwrap_or_else(|problems| panic!("{problems}"))
}

fn program(text: &str) -> ToolPath {
    let axis = Vector3::x_axis();
    let read = ToolPath::of_program(Format::GCode, "part.ngc", text.to_owned(), axis, &Options::default());
    read.unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn the_tip_is_the_length_along_the_spindle_from_the_nose() {
    let cell = read(&format!("{SPINDLE}{TOOLS}tool: T2\n"));
    let tip = cell.tcp(cell.mounted().unwrap());
    assert!((Vector3::from(tip.xyz) - Vector3::new(0.19, 0.0, 0.02)).amax() < 1e-15, "{tip:?}");
    // With a turn of the nose, the axis is one of its frame: y of the flange turned by 90 deg about z is -x.
    let turned = SPINDLE.replace("axis: x", "rpy: [0 deg, 0 deg, 90 deg], axis: y");
    let cell = read(&format!("{turned}{TOOLS}tool: T1\n"));
    let tip = cell.tcp(cell.mounted().unwrap());
    assert!((Vector3::from(tip.xyz) - Vector3::new(-0.05, 0.0, 0.02)).amax() < 1e-15, "{tip:?}");
    assert_eq!(tip.rpy, [0.0, 0.0, core::f64::consts::FRAC_PI_2]);
}

/// A nose that is not given is where the description has its tool.
#[test]
fn without_a_place_the_nose_is_the_tool_of_the_description() {
    let cell = read("robot: fanuc-r2000ic\nspindle: {axis: z}\ntools: {T1: {length: 80 mm}}\n");
    let (of_robot, tip) = (cell.robot.tool, cell.tcp(cell.mounted().unwrap()));
    assert!((tip.xyz[2] - of_robot.xyz[2] - 0.08).abs() < 1e-15 && tip.xyz[..2] == of_robot.xyz[..2], "{tip:?}");
    assert_eq!(read("robot: fanuc-r2000ic\n").tcp(None), of_robot);
}

#[test]
fn the_tool_is_that_of_the_program() {
    let cell = read(&format!("{SPINDLE}{TOOLS}"));
    let number = |path: &str| cell.tool_on(&program(path)).map(|tool| tool.unwrap().number);
    assert_eq!(number("G21 T2 M6\nG0 X0 Y0 Z5\nG1 X9 F600\nT0 M6\nG0 Z9\n").unwrap(), 2);
    let said = number("G21 T1 M6\nG0 X0 Y0 Z5\nT2 M6\nG1 X9 F600\n").unwrap_err().to_string();
    assert!(said.contains("T2 is 40.000 mm longer than T1") && said.contains("part.ngc:4"), "{said}");
    let said = number("G21 T7 M6\nG0 X0 Y0 Z5\n").unwrap_err().to_string();
    assert!(said.contains("cell.yaml has no tool T7") && said.contains("there are T1, T2"), "{said}");
    let said = number("G21 G0 X0 Y0 Z5\n").unwrap_err().to_string();
    assert!(said.contains("write e.g. `tool: T1`"), "{said}");
    assert!(cell.mounted().unwrap_err().contains("which of the tools T1, T2"));
    // One tool is in the spindle whatever names it.
    let one = read(&format!("{SPINDLE}tools: {{T3: {{length: 1 m}}}}\n"));
    assert_eq!(one.tool_on(&program("G21 G0 X0 Y0 Z5\n")).unwrap().unwrap().number, 3);
    assert!(read("robot: rv130hsc\n").tool_on(&program("G21 T9 M6\nG0 X0 Y0 Z5\n")).unwrap().is_none());
}

#[test]
fn frames_with_names_are_offsets_of_the_first() {
    let place = |text: &str| read(&format!("robot: rv130hsc\nwork: {text}\n"));
    let cell = place("{xyz: [1 m, 0 m, 0.5 m], rpy: [0 deg, 0 deg, 90 deg]}");
    assert_eq!((cell.place().unwrap()[(0, 3)], cell.options().offsets), (1.0, Options::default().offsets));
    let turn = "rpy: [0 deg, 0 deg, 90 deg]";
    let cell = place(&format!("{{G54: {{xyz: [1 m, 0 m, 0 m], {turn}}}, G55: {{xyz: [1 m, 0.3 m, 0 m], {turn}}}}}"));
    // y of the base is x of the frame.
    let zero = cell.options().offsets[2].unwrap();
    assert!((zero - Vector3::new(0.3, 0.0, 0.0)).amax() < 1e-15, "{zero}");
    assert!((cell.place().unwrap()[(0, 3)] - 1.0).abs() < 1e-15);
}

#[test]
fn what_programs_assume_is_read() {
    let cell =
        read("robot: rv130hsc\nprogram: {machine: table A C, center: [0, 0, -50 mm], tcp: off, arc_tolerance: 5 um}\n");
    let Options { arc_tolerance, machine, tcp, .. } = cell.options();
    assert_eq!((arc_tolerance, tcp), (5e-6, Some(false)));
    assert_eq!(machine.unwrap().center, Some(Vector3::new(0.0, 0.0, -0.05)));
    assert_eq!(read("robot: rv130hsc\n").options(), Options::default());
}

#[test]
fn what_is_wrong_is_said_at_its_place() {
    for (text, place, part) in [
        ("robot: rv130hsc\nspindel: {axis: x}\n", "cell.yaml:2:1", "did you mean `spindle`?"),
        ("name: x\nspindle: {axis: x}\n", "cell.yaml:1:1", "the field `robot` is missing"),
        ("robot: rv130\n", "cell.yaml:1:8", "no robot of that name in the catalogue"),
        ("robot: rv130hsc\nspindle: {speeds: [1 rpm, 2 rpm]}\n", "cell.yaml:2:10", "the field `axis` is missing"),
        ("robot: rv130hsc\nspindle: {axis: x, speeds: [9 rpm, 2 rpm]}\n", "cell.yaml:2:28", "`[3000 rpm, 24000 rpm]`"),
        ("robot: rv130hsc\nspindle: {axis: w}\n", "cell.yaml:2:17", "write one of"),
        ("robot: rv130hsc\ntools: {T1: {length: 1 m}}\n", "cell.yaml:2:8", "the cell has none"),
        (
            "robot: rv130hsc\nspindle: {axis: x}\ntools: {mill: {length: 1 m}}\n",
            "cell.yaml:3:15",
            "no number of a tool",
        ),
        ("robot: rv130hsc\nspindle: {axis: x}\ntools: {T1: {length: 120}}\n", "cell.yaml:3:22", "120 mm"),
        (
            "robot: rv130hsc\nspindle: {axis: x}\ntools: {T1: {diameter: 9 mm}}\n",
            "cell.yaml:3:13",
            "`length` is missing",
        ),
        (
            "robot: rv130hsc\nspindle: {axis: x}\ntools: {T1: {length: 1 m}, \"1\": {length: 1 m}}\n",
            "cell.yaml:3:33",
            "T1 is given twice",
        ),
        (
            "robot: rv130hsc\nspindle: {axis: x}\ntools: {T1: {length: 1 m, diameter: 8 mm, corner_radius: 5 mm}}\n",
            "cell.yaml:3:58",
            "larger than half of the tool",
        ),
        (
            "robot: rv130hsc\nspindle: {axis: x}\ntools: {T1: {length: 1 m}}\ntool: T2\n",
            "cell.yaml:4:7",
            "there are `T1`",
        ),
        ("robot: rv130hsc\nwork: {G55: {xyz: [0, 0, 0]}}\n", "cell.yaml:2:7", "the field `G54` is missing"),
        (
            "robot: rv130hsc\nwork: {G54: {xyz: [0, 0, 0]}, G55: {rpy: [0, 0, 1 deg]}}\n",
            "cell.yaml:2:36",
            "G55 is turned against G54",
        ),
        ("robot: rv130hsc\nstock: {from: [0, 0, 1 m], to: [1 m, 1 m, 0]}\n", "cell.yaml:2:8", "along z the stock ends"),
        ("robot: rv130hsc\njoint_speeds: [90 deg/s]\n", "cell.yaml:2:15", "Rv130hsc has 5 joints, not 1"),
        ("robot: rv130hsc\ncut: none.yaml\n", "cell.yaml:2:6", "there is no file none.yaml"),
        ("robot: rv130hsc\nprogram: {machine: hexapod}\n", "cell.yaml:2:20", "table A C"),
        ("robot: rv130hsc\nprogram: {tcp: on}\n", "cell.yaml:2:16", "add its rotary axes"),
    ] {
        let said = refused(text);
        assert!(said.contains(&format!(" --> {place}")) && said.contains(part), "{text}{said}");
    }
}

/// All problems at once, and of a robot that cannot be read its own.
#[test]
fn every_problem_is_said_and_a_robot_has_its_own() {
    let said =
        refused("robot: nobody\nstock: {from: [0, 0, 1], to: [1, 1, 0]}\njoint_speeds: [1 deg/s]\ncut: none.yaml\n");
    assert_eq!(said.matches("error: ").count(), 3, "{said}");
    let folder = std::env::temp_dir().join(format!("robstiff-cell-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("arm.yaml"), "name: Arm\nconvention: standard\njoints: [{a: 1 N}]\n").unwrap();
    let said = Cell::parse("cell.yaml", "robot: arm.yaml\njoint_speeds: [1 deg/s]\n", &folder).unwrap_err().to_string();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(said.contains("arm.yaml:3:14") && !said.contains("cell.yaml"), "{said}");
}

#[test]
fn a_cell_is_no_description_and_no_campaign() {
    assert!(Cell::is_one("robot: rv130hsc\n") && Cell::is_one("work: {}\nrobt: arm.yaml\n"));
    assert!(!Cell::is_one("robot: rv130hsc\nobservations: loads.csv\nkind: displacement\n"));
    assert!(!Cell::is_one("robot: [\n") && !Cell::is_one("- robot\n"));
    for (_, text) in catalogue::catalogue() {
        assert!(!Cell::is_one(text), "{text}");
    }
}

/// A last joint that tilts the spindle tells nothing of it; one that turns the flange does.
#[test]
fn a_description_tells_the_axis_or_not() {
    let of = |file: &str| robot(catalogue::find(file).unwrap());
    for (file, _) in catalogue::catalogue() {
        let axis = axis_of(&of(file));
        assert_eq!(axis, (*file != "rv130hsc.yaml").then(Vector3::z_axis), "{file}");
    }
    let mut arm = of("rv130hsc");
    arm.tool.xyz = [0.1, 0.0, 0.0];
    assert_eq!(axis_of(&arm), None);
    arm.tool.rpy = [0.0, 90_f64.to_radians(), 0.0];
    assert_eq!(axis_of(&arm), Some(Vector3::z_axis()));
    // A spindle across the flange, without a word of its turn.
    let mut arm = of("kuka-kr270-r2700");
    arm.tool.xyz = [0.3, 0.0, 0.1];
    assert_eq!(axis_of(&arm), None);
    arm.tool.xyz = [0.0, 0.0, 0.1];
    assert_eq!(axis_of(&arm), Some(Vector3::z_axis()));
}

#[test]
fn a_spindle_and_a_stock_that_do_not_fit_are_doubted() {
    let stock = "stock: {from: [0 mm, 0 mm, -20 mm], to: [50 mm, 50 mm, 0 mm]}\n";
    let cell = read(&format!("{SPINDLE}{TOOLS}tool: T1\n{stock}"));
    let doubts = |text: &str| cell.doubts(&program(text), cell.mounted().unwrap());
    assert_eq!(doubts("G21 S9000 M3\nG0 X0 Y0 Z5\nG1 Z-2 F600\n"), Vec::<String>::new());
    let said = doubts("G21 S30000 M3\nG0 X0 Y0 Z5\nG1 Z-2 F600\n");
    assert!(said[0].contains("part.ngc:3: the program's spindle turns with 30000 rpm"), "{said:?}");
    // Beside the stock by less than the radius of the tool it is in it still.
    assert_eq!(doubts("G21 S9000 M3\nG0 X-9 Y0 Z5\nG1 Z-2 F600\n").len(), 0);
    let said = doubts("G21 S9000 M3\nG0 X-11 Y0 Z5\nG1 Z-2 F600\n");
    assert!(said.len() == 1 && said[0].contains("no point of part.ngc lies in the `stock`"), "{said:?}");
}

/// From one row to the next joint 1 turns by 10 deg while the tip goes along a chord; at that feed the time is known.
#[test]
fn a_joint_that_is_too_slow_is_named() {
    let text = "q1 [deg],q2,q3,q4,q5,feed [m/s],s [m]\n0,0.1,0.2,0.3,0.4,0.5,0\n10,0.1,0.2,0.3,0.4,0.5,0.1\n\
                11,0.1,0.2,0.3,0.4,0.5,0.2\n";
    let cell = read("robot: rv130hsc\njoint_speeds: [49 deg/s, 90 deg/s, 90 deg/s, 90 deg/s, 90 deg/s]\n");
    let arm = Generic::<5>::new(&cell.robot).unwrap();
    let path = ToolPath::parse("joints.csv", text, &cell.robot, Vector3::z_axis()).unwrap();
    assert!(matches!(path.points[0].goal, Goal::Joints(_)) && !path.gives_axes());
    let solved = path.solve(&arm, None).unwrap();
    let fast = cell.too_fast(&solved);
    assert_eq!(fast.len(), 1, "{fast:?}");
    let fast = fast[0];
    assert_eq!((fast.joint, fast.line, fast.points), (1, 3, 1));
    // 10 deg in 0.1 m / (0.5 m/s).
    assert!((fast.speed.to_degrees() - 50.0).abs() < 1e-9 && (fast.most.to_degrees() - 49.0).abs() < 1e-9, "{fast:?}");
    let quick = read("robot: rv130hsc\njoint_speeds: [51 deg/s, 90 deg/s, 90 deg/s, 90 deg/s, 90 deg/s]\n");
    assert!(quick.too_fast(&solved).is_empty());
}

#[test]
fn the_axis_of_a_cell_is_a_unit_vector_of_the_noses_frame() {
    let axis = |word: &str| read(&SPINDLE.replace("axis: x", &format!("axis: {word}"))).spindle.unwrap().axis;
    assert_eq!(axis("-y"), -Vector3::y_axis());
    let along: Unit<Vector3<f64>> = axis("z");
    assert_eq!(along, Vector3::z_axis());
}
