//! Descriptions from URDF files (Unified Robot Description Format, ROS).
//!
//! [`Tree`] is what the file says, [`Tree::chain`] the serial chain between two
//! of its links, and [`Chain::description`] that chain as a standard
//! Denavit-Hartenberg table with base and tool. [`Tree::export`] is the way back: the file with
//! the kinematics of a description.

mod chain;
mod export;
#[cfg(test)]
mod export_tests;
mod motion;
mod placing;
mod read;
mod spelling;
mod table;
#[cfg(test)]
mod tests;

use std::string::String;
use std::vec::Vec;

use nalgebra::{Isometry3, Unit, Vector3};

use crate::JointKind;
use crate::text::Lines;
pub use chain::Chain;
pub use export::{Export, Moved, is_said_by_origins};

/// The links and joints of a URDF file.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The robot's name.
    pub name: String,
    /// Its links, in the order of the file.
    pub links: Vec<Body>,
    /// Its joints, in the order of the file.
    pub joints: Vec<Connection>,
    /// What the reader noticed without refusing the file.
    pub warnings: Vec<String>,
    file: String,
    lines: Lines<String>,
    /// Whether the file begins with a byte order mark, which is no part of the lines.
    is_marked: bool,
    hangs: Hangs,
}

/// How the links hang on each other.
#[derive(Clone, Debug, Default)]
struct Hangs {
    /// The joint that carries each link, the first where several do, by its index.
    on: Vec<Option<usize>>,
    /// The joints on each link, by their indices.
    carries: Vec<Vec<usize>>,
}

/// A link.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Mass (kg) and centre of mass in the link's frame (m), where the file has
    /// them.
    pub inertia: Option<(f64, Vector3<f64>)>,
    /// Where it is in the file (bytes).
    place: core::ops::Range<usize>,
}

/// A joint between two links.
#[derive(Clone, Debug, PartialEq)]
pub struct Connection {
    /// Its name.
    pub name: String,
    /// How it moves; `None` for a fixed one.
    pub motion: Option<Motion>,
    /// The link that it is on, by its index.
    pub parent: usize,
    /// The link that it carries, by its index.
    pub child: usize,
    /// Its frame in the parent link's frame, at coordinate 0.
    pub origin: Isometry3<f64>,
    /// Where it is in the file (bytes).
    place: core::ops::Range<usize>,
}

/// How a joint moves.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// One coordinate about or along an axis.
    Axis {
        /// Turning or sliding.
        kind: JointKind,
        /// The axis in the joint's frame.
        axis: Unit<Vector3<f64>>,
        /// Lower and upper limit (rad or m), where there are any.
        limits: Option<[f64; 2]>,
        /// Whether the coordinate follows another joint's.
        mimics: bool,
    },
    /// Something that no chain of revolute and prismatic joints can do.
    Other(String),
}
