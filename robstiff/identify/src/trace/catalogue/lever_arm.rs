//! The load acts elsewhere than the file says, by `r` in the tool frame: its
//! wrench at the TCP is `X(r) F`.

use std::format;

use super::{Form, Kind, Number, Offers, POINT, Place, Scene, WRENCH_STEP};

/// The kind.
pub static KIND: Kind = Kind {
    name: "lever_arm",
    of_rig: true,
    words: |found| {
        let shown = found.parameters.iter().filter(|number| POINT.contains(&number.name)).count();
        let part = if (1..POINT.len()).contains(&shown) { ", as far as these loads show" } else { "" };
        format!("a load that acts elsewhere on the tool than the file says{part}")
    },
    explanation: "The cable, the stinger or the weight holds the tool at another point than the file says. Measure \
        that point in the tool frame, and enter it as where the wrench acts.",
    offer,
    on_axes: None,
};

/// Further off it is another tool (m).
const MOST: f64 = 0.5;

fn offer(_: &Scene<'_>, offers: &mut Offers<'_>) {
    let number = |k: usize| {
        Number::of_setup(
            POINT[k],
            "m",
            MOST,
            move |setup, lever| setup.lever[k] += lever,
            |point, enters| point.of_wrench(&**enters, WRENCH_STEP),
        )
    };
    // A SCARA does not show the height of a lever, and three slides below a head a direction of
    // its own: what shows there are two components, or one.
    let fewer: [&[usize]; 6] = [&[0, 1], &[0, 2], &[1, 2], &[0], &[1], &[2]];
    let fewer = fewer.into_iter().map(|numbers| Form::of(numbers.iter().copied()).in_place_of_more());
    let forms = core::iter::once(Form::of(0..3)).chain(fewer).collect();
    offers.add(Place::Rig, (0..3).map(number).collect(), forms);
}
