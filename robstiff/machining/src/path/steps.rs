//! The postures along a path, one after another, and how good they are.

use nalgebra::{Matrix4, Rotation3, SVector, UnitQuaternion, Vector3};

use super::stations::{FAR_ENOUGH, leads_to, margin, state};
use super::turn::FreeTurns;
use super::{Jump, Orientation, Unreached, Waypoint};
use crate::inverse::{Inverse, Target};
use robstiff::{JointKind, Robot};

/// One posture a point, or why there is none.
pub struct Followed<const N: usize> {
    pub postures: Vec<Result<SVector<f64, N>, Unreached>>,
    /// The jumps, each with the point (from 0) that it comes to.
    pub jumps: Vec<(usize, Jump)>,
    /// The largest change of a joint between neighbours (rad or m).
    pub largest: f64,
}

/// How good a way is, the least the best.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rank {
    /// Points that are not reached.
    missed: usize,
    /// Jumps that no plan takes for a way without a change.
    changes: usize,
    /// By how much (deg) the worst posture is nearer to a limit or a singular place than enough.
    nearer: u8,
    /// How much longer (ms) than the feed allows the joints take.
    late: u64,
    /// All jumps: the points of a path may be so far apart that the tool leaves it without a change.
    jumps: usize,
}

impl Rank {
    /// Nothing is left to wish for.
    pub const BEST: Self = Self { missed: 0, changes: 0, nearer: 0, late: 0, jumps: 0 };

    /// That of a way along a path with free turns.
    pub fn of<const N: usize, R: Robot<N>>(
        followed: &Followed<N>,
        robot: &R,
        inverse: &Inverse<'_, R, N>,
        path: &FreeTurns,
    ) -> Self {
        let reached = || followed.postures.iter().flatten();
        let nearer = reached().map(|q| FAR_ENOUGH - margin(inverse, q)).max().unwrap_or(FAR_ENOUGH);
        let is_change = |point: usize| {
            let stop = |point: usize| {
                let q = followed.postures[point].ok()?;
                Some((point, state(inverse, q, path.turn_of(point, &robot.transform(&q)))))
            };
            let before = (0..point).rev().find_map(stop);
            before.zip(stop(point)).is_some_and(|((from, before), (_, after))| {
                !leads_to(inverse, &before, &after, path.progress()[point] - path.progress()[from])
            })
        };
        let points: Vec<(usize, SVector<f64, N>)> =
            followed.postures.iter().enumerate().filter_map(|(point, q)| Some((point, q.ok()?))).collect();
        let late = points.windows(2).map(|pair| {
            let [(from, before), (to, after)] = [pair[0], pair[1]];
            path.late([from, to], (after - before).as_slice())
        });
        let late = (1e3 * late.sum::<f64>()).round() as u64;
        Self {
            late,
            missed: followed.postures.len() - reached().count(),
            changes: followed.jumps.iter().filter(|(point, _)| is_change(*point)).count(),
            nearer,
            jumps: followed.jumps.len(),
        }
    }

    /// How many changes of posture there are, and how near (deg) it comes to limits and singular places.
    #[cfg(test)]
    pub fn changes_and_nearer(&self) -> (usize, u8) {
        (self.changes, self.nearer)
    }
}

/// Follows a path; `reach` gives the posture at a point (from 0) after that at the last one reached.
pub fn follow<const N: usize, R: Robot<N>>(
    robot: &R,
    points: &[Waypoint],
    reach: impl Fn(usize, Option<&SVector<f64, N>>) -> Result<SVector<f64, N>, Unreached>,
) -> Followed<N> {
    let mut followed = Followed { postures: Vec::with_capacity(points.len()), jumps: Vec::new(), largest: 0.0 };
    let mut last: Option<(usize, SVector<f64, N>, Matrix4<f64>)> = None;
    for (i, point) in points.iter().enumerate() {
        let reached = reach(i, last.as_ref().map(|(_, q, _)| q));
        followed.postures.push(reached);
        // After a point that is not reached, the next is nearest to the last that is.
        let Ok(q) = reached else { continue };
        let pose = robot.transform(&q);
        if let Some((line, before, from)) = &last {
            let change = q - before;
            followed.largest = followed.largest.max(change.amax());
            if let Some(jump) = jump(robot, [*line, point.line], before, &change, [from, &pose]) {
                followed.jumps.push((i, jump));
            }
        }
        last = Some((point.line, q, pose));
    }
    followed
}

/// A change of posture, if it is one: halfway in joint coordinates the tool is
/// off the middle by more than half of its own way (and 1 mm), or of its own
/// turn (and 5 degrees).
fn jump<const N: usize, R: Robot<N>>(
    robot: &R,
    lines: [usize; 2],
    before: &SVector<f64, N>,
    change: &SVector<f64, N>,
    [from, to]: [&Matrix4<f64>; 2],
) -> Option<Jump> {
    let halfway = robot.transform(&(before + change * 0.5));
    let way = (position(to) - position(from)).norm();
    let [first, last] = [from, to].map(orientation);
    let middle = Target {
        position: (position(from) + position(to)) * 0.5,
        orientation: Orientation::Full(first.try_slerp(&last, 0.5, 1e-9).unwrap_or(first).to_rotation_matrix()),
    };
    let off = middle.remaining(&halfway);
    let (turn, slack) = (first.angle_to(&last), 5_f64.to_radians());
    if off.distance <= 0.5 * way + 1e-3 && off.angle <= 0.5 * turn + slack {
        return None;
    }
    let turning = robot.joint_kinds();
    // A slide moves as far as a turn at the arm's end.
    let size = |i: usize| if turning[i] == JointKind::Revolute { change[i].abs() } else { change[i].abs() * 2.0 };
    let joint = (0..N).max_by(|&one, &other| size(one).total_cmp(&size(other)))?;
    Some(Jump { lines, joint: joint + 1, change: change[joint], off })
}

/// Where the TCP is (m).
pub fn position(pose: &Matrix4<f64>) -> Vector3<f64> {
    pose.fixed_view::<3, 1>(0, 3).into_owned()
}

fn orientation(pose: &Matrix4<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(pose.fixed_view::<3, 3>(0, 0).into_owned()))
}
