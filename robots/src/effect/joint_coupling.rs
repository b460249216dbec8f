//! `joint_coupling`: the torque of one joint turns another.
//!
//! An off-diagonal entry of the joints' compliance, `H_q[i, j] = H_q[j, i]`;
//! together with the others it must leave `H_q` positive definite, so
//! `|value| < sqrt(h_i h_j)`, where `h` is what the effects leave of a joint's
//! compliance at the worst angle and torque.

use super::physics::*;
use super::{Dimension, Place};

/// An off-diagonal entry of the joint compliance.
pub struct JointCoupling;

impl Physics<1> for JointCoupling {
    const ABOUT: About = About {
        kind: "joint_coupling",
        at: At::TurningJoints,
        kinematic: false,
        noun: "the coupling of {} (belts, wrist gearing)",
        explanation: "The two joints share a belt, a rod or shafts that run in one another, so that the torque of one \
            turns the other. It belongs to the design; the model takes it into account.",
        typical: "below sqrt(h_i h_j), either sign",
        parameters: &[Parameter {
            name: "value",
            symbol: "COUPLING",
            what: "Coupling compliance",
            quantity: Quantity::Of(Dimension::Compliance),
            range: Range::Any,
            default: None,
            example: "6.35e-7 rad/Nm",
        }],
    };

    fn springs(place: Place) -> [Option<Spring>; 1] {
        let Place::Joints(joints) = place else { return [None] };
        [Some(Spring::Coupling(joints))]
    }
}
