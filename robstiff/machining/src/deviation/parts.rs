//! What each joint and effect gives to a displacement.

use nalgebra::{SVector, Vector6};

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
