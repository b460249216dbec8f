//! `link_compliance`: a link bends and twists.
//!
//! A uniform, round beam from joint to joint: `L / EI` for its bending and
//! `L / GJ` for its torsion give its whole 6 x 6 compliance (Euler-Bernoulli,
//! Saint-Venant; stretching is a hundred times stiffer and left out).

use super::physics::*;
use super::{Dimension, Place};

/// A uniform, round beam from one joint to the next.
pub struct LinkCompliance;

impl Physics<2> for LinkCompliance {
    const ABOUT: About = About {
        kind: "link_compliance",
        at: At::Link,
        kinematic: false,
        noun: "the bending and torsion of {}",
        explanation: "The body between two joints is a beam that bends and twists. Nothing short of another arm \
            stiffens it; the model takes it into account, and poses that load it along itself avoid it.",
        typical: "L/EI about 7e-8 and L/GJ about 1.2e-7 rad/Nm for a cast arm of 1.15 m",
        parameters: &[
            Parameter {
                name: "bending",
                symbol: "BENDING",
                what: "Bending compliance L / EI",
                quantity: Quantity::Of(Dimension::Compliance),
                range: Range::NotNegative,
                default: Some(0.0),
                example: "7e-8 rad/Nm",
            },
            Parameter {
                name: "torsion",
                symbol: "TORSION",
                what: "Torsion compliance L / GJ",
                quantity: Quantity::Of(Dimension::Compliance),
                range: Range::NotNegative,
                default: Some(0.0),
                example: "1.2e-7 rad/Nm",
            },
        ],
    };

    fn springs(place: Place) -> [Option<Spring>; 2] {
        let Place::Link(link) = place else { return [None; 2] };
        [Some(Spring::LinkBending(link)), Some(Spring::LinkTorsion(link))]
    }

    fn noun([bending, torsion]: [f64; 2]) -> &'static str {
        match (bending != 0.0, torsion != 0.0) {
            (true, false) => "the bending of {}",
            (false, true) => "the torsion of {}",
            _ => Self::ABOUT.noun,
        }
    }
}
