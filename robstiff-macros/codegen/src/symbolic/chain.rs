//! A description as a chain of elementary steps from the base to the TCP.
//!
//! Both Denavit-Hartenberg conventions, base and tool become the same few
//! steps, so that the algorithms know nothing of conventions.

use robstiff_robots::angle::{quarter_turns, sin_cos_of_turns};
use robstiff_robots::{Convention, Description, JointKind, Placement};

use super::elastic::{harmonic, parameters, remark};
use super::vector::Vec3;
use super::weight;
use crate::angle::Angle;
use crate::graph::{Graph, Sym};

/// One step from a frame to the next. What stands in the frame that has been
/// reached (a joint, the foundation) is a step that does not move.
#[derive(Clone, Debug)]
pub enum Step<'g> {
    /// A shift along the axes of the current frame.
    Move(Vec3<'g>),
    /// A turn about the current z axis.
    Turn(Angle),
    /// A turn about the current axis 0 (x) or 1 (y) by a constant angle.
    Tilt(Tilt<'g>),
    /// Here is frame 0.
    Base,
    /// Joint `i` (from 0) acts on the current z axis, at the current origin.
    Joint(usize),
    /// Link `i` (from 0) begins at the current origin and ends a vector
    /// further, in the current axes.
    Link(usize, Vec3<'g>),
    /// Here is the frame of link `i` (from 0).
    LinkFrame(usize),
    /// Here is the flange frame.
    Flange,
}

/// A constant turn about x (0) or y (1).
#[derive(Clone, Copy, Debug)]
pub struct Tilt<'g> {
    /// The axis turned about.
    pub axis: usize,
    /// Sine and cosine.
    pub sin_cos: (Sym<'g>, Sym<'g>),
}

impl Tilt<'_> {
    /// Whether this is half a turn about x, which merely mirrors turns about z.
    pub fn is_half_turn_about_x(&self) -> bool {
        // The cosine alone is -1 by rounding, too.
        self.axis == 0 && self.sin_cos.0.is_zero() && self.sin_cos.1.constant() == Some(-1.0)
    }
}

/// The steps of a description, base first, with every joint where it stands.
pub fn chain<'g>(g: &'g Graph, robot: &Description) -> Vec<Step<'g>> {
    let aside = deviations(g, robot);
    let upright = steps(g, robot, &aside, Series::Short);
    let Some(sag) = weight::sag(g, robot, &upright) else { return upright };
    let both = |(aside, sag): (&Option<Sym<'g>>, Sym<'g>)| Some(aside.map_or(sag, |aside| aside + sag));
    steps(g, robot, &aside.iter().zip(sag).map(both).collect::<Vec<_>>(), Series::Long)
}

/// The same without a sag.
pub fn upright<'g>(g: &'g Graph, robot: &Description) -> Vec<Step<'g>> {
    steps(g, robot, &deviations(g, robot), Series::Short)
}

/// The steps with joints that stand aside of their coordinates (rad or m).
fn steps<'g>(g: &'g Graph, robot: &Description, aside: &[Option<Sym<'g>>], series: Series) -> Vec<Step<'g>> {
    let mut steps = Vec::new();
    place(g, &mut steps, &robot.base, "BASE", "Frame 0 in the base frame");
    steps.push(Step::Base);
    for (i, (joint, stated)) in robot.corrected_joints().iter().zip(&robot.joints).enumerate() {
        let number = i + 1;
        let entry = |name: &str, value: f64, stated: f64, what: &str| {
            let corrected = if value == stated { "" } else { ", corrected" };
            g.named_number(&format!("{name}{number}"), value, &format!("{what} of row {number}{corrected} (m)."))
        };
        let d = entry("D", joint.d, stated.d, "DH offset d");
        let a = entry("A", joint.a, stated.a, "DH length a");
        let corrected = if joint.theta == stated.theta { "" } else { ", corrected" };
        let (name, what) = (format!("THETA{number}"), format!("the DH angle theta of row {number}{corrected}"));
        g.named_number(&name, joint.theta, &format!("DH angle theta of row {number}{corrected} (rad)."));
        let theta = |angle: Angle| angle.named(&name, joint.theta, &what);
        let aside = aside[i].filter(|aside| !aside.is_zero());
        let (turn, d) = match (joint.kind, aside) {
            (JointKind::Revolute, None) => (theta(Angle::of_joint(i, joint.theta)), d),
            (JointKind::Revolute, Some(aside)) => {
                g.remark(format!("Sine and cosine of the angle e{number} by which joint {number} stands aside."));
                let deviation = g.add_deviation(series.sin_cos(g, aside.named(format!("e{number}"))));
                (theta(Angle::of_joint(i, joint.theta)).with_deviation(deviation), d)
            }
            (JointKind::Prismatic, None) => (theta(Angle::constant(joint.theta)), g.coordinate(i) + d),
            (JointKind::Prismatic, Some(aside)) => (theta(Angle::constant(joint.theta)), g.coordinate(i) + aside + d),
        };
        let twist = tilt(g, 0, joint.alpha, &format!("ALPHA{number}"), &format!("the DH twist alpha of row {number}"));
        let along = Vec3([a, g.number(0.0), d]);
        match robot.convention {
            Convention::Standard => {
                steps.extend([Step::Joint(i), Step::Turn(turn)]);
                if number < robot.joints.len() {
                    steps.push(Step::Link(i, along));
                }
                steps.push(Step::Move(along));
                steps.extend(twist);
            }
            Convention::Modified => {
                steps.extend(twist);
                if i > 0 {
                    steps.push(Step::Link(i - 1, along));
                }
                // Tz(d) commutes with Rz(theta): one shift for a and d.
                steps.extend([Step::Move(along), Step::Turn(turn), Step::Joint(i)]);
            }
        }
        steps.push(Step::LinkFrame(i));
    }
    steps.push(Step::Flange);
    place(g, &mut steps, &robot.tool, "TOOL", "TCP in the flange frame");
    steps.retain(|step| match step {
        Step::Move(by) => !by.is_zero(),
        Step::Turn(angle) => !angle.is_zero(),
        _ => true,
    });
    steps
}

/// By how much effects of their own make the joints stand aside, a joint each.
fn deviations<'g>(g: &'g Graph, robot: &Description) -> Vec<Option<Sym<'g>>> {
    (0..robot.joints.len()).map(|joint| deviation(g, robot, joint)).collect()
}

/// By how much effects of its own make a joint (from 0) stand aside of its
/// coordinate (rad).
fn deviation<'g>(g: &'g Graph, robot: &Description, joint: usize) -> Option<Sym<'g>> {
    let effects = robot.effects.iter().filter(|effect| effect.row() == Some(joint + 1));
    let own = effects.filter(|effect| effect.is_kinematic()).filter_map(|effect| {
        remark(g, effect);
        effect.deviation(&parameters(g, effect), &harmonic(g, joint))
    });
    own.reduce(|sum, more| sum + more)
}

/// How many terms give sine and cosine of a small angle to rounding.
#[derive(Clone, Copy)]
enum Series {
    /// Of at most [`MOST_DEVIATION`](robstiff_robots::effect::physics::MOST_DEVIATION).
    Short,
    /// Of that and at most [`MOST_SAG`](robstiff_robots::effect::physics::MOST_SAG)
    /// together.
    Long,
}

impl Series {
    fn sin_cos<'g>(self, g: &'g Graph, angle: Sym<'g>) -> (Sym<'g>, Sym<'g>) {
        let number = |value| g.number(value);
        let square = angle.squared();
        let (sin, cos) = match self {
            Self::Short => (number(1.0 / 120.0), number(1.0 / 24.0)),
            Self::Long => {
                (number(1.0 / 120.0) - square * number(1.0 / 5040.0), number(1.0 / 24.0) - square * number(1.0 / 720.0))
            }
        };
        let cos = number(1.0) - square * (number(0.5) - square * cos);
        let sin = angle - angle * square * (number(1.0 / 6.0) - square * sin);
        (sin, cos)
    }
}

fn place<'g>(g: &'g Graph, steps: &mut Vec<Step<'g>>, placement: &Placement, name: &str, what: &str) {
    if *placement == Placement::default() {
        return;
    }
    let at = |axis: usize, letter| {
        g.named_number(&format!("{name}_{letter}"), placement.xyz[axis], &format!("{what}, along {letter} (m)."))
    };
    let [roll, pitch, yaw] = placement.rpy;
    steps.push(Step::Move(Vec3([at(0, 'X'), at(1, 'Y'), at(2, 'Z')])));
    let of = name.to_lowercase();
    steps.push(Step::Turn(Angle::constant(yaw).named(&format!("{name}_YAW"), yaw, &format!("the yaw of the {of}"))));
    steps.extend(tilt(g, 1, pitch, &format!("{name}_PITCH"), &format!("the pitch of the {of}")));
    steps.extend(tilt(g, 0, roll, &format!("{name}_ROLL"), &format!("the roll of the {of}")));
}

/// The turn by a constant angle, if it is one; exact at multiples of 90
/// degrees, else with a named sine and cosine.
fn tilt<'g>(g: &'g Graph, axis: usize, angle: f64, name: &str, what: &str) -> Option<Step<'g>> {
    let sin_cos = match quarter_turns(angle) {
        Some(0) => return None,
        Some(turns) => {
            let (s, c) = sin_cos_of_turns(turns);
            (g.number(s), g.number(c))
        }
        None => (
            g.named_number(&format!("SIN_{name}"), angle.sin(), &format!("Sine of {what}.")),
            g.named_number(&format!("COS_{name}"), angle.cos(), &format!("Cosine of {what}.")),
        ),
    };
    Some(Step::Tilt(Tilt { axis, sin_cos }))
}

/// The homogeneous matrix of a placement by rows, with exact quarter turns.
pub fn homogeneous(placement: &Placement) -> [f64; 16] {
    let [(sr, cr), (sp, cp), (sy, cy)] = placement.rpy.map(|angle| match quarter_turns(angle) {
        Some(turns) => sin_cos_of_turns(turns),
        None => angle.sin_cos(),
    });
    let [x, y, z] = placement.xyz;
    [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, x],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, y],
        [-sp, cp * sr, cp * cr, z],
        [0.0, 0.0, 0.0, 1.0],
    ]
    // -0 would be printed as such.
    .map(|row| row.map(|entry| entry + 0.0))
    .concat()
    .try_into()
    .expect("four rows of four")
}
