//! Where a load takes the tool, carried by the arm in its deformed shape.
//!
//! `H_x F` has the load act on the arm as it stands unloaded. An arm that has given
//! way carries it on other levers, and its parts have turned each other: under 200 kg
//! that is some 10 um of 5 mm, in proportion to the square of the load.
//!
//! Each part that yields moves all behind it by a screw of its own, so the tool goes
//! where their product takes it, `exp(x_1) exp(x_2) .. exp(x_m)` from base to tip, all
//! `x_k` in the axes of the unloaded arm (the product of exponentials; Murray, Li and
//! Sastry, A Mathematical Introduction to Robotic Manipulation, CRC Press 1994,
//! section 3.2). A part meets the load as it looks from its own, moved place: as the
//! wrench at the moved tool, taken back through the screws before it.

use std::vec::Vec;

use nalgebra::{Isometry3, Matrix4, Matrix6, SVector, Vector3, Vector6};

use super::laws::{plays, turns_under};
use super::{Pose, Spring, Torque, springs};
use crate::{Robot, State};

/// The arm is closer to its equilibrium by some 1e-3 with each pass, a very soft one
/// by 1e-2.
const PASSES: usize = 4;

/// A robot at rest under a load.
#[derive(Clone, Copy, Debug)]
pub struct Deformed<const N: usize> {
    /// The frame of the tool centre point in the base frame, 4 x 4.
    pub tcp: Matrix4<f64>,
    /// By how much each joint has turned (rad or m), as encoders behind the gears see.
    pub turns: SVector<f64, N>,
    /// What has moved the tool, as of [`Rest`].
    motion: Isometry3<f64>,
}

impl<const N: usize> Deformed<N> {
    /// The displacement `[d; r]` (m, rad) in the base frame of a point that is fixed to
    /// the tool, `lever` (m) away from the unloaded TCP along the base frame's axes.
    pub fn displacement_at(&self, lever: &Vector3<f64>) -> Vector6<f64> {
        displacement_at(&self.motion, lever)
    }
}

/// Where a robot comes to rest at joint coordinates `q` [rad or m] under a load that
/// hangs at its tool: `load` is the wrench `[f; m]` (N, Nm) in the base frame, about
/// the tool centre point, for each frame of that. The load follows those in `state`,
/// which it joins, as for [`Robot::deflection_with`]. Exact but for links, which are
/// one screw each however they bend.
pub fn deformed<const N: usize>(
    robot: &impl Robot<N>,
    q: &SVector<f64, N>,
    load: impl Fn(&Matrix4<f64>) -> Vector6<f64>,
    state: &mut State<N>,
) -> Deformed<N> {
    let tcp = robot.transform(q);
    let wrench = |motion: &Isometry3<f64>| load(&moved(&tcp, motion));
    let laws = |torques: &[f64]| turns_under(robot, q, &SVector::from_column_slice(torques), state).as_slice().to_vec();
    let Rest { motion, torques, turns } = at_rest(&parts(robot, q), wrench, laws);
    let preload = robot.preload(q);
    for effect in robot.effects() {
        if let Some(joint) = effect.row().map(|row| row - 1) {
            let torque = Torque { preload: preload[joint], load: torques[joint] };
            state.plays[joint] = plays(effect, torque, state.plays[joint]);
        }
    }
    Deformed { tcp: moved(&tcp, &motion), turns: SVector::from_column_slice(&turns), motion }
}

/// What yields.
#[expect(clippy::large_enum_variant, reason = "there are a dozen, for a moment")]
pub enum Part {
    /// A joint, from 0, with the twist of the TCP per unit of its turn.
    Joint(usize, Vector6<f64>),
    /// Anything else, with what it adds to the compliance at the TCP.
    Spring(Matrix6<f64>),
}

/// Parts at rest under a load.
pub struct Rest {
    /// The motion of the tool, about the place of the unloaded TCP and along the axes of
    /// the base frame.
    pub motion: Isometry3<f64>,
    /// The torques of the joints (Nm or N).
    pub torques: Vec<f64>,
    /// Their turns (rad or m).
    pub turns: Vec<f64>,
}

/// Where parts from base to tip come to rest: `load` is the wrench at the moved TCP, in
/// the base frame, for each motion of it, `turns_under` gives the turns of the joints
/// under their torques.
pub fn at_rest(
    parts: &[Part],
    load: impl Fn(&Isometry3<f64>) -> Vector6<f64>,
    turns_under: impl Fn(&[f64]) -> Vec<f64>,
) -> Rest {
    let joints = parts.iter().filter(|part| matches!(part, Part::Joint(..))).count();
    let mut screws = std::vec![Vector6::zeros(); parts.len()];
    let (mut torques, mut turns) = (std::vec![0.0; joints], Vec::new());
    for _ in 0..PASSES {
        let (half_way, whole) = walk(&screws);
        let wrench = load(&whole);
        let force: Vector3<f64> = wrench.fixed_rows::<3>(0).into_owned();
        let moment = whole.translation.vector.cross(&force) + wrench.fixed_rows::<3>(3);
        let met: Vec<Vector6<f64>> = half_way.iter().map(|motion| taken_back(motion, &force, &moment)).collect();
        for (part, met) in parts.iter().zip(&met) {
            if let Part::Joint(joint, twist) = part {
                torques[*joint] = twist.dot(met);
            }
        }
        turns = turns_under(&torques);
        for ((part, met), screw) in parts.iter().zip(&met).zip(&mut screws) {
            *screw = match part {
                Part::Joint(joint, twist) => twist * turns[*joint],
                Part::Spring(compliance) => compliance * met,
            };
        }
    }
    Rest { motion: walk(&screws).1, torques, turns }
}

/// The motion of each part when it has gone half its way, which is where it meets its
/// load on average, and of all behind the last.
fn walk(screws: &[Vector6<f64>]) -> (Vec<Isometry3<f64>>, Isometry3<f64>) {
    let mut before = Isometry3::identity();
    let half_way = |screw: &Vector6<f64>| {
        let half = along(&(screw / 2.0));
        let met = before * half;
        before = met * half;
        met
    };
    (screws.iter().map(half_way).collect(), before)
}

/// All parts from base to tip. Couplings and laws are those of joints.
fn parts<const N: usize>(robot: &impl Robot<N>, q: &SVector<f64, N>) -> Vec<Part> {
    let pose = Pose::of(robot, q);
    let geometry = pose.geometry();
    // Before, at, and behind the axis of a joint, counted from 1.
    let mut parts: Vec<((usize, usize), Part)> =
        (0..N).map(|joint| ((joint + 1, 1), Part::Joint(joint, geometry.joint_twist(joint + 1)))).collect();
    for (spring, value) in robot.effects().iter().flat_map(springs) {
        let at = match spring {
            Spring::BaseTilt | Spring::BaseTranslation => (0, 0),
            Spring::Transverse(joint) => (joint, 0),
            Spring::LinkBending(link) | Spring::LinkTorsion(link) => (link, 2),
            Spring::ToolRotation | Spring::ToolTranslation => (N + 1, 0),
            Spring::Joint(_) | Spring::Coupling(_) => continue,
        };
        parts.push((at, Part::Spring(geometry.unit_compliance(spring) * value)));
    }
    parts.sort_by_key(|(at, _)| *at);
    parts.into_iter().map(|(_, part)| part).collect()
}

/// The motion by a screw `[d; r]` of finite size: its exponential, the shift by the
/// series up to the angle's third power.
fn along(screw: &Vector6<f64>) -> Isometry3<f64> {
    let (shift, turn): (Vector3<f64>, Vector3<f64>) =
        (screw.fixed_rows::<3>(0).into_owned(), screw.fixed_rows::<3>(3).into_owned());
    let once = turn.cross(&shift);
    let twice = turn.cross(&once);
    Isometry3::new(shift + once / 2.0 + twice / 6.0 + turn.cross(&twice) / 24.0, turn)
}

/// A wrench as what has moved so meets it.
fn taken_back(motion: &Isometry3<f64>, force: &Vector3<f64>, moment: &Vector3<f64>) -> Vector6<f64> {
    let moment = moment - motion.translation.vector.cross(force);
    let [force, moment] = [*force, moment].map(|vector| motion.rotation.inverse_transform_vector(&vector));
    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

/// What a motion displaces a point by, and turns it, `lever` away from the place of the
/// unloaded TCP.
pub fn displacement_at(motion: &Isometry3<f64>, lever: &Vector3<f64>) -> Vector6<f64> {
    let moved = motion.translation.vector + motion.rotation * lever - lever;
    let turned = motion.rotation.scaled_axis();
    Vector6::new(moved.x, moved.y, moved.z, turned.x, turned.y, turned.z)
}

/// The frame of the TCP, moved.
fn moved(tcp: &Matrix4<f64>, motion: &Isometry3<f64>) -> Matrix4<f64> {
    let turn = motion.rotation.to_rotation_matrix();
    let mut moved = *tcp;
    moved.fixed_view_mut::<3, 3>(0, 0).copy_from(&(turn.matrix() * tcp.fixed_view::<3, 3>(0, 0)));
    moved.fixed_view_mut::<3, 1>(0, 3).copy_from(&(tcp.fixed_view::<3, 1>(0, 3) + motion.translation.vector));
    moved
}
