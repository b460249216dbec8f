//! `tool_compliance`: what is mounted on the flange yields.
//!
//! A compliance at the origin of the flange frame, the same about and along
//! every axis.

use super::physics::*;
use super::{Dimension, Place};

/// Flange, spindle and tool.
pub struct ToolCompliance;

impl Physics<2> for ToolCompliance {
    const ABOUT: About = About {
        kind: "tool_compliance",
        at: At::Tool,
        kinematic: false,
        noun: "the compliance of flange, spindle and tool",
        explanation: "The mount, the spindle and the tool yield in every pose alike. A stiffer adapter, a shorter \
            tool; loads at two lever lengths tell it from the wrist.",
        typical: "about 1e-8 m/N and 3e-7 rad/Nm with a milling spindle",
        parameters: &[
            Parameter {
                name: "rotation",
                symbol: "TOOL_ROTATION",
                what: "Rotation compliance",
                quantity: Quantity::Of(Dimension::Compliance),
                range: Range::NotNegative,
                default: Some(0.0),
                example: "3e-7 rad/Nm",
            },
            Parameter {
                name: "translation",
                symbol: "TOOL_TRANSLATION",
                what: "Translation compliance",
                quantity: Quantity::Of(Dimension::LinearCompliance),
                range: Range::NotNegative,
                default: Some(0.0),
                example: "1e-8 m/N",
            },
        ],
    };

    fn springs(_: Place) -> [Option<Spring>; 2] {
        [Some(Spring::ToolRotation), Some(Spring::ToolTranslation)]
    }
}
