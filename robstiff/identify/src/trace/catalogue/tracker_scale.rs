//! What reads absolute positions says all lengths too long or too short: `(1 + s) p`.
//! An arm that is warmer all over than when its description was true says the same,
//! and no reading of a point on its tool tells which of the two it is. Of displacements
//! it is a scale of all compliances and cannot be seen.

use super::{Kind, Offers, Scene};

/// The kind.
pub static KIND: Kind = Kind {
    name: "tracker_scale",
    of_rig: true,
    words: |_| "a scale of all lengths, the tracker's or a warmer arm's".into(),
    explanation: "All lengths are read too long or too short by the same share. Read a calibrated length with the \
        tracker, and look at its settings for refraction; a warm arm is longer all over, by 12e-6 a kelvin of steel \
        or iron, 23e-6 of aluminium.",
    offer,
    on_axes: None,
};

fn offer(_: &Scene<'_>, _: &mut Offers<'_>) {}
