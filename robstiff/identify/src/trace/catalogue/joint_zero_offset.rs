//! The zero of a joint's coordinate is off. Differences of one pose show it
//! only as `d(H F)/dq`: the arm stands where the file does not say.

use std::format;
use std::vec;

use super::{Form, Kind, Number, Offers, Part, Scene, place_words};
use crate::identify::setup::coordinate_entry;

/// The kind.
pub static KIND: Kind = Kind {
    name: "joint_zero_offset",
    of_rig: false,
    words: |found| format!("the offset of the zero of {}", place_words(found)),
    explanation: "",
    offer,
    on_axes: None,
};

/// Beyond this a zero is not off but elsewhere (rad, m).
pub const MOST: [f64; 2] = [0.2, 0.1];

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for joint in 1..=scene.joints() {
        let entry = coordinate_entry(scene.samples.joint_kinds[joint - 1]);
        let number = Number::of_setup(
            "offset",
            ["rad", "m"][entry],
            MOST[entry],
            move |setup, offset| setup.table[joint - 1][entry] += offset,
            move |point, _| point.slope(joint, entry, |_| 1.0),
        );
        offers.add(Part::Joint(joint), vec![number], vec![Form::of([0])]);
    }
}
