//! Without a name: a joint is taken along by its neighbour.

use std::rc::Rc;

use robstiff_robots::Place as Part;

use super::scene::What;
use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "kinematic_coupling",
    side: Side::Unnamed,
    words: |place, _| format!("a coupling of the angles of {}", place.words()),
    explanation: "One joint turns another by gearing that the controller does not take into account.",
    offer,
};

/// The likely part of the other's angle.
const LIKELY: f64 = 3e-4;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what != What::Positions {
        return;
    }
    let turning = scene.turning();
    for pair in turning.windows(2) {
        let [first, second] = [pair[0], pair[1]];
        if second != first + 1 {
            continue;
        }
        for (joint, other) in [(first, second), (second, first)] {
            let of = move |at: &At<'_>| at.q[other - 1];
            let share = Parameter::new("share", "1", Size::Of(LIKELY), Term::Aside(joint, 2, Rc::new(of)));
            offers.add(Part::Joints([joint, other]), vec![Form::new("", vec![share])]);
        }
    }
}
