//! The foundation and the pedestal give way: they tilt about x and y of frame 0, alike or not, or
//! shift.

use robstiff::Effect;
use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side};
use crate::model::Parameter;
use crate::model::spring::{ACROSS, EACH, Site, Spring};

/// The kind.
pub static KIND: Kind = Kind {
    name: "base_compliance",
    side: Side::Robot,
    words: |_, _| "the compliance of the base".into(),
    explanation: "",
    offer,
};

/// A foundation shifts by as much as it tilts at this height (1/m^2 of its tilt).
const SHIFTS: f64 = 1.0 / 3.0;

/// What tilts as the base does.
const JOINT_1: &str = "transverse_compliance@joint 1";

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if !scene.is_loaded() {
        return;
    }
    let size = 0.5 * scene.middle;
    let tilt = |name, axes| Parameter::compliance(name, "rad/Nm", size, Spring::Turn(Site::Base, axes));
    let shift = |name, axes| Parameter::compliance(name, "m/N", SHIFTS * scene.middle, Spring::Shift(Site::Base, axes));
    let written = |tilt: f64, translation: f64| vec![Effect::BaseCompliance { tilt, translation }];
    offers.add(
        Part::Base,
        vec![
            // Frame 0 tilts as joint 1 does.
            Form::new("tilt", vec![tilt("tilt", ACROSS)]).written(move |v| written(v[0], 0.0)).same_as(JOINT_1),
            Form::new("tilts", vec![tilt("tilt_x", EACH[0]), tilt("tilt_y", EACH[1])]).same_as(JOINT_1),
            Form::new("shifts", vec![shift("x", EACH[0]), shift("y", EACH[1]), shift("z", EACH[2])]),
        ],
    );
}
