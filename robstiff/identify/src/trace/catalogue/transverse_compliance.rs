//! Tilt of a joint about the x and y axes of its joint frame (bearing,
//! housing): `h [s(x) s(x)^T + s(y) s(y)^T] F`.

use std::format;

use super::{Kind, Offers, Part, Scene, one_compliance, place_words};
use robstiff::elements::Spring;

/// The kind.
pub static KIND: Kind = Kind {
    name: "transverse_compliance",
    of_rig: false,
    words: |found| format!("the tilt of {} about the axes across its own (bearing, housing)", place_words(found)),
    explanation: "",
    offer,
    on_axes: None,
};

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for joint in 1..=scene.joints() {
        one_compliance(scene, offers, Part::Joint(joint), "h", Spring::Transverse(joint));
    }
}
