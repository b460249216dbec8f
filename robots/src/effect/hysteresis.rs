//! `hysteresis`: the deflection depends on the order of the loads.
//!
//! Beyond `h tau` the joint turns by `sum_j weight_j P_j`, with the play
//! operators of a Prandtl-Ishlinskii model,
//!
//! `P_j(k) = max(tau - radius_j, min(tau + radius_j, P_j(k - 1)))`,
//!
//! up to three of them, each with its radius and weight. `P_j` is the state that
//! a caller carries from load to load; it begins with zero, the virgin state, in
//! which nothing is added until the torque exceeds a radius: the joint looks
//! softer under large torques, and on the way back it first stays behind. A
//! closed cycle of torques gives a closed loop (return-point memory), whose
//! branches are the virgin curve at twice the scale (Masing). Sliding between
//! parts takes work only if no weight is negative.

use super::physics::*;
use super::{Dimension, Scalar};
#[cfg(feature = "read")]
use {super::Place, std::borrow::ToOwned, std::format};

/// Play operators between torque and turn of a joint.
pub struct Hysteresis;

/// The first one there must be; another that is left out is 0.
const fn radius(name: &'static str, symbol: &'static str, what: &'static str, default: Option<f64>) -> Parameter {
    Parameter {
        name,
        symbol,
        what,
        quantity: Quantity::Of(Dimension::Torque),
        range: if default.is_some() { Range::NotNegative } else { Range::Positive },
        default,
        example: "50 Nm",
    }
}

const fn weight(name: &'static str, symbol: &'static str, what: &'static str, default: Option<f64>) -> Parameter {
    Parameter {
        name,
        symbol,
        what,
        quantity: Quantity::Of(Dimension::Compliance),
        range: Range::NotNegative,
        default,
        example: "5e-8 rad/Nm",
    }
}

impl Physics<6> for Hysteresis {
    const ABOUT: About = About {
        kind: "hysteresis",
        at: At::TurningJoint,
        kinematic: false,
        noun: "the hysteresis of {}",
        explanation: "Parts that rub on each other stay behind when the load returns, so the deflection depends on the \
            loads before. Lubrication and less preload make it smaller; unloading the same way each time makes it \
            repeat.",
        typical: "loops as wide as 5 to 20 % of the stroke",
        parameters: &[
            radius("radius1", "RADIUS1_", "Torque that moves play operator 1", None),
            weight("weight1", "WEIGHT1_", "Compliance of play operator 1", None),
            radius("radius2", "RADIUS2_", "Torque that moves play operator 2", Some(0.0)),
            weight("weight2", "WEIGHT2_", "Compliance of play operator 2", Some(0.0)),
            radius("radius3", "RADIUS3_", "Torque that moves play operator 3", Some(0.0)),
            weight("weight3", "WEIGHT3_", "Compliance of play operator 3", Some(0.0)),
        ],
    };

    const LINEAR: bool = true;

    fn turn<S: Scalar>([_, first, _, second, _, third]: [S; 6], joint: &Joint<S>) -> Option<S> {
        let [a, b, c] = joint.plays;
        Some(first * a + second * b + third * c)
    }

    fn plays_in_use([_, first, _, second, _, third]: [f64; 6]) -> usize {
        [first, second, third].iter().rposition(|&weight| weight != 0.0).map_or(0, |last| last + 1)
    }

    fn plays<S: Scalar>([r1, _, r2, _, r3, _]: [S; 6], torque: S, [a, b, c]: [S; PLAYS]) -> [S; PLAYS] {
        // The torque last: floats take the second of two where one is not a number, and what
        // is not a number would stay unseen on a rigid joint.
        let play = |radius: S, before: S| before.min(torque + radius).max(torque - radius);
        [play(r1, a), play(r2, b), play(r3, c)]
    }

    #[cfg(feature = "read")]
    fn check(numbers: [f64; 6], _: Place, _: f64) -> Option<Complaint> {
        let mut before = 0.0;
        for (pair, names) in numbers.chunks(2).zip(Self::ABOUT.parameters.chunks(2)) {
            let ([radius, weight], [name, of]) = (pair, names) else { continue };
            if *weight == 0.0 && *radius == 0.0 && before > 0.0 {
                continue;
            }
            if *radius <= before {
                let than = if before == 0.0 { "0" } else { "the radius before it" };
                return Some(Complaint {
                    parameter: name.name,
                    otherwise: Some(of.name),
                    message: format!("`{}` is not above {than}", name.name),
                    help: "give the radii from the smallest to the largest, above 0 Nm".to_owned(),
                });
            }
            before = *radius;
        }
        None
    }
}
