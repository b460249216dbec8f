//! A joint turns by more or less than its encoder says, in proportion.

use std::rc::Rc;

use robstiff_robots::Place as Part;

use super::scene::What;
use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "encoder_scale",
    side: Side::Unnamed,
    words: |place, _| format!("an encoder of {} with a scale of its own", place.words()),
    explanation: "The gear ratio or the line count in the controller is not that of the joint.",
    offer,
};

/// What a scale is likely to be off by (1).
const LIKELY: f64 = 3e-4;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what != What::Positions {
        return;
    }
    for joint in scene.turning() {
        let of = move |at: &At<'_>| at.q[joint - 1];
        let scale = Parameter::new("scale", "1", Size::Of(LIKELY), Term::Aside(joint, 2, Rc::new(of)));
        offers.add(Part::Joint(joint), vec![Form::new("", vec![scale])]);
    }
}
