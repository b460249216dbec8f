//! A joint that gives way otherwise one way than the other: a gear whose flanks differ, a spring
//! or balancer that bears on one side. It turns by `h (tau + added max(tau, 0))`.

use std::format;
use std::vec;

use super::super::{Form, Kind, Number, Offers, Part, Scene, place_words};

/// The kind.
pub static KIND: Kind = Kind {
    name: "one_sided_compliance",
    of_rig: false,
    words: |found| format!("a compliance of {} that depends on which way it is loaded", place_words(found)),
    explanation: "",
    offer,
    on_axes: None,
};

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for joint in (1..=scene.joints()).filter(|&joint| scene.largest_torque(joint).is_some()) {
        let added = Number::elastic("added", "1", [f64::NEG_INFINITY, f64::INFINITY], move |point| {
            let torques = point.torques(joint);
            point.of_joint(joint, |row| torques[row].max(0.0))
        });
        offers.add(Part::Joint(joint), vec![Number { share_of: Some(joint), ..added }], vec![Form::of([0])]);
    }
}
