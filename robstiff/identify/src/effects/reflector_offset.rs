//! The point that is read is elsewhere on the tool than the file says.

use super::{Form, Kind, Offers, POINT, Place, Scene, Side, three};

/// The kind.
pub static KIND: Kind = Kind {
    name: "reflector_offset",
    side: Side::Rig,
    words: |_, _| "a reflector that sits elsewhere on the tool than the file says".into(),
    explanation: "The reflector's nest is not where the file says, or the tool's length is another. Measure that point \
        in the tool frame, and enter it as where displacements or positions are measured.",
    offer,
};

/// What a point is likely to be off by (m).
const LIKELY: f64 = 0.08;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    // With absolute positions it is always fitted.
    if scene.has_loads() {
        let reflector = three(POINT, "m", LIKELY, |world, k, by| world.rig.reflector[k] += by);
        offers.add(Place::Rig, vec![Form::new("", reflector)]);
    }
}
