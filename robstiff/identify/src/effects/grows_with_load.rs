//! Without a name: the arm yields more, or less, under larger loads, all of it alike.

use std::rc::Rc;

use super::{Form, Kind, Offers, Place, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "grows_with_load",
    side: Side::Unnamed,
    words: |_, _| "readings that are not in proportion to the load (a load cell that is not linear)".into(),
    explanation: "Nothing in the catalogue is like this. Check the load cell at several loads.",
    offer,
};

/// The likely part (1).
const LIKELY: f64 = 0.1;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.has_loads() {
        let grows = |at: &At<'_>| at.load;
        let share = Parameter::new("share", "1", Size::Of(LIKELY), Term::Gain(Rc::new(grows)));
        offers.add(Place::Rig, vec![Form::new("", vec![share])]);
    }
}
