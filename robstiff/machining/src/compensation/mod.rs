//! The path that makes up for the deviation: commanded poses from which the load
//! pushes the tool to where it is wanted.
//!
//! Each point is corrected until the tool under load is where the path wants it:
//! the commanded pose is moved by what is missing, the arm takes its posture there,
//! yields there to the force of the path, and so on. Every round leaves
//! about as large a part as the commanded pose moves relative to the arm's reach:
//! two or three rounds are usual. In the end the tool must stay there although its
//! force follows a displacement.
//!
//! What the correction is worth on an arm that is not as described tells
//! [`sensitivity()`].

mod sensitivity;
#[cfg(test)]
mod tests;

use nalgebra::{Matrix4, Rotation3, SVector, Unit, Vector3, Vector6};
use robstiff_robots::Diagnostics;

use crate::deviation::{Contact, Load, Yielding, settle, turned};
use crate::inverse::{Inverse, Orientation, Remaining, Target, Unreached};
use crate::path::follow::MOST_SHOWN;
use crate::path::{PathPoint, SolvedPath, ToolPath, lines};
use robstiff::{Robot, State};

pub use sensitivity::{LeftIfWrong, Sensitivity, left, sensitivity};

/// The tool under load is where it is wanted within this (m, rad).
pub const TOLERANCE: f64 = 1e-9;

/// Rounds until a point must have converged.
pub const MOST_ROUNDS: usize = 50;

/// What the correction keeps of a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Keep {
    /// All of it: six axes or more.
    Pose,
    /// The position and the direction of an axis of the TCP's frame; the turn about
    /// it is free: five axes.
    Axis(Unit<Vector3<f64>>),
    /// The position alone: fewer than five axes.
    Position,
    /// All of it where the arm can, else the position and the direction of the axis: six axes or more
    /// along a path that leaves the turn about the tool free.
    PoseOrAxis(Unit<Vector3<f64>>),
}

impl Keep {
    /// What an arm of `joints` axes can keep, its tool along `axis` of the TCP's frame.
    pub fn of(joints: usize, axis: Unit<Vector3<f64>>) -> Self {
        match joints {
            0..=4 => Self::Position,
            5 => Self::Axis(axis),
            _ => Self::Pose,
        }
    }

    /// The same along a path, which may leave the turn about the tool free.
    pub fn along(path: &ToolPath, joints: usize, axis: Unit<Vector3<f64>>) -> Self {
        match Self::of(joints, axis) {
            Self::Pose if path.gives_axes() => Self::PoseOrAxis(axis),
            keep => keep,
        }
    }

    /// What it keeps of a pose, of two the first.
    pub(crate) fn target(self, pose: &Matrix4<f64>) -> Target {
        let whole = Target::pose(pose);
        match (self, whole.orientation) {
            (Self::Axis(tool), Orientation::Full(rotation)) => Target::axis(whole.position, tool, rotation * tool),
            (Self::Position, _) => Target { orientation: Orientation::Free, ..whole },
            _ => whole,
        }
    }
}

/// A path corrected for its load.
#[derive(Clone, Debug, PartialEq)]
pub struct Compensated<const N: usize> {
    /// The points, as many as the path has and in its order.
    pub points: Vec<CompensatedPoint<N>>,
}

/// A point corrected for its load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompensatedPoint<const N: usize> {
    /// The line of the path's file, from 1.
    pub line: usize,
    /// Joint coordinates to command (rad or m).
    pub q: SVector<f64, N>,
    /// The pose of the TCP that they are without load, 4 x 4 in the base frame (m).
    pub pose: Matrix4<f64>,
    /// How far that is from the wanted position, in the base frame (m).
    pub correction: Vector3<f64>,
    /// The wrench on the tool where it then is, in the base frame (N, Nm).
    pub wrench: Vector6<f64>,
    /// How far the tool under load is from where it is wanted.
    pub remaining: Remaining,
    /// Rounds that it took.
    pub rounds: usize,
}

/// Why a point cannot be corrected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Uncorrectable {
    /// The arm cannot take the corrected pose.
    Unreached(Unreached),
    /// The correction does not come to rest.
    NotConverged {
        /// What the last round left.
        remaining: Remaining,
    },
    /// Arm and cut do not settle: the force grows faster than the arm resists.
    PulledIn,
}

impl core::fmt::Display for Uncorrectable {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Unreached(why) => write!(f, "the corrected pose cannot be taken: {why}"),
            Self::NotConverged { remaining } => write!(
                f,
                "the correction does not converge: after {MOST_ROUNDS} rounds {:.4} mm and {:.4} deg are left",
                remaining.distance * 1e3,
                remaining.angle.to_degrees()
            ),
            Self::PulledIn => f.write_str(
                "arm and cut do not settle: the force grows faster with the displacement than the arm resists",
            ),
        }
    }
}

/// A path with points that cannot be corrected.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncompensated {
    /// Every such point: its line and why, in the order of the path.
    pub points: Vec<(usize, Uncorrectable)>,
    /// How many points the path has.
    pub of: usize,
}

impl Uncompensated {
    /// The problems at their lines of the path's file, the first ten.
    pub fn diagnostics(&self, path: &ToolPath) -> Option<Diagnostics> {
        let problem = |(line, why): &(usize, Uncorrectable)| {
            let help = match why {
                Uncorrectable::Unreached(_) => "move the workpiece, or cut with less force",
                Uncorrectable::NotConverged { .. } => {
                    "keep away from postures where the arm is stretched out or its wrist straight"
                }
                Uncorrectable::PulledIn => "take a narrower or shallower cut",
            };
            path.diagnostic(*line, why.to_string(), help)
        };
        Diagnostics::new(self.points.iter().take(MOST_SHOWN).map(problem).collect())
    }

    /// How many points it is, and the lines of all of them.
    pub fn summary(&self) -> String {
        let lines = lines(self.points.iter().map(|(line, _)| *line));
        format!("{} of {} points cannot be corrected: {lines}", self.points.len(), self.of)
    }
}

impl core::fmt::Display for Uncompensated {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        for (line, why) in self.points.iter().take(MOST_SHOWN) {
            writeln!(f, "line {line}: {why}")?;
        }
        f.write_str(&self.summary())
    }
}

impl core::error::Error for Uncompensated {}

/// The joint coordinates to command so that the tool under load is on the path.
/// Joints with hysteresis follow the loads in the order of the path.
///
/// # Errors
/// The points that cannot be corrected, all of them.
///
/// # Panics
/// If the load has another number of points than the path.
pub fn compensate<const N: usize>(
    robot: &impl Robot<N>,
    path: &SolvedPath<N>,
    load: &Load,
    keep: Keep,
) -> Result<Compensated<N>, Uncompensated> {
    assert_eq!(load.contacts.len(), path.points.len(), "a contact for every point of the path");
    let inverse = Inverse::new(robot);
    let mut state = State::new();
    let (mut points, mut missed) = (Vec::with_capacity(path.points.len()), Vec::new());
    for (point, contact) in path.points.iter().zip(&load.contacts) {
        let corrected = correct(robot, &inverse, point, contact, keep, &mut state);
        let corrected = match (corrected, keep) {
            (Err(Uncorrectable::Unreached(_)), Keep::PoseOrAxis(axis)) => {
                correct(robot, &inverse, point, contact, Keep::Axis(axis), &mut state)
            }
            (corrected, _) => corrected,
        };
        match corrected {
            Ok(corrected) => points.push(corrected),
            Err(why) => missed.push((point.line, why)),
        }
    }
    if missed.is_empty() {
        Ok(Compensated { points })
    } else {
        Err(Uncompensated { points: missed, of: path.points.len() })
    }
}

fn correct<const N: usize, R: Robot<N>>(
    robot: &R,
    inverse: &Inverse<'_, R, N>,
    point: &PathPoint<N>,
    contact: &Contact,
    keep: Keep,
    state: &mut State<N>,
) -> Result<CompensatedPoint<N>, Uncorrectable> {
    let wanted = keep.target(&point.pose);
    let (mut commanded, mut q) = (wanted, point.q);
    let mut remaining = Remaining { distance: f64::NAN, angle: f64::NAN };
    for round in 0..=MOST_ROUNDS {
        let pose = robot.transform(&q);
        let arm = Yielding::of(robot, &q).as_described();
        let yields = |wrench: &Vector6<f64>| arm.deflection(wrench, &mut state.clone());
        // Where the tool is wanted it meets what the path says, and the force is that of the path: a force
        // that follows the displacement has no part in the way there.
        let mut actual = turned(&pose, &yields(&contact.wrench));
        remaining = wanted.remaining(&actual);
        if is_there(&remaining) {
            // Whether the tool then stays there, that part decides.
            let stand = settle(&pose, &point.pose, contact, yields).ok_or(Uncorrectable::PulledIn)?;
            actual = turned(&pose, &stand.deflection);
            remaining = wanted.remaining(&actual);
            if is_there(&remaining) {
                arm.deflection(&stand.wrench, state);
                let correction = (pose - point.pose).fixed_view::<3, 1>(0, 3).into_owned();
                let wrench = stand.wrench;
                return Ok(CompensatedPoint {
                    line: point.line,
                    q,
                    pose,
                    correction,
                    wrench,
                    remaining,
                    rounds: round,
                });
            }
        }
        commanded = moved(&commanded, wanted.apart(&actual));
        // What the arm misses by less than the tool may be off is not out of its reach.
        q = match inverse.nearest(&commanded, &q) {
            Ok(q) => q,
            Err(why) => inverse.near(&commanded, &q, TOLERANCE).ok_or(Uncorrectable::Unreached(why))?,
        };
    }
    Err(Uncorrectable::NotConverged { remaining })
}

fn is_there(remaining: &Remaining) -> bool {
    remaining.distance < TOLERANCE && remaining.angle < TOLERANCE
}

/// A target moved by a translation (m) and a rotation vector (rad) in the base frame.
fn moved(target: &Target, (shift, turn): (Vector3<f64>, Vector3<f64>)) -> Target {
    let turn = Rotation3::new(turn);
    let orientation = match target.orientation.turned(&turn) {
        Orientation::Axis { tool, direction } => {
            // Rounds must not make the direction longer or shorter.
            Orientation::Axis { tool, direction: Unit::new_normalize(direction.into_inner()) }
        }
        turned => turned,
    };
    Target { position: target.position + shift, orientation }
}

impl<const N: usize> Compensated<N> {
    /// The most rounds that a point took.
    pub fn rounds(&self) -> usize {
        self.points.iter().map(|point| point.rounds).max().unwrap_or(0)
    }
}
