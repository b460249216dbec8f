//! Where the joints of an arm are.

use std::vec::Vec;

use nalgebra::{Matrix4, SVector, Vector3};
use robstiff_robots::Description;

use crate::campaign::PositionRow;
use robstiff::elements::Pose;
use robstiff::{Robot, with_robot};

/// Where the joints of an arm are at a row, in the base frame.
pub struct Frames {
    /// Of each joint, the direction of its axis and a point on it.
    pub axes: Vec<(Vector3<f64>, Vector3<f64>)>,
    /// Of each joint, the direction of x of its frame.
    pub across: Vec<Vector3<f64>>,
    /// Of each link, the frame behind its joint, which turns with it.
    pub links: Vec<Matrix4<f64>>,
}

/// Where the joints are at some rows.
pub fn frames(robot: &Description, rows: &[PositionRow]) -> Vec<Frames> {
    with_robot!(robot, |robot| frames_of(&robot, rows))
}

fn frames_of<const N: usize>(robot: &impl Robot<N>, rows: &[PositionRow]) -> Vec<Frames> {
    let of_row = |row: &PositionRow| {
        let q = SVector::<f64, N>::from_column_slice(&row.q);
        let pose = Pose::of(robot, &q);
        let geometry = pose.geometry();
        let column = |frame: &Matrix4<f64>, k: usize| frame.fixed_view::<3, 1>(0, k).into_owned();
        let joints = geometry.joint_frames;
        Frames {
            axes: joints.iter().map(|frame| (column(frame, 2), column(frame, 3))).collect(),
            across: joints.iter().map(|frame| column(frame, 0)).collect(),
            links: robot.link_frames(&q).to_vec(),
        }
    };
    rows.iter().map(of_row).collect()
}
