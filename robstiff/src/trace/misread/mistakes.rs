//! The mistakes that files are written with, and what a campaign is with one undone.

use core::f64::consts::{FRAC_PI_2, PI};
use core::fmt;
use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use robstiff_robots::{Convention, Description};

use crate::JointKind;
use crate::campaign::{Displacements, Frame, Observation};

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
    /// The coordinates of two joints, from 0, are exchanged.
    Exchanged([usize; 2]),
    /// The table of the description is of the other convention.
    Convention,
}

/// What is read three components of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vector {
    Force,
    Displacement,
}

/// For each axis, which component of the file is along it, and its sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes([(usize, f64); 3]);

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

/// Units that one component of a vector may be in where the others are in that of their header.
const OF_FORCES: [Unit; 6] = [
    Unit { name: "kgf where the header has N", factor: 9.80665 },
    Unit { name: "lbf where the header has N", factor: 4.448_221_615_260_5 },
    Unit { name: "a unit 10 times that of the header", factor: 10.0 },
    Unit { name: "a unit a tenth of that of the header", factor: 0.1 },
    Unit { name: "a unit 1000 times that of the header", factor: 1e3 },
    Unit { name: "a unit a thousandth of that of the header", factor: 1e-3 },
];
const OF_DISPLACEMENTS: [Unit; 5] = [
    Unit { name: "inches where the header has mm, or mils where it has um", factor: 25.4 },
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

/// Every mistake that a campaign's file or its robot's description may have been written with.
pub fn mistakes(robot: &Description) -> Vec<Mistake> {
    let turns = |joint: usize| robot.joints[joint].kind == JointKind::Revolute;
    let joints = robot.joints.len();
    let mut all: Vec<Mistake> = Vec::new();
    for vector in [Vector::Displacement, Vector::Force] {
        all.extend(Axes::others().map(|axes| Mistake::Axes(vector, axes)));
        all.push(Mistake::Frame(vector));
    }
    all.extend(Axes::others().map(Mistake::AllAxes));
    for axis in 0..3 {
        all.extend(OF_FORCES.map(|unit| Mistake::Unit(Vector::Force, axis, unit)));
        all.extend(OF_DISPLACEMENTS.map(|unit| Mistake::Unit(Vector::Displacement, axis, unit)));
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
    all.push(Mistake::Convention);
    all
}

impl Mistake {
    /// The robot and its campaign as they are where this mistake was made.
    pub fn undone(&self, robot: &Description, data: &Displacements) -> (Description, Displacements) {
        let (mut robot, mut data) = (robot.clone(), data.clone());
        match self {
            Self::Convention => {
                robot.convention = match robot.convention {
                    Convention::Standard => Convention::Modified,
                    Convention::Modified => Convention::Standard,
                };
            }
            Self::Frame(Vector::Force) => data.wrench_frame = other(data.wrench_frame),
            Self::Frame(Vector::Displacement) => data.measured_frame = other(data.measured_frame),
            _ => data.rows.iter_mut().for_each(|row| self.undo_in(row)),
        }
        (robot, data)
    }

    fn undo_in(&self, row: &mut Observation) {
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
            Self::Counted(joint, counted) => coordinates(row).for_each(|q| counted.undo(joint, q)),
            Self::Exchanged([one, other]) => coordinates(row).for_each(|q| q.swap(one, other)),
            Self::Frame(_) | Self::Convention => {}
        }
    }
}

fn other(frame: Frame) -> Frame {
    match frame {
        Frame::Base => Frame::Tool,
        Frame::Tool => Frame::Base,
    }
}

/// The coordinates of a row as they were commanded, and as they were read under the load.
fn coordinates(row: &mut Observation) -> impl Iterator<Item = &mut Vec<f64>> {
    core::iter::once(&mut row.q).chain(&mut row.encoders).chain(&mut row.motors)
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

impl Axes {
    /// Every one but that in which each component is along its own axis.
    fn others() -> impl Iterator<Item = Self> {
        const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]];
        let signs = |of: usize| [0, 1, 2].map(|axis| if of >> axis & 1 == 0 { 1.0 } else { -1.0 });
        let all = ORDERS
            .into_iter()
            .flat_map(move |order| (0..8).map(move |of| Self([0, 1, 2].map(|axis| (order[axis], signs(of)[axis])))));
        all.skip(1)
    }

    /// Whether right-handed axes stay so.
    fn is_right_handed(&self) -> bool {
        let [x, y, z] = self.0;
        let is_even = (x.0 + 1) % 3 == y.0;
        (x.1 * y.1 * z.1 > 0.0) == is_even
    }

    fn apply(&self, vector: &mut [f64]) {
        let read = [vector[0], vector[1], vector[2]];
        vector.iter_mut().zip(self.0).for_each(|(component, (of, sign))| *component = sign * read[of]);
    }

    /// The same of a moment or a rotation, which counts the other way in a mirror.
    fn apply_to_turn(&self, vector: &mut [f64]) {
        self.apply(vector);
        if !self.is_right_handed() {
            vector.iter_mut().for_each(|component| *component = -*component);
        }
    }

    /// What stands in the columns of a vector.
    fn words(&self, column: fn(usize) -> String) -> String {
        let moved: Vec<usize> = (0..3).filter(|&axis| self.0[axis].0 != axis).collect();
        let reversed: Vec<usize> = (0..3).filter(|&axis| self.0[axis].1 < 0.0).collect();
        match (&moved[..], &reversed[..]) {
            ([], reversed) => format!("{} with the other sign", listed(reversed.iter().map(|&k| column(k)))),
            (&[one, other], []) => format!("{} and {} exchanged", column(one), column(other)),
            _ => {
                let stands = |place: usize| {
                    let in_it = |&axis: &usize| self.0[axis].0 == place;
                    let axis = (0..3).find(in_it).unwrap_or(place);
                    format!("{}{}", if self.0[axis].1 < 0.0 { "-" } else { "" }, column(axis))
                };
                format!("{} where {} should be", listed([0, 1, 2].map(stands)), listed([0, 1, 2].map(column)))
            }
        }
    }
}

fn listed(names: impl IntoIterator<Item = String>) -> String {
    let mut names: Vec<String> = names.into_iter().collect();
    match names.pop() {
        Some(last) if !names.is_empty() => format!("{} and {last}", names.join(", ")),
        last => last.unwrap_or_default(),
    }
}

impl Vector {
    /// The name of the column of a component.
    fn column(self) -> fn(usize) -> String {
        match self {
            Self::Force => |axis| format!("F{}", ["x", "y", "z"][axis]),
            Self::Displacement => |axis| format!("d{}", ["x", "y", "z"][axis]),
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Force => "forces",
            Self::Displacement => "displacements",
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
                        format!("{q} less by {:.0} deg than the description counts", 90.0 * quarters)
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
            Self::Exchanged([one, other]) => format!("q{} and q{} exchanged", one + 1, other + 1),
            Self::Convention => String::from("the DH table in the other convention than the description says"),
        };
        f.write_str(&words)
    }
}
