//! When the rows of a campaign of kind `displacement` were read.

use std::vec::Vec;

use super::Displacements;

/// A clock that was started longer before the campaign than this share of what it took
/// was not started for it.
const LONG_BEFORE: f64 = 0.5;

impl Displacements {
    /// The time of each row (s), or their number where the file tells no time; and
    /// the median step from one row of a visit to the next.
    pub(crate) fn clock(&self) -> (Vec<f64>, f64) {
        let timed: Option<Vec<f64>> = self.rows.iter().map(|row| row.time).collect();
        let clock = timed.unwrap_or_else(|| (0..self.rows.len()).map(|row| row as f64).collect());
        let pairs = (1..clock.len()).filter(|&row| self.rows[row].visit == self.rows[row - 1].visit);
        let mut steps: Vec<f64> = pairs.map(|row| clock[row] - clock[row - 1]).collect();
        steps.sort_by(f64::total_cmp);
        let pace = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
        (clock, pace)
    }

    /// Counts the time from the beginning of the campaign, where it is Unix time or that
    /// of the day: what drifts or settles does so since then. The beginning leaves room
    /// for a round of unloaded readings before the first row.
    pub(super) fn count_from_the_beginning(&mut self) {
        let (clock, pace) = self.clock();
        let (Some(first), Some(last)) = (clock.first(), clock.last()) else { return };
        let round = apart(&clock, pace) * (self.visits.len() + 1) as f64;
        let idle = first - round;
        if idle > LONG_BEFORE * (last - idle) {
            self.rows.iter_mut().for_each(|row| row.time = row.time.map(|time| time - idle));
        }
    }
}

/// How far apart rows are. Where every row is a visit, no two of one tell (`pace` is 0).
pub(crate) fn apart(clock: &[f64], pace: f64) -> f64 {
    match (clock.first(), clock.last()) {
        (Some(first), Some(last)) if pace <= 0.0 => (last - first) / (clock.len().max(2) - 1) as f64,
        _ => pace,
    }
}
