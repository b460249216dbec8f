//! An off-diagonal entry of `H_q` (belts, wrist gearing): `c (J_i J_j^T + J_j
//! J_i^T) F`, of either sign, small enough that `H_q` stays positive definite.

use std::format;
use std::rc::Rc;
use std::vec;

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
    for j in 2..=scene.joints() {
        for i in (1..j).filter(|&i| scene.turns(i) && scene.turns(j) && share_a_drive(i, j, &axis)) {
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

/// The first joint of a wrist, on arms that have one.
const WRIST: usize = 4;

/// Whether two joints can have a belt, rod or gear in common: neighbours with
/// parallel axes (a parallelogram, a drive further down) and the joints of a
/// wrist, whose shafts run in one another. Other pairs have no part through
/// which one could turn the other, and would only be names for something else.
pub fn share_a_drive(i: usize, j: usize, axis: &dyn Fn(usize) -> Vector3<f64>) -> bool {
    let parallel = axis(i).cross(&axis(j)).norm() < PARALLEL;
    (j == i + 1 && parallel) || i >= WRIST
}

/// Axes within this angle are parallel (rad); description angles are exact.
const PARALLEL: f64 = 1e-6;
