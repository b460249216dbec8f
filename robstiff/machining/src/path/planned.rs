//! The postures of a path whose turn about the tool's axis is planned.

use std::collections::BTreeSet;

use nalgebra::SVector;

use super::plan::{Plan, Wanted};
use super::turn::FreeTurns;
use super::{Goal, Known, Waypoint, stations};
use crate::inverse::Inverse;
use robstiff::Robot;

/// How often points between the stations that the plan does not reach, or between which it changes the
/// posture, become stations of a new one.
const ROUNDS: usize = 3;

/// A posture for each point that is reached as planned.
pub struct Planned<const N: usize> {
    /// The path with its turns.
    pub path: FreeTurns,
    /// What is planned at each point.
    pub wanted: Vec<Wanted<N>>,
    /// The postures (rad) of those points that are reached so.
    pub postures: Vec<Option<SVector<f64, N>>>,
}

/// Plans the turns of a path, from the posture at its first point that is nearest to a `start` (rad), if that
/// is given; `middle` is that of the joints' ranges. `None` where a turn is not free, or the arm does not take
/// every turn or reaches no point.
pub fn planned<const N: usize, R: Robot<N>>(
    robot: &R,
    inverse: &Inverse<'_, R, N>,
    points: &[Waypoint],
    start: Option<&SVector<f64, N>>,
    middle: &SVector<f64, N>,
    known: &Known<'_>,
) -> Option<Planned<N>> {
    let path = FreeTurns::of(points, inverse.scale(), known).filter(|_| inverse.takes_every_turn())?;
    let start = match (start, &points.first()?.goal) {
        (Some(start), Goal::Tool(target)) => Some(inverse.nearest(target, start).ok()?),
        _ => None,
    };
    let start = start.as_ref().map(|q| (q, path.turn_of(0, &robot.transform(q))));
    let mut stations: BTreeSet<usize> =
        stations::points(path.progress(), inverse.carried_along(middle).len()).into_iter().collect();
    let mut round = 0;
    loop {
        round += 1;
        let wanted = Plan::of((robot, inverse), &path, stations.iter().copied(), start, middle)?.along(inverse, &path);
        let solve = |(point, wanted): (usize, &Wanted<N>)| {
            let q = inverse.exactly(&path.target(point, wanted.turn), &wanted.near)?;
            (inverse.side(&q) == wanted.side && inverse.is_within_half_a_turn(&q, &wanted.near)).then_some(q)
        };
        let postures: Vec<_> = wanted.iter().enumerate().map(solve).collect();
        let open = || (0..postures.len()).filter(|point| postures[*point].is_none() || wanted[*point].changing);
        // Of a path that is mostly out of reach they would be too many, and help nobody.
        let more = open().filter(|point| !stations.contains(point)).count();
        if more == 0 || more > stations.len() || round > ROUNDS {
            return Some(Planned { path, wanted, postures });
        }
        stations.extend(open());
    }
}
