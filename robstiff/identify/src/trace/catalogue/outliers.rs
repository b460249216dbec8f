//! Readings that have nothing to do with the others: a few rows, or the
//! unloaded reading of a visit. They have no columns; [`isolated`] finds them.
//!
//! [`isolated`]: crate::trace::isolated

use std::format;

use super::{Kind, Offers, Scene};

/// The kind.
pub static KIND: Kind = Kind {
    name: "outliers",
    of_rig: true,
    words: |found| {
        let rows = found.value("rows");
        format!("{rows} wild reading{}", if rows == 1.0 { "" } else { "s" })
    },
    explanation: "A knocked reflector, a gauge that stuck, a slip of the pen. Repeat these readings; they do not \
        count in any fit until then.",
    offer,
    on_axes: None,
};

fn offer(_: &Scene<'_>, _: &mut Offers<'_>) {}
