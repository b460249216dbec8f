//! Everything random of a scenario, each from a stream of its own.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_robots::Description;

use super::{Part, Poses, Refused, Scenario};
use crate::model::Arm;

/// The streams of a seed.
#[derive(Clone, Copy)]
pub enum Stream {
    Poses,
    Loads,
    Noise,
    Scatter,
    Encoders,
    Tracker,
}

/// One of them.
pub fn stream(scenario: &Scenario, stream: Stream) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(scenario.seed);
    random.set_stream(stream as u64);
    random
}

/// Draws of one pose before the working region counts as out of reach.
const TRIES: usize = 10_000;

/// From one row to the next (s).
pub const PACE: f64 = 60.0;

/// Takes the parts of the joints' compliances off their declared values.
pub fn scatter(scenario: &Scenario, robot: &mut Description) {
    let mut random = stream(scenario, Stream::Scatter);
    for part in robot.joints.iter_mut().flat_map(|joint| &mut joint.compliance) {
        part.value *= 1.0 + scenario.scatter * (2.0 * random.random::<f64>() - 1.0);
    }
}

/// The poses of a scenario.
///
/// # Errors
/// No pose in the working region.
pub fn poses(robot: &Description, scenario: &Scenario) -> Result<Vec<Vec<f64>>, Refused> {
    let (count, within, floor, column) = match &scenario.poses {
        Poses::Listed(poses) => return Ok(poses.clone()),
        Poses::Drawn { count, within, floor, column } => (*count, within, *floor, *column),
    };
    let mut random = stream(scenario, Stream::Poses);
    let arm = Arm::of(robot);
    let [foot_x, foot_y, foot_z] = robot.base.xyz;
    let is_inside = |[x, y, z]: [f64; 3]| {
        floor.is_none_or(|floor| z - foot_z >= floor)
            && column.is_none_or(|column| (x - foot_x).hypot(y - foot_y) >= column)
    };
    let mut pose = || {
        for _ in 0..TRIES {
            let q: Vec<f64> = within.iter().map(|&[low, high]| random.random_range(low..=high)).collect();
            if is_inside(arm.stand(&q, &[]).tcp.at.into()) {
                return Ok(q);
            }
        }
        Err(Refused {
            part: Part::Region,
            message: format!(
                "none of {TRIES} poses drawn within the joints' limits keeps the tool in this working region"
            ),
            help: String::from("a lower `floor`, a smaller `column`, or wider joint ranges in `within`"),
        })
    };
    (0..count).map(|_| pose()).collect()
}

/// Names of poses or visits.
pub fn names(count: usize) -> Vec<String> {
    (1..=count).map(|number| number.to_string()).collect()
}
