//! The robot or the tracker shifted at some moment, and stayed there.

use std::rc::Rc;

use nalgebra::Vector3;
use robstiff_robots::Place as Part;

use super::scene::What;
use super::thermal_drift::FEWEST_VISITS;
use super::{Form, Kind, Offers, SHIFT, Scene, Side, TURN, three_readings};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "base_slip",
    side: Side::Rig,
    words: |_, numbers| {
        let line = numbers.iter().find(|number| number.name == FROM).map_or(0.0, |number| number.value);
        format!("a slip of the base or of the tracker before line {line:.0}")
    },
    explanation: "The robot shifted on its foundation, or the tracker on its stand, at one moment. Fasten it, and \
        measure what came after again.",
    offer,
};

/// The first line after it.
pub(super) const FROM: &str = "from_line";

/// How far something is likely to slip (m), and to turn about the base (rad).
const LIKELY: f64 = 1e-4;
const LIKELY_TURN: f64 = 1e-4;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what == What::Clamped || scene.visits < FEWEST_VISITS {
        return;
    }
    let form = |(from, between): (usize, bool), turns: bool| {
        let after = move |at: &At<'_>| if at.row >= from { 1.0 } else { 0.0 };
        let mut parameters = three_readings(SHIFT, "m", LIKELY, after);
        if turns {
            let turn = |k: usize| {
                let of = move |at: &At<'_>| Vector3::ith(k, after(at)).cross(&at.stand.tcp.at);
                Parameter::new(TURN[k], "rad", Size::Of(LIKELY_TURN), Term::Reading(Rc::new(of)))
            };
            parameters.extend((0..3).map(turn));
        }
        let label = if turns { "shift and turn" } else { "shift" };
        let form = Form::new(format!("{label} from row {from}"), parameters).with(FROM, scene.line(from), "1");
        Form { between, ..form }
    };
    // A turn is tried where something slipped, and everywhere only where there are few columns otherwise.
    let turns = |(_, near): &(usize, bool)| *near || scene.what == What::Positions;
    let moments = scene.moments();
    let turned = moments.iter().filter(|moment| turns(moment)).map(|moment| form(*moment, true));
    offers.add(Part::Base, moments.iter().map(|moment| form(*moment, false)).chain(turned).collect());
}
