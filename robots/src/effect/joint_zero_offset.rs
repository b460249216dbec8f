//! `joint_zero_offset`: the encoder's zero is off.
//!
//! The joint stands at `q + value` when it says `q`: the value adds to the
//! row's theta.

use super::physics::*;
use super::{Dimension, Place};

/// An offset of a joint's angle.
pub struct JointZeroOffset;

impl Physics<1> for JointZeroOffset {
    const ABOUT: About = About {
        kind: "joint_zero_offset",
        at: At::TurningJoint,
        kinematic: true,
        noun: "the zero offset of {}",
        explanation: "The encoder reads zero where the joint is not at zero, after a change of motor or a crash. \
            Mastering the joint anew, or the corrected description, takes it out.",
        typical: "",
        parameters: &[Parameter {
            name: "value",
            symbol: "ZERO_OFFSET",
            what: "Zero offset",
            quantity: Quantity::Of(Dimension::Angle),
            range: Range::Any,
            default: None,
            example: "0.02 deg",
        }],
    };

    fn correct([value]: [f64; 1], _: Place, row: &mut Row) {
        row.theta += value;
    }
}
