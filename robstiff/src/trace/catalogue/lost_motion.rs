//! Lost motion: the steep part of a gear about zero torque. The joint turns by
//! `gap / 2 tau / sqrt(tau^2 + knee^2)` on top of `h tau`, a smooth sign of the
//! torque whose knee is well below the loads. That is what hardening does,
//! `added = gap / (2 knee)`: which it is, the knee says, and between them it may
//! be either.

use std::format;
use std::vec::Vec;

use super::{Form, Kind, Number, Offers, Part, Scene, place_words};

/// The kind.
pub static KIND: Kind = Kind {
    name: "lost_motion",
    of_rig: false,
    words: |found| format!("the lost motion of {} about zero torque", place_words(found)),
    explanation: "",
    offer,
};

/// The knees tried, as fractions of the largest torque seen on the joint: lost
/// motion is over below some 3 % of what a gear is made for.
const KNEES: [f64; 3] = [1.0 / 64.0, 1.0 / 32.0, 1.0 / 16.0];

/// Knees that may be either's, as fractions of the largest torque: between the
/// grids of the two and half a step into each, for no knee is known better.
pub const EITHER: [f64; 2] = [1.0 / 24.0, 1.0 / 6.0];

/// A gap of a degree is a gear that is broken (rad); on a sliding joint (m).
const WIDEST: f64 = 0.0175;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for joint in 1..=scene.joints() {
        let Some(largest) = scene.largest_torque(joint) else { continue };
        let [gap, torque] = if scene.turns(joint) { ["rad", "Nm"] } else { ["m", "N"] };
        let number = move |knee: f64| {
            Number::elastic("gap", gap, [0.0, WIDEST], move |point| {
                let torques = point.torques(joint);
                point.of_joint(joint, |row| 0.5 * torques[row] / torques[row].hypot(knee))
            })
        };
        let knees = KNEES.map(|fraction| fraction * largest);
        let forms = (0..).zip(knees).map(|(k, knee)| Form::of([k]).with("knee", knee, torque));
        let forms = forms.map(|form| form.refined(move |knees| [number(knees[0])].into()));
        let forms = forms.map(|form| form.within([0.0, EITHER[1] * largest])).collect();
        let numbers: Vec<Number> = knees.map(number).into();
        offers.add(Part::Joint(joint), numbers, forms);
    }
}
