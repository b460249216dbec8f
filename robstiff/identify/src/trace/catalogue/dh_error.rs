//! A length or twist of the DH table is off; seen, as a zero offset is, only
//! through `d(H F)`. The entry that a joint's coordinate adds to is its zero.

use std::format;
use std::vec;

use robstiff_robots::effect::DhEntry;

use super::{Form, Kind, Number, Offers, Part, Scene, place_words};
use crate::identify::setup::coordinate_entry;

/// The kind.
pub static KIND: Kind = Kind {
    name: "dh_error",
    of_rig: false,
    words: |found| format!("the error of {} in the DH table", place_words(found)),
    explanation: "",
    offer,
    on_axes: None,
};

/// Beyond this a table is not off but another robot's (rad, m, m, rad).
pub const MOST: [f64; 4] = [0.125, 0.125, 0.125, 0.125];
/// The units of a table's entries.
pub const UNITS: [&str; 4] = ["rad", "m", "m", "rad"];

/// The entries of a row, in the order of a setup's table.
pub const ENTRIES: [fn(usize) -> DhEntry; 4] = [DhEntry::Theta, DhEntry::D, DhEntry::A, DhEntry::Alpha];

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for row in 1..=scene.joints() {
        let coordinate = coordinate_entry(scene.samples.joint_kinds[row - 1]);
        for entry in (0..4).filter(|&entry| entry != coordinate) {
            let number = Number::of_setup(
                "value",
                UNITS[entry],
                MOST[entry],
                move |setup, error| setup.table[row - 1][entry] += error,
                move |point, _| point.slope(row, entry, |_| 1.0),
            );
            offers.add(Part::Entry(ENTRIES[entry](row)), vec![number], vec![Form::of([0])]);
        }
    }
}
