//! What is fitted whatever is found: the numbers that a description declares, where the robot
//! stands, and of absolute positions every number of the table.

use std::rc::Rc;

use nalgebra::Vector3;
use robstiff::Convention;
use robstiff_robots::Description;

use crate::effects::{Scene, What};
use crate::model::arm::{A, ALPHA, BETA, D, THETA};
use crate::model::described::declared;
use crate::model::{At, Parameter, Size, Term, World};

pub use crate::model::described::{Declared, Own};

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
