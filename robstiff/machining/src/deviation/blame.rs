//! Which joints and effects a displacement comes from.

use nalgebra::{SVector, Vector6};

use super::{Deviation, Load};
use crate::path::SolvedPath;
use robstiff::elements::{Element, Pose, Spring, Torque, plays, springs, turn};
use robstiff::{Robot, State};

/// What each joint and then each effect gives to the displacement of the TCP under
/// a wrench (m, rad in the base frame), in the order of the description; the sum is
/// [`Robot::deflection_with`]. Beyond
/// [`contributions`](robstiff::elements::contributions) it knows the nonlinear effects.
pub fn parts<'r, const N: usize, R: Robot<N>>(
    robot: &'r R,
    q: &SVector<f64, N>,
    wrench: &Vector6<f64>,
    state: &mut State<N>,
) -> impl Iterator<Item = (Element<'r>, Vector6<f64>)> + use<'r, N, R> {
    let (pose, own, preload) = (Pose::of(robot, q), robot.joint_compliance(), robot.preload(q));
    let geometry = pose.geometry();
    let joint = |i: usize| geometry.unit_compliance(Spring::Joint(i + 1)) * wrench * own[i];
    let mut found: Vec<_> = (0..N).map(|i| (Element::Joint(i + 1), joint(i))).collect();
    for effect in robot.effects() {
        let mut part = Vector6::zeros();
        for (spring, value) in springs(effect) {
            part += geometry.unit_compliance(spring) * wrench * value;
        }
        if let Some(i) = effect.row().map(|joint| joint - 1) {
            let twist = geometry.joint_twist(i + 1);
            let torque = Torque { preload: preload[i], load: twist.dot(wrench) };
            state.plays[i] = plays(effect, torque, state.plays[i]);
            part += twist * turn(effect, own[i], q[i], torque, state.plays[i]).unwrap_or_default();
        }
        found.push((Element::Effect(effect), part));
    }
    found.into_iter()
}

/// Which share of the surface error comes from each joint and effect, the largest
/// first; over the points of a deviation that `counts` picks by their index. Each
/// point counts with the size of its error, and what works against the error
/// counts negative. The sum is 1; empty where there is no error.
pub fn blame<'r, const N: usize>(
    robot: &'r impl Robot<N>,
    path: &SolvedPath<N>,
    load: &Load,
    deviation: &Deviation,
    counts: impl Fn(usize) -> bool,
) -> Vec<(Element<'r>, f64)> {
    let mut state = State::new();
    let mut shares: Vec<(Element<'r>, f64)> = Vec::new();
    for (i, (point, found)) in path.points.iter().zip(&deviation.points).enumerate() {
        let parts = parts(robot, &point.q, &found.wrench, &mut state);
        let (Some(into), Some(error), true) = (load.contacts[i].into, found.error, counts(i)) else { continue };
        for (k, (element, part)) in parts.enumerate() {
            let share = error.signum() * into.dot(&part.fixed_rows::<3>(0));
            match shares.get_mut(k) {
                Some((_, sum)) => *sum += share,
                None => shares.push((element, share)),
            }
        }
    }
    let whole: f64 = shares.iter().map(|(_, share)| share).sum();
    if whole <= 0.0 {
        return Vec::new();
    }
    shares.iter_mut().for_each(|(_, share)| *share /= whole);
    shares.sort_by(|(_, one), (_, other)| other.total_cmp(one));
    shares
}
