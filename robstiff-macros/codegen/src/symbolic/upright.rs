//! A description as a chain of elementary steps, with its joints where they are put.
//!
//! Both Denavit-Hartenberg conventions, base and tool become the same few
//! steps, so that the algorithms know nothing of conventions.

use robstiff_robots::angle::{quarter_turns, sin_cos_of_turns};
use robstiff_robots::{Convention, Description, JointKind, Placement};

use super::parameters::{harmonic, parameters, remark};
use super::step::{Step, Tilt};
use super::vector::Vec3;
use crate::angle::Angle;
use crate::graph::{Graph, Sym};

/// The steps of a description, base first, with every joint where it stands but for a sag.
pub fn upright<'g>(g: &'g Graph, robot: &Description) -> Vec<Step<'g>> {
    steps(g, robot, &deviations(g, robot), Series::Short)
}

/// The steps with joints that stand aside of their coordinates (rad or m).
pub(super) fn steps<'g>(g: &'g Graph, robot: &Description, aside: &[Option<Sym<'g>>], series: Series) -> Vec<Step<'g>> {
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
pub(super) fn deviations<'g>(g: &'g Graph, robot: &Description) -> Vec<Option<Sym<'g>>> {
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
pub(super) enum Series {
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
