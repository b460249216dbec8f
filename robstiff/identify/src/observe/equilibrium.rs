//! What large loads make of an arm's shape: it carries them on other levers once it has yielded.
//!
//! The joints' own springs in equilibrium, less what they yield about the unloaded arm: some 0.2 % of
//! it under 800 N. What else yields is small against them, and its second order is neglected.

use nalgebra::{Rotation3, Vector3, Vector6};
use robstiff::JointKind;

use crate::model::{Parameter, Spring, Stand, Term, World};

/// An arm is closer to its equilibrium by a factor of some thousand with each pass.
const PASSES: usize = 3;

/// What an arm in equilibrium yields more than about its unloaded shape.
pub struct Beyond {
    /// The displacement and the turn `[d; r]` of the point that is read, in the base frame (m, rad).
    pub moved: Vector6<f64>,
    /// The turn of each joint (from 0; rad or m).
    pub turns: Vec<f64>,
}

/// The compliance of each joint's own spring (rad/Nm or m/N).
pub fn own_springs(parameters: &[Parameter], values: &[f64], joints: usize) -> Vec<f64> {
    let mut own = vec![0.0; joints];
    for (parameter, &value) in parameters.iter().zip(values) {
        if let Term::Spring(Spring::Joint(joint)) = parameter.term {
            own[joint - 1] += value.max(0.0);
        }
    }
    own
}

/// The second order of the joints' own springs on an arm that stands at `rest` without its load, with
/// coordinates `q` and joints aside by `aside`; `wrench` is that of the load at the tool centre point
/// there, `twists` the columns of the Jacobian. The force keeps its direction, its point goes with the tool.
pub fn beyond_linear(
    world: &World,
    (kinds, own): (&[JointKind], &[f64]),
    (rest, q, aside): (&Stand, &[f64], &[Vector3<f64>]),
    wrench: &Vector6<f64>,
    twists: &[Vector6<f64>],
) -> Beyond {
    let (force, moment) = (wrench.fixed_rows::<3>(0).into_owned(), wrench.fixed_rows::<3>(3).into_owned());
    let lever = world.rig.wrench_at + world.rig.lever;
    let alone: Vector3<f64> = moment - (rest.tcp.turn * lever).cross(&force);
    let turns = |stand: &Stand| -> Vec<f64> {
        let moment = alone + (stand.tcp.turn * lever).cross(&force);
        let wrench = Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
        let turn =
            |joint: usize| own[joint] * stand.joint_screw(joint, kinds[joint]).twist_at(&stand.tcp.at).dot(&wrench);
        (0..own.len()).map(turn).collect()
    };
    let linear = turns(rest);
    let mut turned = linear.clone();
    let mut stand = rest.clone();
    for _ in 0..PASSES {
        let moved: Vec<f64> = q.iter().zip(&turned).map(|(q, turn)| q + turn).collect();
        stand = world.arm.stand(&moved, aside);
        turned = turns(&stand);
    }
    let twist: Vector6<f64> = twists.iter().zip(&linear).map(|(twist, turn)| twist * *turn).sum();
    let marker = world.rig.marker(&rest.tcp);
    let turn: Vector3<f64> = twist.fixed_rows::<3>(3).into_owned();
    let d = stand.tcp.at + world.rig.marker(&stand.tcp) - rest.tcp.at - marker;
    let d = d - twist.fixed_rows::<3>(0) - turn.cross(&marker);
    let r = Rotation3::from_matrix_unchecked(stand.tcp.turn * rest.tcp.turn.transpose()).scaled_axis() - turn;
    let turns = turned.iter().zip(&linear).map(|(turned, linear)| turned - linear).collect();
    Beyond { moved: Vector6::new(d.x, d.y, d.z, r.x, r.y, r.z), turns }
}
