//! Encoders: what the motors' and those behind the gears read under a load.

use rand_chacha::ChaCha8Rng;

use super::noise::normal;

/// A description has eight joints at most.
pub const MOST_JOINTS: usize = 8;

/// By how much joints have turned (rad or m), from the first on.
pub type Turns = [f64; MOST_JOINTS];

/// Encoders that are read with every row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoders {
    /// Those on the output side of the gears: the noise of a reading, one sigma
    /// (rad or m); none where there are none.
    pub output: Option<f64>,
    /// By how much these and the coordinate of the unloaded arm are apart, one
    /// number a pose and joint, one sigma (rad or m): a gear has errors of its
    /// own.
    pub apart: f64,
    /// Those of the motors, of a controller that gives way by this share of each
    /// joint's compliance.
    pub motors: Option<f64>,
}

impl Encoders {
    /// Encoders behind the gears alone, to a second of arc, which agree with the
    /// coordinates of the unloaded arm.
    pub fn behind_gears() -> Self {
        Self { output: Some(5e-6), apart: 0.0, motors: None }
    }

    /// The errors of a pose.
    pub(super) fn of_pose(&self, random: &mut ChaCha8Rng) -> Turns {
        std::array::from_fn(|_| self.apart * normal(random))
    }

    /// The noise of a row.
    pub(super) fn of_row(&self, random: &mut ChaCha8Rng) -> Turns {
        std::array::from_fn(|_| self.output.unwrap_or(0.0) * normal(random))
    }
}
