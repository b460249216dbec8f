//! An off-diagonal entry of `H_q` (belts, wrist gearing): `c (J_i J_j^T + J_j
//! J_i^T) F`, of either sign, small enough that `H_q` stays positive definite.

use std::format;
use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::{SVector, Vector3};
use robstiff_robots::{Description, JointKind};

use super::{Form, Kind, Number, Offers, Part, Scene, place_words};
use robstiff::elements::{Pose, Spring};
use robstiff::{Robot, with_robot};

/// The kind.
pub static KIND: Kind = Kind {
    name: "joint_coupling",
    of_rig: false,
    words: |found| format!("the coupling of {} (belts, wrist gearing)", place_words(found)),
    explanation: "",
    offer,
    on_axes: None,
};

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    offer_of(drives(scene.description), scene, offers);
}

/// Offers couplings of pairs of joints.
pub fn offer_of(pairs: Vec<[usize; 2]>, scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for [i, j] in pairs {
        let number = Number::compliance(scene, "value", [f64::NEG_INFINITY, f64::INFINITY], Spring::Coupling([i, j]));
        let check = move |numbers: &[(&str, f64)], joint: &dyn Fn(usize) -> f64| {
            let bound = (joint(i) * joint(j)).sqrt();
            (numbers[0].1.abs() < bound)
                .then_some(())
                .ok_or_else(|| format!("the coupling would be {:.2e}, beyond {bound:.2e} rad/Nm", numbers[0].1))
        };
        offers.add_checked(Part::Joints([i, j]), vec![number], vec![Form::of([0])], Some(Rc::new(check)));
    }
}

/// How many joints turn before the wrist, on arms that have one.
const BEFORE_WRIST: usize = 3;

/// The pairs of joints that can have a belt, rod or gear in common: neighbours with
/// parallel axes (a parallelogram, a drive further down) and the joints of a
/// wrist, whose shafts run in one another. Other pairs have no part through
/// which one could turn the other, and would only be names for something else.
/// Joints that slide do not count: a belt goes along a slide, and a wrist on a rail is one.
pub fn drives(robot: &Description) -> Vec<[usize; 2]> {
    pairs(robot, true)
}

/// The pairs of joints that turn and have no such part in common.
pub fn without_drive(robot: &Description) -> Vec<[usize; 2]> {
    pairs(robot, false)
}

/// The pairs of joints that turn, with a drive in common or without.
fn pairs(robot: &Description, with_drive: bool) -> Vec<[usize; 2]> {
    let axes = axes_at_zero(robot);
    let turning: Vec<usize> =
        (1..=robot.joints.len()).filter(|&joint| robot.joints[joint - 1].kind == JointKind::Revolute).collect();
    let share = |first: usize, second: usize| {
        // Neighbours stand to each other at every pose as at this one.
        let parallel = axes[turning[first] - 1].cross(&axes[turning[second] - 1]).norm() < PARALLEL;
        (second == first + 1 && parallel) || first >= BEFORE_WRIST
    };
    let behind = |second: usize| (0..second).map(move |first| (first, second));
    let pairs = (0..turning.len()).flat_map(behind).filter(|&(first, second)| share(first, second) == with_drive);
    pairs.map(|(first, second)| [turning[first], turning[second]]).collect()
}

/// The directions of the joints' axes where all coordinates are zero, in the base frame.
fn axes_at_zero(robot: &Description) -> Vec<Vector3<f64>> {
    fn of<const N: usize>(robot: &impl Robot<N>) -> Vec<Vector3<f64>> {
        let pose = Pose::of(robot, &SVector::zeros());
        pose.geometry().joint_frames.iter().map(|frame| frame.fixed_view::<3, 1>(0, 2).into_owned()).collect()
    }
    with_robot!(robot, |robot| of(&robot))
}

/// Axes within this angle are parallel (rad); description angles are exact.
const PARALLEL: f64 = 1e-6;
