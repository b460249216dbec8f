//! The load acts at another point of the tool than the file says.

use super::{Form, Kind, Offers, POINT, Place, Scene, Side, three};

/// The kind.
pub static KIND: Kind = Kind {
    name: "lever_arm",
    side: Side::Rig,
    words: |_, _| "a load that acts elsewhere on the tool than the file says".into(),
    explanation: "The cable, the stinger or the weight holds the tool at another point than the file says. Measure that \
        point in the tool frame, and enter it as where the wrench acts.",
    offer,
};

/// What a point is likely to be off by (m).
const LIKELY: f64 = 0.08;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.is_loaded() {
        let lever = three(POINT, "m", LIKELY, |world, k, by| world.rig.lever[k] += by);
        offers.add(Place::Rig, vec![Form::new("", lever)]);
    }
}
