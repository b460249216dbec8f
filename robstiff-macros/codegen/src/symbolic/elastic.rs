//! The elastic parameters of a description, as named symbols.

use robstiff_robots::effect::physics::{PLAYS, Spring};
use robstiff_robots::{Description, Effect, effect};

pub use super::parameters::{harmonic, joint_compliances, parameters, remark};
use super::weight;
use crate::graph::{Graph, Sym};

/// All elastic parameters of a robot; what it does not have is 0 and folds
/// away. Joints and links count from 0.
#[derive(Debug)]
pub struct Elastic<'g> {
    /// The joints' own compliance (rad/Nm or m/N).
    pub joint: Vec<Sym<'g>>,
    /// Tilt of the joints about x and y (rad/Nm).
    pub transverse: Vec<Sym<'g>>,
    /// Bending and torsion of the links (rad/Nm).
    pub link: Vec<(Sym<'g>, Sym<'g>)>,
    /// Tilt (rad/Nm) and translation (m/N) of the foundation.
    pub base: (Sym<'g>, Sym<'g>),
    /// Rotation (rad/Nm) and translation (m/N) of flange and tool.
    pub tool: (Sym<'g>, Sym<'g>),
    /// Couplings of two joints, the smaller first (rad/Nm).
    pub coupling: Vec<([usize; 2], Sym<'g>)>,
    /// Effects with a part in the law of a joint.
    pub laws: Vec<Law<'g>>,
}

/// An effect with a part in the law of its joint.
#[derive(Clone, Debug)]
pub struct Law<'g> {
    /// The joint, from 0.
    pub joint: usize,
    effect: Effect,
    parameters: Vec<Sym<'g>>,
    /// What the joint's gear carries before the load (Nm).
    preload: Sym<'g>,
    /// What the unloaded joint's compliance has on top (rad/Nm).
    unloaded: Sym<'g>,
}

impl<'g> Law<'g> {
    fn of(
        g: &'g Graph,
        effect: Effect,
        parameters: &[Sym<'g>],
        own: &[Sym<'g>],
        preload: Option<&[Sym<'g>]>,
    ) -> Option<Self> {
        let joint = effect.row()? - 1;
        remark(g, &effect);
        let preload = preload.map_or(g.number(0.0), |preload| preload[joint]);
        let unloaded = effect.slope(parameters, own[joint], preload, &harmonic(g, joint))?;
        Some(Self { joint, effect, parameters: parameters.to_vec(), preload, unloaded })
    }

    /// Says in the code that what follows is of it.
    pub fn remark(&self, g: &'g Graph) {
        remark(g, &self.effect);
    }

    /// The play operators it uses, after the torque of a load that follows `before`, both
    /// counted from where they rest under the preload.
    pub fn plays(&self, torque: Sym<'g>, before: [Sym<'g>; PLAYS]) -> Vec<Sym<'g>> {
        // Where a gear carries nothing they rest at 0, which symbols do not see.
        let plays = match self.preload.is_zero() {
            true => self.effect.plays(&self.parameters, torque, before),
            false => self.effect.plays_beyond(&self.parameters, self.preload, torque, before),
        };
        plays[..self.effect.plays_in_use()].to_vec()
    }

    /// By how much the joint turns more than by its own compliance.
    pub fn turn(&self, g: &'g Graph, compliance: Sym<'g>, torque: Sym<'g>, plays: &[Sym<'g>]) -> Sym<'g> {
        let plays = std::array::from_fn(|k| plays.get(k).copied().unwrap_or(g.number(0.0)));
        let joint = effect::physics::Joint { compliance, torque, plays, harmonic: &harmonic(g, self.joint) };
        let turn = match self.preload.is_zero() {
            true => self.effect.turn(&self.parameters, &joint),
            false => self.effect.turn_beyond(&self.parameters, self.preload, &joint),
        };
        turn.expect("a law")
    }
}

impl<'g> Elastic<'g> {
    /// The parameters of `robot` under the names that generated code gives
    /// them.
    pub fn of(g: &'g Graph, robot: &Description) -> Self {
        let n = robot.joints.len();
        let zero = g.number(0.0);
        let mut elastic = Self {
            joint: joint_compliances(g, robot),
            transverse: vec![zero; n],
            link: vec![(zero, zero); n],
            base: (zero, zero),
            tool: (zero, zero),
            coupling: Vec::new(),
            laws: Vec::new(),
        };
        let preload = weight::preload(g, robot);
        for effect in &robot.effects {
            if effect.is_kinematic() {
                continue;
            }
            let parameters = parameters(g, effect);
            for (k, spring) in effect.springs() {
                elastic.add(spring, parameters[k]);
            }
            elastic.laws.extend(Law::of(g, *effect, &parameters, &elastic.joint, preload.as_deref()));
        }
        elastic
    }

    fn add(&mut self, spring: Spring, h: Sym<'g>) {
        let sum = match spring {
            Spring::Joint(joint) => &mut self.joint[joint - 1],
            Spring::Transverse(joint) => &mut self.transverse[joint - 1],
            Spring::LinkBending(link) => &mut self.link[link - 1].0,
            Spring::LinkTorsion(link) => &mut self.link[link - 1].1,
            Spring::BaseTilt => &mut self.base.0,
            Spring::BaseTranslation => &mut self.base.1,
            Spring::ToolRotation => &mut self.tool.0,
            Spring::ToolTranslation => &mut self.tool.1,
            Spring::Coupling([i, j]) => return self.coupling.push(([i.min(j) - 1, i.max(j) - 1], h)),
        };
        *sum = *sum + h;
    }

    /// Whether nothing but the joints yields, each about its own axis.
    pub fn is_of_joints(&self) -> bool {
        let pairs = self.link.iter().chain([&self.base, &self.tool]);
        self.transverse.iter().all(|h| h.is_zero())
            && pairs.into_iter().all(|(first, second)| first.is_zero() && second.is_zero())
            && self.coupling.is_empty()
    }

    /// The compliance of a joint about the unloaded state: its own and what
    /// its law has on top there.
    pub fn unloaded_joint(&self, joint: usize) -> Sym<'g> {
        let laws = self.laws.iter().filter(|law| law.joint == joint);
        laws.fold(self.joint[joint], |h, law| h + law.unloaded)
    }
}
