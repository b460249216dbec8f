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
