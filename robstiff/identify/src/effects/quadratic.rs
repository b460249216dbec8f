//! Without a name: a joint that yields more one way than the other.

use std::rc::Rc;

use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{Parameter, Size, Term, Torques};

/// The kind.
pub static KIND: Kind = Kind {
    name: "quadratic",
    side: Side::Unnamed,
    words: |place, _| format!("a compliance of {} that depends on which way it is loaded", place.words()),
    explanation: "Nothing in the catalogue is like this: a gear whose flanks differ, or a balancer that bears on one side.",
    offer,
};

/// The likely part of the joint's compliance.
const LIKELY: f64 = 0.3;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if !scene.has_loads() {
        return;
    }
    for joint in scene.turning().into_iter().filter(|&joint| scene.is_driven(joint)) {
        let law = |torques: &Torques<'_>| torques.load.iter().map(|torque| torque.max(0.0)).collect();
        let size = LIKELY * scene.compliance[joint - 1];
        let added = Parameter::new("added", "rad/Nm", Size::Of(size), Term::Law(joint, Rc::new(law)));
        offers.add(Part::Joint(joint), vec![Form::new("", vec![added])]);
    }
}
