//! An off-diagonal entry of `H_q` (belts, wrist gearing): `c (J_i J_j^T + J_j
//! J_i^T) F`, of either sign, small enough that `H_q` stays positive definite.

use std::format;
use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;

use super::{Form, Kind, Number, Offers, Part, Scene, place_words};
use crate::elements::Spring;

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
    let frames = &scene.samples.rows[0].joint_frames;
    let axis = |joint: usize| frames[joint - 1].fixed_view::<3, 1>(0, 2).into_owned();
    let turning: Vec<usize> = (1..=scene.joints()).filter(|&joint| scene.turns(joint)).collect();
    for &j in &turning {
        for &i in turning.iter().filter(|&&i| share_a_drive(i, j, &turning, &axis)) {
            let number =
                Number::compliance(scene, "value", [f64::NEG_INFINITY, f64::INFINITY], Spring::Coupling([i, j]));
            let check = move |numbers: &[(&str, f64)], joint: &dyn Fn(usize) -> f64| {
                let bound = (joint(i) * joint(j)).sqrt();
                (numbers[0].1.abs() < bound)
                    .then_some(())
                    .ok_or_else(|| format!("the coupling would be {:.2e}, beyond {bound:.2e} rad/Nm", numbers[0].1))
            };
            offers.add_checked(Part::Joints([i, j]), vec![number], vec![Form::of([0])], Some(Rc::new(check)));
        }
    }
}

/// How many joints turn before the wrist, on arms that have one.
const BEFORE_WRIST: usize = 3;

/// Whether a joint and one behind it can have a belt, rod or gear in common: neighbours with
/// parallel axes (a parallelogram, a drive further down) and the joints of a
/// wrist, whose shafts run in one another. Other pairs have no part through
/// which one could turn the other, and would only be names for something else.
/// Joints that slide do not count: a belt goes along a slide, and a wrist on a rail is one.
pub fn share_a_drive(i: usize, j: usize, turning: &[usize], axis: &dyn Fn(usize) -> Vector3<f64>) -> bool {
    let place = |joint: usize| turning.iter().position(|&other| other == joint);
    let (Some(first), Some(second)) = (place(i), place(j)) else { return false };
    let parallel = axis(i).cross(&axis(j)).norm() < PARALLEL;
    first < second && ((second == first + 1 && parallel) || first >= BEFORE_WRIST)
}

/// Axes within this angle are parallel (rad); description angles are exact.
const PARALLEL: f64 = 1e-6;
