//! Measured data: a campaign is a YAML file that says what was measured, and a
//! CSV file with the observations.
//!
//! Reading checks everything and converts to SI; nothing is computed with the
//! robot yet, so rows hold what the file says, in the frames the file says.

mod alone;
mod beyond;
mod check;
mod clamped;
mod clock;
#[cfg(test)]
mod clock_tests;
mod displacements;
mod gauges;
pub(crate) mod holdout;
mod joints;
#[cfg(test)]
pub(crate) mod made;
#[cfg(test)]
pub(crate) mod made_positions;
mod order;
mod poses;
mod positions;
pub(crate) mod read;
mod reference;
mod renamed;
mod revisited;
pub(crate) mod rounded;
#[cfg(feature = "schema")]
pub mod schema;
#[cfg(test)]
mod tables_tests;
#[cfg(test)]
mod tests;
mod times;
mod unread;
#[cfg(test)]
mod warned_tests;

use std::path::PathBuf;
use std::string::String;
use std::vec::Vec;

pub(crate) use beyond::told_length;
pub use joints::{Column, JointTable};
use robstiff_robots::Description;
pub use robstiff_robots::ReadError;

/// A measuring campaign on one robot.
#[derive(Clone, Debug)]
pub struct Campaign {
    /// What the file calls itself.
    pub name: String,
    /// When it was measured, as the file says it; empty where it does not.
    pub date: String,
    /// Who measured; empty where the file does not say it.
    pub operator: String,
    /// The campaign file.
    pub path: PathBuf,
    /// The robot's description file, as resolved from the campaign's folder, or its name in the
    /// catalogue.
    pub robot_path: PathBuf,
    /// The file with the observations, likewise.
    pub observations_path: PathBuf,
    /// The robot as declared.
    pub robot: Description,
    /// The observations.
    pub data: Data,
    /// The noise as declared.
    pub noise: Noise,
    /// Which part of the poses to hold out, if the file asks for it.
    pub holdout: Option<Holdout>,
    /// More poses that are held out, by index.
    pub held_out: Vec<usize>,
    /// What the reader noticed without refusing the files, e.g. unknown columns.
    pub warnings: Vec<String>,
}

/// The observations, by kind of campaign.
#[derive(Clone, Debug)]
pub enum Data {
    /// Loaded minus unloaded displacement of a point of the tool.
    Displacement(Displacements),
    /// Absolute positions of a point of the tool.
    Position(Positions),
    /// One axis loaded, those before it clamped.
    Clamped(Vec<ClampedRow>),
}

impl Data {
    /// The ids of its poses; clamped axes have none.
    pub fn poses(&self) -> &[String] {
        match self {
            Self::Displacement(data) => &data.poses,
            Self::Position(data) => &data.poses,
            Self::Clamped(_) => &[],
        }
    }
}

/// One sigma of one axis of one reading, where the file declares it. A
/// displacement is the difference of a loaded and an unloaded reading.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// Of a displacement reading (m).
    pub displacement: Option<f64>,
    /// Of a rotation reading (rad).
    pub rotation: Option<f64>,
}

/// The poses kept for judging, never for choosing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Holdout {
    /// The fraction of the poses, between 0 and 1 exclusive.
    pub fraction: f64,
    /// Seed of the choice.
    pub seed: u64,
}

impl Holdout {
    /// How many of so many poses it keeps. Where there are two, at least one is on
    /// either side.
    pub fn count(&self, poses: usize) -> usize {
        if poses < 2 { 0 } else { ((self.fraction * poses as f64).round() as usize).clamp(1, poses - 1) }
    }
}

/// Which frame a vector of the file is given in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Frame {
    /// The robot's base frame.
    #[default]
    Base,
    /// The tool's (TCP's) frame.
    Tool,
}

/// Rows of kind `displacement`.
#[derive(Clone, Debug)]
pub struct Displacements {
    /// The frame of forces and moments.
    pub wrench_frame: Frame,
    /// Where the wrench acts, in the tool frame (m); the TCP is the origin.
    pub wrench_at: [f64; 3],
    /// The frame of displacements and rotations.
    pub measured_frame: Frame,
    /// Where the displacement is measured, in the tool frame (m).
    pub measured_at: [f64; 3],
    /// Along what it is measured, unit vectors in that frame: the axes, some of them, or the stem of a dial
    /// gauge. What is not along one of them is zero in every row.
    pub directions: Vec<[f64; 3]>,
    /// Pose ids in order of appearance; rows refer to them by index. Of several ids with the
    /// same joint coordinates there is the first.
    pub poses: Vec<String>,
    /// Visit ids in order of appearance; rows refer to them by index. Without
    /// the column, every row is a visit of its own.
    pub visits: Vec<String>,
    /// The rows, in the order in which they were read: the file's, or that of their times where a
    /// file has them in another.
    pub rows: Vec<Observation>,
}

/// The axes of a frame.
pub const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Displacements {
    /// Whether all three components of a displacement are measured.
    pub fn is_whole(&self) -> bool {
        self.directions.len() == AXES.len()
    }
}

/// One row of kind `displacement`, as the file gives it, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Line of the CSV file, from 1.
    pub line: usize,
    /// Index into [`Displacements::poses`].
    pub pose: usize,
    /// Index into [`Displacements::visits`].
    pub visit: usize,
    /// Time (s). Where a file tells Unix time or that of the day, or what a clock showed, since
    /// the campaign began.
    pub time: Option<f64>,
    /// Temperature (degrees Celsius or K, as the file has it: differences count).
    pub temperature: Option<f64>,
    /// Joint coordinates (rad or m), one a joint.
    pub q: Vec<f64>,
    /// Force and moment in [`Displacements::wrench_frame`] (N, Nm).
    pub wrench: [f64; 6],
    /// Displacement in [`Displacements::measured_frame`] (m).
    pub displacement: [f64; 3],
    /// Rotation in the same frame (rad), where measured.
    pub rotation: Option<[f64; 3]>,
    /// Joint coordinates under the load on the output side of the gears, by
    /// secondary encoders (rad or m), one a joint, where read.
    pub encoders: Option<Vec<f64>>,
    /// Joint coordinates under the load by the motors' encoders, through the
    /// gear ratio (rad or m), one a joint, where read: what the controller lets
    /// through.
    pub motors: Option<Vec<f64>>,
}

/// Rows of kind `position`.
#[derive(Clone, Debug)]
pub struct Positions {
    /// Where the payload hangs, in the tool frame (m); the TCP is the origin.
    pub payload_at: [f64; 3],
    /// The point that is read, in the tool frame (m).
    pub measured_at: [f64; 3],
    /// Pose ids in order of appearance; rows refer to them by index. Of several ids with the
    /// same joint coordinates there is the first.
    pub poses: Vec<String>,
    /// Visit ids in order of appearance; rows refer to them by index. Without
    /// the column, every row is a visit of its own.
    pub visits: Vec<String>,
    /// The rows, in the order in which they were read: the file's, or that of their times where a
    /// file has them in another.
    pub rows: Vec<PositionRow>,
}

/// One row of kind `position`, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct PositionRow {
    /// Line of the CSV file, from 1.
    pub line: usize,
    /// Index into [`Positions::poses`].
    pub pose: usize,
    /// Index into [`Positions::visits`].
    pub visit: usize,
    /// Time (s); of a clock since the midnight before the first row.
    pub time: Option<f64>,
    /// Temperature (degrees Celsius or K, as the file has it: differences count).
    pub temperature: Option<f64>,
    /// Joint coordinates (rad or m), one a joint.
    pub q: Vec<f64>,
    /// The position in the frame of what reads it, wherever that stands (m).
    pub position: [f64; 3],
    /// The payload (kg), 0 where the file has no such column.
    pub payload: f64,
}

/// One row of kind `clamped`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClampedRow {
    /// Line of the CSV file, from 1.
    pub line: usize,
    /// The loaded axis, from 1.
    pub axis: usize,
    /// Torque about the axis (Nm); of one that slides, force along it (N).
    pub torque: f64,
    /// Deflection of the axis (rad or m).
    pub deflection: f64,
}
