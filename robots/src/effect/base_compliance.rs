//! `base_compliance`: the foundation yields.
//!
//! A compliance at the origin of frame 0. Its turn about z is that of a first
//! joint on the same axis and is left to it. A first joint that slides, or whose
//! axis stands askew to z of frame 0 (modified DH with an `alpha`), does not take
//! it up: a base that turns under such a joint is not in the catalogue.

use super::physics::*;
use super::{Dimension, Place};

/// Foundation and pedestal.
pub struct BaseCompliance;

impl Physics<2> for BaseCompliance {
    const ABOUT: About = About {
        kind: "base_compliance",
        at: At::Base,
        kinematic: false,
        noun: "the compliance of foundation and pedestal",
        explanation: "The floor, the anchors or the pedestal give way under the whole robot. More or tighter anchors, \
            grout, a shorter pedestal; a dial gauge at the foot shows it apart from joint 1.",
        typical: "a tilt of about 2e-8 rad/Nm",
        parameters: &[
            Parameter {
                name: "tilt",
                symbol: "BASE_TILT",
                what: "Tilt compliance",
                quantity: Quantity::Of(Dimension::Compliance),
                range: Range::NotNegative,
                default: Some(0.0),
                example: "2e-8 rad/Nm",
            },
            Parameter {
                name: "translation",
                symbol: "BASE_TRANSLATION",
                what: "Translation compliance",
                quantity: Quantity::Of(Dimension::LinearCompliance),
                range: Range::NotNegative,
                default: Some(0.0),
                example: "3e-9 m/N",
            },
        ],
    };

    fn springs(_: Place) -> [Option<Spring>; 2] {
        [Some(Spring::BaseTilt), Some(Spring::BaseTranslation)]
    }
}
