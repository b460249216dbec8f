//! The depths over the speed of the spindle.

use robstiff_machining::milling::Cut;
use robstiff_machining::stability::FeedLimit;
use robstiff_robots::quantity::Dimension;

use crate::input::all_with_unit;

/// How many speeds are looked at.
const SPEEDS: usize = 55;

/// The depths at one speed of the spindle.
pub struct Lobe {
    /// The speed (rad/s).
    pub speed: f64,
    /// The depth at which it begins (m), feed by feed; none where it does not.
    pub limits: Vec<Option<f64>>,
}

impl Lobe {
    /// The least of all feeds.
    pub fn least(&self) -> Option<f64> {
        self.limits.iter().flatten().copied().reduce(f64::min)
    }

    /// The place of the best feed; of equal ones the first.
    pub fn best(&self) -> usize {
        let depth = |place: usize| self.limits[place].unwrap_or(f64::INFINITY);
        (0..self.limits.len()).reduce(|best, place| if depth(place) > depth(best) { place } else { best }).unwrap_or(0)
    }
}

/// Two speeds, the lower first.
pub fn range(text: &str) -> Result<[f64; 2], String> {
    let parts: Vec<&str> = text.split(',').collect();
    let speeds = all_with_unit(&parts, Dimension::RotationalSpeed)?;
    match speeds[..] {
        [from, to] if 0.0 < from && from < to => Ok([from, to]),
        _ => Err("two speeds above zero are expected here, the lower first, e.g. `3000 rpm, 18000 rpm`".to_owned()),
    }
}

/// The speeds that are looked at (rad/s), evenly spaced; about that of a cut from a fifth to
/// twice, in steps of a thirtieth.
pub fn speeds(range: Option<[f64; 2]>, speed: f64) -> impl Iterator<Item = f64> {
    let [from, to] = range.unwrap_or([0.2 * speed, 2.0 * speed]);
    (0..SPEEDS).map(move |k| from + (to - from) * k as f64 / (SPEEDS - 1) as f64)
}

/// The depths at each speed.
pub fn over_speeds(feeds: &[FeedLimit], cut: &Cut, speeds: impl Iterator<Item = f64>) -> Vec<Lobe> {
    let at = |speed: f64| {
        let period = Cut { speed: Some(speed), ..cut.clone() }.tooth_period();
        let limit = |feed: &FeedLimit| period.and_then(|period| feed.lobes.limits(period).limiting());
        Lobe { speed, limits: feeds.iter().map(limit).collect() }
    };
    speeds.map(at).collect()
}
