//! `lost_motion`: backlash, the steep part about zero torque.
//!
//! The joint turns by `gap / 2` to the side of its torque. The step is smoothed
//! as `gap/2 * tau / sqrt(tau^2 + knee^2)`: odd, without memory, 71 % done at
//! the knee and 99.5 % at ten times of it, where the elastic part alone goes on.
//! About zero torque it adds `gap / (2 knee)` to the joint's compliance.
//!
//! That is a [`stiffness_nonlinearity`](super::stiffness_nonlinearity) with
//! `added = gap / (2 knee)` and so small a knee that only the step is seen.

#[cfg(feature = "read")]
use super::Place;
use super::physics::*;
use super::{Dimension, Scalar};

/// Backlash of a joint.
pub struct LostMotion;

impl Physics<2> for LostMotion {
    const ABOUT: About = About {
        kind: "lost_motion",
        at: At::TurningJoint,
        kinematic: false,
        noun: "the backlash of {}",
        explanation: "Between the flanks of the gear there is play, which the joint crosses when its torque changes \
            sign. Adjusting or preloading the gear takes it out; loads that keep the sign, as gravity often does, \
            hide it.",
        typical: "up to 1 arcmin below 3 % of the rated torque on cycloid (RV) gears, by their makers' catalogues",
        parameters: &[
            Parameter {
                name: "gap",
                symbol: "GAP",
                what: "Total play",
                quantity: Quantity::Of(Dimension::Angle),
                range: Range::NotNegative,
                default: None,
                example: "0.5 arcmin",
            },
            Parameter {
                name: "knee",
                symbol: "GAP_KNEE",
                what: "Torque that takes up most of the play",
                quantity: Quantity::Of(Dimension::Torque),
                range: Range::Positive,
                default: None,
                example: "30 Nm",
            },
        ],
    };

    fn turn<S: Scalar>([gap, knee]: [S; 2], joint: &Joint<S>) -> Option<S> {
        let knees = joint.torque * knee.recip();
        Some(gap.times(0.5) * knees * (knees * knees).plus(1.0).sqrt().recip())
    }

    #[cfg(feature = "read")]
    fn check([_, knee]: [f64; 2], _: Place, _: f64) -> Option<Complaint> {
        tiny_knee(knee)
    }
}
