//! Numbers in sentences.

use std::format;
use std::string::String;

pub use robstiff_robots::words::{and, count};

/// A share in percent.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent.abs() < 9.95 { format!("{percent:.1} %") } else { format!("{percent:.0} %") }
}

/// A length in micrometres.
pub fn micrometres(length: f64) -> String {
    format!("{:.1} um", 1e6 * length)
}
