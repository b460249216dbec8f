//! Without a name: an angle error of orders that no description takes.

use robstiff_robots::Place as Part;

use super::scene::What;
use super::transmission_error::waves;
use super::{Form, Kind, Offers, Scene, Side};

/// The kind.
pub static KIND: Kind = Kind {
    name: "harmonics",
    side: Side::Unnamed,
    words: |place, _| format!("an angle error of {} with three to six periods in a turn", place.words()),
    explanation: "A gear or encoder that errs several times in a turn.",
    offer,
};

/// What a wave is likely to be (rad).
const LIKELY: f64 = 1e-4;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what != What::Positions {
        return;
    }
    for joint in scene.turning() {
        let waves = (3..=6).flat_map(|order| waves(joint, order, LIKELY));
        offers.add(Part::Joint(joint), vec![Form::new("", waves.collect())]);
    }
}
