//! Inverse kinematics: the joint coordinates that bring the tool to a target.
//!
//! [`Inverse`] takes any [`Robot`]. Arms with a spherical wrist, or of five axes
//! whose last two meet, have a [closed form](Inverse::has_closed_form); its
//! candidates are made exact by a few steps of the others' way, damped least
//! squares on the robot's own Jacobian within the joints' limits, from the seed
//! and from starts all over the joint space. What the description corrects (DH
//! errors, zero offsets, transmission errors) is part of the robot, so that the
//! solutions are those of the robot as described.

mod base;
mod carried;
mod closed;
mod descent;
mod screws;
mod starts;
mod sweep;
mod target;
#[cfg(test)]
mod tests;
mod turns;
mod unreached;
mod wrist;

use core::f64::consts::TAU;

use nalgebra::SVector;
use robstiff_robots::description::ON_THE_LIMIT;

use carried::Closed;
use descent::{Bounds, End, descend};
use robstiff::{JointKind, Robot};
use starts::Starts;
pub use target::{Orientation, Remaining, Target};
pub use unreached::Unreached;
pub(crate) use wrist::Sides;

/// A solution is within this of its target (m, rad).
pub const TOLERANCE: f64 = 1e-10;

/// Candidates of a closed form within this (m, rad) need no further step.
const EXACT: f64 = 1e-12;

/// Candidates further off than this times the reach (m) or this (rad) are no
/// solutions: more than the errors of a measured table, or the step between the
/// turns that are tried, can account for.
const NEAR: f64 = 0.1;

/// The same where the closed form leaves nothing but rounding.
const EXACTLY_NEAR: f64 = 1e-6;

/// Solutions are the same when no joint differs by more (rad or m).
const SAME: f64 = 1e-6;

/// Starts of the descent for an arm without a closed form, and for one whose
/// closed form found nothing.
const STARTS: usize = 300;

/// The inverse kinematics of a robot.
#[derive(Clone, Debug)]
pub struct Inverse<'r, R, const N: usize> {
    robot: &'r R,
    kinds: [JointKind; N],
    limits: Bounds<N>,
    /// The size of the arm (m).
    reach: f64,
    wrist: Option<Closed<N>>,
    starts: Starts<N>,
}

impl<'r, R: Robot<N>, const N: usize> Inverse<'r, R, N> {
    /// The inverse kinematics of a robot, within its limits.
    pub fn new(robot: &'r R) -> Self {
        let limits = robot.limits().map(|limits| limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]));
        let reach = starts::reach(robot);
        let starts = Starts::new(robot, &limits, reach);
        Self { robot, kinds: robot.joint_kinds(), limits, reach, wrist: Closed::of(robot, reach), starts }
    }

    /// Whether the arm has a closed form: an axis, two parallel ones across it,
    /// and either three that meet in a point or, of five, two. Of seven axes the first may
    /// carry one of six.
    pub fn has_closed_form(&self) -> bool {
        self.wrist.is_some()
    }

    /// On which sides of its axes the arm is; `None` without a closed form.
    pub(crate) fn sides(&self, q: &SVector<f64, N>) -> Option<Sides> {
        self.wrist.as_ref().map(|wrist| wrist.sides(q))
    }

    /// The solution nearest to a seed: the one whose joints differ least, as
    /// the root of the sum of their squares (rad and m alike). Revolute joints
    /// with a range above a turn take the turn nearest to the seed.
    ///
    /// # Errors
    /// Why there is none.
    pub fn nearest(&self, target: &Target, seed: &SVector<f64, N>) -> Result<SVector<f64, N>, Unreached> {
        check(target, seed)?;
        if !self.is_exact(target) {
            // Down from the seed is the next solution, but not from far away.
            let end = self.descend(target, seed, &self.limits);
            if is_solved(&end) && (end.q - seed).amax() < 0.5 {
                return Ok(end.q);
            }
        }
        let mut outside = None;
        let best = self.nearest_closed(target, seed, |q, beyond| self.note(&mut outside, target, q, beyond));
        if let Some(q) = best {
            return Ok(q);
        }
        self.search(target, seed, outside, 1).map(|found| found[0])
    }

    /// The solution of the closed form that is nearest to a seed. Hands over the candidates outside the
    /// limits, with by how much they are and of which joint.
    fn nearest_closed(
        &self,
        target: &Target,
        seed: &SVector<f64, N>,
        mut outside: impl FnMut(&SVector<f64, N>, (f64, usize, f64)),
    ) -> Option<SVector<f64, N>> {
        let mut best: Option<(f64, SVector<f64, N>)> = None;
        self.closed(target, seed, |q| match self.within(&q, seed) {
            Ok(q) => {
                let far = (q - seed).norm_squared();
                if best.as_ref().is_none_or(|(least, _)| far < *least)
                    && let Some(q) = self.polished(target, &q)
                {
                    best = Some(((q - seed).norm_squared(), q));
                }
            }
            Err(beyond) => outside(&q, beyond),
        });
        best.map(|(_, q)| q)
    }

    /// Where a descent from the seed comes to rest within a tolerance (m, rad) of the target,
    /// which it need not reach: an arm of few joints can get only that near.
    pub(crate) fn near(&self, target: &Target, seed: &SVector<f64, N>, tolerance: f64) -> Option<SVector<f64, N>> {
        let End { q, remaining } = self.descend(target, seed, &self.limits);
        (remaining.distance < tolerance && remaining.angle < tolerance).then_some(q)
    }

    /// All solutions within the limits that were found, the nearest to the seed
    /// first, each in the turn nearest to the seed.
    ///
    /// Where the closed form gives the whole pose these are all there are, up to
    /// eight; where a joint may stand anywhere, it stands where the seed has it.
    /// Where the turn about the tool's axis is free, that turn is searched: for five
    /// axes all solutions are found but two so near to each other that the search
    /// steps over both; for six, which have a family of them, those of turns 3
    /// degrees apart. Other arms have what descents from all over the joint space
    /// found, a redundant arm a choice of them.
    ///
    /// # Errors
    /// Why there is none.
    pub fn all(&self, target: &Target, seed: &SVector<f64, N>) -> Result<Vec<SVector<f64, N>>, Unreached> {
        check(target, seed)?;
        let (mut solutions, mut outside) = (Vec::new(), None);
        for seed in self.carried_along(seed) {
            self.closed(target, &seed, |q| match self.within(&q, &seed) {
                Ok(q) => {
                    if let Some(q) = self.polished(target, &q) {
                        insert(&mut solutions, q, &self.kinds);
                    }
                }
                Err(beyond) => self.note(&mut outside, target, &q, beyond),
            });
        }
        if solutions.is_empty() {
            solutions =
                self.search(target, seed, outside, if self.wrist.is_some() && N <= 6 { 1 } else { usize::MAX })?;
        }
        solutions.sort_by(|one, other| (one - seed).norm_squared().total_cmp(&(other - seed).norm_squared()));
        Ok(solutions)
    }

    /// Whether the candidates of the closed form are all there can be.
    fn is_exact(&self, target: &Target) -> bool {
        let is_exact = match target.orientation {
            Orientation::Full(_) => N <= 6,
            Orientation::Axis { .. } => N == 5,
            Orientation::Free => false,
        };
        is_exact && self.wrist.is_some()
    }

    /// Whether a candidate of the closed form comes so near that it is worth a
    /// descent: a branch that does not reach the target is nowhere near it.
    fn is_near(&self, remaining: &Remaining) -> bool {
        let exactly = self.wrist.as_ref().is_some_and(|wrist| !wrist.only_near());
        let near = if exactly { EXACTLY_NEAR } else { NEAR };
        remaining.distance <= near * self.reach && remaining.angle <= near
    }

    fn closed(&self, target: &Target, seed: &SVector<f64, N>, found: impl FnMut(SVector<f64, N>)) {
        if let Some(wrist) = &self.wrist {
            wrist.candidates(target, seed, found);
        }
    }

    fn descend(&self, target: &Target, start: &SVector<f64, N>, bounds: &Bounds<N>) -> End<N> {
        descend(self.robot, target, start, bounds, 0.25 * self.reach)
    }

    /// A candidate made exact; `None` if it is no solution.
    fn polished(&self, target: &Target, q: &SVector<f64, N>) -> Option<SVector<f64, N>> {
        let remaining = target.remaining(&self.robot.transform(q));
        if remaining.distance < EXACT && remaining.angle < EXACT {
            return Some(*q);
        }
        if !self.is_near(&remaining) {
            return None;
        }
        let end = self.descend(target, q, &self.limits);
        is_solved(&end).then_some(end.q)
    }

    /// The coordinates in the turns nearest to the seed within the limits; or
    /// by how much, at least, they are outside, with the joint (from 0).
    fn within(&self, q: &SVector<f64, N>, seed: &SVector<f64, N>) -> Result<SVector<f64, N>, (f64, usize, f64)> {
        let mut turned = *q;
        let mut worst: Option<(f64, usize, f64)> = None;
        for i in 0..N {
            let [low, high] = self.limits[i];
            let mut value = q[i];
            if self.kinds[i] == JointKind::Revolute {
                value += TAU * ((seed[i] - value) / TAU).round();
                // By as many turns as it takes, and no further.
                if value > high + ON_THE_LIMIT {
                    value -= TAU * ((value - high - ON_THE_LIMIT) / TAU).ceil();
                } else if value < low - ON_THE_LIMIT {
                    value += TAU * ((low - ON_THE_LIMIT - value) / TAU).ceil();
                }
                // In a gap of the range, the end that is nearer.
                let other = value + if value > high { -TAU } else { TAU };
                if beyond(other, [low, high]) < beyond(value, [low, high]) {
                    value = other;
                }
            }
            let outside = beyond(value, [low, high]);
            if outside > ON_THE_LIMIT && worst.is_none_or(|(most, ..)| outside > most) {
                worst = Some((outside, i, value));
            }
            turned[i] = value;
        }
        worst.map_or(Ok(turned), Err)
    }

    /// Keeps the solution that is least outside the limits, if it is one.
    fn note(
        &self,
        outside: &mut Option<(f64, Unreached)>,
        target: &Target,
        q: &SVector<f64, N>,
        (by, joint, coordinate): (f64, usize, f64),
    ) {
        if outside.is_some_and(|(least, _)| least <= by) {
            return;
        }
        let remaining = target.remaining(&self.robot.transform(q));
        if !self.is_near(&remaining) {
            return;
        }
        let nearly = remaining.distance < 1e-6 * self.reach && remaining.angle < 1e-6;
        if nearly || is_solved(&self.descend(target, q, &unbounded())) {
            let limits = self.limits[joint];
            *outside =
                Some((by, Unreached::OutsideLimits { joint: joint + 1, kind: self.kinds[joint], coordinate, limits }));
        }
    }

    /// Descents from the seed and from starts all over the joint space, until
    /// `enough` solutions are there.
    fn search(
        &self,
        target: &Target,
        seed: &SVector<f64, N>,
        mut outside: Option<(f64, Unreached)>,
        enough: usize,
    ) -> Result<Vec<SVector<f64, N>>, Unreached> {
        let mut solutions = Vec::new();
        let mut nearest: Option<End<N>> = None;
        // A closed form that found every way to be outside the limits knows.
        let count = match (&self.wrist, &outside) {
            (Some(_), Some(_)) if self.is_exact(target) => 4,
            (Some(closed), _) if !closed.is_carried() => 40,
            _ => STARTS,
        };
        for start in core::iter::once(*seed).chain(self.starts.nearest_first(target, count, 0.25 * self.reach)) {
            let end = self.descend(target, &start, &self.limits);
            if is_solved(&end) {
                if let Ok(q) = self.within(&end.q, seed) {
                    insert(&mut solutions, q, &self.kinds);
                }
                if solutions.len() >= enough {
                    break;
                }
            } else if nearest.as_ref().is_none_or(|least| self.size(&end) < self.size(least)) {
                nearest = Some(end);
            }
        }
        if !solutions.is_empty() {
            return Ok(solutions);
        }
        let mut free: Option<End<N>> = None;
        if outside.is_none() {
            for start in core::iter::once(*seed).chain(self.starts.nearest_first(target, 8, 0.25 * self.reach)) {
                let end = self.descend(target, &start, &unbounded());
                if is_solved(&end)
                    && let Err(beyond) = self.within(&end.q, seed)
                {
                    self.note(&mut outside, target, &end.q, beyond);
                }
                if free.as_ref().is_none_or(|least| self.size(&end) < self.size(least)) {
                    free = Some(end);
                }
            }
        }
        if let Some((_, why)) = outside {
            return Err(why);
        }
        let remaining = nearest.or(free).map_or(Remaining { distance: f64::NAN, angle: f64::NAN }, |end| end.remaining);
        let beyond = (target.position - self.starts.origin()).norm() > self.starts.longest();
        Err(if beyond || self.is_exact(target) {
            Unreached::OutOfReach { remaining: free.map_or(remaining, |end| end.remaining) }
        } else {
            Unreached::NotConverged { remaining }
        })
    }

    /// How far an end is from its target, angles as at the end of the arm (m).
    fn size(&self, end: &End<N>) -> f64 {
        end.remaining.distance.hypot(end.remaining.angle * 0.25 * self.reach)
    }
}

/// No limits.
const fn unbounded<const N: usize>() -> Bounds<N> {
    [[f64::NEG_INFINITY, f64::INFINITY]; N]
}

fn is_solved<const N: usize>(end: &End<N>) -> bool {
    end.remaining.distance < TOLERANCE && end.remaining.angle < TOLERANCE
}

/// By how much a coordinate is outside its limits (rad or m).
fn beyond(value: f64, [low, high]: [f64; 2]) -> f64 {
    (low - value).max(value - high).max(0.0)
}

/// Adds a solution that is not there yet.
fn insert<const N: usize>(solutions: &mut Vec<SVector<f64, N>>, q: SVector<f64, N>, kinds: &[JointKind; N]) {
    let same = |other: &SVector<f64, N>| {
        (0..N).all(|i| {
            let apart = (q[i] - other[i]).abs();
            apart < SAME || (kinds[i] == JointKind::Revolute && (apart - TAU).abs() < SAME)
        })
    };
    if !solutions.iter().any(same) {
        solutions.push(q);
    }
}

fn check<const N: usize>(target: &Target, seed: &SVector<f64, N>) -> Result<(), Unreached> {
    let orientation = match &target.orientation {
        Orientation::Full(rotation) => rotation.matrix().iter().all(|entry| entry.is_finite()),
        Orientation::Axis { tool, direction } => tool.iter().chain(direction.iter()).all(|entry| entry.is_finite()),
        Orientation::Free => true,
    };
    let finite = orientation && target.position.iter().chain(seed.iter()).all(|entry| entry.is_finite());
    if finite { Ok(()) } else { Err(Unreached::NotFinite) }
}
