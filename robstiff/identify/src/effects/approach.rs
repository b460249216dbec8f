//! Without a name: where a joint stops depends on the side that it comes from.

use std::rc::Rc;

use robstiff_robots::Place as Part;

use super::scene::What;
use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "approach",
    side: Side::Unnamed,
    words: |place, _| format!("a stop of {} that depends on the side that it comes from", place.words()),
    explanation: "Friction or backlash in the joint: approach every pose from the same side.",
    offer,
};

/// What it is likely to be (rad).
const LIKELY: f64 = 1e-4;

/// A joint that moves by less has no side that it comes from (rad).
const STILL: f64 = 5e-5;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what != What::Positions {
        return;
    }
    for joint in scene.turning() {
        let of = move |at: &At<'_>| {
            let moved = at.q[joint - 1] - at.before[joint - 1];
            if moved.abs() < STILL { 0.0 } else { moved.signum() }
        };
        let side = Parameter::new("side", "rad", Size::Of(LIKELY), Term::Aside(joint, 2, Rc::new(of)));
        offers.add(Part::Joint(joint), vec![Form::new("", vec![side])]);
    }
}
