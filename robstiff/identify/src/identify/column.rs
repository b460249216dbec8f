//! Columns of the regression of a campaign.

use robstiff_robots::effect::physics::PLAYS;

use robstiff::Effect;
use robstiff::elements::{Spring, Torque, plays, turn};

/// A column of the regression: what a unit of one number adds to every
/// displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Column {
    /// The compliance of a spring.
    Spring(Spring),
    /// The `added` of a [`StiffnessNonlinearity`](robstiff::Effect) with a given
    /// knee.
    Knee {
        /// The joint, from 1.
        joint: usize,
        /// The torque at the knee (Nm).
        knee: f64,
    },
    /// The `gap` of a [`LostMotion`](robstiff::Effect) with a given knee.
    Gap {
        /// The joint, from 1.
        joint: usize,
        /// The torque at which most of the play is taken up (Nm).
        knee: f64,
    },
    /// A weight of a [`Hysteresis`](robstiff::Effect).
    Play {
        /// The joint, from 1.
        joint: usize,
        /// Which of its play operators.
        operator: usize,
        /// Its radius (Nm).
        radius: f64,
    },
}

impl Column {
    /// By how much a unit of a number of a gear's curve turns its joint under a load (rad or m), by
    /// the law of its [`Effect`]; 0 where it is of no curve.
    pub fn turn(self, torque: Torque) -> f64 {
        let unit = match self {
            Self::Knee { joint, knee } => Effect::StiffnessNonlinearity { joint, added: 1.0, knee },
            Self::Gap { joint, knee } => Effect::LostMotion { joint, gap: 1.0, knee },
            Self::Spring(_) | Self::Play { .. } => return 0.0,
        };
        turn(&unit, 0.0, 0.0, torque, [0.0; PLAYS]).unwrap_or_default()
    }

    /// Where the play operator of a weight is after a load (Nm), counted as `before` from where it rests
    /// under the preload; 0 where it is of no weight.
    pub fn after(self, torque: Torque, before: f64) -> f64 {
        let Self::Play { joint, radius: radius1, .. } = self else { return 0.0 };
        let [radius2, radius3, weight2, weight3] = [0.0; 4];
        let unit = Effect::Hysteresis { joint, radius1, weight1: 1.0, radius2, weight2, radius3, weight3 };
        plays(&unit, torque, [before, 0.0, 0.0])[0]
    }

    /// Whether it is of a law of its joint, in which the joint's torque is not linear.
    pub fn is_law(self) -> bool {
        !matches!(self, Self::Spring(_))
    }
}
