//! What a description declares, as parameters.

use std::rc::Rc;

use robstiff::elements::{Torque, turn};
use robstiff::{Effect, JointKind};
use robstiff_robots::Description;

use super::law::{play, unit_law};
use super::spring::{ACROSS, ALL, Site};
use super::{At, Parameter, Sign, Size, Spring, Term, Torques, Weight};

/// A number of the description that is fitted.
#[derive(Clone, Debug)]
pub struct Declared {
    /// What it is.
    pub what: Own,
    /// Its parameter.
    pub parameter: Parameter,
}

/// Which number of a description.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Own {
    /// The compliance of a joint (from 1).
    Joint(usize),
    /// The number of an effect: its index in the description, and that of the number.
    Effect(usize, usize),
}

/// A declared compliance is off by up to so many times itself.
const OFF: f64 = 3.0;

/// What is likely of a joint of which nothing is declared (rad/Nm, m/N).
const UNDECLARED: f64 = 1e-5;

/// The numbers of a description that loads show: compliances, and those of its effects in which
/// the deflection is linear.
pub fn declared(robot: &Description) -> Vec<Declared> {
    let own: Vec<f64> = robot.joints.iter().map(|joint| joint.compliance()).collect();
    let largest = own.iter().copied().fold(0.0, f64::max);
    let joints = own.iter().enumerate().map(|(i, &value)| {
        let size = match value > 0.0 {
            true => Size::Of(OFF * value),
            // Of an arm of which no compliance is declared, all are unknown.
            false => Size::Of(if largest > 0.0 { OFF * largest } else { UNDECLARED }),
        };
        let unit = if robot.joints[i].kind == JointKind::Revolute { "rad/Nm" } else { "m/N" };
        let term = Term::Spring(Spring::Joint(i + 1));
        let parameter = Parameter { name: "h", unit, term, size, sign: Sign::Nonnegative, mean: value };
        Declared { what: Own::Joint(i + 1), parameter }
    });
    let effects = robot.effects.iter().enumerate().flat_map(|(index, effect)| of_effect(robot, index, effect));
    joints.chain(effects).collect()
}

/// The numbers of a declared effect that are fitted again.
fn of_effect(robot: &Description, index: usize, effect: &Effect) -> Vec<Declared> {
    let number = |k: usize, name, unit, value: f64, size: f64, sign, term| Declared {
        what: Own::Effect(index, k),
        parameter: Parameter { name, unit, term, size: Size::Of(size), sign, mean: value },
    };
    let middle = {
        let mut own: Vec<f64> = robot.joints.iter().map(|joint| joint.compliance()).collect();
        own.sort_by(f64::total_cmp);
        own.get(own.len() / 2).copied().filter(|h| *h > 0.0).unwrap_or(3e-7)
    };
    let likely = |value: f64| OFF * value.abs().max(0.1 * middle);
    let spring = |k, name, unit, value: f64, spring| {
        number(k, name, unit, value, likely(value), Sign::Nonnegative, Term::Spring(spring))
    };
    let of_law = |k, name, unit, value: f64, size: f64, sign, joint, law| {
        number(k, name, unit, value, size, sign, Term::Law(joint, law))
    };
    match *effect {
        Effect::TransverseCompliance { joint, value } => {
            vec![spring(0, "h", "rad/Nm", value, Spring::Turn(Site::Joint(joint), ACROSS))]
        }
        Effect::LinkCompliance { link, bending, torsion } => vec![
            spring(0, "bending", "rad/Nm", bending, Spring::Bending(link)),
            spring(1, "torsion", "rad/Nm", torsion, Spring::Torsion(link)),
        ],
        Effect::BaseCompliance { tilt, translation } => vec![
            spring(0, "tilt", "rad/Nm", tilt, Spring::Turn(Site::Base, ACROSS)),
            spring(1, "translation", "m/N", translation, Spring::Shift(Site::Base, ALL)),
        ],
        Effect::ToolCompliance { rotation, translation } => vec![
            spring(0, "rotation", "rad/Nm", rotation, Spring::Turn(Site::Flange, ALL)),
            spring(1, "translation", "m/N", translation, Spring::Shift(Site::Flange, ALL)),
        ],
        Effect::JointCoupling { joints, value } => {
            let term = Term::Spring(Spring::Coupling(joints));
            vec![number(0, "c", "rad/Nm", value, likely(value), Sign::Free, term)]
        }
        Effect::StiffnessNonlinearity { joint, added, knee } => {
            let law = unit_law(Effect::StiffnessNonlinearity { joint, added: 1.0, knee });
            vec![of_law(0, "added", "rad/Nm", added, likely(added), Sign::Free, joint, law)]
        }
        Effect::LostMotion { joint, gap, knee } => {
            let law = unit_law(Effect::LostMotion { joint, gap: 1.0, knee });
            vec![of_law(0, "gap", "rad", gap, OFF * gap, Sign::Nonnegative, joint, law)]
        }
        Effect::Hysteresis { joint, radius1, weight1, radius2, weight2, radius3, weight3 } => {
            let plays = [(radius1, weight1, "weight1"), (radius2, weight2, "weight2"), (radius3, weight3, "weight3")];
            let own = plays.into_iter().enumerate().filter(|(_, (radius, ..))| *radius > 0.0);
            own.map(|(k, (radius, weight, name))| {
                let law = play(radius);
                of_law(2 * k + 1, name, "rad/Nm", weight, likely(weight), Sign::Nonnegative, joint, law)
            })
            .collect()
        }
        // A share of the joint's own compliance, and of the kinematics.
        Effect::PoseDependentCompliance { .. }
        | Effect::JointZeroOffset { .. }
        | Effect::DhError { .. }
        | Effect::TransmissionError { .. }
        | Effect::GravitySag { .. }
        | Effect::GravityPreload { .. } => Vec::new(),
    }
}

/// What a description declares that is not fitted: where joints stand aside, and how a joint's
/// compliance varies with its angle.
pub fn fixed(robot: &Description) -> Vec<Parameter> {
    let mut fixed = Vec::new();
    for effect in &robot.effects {
        match *effect {
            Effect::TransmissionError { joint, order, sin, cos } => {
                let of = move |at: &At<'_>| {
                    let (s, c) = (order * at.q[joint - 1]).sin_cos();
                    sin * s + cos * c
                };
                fixed.push(one(Term::Aside(joint, 2, Rc::new(of))));
            }
            Effect::GravitySag { share } => {
                let kinds: Vec<JointKind> = robot.joints.iter().map(|joint| joint.kind).collect();
                for joint in 1..=kinds.len() {
                    let (weight, kinds) = (Weight::of(robot), kinds.clone());
                    let own = share * robot.joints[joint - 1].compliance();
                    let of = move |at: &At<'_>| own * weight.torque(at.stand, &kinds, joint - 1);
                    fixed.push(one(Term::Aside(joint, 2, Rc::new(of))));
                }
            }
            Effect::PoseDependentCompliance { joint, .. } => {
                let (effect, own) = (*effect, robot.joints[joint - 1].compliance());
                let law = move |torques: &Torques<'_>| {
                    let of =
                        |(load, q): (&f64, &f64)| turn(&effect, own, *q, Torque::of(*load), [0.0; 3]).unwrap_or(0.0);
                    torques.load.iter().zip(torques.q).map(of).collect()
                };
                fixed.push(one(Term::Law(joint, Rc::new(law))));
            }
            _ => {}
        }
    }
    fixed
}

/// All that a description declares, with the values that it gives.
pub fn as_declared(robot: &Description) -> (Vec<Parameter>, Vec<f64>) {
    let own = declared(robot).into_iter().map(|own| own.parameter);
    let parameters: Vec<Parameter> = fixed(robot).into_iter().chain(own).collect();
    let values = parameters.iter().map(|parameter| parameter.mean).collect();
    (parameters, values)
}

/// A parameter that is one.
fn one(term: Term) -> Parameter {
    Parameter { name: "declared", unit: "1", term, size: Size::Of(1.0), sign: Sign::Free, mean: 1.0 }
}
