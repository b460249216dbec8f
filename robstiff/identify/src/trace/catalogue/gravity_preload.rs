//! The gears carry the arm's own weight before the load. By itself it shows in nothing: it
//! says about which torque the curves of gears are, and is found with these
//! ([`preload`](crate::trace::preload)).

use super::Kind;

/// The kind.
pub static KIND: Kind = Kind {
    name: "gravity_preload",
    of_rig: false,
    words: |_| "the weight of the arm on its gears, which their curves begin at".into(),
    explanation: "",
    offer: |_, _| {},
    on_axes: None,
};
