//! The mistakes that files are written with, and what a campaign is with one undone.

use core::f64::consts::{FRAC_PI_2, PI};
use core::fmt;
use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use robstiff_robots::{Convention, Description};

use super::axes::Axes;
use crate::campaign::{Displacements, Frame, Observation, PositionRow, Positions};
use crate::words::and;
use robstiff::JointKind;

/// One mistake.
#[derive(Clone, Debug, PartialEq)]
pub enum Mistake {
    /// The columns of a vector are those of other axes, or count the other way.
    Axes(Vector, Axes),
    /// All vectors are given along other axes, in a frame that is turned by quarters or mirrored.
    AllAxes(Axes),
    /// A vector is given in the other frame.
    Frame(Vector),
    /// A component of a vector, from 0, is in another unit.
    Unit(Vector, usize, Unit),
    /// The coordinate of a joint, from 0, is another.
    Counted(usize, Counted),
    /// The coordinates of several joints, from 0, count the other way round.
    Backwards(Vec<usize>),
    /// The angles of all joints that turn are in another unit, lengths of others are not.
    AllAngles(Unit),
    /// The coordinates of two joints, from 0, are exchanged.
    Exchanged([usize; 2]),
    /// Positions are read along axes of the other hand, which no stand of the robot makes up for.
    OtherHand,
    /// The table of the description is of the other convention.
    Convention,
}

/// What is read three components of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vector {
    Force,
    Displacement,
    Position,
}

/// A unit by what it is taken for, and how many of that it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    name: &'static str,
    factor: f64,
}

/// How a coordinate is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Counted {
    /// The other way round.
    Backwards,
    /// From elsewhere: so many quarter turns are to be added.
    From(f64),
    /// Against the link before that of the joint before: with that joint's coordinate, times this,
    /// it is what the description means.
    OnJointBefore(f64),
    /// In another unit.
    In(Unit),
}

/// Units that one component of a vector may be in where the others are in that of their header:
/// of forces, of lengths, and of either.
const OF_FORCES: [Unit; 2] = [
    Unit { name: "kgf where the header has N", factor: 9.80665 },
    Unit { name: "lbf where the header has N", factor: 4.448_221_615_260_5 },
];
const OF_LENGTHS: [Unit; 1] = [Unit { name: "inches where the header has mm, or mils where it has um", factor: 25.4 }];
const OF_EITHER: [Unit; 4] = [
    Unit { name: "a unit 10 times that of the header", factor: 10.0 },
    Unit { name: "a unit a tenth of that of the header", factor: 0.1 },
    Unit { name: "a unit 1000 times that of the header", factor: 1e3 },
    Unit { name: "a unit a thousandth of that of the header", factor: 1e-3 },
];

/// Units that an angle may be in.
const OF_ANGLES: [Unit; 3] = [
    Unit { name: "gon where the header has deg", factor: 0.9 },
    Unit { name: "rad where the header has deg", factor: 180.0 / PI },
    Unit { name: "deg where the header has rad", factor: PI / 180.0 },
];

/// Every mistake that a campaign of displacements or its robot's description may have been
/// written with.
pub fn of_displacements(robot: &Description) -> Vec<Mistake> {
    let mut all = of_robot(robot);
    for vector in [Vector::Displacement, Vector::Force] {
        all.extend(Axes::others().map(|axes| Mistake::Axes(vector, axes)));
        all.push(Mistake::Frame(vector));
    }
    all.extend(Axes::others().map(Mistake::AllAxes));
    all.extend(of_units(Vector::Force, &OF_FORCES));
    all.extend(of_units(Vector::Displacement, &OF_LENGTHS));
    all
}

/// The same of a campaign of positions, whose frame may be turned in any way.
pub fn of_positions(robot: &Description) -> Vec<Mistake> {
    let mut all = of_robot(robot);
    all.push(Mistake::OtherHand);
    all.extend(of_units(Vector::Position, &OF_LENGTHS));
    all
}

/// One component of a vector in one of its own units, or of those of either.
fn of_units(vector: Vector, own: &'static [Unit]) -> impl Iterator<Item = Mistake> {
    let units = own.iter().chain(&OF_EITHER);
    units.flat_map(move |&unit| (0..3).map(move |axis| Mistake::Unit(vector, axis, unit)))
}

/// What may be the matter with the coordinates of joints, and with the robot's own description.
fn of_robot(robot: &Description) -> Vec<Mistake> {
    let turns = |joint: usize| robot.joints[joint].kind == JointKind::Revolute;
    let joints = robot.joints.len();
    let mut all = Vec::from([Mistake::Convention]);
    // Of one that turns, all are that one.
    if (0..joints).filter(|&joint| turns(joint)).count() > 1 {
        all.extend(OF_ANGLES.map(Mistake::AllAngles));
    }
    for joint in 0..joints {
        all.push(Mistake::Counted(joint, Counted::Backwards));
        if turns(joint) {
            let quarters = [1.0, 2.0, -1.0].map(Counted::From);
            let units = OF_ANGLES.map(Counted::In);
            all.extend(quarters.into_iter().chain(units).map(|counted| Mistake::Counted(joint, counted)));
        }
        if joint > 0 && turns(joint) && turns(joint - 1) {
            all.extend([1.0, -1.0].map(|sign| Mistake::Counted(joint, Counted::OnJointBefore(sign))));
        }
        let alike = (joint + 1..joints).filter(|&other| turns(other) == turns(joint));
        all.extend(alike.map(|other| Mistake::Exchanged([joint, other])));
    }
    // Every choice of more is one more that may fit by chance, and a fit.
    if joints <= MOST_BACKWARDS {
        let chosen = |of: u32| (0..joints).filter(move |joint| of >> joint & 1 == 1).collect::<Vec<_>>();
        let several = (0..1 << joints).map(chosen).filter(|joints| joints.len() > 1);
        all.extend(several.map(Mistake::Backwards));
    }
    all
}

/// Arms of more joints are not tried with several of them counted the other way.
const MOST_BACKWARDS: usize = 7;

impl Mistake {
    /// The robot and its displacements as they are where this mistake was made.
    pub fn undone(&self, robot: &Description, data: &Displacements) -> (Description, Displacements) {
        let mut data = data.clone();
        match self {
            Self::Frame(Vector::Force) => data.wrench_frame = other(data.wrench_frame),
            Self::Frame(Vector::Displacement) => data.measured_frame = other(data.measured_frame),
            _ => data.rows.iter_mut().for_each(|row| self.undo_in(row, robot)),
        }
        (self.undone_of(robot), data)
    }

    /// The robot and its positions, likewise.
    pub fn undone_in_positions(&self, robot: &Description, data: &Positions) -> (Description, Positions) {
        let mut data = data.clone();
        data.rows.iter_mut().for_each(|row| self.undo_in_position(row, robot));
        (self.undone_of(robot), data)
    }

    fn undone_of(&self, robot: &Description) -> Description {
        let mut robot = robot.clone();
        if *self == Self::Convention {
            robot.convention = match robot.convention {
                Convention::Standard => Convention::Modified,
                Convention::Modified => Convention::Standard,
            };
        }
        robot
    }

    fn undo_in(&self, row: &mut Observation, robot: &Description) {
        match *self {
            Self::Axes(Vector::Force, axes) => axes.apply(&mut row.wrench[..3]),
            Self::Axes(Vector::Displacement, axes) => axes.apply(&mut row.displacement),
            Self::AllAxes(axes) => {
                axes.apply(&mut row.wrench[..3]);
                axes.apply_to_turn(&mut row.wrench[3..]);
                axes.apply(&mut row.displacement);
                row.rotation.iter_mut().for_each(|rotation| axes.apply_to_turn(rotation));
            }
            Self::Unit(Vector::Force, axis, unit) => row.wrench[axis] *= unit.factor,
            Self::Unit(Vector::Displacement, axis, unit) => row.displacement[axis] *= unit.factor,
            // As they were commanded, and as they were read under the load.
            _ => {
                let coordinates = core::iter::once(&mut row.q).chain(&mut row.encoders).chain(&mut row.motors);
                coordinates.for_each(|q| self.undo_in_coordinates(q, robot));
            }
        }
    }

    fn undo_in_position(&self, row: &mut PositionRow, robot: &Description) {
        match *self {
            Self::OtherHand => row.position[0] = -row.position[0],
            Self::Unit(Vector::Position, axis, unit) => row.position[axis] *= unit.factor,
            _ => self.undo_in_coordinates(&mut row.q, robot),
        }
    }

    fn undo_in_coordinates(&self, q: &mut [f64], robot: &Description) {
        match *self {
            Self::Backwards(ref joints) => joints.iter().for_each(|&joint| q[joint] = -q[joint]),
            Self::AllAngles(unit) => {
                let angles = q.iter_mut().zip(&robot.joints).filter(|(_, joint)| joint.kind == JointKind::Revolute);
                angles.for_each(|(q, _)| *q *= unit.factor);
            }
            Self::Counted(joint, counted) => counted.undo(joint, q),
            Self::Exchanged([one, other]) => q.swap(one, other),
            _ => {}
        }
    }
}

fn other(frame: Frame) -> Frame {
    match frame {
        Frame::Base => Frame::Tool,
        Frame::Tool => Frame::Base,
    }
}

impl Counted {
    fn undo(self, joint: usize, q: &mut [f64]) {
        match self {
            Self::Backwards => q[joint] = -q[joint],
            Self::From(quarters) => q[joint] += quarters * FRAC_PI_2,
            Self::OnJointBefore(sign) => q[joint] += sign * q[joint - 1],
            Self::In(unit) => q[joint] *= unit.factor,
        }
    }
}

impl Vector {
    /// The name of the column of a component.
    fn column(self) -> fn(usize) -> String {
        match self {
            Self::Force => |axis| format!("F{}", ["x", "y", "z"][axis]),
            Self::Displacement => |axis| format!("d{}", ["x", "y", "z"][axis]),
            Self::Position => |axis| format!("p{}", ["x", "y", "z"][axis]),
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Force => "forces",
            Self::Displacement => "displacements",
            Self::Position => "positions",
        }
    }
}

/// The mistake as what the files have: "dx and dy exchanged".
impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words = match *self {
            Self::Axes(vector, axes) => axes.words(vector.column()),
            Self::AllAxes(axes) => {
                format!("all vectors along other axes, {}", axes.words(|axis| ["x", "y", "z"][axis].to_string()))
            }
            Self::Frame(vector) => {
                format!("{} in the other frame, base or tool, than the campaign says", vector.words())
            }
            Self::Unit(vector, axis, Unit { name, .. }) => {
                format!("{} in {name}", vector.column()(axis))
            }
            Self::Counted(joint, counted) => {
                let q = format!("q{}", joint + 1);
                match counted {
                    Counted::Backwards => format!("{q} counted the other way"),
                    Counted::From(quarters) => {
                        let which = if quarters < 0.0 { "more" } else { "less" };
                        format!("{q} {which} by {:.0} deg than the description counts", 90.0 * quarters.abs())
                    }
                    Counted::OnJointBefore(sign) => {
                        let which = if sign < 0.0 { "more" } else { "less" };
                        format!(
                            "{q} {which} by q{joint} than the description counts, as where it is counted from the floor"
                        )
                    }
                    Counted::In(Unit { name, .. }) => format!("{q} in {name}"),
                }
            }
            Self::Backwards(ref joints) => {
                let joints: Vec<String> = joints.iter().map(|joint| format!("q{}", joint + 1)).collect();
                format!("{} counted the other way", and(&joints))
            }
            Self::AllAngles(Unit { name, .. }) => format!("all angles in {name}"),
            Self::Exchanged([one, other]) => format!("q{} and q{} exchanged", one + 1, other + 1),
            Self::OtherHand => {
                String::from("px, py and pz of the other hand, one with the other sign or two exchanged")
            }
            Self::Convention => String::from("the DH table in the other convention than the description says"),
        };
        f.write_str(&words)
    }
}
