//! What a correction leaves when the arm is not as described.

use super::Compensated;
use crate::deviation::{Load, PulledIn, Stand, Summary, displaced};
use crate::path::SolvedPath;
use robstiff::Robot;

/// What a correction leaves of the displacement of the TCP, as fractions of what it
/// is without correction on the same arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeftIfWrong {
    /// Of the root of the mean square over the length of the path.
    pub rms: f64,
    /// Of the largest.
    pub worst: f64,
}

/// What is left when the true arm is softer or stiffer than the model by a part.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// All joints and effects at once, softer and stiffer.
    pub all: [LeftIfWrong; 2],
    /// Each joint and then each effect alone, in the order of the description.
    pub each: Vec<[LeftIfWrong; 2]>,
}

/// What is left on an arm whose joints and effects are softer than the robot's by a
/// factor each (in the order of the description); 1 for all is the robot itself.
///
/// # Errors
/// The points at which arm and cut do not settle.
///
/// # Panics
/// If the load or the correction has another number of points than the path.
pub fn left<const N: usize>(
    robot: &impl Robot<N>,
    factors: &[f64],
    path: &SolvedPath<N>,
    load: &Load,
    compensated: &Compensated<N>,
) -> Result<LeftIfWrong, PulledIn> {
    let all = left_of_each(robot, &[factors.to_vec()], path, load, compensated)?;
    Ok(all[0])
}

/// The same of several arms.
fn left_of_each<const N: usize>(
    robot: &impl Robot<N>,
    arms: &[Vec<f64>],
    path: &SolvedPath<N>,
    load: &Load,
    compensated: &Compensated<N>,
) -> Result<Vec<LeftIfWrong>, PulledIn> {
    assert_eq!(compensated.points.len(), path.points.len(), "a correction for every point of the path");
    let lengths = path.lengths();
    let distance = |stand: &Stand| stand.off.fixed_rows::<3>(0).norm();
    let distances = |distances: Vec<f64>| Summary::of(distances.into_iter().zip(lengths.iter().copied()));
    let uncorrected = displaced(robot, arms, path.points.iter().map(|point| point.q), path, load, distance)?;
    let corrected = displaced(robot, arms, compensated.points.iter().map(|point| point.q), path, load, distance)?;
    // An arm that is not pushed anywhere has nothing to correct.
    let part = |with: f64, without: f64| if without > 0.0 { with / without } else { 0.0 };
    let left = |(corrected, uncorrected)| {
        let both = distances(corrected).zip(distances(uncorrected));
        both.map_or(LeftIfWrong { rms: 0.0, worst: 0.0 }, |(with, without)| LeftIfWrong {
            rms: part(with.rms, without.rms),
            worst: part(with.worst, without.worst),
        })
    };
    Ok(corrected.into_iter().zip(uncorrected).map(left).collect())
}

/// What is left when the true arm's compliance is `by` larger and smaller than the
/// model's (0.1 for 10 %): all of it, and each joint and effect alone.
///
/// # Errors
/// The points at which arm and cut do not settle.
///
/// # Panics
/// As [`left`].
pub fn sensitivity<const N: usize>(
    robot: &impl Robot<N>,
    path: &SolvedPath<N>,
    load: &Load,
    compensated: &Compensated<N>,
    by: f64,
) -> Result<Sensitivity, PulledIn> {
    let count = N + robot.effects().len();
    // All elements, and then each alone.
    let wrong = core::iter::once(None).chain((0..count).map(Some));
    let arms = wrong
        .flat_map(|one| [1.0 + by, 1.0 - by].map(|factor| (one, factor)))
        .map(|(one, factor)| (0..count).map(|k| if one.is_none_or(|one| one == k) { factor } else { 1.0 }).collect());
    let arms: Vec<Vec<f64>> = arms.collect();
    let left = left_of_each(robot, &arms, path, load, compensated)?;
    let mut both = left.chunks_exact(2).map(|both| [both[0], both[1]]);
    let all = both.next().expect("there is an arm");
    Ok(Sensitivity { all, each: both.collect() })
}
