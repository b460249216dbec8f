//! The load acts elsewhere than the file says, by `r` in the tool frame: its
//! wrench at the TCP is `X(r) F`.

use super::{Form, Kind, Number, Offers, POINT, Place, Scene, WRENCH_STEP};

/// The kind.
pub static KIND: Kind = Kind {
    name: "lever_arm",
    of_rig: true,
    words: |_| "a load that acts elsewhere on the tool than the file says".into(),
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
    offers.add(Place::Rig, (0..3).map(number).collect(), [Form::of(0..3)].into());
}
