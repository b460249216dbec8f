//! A periodic error of a joint's coordinate (eccentric encoder, gear): `cos
//! cos(k q) + sin sin(k q)`. In same-pose differences it is small, as a zero
//! offset is.

use std::format;
use std::vec::Vec;

use super::{Form, Kind, Number, Offers, Part, Scene, place_words};
use crate::identify::setup::Wave;
use robstiff::Effect;

/// The kind.
pub static KIND: Kind = Kind {
    name: "transmission_error",
    of_rig: false,
    words: |found| {
        format!(
            "the error of the angle of {} that comes back {} times a turn",
            place_words(found),
            found.value("order")
        )
    },
    explanation: "",
    offer,
    on_axes: None,
};

/// The orders tried, one of them.
pub const ORDERS: [f64; 3] = [1.0, 2.0, 3.0];

/// More is no error of a gear (rad), and no gear has near as much; what a same-
/// pose difference shows at all has to be that large.
pub const MOST: f64 = 0.1;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for joint in (1..=scene.joints()).filter(|&joint| scene.turns(joint)) {
        // A description takes one order of a joint: the one that it has.
        let declared = scene.description.effects.iter().find_map(|effect| match *effect {
            Effect::TransmissionError { joint: own, order, .. } if own == joint => Some(order),
            _ => None,
        });
        let orders: Vec<f64> =
            ORDERS.into_iter().filter(|&order| declared.is_none_or(|declared| declared == order)).collect();
        if orders.is_empty() {
            continue;
        }
        let number = |(order, name): (f64, &'static str)| {
            let of_cos = name == "cos";
            let wave = move |amplitude: f64| {
                let (cos, sin) = if of_cos { (amplitude, 0.0) } else { (0.0, amplitude) };
                Wave { joint, order, cos, sin }
            };
            Number::of_setup(
                name,
                "rad",
                MOST,
                move |setup, amplitude| setup.waves.push(wave(amplitude)),
                move |point, _| {
                    point.slope(joint, 0, |row| {
                        let angle = order * point.data.rows[row].q[joint - 1];
                        if of_cos { angle.cos() } else { angle.sin() }
                    })
                },
            )
        };
        let numbers: Vec<Number> =
            orders.iter().flat_map(|&order| [(order, "cos"), (order, "sin")]).map(number).collect();
        let form = |(k, &order): (usize, &f64)| Form::of([2 * k, 2 * k + 1]).with("order", order, "1");
        offers.add(Part::Joint(joint), numbers, orders.iter().enumerate().map(form).collect());
    }
}
