//! The zero of a joint's encoder is off. With absolute positions the table's numbers are fitted all
//! together, each a little off; here one stands out from the others.

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

/// What a zero is likely to be off by (rad): displacements show it only where it is far off.
const LIKELY_LOADED: f64 = 0.03;
const LIKELY_ABSOLUTE: f64 = 2e-3;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    let size = match scene.what {
        What::Displacements => LIKELY_LOADED,
        What::Positions => LIKELY_ABSOLUTE,
        What::Clamped => return,
    };
    // Of positions, where the robot stands takes the zero of its first joint.
    let is_seen = |joint: &usize| *joint > 1 || scene.what == What::Displacements;
    for joint in scene.turning().into_iter().filter(is_seen) {
        let zero = Parameter::new("offset", "rad", Size::Of(size), Term::Table(joint, THETA));
        let form = Form::new("", vec![zero]);
        offers
            .add(Part::Joint(joint), vec![form.written(move |v| vec![Effect::JointZeroOffset { joint, value: v[0] }])]);
    }
}
