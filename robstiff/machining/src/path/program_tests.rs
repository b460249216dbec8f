//! Tool paths from programs of machine tools.

use nalgebra::{Matrix4, SVector, Vector3};
use robstiff::Generic;
use robstiff_robots::{Description, catalogue};

use super::{Goal, Orientation, ToolPath, lines};
use crate::nc::{Format, Machine, Options};

fn kuka() -> (Description, Generic<6>) {
    let name = "kuka-kr270-r2700";
    let description = Description::parse(name, catalogue::find(name).unwrap()).unwrap();
    let robot = Generic::new(&description).unwrap();
    (description, robot)
}

fn program(text: &str, options: &Options) -> Result<ToolPath, String> {
    let path = ToolPath::of_program(Format::GCode, "part.ngc", text.to_owned(), Vector3::z_axis(), options);
    path.map_err(|problems| problems.to_string())
}

/// A square of 100 mm with a rounded corner, on a table in front of the arm.
const SQUARE: &str = "G21 G90 G94 G17\nT3 M6\nS6000 M3\nG0 X0 Y0 Z50\nZ2\nG1 Z-2 F200\nX90 F1200\nG3 X100 Y10 I0 J10\nG1 Y100\n\
    G0 Z50\nX0 Y0\nM30\n";

#[test]
fn a_program_is_solved_as_a_path_of_its_lines() {
    let (_, robot) = kuka();
    let place = Matrix4::new_translation(&Vector3::new(1.5, 0.0, 0.8));
    let path = program(SQUARE, &Options::default()).unwrap().placed(&place);
    assert!(path.is_program && path.warnings.is_empty());
    let solved = path.solve(&robot, None).unwrap();
    let first = &solved.points[0];
    assert_eq!((first.line, first.rapid, first.feed, first.tool), (4, true, None, Some(3)));
    assert!((first.position() - Vector3::new(1.5, 0.0, 0.85)).norm() < 1e-9);
    // The spindle is above the tip.
    assert!(solved.points.iter().all(|point| (point.pose.fixed_view::<3, 1>(0, 2) + Vector3::z()).norm() < 1e-9));
    assert!(solved.points.iter().all(|point| (point.spindle.unwrap() - 200.0 * core::f64::consts::PI).abs() < 1e-9));
    let of = |line: usize| solved.points.iter().filter(move |point| point.line == line);
    assert!(of(8).count() > 5 && of(8).all(|point| point.feed == Some(0.02) && !point.rapid));
    let mut rapid: Vec<usize> = solved.points.iter().filter(|point| point.rapid).map(|point| point.line).collect();
    rapid.dedup();
    assert_eq!(rapid, [4, 5, 10, 11]);
    // Where the plunge begins and where the cut ends, the rapid beside it is no feed.
    let tangent = |line: usize| of(line).next_back().unwrap().tangent.unwrap().into_inner();
    assert!((tangent(5) + Vector3::z()).norm() < 1e-6 && (tangent(9) - Vector3::y()).norm() < 1e-6);
    assert_eq!(lines(solved.points.iter().map(|point| point.line)), "lines 4 to 11");
}

#[test]
fn points_out_of_reach_are_named_by_the_line_of_the_program() {
    let (_, robot) = kuka();
    let place = Matrix4::new_translation(&Vector3::new(1.5, 0.0, 0.8));
    let path = program(&SQUARE.replace("Y100", "Y9000"), &Options::default()).unwrap().placed(&place);
    let said = path.solve(&robot, None).unwrap_err().to_string();
    assert!(said.contains(" --> part.ngc:9:1\n") && said.contains("9 | G1 Y9000"), "{said}");
    assert!(said.ends_with("cannot be reached: lines 9 to 10"), "{said}");
}

/// Five axes: the direction from the spindle to the tip, whatever axis of the TCP's frame that is.
#[test]
fn the_axis_of_the_tool_comes_from_the_program() {
    let options = Options { machine: Some(Machine::parse("table A C").unwrap()), ..Options::default() };
    let text = "G21 M428\nG0 X0 Y0 Z0 A0 C0\nG1 A90 C90 F600\n".to_owned();
    let path = ToolPath::of_program(Format::GCode, "part.ngc", text, Vector3::x_axis(), &options).unwrap();
    let Goal::Tool(last) = &path.points.last().unwrap().goal else { panic!("a pose") };
    let Orientation::Axis { tool, direction } = &last.orientation else { panic!("an axis") };
    assert_eq!(*tool, Vector3::x_axis());
    // The spindle is at (sin C sin A, cos C sin A, cos A).
    assert!((direction.into_inner() + Vector3::x()).norm() < 1e-12);
}

#[test]
fn a_program_that_goes_nowhere_is_none() {
    for text in ["", "%\n%\n", "M3 S100\nG0 X1\n"] {
        let said = program(text, &Options::default()).unwrap_err();
        assert!(said.contains("the program never says where the tool is") && said.contains("part.ngc:1:1"), "{said}");
    }
}

/// What `robstiff path` writes of a program keeps its rapids.
#[test]
fn a_table_may_have_rapids() {
    let (description, robot) = kuka();
    let text = "x [mm],y [mm],z [mm],ux,uy,uz,feed [mm/min],rapid\n1500,0,800,0,0,-1,,1\n1600,0,800,0,0,-1,1200,0\n";
    let path = ToolPath::parse("p.csv", text, &description, Vector3::z_axis()).unwrap();
    let solved = path.solve(&robot, None::<&SVector<f64, 6>>).unwrap();
    let told: Vec<_> = solved.points.iter().map(|point| (point.rapid, point.feed)).collect();
    assert_eq!(told, [(true, None), (false, Some(0.02))]);
    let without = text.replace(",rapid", "").replace(",1\n", "\n").replace(",0\n", "\n");
    let said = ToolPath::parse("p.csv", &without, &description, Vector3::z_axis()).unwrap_err().to_string();
    assert!(said.contains("a number is missing"), "{said}");
}
