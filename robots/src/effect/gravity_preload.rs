//! `gravity_preload`: the gears carry the arm's own weight when the load comes.
//!
//! The law of a joint acts on all that its gear carries: under a torque `tau` of
//! the load it turns by `phi(tau0 + tau) - phi(tau0)`, where `tau0 = share g_i(q)`
//! is what the weights behind it put on it already
//! ([`gravity_sag`](super::gravity_sag) has `g_i`). `share` is what a gravity
//! compensator or counterweight leaves of it. What is in proportion to the torque,
//! a joint's own compliance and its change with the angle, is as without.

use super::Dimension;
use super::Scalar;
use super::physics::*;

/// What the laws of joints are preloaded by.
pub struct GravityPreload;

impl Physics<1> for GravityPreload {
    const ABOUT: About = About {
        kind: "gravity_preload",
        at: At::Robot,
        kinematic: false,
        noun: "the preload of the gears by the weight of the arm",
        explanation: "The links weigh on the gears before any load does, which takes up backlash on one side and \
            keeps gears that harden on their stiff side. Loads that unload a gear beyond its preload show what is \
            hidden under the others.",
        typical: "1 without a gravity compensator",
        parameters: &[super::physics::Parameter {
            name: "share",
            symbol: "PRELOAD_SHARE",
            what: "Share of the weight that the gears carry",
            quantity: Quantity::Of(Dimension::Number),
            range: Range::NotNegative,
            default: None,
            example: "1",
        }],
    };

    fn share_of_preload<S: Scalar>([share]: [S; 1]) -> Option<S> {
        Some(share)
    }
}
