//! What is fitted whatever is found: the numbers that a description declares, where the robot
//! stands, and of absolute positions every number of the table.

use std::rc::Rc;

use nalgebra::Vector3;
use robstiff::elements::{Torque, turn};
use robstiff::{Convention, Effect, JointKind};
use robstiff_robots::Description;

use crate::effects::{Scene, What};
use crate::model::arm::{A, ALPHA, BETA, D, THETA};
use crate::model::spring::{ACROSS, ALL, Site};
use crate::model::term::Law;
use crate::model::{At, Parameter, Sign, Size, Spring, Term, Torques, World};

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
                let law = crate::effects::play(radius);
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

/// The law of an effect whose number is one.
fn unit_law(effect: Effect) -> Law {
    Rc::new(move |torques: &Torques<'_>| {
        let of = |row: usize| {
            let torque = Torque { preload: torques.preload[row], load: torques.load[row] };
            turn(&effect, 0.0, torques.q[row], torque, [0.0; 3]).unwrap_or(0.0)
        };
        (0..torques.load.len()).map(of).collect()
    })
}

/// What a description declares that is not fitted: where joints stand aside, and how a joint's
/// compliance varies with its angle.
pub fn fixed(robot: &Description, scene: &Scene<'_>) -> Vec<Parameter> {
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
                for joint in scene.turning() {
                    let (weight, kinds) = (scene.weight.clone(), scene.kinds.clone());
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

/// A parameter that is one.
fn one(term: Term) -> Parameter {
    Parameter { name: "declared", unit: "1", term, size: Size::Of(1.0), sign: Sign::Free, mean: 1.0 }
}

/// Groups of learned scales: lengths of the table, its angles, and the unnamed block.
const LENGTHS: usize = 0;
const ANGLES: usize = 1;
/// That of the unnamed block.
pub const BLOCK: usize = 2;

/// What the scales are likely to be (m, rad).
pub const LIKELY_SCALES: [f64; 3] = [3e-4, 3.5e-4, 3e-5];

/// From so many poses on there are enough to learn a block of numbers without a name.
pub const POSES_FOR_BLOCK: usize = 80;

/// Where the robot stands is known to no better than this (m, rad).
const ANYWHERE: f64 = 1e3;

/// What the reflector of absolute positions is likely to be off by (m).
const REFLECTOR_OFF: f64 = 0.1;

/// The names of its numbers.
pub const REFLECTOR: [&str; 3] = ["reflector x", "reflector y", "reflector z"];

/// Axes are nearly parallel where the sine of the twist between them is smaller. There an angle
/// between them about y is no combination of the table's other numbers (Hayati 1983); elsewhere it is
/// one, and would only split what these say.
const PARALLEL: f64 = 0.1;

/// The numbers of the table, by what they are called.
pub const TABLE: [(usize, &str, &str); 5] =
    [(THETA, "theta", "rad"), (D, "d", "m"), (A, "a", "m"), (ALPHA, "alpha", "rad"), (BETA, "beta", "rad")];

/// What is always fitted of absolute positions, with so many poses.
pub fn of_positions(scene: &Scene<'_>, poses: usize) -> Vec<Parameter> {
    let flat = |name, unit, change: fn(&mut World, usize, f64), k: usize| {
        let term = Term::World(Rc::new(move |world: &mut World, by| change(world, k, by)));
        Parameter::new(name, unit, Size::Flat(ANYWHERE), term)
    };
    let mut always: Vec<Parameter> = Vec::new();
    for k in 0..3 {
        always.push(flat(["x", "y", "z"][k], "m", |world, k, by| world.rig.stand_off[1][k] += by, k));
    }
    for k in 0..3 {
        always.push(flat(["rx", "ry", "rz"][k], "rad", |world, k, by| world.rig.stand_off[0][k] += by, k));
    }
    for (k, name) in REFLECTOR.into_iter().enumerate() {
        let term = Term::World(Rc::new(move |world: &mut World, by| world.rig.reflector[k] += by));
        always.push(Parameter::new(name, "m", Size::Of(REFLECTOR_OFF), term));
    }
    for joint in scene.joints() {
        for (number, name, unit) in TABLE.into_iter().filter(|of| of.0 != BETA || is_parallel(scene, joint)) {
            // Of a joint that slides, theta and d are the angle and the coordinate.
            let group = if unit == "m" { LENGTHS } else { ANGLES };
            let size = Size::Learned(group, LIKELY_SCALES[group]);
            always.push(Parameter::new(name, unit, size, Term::Table(joint, number)));
        }
    }
    if poses >= POSES_FOR_BLOCK {
        always.extend(block(scene));
    }
    always
}

/// Whether the twist of a joint's row lies between two nearly parallel axes of joints. In the standard
/// table it lies behind the joint (from 1), in the modified one before it.
fn is_parallel(scene: &Scene<'_>, joint: usize) -> bool {
    let end = match scene.robot.convention {
        Convention::Standard => scene.kinds.len(),
        Convention::Modified => 1,
    };
    joint != end && scene.robot.joints[joint - 1].alpha.sin().abs() < PARALLEL
}

/// Every joint stands aside by sines and cosines of its own and of neighbouring angles: what an arm
/// does for causes that have no name.
fn block(scene: &Scene<'_>) -> Vec<Parameter> {
    let turning = scene.turning();
    let mut waves: Vec<Vec<(usize, f64)>> = Vec::new();
    for &joint in &turning {
        waves.push(vec![(joint, 1.0)]);
        waves.push(vec![(joint, 2.0)]);
    }
    for pair in turning.windows(2) {
        for sign in [1.0, -1.0] {
            waves.push(vec![(pair[0], 1.0), (pair[1], sign)]);
        }
    }
    let mut block = Vec::new();
    for &joint in &turning {
        for wave in &waves {
            for sine in [false, true] {
                let wave = wave.clone();
                let of = move |at: &At<'_>| {
                    let angle: f64 = wave.iter().map(|(joint, order)| order * at.q[joint - 1]).sum();
                    if sine { angle.sin() } else { angle.cos() }
                };
                let size = Size::Learned(BLOCK, LIKELY_SCALES[BLOCK]);
                block.push(Parameter::new("wave", "rad", size, Term::Aside(joint, 2, Rc::new(of))));
            }
        }
    }
    block
}

/// The unloaded reading that the rows of each clamped axis share is as noisy as the others.
fn of_clamped(scene: &Scene<'_>) -> Vec<Parameter> {
    let of_axis = |(k, &axis): (usize, &usize)| {
        let rows: Vec<bool> = scene.visit.iter().map(|visit| *visit == k).collect();
        let of = move |at: &At<'_>| Vector3::x() * if rows[at.row] { 1.0 } else { 0.0 };
        let unit = if scene.turns(axis) { "rad" } else { "m" };
        Parameter::new("unloaded", unit, Size::Noise, Term::Reading(Rc::new(of)))
    };
    scene.axes.iter().enumerate().map(of_axis).collect()
}

/// What is always fitted in a scene, with so many poses; the description's own numbers first.
pub fn always(robot: &Description, scene: &Scene<'_>, poses: usize) -> (Vec<Declared>, Vec<Parameter>) {
    let own = match scene.what {
        What::Displacements => declared(robot),
        What::Positions if scene.is_loaded() => declared(robot),
        What::Positions => Vec::new(),
        What::Clamped => {
            let of_axes = |own: &Declared| match own.what {
                Own::Joint(joint) => scene.axes.contains(&joint),
                Own::Effect(index, _) => robot.effects[index].row().is_some_and(|joint| scene.axes.contains(&joint)),
            };
            declared(robot).into_iter().filter(of_axes).collect()
        }
    };
    let mut all: Vec<Parameter> = own.iter().map(|own| own.parameter.clone()).collect();
    match scene.what {
        What::Positions => all.extend(of_positions(scene, poses)),
        What::Clamped => all.extend(of_clamped(scene)),
        What::Displacements => {}
    }
    (own, all)
}
