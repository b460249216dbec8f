//! `gravity_sag`: the arm hangs below where its encoders say.
//!
//! Every joint stands at `q_i + share h_i g_i(q)` when it says `q_i`: `g_i` is
//! the torque of the weights behind it, with every joint where it would stand
//! without sag; `share` is how much of it the controller does not correct.
//! Gravity points against z of the base (world) frame.

use super::joint::JointKind;
use super::physics::*;
use super::{Dimension, Scalar};

/// Standard gravity (m/s^2).
pub const GRAVITY: f64 = 9.80665;

/// The yielding of all joints to the arm's own weight.
pub struct GravitySag;

impl Physics<1> for GravitySag {
    const ABOUT: About = About {
        kind: "gravity_sag",
        at: At::Robot,
        kinematic: true,
        noun: "the sag of the robot under its own weight",
        explanation: "The links weigh on the joints, so the arm hangs below where its encoders say. A controller that \
            knows the masses corrects it; measurements from the encoders alone cannot show it.",
        typical: "1 for a controller that corrects nothing",
        parameters: &[super::physics::Parameter {
            name: "share",
            symbol: "SAG_SHARE",
            what: "Uncorrected share of the sag",
            quantity: Quantity::Of(Dimension::Number),
            range: Range::NotNegative,
            default: None,
            example: "1",
        }],
    };

    fn share_of_weight<S: Scalar>([share]: [S; 1]) -> Option<S> {
        Some(share)
    }
}

/// The torque about a joint's axis (Nm), or the force along it (N), of a
/// weight (N) whose first moment about the origin of the base frame (Nm) is
/// `moment` in x and y; the axis goes `through` a point (m). All in the base
/// frame: `axis . sum((c_k - through) x (0, 0, -w_k))`.
pub fn torque<S: Scalar>(kind: JointKind, axis: [S; 3], through: [S; 3], weight: S, moment: [S; 2]) -> S {
    let arm = |k: usize| moment[k] - weight * through[k];
    match kind {
        JointKind::Revolute => axis[1] * arm(0) - axis[0] * arm(1),
        JointKind::Prismatic => -(weight * axis[2]),
    }
}
