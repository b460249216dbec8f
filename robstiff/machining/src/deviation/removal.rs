//! How much a cut removes.

use crate::milling::Cut;

/// The radial width of a cut (m): what its engagement takes across the feed.
pub fn width(cut: &Cut) -> f64 {
    0.5 * cut.mill.diameter * (cut.engagement.entry.cos() - cut.engagement.exit.cos())
}

/// The material that a cut removes in a time (m^3/s), width times depth times speed
/// of the feed; `None` where the speed of the spindle is not known. By it cuts are
/// compared: high-speed cutting removes as much with less force.
pub fn removal_rate(cut: &Cut) -> Option<f64> {
    cut.feed_speed().map(|feed| width(cut) * cut.depth * feed)
}
