//! Reachable poses, drawn at random, and whether inverse kinematics finds them.

use nalgebra::{Matrix4, SVector, Unit, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff::Robot;
use robstiff_machining::inverse::{Inverse, Target};

/// What came of some poses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reached {
    /// Poses that were tried.
    pub tried: usize,
    /// Poses without a solution, or with one outside the limits.
    pub missed: usize,
    /// The largest distance between a solution and its target (m).
    pub distance: f64,
    /// The largest angle between the two (rad).
    pub angle: f64,
}

impl Reached {
    /// The same of two samples.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            tried: self.tried + other.tried,
            missed: self.missed + other.missed,
            distance: self.distance.max(other.distance),
            angle: self.angle.max(other.angle),
        }
    }
}

/// What of a pose is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Asked {
    /// All of it.
    Pose,
    /// The position, and the direction of an axis of the tool.
    Axis(Unit<Vector3<f64>>),
}

/// Draws postures evenly within the limits (where there are none, within a turn
/// or a metre to either side), and solves the poses of the tool there from
/// another posture drawn the same way.
pub fn reach<const N: usize, R: Robot<N>>(robot: &R, asked: Asked, count: usize, seed: u64) -> Reached {
    let inverse = Inverse::new(robot);
    let limits = robot.limits();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut draw = || {
        SVector::<f64, N>::from_fn(|i, _| {
            let [low, high] = limits[i].unwrap_or([-std::f64::consts::PI, std::f64::consts::PI]);
            random.random_range(low..=high)
        })
    };
    let mut reached = Reached { tried: count, ..Reached::default() };
    for _ in 0..count {
        let (q, seed) = (draw(), draw());
        let target = target(&robot.transform(&q), asked);
        let Ok(found) = inverse.nearest(&target, &seed) else {
            reached.missed += 1;
            continue;
        };
        let is_allowed = found
            .iter()
            .zip(limits)
            .all(|(&value, limits)| limits.is_none_or(|[low, high]| (low - 1e-6..=high + 1e-6).contains(&value)));
        let left = target.remaining(&robot.transform(&found));
        reached.missed += usize::from(!is_allowed);
        reached.distance = reached.distance.max(left.distance);
        reached.angle = reached.angle.max(left.angle);
    }
    reached
}

fn target(pose: &Matrix4<f64>, asked: Asked) -> Target {
    match asked {
        Asked::Pose => Target::pose(pose),
        Asked::Axis(tool) => {
            let direction = pose.fixed_view::<3, 3>(0, 0) * tool.as_ref();
            Target::axis(pose.fixed_view::<3, 1>(0, 3).into_owned(), tool, Unit::new_normalize(direction))
        }
    }
}
