//! What each joint and effect gives to a displacement.

use nalgebra::{Matrix6, SVector, Vector6};

use robstiff::elements::{Element, Pose, Spring, Torque, plays, springs, turn};
use robstiff::{Effect, Robot, State};

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
    let found = Yielding::of(robot, q).elements.into_iter().map(|part| {
        let bent = part.bend.as_ref().map(|bend| bend.by(wrench, state));
        (part.element, part.compliance * wrench + bent.unwrap_or_default())
    });
    found.collect::<Vec<_>>().into_iter()
}

/// How an arm yields in one posture, ready for many wrenches.
pub(crate) struct Yielding<'r> {
    elements: Vec<Part<'r>>,
}

/// A joint or an effect.
struct Part<'r> {
    element: Element<'r>,
    /// What goes with the wrench.
    compliance: Matrix6<f64>,
    /// What does not.
    bend: Option<Bend<'r>>,
}

/// A part of an effect in the law of a joint.
#[derive(Clone, Copy)]
struct Bend<'r> {
    effect: &'r Effect,
    /// The joint (from 0), its compliance, coordinate and preload.
    joint: usize,
    own: f64,
    q: f64,
    preload: f64,
    /// What a turn of the joint moves the TCP by.
    twist: Vector6<f64>,
}

impl Bend<'_> {
    /// What it adds to the displacement under a wrench that follows the loads in a state.
    fn by<const N: usize>(&self, wrench: &Vector6<f64>, state: &mut State<N>) -> Vector6<f64> {
        let torque = Torque { preload: self.preload, load: self.twist.dot(wrench) };
        let all = &mut state.plays[self.joint];
        *all = plays(self.effect, torque, *all);
        self.twist * turn(self.effect, self.own, self.q, torque, *all).unwrap_or_default()
    }

    /// Whether there is such a part in the joint's law at all.
    fn is_any(&self) -> bool {
        let none = Torque { preload: self.preload, load: 0.0 };
        turn(self.effect, self.own, self.q, none, State::<1>::new().plays[0]).is_some()
    }
}

/// An arm whose joints and effects are softer by factors.
pub(crate) struct Softened<'y> {
    compliance: Matrix6<f64>,
    bends: Vec<(Bend<'y>, f64)>,
}

impl<'r> Yielding<'r> {
    /// That of a robot at joint coordinates (rad or m).
    pub(crate) fn of<const N: usize, R: Robot<N>>(robot: &'r R, q: &SVector<f64, N>) -> Self {
        let (pose, own, preload) = (Pose::of(robot, q), robot.joint_compliance(), robot.preload(q));
        let geometry = pose.geometry();
        let joint = |i: usize| Part {
            element: Element::Joint(i + 1),
            compliance: geometry.unit_compliance(Spring::Joint(i + 1)) * own[i],
            bend: None,
        };
        let effect = |effect: &'r Effect| {
            let compliance = springs(effect)
                .fold(Matrix6::zeros(), |sum, (spring, value)| sum + geometry.unit_compliance(spring) * value);
            let bend = effect.row().map(|row| {
                let i = row - 1;
                let twist = geometry.joint_twist(row);
                Bend { effect, joint: i, own: own[i], q: q[i], preload: preload[i], twist }
            });
            Part { element: Element::Effect(effect), compliance, bend: bend.filter(Bend::is_any) }
        };
        Self { elements: (0..N).map(joint).chain(robot.effects().iter().map(effect)).collect() }
    }

    /// The arm as it is.
    pub(crate) fn as_described(&self) -> Softened<'r> {
        self.softened(&vec![1.0; self.elements.len()])
    }

    /// The arm whose joints and then effects are softer by a factor each.
    pub(crate) fn softened(&self, factors: &[f64]) -> Softened<'r> {
        let each = || self.elements.iter().zip(factors);
        Softened {
            compliance: each().fold(Matrix6::zeros(), |sum, (part, factor)| sum + part.compliance * *factor),
            bends: each().filter_map(|(part, factor)| Some((part.bend?, *factor))).collect(),
        }
    }
}

impl Softened<'_> {
    /// The displacement of the TCP (m, rad) under a wrench (N, Nm) that follows the loads in a state.
    pub(crate) fn deflection<const N: usize>(&self, wrench: &Vector6<f64>, state: &mut State<N>) -> Vector6<f64> {
        let bent = self.bends.iter().map(|(bend, factor)| bend.by(wrench, state) * *factor);
        self.compliance * wrench + bent.sum::<Vector6<f64>>()
    }
}
