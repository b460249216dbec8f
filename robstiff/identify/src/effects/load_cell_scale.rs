//! The axes of the load cell read too little or too much, each by a share of its own. What is common to
//! all is a scale of all compliances and cannot be seen.

use super::{Form, Kind, Offers, Place, Scene, Side, three};
use crate::model::rig::{BASE, TOOL};

/// The kind.
pub static KIND: Kind = Kind {
    name: "load_cell_scale",
    side: Side::Rig,
    words: |_, _| "an unequal scale of the load cell's axes".into(),
    explanation: "The axes of the load cell are not calibrated alike: along each, 1 plus its number times what the file \
        says acts. Multiply the forces in the file by that, or hang one known weight along each axis, calibrate and \
        measure again.",
    offer,
};

/// What a scale is likely to be off by (1).
const LIKELY: f64 = 0.1;

const SCALE: [&str; 3] = ["sx", "sy", "sz"];

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.has_loads() {
        let base = three(SCALE, "1", LIKELY, |world, k, by| world.rig.force_scale[BASE][k] += by);
        let tool = three(SCALE, "1", LIKELY, |world, k, by| world.rig.force_scale[TOOL][k] += by);
        offers.add(
            Place::Rig,
            vec![
                Form::new("in the base frame", base),
                Form::new("in the tool frame", tool).with("tool_frame", 1.0, "1"),
            ],
        );
    }
}
