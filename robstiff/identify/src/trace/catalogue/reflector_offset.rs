//! The point that is read is elsewhere on the tool than the file says, by `r` in
//! the tool frame. A displacement shows it only where the tool turns, and as a
//! lever: `r` from the point, it is `theta x r` more.

use std::format;

use super::{Form, Kind, Number, Offers, POINT, Place, Scene};

/// The kind.
pub static KIND: Kind = Kind {
    name: "reflector_offset",
    of_rig: true,
    words: |found| {
        let shown = found.parameters.iter().filter(|number| POINT.contains(&number.name)).count();
        let part = if (1..POINT.len()).contains(&shown) { ", as far as these turns show" } else { "" };
        format!("a reflector that sits elsewhere on the tool than the file says{part}")
    },
    explanation: "The reflector's nest was not where the file says, or the tool's length is another. Measure that point \
        in the tool frame, and enter it as where displacements or positions are measured.",
    offer,
    on_axes: None,
};

/// Further off it is on another tool (m).
const MOST: f64 = 0.5;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    if !scene.elsewhere {
        return;
    }
    let number = |k: usize| {
        Number::of_setup(
            POINT[k],
            "m",
            MOST,
            move |setup, offset| setup.marker[k] += offset,
            move |point, _| point.of_marker(k),
        )
    };
    // A SCARA turns its tool about one line only, along which a reflector may be anywhere.
    let fewer: [&[usize]; 6] = [&[0, 1], &[0, 2], &[1, 2], &[0], &[1], &[2]];
    let fewer = fewer.into_iter().map(|numbers| Form::of(numbers.iter().copied()).in_place_of_more());
    let forms = core::iter::once(Form::of(0..3)).chain(fewer).collect();
    offers.add(Place::Rig, (0..3).map(number).collect(), forms);
}
