//! A link as a uniform, round beam between two joint frames: `L / EI` and
//! `L / GJ`.

use std::format;

use super::{Kind, Offers, Part, Scene, place_words, two_compliances};
use robstiff::elements::Spring;

/// The kind.
pub static KIND: Kind = Kind {
    name: "link_compliance",
    of_rig: false,
    words: |found| {
        let motion = match (found.value("bending") != 0.0, found.value("torsion") != 0.0) {
            (true, false) => "bending",
            (false, true) => "torsion",
            _ => "bending and torsion",
        };
        format!("the {motion} of {}", place_words(found))
    },
    explanation: "",
    offer,
    on_axes: None,
};

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for link in (1..scene.joints()).filter(|&link| !scene.description.is_stroke(link)) {
        let two = [("bending", Spring::LinkBending(link)), ("torsion", Spring::LinkTorsion(link))];
        two_compliances(scene, offers, Part::Link(link), two);
    }
}
