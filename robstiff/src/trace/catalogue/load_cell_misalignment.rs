//! The load cell is turned against the frame that the file names: the force is
//! `R(theta) f`, the turn being constant in the base frame or in the tool's.

use super::{Form, IN_BASE, IN_TOOL, Kind, Number, Offers, Place, Scene, WRENCH_STEP};

/// The kind.
pub static KIND: Kind = Kind {
    name: "load_cell_misalignment",
    of_rig: true,
    words: |_| "a turn of the load cell against its frame".into(),
    offer,
};

/// Beyond this the frame is another one (rad).
const MOST: f64 = 0.35;

fn offer(_: &Scene<'_>, offers: &mut Offers<'_>) {
    let number = |k: usize| {
        let name = if k < 3 { IN_BASE[k] } else { IN_TOOL[k - 3] };
        Number::of_setup(
            name,
            "rad",
            MOST,
            move |setup, turn| {
                let cell = if k < 3 { &mut setup.in_base } else { &mut setup.in_tool };
                cell.turn[k % 3] += turn;
            },
            |point, enters| point.of_wrench(&**enters, WRENCH_STEP),
        )
    };
    let forms = [Form::of(0..3), Form::of(3..6)].into();
    offers.add(Place::Rig, (0..6).map(number).collect(), forms);
}
