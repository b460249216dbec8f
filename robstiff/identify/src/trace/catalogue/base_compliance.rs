//! Foundation and pedestal: tilt about x and y of frame 0, and a displacement,
//! the same in every direction. The turn about z is joint 1's.

use super::{Kind, Offers, Part, Scene, two_compliances};
use robstiff::elements::Spring;

/// The kind.
pub static KIND: Kind = Kind {
    name: "base_compliance",
    of_rig: false,
    words: |_| "the compliance of foundation and pedestal".into(),
    explanation: "",
    offer,
    on_axes: None,
};

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let two = [("tilt", Spring::BaseTilt), ("translation", Spring::BaseTranslation)];
    two_compliances(scene, offers, Part::Base, two);
}
