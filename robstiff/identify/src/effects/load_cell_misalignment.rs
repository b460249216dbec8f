//! The load cell is turned against the frame that the file names, constant in the base frame or in
//! the tool's.

use super::{Form, Kind, Offers, Place, Scene, Side, TURN, three};
use crate::model::rig::{BASE, TOOL};

/// The kind.
pub static KIND: Kind = Kind {
    name: "load_cell_misalignment",
    side: Side::Rig,
    words: |_, _| "a turn of the load cell against its frame".into(),
    explanation: "The load cell is mounted at another angle than the file says, its frame is named wrongly, or weights \
        hang on a base that is not level. Pull along a known line, a plumb line for one, and compare; forces in the file \
        turned by this rotation vector are what acts.",
    offer,
};

/// What an angle is likely to be off by (rad).
const LIKELY: f64 = 0.1;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.has_loads() {
        let base = three(TURN, "rad", LIKELY, |world, k, by| world.rig.force_turn[BASE][k] += by);
        let tool = three(TURN, "rad", LIKELY, |world, k, by| world.rig.force_turn[TOOL][k] += by);
        offers.add(
            Place::Rig,
            vec![
                Form::new("in the base frame", base),
                Form::new("in the tool frame", tool).with("tool_frame", 1.0, "1"),
            ],
        );
    }
}
