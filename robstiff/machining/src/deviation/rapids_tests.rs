//! Rapids carry no force, and programs have their own feeds.

use nalgebra::{Matrix4, Vector3, Vector6};
use robstiff::Generic;
use robstiff_robots::{Description, catalogue};

use super::tests::cut;
use super::{Deviation, ForceTable, Surface, load_at_feeds, load_of_cut};
use crate::milling::{Cut, ForceFrame, Forces};
use crate::nc::{Format, Options};
use crate::path::{SolvedPath, ToolPath};

fn solved(text: &str) -> (Generic<6>, SolvedPath<6>) {
    let name = "kuka-kr270-r2700";
    let description = Description::parse(name, catalogue::find(name).unwrap()).unwrap();
    let robot = Generic::new(&description).unwrap();
    let options = Options::default();
    let path = ToolPath::of_program(Format::GCode, "p.ngc", text.to_owned(), Vector3::z_axis(), &options).unwrap();
    let place = Matrix4::new_translation(&Vector3::new(1.5, 0.0, 0.8));
    let solved = path.placed(&place).solve(&robot, None).unwrap();
    (robot, solved)
}

const TWO_CUTS: &str = "G21 S6000 M3\nG0 X0 Y0 Z0\nG1 X20 F1200\nX40\nG0 Z20\nX0 Y20\nZ0\nG1 X20 F2400\nX40\nG0 Z20\n";

#[test]
fn nothing_pushes_in_rapids() {
    let (robot, path) = solved(TWO_CUTS);
    let forces = Forces::Model(cut("3 mm", "6000 rpm", "0.1 mm/tooth"));
    let load = load_of_cut(&forces, &path, Vector3::z_axis(), Surface::Side);
    let pushed = |of: &Deviation| of.in_cut().map(|point| point.line).collect::<Vec<_>>();
    let found = Deviation::of(&robot, &path, &load).unwrap();
    assert_eq!((pushed(&found), load.undirected.len()), (vec![3, 4, 8, 9], 0));
    assert_eq!(found.judged().count(), 4);
    // At the end of a cut the feed is that of the cut, not of the rapid that follows.
    let frame = load.contacts[2].frame.unwrap();
    assert!((frame.matrix().column(0) - Vector3::x()).norm() < 1e-6);
    // Nor does a table of forces push there.
    let rows = "Fx,Fy,Fz\n".to_owned() + &"10,20,30\n".repeat(path.points.len());
    let table = ForceTable::parse("f.csv", &rows).unwrap();
    let load = table.load(&path, ForceFrame::Base, Vector3::z_axis(), Surface::Side).unwrap();
    assert_eq!(pushed(&Deviation::of(&robot, &path, &load).unwrap()), [3, 4, 8, 9]);
    assert_eq!(load.contacts[0].wrench, Vector6::zeros());
}

/// A tooth takes f / (z n): 1200 mm/min at 6000 rpm and four teeth are 0.05 mm.
#[test]
fn a_program_has_the_force_of_each_lines_feed() {
    let (_, path) = solved(TWO_CUTS);
    let cut = cut("3 mm", "6000 rpm", "0.1 mm/tooth");
    let load = load_at_feeds(&Forces::Model(cut.clone()), &path, Vector3::z_axis(), Surface::Side);
    let of_feed = |feed_per_tooth: f64| Cut { feed_per_tooth, ..cut.clone() }.mean_force().norm();
    let size = |line: usize| {
        let at = path.points.iter().position(|point| point.line == line).unwrap();
        load.contacts[at].wrench.norm()
    };
    for (line, feed) in [(3, 0.05e-3), (4, 0.05e-3), (8, 0.1e-3), (9, 0.1e-3)] {
        assert!((size(line) - of_feed(feed)).abs() < 1e-9, "{line}: {} {}", size(line), of_feed(feed));
    }
    assert!(size(8) > 1.3 * size(3) && size(5) == 0.0);
    // Without S the spindle's speed is the cut's.
    let (_, without) = solved(&TWO_CUTS.replace("S6000 M3", ""));
    let same = load_at_feeds(&Forces::Model(cut), &without, Vector3::z_axis(), Surface::Side);
    assert!(same.contacts.iter().zip(&load.contacts).all(|(one, other)| (one.wrench - other.wrench).norm() < 1e-9));
}
