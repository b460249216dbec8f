//! A robot as its YAML file describes it, checked, in SI units.

use crate::controller::Controller;
use crate::effect::physics::Row;
use crate::effect::{Convention, Effect, JointKind};
use crate::placement::Placement;

/// The most joints a robot may have.
pub const MOST_JOINTS: usize = 8;

/// Names that no robot may have: those that generated code imports, and `Self`, which is no
/// name.
pub const TAKEN: [&str; 14] = [
    "Self",
    "Robot",
    "Real",
    "Statics",
    "State",
    "Effect",
    "DhEntry",
    "Convention",
    "JointKind",
    "Matrix4",
    "Matrix6",
    "SMatrix",
    "SVector",
    "Vector6",
];

/// A robot: kinematics, joint compliance, and the effects beyond it.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// The name, which becomes the Rust type (an upper camel case identifier).
    pub name: String,
    /// One line on what the robot is.
    pub description: String,
    /// Where the numbers come from.
    pub source: String,
    /// How the rows of [`joints`](Self::joints) are to be read.
    pub convention: Convention,
    /// Frame 0 in the base (world) frame, in which wrenches and displacements
    /// are given.
    pub base: Placement,
    /// The DH rows, from the base to the flange; one to eight.
    pub joints: Vec<Joint>,
    /// The tool centre point's frame in the flange frame.
    pub tool: Placement,
    /// Masses for gravity: empty, or one a joint.
    pub links: Vec<Link>,
    /// What is beyond the table and the joints' compliance.
    pub effects: Vec<Effect>,
    /// How the robot's controller sees it.
    pub controller: Option<Controller>,
}

/// One row of the DH table with the joint it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Turning or sliding.
    pub kind: JointKind,
    /// DH angle about z at joint coordinate 0 (rad).
    pub theta: f64,
    /// DH offset along z at joint coordinate 0 (m).
    pub d: f64,
    /// DH length along x (m).
    pub a: f64,
    /// DH twist about x (rad).
    pub alpha: f64,
    /// Lower and upper limit of the joint coordinate [rad or m].
    pub limits: Option<[f64; 2]>,
    /// The parts of the compliance [rad/Nm or m/N], which add up; a joint with
    /// one number has one part with an empty name, a rigid joint has none.
    pub compliance: Vec<Part>,
}

impl Description {
    /// The joints with the rows of the DH table as the effects correct them.
    pub fn corrected_joints(&self) -> Vec<Joint> {
        corrected(&self.joints, &self.effects)
    }

    /// Whether a link is nothing but the stroke of a joint that slides, as the
    /// effects correct it: it may have no length, and then no direction along
    /// which to be a beam. Links count from 1, the body behind joint 1, to one
    /// less than joints; no other is a stroke.
    pub fn is_stroke(&self, link: usize) -> bool {
        (1..self.joints.len()).contains(&link) && is_stroke(self.convention, &self.corrected_joints(), link)
    }

    /// Whether a link can be a beam: it has a length, as the effects correct it,
    /// and is more than a stroke. Links count from 1 to one less than joints; no
    /// other is a beam.
    pub fn is_beam(&self, link: usize) -> bool {
        (1..self.joints.len()).contains(&link)
            && !self.is_stroke(link)
            && has_length(self.convention, &self.corrected_joints(), link)
    }
}

/// The joints with the rows of the DH table as these effects correct them.
pub(crate) fn corrected<'e>(joints: &[Joint], effects: impl IntoIterator<Item = &'e Effect>) -> Vec<Joint> {
    let mut joints = joints.to_vec();
    for effect in effects {
        let Some(joint) = effect.row().and_then(|row| joints.get_mut(row - 1)) else { continue };
        let mut row = Row { theta: joint.theta, d: joint.d, a: joint.a, alpha: joint.alpha };
        effect.correct(&mut row);
        (joint.theta, joint.d) = (row.theta, row.d);
        (joint.a, joint.alpha) = (row.a, row.alpha);
    }
    joints
}

/// The joint whose row of the DH table is a link's (from 1).
fn of_link(convention: Convention, joints: &[Joint], link: usize) -> Option<&Joint> {
    let row = match convention {
        Convention::Standard => link,
        Convention::Modified => link + 1,
    };
    joints.get(row - 1)
}

/// Whether a link is a stroke, of joints that have been [`corrected`].
pub(crate) fn is_stroke(convention: Convention, joints: &[Joint], link: usize) -> bool {
    of_link(convention, joints, link).is_some_and(|joint| joint.kind == JointKind::Prismatic && joint.a == 0.0)
}

/// Whether a link has a length, of joints that have been [`corrected`]; what
/// slides has one but for a point.
pub(crate) fn has_length(convention: Convention, joints: &[Joint], link: usize) -> bool {
    of_link(convention, joints, link)
        .is_none_or(|joint| joint.kind == JointKind::Prismatic || joint.a != 0.0 || joint.d != 0.0)
}

/// Coordinates beyond a limit by less than this are on it (rad or m): a limit in
/// degrees is rounded.
pub const ON_THE_LIMIT: f64 = 1e-6;

impl Joint {
    /// The joint's compliance, the sum of its parts [rad/Nm or m/N].
    pub fn compliance(&self) -> f64 {
        // The sum of nothing is a negative zero.
        self.compliance.iter().map(|part| part.value).sum::<f64>() + 0.0
    }

    /// Whether a coordinate (rad or m) is within the limits, if there are any.
    pub fn reaches(&self, q: f64) -> bool {
        self.limits.is_none_or(|[low, high]| (low - ON_THE_LIMIT..=high + ON_THE_LIMIT).contains(&q))
    }

    /// A coordinate (rad or m) as people give it, in the
    /// [`people_unit`](Self::people_unit), without the rounding of the
    /// conversion.
    pub fn for_people(&self, q: f64) -> f64 {
        let unit = match self.kind {
            JointKind::Revolute => 1_f64.to_radians(),
            JointKind::Prismatic => 1e-3,
        };
        (q / unit * 1e6).round() / 1e6
    }

    /// The unit in which people give the joint's coordinate.
    pub fn people_unit(&self) -> &'static str {
        match self.kind {
            JointKind::Revolute => "deg",
            JointKind::Prismatic => "mm",
        }
    }

    /// What a coordinate that the joint does not reach is, in words; nothing
    /// for a joint without limits.
    pub fn outside_limits(&self) -> Option<String> {
        let [low, high] = self.limits?.map(|limit| self.for_people(limit));
        Some(format!("outside its limits [{low}, {high}] {}", self.people_unit()))
    }
}

/// One part of a compound joint's compliance, such as `gear` or `belt`.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The part's name; empty where the joint is not compound.
    pub name: String,
    /// Its compliance [rad/Nm or m/N].
    pub value: f64,
}

/// Mass of the body that moves with joint `i`, for gravity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Link {
    /// Mass (kg).
    pub mass: f64,
    /// Centre of mass in the link's frame `i` (m).
    pub center_of_mass: [f64; 3],
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_between_two_joints_is_a_link() {
        for (convention, rows) in
            [("standard", "{type: prismatic}, {a: 1 m}, {}"), ("modified", "{}, {type: prismatic}, {a: 1 m}")]
        {
            let text = format!("name: Arm\nconvention: {convention}\njoints: [{rows}]\n");
            let arm = Description::parse("arm.yaml", &text).unwrap_or_else(|problems| panic!("{problems}"));
            assert_eq!([0, 1, 2, 3, 9].map(|link| arm.is_stroke(link)), [false, true, false, false, false]);
            assert_eq!([0, 1, 2, 3, 9].map(|link| arm.is_beam(link)), [false, false, true, false, false]);
        }
    }
}
