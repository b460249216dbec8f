//! Columns of the regression of a campaign.

use robstiff::elements::Spring;

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
    /// Whether it is of a law of its joint, in which the joint's torque is not linear.
    pub fn is_law(self) -> bool {
        !matches!(self, Self::Spring(_))
    }
}
