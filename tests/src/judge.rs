//! How near two calculations of the same thing must be.

use nalgebra::{Matrix6, SVector, Vector6};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_robots::dimension::Dimension;
use robstiff_robots::{Description, Effect, Joint, Placement};

/// How large things of a robot are, for what cancels to be measured by.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    /// The length of the outstretched arm (m), at least 1.
    pub reach: f64,
    /// The largest compliance in the description.
    pub softest: f64,
}

impl Sizes {
    /// The sizes of a robot at joint coordinates `q`.
    pub fn of(robot: &Description, q: &[f64]) -> Self {
        let placed = |placement: &Placement| placement.xyz.iter().map(|x| x.abs()).sum::<f64>();
        let joints = robot.joints.iter().zip(q).map(|(joint, q)| joint.d.abs() + joint.a.abs() + q.abs());
        let reach = (placed(&robot.base) + placed(&robot.tool) + joints.sum::<f64>()).max(1.0);
        let joints = robot.joints.iter().map(Joint::compliance);
        let effects = robot.effects.iter().map(|effect| match *effect {
            Effect::LostMotion { gap, knee, .. } => gap / (2.0 * knee),
            Effect::PoseDependentCompliance { joint, cos1, sin1, cos2, sin2 } => {
                robot.joints[joint - 1].compliance() * (1.0 + cos1.abs() + sin1.abs() + cos2.abs() + sin2.abs())
            }
            _ if effect.is_kinematic() => 0.0,
            _ => {
                let compliances = effect.parameters().filter(|(parameter, _)| {
                    let dimension = parameter.quantity.at(effect.place());
                    matches!(dimension, Dimension::Compliance | Dimension::LinearCompliance)
                });
                compliances.map(|(_, value)| value.abs()).fold(0.0, f64::max)
            }
        });
        Self { reach, softest: joints.chain(effects).fold(0.0, f64::max) }
    }

    /// What the blocks of a compliance would be if nothing cancelled: those of
    /// [`blocks`].
    pub fn compliance(&self) -> [f64; 3] {
        [self.softest * self.reach * self.reach, self.softest * self.reach, self.softest]
    }

    /// What a joint torque under a wrench would be if nothing cancelled.
    pub fn torque(&self, wrench: &Vector6<f64>) -> f64 {
        wrench.amax() * self.reach
    }
}

/// How far apart two calculations may be.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// Relative to the largest entry of the same kind, because a cancelled
    /// entry has the rounding of what cancelled.
    pub relative: f64,
    /// Relative to what the entries would be if nothing cancelled, for where
    /// all do.
    pub rounding: f64,
}

/// For calculations in `f64`.
pub const DOUBLE: Tolerance = Tolerance { relative: 1e-12, rounding: 1e-15 };

/// For calculations in `f32`.
pub const SINGLE: Tolerance = Tolerance { relative: 1e-5, rounding: 5e-7 };

/// Asserts that two calculations agree; without cancellation the entries would
/// be as large as `size`.
///
/// # Panics
/// If they do not agree.
pub fn assert_close(name: &str, found: &[f64], expected: &[f64], size: f64, tolerance: Tolerance) {
    assert_eq!(found.len(), expected.len(), "{name}");
    let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let allowed = (tolerance.relative * largest).max(tolerance.rounding * size);
    for (k, (a, b)) in found.iter().zip(expected).enumerate() {
        let off = (a - b).abs();
        assert!(off <= allowed, "{name}[{k}]: {a:e}, expected {b:e}, off by {off:e}, allowed are {allowed:e}");
    }
}

/// Displacement per force, displacement per moment, rotation per moment.
pub fn blocks(compliance: &Matrix6<f64>) -> [Vec<f64>; 3] {
    [(0, 0), (0, 3), (3, 3)].map(|at| compliance.fixed_view::<3, 3>(at.0, at.1).iter().copied().collect())
}

/// Random joint coordinates within +-3 (rad or m), each with a random wrench
/// within +-1000 (N, Nm); the same ones for the same seed.
pub fn trials<const N: usize>(count: usize, seed: u64) -> impl Iterator<Item = (SVector<f64, N>, Vector6<f64>)> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    (0..count).map(move |_| {
        let q = SVector::from_fn(|_, _| random.random_range(-3.0..3.0));
        let wrench = Vector6::from_fn(|_, _| random.random_range(-1000.0..1000.0));
        (q, wrench)
    })
}
