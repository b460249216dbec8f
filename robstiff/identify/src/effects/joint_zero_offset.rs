//! The zero of a joint's encoder is off. With absolute positions it is one of the table's numbers,
//! which are fitted all together.

use robstiff::Effect;
use robstiff_robots::Place as Part;

use super::scene::What;
use super::{Form, Kind, Offers, Scene, Side};
use crate::model::arm::THETA;
use crate::model::{Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "joint_zero_offset",
    side: Side::Robot,
    words: |place, _| format!("the zero offset of {}", place.words()),
    explanation: "",
    offer,
};

/// What a zero is likely to be off by (rad).
const LIKELY: f64 = 0.03;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what != What::Displacements {
        return;
    }
    for joint in scene.turning() {
        let zero = Parameter::new("offset", "rad", Size::Of(LIKELY), Term::Table(joint, THETA));
        let form = Form::new("", vec![zero]);
        offers
            .add(Part::Joint(joint), vec![form.written(move |v| vec![Effect::JointZeroOffset { joint, value: v[0] }])]);
    }
}
