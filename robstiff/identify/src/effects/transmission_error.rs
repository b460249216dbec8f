//! The joint's angle errs periodically: an encoder or a gear wheel that is not quite centred.

use std::rc::Rc;

use robstiff::Effect;
use robstiff_robots::Place as Part;

use super::scene::What;
use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "transmission_error",
    side: Side::Robot,
    words: |place, _| format!("the periodic angle error of {}", place.words()),
    explanation: "",
    offer,
};

/// What a wave is likely to be (rad): displacements show it only where it is large.
const LIKELY_LOADED: f64 = 0.03;
const LIKELY_ABSOLUTE: f64 = 3e-4;

/// The orders of the forms: periods in a turn. Loads do not tell three.
const ORDERS: [&[u16]; 4] = [&[1], &[2], &[1, 2], &[1, 2, 3]];
const ORDERS_LOADED: &[&[u16]] = &[&[1], &[2], &[1, 2]];

const SINES: [&str; 3] = ["sin1", "sin2", "sin3"];
const COSINES: [&str; 3] = ["cos1", "cos2", "cos3"];

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    let (size, orders) = match scene.what {
        What::Displacements => (LIKELY_LOADED, ORDERS_LOADED),
        What::Positions => (LIKELY_ABSOLUTE, &ORDERS[..]),
        What::Clamped => return,
    };
    for joint in scene.turning() {
        let each = [1, 2, 3].map(|order| waves(joint, order, size));
        let form = |orders: &&'static [u16]| {
            let wave = |order: &u16| each[usize::from(order - 1)].clone();
            let label: Vec<String> = orders.iter().map(ToString::to_string).collect();
            let orders: &'static [u16] = orders;
            let form = Form::new(format!("order {}", label.join(", ")), orders.iter().flat_map(wave).collect());
            form.written(move |v| {
                let of = |(k, order): (usize, &u16)| Effect::TransmissionError {
                    joint,
                    order: f64::from(*order),
                    sin: v[2 * k],
                    cos: v[2 * k + 1],
                };
                orders.iter().enumerate().map(of).collect()
            })
        };
        offers.add(Part::Joint(joint), orders.iter().map(form).collect());
    }
}

/// A wave of an order: its sine and its cosine, each likely to be of a size (rad).
pub(super) fn waves(joint: usize, order: u16, size: f64) -> [Parameter; 2] {
    let number = |name, sine: bool| {
        let of = move |at: &At<'_>| {
            let (s, c) = (f64::from(order) * at.q[joint - 1]).sin_cos();
            if sine { s } else { c }
        };
        Parameter::new(name, "rad", Size::Of(size), Term::Aside(joint, 2, Rc::new(of)))
    };
    let k = usize::from(order - 1).min(2);
    [number(SINES[k], true), number(COSINES[k], false)]
}
