//! `pose_dependent_compliance`: a joint's compliance varies with its angle.
//!
//! `h_i(q) = h_i (1 + cos1 cos q + sin1 sin q + cos2 cos 2q + sin2 sin 2q)`,
//! which must be positive at every angle. It scales the joint's own compliance
//! alone: couplings and what a nonlinearity adds stay as they are.

use super::physics::*;
use super::{Dimension, Scalar};
#[cfg(feature = "read")]
use {super::Place, std::borrow::ToOwned, std::format};

/// A compliance that is periodic in the joint's angle.
pub struct PoseDependentCompliance;

const fn relative(name: &'static str, symbol: &'static str, what: &'static str) -> Parameter {
    Parameter {
        name,
        symbol,
        what,
        quantity: Quantity::Of(Dimension::Number),
        range: Range::Any,
        default: Some(0.0),
        example: "0.15",
    }
}

impl Physics<4> for PoseDependentCompliance {
    const ABOUT: About = About {
        kind: "pose_dependent_compliance",
        at: At::TurningJoint,
        kinematic: false,
        noun: "the compliance of {} that varies with its angle",
        explanation: "The teeth of a gear share the load differently as it turns, and a gravity compensator pulls at \
            another angle. The model takes it into account; loads at many angles of the joint show it.",
        typical: "",
        parameters: &[
            relative("cos1", "COS1_", "Relative change of the compliance with cos q"),
            relative("sin1", "SIN1_", "Relative change of the compliance with sin q"),
            relative("cos2", "COS2_", "Relative change of the compliance with cos 2q"),
            relative("sin2", "SIN2_", "Relative change of the compliance with sin 2q"),
        ],
    };

    const LINEAR: bool = true;

    fn turn<S: Scalar>([cos1, sin1, cos2, sin2]: [S; 4], joint: &Joint<S>) -> Option<S> {
        let (s, c) = (joint.harmonic)(1.0);
        // sin 2q = 2 s c and cos 2q = c^2 - s^2.
        let change = cos1 * c + sin1 * s + cos2 * ((c - s) * (c + s)) + sin2 * (s * c).times(2.0);
        Some(joint.compliance * change * joint.torque)
    }

    #[cfg(feature = "read")]
    fn check(numbers: [f64; 4], place: Place, _: f64) -> Option<Complaint> {
        let (least, at) = least_change(numbers);
        (least <= -1.0).then(|| Complaint {
            parameter: largest(numbers),
            otherwise: None,
            message: format!("at q = {:.0} deg, {place} would have no compliance left", at.to_degrees()),
            help: "the amplitudes are parts of the joint's compliance, which must stay positive".to_owned(),
        })
    }

    #[cfg(feature = "read")]
    fn least(numbers: [f64; 4], compliance: f64) -> f64 {
        compliance * least_change(numbers).0.min(0.0)
    }
}

/// The least relative change over all angles, and the angle (rad).
#[cfg(feature = "read")]
fn least_change([cos1, sin1, cos2, sin2]: [f64; 4]) -> (f64, f64) {
    let change = |q: f64| cos1 * q.cos() + sin1 * q.sin() + cos2 * (2.0 * q).cos() + sin2 * (2.0 * q).sin();
    let slope = |q: f64| sin1 * q.cos() - cos1 * q.sin() + 2.0 * (sin2 * (2.0 * q).cos() - cos2 * (2.0 * q).sin());
    // Between two stops a degree apart the slope changes its sign once at most
    // where it matters: there the least is found by bisection.
    let step = 1_f64.to_radians();
    let stops = (0..360).map(|k| f64::from(k) * step);
    let refined = stops.map(|from| {
        let (mut low, mut high) = (from, from + step);
        if slope(low) < 0.0 && slope(high) > 0.0 {
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if slope(middle) < 0.0 { low = middle } else { high = middle }
            }
        }
        (change(low), low)
    });
    refined.min_by(|one, other| one.0.total_cmp(&other.0)).expect("a turn has stops")
}

/// The parameter with the largest amplitude.
#[cfg(feature = "read")]
fn largest(numbers: [f64; 4]) -> &'static str {
    let by_size = PoseDependentCompliance::ABOUT.parameters.iter().zip(numbers);
    by_size.max_by(|one, other| one.1.abs().total_cmp(&other.1.abs())).expect("four parameters").0.name
}
