//! Where the kinds of the catalogue can be.

use std::vec;
use std::vec::Vec;

use robstiff_robots::{Description, JointKind};

use super::{Kind, Part, Place, drives};

impl Kind {
    /// Where it can be on an arm, of any campaign; errors of the table, whose places are its
    /// entries, at none.
    pub fn places(&self, robot: &Description) -> Vec<Place> {
        let joints = robot.joints.len();
        match self.name {
            "link_compliance" => {
                (1..joints).filter(|&link| !robot.is_stroke(link)).map(|link| Part::Link(link).into()).collect()
            }
            "base_compliance" | "base_slip" => vec![Part::Base.into()],
            "tool_compliance" => vec![Part::Tool.into()],
            "joint_coupling" => drives(robot).into_iter().map(|pair| Part::Joints(pair).into()).collect(),
            "gravity_sag" => vec![Part::Robot.into()],
            "dh_error" => Vec::new(),
            "pose_dependent_compliance" | "transmission_error" => {
                let turning = (1..=joints).filter(|&joint| robot.joints[joint - 1].kind == JointKind::Revolute);
                turning.map(|joint| Part::Joint(joint).into()).collect()
            }
            _ if self.of_rig => vec![Place::Rig],
            _ => (1..=joints).map(|joint| Part::Joint(joint).into()).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::catalogue::JOINT_COUPLING;

    /// On an arm with a spherical wrist: a drive further down turns joints 2 and 3, the shafts of
    /// the wrist run in one another.
    #[test]
    fn couplings_are_where_joints_share_a_drive() {
        let text = robstiff_robots::catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
        let robot = Description::parse("kuka-kr270-r2700.yaml", text).expect("a description");
        let pairs = [[2, 3], [4, 5], [4, 6], [5, 6]].map(|pair| Place::Part(Part::Joints(pair)));
        assert_eq!(JOINT_COUPLING.places(&robot), pairs);
    }
}
