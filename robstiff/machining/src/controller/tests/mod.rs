mod postures;
mod programs;

use nalgebra::SVector;
use robstiff_robots::{Description, catalogue};

/// A robot of the catalogue with a controller, and what else is to be in its description.
fn with(name: &str, controller: &str) -> Description {
    let text = format!("{}\n{controller}", catalogue::find(name).unwrap());
    Description::parse(name, &text).unwrap_or_else(|problems| panic!("{problems}"))
}

fn kuka() -> Description {
    with("kuka-kr270-r2700", "controller: {}\n")
}

fn abb() -> Description {
    with("abb-irb6640-185-280", "controller: {world: {xyz: [0, 0, 100 mm], rpy: [0, 0, 90 deg]}}\n")
}

/// Joint 3 counts from the ground, and the wrist the other way round.
fn fanuc() -> Description {
    let joints = "[{}, {}, {sign: -1, add: {t2: 1}}, {sign: -1}, {sign: -1}, {sign: -1}]";
    with("fanuc-r2000ic", &format!("controller: {{joints: {joints}, flange: {{xyz: [0, 0, 12 mm]}}}}\n"))
}

fn degrees(of: [f64; 6]) -> SVector<f64, 6> {
    SVector::from(of.map(f64::to_radians))
}

/// Universal Robots' UR10e, with the maker's table; its wrist does not meet in a point.
fn ur() -> Description {
    let text = "\
name: Ur10e
convention: standard
joints:
  - {theta: 0, d: 180.7 mm, alpha: 90 deg, limits: [-360 deg, 360 deg]}
  - {theta: 0, a: -612.7 mm, limits: [-360 deg, 360 deg]}
  - {theta: 0, a: -571.55 mm, limits: [-180 deg, 180 deg]}
  - {theta: 0, d: 174.15 mm, alpha: 90 deg, limits: [-360 deg, 360 deg]}
  - {theta: 0, d: 119.85 mm, alpha: -90 deg, limits: [-360 deg, 360 deg]}
  - {theta: 0, d: 116.55 mm, limits: [-360 deg, 360 deg]}
controller: {}
";
    Description::parse("ur10e.yaml", text).unwrap_or_else(|problems| panic!("{problems}"))
}
