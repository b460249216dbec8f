//! The reflector shifted on the tool at some moment, and stayed there.

use std::rc::Rc;

use super::base_slip::FROM;
use super::scene::What;
use super::thermal_drift::FEWEST_VISITS;
use super::{Form, Kind, Offers, Place, SHIFT, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "reflector_slip",
    side: Side::Rig,
    words: |_, numbers| {
        let line = numbers.iter().find(|number| number.name == FROM).map_or(0.0, |number| number.value);
        format!("a slip of the reflector on the tool before line {line:.0}")
    },
    explanation: "The reflector shifted in its nest, or the tool in its holder, at one moment. Fasten it, and measure \
        what came after again.",
    offer,
};

/// How far a reflector is likely to slip (m).
const LIKELY: f64 = 1e-4;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what == What::Clamped || scene.visits < FEWEST_VISITS {
        return;
    }
    let form = |(from, between): (usize, bool)| {
        let shift = |k: usize| {
            let of = move |at: &At<'_>| if at.row >= from { at.stand.tcp.axis(k) } else { nalgebra::Vector3::zeros() };
            Parameter::new(SHIFT[k], "m", Size::Of(LIKELY), Term::Reading(Rc::new(of)))
        };
        let form = Form::new(format!("from row {from}"), (0..3).map(shift).collect());
        Form { between, ..form.with(FROM, scene.line(from), "1") }
    };
    offers.add(Place::Rig, scene.moments().into_iter().map(form).collect());
}
