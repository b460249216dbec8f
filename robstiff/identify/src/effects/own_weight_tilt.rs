//! The bearing of a joint tilts under the arm's own weight.

use std::rc::Rc;

use robstiff_robots::Place as Part;

use super::own_weight::moment;
use super::scene::What;
use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "own_weight_tilt",
    side: Side::Unnamed,
    words: |place, _| format!("a tilt of {} under the arm's own weight", place.words()),
    explanation: "The links weigh on the bearing of the joint, across its axis. Loads with a measured displacement tell \
        what gives way.",
    offer,
};

/// How far it is likely to move the tool (m).
const LIKELY: f64 = 3e-4;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what != What::Positions {
        return;
    }
    for joint in scene.turning() {
        let tilt = |name, axis: usize| {
            let of = move |at: &At<'_>| at.stand.joints[joint - 1].axis(axis).dot(&moment(at.stand, joint));
            Parameter::new(name, "rad", Size::Moves(LIKELY), Term::Aside(joint, axis, Rc::new(of)))
        };
        offers.add(Part::Joint(joint), vec![Form::new("", vec![tilt("x", 0), tilt("y", 1)])]);
    }
}
