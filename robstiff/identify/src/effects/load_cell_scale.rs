//! The axes of the load cell read too little or too much, each by a share of its own. What is common to
//! all is a scale of all compliances and cannot be seen, so one axis is taken to be right.

use super::{Form, Kind, Offers, Place, Scene, Side, three};
use crate::model::Parameter;
use crate::model::rig::{BASE, TOOL};

/// The kind.
pub static KIND: Kind = Kind {
    name: "load_cell_scale",
    side: Side::Rig,
    words: |_, _| "an unequal scale of the load cell's axes".into(),
    explanation: "The axes of the load cell are not calibrated alike: along each, 1 plus its number times what the file \
        says acts, if the axis without a number is right. Multiply the forces in the file by that, or hang one known \
        weight along each axis, calibrate and measure again.",
    offer,
};

/// What a scale is likely to be off by (1).
const LIKELY: f64 = 0.1;

const SCALE: [&str; 3] = ["sx", "sy", "sz"];

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.has_loads() {
        let base = three(SCALE, "1", LIKELY, |world, k, by| world.rig.force_scale[BASE][k] += by);
        let tool = three(SCALE, "1", LIKELY, |world, k, by| world.rig.force_scale[TOOL][k] += by);
        // Which axis is right cannot be seen either; small numbers are likely.
        let others = |all: &[Parameter], right: usize| -> Vec<Parameter> {
            all.iter().enumerate().filter(|(axis, _)| *axis != right).map(|(_, scale)| scale.clone()).collect()
        };
        let forms = (0..3).flat_map(|right| {
            let axis = ["x", "y", "z"][right];
            [
                Form::new(format!("in the base frame, {axis} right"), others(&base, right)),
                Form::new(format!("in the tool frame, {axis} right"), others(&tool, right)).with(
                    "tool_frame",
                    1.0,
                    "1",
                ),
            ]
        });
        offers.add(Place::Rig, forms.collect());
    }
}
