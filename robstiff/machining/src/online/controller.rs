//! The controller that corrects joint targets.

use core::f64::consts::TAU;

/// What the controller corrects by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensing {
    /// A force sensor and a model of the robot's compliance: corrects whatever
    /// the model has, and leaves what it does not.
    Force,
    /// Encoders on the output side of the gears: corrects what the gears do
    /// without a model of them, and leaves links, bearings, base and tool.
    Encoders,
}

/// How the position of a joint follows its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Servo {
    /// At once.
    Ideal,
    /// With one pole.
    FirstOrder {
        /// The frequency where the gain has fallen to `1 / sqrt(2)` (Hz).
        bandwidth: f64,
    },
    /// With two.
    SecondOrder {
        /// The natural frequency (Hz).
        frequency: f64,
        /// The damping ratio.
        damping: f64,
    },
}

/// What corrections must not exceed, one number for all joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Of a correction, either way (rad or m).
    pub size: f64,
    /// Of its speed (rad/s or m/s).
    pub rate: f64,
    /// For how long the last correction is held without a reading (s); then it
    /// is withdrawn at that speed.
    pub hold: f64,
}

/// A controller and what it acts on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    /// What is read.
    pub sensing: Sensing,
    /// The time from one control step to the next (s).
    pub step: f64,
    /// From a reading to the position loops (s).
    pub delay: f64,
    /// The position loops.
    pub servo: Servo,
    /// Of the correction.
    pub limits: Limits,
    /// Of the least squares (m^2): directions in which the joints move the tool
    /// by less than the root of this are not corrected.
    pub damping: f64,
}

impl Controller {
    /// By how much a correction that changes slowly lags behind the force (s): the delay, half
    /// the step for which it is held, and what the position loops take.
    pub fn lag(&self) -> f64 {
        let loops = match self.servo {
            Servo::Ideal => 0.0,
            Servo::FirstOrder { bandwidth } => 1.0 / (TAU * bandwidth),
            Servo::SecondOrder { frequency, damping } => 2.0 * damping / (TAU * frequency),
        };
        self.delay + 0.5 * self.step + loops
    }
}
