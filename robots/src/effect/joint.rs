//! The words of a description for a table's convention and a joint's kind.

use crate::dimension::Dimension;

/// Which of the two Denavit-Hartenberg conventions a table is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convention {
    /// `T_i = Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i)`; joint `i` acts on the
    /// z axis of frame `i - 1`.
    Standard,
    /// `T_i = Rx(alpha_i) Tx(a_i) Rz(theta_i) Tz(d_i)` with the row's own
    /// alpha and a (those of the link before it); joint `i` acts on the z axis
    /// of frame `i`.
    Modified,
}

impl Convention {
    /// The convention as descriptions spell it.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::Modified => "modified",
        }
    }
}

/// What a joint does along its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Turns: the joint coordinate (rad) adds to theta.
    Revolute,
    /// Slides: the joint coordinate (m) adds to d.
    Prismatic,
}

impl JointKind {
    /// The dimension of the compliance of such a joint.
    pub const fn compliance(self) -> Dimension {
        match self {
            Self::Revolute => Dimension::Compliance,
            Self::Prismatic => Dimension::LinearCompliance,
        }
    }
}
