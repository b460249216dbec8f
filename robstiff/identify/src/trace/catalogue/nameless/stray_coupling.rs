//! A coupling of joints that have no part in common through which one could turn the other: a hose
//! package, or a compliance of the structure between them. A name for it would only be one for
//! something else.

use std::format;

use super::super::joint_coupling::{offer_of, without_drive};
use super::super::{Kind, Offers, Scene, place_words};

/// The kind.
pub static KIND: Kind = Kind {
    name: "stray_coupling",
    of_rig: false,
    words: |found| format!("a coupling of {}, which share no drive", place_words(found)),
    explanation: "",
    offer,
    on_axes: None,
};

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    offer_of(without_drive(scene.description), scene, offers);
}
