//! Correcting a milling robot's joint targets for a measured force.
//!
//! The tool gives way to the cutting force by what `Robot::deflection` says.
//! Each control step takes the force sensor's reading and shifts the joint
//! targets so that the tool centre point moves back by as much, within limits of
//! size and rate. When the sensor falls silent or talks nonsense, the last
//! correction is held for a moment and then withdrawn at the same rate: a
//! correction for a force that is no longer known must not stay, and must not
//! vanish with a jerk.
#![no_std]

use robstiff::Robot;
use robstiff::nalgebra::{SVector, Vector6};

robstiff::robot!("rv130hsc.yaml");

/// The number of joints.
pub const JOINTS: usize = 5;

/// What the corrections must not exceed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Of a joint's correction, either way (rad).
    pub size: f32,
    /// Of its change in one step (rad).
    pub rate: f32,
    /// Steps for which the last correction is held without a reading.
    pub hold: u32,
}

/// The state between control steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    limits: Limits,
    correction: [f32; JOINTS],
    steps_without_reading: u32,
}

/// Keeps the inverse finite where the arm is stretched out (m^2): directions in
/// which a joint moves the tool by less than some 0.03 m/rad are not corrected.
const DAMPING: f32 = 1e-3;

impl Controller {
    /// A controller that corrects nothing yet.
    pub const fn new(limits: Limits) -> Self {
        Self { limits, correction: [0.0; JOINTS], steps_without_reading: 0 }
    }

    /// One control step: joint coordinates (rad) and, if the sensor has one, the
    /// wrench at the tool centre point in the base frame (N, Nm) in; what to add
    /// to the joint targets (rad) out.
    pub fn step(&mut self, q: &[f32; JOINTS], wrench: Option<&[f32; 6]>) -> [f32; JOINTS] {
        let wanted = match wrench.and_then(|wrench| correction(q, wrench)) {
            Some(wanted) => {
                self.steps_without_reading = 0;
                wanted
            }
            None => {
                self.steps_without_reading = self.steps_without_reading.saturating_add(1);
                if self.steps_without_reading <= self.limits.hold { self.correction } else { [0.0; JOINTS] }
            }
        };
        let Limits { size, rate, .. } = self.limits;
        for (now, wanted) in self.correction.iter_mut().zip(wanted) {
            *now += clamped(clamped(wanted, size) - *now, rate);
        }
        self.correction
    }
}

/// `x` within `+-most`. Unlike `f32::clamp` it has no bounds that could be wrong.
fn clamped(x: f32, most: f32) -> f32 {
    x.min(most).max(-most)
}

/// The joint correction that takes the tool centre point back to where it would
/// be without the wrench: damped least squares on the rows of the Jacobian that
/// move it, `J^T (J J^T + DAMPING)^-1 (-d)`. `None` where anything is not a
/// number.
fn correction(q: &[f32; JOINTS], wrench: &[f32; 6]) -> Option<[f32; JOINTS]> {
    let q = SVector::<f32, JOINTS>::from(*q);
    let deflection = Rv130hsc.deflection(&q, &Vector6::from(*wrench));
    let translation = Rv130hsc.jacobian(&q).fixed_rows::<3>(0).into_owned();
    let d = deflection.fixed_rows::<3>(0).into_owned();

    let mut square = translation * translation.transpose();
    for i in 0..3 {
        square[(i, i)] += DAMPING;
    }
    // Symmetric and positive definite: the inverse by cross products of its
    // columns is safe, and takes neither pivots nor loops.
    let (x, y, z) = (square.column(0).into_owned(), square.column(1).into_owned(), square.column(2).into_owned());
    let across = [y.cross(&z), z.cross(&x), x.cross(&y)];
    let determinant = x.dot(&across[0]);
    let solved = SVector::<f32, 3>::new(across[0].dot(&d), across[1].dot(&d), across[2].dot(&d)) / determinant;
    let correction: [f32; JOINTS] = (translation.transpose() * -solved).into();
    correction.iter().all(|x| x.is_finite()).then_some(correction)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { size: 5e-3, rate: 1e-4, hold: 3 };
    const Q: [f32; JOINTS] = [0.3, -0.4, 0.5, 0.2, 1.2];
    const WRENCH: [f32; 6] = [150.0, -200.0, 300.0, 0.0, 0.0, 0.0];

    fn settled() -> (Controller, [f32; JOINTS]) {
        let mut controller = Controller::new(LIMITS);
        let mut correction = [0.0; JOINTS];
        for _ in 0..200 {
            correction = controller.step(&Q, Some(&WRENCH));
        }
        (controller, correction)
    }

    #[test]
    fn the_tool_moves_back_by_its_deflection() {
        let (_, correction) = settled();
        let q = SVector::from(Q);
        let moved = q + SVector::from(correction);
        let position = |q| Rv130hsc.transform::<f32>(q).fixed_view::<3, 1>(0, 3).into_owned();
        let deflection = Rv130hsc.deflection(&q, &Vector6::from(WRENCH)).fixed_rows::<3>(0).into_owned();
        let left = position(&moved) - position(&q) + deflection;
        assert!(deflection.norm() > 3e-4, "{}", deflection.norm());
        assert!(left.norm() < 0.03 * deflection.norm(), "{} of {}", left.norm(), deflection.norm());
    }

    #[test]
    fn size_and_rate_are_limited() {
        let mut controller = Controller::new(LIMITS);
        let mut before = [0.0; JOINTS];
        for _ in 0..500 {
            let now = controller.step(&Q, Some(&[1e6, -1e6, 1e6, 0.0, 0.0, 0.0]));
            for (now, before) in now.iter().zip(before) {
                assert!((now - before).abs() <= LIMITS.rate * 1.001 && now.abs() <= LIMITS.size);
            }
            before = now;
        }
        assert!(before.iter().any(|x| x.abs() == LIMITS.size));
    }

    #[test]
    fn a_silent_sensor_is_held_and_then_let_go() {
        let (mut controller, correction) = settled();
        for _ in 0..LIMITS.hold {
            assert_eq!(controller.step(&Q, None), correction);
        }
        for _ in 0..200 {
            controller.step(&Q, None);
        }
        assert_eq!(controller.step(&Q, None), [0.0; JOINTS]);
    }

    #[test]
    fn nonsense_counts_as_silence() {
        for wrench in [[f32::NAN; 6], [f32::INFINITY, 0.0, 0.0, 0.0, 0.0, 0.0]] {
            let (mut controller, correction) = settled();
            assert_eq!(controller.step(&Q, Some(&wrench)), correction);
        }
        let (mut controller, correction) = settled();
        assert_eq!(controller.step(&[f32::NAN; JOINTS], Some(&WRENCH)), correction);
    }
}
