//! A joint tilts about the axes across its own: its bearing or housing gives way, alike about both
//! or not.

use robstiff::Effect;
use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side};
use crate::model::Parameter;
use crate::model::spring::{ACROSS, EACH, Site, Spring};

/// The kind.
pub static KIND: Kind = Kind {
    name: "transverse_compliance",
    side: Side::Robot,
    words: |place, _| format!("the tilt of {} about the axes across its own (bearing, housing)", place.words()),
    explanation: "",
    offer,
};

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if !scene.is_loaded() {
        return;
    }
    // Frame 0 tilts as the first joint does: that is the base, which lists it as the same.
    for joint in scene.joints().skip(1) {
        let size = 0.5 * scene.likely(joint);
        let tilt = |name, axes| Parameter::compliance(name, "rad/Nm", size, Spring::Turn(Site::Joint(joint), axes));
        offers.add(
            Part::Joint(joint),
            vec![
                Form::new("alike", vec![tilt("h", ACROSS)])
                    .written(move |v| vec![Effect::TransverseCompliance { joint, value: v[0] }]),
                Form::new("unequal", vec![tilt("x", EACH[0]), tilt("y", EACH[1])]),
            ],
        );
    }
}
