//! Without a name: something between the load cell and the tool holds a part of the load back.

use std::rc::Rc;

use super::{Form, Kind, Offers, Place, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "load_friction",
    side: Side::Unnamed,
    words: |_, _| {
        "a load that is held back while it grows, and while it falls (friction between load cell and tool)".into()
    },
    explanation: "Nothing in the catalogue is like this. Measure the force at the tool, without pulleys between.",
    offer,
};

/// The likely part of the load (1).
const LIKELY: f64 = 0.05;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.has_loads() && scene.visits < scene.visit.len() {
        let held_back = |at: &At<'_>| -at.growing;
        let share = Parameter::new("share", "1", Size::Of(LIKELY), Term::Gain(Rc::new(held_back))).nonnegative();
        offers.add(Place::Rig, vec![Form::new("", vec![share])]);
    }
}
