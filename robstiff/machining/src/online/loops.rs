//! The position loops of the joints, between the corrections that reach them.

use std::collections::VecDeque;

use core::f64::consts::TAU;
use nalgebra::{Matrix2, SVector, Vector2};

use super::controller::Servo;

/// The loops of all joints, with what is on its way to them.
pub struct Loops<const N: usize> {
    servo: Servo,
    /// Position (rad or m) and speed of each.
    joints: [Vector2<f64>; N],
    target: SVector<f64, N>,
    /// Targets that have not come yet, with the time when they do (s).
    underway: VecDeque<(f64, SVector<f64, N>)>,
    /// The time that they have come to (s).
    now: f64,
    /// How they go on over the time that is asked for most often.
    usual: Matrix2<f64>,
}

impl<const N: usize> Loops<N> {
    /// At rest at zero, mostly to be looked at after every `part` of a second.
    pub fn new(servo: Servo, part: f64) -> Self {
        Self {
            servo,
            joints: [Vector2::zeros(); N],
            target: SVector::zeros(),
            underway: VecDeque::new(),
            now: 0.0,
            usual: transition(servo, part),
        }
    }

    /// A target that comes at a time (s), not before those that were sent before it.
    pub fn send(&mut self, at: f64, target: SVector<f64, N>) {
        self.underway.push_back((at, target));
    }

    /// The positions at a time (s) that is one `part` after the last one that was asked for; the
    /// first one may be earlier, and is half a part after zero.
    pub fn at(&mut self, time: f64) -> SVector<f64, N> {
        let mut is_usual = self.now > 0.0;
        while let Some(&(at, next)) = self.underway.front().filter(|(at, _)| *at < time) {
            self.underway.pop_front();
            if at > self.now {
                self.go_on(&transition(self.servo, at - self.now));
                (self.now, is_usual) = (at, false);
            }
            self.target = next;
        }
        let rest = if is_usual { self.usual } else { transition(self.servo, time - self.now) };
        self.go_on(&rest);
        self.now = time;
        SVector::from_fn(|i, _| self.joints[i].x)
    }

    fn go_on(&mut self, transition: &Matrix2<f64>) {
        for (joint, &target) in self.joints.iter_mut().zip(&self.target) {
            let target = Vector2::new(target, 0.0);
            *joint = transition * (*joint - target) + target;
        }
    }
}

/// How position and speed, less the target, go on over a time (s).
fn transition(servo: Servo, time: f64) -> Matrix2<f64> {
    match servo {
        Servo::Ideal => Matrix2::zeros(),
        Servo::FirstOrder { bandwidth } => Matrix2::new((-TAU * bandwidth * time).exp(), 0.0, 0.0, 0.0),
        Servo::SecondOrder { frequency, damping } => {
            let w = TAU * frequency;
            (Matrix2::new(0.0, 1.0, -w * w, -2.0 * damping * w) * time).exp()
        }
    }
}
