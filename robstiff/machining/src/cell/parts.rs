//! What a cell is made of, and the frames that follow from it.

use std::path::PathBuf;

use nalgebra::{Matrix4, Rotation3, Unit, Vector3};
use robstiff_robots::{Description, Placement};

use crate::nc::{Machine, OFFSETS, Options};

/// A production cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// What the file calls it; may be empty.
    pub name: String,
    /// The file's name, as problems show it.
    pub file: String,
    /// The robot as its description has it.
    pub robot: Description,
    /// The file of the description, or the name of the robot's file in the catalogue.
    pub robot_path: PathBuf,
    /// The spindle at the flange.
    pub spindle: Option<Spindle>,
    /// The tools, each number once; none where nothing is known of them.
    pub tools: Vec<Tool>,
    /// The number of the tool that is in the spindle where the path does not say it.
    pub tool: Option<u32>,
    /// Where the frames of programs stand.
    pub work: Option<Work>,
    /// The stock, a box along the axes of the work frame: its lower and its upper corner there (m).
    pub stock: Option<[Vector3<f64>; 2]>,
    /// How fast each joint can move (rad/s, or m/s of one that slides); empty where nobody says it.
    pub joint_speeds: Vec<f64>,
    /// The file of the cut.
    pub cut: Option<PathBuf>,
    /// How programs are read.
    pub program: Program,
}

/// A spindle.
#[derive(Clone, Debug, PartialEq)]
pub struct Spindle {
    /// The frame of its nose in the flange frame; `None`: the tool of the description.
    pub nose: Option<Placement>,
    /// From the nose to the tip, in the frame of the nose.
    pub axis: Unit<Vector3<f64>>,
    /// The least and the highest speed (rad/s).
    pub speeds: Option<[f64; 2]>,
}

/// A tool.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    /// Its number in programs.
    pub number: u32,
    /// What it is called; may be empty.
    pub name: String,
    /// From the nose of the spindle to the tip (m).
    pub length: f64,
    /// The diameter (m).
    pub diameter: Option<f64>,
    /// The radius of its corners (m): half of the diameter is a ball.
    pub corner_radius: Option<f64>,
    /// How many teeth it has.
    pub teeth: Option<usize>,
}

/// Where the frames of programs stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// The frame of the path in the base frame: that of G54 where frames have names.
    pub place: Placement,
    /// The zeros of the work offsets in that frame (m), where frames have names.
    pub offsets: [Option<Vector3<f64>>; OFFSETS.len()],
}

/// How programs are read: what [`Options`] holds, as far as the cell says it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// The rotary axes that programs are written for.
    pub machine: Option<Machine>,
    /// Whether coordinates are those of the tip on the workpiece whatever the rotary axes do.
    pub tcp: Option<bool>,
    /// How far chords are off the arcs that they stand for, at most (m).
    pub arc_tolerance: Option<f64>,
}

impl Cell {
    /// How its programs are read.
    pub fn options(&self) -> Options {
        let defaults = Options::default();
        Options {
            arc_tolerance: self.program.arc_tolerance.unwrap_or(defaults.arc_tolerance),
            machine: self.program.machine.clone(),
            tcp: self.program.tcp,
            offsets: self.work.as_ref().map_or(defaults.offsets, |work| work.offsets),
        }
    }

    /// Where the frame of the path stands in the base frame (homogeneous, 4 x 4, m).
    pub fn place(&self) -> Option<Matrix4<f64>> {
        self.work.as_ref().map(|work| homogeneous(&work.place))
    }

    /// The TCP in the flange frame with a tool in the spindle: its tip, turned as the nose is.
    pub fn tcp(&self, tool: Option<&Tool>) -> Placement {
        let Some(spindle) = &self.spindle else { return self.robot.tool };
        let nose = spindle.nose.unwrap_or(self.robot.tool);
        let length = tool.map_or(0.0, |tool| tool.length);
        let tip = Vector3::from(nose.xyz) + rotation(&nose) * spindle.axis.into_inner() * length;
        Placement { xyz: tip.into(), rpy: nose.rpy }
    }

    /// The robot with a tool in the spindle.
    pub fn robot_with(&self, tool: Option<&Tool>) -> Description {
        Description { tool: self.tcp(tool), ..self.robot.clone() }
    }
}

pub(super) fn rotation(placement: &Placement) -> Rotation3<f64> {
    let [roll, pitch, yaw] = placement.rpy;
    Rotation3::from_euler_angles(roll, pitch, yaw)
}

fn homogeneous(placement: &Placement) -> Matrix4<f64> {
    Matrix4::new_translation(&placement.xyz.into()) * rotation(placement).to_homogeneous()
}
