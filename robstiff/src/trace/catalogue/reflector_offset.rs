//! The point whose absolute position is read is elsewhere on the tool than the file
//! says, by `r` in the tool frame. Displacements of one pose show it only where
//! the tool turns, and as a lever; there it has no name of its own.

use super::{Kind, Offers, Scene};

/// The kind.
pub static KIND: Kind = Kind {
    name: "reflector_offset",
    of_rig: true,
    words: |_| "a reflector that sits elsewhere on the tool than the file says".into(),
    explanation: "The reflector's nest was not where the file says, or the tool's length is another. Measure that point \
        in the tool frame, and enter it as where positions are measured.",
    offer,
    on_axes: None,
};

fn offer(_: &Scene<'_>, _: &mut Offers<'_>) {}
