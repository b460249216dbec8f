//! Readings that do not belong to the others. They are found by their weights, not by columns.

use super::{Kind, Side};

/// The kind.
pub static KIND: Kind = Kind {
    name: "outliers",
    side: Side::Rig,
    words: |_, numbers| {
        let rows = numbers.iter().find(|number| number.name == "rows").map_or(0.0, |number| number.value);
        format!("{rows:.0} outlying reading{}", if rows == 1.0 { "" } else { "s" })
    },
    explanation: "A reading that does not belong to the others: a reflector that was knocked, a beam that was broken, a \
        slip of the pen. The fit gives it next to no weight. Look at these lines, and measure them again.",
    offer: |_, _| {},
};
