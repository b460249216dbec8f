//! A production cell in one file: which robot, where its spindle and the workpiece are, which tools.
//!
//! A [`Cell`] says once what a path needs each time: the tool centre point (TCP), which is the tip of
//! the tool in the spindle, the direction of the spindle, the place of the workpiece, the rotary axes
//! that a program was written for. Without a cell, [`axis_of`] says what a description alone tells of
//! the spindle's direction.
//!
//! A rail or a turntable is a joint of the robot: an arm whose first joint slides is an arm on a rail.
//! It belongs to the description, and no cell has one.

mod axis;
mod doubts;
mod mount;
mod parts;
mod read;
#[cfg(feature = "schema")]
pub mod schema;
#[cfg(test)]
mod tests;

pub use axis::axis_of;
pub use doubts::{TooFast, is_too_fast};
pub use parts::{Cell, Program, Spindle, Tool, Work};
