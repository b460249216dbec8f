//! The flange, the spindle or the tool gives way.

use robstiff::Effect;
use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side};
use crate::model::Parameter;
use crate::model::spring::{ACROSS, ALL, EACH, Site, Spring};

/// The kind.
pub static KIND: Kind = Kind {
    name: "tool_compliance",
    side: Side::Robot,
    words: |_, _| "the compliance of the flange, the spindle or the tool".into(),
    explanation: "",
    offer,
};

/// A spindle shifts by as much as it turns at this lever (m^2).
const SHIFTS: f64 = 0.5;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if !scene.is_loaded() {
        return;
    }
    let shift =
        |name, axes| Parameter::compliance(name, "m/N", SHIFTS * scene.middle, Spring::Shift(Site::Flange, axes));
    let size = 0.5 * scene.likely(scene.kinds.len());
    let turn = |name, axes| Parameter::compliance(name, "rad/Nm", size, Spring::Turn(Site::Flange, axes));
    let written = |rotation: f64, translation: f64| vec![Effect::ToolCompliance { rotation, translation }];
    offers.add(
        Part::Tool,
        vec![
            // What shifts alike in all directions shifts anywhere along the arm.
            Form::new("shift", vec![shift("translation", ALL)])
                .written(move |v| written(0.0, v[0]))
                .same_as("base_compliance@base"),
            Form::new("turn and shift", vec![turn("rotation", ALL), shift("translation", ALL)])
                .written(move |v| written(v[0], v[1])),
            Form::new("shift across and along", vec![shift("across", ACROSS), shift("along", EACH[2])]),
            Form::new("shifts", vec![shift("x", EACH[0]), shift("y", EACH[1]), shift("z", EACH[2])]),
            Form::new("turn", vec![turn("rotation", ALL)]).written(move |v| written(v[0], 0.0)),
            Form::new("turns", vec![turn("rx", EACH[0]), turn("ry", EACH[1])]),
        ],
    );
}
