//! What reads the displacement is turned against the frame that the file
//! names: `R(theta) delta`.

use super::{Form, Kind, Number, Offers, Place, Scene, TURN, WRENCH_STEP};

/// The kind.
pub static KIND: Kind = Kind {
    name: "tracker_misalignment",
    of_rig: true,
    words: |_| "a turn of the displacement readings against their frame".into(),
    explanation: "The tracker or the gauges were aligned to another frame than the file names. Align them anew to \
        the robot's base on three points or more, and turn the readings.",
    offer,
    on_axes: None,
};

/// Beyond this the frame is another one (rad).
const MOST: f64 = 0.35;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let number = |k: usize| {
        let tools = scene.tools();
        Number::of_setup(
            TURN[k],
            "rad",
            MOST,
            move |setup, turn| setup.tracker[k] += turn,
            move |point, enters| point.of_sight(&tools, &**enters, WRENCH_STEP),
        )
    };
    offers.add(Place::Rig, (0..3).map(number).collect(), [Form::of(0..3)].into());
}
