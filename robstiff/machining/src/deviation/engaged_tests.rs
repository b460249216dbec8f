//! Each segment has the force of what it meets.

use nalgebra::{Matrix4, Vector3};
use robstiff::Generic;

use super::tests::{cut, described};
use super::{Deviation, Load, Operation, Surface};
use crate::engagement::{Cutter, Stock, Survey, steps};
use crate::milling::{Cut, Direction, Engagement, Forces};
use crate::nc::{Format, Options};
use crate::path::{SolvedPath, ToolPath};

const KUKA: &str = "kuka-kr270-r2700";

fn place() -> Matrix4<f64> {
    Matrix4::new_translation(&Vector3::new(1.5, 0.1, 0.8))
}

fn robot() -> Generic<6> {
    Generic::new(&described(KUKA)).unwrap()
}

fn program(text: &str) -> SolvedPath<6> {
    let options = Options::default();
    let path = ToolPath::of_program(Format::GCode, "p.ngc", text.to_owned(), Vector3::z_axis(), &options).unwrap();
    path.placed(&place()).solve(&robot(), None).unwrap()
}

fn table(text: &str) -> ToolPath {
    ToolPath::parse("p.csv", text, &described(KUKA), Vector3::z_axis()).unwrap()
}

/// Along the front of a block that ends at y = -30, 5 mm of a tool of 20 mm in it; back in the air; a slot. Half of the
/// first way is before the block.
const PROGRAM: &str = "G21 T1 M6 S6000 M3\nG0 X-40 Y-35 Z5\nG0 Z-2\nG1 X0 F1200\nX20 F2400\nX40\nG0 Z5\nG0 X0 Y-35\n\
                       Z-2\nG1 X40 F1200\nG0 Z5\nG0 X60 Y0\nZ-3\nG1 X20\nX0\nG0 Z5\nG1 X1 Z5\n";

fn stock() -> Stock {
    Stock::of_corners(&(Vector3::new(-20.0, -30.0, -10.0) * 1e-3), &(Vector3::new(50.0, 30.0, 0.0) * 1e-3)).unwrap()
}

fn load(forces: &Forces, tools: &[(u32, Forces)], path: &SolvedPath<6>, angles: Option<usize>) -> Load {
    let cutters = [Cutter { diameter: 0.02, corner: 0.0 }, Cutter { diameter: 0.01, corner: 0.0 }];
    let steps = steps(path, &place(), Vector3::z_axis(), |point| usize::from(point.tool == Some(2)));
    let survey = Survey::new(&stock(), &steps, &cutters).unwrap();
    let operation = Operation { forces, tools, at_feeds: true, survey: Some(&survey), angles };
    operation.load(path, Vector3::z_axis(), Surface::Side)
}

/// The force on the line, along feed, normal and axis (N).
fn force(load: &Load, path: &SolvedPath<6>, line: usize) -> Vector3<f64> {
    let at = path.points.iter().position(|point| point.line == line).unwrap();
    let contact = &load.contacts[at];
    let force = contact.wrench.fixed_rows::<3>(0).into_owned();
    contact.frame.map_or(force, |frame| frame.components(&force))
}

fn near(found: Vector3<f64>, expected: Vector3<f64>, within: f64) {
    assert!((found - expected).norm() < within * expected.norm(), "{found} {expected}");
}

#[test]
fn each_segment_has_its_own_engagement_feed_and_speed() {
    let path = program(PROGRAM);
    let own = cut("9 mm", "9000 rpm", "0.3 mm/tooth");
    let load = load(&Forces::Model(own.clone()), &[], &path, None);
    let of = |engagement: Engagement, depth: f64, feed: f64| {
        let feed_per_tooth = feed / (100.0 * 4.0);
        Cut { engagement, depth, feed_per_tooth, ..own.clone() }.mean_force()
    };
    // The wall is left of the tool: up milling, whatever the cut's file has.
    let side = Engagement::of_width(Direction::Up, 5.0, 20.0).unwrap();
    near(force(&load, &path, 5), of(side, 2e-3, 0.04), 0.03);
    near(force(&load, &path, 6), of(side, 2e-3, 0.04), 0.03);
    // The tool meets the block after 11 of 40 mm.
    let first = force(&load, &path, 4);
    near(first / first.norm() * 0.55 * of(side, 2e-3, 0.02).norm(), 0.55 * of(side, 2e-3, 0.02), 0.1);
    assert!((first.norm() / of(side, 2e-3, 0.02).norm() - 0.6).abs() < 0.1, "{first}");
    near(force(&load, &path, 15), of(Engagement::SLOT, 3e-3, 0.02), 0.02);
    // Rapids, and the way that is cut already.
    for line in [3, 7, 8, 10, 13, 17] {
        assert_eq!(force(&load, &path, line), Vector3::zeros(), "{line}");
    }
    assert!(load.undirected.is_empty());
    let at = |line: usize| path.points.iter().position(|point| point.line == line).unwrap();
    let into = |line: usize| load.contacts[at(line)].into.unwrap();
    assert!(into(5).y > 0.99, "into the wall on the left");
    let found = Deviation::of(&robot(), &path, &load).unwrap();
    assert_eq!(found.in_cut().map(|point| point.line).collect::<Vec<_>>(), [4, 5, 6, 14, 15]);
}

#[test]
fn the_peak_is_that_of_what_is_met() {
    let path = program(PROGRAM);
    let forces = Forces::Model(cut("9 mm", "9000 rpm", "0.3 mm/tooth"));
    let load = load(&forces, &[], &path, Some(72));
    let found = Deviation::of(&robot(), &path, &load).unwrap();
    for (i, point) in found.points.iter().enumerate() {
        let forces = load.revolution(i);
        let peak = forces.iter().map(|force| force.norm()).fold(0.0, f64::max);
        match point.in_cut() {
            true => assert!(peak > point.wrench.norm() && peak < 6.0 * point.wrench.norm(), "{i}: {peak}"),
            false => assert!(forces.is_empty() && point.peak.is_none()),
        }
    }
}

#[test]
fn tools_have_their_cuts_by_number() {
    let text = PROGRAM.replace("G0 X60 Y0\n", "T2 M6 S6000 M3\nG0 X60 Y0\n");
    let path = program(&text);
    let mut small = cut("9 mm", "9000 rpm", "0.3 mm/tooth");
    (small.mill.diameter, small.mill.teeth) = (0.01, 2);
    let tools = [(2, Forces::Model(small.clone()))];
    let load = load(&Forces::Model(cut("9 mm", "9000 rpm", "0.3 mm/tooth")), &tools, &path, None);
    let expected = Cut { engagement: Engagement::SLOT, depth: 3e-3, feed_per_tooth: 0.02 / 200.0, ..small };
    near(force(&load, &path, 16), expected.mean_force(), 0.02);
}

const HEADER: &str = "x [mm],y [mm],z [mm],ux,uy,uz,feed [mm/min],ae [mm],ap [mm]\n";

#[test]
fn a_table_gives_widths_and_depths() {
    let rows = "1500,0,800,0,0,-1,1200,,\n1520,0,800,0,0,-1,1200,4,\n1540,0,800,0,0,-1,1200,,1\n\
                1560,0,800,0,0,-1,1200,0,3\n1580,0,800,0,0,-1,1200,20,3\n";
    let path = table(&format!("{HEADER}{rows}"));
    let solved = path.solve(&robot(), None).unwrap();
    let own = cut("2 mm", "9000 rpm", "0.1 mm/tooth");
    let forces = Forces::Model(own.clone());
    let operation = Operation { forces: &forces, tools: &[], at_feeds: false, survey: None, angles: None };
    assert!(operation.check(&path).is_ok());
    let load = operation.load(&solved, Vector3::z_axis(), Surface::Side);
    let with = |width: Option<f64>, depth: f64| {
        let engagement =
            width.map_or(own.engagement, |width| Engagement::of_width(Direction::Down, width, 20.0).unwrap());
        Cut { engagement, depth, ..own.clone() }.mean_force()
    };
    for (line, expected) in
        [(2, own.mean_force()), (3, with(Some(4.0), 2e-3)), (4, with(None, 1e-3)), (6, with(Some(20.0), 3e-3))]
    {
        near(force(&load, &solved, line), expected, 1e-9);
    }
    assert_eq!(force(&load, &solved, 5), Vector3::zeros());

    // Along a block that stands aside tilted segments have what the table says, and others what they meet.
    let tilted = table(&format!("{HEADER}{rows}").replace("1520,0,800,0,0,-1", "1520,0,800,0.1,0,-1"));
    let solved = tilted.solve(&robot(), None).unwrap();
    let aside = Stock::of_corners(&Vector3::new(0.0, 1.0, 0.0), &Vector3::new(1.0, 2.0, 1.0)).unwrap();
    let steps = steps(&solved, &Matrix4::identity(), Vector3::z_axis(), |_| 0);
    let survey = Survey::new(&aside, &steps, &[Cutter { diameter: 0.02, corner: 0.0 }]).unwrap();
    let load = Operation { survey: Some(&survey), ..operation }.load(&solved, Vector3::z_axis(), Surface::Side);
    let pushed: Vec<bool> = (2..7).map(|line| force(&load, &solved, line) != Vector3::zeros()).collect();
    assert_eq!(pushed, [false, true, true, false, false]);
}

#[test]
fn widths_that_cannot_be_are_refused_by_line() {
    let path = table(&format!("{HEADER}1500,0,800,0,0,-1,1200,4,\n1520,0,800,0,0,-1,1200,25,\n"));
    let own = cut("2 mm", "9000 rpm", "0.1 mm/tooth");
    let slot = Forces::Model(Cut { engagement: Engagement::SLOT, ..own.clone() });
    let said = |forces: &Forces| {
        let operation = Operation { forces, tools: &[], at_feeds: false, survey: None, angles: None };
        operation.check(&path).unwrap_err().to_string()
    };
    let wide = said(&Forces::Model(own));
    assert!(wide.contains("p.csv:3:1") && wide.contains("25 mm is wider than its tool, 20 mm"), "{wide}");
    let aside = said(&slot);
    assert!(aside.contains("p.csv:2:1") && aside.contains("on which side the tool cuts 4 mm"), "{aside}");

    let read = |row: &str| {
        let text = format!("{HEADER}1500,0,800,0,0,-1,1200,4,\n{row}\n");
        ToolPath::parse("p.csv", &text, &described(KUKA), Vector3::z_axis()).unwrap_err().to_string()
    };
    let negative = read("1520,0,800,0,0,-1,1200,-1,");
    assert!(negative.contains("p.csv:3:24") && negative.contains("`ae` is negative"), "{negative}");
    let text = HEADER.replace("ap [mm]", "tool") + "1500,0,800,0,0,-1,1200,4,1.5\n";
    let tool = ToolPath::parse("p.csv", &text, &described(KUKA), Vector3::z_axis()).unwrap_err().to_string();
    assert!(tool.contains("a tool has a whole number"), "{tool}");
}
