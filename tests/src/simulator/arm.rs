//! An arm put together from rigid bodies, springs, gears and weights.

use nalgebra::Vector3;
use robstiff_robots::{Convention, Description, Effect, JointKind, Link};

use super::equilibrium::{Equilibrium, PosedArm, Pull};
use super::frame::Frame;
use super::gear::{Gear, JointLaw};
use super::hidden::{DhColumn, Hidden};
use super::outside::Outside;
use super::spring::{Chain, Motion, Response};

/// Segments a bending link is divided into where nothing else is said.
///
/// Each segment carries two springs, at its Gauss points: any number of
/// segments then has exactly the beam's compliance under small loads (its
/// moment is linear along it, and the work quadratic), and more segments only
/// follow the curve of a strongly bent beam better.
pub const SEGMENTS: usize = 4;

/// Gravity (m/s^2), along -z of the base frame.
pub const GRAVITY: f64 = 9.81;

/// An arm with all its springs, those of its description and hidden ones.
#[derive(Clone, Debug)]
pub struct Arm {
    description: Description,
    /// The description's effects and the hidden ones.
    effects: Vec<Effect>,
    /// What is hidden besides, as far as it is the arm's.
    hidden: Vec<Hidden>,
    segments: usize,
    /// What the controller gives way by, over the compliance of each joint.
    droop: f64,
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
        Self { description: description.clone(), effects, hidden: Vec::new(), segments: SEGMENTS, droop: 0.0 }
    }

    /// The same arm with something more hidden in it. What is of the rig leaves
    /// the arm as it is, but for a lever arm, which is where its loads act.
    ///
    /// # Panics
    ///
    /// Where it does not fit the arm.
    #[must_use]
    pub fn hiding(mut self, hidden: &Hidden) -> Self {
        let joints = self.description.joints.len();
        let fits = match hidden {
            Hidden::Elastic(effect) => fits(&self.description, effect),
            Hidden::LostMotion { joint, .. }
            | Hidden::Hysteresis { joint, .. }
            | Hidden::PoseDependentCompliance { joint, .. }
            | Hidden::JointZeroOffset { joint, .. }
            | Hidden::TransmissionError { joint, .. }
            | Hidden::DhError { row: joint, .. }
            | Hidden::Outside(
                Outside::ViscousJoint { joint, .. }
                | Outside::HardeningBearing { joint, .. }
                | Outside::WarmingJoint { joint, .. }
                | Outside::OneSided { joint, .. }
                | Outside::GainOfAngle { joint, .. }
                | Outside::Cable { link: joint, .. }
                | Outside::LinkGrowth { link: joint, .. },
            ) => (1..=joints).contains(joint),
            Hidden::Outside(Outside::CrossDependence { joint, of, .. }) => {
                (1..=joints).contains(joint) && (1..=joints).contains(of) && joint != of
            }
            Hidden::GravitySag(links) => links.len() == joints,
            _ => true,
        };
        assert!(fits, "{} with {hidden:?} does not fit {}", hidden.name(), self.description.name);
        match hidden {
            Hidden::Elastic(effect) => self.effects.push(*effect),
            Hidden::DhError { of, row, by } => {
                let row = &mut self.description.joints[row - 1];
                match of {
                    DhColumn::A => row.a += by,
                    DhColumn::D => row.d += by,
                    DhColumn::Alpha => row.alpha += by,
                }
            }
            other => self.hidden.push(other.clone()),
        }
        self
    }

    /// How many links (rows of its table) it has.
    pub(super) fn links(&self) -> usize {
        self.description.joints.len()
    }

    /// The same arm with one link (a row of its table, from 1) longer by a
    /// share of itself.
    #[must_use]
    pub(super) fn stretched(&self, link: usize, share: f64) -> Self {
        let mut arm = self.clone();
        let row = &mut arm.description.joints[link - 1];
        row.a *= 1.0 + share;
        row.d *= 1.0 + share;
        arm
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

    /// The same arm with a controller whose motors give way by a share of what
    /// each joint's compliance does.
    pub fn with_droop(self, share: f64) -> Self {
        Self { droop: share, ..self }
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
        let mut chain = Chain::at(Frame::placed(&self.description.base));
        self.foundation(&mut chain);
        for (index, (joint, &coordinate)) in joints.iter().zip(q).enumerate() {
            let coordinate = self.stands_at(index + 1, coordinate);
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
            self.attach(&mut chain, index + 1);
        }
        self.flange(&mut chain);
        chain.rigid(&Frame::placed(&self.description.tool));
        let lever = self.hidden.iter().map(|hidden| match hidden {
            Hidden::LeverArm(at) => Vector3::from(*at),
            _ => Vector3::zeros(),
        });
        PosedArm::new(chain.springs, chain.rod, self.law(q), chain.attached, lever.sum())
    }

    /// Where a joint, from 1, really stands when it says `q`.
    fn stands_at(&self, number: usize, q: f64) -> f64 {
        let off = self.hidden.iter().map(|hidden| match *hidden {
            Hidden::JointZeroOffset { joint, offset } if joint == number => offset,
            Hidden::TransmissionError { joint, order, sin, cos } if joint == number => {
                let angle = order as f64 * q;
                sin * angle.sin() + cos * angle.cos()
            }
            _ => 0.0,
        });
        q + off.sum::<f64>()
    }

    /// What pulls at the link `number`, from 1, whose frame the chain has come
    /// to.
    fn attach(&self, chain: &mut Chain, number: usize) {
        for hidden in &self.hidden {
            match hidden {
                Hidden::GravitySag(links) => {
                    let Link { mass, center_of_mass } = links[number - 1];
                    let weight = Pull::Weight(-Vector3::z() * (mass * GRAVITY));
                    chain.attached(Vector3::from(center_of_mass), weight);
                }
                Hidden::Outside(Outside::Cable { link, anchor, stiffness, length }) if *link == number => {
                    let anchor = Vector3::from(*anchor);
                    let stay = Pull::Stay { anchor, stiffness: *stiffness, length: *length };
                    chain.attached(Vector3::zeros(), stay);
                }
                _ => {}
            }
        }
    }

    fn foundation(&self, chain: &mut Chain) {
        for effect in &self.effects {
            if let Effect::BaseCompliance { tilt, translation } = *effect {
                chain.spring(Motion::Slide, Vector3::repeat(translation));
                chain.spring(Motion::Turn, Vector3::new(tilt, tilt, 0.0));
            }
        }
        for hidden in &self.hidden {
            match *hidden {
                Hidden::Outside(Outside::SoftFoundation { compliance, knee }) => {
                    chain.push(Motion::Turn, Response::Stiffening { compliance, knee });
                }
                Hidden::Outside(Outside::UnevenFoundation { tilt: [x, y] }) => {
                    chain.spring(Motion::Turn, Vector3::new(x, y, 0.0));
                }
                _ => {}
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
        for hidden in &self.hidden {
            if let Hidden::Outside(Outside::LooseFlange { gap, knee }) = *hidden {
                chain.push(Motion::Slide, Response::Gap { gap, knee });
            }
            if let Hidden::Outside(Outside::LooseTaper { gap, knee }) = *hidden {
                chain.push(Motion::Turn, Response::Gap { gap, knee });
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
        for hidden in &self.hidden {
            if let Hidden::Outside(Outside::HardeningBearing { joint, compliance, knee }) = *hidden
                && joint == index + 1
            {
                chain.push(Motion::Turn, Response::Stiffening { compliance, knee });
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

    /// The joints' law at the joint coordinates `q`.
    fn law(&self, q: &[f64]) -> JointLaw {
        let plain: Vec<f64> = self.description.joints.iter().map(|joint| joint.compliance()).collect();
        let mut law = JointLaw::new((1..=plain.len()).map(|joint| plain[joint - 1] * self.varies(joint, q)).collect());
        if self.droop > 0.0 {
            let held = |(joint, h): (usize, &f64)| (joint, Gear::Droop { compliance: self.droop * h });
            law.gears.extend(plain.iter().enumerate().map(held));
        }
        for effect in &self.effects {
            match *effect {
                Effect::JointCoupling { joints: [i, j], value } => law.couplings.push((i - 1, j - 1, value)),
                Effect::StiffnessNonlinearity { joint, added, knee } => {
                    law.gears.push((joint - 1, Gear::Softening { added, knee }));
                }
                _ => {}
            }
        }
        for hidden in &self.hidden {
            match hidden {
                &Hidden::LostMotion { joint, gap, knee } => law.gears.push((joint - 1, Gear::LostMotion { gap, knee })),
                Hidden::Hysteresis { joint, operators } => {
                    let plays = operators.iter().map(|&(radius, weight)| Gear::Play { weight, radius });
                    law.gears.extend(plays.map(|play| (joint - 1, play)));
                }
                Hidden::Outside(outside) => law.gears.extend(outside.gear(&plain)),
                _ => {}
            }
        }
        law
    }

    /// The factor of the compliance of a joint, from 1, at the joint
    /// coordinates `q`.
    fn varies(&self, number: usize, q: &[f64]) -> f64 {
        let added = self.hidden.iter().map(|hidden| match *hidden {
            Hidden::PoseDependentCompliance { joint, cos, sin } if joint == number => {
                let (once, twice) = (q[joint - 1].sin_cos(), (2.0 * q[joint - 1]).sin_cos());
                cos[0] * once.1 + sin[0] * once.0 + cos[1] * twice.1 + sin[1] * twice.0
            }
            Hidden::Outside(Outside::CrossDependence { joint, of, cos, sin }) if joint == number => {
                cos * q[of - 1].cos() + sin * q[of - 1].sin()
            }
            _ => 0.0,
        });
        let factor = 1.0 + added.sum::<f64>();
        assert!(factor > 0.0, "joint {number} would turn against its torque");
        factor
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
