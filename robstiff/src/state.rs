//! What a robot remembers of the loads it bore.

use robstiff_robots::effect::physics::PLAYS;

use crate::Real;

/// The state of the joints with [`hysteresis`], which a caller carries from
/// load to load: [`Robot::deflection_with`](crate::Robot::deflection_with)
/// takes it and brings it up to date.
///
/// A new one is that of a robot that was never loaded. Robots without
/// hysteresis leave it as it is.
///
/// ```
/// # #[cfg(feature = "generic")] {
/// use robstiff::nalgebra::{SVector, Vector6};
/// use robstiff::robots::Description;
/// use robstiff::{Generic, Robot, State};
///
/// let text = "
/// name: Lever
/// convention: standard
/// joints: [{a: 1 m, compliance: 1e-6 rad/Nm}]
/// effects: [{kind: hysteresis, at: joint 1, radius1: 50 Nm, weight1: 2e-7 rad/Nm}]
/// ";
/// let lever = Generic::<1>::new(&Description::parse("lever.yaml", text).unwrap()).unwrap();
/// let (q, push) = (SVector::from([0.0]), Vector6::new(0.0, 100.0, 0.0, 0.0, 0.0, 0.0));
///
/// let mut state = State::new();
/// let up: f64 = lever.deflection_with(&q, &push, &mut state)[1];
/// assert!((up - (100e-6 + 2e-7 * (100.0 - 50.0))).abs() < 1e-12);
/// // Without load, what the play operator still holds is left.
/// let left: f64 = lever.deflection_with(&q, &(push * 0.0), &mut state)[1];
/// assert!((left - 2e-7 * 50.0).abs() < 1e-12);
/// # }
/// ```
///
/// [`hysteresis`]: crate::robots::effect::hysteresis
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const N: usize, T = f64> {
    /// The play operators of each joint: up to three torques, each within its
    /// radius of the joint's last one (Nm). Those that nothing depends on stay as
    /// they are: of joints without hysteresis, and those of weight 0 behind the last
    /// that has a weight.
    pub plays: [[T; PLAYS]; N],
}

impl<const N: usize, T: Real> State<N, T> {
    /// The state of a robot that was never loaded.
    pub fn new() -> Self {
        Self { plays: [[T::zero(); PLAYS]; N] }
    }
}

impl<const N: usize, T: Real> Default for State<N, T> {
    fn default() -> Self {
        Self::new()
    }
}
