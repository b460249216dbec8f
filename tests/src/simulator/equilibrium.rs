//! The equilibrium of a loaded arm in its deformed shape.

use nalgebra::Vector3;

use super::frame::{Frame, exp, log, work_on};

/// The springs have settled when none still moves by this much (rad or m).
const SETTLED: f64 = 1e-15;

/// Far more rounds than any load takes that the arm can carry at all.
const ROUNDS: usize = 500;

/// How a spring lets go.
#[derive(Clone, Copy, Debug)]
pub(super) enum Motion {
    /// By a finite turn, a rotation vector in the spring's frame.
    Turn,
    /// By a shift in the spring's frame.
    Slide,
}

/// How far a spring lets go under its generalised force.
#[derive(Clone, Copy, Debug)]
pub(super) enum Response {
    /// Compliance about or along x, y, z of the spring's frame (rad/Nm or m/N).
    Linear(Vector3<f64>),
    /// About or along z only, as the [`JointLaw`] says for this joint, from 0.
    Joint(usize),
}

/// A spring, and the rigid piece that leads to it.
#[derive(Clone, Debug)]
pub(super) struct Spring {
    /// The spring's frame in that of the spring before, as that one has moved.
    pub rod: Frame,
    pub motion: Motion,
    pub response: Response,
}

/// Deflection of the joints about their own axes under their torques.
#[derive(Clone, Debug)]
pub(super) struct JointLaw {
    compliances: Vec<f64>,
    /// Two joints and the entry of the compliance matrix they share.
    pub couplings: Vec<(usize, usize, f64)>,
    /// A joint, what its unloaded compliance has on top, and the knee torque.
    pub softenings: Vec<(usize, f64, f64)>,
}

impl JointLaw {
    pub fn new(compliances: Vec<f64>) -> Self {
        Self { compliances, couplings: Vec::new(), softenings: Vec::new() }
    }

    fn joints(&self) -> usize {
        self.compliances.len()
    }

    /// Joint deflections (rad or m) under the torques (Nm or N).
    fn deflections(&self, torques: &[f64], out: &mut [f64]) {
        for ((out, torque), compliance) in out.iter_mut().zip(torques).zip(&self.compliances) {
            *out = compliance * torque;
        }
        for &(one, other, value) in &self.couplings {
            out[one] += value * torques[other];
            out[other] += value * torques[one];
        }
        for &(joint, added, knee) in &self.softenings {
            let torque = torques[joint];
            out[joint] += added * torque / 1_f64.hypot(torque / knee);
        }
    }

    /// The integral of the deflections over the torques (J).
    fn complementary_energy(&self, torques: &[f64]) -> f64 {
        let straight: f64 = self.compliances.iter().zip(torques).map(|(h, torque)| 0.5 * h * torque * torque).sum();
        let coupled: f64 = self.couplings.iter().map(|&(i, j, value)| value * torques[i] * torques[j]).sum();
        let softened = |&(joint, added, knee): &(usize, f64, f64)| {
            added * knee * knee * (1_f64.hypot(torques[joint] / knee) - 1.0)
        };
        straight + coupled + self.softenings.iter().map(softened).sum::<f64>()
    }
}

/// Where a load has taken an arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// Deformed minus unloaded position of the TCP (m), in the base frame.
    pub displacement: [f64; 3],
    /// Rotation vector (rad), in the base frame, of the turn that takes the
    /// tool from its unloaded to its deformed orientation.
    pub rotation: [f64; 3],
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
    unloaded: Frame,
}

impl PosedArm {
    pub(super) fn new(springs: Vec<Spring>, end: Frame, law: JointLaw) -> Self {
        let mut arm = Self { springs, end, law, unloaded: Frame::identity() };
        let still = vec![Vector3::zeros(); arm.springs.len()];
        arm.unloaded = arm.walk(&still, &mut Vec::new());
        arm
    }

    /// The unloaded position of the TCP (m) in the base frame.
    pub fn tcp(&self) -> [f64; 3] {
        self.unloaded.origin.into()
    }

    /// The equilibrium under a wrench `[f; m]` (N, Nm) that keeps its
    /// components in the base frame and acts at the TCP, wherever that goes.
    ///
    /// # Panics
    ///
    /// Where the springs do not settle: the load is beyond what the arm can
    /// carry without buckling.
    pub fn settle(&self, wrench: &[f64; 6]) -> Equilibrium {
        let mut moved = vec![Vector3::zeros(); self.springs.len()];
        let mut next = moved.clone();
        let mut load = Load::new(wrench, self.springs.len(), self.law.joints());
        // An industrial arm's springs shift the load by about 1e-3 of its lever
        // arms, so letting the springs follow the load gains three digits a
        // round.
        for _ in 0..ROUNDS {
            self.generalised(&moved, &mut load);
            self.respond(&load, &mut next);
            let change = moved.iter().zip(&next).map(|(old, new)| (new - old).amax()).fold(0.0, f64::max);
            std::mem::swap(&mut moved, &mut next);
            if change < SETTLED {
                return self.equilibrium(&moved, &mut load);
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
            match spring.motion {
                Motion::Turn => frame.turn *= exp(by),
                Motion::Slide => frame.origin += frame.turn * by,
            }
        }
        frame.then(&self.end)
    }

    /// Virtual work of the load per change of every spring, in the shape that
    /// the springs have taken on: the moment about the spring as it stands, and
    /// the force along it.
    fn generalised(&self, moved: &[Vector3<f64>], load: &mut Load) {
        load.tcp = self.walk(moved, &mut load.frames);
        for (index, (spring, frame)) in self.springs.iter().zip(&load.frames).enumerate() {
            let work = match spring.motion {
                Motion::Turn => {
                    let moment = (load.tcp.origin - frame.origin).cross(&load.force) + load.moment;
                    work_on(&moved[index], &frame.turn.tr_mul(&moment))
                }
                Motion::Slide => frame.turn.tr_mul(&load.force),
            };
            load.generalised[index] = work;
            if let Response::Joint(joint) = spring.response {
                load.torques[joint] = work.z;
            }
        }
    }

    /// How far the springs let go under the generalised forces in `load`.
    fn respond(&self, load: &Load, out: &mut [Vector3<f64>]) {
        // A description has eight joints at most.
        let mut joints = [0.0; 8];
        let joints = &mut joints[..self.law.joints()];
        self.law.deflections(&load.torques, joints);
        for ((spring, work), out) in self.springs.iter().zip(&load.generalised).zip(out) {
            *out = match spring.response {
                Response::Linear(compliance) => compliance.component_mul(work),
                Response::Joint(joint) => Vector3::z() * joints[joint],
            };
        }
    }

    fn equilibrium(&self, moved: &[Vector3<f64>], load: &mut Load) -> Equilibrium {
        self.generalised(moved, load);
        let mut energy = -self.law.complementary_energy(&load.torques);
        for ((spring, work), by) in self.springs.iter().zip(&load.generalised).zip(moved) {
            energy += match spring.response {
                Response::Linear(_) => 0.5 * work.dot(by),
                Response::Joint(_) => work.z * by.z,
            };
        }
        Equilibrium {
            displacement: (load.tcp.origin - self.unloaded.origin).into(),
            rotation: log(&(load.tcp.turn * self.unloaded.turn.transpose())).into(),
            energy,
        }
    }
}

/// A load, and what it does to the springs in one shape of the arm.
struct Load {
    force: Vector3<f64>,
    moment: Vector3<f64>,
    frames: Vec<Frame>,
    tcp: Frame,
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
        arm.respond(&load, &mut moved);
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
