//! An axis of the load cell reads too little or, where `s` is negative, too much:
//! `(1 + s) f` acts, by axis of the base frame or the tool's. What is common to all axes is a scale of
//! all compliances and cannot be seen, so at most two axes are off against the
//! third.

use std::format;
use std::vec;
use std::vec::Vec;

use super::{Form, Kind, Number, Offers, Place, Scene, WRENCH_STEP, frame_words};

/// The kind.
pub static KIND: Kind = Kind {
    name: "load_cell_scale",
    of_rig: true,
    words: |found| format!("an unequal scale of the load cell's axes, those of the {}", frame_words(found)),
    explanation: "The axes of the load cell are not calibrated alike: along each, 1 plus its number times what the file \
        says acts. Multiply the forces in the file by that, or hang one known weight along each axis, calibrate and \
        measure anew.",
    offer,
    on_axes: None,
};

/// Beyond this it is no scale but a fault (1).
const MOST: f64 = 0.5;

fn offer(_: &Scene<'_>, offers: &mut Offers<'_>) {
    let number = |k: usize| {
        Number::of_setup(
            ["sx", "sy", "sz"][k % 3],
            "1",
            MOST,
            move |setup, scale| {
                let cell = if k < 3 { &mut setup.in_base } else { &mut setup.in_tool };
                cell.scale[k % 3] += scale;
            },
            |point, enters| point.of_wrench(&**enters, WRENCH_STEP),
        )
    };
    let forms: Vec<Form> = [0, 3]
        .into_iter()
        .flat_map(|first| [vec![0], vec![1], vec![2], vec![0, 1], vec![0, 2], vec![1, 2]].map(|k| (first, k)))
        .map(|(first, axes)| (first, Form::of(axes.into_iter().map(|axis: usize| first + axis))))
        .map(|(first, form)| if first == 0 { form } else { form.in_tool() })
        .collect();
    offers.add(Place::Rig, (0..6).map(number).collect(), forms);
}
