//! `stiffness_nonlinearity`: a joint hardens or softens with torque.
//!
//! Beyond `h tau` the joint turns by `added tau / sqrt(1 + (tau / knee)^2)`: its
//! compliance falls from `h + added` without load to `h` far beyond the knee.
//! The smooth form of the two or three slopes that makers of harmonic drives
//! give.

use super::physics::*;
use super::{Dimension, Scalar};
#[cfg(feature = "read")]
use {super::Place, crate::words::significant, std::borrow::ToOwned, std::format};

const SOFTENS: &str = "Something between motor and arm gives way as the torque grows, a bolted joint that opens or a \
    bearing that loses its preload, so the joint is stiffer under small torques than under large ones. Small loads, \
    such as those of a test by hand, do not show it.";

/// Hardening (positive) or softening (negative) of a joint with torque.
pub struct StiffnessNonlinearity;

impl Physics<2> for StiffnessNonlinearity {
    const ABOUT: About = About {
        kind: "stiffness_nonlinearity",
        at: At::TurningJoint,
        kinematic: false,
        noun: "the hardening of {} with torque",
        explanation: "The teeth of the gear take hold one after the other, so the joint is softer under small torques \
            than under large ones. A preload, by gravity or a counterweight, keeps it on the stiff side.",
        typical: "slopes K1:K2:K3 of about 1:1.6:1.8 on harmonic drives, as their makers' catalogues give them",
        parameters: &[
            Parameter {
                name: "added",
                symbol: "ADDED",
                what: "Additional compliance without load",
                quantity: Quantity::Of(Dimension::Compliance),
                range: Range::Any,
                default: None,
                example: "6.35e-7 rad/Nm",
            },
            Parameter {
                name: "knee",
                symbol: "KNEE",
                what: "Torque at the knee",
                quantity: Quantity::Of(Dimension::Torque),
                range: Range::Positive,
                default: None,
                example: "500 Nm",
            },
        ],
    };

    fn turn<S: Scalar>([added, knee]: [S; 2], joint: &Joint<S>) -> Option<S> {
        let knees = joint.torque * knee.recip();
        Some(added * joint.torque * (knees * knees).plus(1.0).sqrt().recip())
    }

    fn noun([added, _]: [f64; 2]) -> &'static str {
        if added < 0.0 { "the softening of {} with torque" } else { Self::ABOUT.noun }
    }

    fn explanation([added, _]: [f64; 2]) -> &'static str {
        if added < 0.0 { SOFTENS } else { Self::ABOUT.explanation }
    }

    #[cfg(feature = "read")]
    fn check([added, knee]: [f64; 2], place: Place, compliance: f64) -> Option<Complaint> {
        let (message, help) = match compliance {
            _ if added > -compliance => return tiny_knee(knee),
            0.0 => (
                format!("{place} is rigid, and would have no compliance without load"),
                "give it a `compliance`, or `added` above 0".to_owned(),
            ),
            _ => (
                format!(
                    "without load, {place} would have no compliance left: {} - {} rad/Nm",
                    significant(compliance),
                    significant(-added)
                ),
                format!("`added` must be above {} rad/Nm", significant(-compliance)),
            ),
        };
        Some(Complaint { parameter: "added", otherwise: None, message, help })
    }

    #[cfg(feature = "read")]
    fn least([added, _]: [f64; 2], _: f64) -> f64 {
        added.min(0.0)
    }
}
