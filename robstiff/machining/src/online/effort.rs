//! How much there is to simulate, which is known before it begins.

use core::f64::consts::TAU;

use super::controller::{Controller, Servo};

/// Points within a control step at which the deviation is looked at, at least (so
/// that what a step does within is seen) and at most.
const POINTS: [usize; 2] = [2, 8];

/// Between two of them along a path, if the control step is longer (s).
const APART: f64 = 0.5e-3;

/// Of a sine, so many in a period at least, as far as the above lets them be.
const IN_A_PERIOD: f64 = 200.0;

/// How long a sine is looked at (s), but for two to ten periods.
const LOOKED_AT: f64 = 4.0;

/// So many time constants of the position loops are waited for.
const SETTLED: f64 = 20.0;

/// How much there is to simulate: time and memory of a simulation are those of its
/// [`instants`](Self::instants), which an odd delay, bandwidth or frequency makes
/// more than anybody waits for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// The time that is simulated (s); infinite where the numbers of the
    /// controller say so.
    pub duration: f64,
    /// The control step (s).
    pub step: f64,
    /// The points within a control step at which the deviation is looked at.
    pub points: usize,
}

impl Effort {
    /// Of [`simulate`](super::simulate) for a duration (s).
    pub fn at_pose(controller: &Controller, duration: f64) -> Self {
        Self { duration, step: controller.step, points: POINTS[1] }
    }

    /// Of [`simulate_along`](super::simulate_along) for a duration (s).
    pub fn along(controller: &Controller, duration: f64) -> Self {
        Self { duration, step: controller.step, points: points(controller.step / APART) }
    }

    /// Of [`left_of_sine`](super::left_of_sine) at a frequency (Hz): until delay and
    /// position loops have died down, at least a period, and two to ten more.
    pub fn of_sine(controller: &Controller, frequency: f64) -> Self {
        let settled = settling(&controller.servo) + controller.delay + controller.step;
        Self {
            duration: settled.max(1.0 / frequency) + looked_at(frequency),
            step: controller.step,
            points: points(IN_A_PERIOD * frequency * controller.step),
        }
    }

    /// How many [`Instant`](super::Instant)s it takes.
    pub fn instants(&self) -> f64 {
        (self.duration / self.step).ceil() * self.points as f64
    }
}

/// How long the position loops take to die down (s).
fn settling(servo: &Servo) -> f64 {
    let slowest = match *servo {
        Servo::Ideal => 0.0,
        Servo::FirstOrder { bandwidth } => 1.0 / (TAU * bandwidth),
        Servo::SecondOrder { frequency, damping } => {
            // Of two real poles the slower, whose rate as a difference would cancel;
            // of two complex ones what both decay with.
            let slow = match damping > 1.0 {
                true => 1.0 / (damping + (damping - 1.0).sqrt() * (damping + 1.0).sqrt()),
                false => damping,
            };
            1.0 / (TAU * frequency * slow)
        }
    };
    SETTLED * slowest
}

/// How long a sine is looked at (s).
pub(super) fn looked_at(frequency: f64) -> f64 {
    (LOOKED_AT * frequency).round().clamp(2.0, 10.0) / frequency
}

/// Points within a control step, for want of so many.
fn points(wanted: f64) -> usize {
    (wanted.ceil() as usize).clamp(POINTS[0], POINTS[1])
}
