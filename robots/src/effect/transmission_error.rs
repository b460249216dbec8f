//! `transmission_error`: the joint's angle errs periodically.
//!
//! The joint stands at `q + sin * sin(order q) + cos * cos(order q)` when it
//! says `q`: `order` 1 is an eccentric encoder, the number of teeth a gear's.
//!
//! The error is between the motor's side, where `q` is told, and the output;
//! what a load turns is the output. So frames stand at the corrected angle, and
//! the Jacobian's column is that of a turn of the output: with it a torque is in
//! equilibrium and the compliance symmetric. Per unit of the *told* angle the
//! tool centre point moves by that column times the derivative of the angle.

use super::physics::*;
use super::{Dimension, Scalar};
#[cfg(feature = "read")]
use {super::Place, crate::words::above, std::format};

/// An error of a joint's angle, periodic in the angle.
pub struct TransmissionError;

const fn amplitude(name: &'static str, symbol: &'static str, what: &'static str) -> Parameter {
    Parameter {
        name,
        symbol,
        what,
        quantity: Quantity::Of(Dimension::Angle),
        range: Range::Any,
        default: Some(0.0),
        example: "20 urad",
    }
}

impl Physics<3> for TransmissionError {
    const ABOUT: About = About {
        kind: "transmission_error",
        at: At::TurningJoint,
        kinematic: true,
        noun: "the periodic angle error of {}",
        explanation: "An encoder or a gear wheel is not quite centred, so the joint runs ahead and behind as it turns. \
            A map of the error in the controller, or an encoder on the output side, takes it out.",
        typical: "",
        parameters: &[
            Parameter {
                name: "order",
                symbol: "ORDER",
                what: "Periods of the angle error in a turn",
                quantity: Quantity::Of(Dimension::Number),
                range: Range::Whole(1000),
                default: None,
                example: "1",
            },
            amplitude("sin", "SIN_ERROR", "Sine amplitude of the angle error"),
            amplitude("cos", "COS_ERROR", "Cosine amplitude of the angle error"),
        ],
    };

    fn deviation<S: Scalar>(
        [order, ..]: [f64; 3],
        [_, sin, cos]: [S; 3],
        harmonic: &dyn Fn(f64) -> (S, S),
    ) -> Option<S> {
        let (s, c) = harmonic(order);
        Some(sin * s + cos * c)
    }

    #[cfg(feature = "read")]
    fn check([_, sin, cos]: [f64; 3], _: Place, _: f64) -> Option<Complaint> {
        (sin.hypot(cos) > MOST_DEVIATION).then(|| Complaint {
            parameter: if sin.abs() > cos.abs() { "sin" } else { "cos" },
            otherwise: None,
            message: {
                let most = MOST_DEVIATION * 1e3;
                format!("an angle error of {} mrad is more than {most} mrad", above(sin.hypot(cos) * 1e3, most))
            },
            help: format!("the amplitude is at most {} mrad, 17 arcmin", MOST_DEVIATION * 1e3),
        })
    }
}
