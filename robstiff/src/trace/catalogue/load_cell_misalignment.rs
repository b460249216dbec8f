//! The load cell is turned against the frame that the file names: the force is
//! `R(theta) f`, the turn being constant in the base frame or in the tool's.

use std::format;

use super::{Form, Kind, Number, Offers, Place, Scene, TURN, WRENCH_STEP, frame_words};

/// The kind.
pub static KIND: Kind = Kind {
    name: "load_cell_misalignment",
    of_rig: true,
    words: |found| format!("a turn of the load cell, constant in the {}", frame_words(found)),
    explanation: "The load cell is mounted at another angle than the file says, or its frame is named wrongly. Pull \
        along a known line, a plumb line for one, and compare.",
    offer,
    on_axes: None,
};

/// Beyond this the frame is another one (rad).
const MOST: f64 = 0.35;

fn offer(_: &Scene<'_>, offers: &mut Offers<'_>) {
    let number = |k: usize| {
        Number::of_setup(
            TURN[k % 3],
            "rad",
            MOST,
            move |setup, turn| {
                let cell = if k < 3 { &mut setup.in_base } else { &mut setup.in_tool };
                cell.turn[k % 3] += turn;
            },
            |point, enters| point.of_wrench(&**enters, WRENCH_STEP),
        )
    };
    let forms = [Form::of(0..3), Form::of(3..6).in_tool()].into();
    offers.add(Place::Rig, (0..6).map(number).collect(), forms);
}
