//! All that is read is too long or too short by one share.

use super::scene::What;
use super::{Form, Kind, Offers, Place, Scene, Side};
use crate::model::Parameter;

/// The kind.
pub static KIND: Kind = Kind {
    name: "tracker_scale",
    side: Side::Rig,
    words: |_, _| "a scale of the position readings".into(),
    explanation: "Every length that is read is off by one share: the instrument corrects for another air temperature or \
        wavelength than there is, or a camera's scale bar is off. Check it against a length that is known.",
    offer,
};

/// What a scale is likely to be off by (1).
const LIKELY: f64 = 1e-4;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what == What::Positions {
        let scale = Parameter::of_world("scale", "1", LIKELY, |world, by| world.rig.reading_scale += by);
        offers.add(Place::Rig, vec![Form::new("", vec![scale])]);
    }
}
