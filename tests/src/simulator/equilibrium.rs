//! The equilibrium of a loaded arm in its deformed shape.

use nalgebra::{Matrix3, Vector3};

use super::encoders::{MOST_JOINTS, Turns};
use super::frame::{Frame, log, work_on};
use super::gear::{JointLaw, Memory, Moment};
use super::spring::{Motion, Response, Spring};

/// The springs have settled when none still moves by this much (rad or m).
const SETTLED: f64 = 1e-15;

/// A load that is read as soon as it is on, in the cold.
const AT_ONCE: Moment = Moment { held: 0.0, warmer: 0.0 };

/// One that has been on for longer than anything takes to come to rest.
const AT_LAST: Moment = Moment { held: f64::MAX, warmer: 0.0 };

/// Far more rounds than any load takes that the arm can carry at all.
const ROUNDS: usize = 500;

/// What pulls at the arm besides the load.
#[derive(Clone, Copy, Debug)]
pub(super) enum Pull {
    /// A force (N) of one direction in the base frame.
    Weight(Vector3<f64>),
    /// A spring to a point (m) that does not move: its stiffness (N/m), and its
    /// length (m) without force, below which it hangs loose.
    Stay { anchor: Vector3<f64>, stiffness: f64, length: f64 },
}

/// A point of the arm that something pulls at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Attached {
    /// How many springs carry it.
    pub after: usize,
    /// Where it is in the frame of the last of these, as that one has moved
    /// (m); in the base frame where there is none.
    pub at: Vector3<f64>,
    pub pull: Pull,
}

/// Where a load has taken an arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// Deformed minus unloaded position of the TCP (m), in the base frame.
    pub displacement: [f64; 3],
    /// Rotation vector (rad), in the base frame, of the turn that takes the
    /// tool from its unloaded to its deformed orientation.
    pub rotation: [f64; 3],
    /// By how much each joint has turned, its motor included.
    pub joints: Turns,
    /// By how much each motor has.
    pub motors: Turns,
    /// Energy in all the springs (J).
    pub energy: f64,
}

/// An arm at one pose: the chain of rigid pieces and springs.
#[derive(Clone, Debug)]
pub struct PosedArm {
    springs: Vec<Spring>,
    /// The TCP's frame in that of the last spring, as that one has moved.
    end: Frame,
    law: JointLaw,
    attached: Vec<Attached>,
    /// Where the load acts, in the TCP's frame (m).
    lever: Vector3<f64>,
    /// The TCP's frame where nothing has given way yet.
    rigid: Frame,
    /// The TCP's frame without a load.
    unloaded: Frame,
    /// By how much joints and motors are turned without a load.
    still: [Turns; 2],
}

impl PosedArm {
    pub(super) fn new(
        springs: Vec<Spring>,
        end: Frame,
        law: JointLaw,
        attached: Vec<Attached>,
        lever: Vector3<f64>,
    ) -> Self {
        let still = vec![Vector3::zeros(); springs.len()];
        let mut arm = Self {
            springs,
            end,
            law,
            attached,
            lever,
            rigid: Frame::identity(),
            unloaded: Frame::identity(),
            still: [[0.0; MOST_JOINTS]; 2],
        };
        arm.rigid = arm.walk(&still, &mut Vec::new());
        arm.unloaded = arm.rigid;
        if !arm.attached.is_empty() {
            let (moved, load) = arm.settled(&[0.0; 6], &arm.law.fresh(), AT_LAST);
            arm.unloaded = load.tcp;
            arm.still = arm.turned(&moved, &load);
        }
        arm
    }

    /// The unloaded position of the TCP (m) in the base frame.
    pub fn tcp(&self) -> [f64; 3] {
        self.unloaded.origin.into()
    }

    /// What the arm's own weight, or what else pulls at it, has moved the
    /// unloaded TCP by (m), in the base frame.
    pub fn sag(&self) -> [f64; 3] {
        (self.unloaded.origin - self.rigid.origin).into()
    }

    /// The unloaded tool's axes x, y, z in the base frame.
    pub fn axes(&self) -> [[f64; 3]; 3] {
        self.unloaded.turn.into()
    }

    /// The same as columns.
    pub(super) fn tool(&self) -> Matrix3<f64> {
        self.unloaded.turn
    }

    /// The equilibrium under a wrench `[f; m]` (N, Nm) that keeps its
    /// components in the base frame and acts at the TCP, wherever that goes;
    /// joints with a memory have seen no load before.
    ///
    /// # Panics
    ///
    /// Where the springs do not settle: the load is beyond what the arm can
    /// carry without buckling.
    pub fn settle(&self, wrench: &[f64; 6]) -> Equilibrium {
        self.settle_after(wrench, &mut self.rested(), AT_ONCE)
    }

    /// The memory of joints that stand unloaded, long since come to rest.
    pub fn rested(&self) -> Memory {
        let mut memory = self.law.fresh();
        self.settle_after(&[0.0; 6], &mut memory, AT_LAST);
        memory
    }

    /// The equilibrium as in [`settle`](Self::settle), after the loads that
    /// `memory` has seen, which sees this one, too. Joints are taken to go
    /// straight from their last torque to this one.
    ///
    /// # Panics
    ///
    /// Where the springs do not settle.
    pub fn settle_after(&self, wrench: &[f64; 6], memory: &mut Memory, moment: Moment) -> Equilibrium {
        let (moved, load) = self.settled(wrench, memory, moment);
        self.law.remember(&load.torques, memory, moment);
        let mut energy = -self.law.complementary_energy(&load.torques);
        for ((spring, work), by) in self.springs.iter().zip(&load.generalised).zip(&moved) {
            energy += work.dot(by) - spring.response.alone(work).1;
        }
        let [joints, motors] = [0, 1].map(|which| {
            let (turned, still) = (self.turned(&moved, &load)[which], self.still[which]);
            std::array::from_fn(|joint| turned[joint] - still[joint])
        });
        Equilibrium {
            joints,
            motors,
            displacement: (load.tcp.origin - self.unloaded.origin).into(),
            rotation: log(&(load.tcp.turn * self.unloaded.turn.transpose())).into(),
            energy,
        }
    }

    /// By how much joints and motors have turned.
    fn turned(&self, moved: &[Vector3<f64>], load: &Load) -> [Turns; 2] {
        let mut joints = [0.0; MOST_JOINTS];
        for (spring, by) in self.springs.iter().zip(moved) {
            if let Response::Joint(joint) = spring.response {
                joints[joint] += by.z;
            }
        }
        [joints, self.law.of_motors(&load.torques)]
    }

    /// How far every spring has let go, and what the load does to it there.
    fn settled(&self, wrench: &[f64; 6], memory: &Memory, moment: Moment) -> (Vec<Vector3<f64>>, Load) {
        let mut moved = vec![Vector3::zeros(); self.springs.len()];
        let mut next = moved.clone();
        let mut load = Load::new(wrench, self.springs.len(), self.law.joints());
        // An industrial arm's springs shift the load by about 1e-3 of its lever
        // arms, so letting the springs follow the load gains three digits a
        // round.
        for _ in 0..ROUNDS {
            self.generalised(&moved, &mut load);
            self.respond(&load, memory, moment, &mut next);
            let change = moved.iter().zip(&next).map(|(old, new)| (new - old).amax()).fold(0.0, f64::max);
            std::mem::swap(&mut moved, &mut next);
            if change < SETTLED {
                self.generalised(&moved, &mut load);
                return (moved, load);
            }
        }
        panic!("the arm does not settle under {wrench:?}")
    }

    /// Frames of all springs before they let go, into `frames`, and the TCP's.
    fn walk(&self, moved: &[Vector3<f64>], frames: &mut Vec<Frame>) -> Frame {
        frames.clear();
        let mut frame = Frame::identity();
        for (spring, by) in self.springs.iter().zip(moved) {
            frame = frame.then(&spring.rod);
            frames.push(frame);
            frame = spring.let_go(&frame, by);
        }
        frame.then(&self.end)
    }

    /// Virtual work of the load per change of every spring, in the shape that
    /// the springs have taken on: the moment about the spring as it stands, and
    /// the force along it.
    fn generalised(&self, moved: &[Vector3<f64>], load: &mut Load) {
        load.tcp = self.walk(moved, &mut load.frames);
        load.pulls.clear();
        load.pulls.push((self.springs.len(), load.tcp.origin + load.tcp.turn * self.lever, load.force));
        for attached in &self.attached {
            let carrier = match attached.after.checked_sub(1) {
                Some(last) => self.springs[last].let_go(&load.frames[last], &moved[last]),
                None => Frame::identity(),
            };
            let point = carrier.origin + carrier.turn * attached.at;
            let force = match attached.pull {
                Pull::Weight(force) => force,
                Pull::Stay { anchor, stiffness, length } => {
                    let along = anchor - point;
                    along * (stiffness * (1.0 - length / along.norm()).max(0.0))
                }
            };
            load.pulls.push((attached.after, point, force));
        }
        for (index, (spring, frame)) in self.springs.iter().zip(&load.frames).enumerate() {
            let carried = load.pulls.iter().filter(|(after, ..)| *after > index);
            let work = match spring.motion {
                Motion::Turn => {
                    let moments = carried.map(|(_, point, force)| (point - frame.origin).cross(force));
                    let moment = moments.fold(load.moment, |sum, one| sum + one);
                    work_on(&moved[index], &frame.turn.tr_mul(&moment))
                }
                Motion::Slide => {
                    let force: Vector3<f64> = carried.map(|(.., force)| force).sum();
                    frame.turn.tr_mul(&force)
                }
            };
            load.generalised[index] = work;
            if let Response::Joint(joint) = spring.response {
                load.torques[joint] = work.z;
            }
        }
    }

    /// How far the springs let go under the generalised forces in `load`.
    fn respond(&self, load: &Load, memory: &Memory, moment: Moment, out: &mut [Vector3<f64>]) {
        // A description has eight joints at most.
        let mut joints = [0.0; 8];
        let joints = &mut joints[..self.law.joints()];
        self.law.deflections(&load.torques, memory, moment, joints);
        for ((spring, work), out) in self.springs.iter().zip(&load.generalised).zip(out) {
            *out = match spring.response {
                Response::Joint(joint) => Vector3::z() * joints[joint],
                response => response.alone(work).0,
            };
        }
    }
}

/// A load, and what it does to the springs in one shape of the arm.
struct Load {
    force: Vector3<f64>,
    moment: Vector3<f64>,
    frames: Vec<Frame>,
    tcp: Frame,
    /// Every force: how many springs carry its point, the point, the force.
    pulls: Vec<(usize, Vector3<f64>, Vector3<f64>)>,
    generalised: Vec<Vector3<f64>>,
    /// The generalised forces of the joints, in the joints' order (Nm or N).
    torques: Vec<f64>,
}

impl Load {
    fn new(wrench: &[f64; 6], springs: usize, joints: usize) -> Self {
        let [fx, fy, fz, mx, my, mz] = *wrench;
        Self {
            force: Vector3::new(fx, fy, fz),
            moment: Vector3::new(mx, my, mz),
            frames: Vec::with_capacity(springs),
            tcp: Frame::identity(),
            pulls: Vec::new(),
            generalised: vec![Vector3::zeros(); springs],
            torques: vec![0.0; joints],
        }
    }
}

#[cfg(test)]
mod tests {
    use robstiff_robots::Effect;

    use super::super::{Arm, six_axis};
    use super::*;

    /// The springs' displacement `[d; r]` of the TCP per change of each of
    /// their three components, by differences of whole walks.
    fn rates(arm: &PosedArm) -> Vec<[[f64; 6]; 3]> {
        let step = 1e-5;
        let walk = |spring: usize, axis: usize, by: f64| {
            let mut moved = vec![Vector3::zeros(); arm.springs.len()];
            moved[spring][axis] = by;
            arm.walk(&moved, &mut Vec::new())
        };
        let rate = |spring: usize, axis: usize| {
            let (ahead, behind) = (walk(spring, axis, step), walk(spring, axis, -step));
            let shift = (ahead.origin - behind.origin) / (2.0 * step);
            let turn = log(&(ahead.turn * behind.turn.transpose())) / (2.0 * step);
            [shift.x, shift.y, shift.z, turn.x, turn.y, turn.z]
        };
        (0..arm.springs.len()).map(|spring| std::array::from_fn(|axis| rate(spring, axis))).collect()
    }

    #[test]
    fn small_loads_are_the_linear_limit() {
        let effects = [
            Effect::TransverseCompliance { joint: 3, value: 6e-7 },
            Effect::LinkCompliance { link: 2, bending: 7e-8, torsion: 1.2e-7 },
            Effect::BaseCompliance { tilt: 2e-8, translation: 3e-9 },
            Effect::ToolCompliance { rotation: 3e-7, translation: 1e-8 },
            Effect::JointCoupling { joints: [4, 6], value: 1e-6 },
        ];
        let arm = Arm::new(&six_axis(), &effects).at(&[0.4, -1.1, 0.7, 0.9, -0.8, 1.3]);
        let rates = rates(&arm);
        let wrench = [0.6, -0.8, 0.5, 0.3, -0.2, 0.4];
        // Virtual work through the rates, the springs' laws, and the rates back.
        let mut load = Load::new(&wrench, arm.springs.len(), arm.law.joints());
        for (index, (spring, rate)) in arm.springs.iter().zip(&rates).enumerate() {
            let work = rate.map(|rate| rate.iter().zip(&wrench).map(|(rate, load)| rate * load).sum());
            load.generalised[index] = Vector3::from(work);
            if let Response::Joint(joint) = spring.response {
                load.torques[joint] = work[2];
            }
        }
        let mut moved = vec![Vector3::zeros(); arm.springs.len()];
        arm.respond(&load, &arm.law.fresh(), AT_ONCE, &mut moved);
        let ahead = arm.settle(&wrench);
        let behind = arm.settle(&wrench.map(|component| -component));
        for axis in 0..6 {
            let pick = |settled: &Equilibrium| [settled.displacement, settled.rotation].concat()[axis];
            let linear: f64 =
                rates.iter().zip(&moved).flat_map(|(rate, by)| (0..3).map(move |k| rate[k][axis] * by[k])).sum();
            let limit = (pick(&ahead) - pick(&behind)) / 2.0;
            assert!((limit - linear).abs() < 1e-8 * linear.abs(), "{axis}: {limit} {linear}");
        }
    }
}
