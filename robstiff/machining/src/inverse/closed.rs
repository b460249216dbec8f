//! What a search over many poses asks of the closed form: candidates that are not made exact, and
//! how far they are from where the arm is singular.

use core::f64::consts::{PI, TAU};

use nalgebra::SVector;
use robstiff_robots::description::ON_THE_LIMIT;

use super::carried::Closed;
use super::{Inverse, Orientation, Target, check};
use robstiff::{JointKind, Robot};

/// At so many places along its range the axis is tried that carries an arm.
const PLACES: usize = 9;

impl<R: Robot<N>, const N: usize> Inverse<'_, R, N> {
    /// Whether six axes with a closed form, or seven of which the first carries such, take every turn about a
    /// tool's axis.
    pub(crate) fn takes_every_turn(&self) -> bool {
        N >= 6 && self.wrist.is_some()
    }

    /// How many joints carry the arm that has the closed form.
    pub(crate) fn carriers(&self) -> usize {
        usize::from(self.wrist.as_ref().is_some_and(Closed::is_carried))
    }

    /// How far apart (rad or m) the places are at which a carried arm is tried; `None` where nothing carries it, or
    /// a rail without ends.
    pub(crate) fn carrier_step(&self) -> Option<f64> {
        let [low, high] = self.limits[0];
        let range = if self.is_endless(0) { TAU } else { high - low };
        (self.carriers() > 0 && range.is_finite() && range > 0.0).then(|| range / (PLACES - 1) as f64)
    }

    /// Coordinates with the axis that carries the arm all along its range, the others as they are given; those alone
    /// where nothing carries it.
    pub(crate) fn carried_along(&self, q: &SVector<f64, N>) -> Vec<SVector<f64, N>> {
        let Some(step) = self.carrier_step() else { return vec![*q] };
        let from = if self.is_endless(0) { -PI } else { self.limits[0][0] };
        (0..PLACES).map(|k| self.carried_to(q, from + step * k as f64)).collect()
    }

    /// Coordinates with the axis that carries the arm at another one, within its limits.
    pub(crate) fn carried_to(&self, q: &SVector<f64, N>, to: f64) -> SVector<f64, N> {
        let mut carried = *q;
        carried[0] = to.clamp(self.limits[0][0], self.limits[0][1]);
        carried
    }

    /// Changes of coordinates as angles (rad): a slide counts by the [`scale`](Self::scale).
    pub(crate) fn as_angles(&self, change: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::from_fn(|i, _| change[i] / self.scale_of(i))
    }

    fn scale_of(&self, joint: usize) -> f64 {
        if self.kinds[joint] == JointKind::Revolute { 1.0 } else { self.scale() }
    }

    /// The length (m) by which positions count as angles: a tool that moves by it moves the joints by
    /// about one radian.
    pub(crate) fn scale(&self) -> f64 {
        0.25 * self.reach
    }

    /// Hands over the postures of the closed form for a whole pose that are within the limits, each joint
    /// in each of its turns; one without limits in the turn nearest to zero. They are as near to the pose
    /// as the closed form gets. Where a joint may stand anywhere, it stands as in the seed.
    pub(crate) fn postures(&self, target: &Target, seed: &SVector<f64, N>, mut found: impl FnMut(SVector<f64, N>)) {
        self.closed(target, seed, |q| {
            if self.is_near(&target.remaining(&self.robot.transform(&q))) {
                self.in_every_turn(q, self.carriers(), &mut found);
            }
        });
    }

    /// The joints from one on in all their turns within the limits.
    fn in_every_turn(&self, q: SVector<f64, N>, joint: usize, found: &mut impl FnMut(SVector<f64, N>)) {
        if joint == N {
            return found(q);
        }
        let [low, high] = self.limits[joint];
        if self.is_endless(joint) {
            return self.in_every_turn(q, joint + 1, found);
        }
        let turns = |ends: f64| (ends - q[joint]) / TAU;
        let first = turns(low - ON_THE_LIMIT).ceil();
        let count = (turns(high + ON_THE_LIMIT).floor() - first + 1.0).max(0.0) as usize;
        for k in 0..count {
            let mut turned = q;
            turned[joint] += TAU * (first + k as f64);
            self.in_every_turn(turned, joint + 1, found);
        }
    }

    /// Whether a joint (from 0) turns without end.
    fn is_endless(&self, joint: usize) -> bool {
        self.kinds[joint] == JointKind::Revolute && !self.limits[joint].iter().all(|limit| limit.is_finite())
    }

    /// What the joints turn by from one posture to another, those without an end on the shorter way.
    pub(crate) fn change(&self, from: &SVector<f64, N>, to: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::from_fn(|i, _| self.change_of(i, from, to))
    }

    fn change_of(&self, joint: usize, from: &SVector<f64, N>, to: &SVector<f64, N>) -> f64 {
        let change = to[joint] - from[joint];
        if self.is_endless(joint) { change - TAU * (change / TAU).round() } else { change }
    }

    /// How far each joint is from the nearer of its limits, as an angle (rad); infinitely where it has none.
    pub(crate) fn to_limits(&self, q: &SVector<f64, N>) -> [f64; N] {
        core::array::from_fn(|i| (q[i] - self.limits[i][0]).min(self.limits[i][1] - q[i]) / self.scale_of(i))
    }

    /// The solution of the closed form for a whole pose that is nearest to a seed; `None` where there is
    /// none, or no closed form, or the orientation leaves something free. It looks no further.
    pub(crate) fn exactly(&self, target: &Target, seed: &SVector<f64, N>) -> Option<SVector<f64, N>> {
        if check(target, seed).is_err() || !matches!(target.orientation, Orientation::Full(_)) {
            return None;
        }
        self.nearest_closed(target, seed, |_, _| ())
    }

    /// The distances from where the arm is singular, each the sine of an angle with the sign of the side:
    /// of the wrist from the plane of the first axis, relative to the arm stretched out; of the elbow from
    /// straight; of the last axis from the plane of the fourth and fifth. The determinant of the Jacobian is
    /// their product times lengths. `None` without a closed form.
    pub(crate) fn openness(&self, q: &SVector<f64, N>) -> Option<[f64; 3]> {
        self.wrist.as_ref().map(|wrist| wrist.openness(q))
    }

    /// On which side of its singular places the arm is: a bit for each of [`openness`](Self::openness).
    pub(crate) fn side(&self, q: &SVector<f64, N>) -> u8 {
        let openness = self.openness(q).unwrap_or([1.0; 3]);
        openness.iter().enumerate().map(|(k, sine)| u8::from(*sine > 0.0) << k).sum()
    }

    /// Whether no joint turns by half a turn or more from one posture to another: from there both ways round
    /// are as far.
    pub(crate) fn is_within_half_a_turn(&self, one: &SVector<f64, N>, other: &SVector<f64, N>) -> bool {
        (0..N).all(|i| self.kinds[i] != JointKind::Revolute || self.change_of(i, one, other).abs() < PI)
    }
}
