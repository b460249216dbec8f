//! The reflector moved on the tool at some moment: every absolute position from then on
//! is of another point, off by `r` in the tool frame. Displacements of one pose show it
//! only where the unloaded reading was before it; there it has no name of its own.

use std::format;

use super::{Kind, Offers, Scene};

/// The kind.
pub static KIND: Kind = Kind {
    name: "reflector_slip",
    of_rig: true,
    words: |found| format!("a slip of the reflector on the tool before line {}", found.value("line")),
    explanation: "The reflector moved in its nest, or the nest on the tool, between two readings. Fix it, and measure \
        the points anew from there on.",
    offer,
    on_axes: None,
};

fn offer(_: &Scene<'_>, _: &mut Offers<'_>) {}
