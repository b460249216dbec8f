//! What a single row explains by being wild, in place of an effect.

use super::bench::Bench;
use crate::identify::clamped::wild::{gains, tail};
use crate::trace::model::Fitted;

/// A row, and what it explains.
pub struct OneOff {
    /// The row that explains most, by index.
    pub row: usize,
    /// The probability of that much, over all rows.
    pub p: f64,
    /// Schwarz's criterion of the model with it: which row, and how far it is off.
    pub bic: f64,
}

/// The row of which it explains most that it is wild.
pub fn one_off(bench: &Bench, model: &Fitted) -> Option<OneOff> {
    let all = gains(&bench.axes.rows, &bench.problem, &model.fit)?;
    let row = (0..all.len()).max_by(|&a, &b| all[a].total_cmp(&all[b]))?;
    let others = model.fit.rss - all[row];
    let p = tail(all[row], others, all.len(), model.fit.columns.len())?;
    (others > 0.0).then(|| OneOff { row, p, bic: bench.bic(others, &model.named, 2) })
}
