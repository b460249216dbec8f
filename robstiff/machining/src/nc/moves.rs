//! Moves of a tool, and how they are read.

use nalgebra::{Unit, Vector3};

use super::machine::Machine;

/// One straight move of the tool, in the frame of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// The line of the program (from 1).
    pub line: usize,
    /// Where the tip of the tool gets to (m).
    pub point: Vector3<f64>,
    /// From the tip to the spindle.
    pub axis: Unit<Vector3<f64>>,
    /// Whether it is a rapid, in which nothing is cut.
    pub rapid: bool,
    /// How fast the tip moves (m/s); none of a rapid, and where the tip stays in place.
    pub feed: Option<f64>,
    /// How long it takes (s); none of a rapid, and of the first move.
    pub duration: Option<f64>,
    /// The speed of the spindle (rad/s), clockwise seen from the spindle; 0 where it stands.
    pub spindle: f64,
    /// The number of the tool, once one is changed to.
    pub tool: Option<u32>,
}

/// The number of a tool: a whole one, as it is written.
pub(super) fn tool_number(written: f64) -> Option<u32> {
    (written >= 0.0 && written.fract() == 0.0 && written <= f64::from(u32::MAX)).then_some(written as u32)
}

/// Work offsets: G53, G54 to G59, G59.1 to G59.3.
pub const OFFSETS: [&str; 10] = ["G53", "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"];

/// How a program is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// How far chords are off the arcs that they stand for, at most (m).
    pub arc_tolerance: f64,
    /// The machine's rotary axes, where the program turns any.
    pub machine: Option<Machine>,
    /// Whether coordinates are those of the tip on the workpiece whatever the rotary axes do
    /// (TCP, RTCP); `None`: as the program's codes say (G43.4, G43.5, M128, M428), off at first.
    pub tcp: Option<bool>,
    /// Where the zeros of [`OFFSETS`] are in the frame of the path (m). G53 is followed only where
    /// its zero is known; the others are at the frame's origin where they are not given.
    pub offsets: [Option<Vector3<f64>>; OFFSETS.len()],
}

impl Default for Options {
    /// Chords within 0.01 mm, no rotary axes.
    fn default() -> Self {
        Self { arc_tolerance: 1e-5, machine: None, tcp: None, offsets: [None; OFFSETS.len()] }
    }
}
