//! Without a name: the readings wander, there and back.

use core::f64::consts::PI;

use super::scene::What;
use super::{Form, Kind, Offers, Place, SHIFT, Scene, Side, three_readings};

/// The kind.
pub static KIND: Kind = Kind {
    name: "wandering",
    side: Side::Unnamed,
    words: |_, _| "readings that wander there and back".into(),
    explanation: "The stand of the tracker or the foundation moves. Read a fixed point in between.",
    offer,
};

/// Half waves over the campaign, and how far they are likely to go (m).
const WAVES: usize = 8;
const LIKELY: f64 = 8e-5;

/// Fewer visits do not tell so many waves.
const FEWEST_VISITS: usize = 20;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what == What::Clamped || scene.visits < FEWEST_VISITS {
        return;
    }
    // Where absolute positions begin is where the robot stands.
    let first = if scene.what == What::Positions { 1 } else { 0 };
    let waves = (first..=WAVES).flat_map(|wave| {
        let size = LIKELY / (1.0 + wave as f64).powf(0.8);
        three_readings(SHIFT, "m", size, move |at| (PI * wave as f64 * at.time).cos())
    });
    offers.add(Place::Rig, vec![Form::new("", waves.collect())]);
}
