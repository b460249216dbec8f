//! `transverse_compliance`: the bearing and the housing of a joint tilt.
//!
//! `h [s(x) s(x)^T + s(y) s(y)^T]` with the twists of turns about the x and y
//! axes of the joint frame ("virtual joints": Abele, Rothenbuecher, Weigold,
//! Production Engineering 2 (2008)).

use super::physics::*;
use super::{Dimension, Place};

/// Tilt of a joint about the x and y axes of its joint frame.
pub struct TransverseCompliance;

impl Physics<1> for TransverseCompliance {
    const ABOUT: About = About {
        kind: "transverse_compliance",
        at: At::Joint,
        kinematic: false,
        noun: "the tilt of {} about the axes across its own (bearing, housing)",
        explanation: "The bearing of the joint and the housing around it tilt under moments across the axis. A \
            larger or preloaded cross-roller bearing and a stiffer housing help; in a program, forces along the axis \
            or with a short lever do.",
        typical: "0.6e-7 to 8e-7 rad/Nm on arms for 130 to 270 kg, two to ten times more with the housing",
        parameters: &[Parameter {
            name: "value",
            symbol: "TRANSVERSE",
            what: "Transverse compliance",
            quantity: Quantity::Of(Dimension::Compliance),
            range: Range::NotNegative,
            default: None,
            example: "6.35e-7 rad/Nm",
        }],
    };

    fn springs(place: Place) -> [Option<Spring>; 1] {
        let Place::Joint(joint) = place else { return [None] };
        [Some(Spring::Transverse(joint))]
    }
}
