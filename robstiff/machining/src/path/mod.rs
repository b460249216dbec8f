//! Tool paths: where the tool is to be, point by point, and the joint
//! coordinates that bring it there.
//!
//! [`ToolPath`] is what the file says, [`solve`](ToolPath::solve) turns it into
//! a [`SolvedPath`]: joint coordinates, poses, feed directions and arc lengths
//! for every point, or the names of all points that cannot be reached.

pub(crate) mod follow;
mod plan;
#[cfg(test)]
mod plan_tests;
mod planned;
mod program;
#[cfg(test)]
mod program_tests;
pub(crate) mod read;
mod seeds;
mod stations;
mod steps;
#[cfg(test)]
mod tests;
mod turn;

use nalgebra::{Matrix4, SVector, Unit, Vector3, Vector6};
use robstiff_robots::text::Lines;
use robstiff_robots::{Diagnostics, words};

pub use crate::inverse::{Orientation, Remaining, Target, Unreached};

/// A tool path as a file says it: poses of the tool centre point (TCP) or joint
/// coordinates, in order.
#[derive(Clone, Debug)]
pub struct ToolPath {
    /// The file's name, as problems show it.
    pub file: String,
    /// The points, at least one.
    pub points: Vec<Waypoint>,
    /// What the reader noticed without refusing the file.
    pub warnings: Vec<String>,
    /// Whether it is a program of a machine tool: its feeds are those of the cut.
    pub is_program: bool,
    /// The tool's axis in the TCP's frame.
    tool: Unit<Vector3<f64>>,
    /// The file's lines, to show them.
    lines: Lines<String>,
}

/// One point of a [`ToolPath`].
#[derive(Clone, Debug, PartialEq)]
pub struct Waypoint {
    /// The line of the file, from 1.
    pub line: usize,
    /// Where the robot is to be.
    pub goal: Goal,
    /// How fast the TCP moves along the path (m/s), where the file says it.
    pub feed: Option<f64>,
    /// The arc length (m), where the file says it.
    pub s: Option<f64>,
    /// Whether the point is reached by a rapid, in which nothing is cut.
    pub rapid: bool,
    /// The speed of the spindle (rad/s), clockwise seen from it, where the file says it.
    pub spindle: Option<f64>,
    /// The number of the tool, where the file says it.
    pub tool: Option<u32>,
    /// The radial width of the cut (m) on the way to the point, where the file says it; 0 in the air.
    pub width: Option<f64>,
    /// The axial depth of the cut (m), the same way.
    pub depth: Option<f64>,
}

/// Where the robot is to be at a point.
#[derive(Clone, Debug, PartialEq)]
pub enum Goal {
    /// A pose of the TCP in the base frame.
    Tool(Target),
    /// Joint coordinates (rad or m).
    Joints(Vec<f64>),
}

/// What is known beside a path, for the plan of its turns.
#[derive(Clone, Copy, Debug, Default)]
pub struct Known<'k> {
    /// How fast each joint can move (rad/s or m/s); empty where that is not known.
    pub speeds: &'k [f64],
    /// What acts on the tool at each point, in the base frame (N, Nm); empty where that is not known.
    pub forces: &'k [Vector6<f64>],
}

/// A tool path with the joint coordinates of an arm of `N` joints.
#[derive(Clone, Debug, PartialEq)]
pub struct SolvedPath<const N: usize> {
    /// The points, as many as the tool path has and in its order.
    pub points: Vec<PathPoint<N>>,
    /// Where the arm changes its posture between two points.
    pub jumps: Vec<Jump>,
}

/// One point of a [`SolvedPath`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint<const N: usize> {
    /// The line of the file, from 1.
    pub line: usize,
    /// Joint coordinates (rad or m).
    pub q: SVector<f64, N>,
    /// The TCP's frame in the base frame, homogeneous, 4 x 4 (m).
    pub pose: Matrix4<f64>,
    /// The feed direction, in the base frame: along the chord to the next
    /// point at the start, from the last one at the end, and halfway between
    /// the two elsewhere; where one of the two is a rapid, along the other.
    /// `None` where the TCP stays in place all along.
    pub tangent: Option<Unit<Vector3<f64>>>,
    /// The arc length from the first point (m): as the file says it, else the
    /// sum of the chords.
    pub s: f64,
    /// How fast the TCP moves along the path (m/s), where the file says it.
    pub feed: Option<f64>,
    /// Whether the point is reached by a rapid, in which nothing is cut.
    pub rapid: bool,
    /// The speed of the spindle (rad/s), clockwise seen from it, where the file says it.
    pub spindle: Option<f64>,
    /// The number of the tool, where the file says it.
    pub tool: Option<u32>,
    /// The radial width of the cut (m) on the way to the point, where the file says it; 0 in the air.
    pub width: Option<f64>,
    /// The axial depth of the cut (m), the same way.
    pub depth: Option<f64>,
}

impl<const N: usize> SolvedPath<N> {
    /// The length of the path that each point stands for (m): half of the way from the point before and half of
    /// that to the next, as far as these are no rapids. Averages over a path are weighed by it, or
    /// more points on a leg would make that leg count for more.
    pub fn lengths(&self) -> Vec<f64> {
        let mut lengths = vec![0.0; self.points.len()];
        for (i, pair) in self.points.windows(2).enumerate().filter(|(_, pair)| !pair[1].rapid) {
            let half = 0.5 * (pair[1].s - pair[0].s);
            lengths[i] += half;
            lengths[i + 1] += half;
        }
        lengths
    }
}

impl<const N: usize> PathPoint<N> {
    /// The TCP in the base frame (m).
    pub fn position(&self) -> Vector3<f64> {
        self.pose.fixed_view::<3, 1>(0, 3).into_owned()
    }
}

/// Two neighbouring points between which the arm changes its posture: half of
/// the way in joint coordinates is far from half of the way of the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The lines of the two points.
    pub lines: [usize; 2],
    /// The joint that moves most (from 1).
    pub joint: usize,
    /// By how much it moves (rad or m).
    pub change: f64,
    /// How far the tool is off the middle when all joints are halfway.
    pub off: Remaining,
}

/// A tool path with points that the arm does not reach.
#[derive(Clone, Debug)]
pub struct Unsolved {
    /// Every such point: its line and why, in the order of the file.
    pub points: Vec<(usize, Unreached)>,
    /// How many points the path has.
    pub of: usize,
    /// The same for a person, the first ten.
    pub problems: Diagnostics,
    /// Whether the file gives joint coordinates, which no frame or tool can be wrong for.
    of_joints: bool,
}

impl core::fmt::Display for Unsolved {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let count = self.points.len();
        let lines = lines(self.points.iter().map(|(line, _)| *line));
        let of = words::count(self.of, "point");
        write!(f, "{}\n\n{count} of {of} cannot be reached: {lines}", self.problems)?;
        if count == self.of && !self.of_joints && !self.points.iter().all(|(_, why)| *why == Unreached::TurnAboutTool) {
            f.write_str("; is the path given in another frame, in another unit, or along another axis of the tool?")?;
        }
        Ok(())
    }
}

impl core::error::Error for Unsolved {}

/// Lines of a file, one after another together: `lines 2 to 5, 9`, `line 2`.
pub fn lines(of: impl IntoIterator<Item = usize>) -> String {
    let mut runs: Vec<[usize; 2]> = Vec::new();
    for line in of {
        match runs.last_mut() {
            // An arc of a program has many points on its line.
            Some([_, last]) if *last == line || *last + 1 == line => *last = line,
            _ => runs.push([line, line]),
        }
    }
    let word = if matches!(runs[..], [[first, last]] if first == last) { "line" } else { "lines" };
    let run = |[first, last]: &[usize; 2]| match last - first {
        0 => format!("{first}"),
        _ => format!("{first} to {last}"),
    };
    format!("{word} {}", runs.iter().map(run).collect::<Vec<_>>().join(", "))
}

impl ToolPath {
    /// Whether it gives joint coordinates, and no poses.
    pub fn gives_joints(&self) -> bool {
        self.points.iter().all(|point| matches!(point.goal, Goal::Joints(_)))
    }

    /// A path of motions that are in joint coordinates already, with the text of their file (empty to
    /// show no lines); `tool` is the axis of the tool in the TCP's frame. Its feeds are those of the cut.
    pub(crate) fn of_motions(file: &str, text: String, points: Vec<Waypoint>, tool: Unit<Vector3<f64>>) -> Self {
        let file = file.to_owned();
        Self { file, points, warnings: Vec::new(), is_program: true, tool, lines: Lines::new(text) }
    }

    /// Whether it gives the direction of the tool's axis anywhere, and leaves the turn about it free.
    pub fn gives_axes(&self) -> bool {
        let is_axis = |orientation: &Orientation| matches!(orientation, Orientation::Axis { .. });
        self.points.iter().any(|point| matches!(&point.goal, Goal::Tool(target) if is_axis(&target.orientation)))
    }

    /// The same path when the frame that its poses are given in stands at
    /// `place` (homogeneous, 4 x 4, m) in the base frame. Joint coordinates stay.
    #[must_use]
    pub fn placed(mut self, place: &Matrix4<f64>) -> Self {
        for point in &mut self.points {
            if let Goal::Tool(target) = &mut point.goal {
                *target = target.placed(place);
            }
        }
        self
    }
}
