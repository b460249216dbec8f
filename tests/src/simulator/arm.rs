//! An arm put together from rigid bodies and springs.

use nalgebra::Vector3;
use robstiff_robots::{Convention, Description, Effect, JointKind};

use super::equilibrium::{Equilibrium, JointLaw, Motion, PosedArm, Response, Spring};
use super::frame::Frame;

/// Segments a bending link is divided into where nothing else is said.
///
/// Each segment carries two springs, at its Gauss points: any number of
/// segments then has exactly the beam's compliance under small loads (its
/// moment is linear along it, and the work quadratic), and more segments only
/// follow the curve of a strongly bent beam better.
pub const SEGMENTS: usize = 4;

/// An arm with all its springs, those of its description and hidden ones.
#[derive(Clone, Debug)]
pub struct Arm {
    description: Description,
    /// The description's effects and the hidden ones.
    effects: Vec<Effect>,
    segments: usize,
}

impl Arm {
    /// The arm of a description, its effects and the `hidden` ones together;
    /// effects at the same place add up.
    ///
    /// # Panics
    ///
    /// Where an effect does not fit the arm: no such joint or link, a coupling
    /// that leaves the joints' compliance not positive definite or ties sliding
    /// joints, a gear that would turn against its torque.
    pub fn new(description: &Description, hidden: &[Effect]) -> Self {
        let effects: Vec<_> = description.effects.iter().chain(hidden).copied().collect();
        for effect in &effects {
            assert!(fits(description, effect), "{effect} with {effect:?} does not fit {}", description.name);
        }
        Self { description: description.clone(), effects, segments: SEGMENTS }
    }

    /// Whether the simulator knows the effects of a description.
    pub fn knows(description: &Description) -> bool {
        description.effects.iter().all(|effect| fits(description, effect))
    }

    /// The same arm with its bending links divided into so many segments.
    ///
    /// # Panics
    ///
    /// For no segments.
    pub fn with_segments(self, segments: usize) -> Self {
        assert!(segments > 0, "a beam has at least one segment");
        Self { segments, ..self }
    }

    /// The unloaded position of the TCP (m) in the base frame at the joint
    /// coordinates `q` (rad or m).
    pub fn tcp(&self, q: &[f64]) -> [f64; 3] {
        self.at(q).tcp()
    }

    /// What a wrench `[f; m]` (N, Nm) in the base frame, at the TCP, does to
    /// the arm at the joint coordinates `q` (rad or m); see
    /// [`PosedArm::settle`]. For several loads at one pose, [`at`](Self::at)
    /// builds the chain only once.
    pub fn deflect(&self, q: &[f64], wrench: &[f64; 6]) -> Equilibrium {
        self.at(q).settle(wrench)
    }

    /// The arm standing, unloaded, at the joint coordinates `q` (rad or m).
    ///
    /// # Panics
    ///
    /// Where `q` is not one coordinate a joint, or a bending link has no length.
    pub fn at(&self, q: &[f64]) -> PosedArm {
        let joints = &self.description.joints;
        assert_eq!(q.len(), joints.len(), "one coordinate a joint");
        let mut chain = Chain { springs: Vec::new(), rod: Frame::placed(&self.description.base) };
        self.foundation(&mut chain);
        for (index, (joint, &coordinate)) in joints.iter().zip(q).enumerate() {
            let (turn, slide) = match joint.kind {
                JointKind::Revolute => (coordinate, 0.0),
                JointKind::Prismatic => (0.0, coordinate),
            };
            let about_z = Frame::turned(Vector3::z() * (joint.theta + turn));
            let about_x = Frame::turned(Vector3::x() * joint.alpha);
            // The shift along z and x, seen from the side of the row where it
            // is one straight piece of a link: d does not care for the turn
            // about its own axis, nor a for the twist about its own.
            let straight = Vector3::new(joint.a, 0.0, joint.d + slide);
            match self.description.convention {
                Convention::Standard => {
                    self.joint(&mut chain, index);
                    chain.rigid(&about_z);
                    self.link(&mut chain, index + 1, straight);
                    chain.rigid(&about_x);
                }
                Convention::Modified => {
                    chain.rigid(&about_x);
                    self.link(&mut chain, index, straight);
                    chain.rigid(&about_z);
                    self.joint(&mut chain, index);
                }
            }
        }
        self.flange(&mut chain);
        chain.rigid(&Frame::placed(&self.description.tool));
        PosedArm::new(chain.springs, chain.rod, self.law())
    }

    fn foundation(&self, chain: &mut Chain) {
        for effect in &self.effects {
            if let Effect::BaseCompliance { tilt, translation } = *effect {
                chain.spring(Motion::Slide, Vector3::repeat(translation));
                chain.spring(Motion::Turn, Vector3::new(tilt, tilt, 0.0));
            }
        }
    }

    fn flange(&self, chain: &mut Chain) {
        for effect in &self.effects {
            if let Effect::ToolCompliance { rotation, translation } = *effect {
                chain.spring(Motion::Slide, Vector3::repeat(translation));
                chain.spring(Motion::Turn, Vector3::repeat(rotation));
            }
        }
    }

    /// The springs of the joint `index`, from 0, in its joint frame.
    fn joint(&self, chain: &mut Chain, index: usize) {
        for effect in &self.effects {
            if let Effect::TransverseCompliance { joint, value } = *effect
                && joint == index + 1
            {
                chain.spring(Motion::Turn, Vector3::new(value, value, 0.0));
            }
        }
        let motion = match self.description.joints[index].kind {
            JointKind::Revolute => Motion::Turn,
            JointKind::Prismatic => Motion::Slide,
        };
        chain.push(motion, Response::Joint(index));
    }

    /// The straight body `number`, from 1, a beam where there is an effect.
    fn link(&self, chain: &mut Chain, number: usize, straight: Vector3<f64>) {
        let (mut bend, mut twist) = (0.0, 0.0);
        for effect in &self.effects {
            if let Effect::LinkCompliance { link, bending, torsion } = *effect
                && link == number
            {
                bend += bending;
                twist += torsion;
            }
        }
        if bend == 0.0 && twist == 0.0 {
            return chain.rigid(&Frame::shifted(straight));
        }
        let length = straight.norm();
        assert!(length > 0.0, "link {number} has no length to bend over");
        let along = Frame::facing(&straight);
        let share = 1.0 / (2 * self.segments) as f64;
        let mut done = 0.0;
        chain.rigid(&along);
        for segment in 0..self.segments {
            for side in [-1.0, 1.0] {
                let place = (segment as f64 + 0.5 + side * 0.5 / 3_f64.sqrt()) / self.segments as f64;
                chain.rigid(&Frame::shifted(Vector3::z() * (length * (place - done))));
                chain.spring(Motion::Turn, Vector3::new(bend, bend, twist) * share);
                done = place;
            }
        }
        chain.rigid(&Frame::shifted(Vector3::z() * (length * (1.0 - done))));
        chain.rigid(&along.turned_back());
    }

    fn law(&self) -> JointLaw {
        let mut law = JointLaw::new(self.description.joints.iter().map(|joint| joint.compliance()).collect());
        for effect in &self.effects {
            match *effect {
                Effect::JointCoupling { joints: [i, j], value } => law.couplings.push((i - 1, j - 1, value)),
                Effect::StiffnessNonlinearity { joint, added, knee } => law.softenings.push((joint - 1, added, knee)),
                _ => {}
            }
        }
        law
    }
}

/// Whether an effect is one this arm can have.
fn fits(description: &Description, effect: &Effect) -> bool {
    let joint = |number: usize| number.checked_sub(1).and_then(|index| description.joints.get(index));
    let amount = |value: f64| value.is_finite() && value >= 0.0;
    match *effect {
        Effect::TransverseCompliance { joint: number, value } => joint(number).is_some() && amount(value),
        Effect::LinkCompliance { link, bending, torsion } => {
            joint(link).is_some() && joint(link + 1).is_some() && amount(bending) && amount(torsion)
        }
        Effect::BaseCompliance { tilt, translation } => amount(tilt) && amount(translation),
        Effect::ToolCompliance { rotation, translation } => amount(rotation) && amount(translation),
        Effect::JointCoupling { joints: [i, j], value } => match (joint(i), joint(j)) {
            (Some(one), Some(other)) => {
                i != j
                    && [one.kind, other.kind] == [JointKind::Revolute; 2]
                    && value * value < one.compliance() * other.compliance()
            }
            _ => false,
        },
        Effect::StiffnessNonlinearity { joint: number, added, knee } => {
            joint(number).is_some_and(|joint| added > -joint.compliance()) && knee > 0.0
        }
        _ => false,
    }
}

/// A chain under construction, from the base outwards.
struct Chain {
    springs: Vec<Spring>,
    /// The rigid piece since the last spring.
    rod: Frame,
}

impl Chain {
    fn rigid(&mut self, piece: &Frame) {
        self.rod = self.rod.then(piece);
    }

    fn push(&mut self, motion: Motion, response: Response) {
        let rod = std::mem::replace(&mut self.rod, Frame::identity());
        self.springs.push(Spring { rod, motion, response });
    }

    fn spring(&mut self, motion: Motion, compliance: Vector3<f64>) {
        self.push(motion, Response::Linear(compliance));
    }
}
