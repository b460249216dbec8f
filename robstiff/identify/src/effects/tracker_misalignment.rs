//! The readings are turned against the frame that the file names, constant in the base frame or in the
//! tool's.

use super::{Form, Kind, Offers, Place, Scene, Side, TURN, three};
use crate::model::rig::{BASE, TOOL};

/// The kind.
pub static KIND: Kind = Kind {
    name: "tracker_misalignment",
    side: Side::Rig,
    words: |_, _| "a turn of the displacement readings against their frame".into(),
    explanation: "The frame of the readings is not the one that the file names: the tracker was registered to the robot \
        wrongly, or the probe is mounted at another angle. Register it again; displacements in the file turned back by \
        this rotation vector are what moved.",
    offer,
};

/// What an angle is likely to be off by (rad).
const LIKELY: f64 = 0.07;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.has_loads() {
        let base = three(TURN, "rad", LIKELY, |world, k, by| world.rig.reading_turn[BASE][k] += by);
        let tool = three(TURN, "rad", LIKELY, |world, k, by| world.rig.reading_turn[TOOL][k] += by);
        offers.add(
            Place::Rig,
            vec![
                Form::new("in the base frame", base),
                Form::new("in the tool frame", tool).with("tool_frame", 1.0, "1"),
            ],
        );
    }
}
