//! A joint whose compliance varies with the coordinate of another: a gear beside a rod or a
//! belt that runs over that joint. It turns by `h (1 + cos cos q + sin sin q) tau`.

use std::format;
use std::vec::Vec;

use super::super::{Form, Kind, Number, Offers, Part, Scene, place_words};
use crate::trace::found::EffectParameter;

/// The kind.
pub static KIND: Kind = Kind {
    name: "foreign_angle",
    of_rig: false,
    words: |found| {
        format!("a compliance of {} that changes with the angle of joint {}", place_words(found), found.value(OTHER))
    },
    explanation: "",
    offer,
    on_axes: None,
};

const OTHER: &str = "other";

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let turning: Vec<usize> = (1..=scene.joints()).filter(|&joint| scene.turns(joint)).collect();
    for joint in (1..=scene.joints()).filter(|&joint| scene.largest_torque(joint).is_some()) {
        let (mut numbers, mut forms) = (Vec::new(), Vec::new());
        for &other in turning.iter().filter(|&&other| other != joint) {
            let number = |name, wave: fn(f64) -> f64| {
                let any = [f64::NEG_INFINITY, f64::INFINITY];
                let number = Number::elastic(name, "1", any, move |point| {
                    let torques = point.torques(joint);
                    point.of_joint(joint, |row| wave(point.data.rows[row].q[other - 1]) * torques[row])
                });
                Number { share_of: Some(joint), ..number }
            };
            let mut form = Form::of([numbers.len(), numbers.len() + 1]);
            form.marks.push(EffectParameter { name: OTHER, value: other as f64, std: None, unit: "1" });
            forms.push(form);
            numbers.extend([number("cos", f64::cos), number("sin", f64::sin)]);
        }
        if !forms.is_empty() {
            offers.add(Part::Joint(joint), numbers, forms);
        }
    }
}
