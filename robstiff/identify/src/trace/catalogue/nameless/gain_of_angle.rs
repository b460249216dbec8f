//! A force whose gain goes with the angle of a joint: a rope or rod that is led round the arm, or
//! a load cell's cable that pulls as the arm turns. Of what is read as `f` there acts
//! `f (1 + gain u)` or `f (1 + gain u + bend u^2)`, with `u` the angle, from -1 to 1 over those of
//! the campaign. A compliance of that joint that varies with its own angle does much the same,
//! but moves nothing else.

use std::format;
use std::vec::Vec;

use super::super::{Form, Kind, Number, Offers, Place, Scene};
use super::of_loads;
use crate::trace::found::EffectParameter;

/// The kind.
pub static KIND: Kind = Kind {
    name: "gain_of_angle",
    of_rig: true,
    words: |found| format!("a load whose reading changes with the angle of joint {}", found.value(JOINT)),
    explanation: "",
    offer,
    on_axes: None,
};

const JOINT: &str = "joint";

/// A load that is off by more than this at the end of the joint's angles is no reading (1).
const MOST: f64 = 0.5;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let rows = &scene.data.rows;
    let (mut numbers, mut forms): (Vec<Number>, Vec<Form>) = (Vec::new(), Vec::new());
    for joint in (1..=scene.joints()).filter(|&joint| scene.turns(joint)) {
        let angles = || rows.iter().map(|row| row.q[joint - 1]);
        let (least, most) = angles().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), q| (a.min(q), b.max(q)));
        if least == most {
            continue;
        }
        let along = |q: f64| (2.0 * q - least - most) / (most - least);
        let first = numbers.len();
        let of_joint = EffectParameter { name: JOINT, value: joint as f64, std: None, unit: "1" };
        for mut form in [Form::of([first]), Form::of([first, first + 1])] {
            form.marks.push(of_joint.clone());
            forms.push(form);
        }
        numbers.push(of_loads("gain", MOST, angles().map(along)));
        numbers.push(of_loads("bend", MOST, angles().map(|q| along(q).powi(2))));
    }
    if !forms.is_empty() {
        offers.add(Place::Rig, numbers, forms);
    }
}
