//! A number of the table is off: a length or a twist. With absolute positions all of them are fitted
//! together, each a little off; here one stands out from the others.

use robstiff::Effect;
use robstiff_robots::{DhEntry, Place as Part};

use super::scene::What;
use super::{Form, Kind, Offers, Scene, Side};
use crate::model::arm::{A, ALPHA, D};
use crate::model::{Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "dh_error",
    side: Side::Robot,
    words: |place, _| format!("an error of {}", place.words()),
    explanation: "",
    offer,
};

/// What a number is likely to be off by (m, rad): displacements show it only where a file has another
/// arm's, positions show what is worn or was set up wrongly.
const LIKELY_LOADED: [f64; 2] = [2e-2, 2e-2];
const LIKELY_ABSOLUTE: [f64; 2] = [1e-3, 1e-3];

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    let [length, angle] = match scene.what {
        What::Displacements => LIKELY_LOADED,
        What::Positions => LIKELY_ABSOLUTE,
        What::Clamped => return,
    };
    for joint in scene.joints() {
        let entries = [
            (DhEntry::A(joint), A, "m", length),
            (DhEntry::D(joint), D, "m", length),
            (DhEntry::Alpha(joint), ALPHA, "rad", angle),
        ];
        for (entry, number, unit, size) in entries {
            // Of positions, where the robot stands takes the height of its first axis.
            if number == D && joint == 1 && scene.what == What::Positions {
                continue;
            }
            let off = Parameter::new("value", unit, Size::Of(size), Term::Table(joint, number));
            offers.add(
                Part::Entry(entry),
                vec![Form::new("", vec![off]).written(move |v| vec![Effect::DhError { entry, value: v[0] }])],
            );
        }
    }
}
