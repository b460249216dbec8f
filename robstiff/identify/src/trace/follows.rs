//! Whether the readings follow the loads at all.
//!
//! A wrong column, or rows that were mixed up, leave readings that have next to nothing to do
//! with the loads beside them. Where nobody says how noisy a reading is, that passes for noise,
//! whatever it is, and nothing is missing in the robot: it is the largest model that there is, a
//! free response at each pose, which leaves it.

use std::format;
use std::string::String;

use super::bench::Bench;
use super::search::Outcome;
use crate::identify::covariance::Basis;
use crate::identify::prepare::Prepared;
use crate::words::micrometres;

/// Noise of so much of what is read, by their squares, is no noise that a campaign is made with.
/// Of 14 simulated campaigns with their readings one row off, those without declared noise came
/// to 0.89 to 2.5; of 250 of robots that lack nothing, with up to 200 um of noise, four came to
/// more than 0.5, and none to more than 0.65.
const HARDLY: f64 = 0.75;

/// Why the readings say nothing, where they hardly follow the loads. Noise that is declared is
/// known from elsewhere, and what has structure may be accounted for one day.
pub fn hardly(prepared: &Prepared<'_>, bench: &Bench<'_>, outcome: &Outcome) -> Option<String> {
    let model = &outcome.selection.model;
    let left = bench.at(&model.named).ok()?.problem.variance(&model.fit);
    let by_readings = matches!(bench.noise.covariance.basis, Basis::Contrasts(_));
    if prepared.noise(left).1.is_declared() || !outcome.looks_like.is_empty() || (outcome.structure() && !by_readings) {
        return None;
    }
    let reading = bench.noise.covariance.reading().filter(|_| by_readings).unwrap_or_else(|| left.sqrt());
    let rows = prepared.samples.rows.iter().enumerate();
    let (mut squares, mut count) = (0.0, 0.0);
    for (_, row) in rows.filter(|&(row, _)| bench.is_fitted_to(row) && !bench.left_out[row]) {
        squares += row.displacement.norm_squared();
        count += 3.0;
    }
    // A displacement is the difference of two.
    let (noise, read) = (2.0 * reading * reading, squares / count);
    let by = if by_readings { ", even where each pose may respond to its loads in its own way" } else { "" };
    (noise > HARDLY * read).then(|| {
        format!(
            "the readings hardly follow the loads: {} a displacement are read, and {} are left as noise{by}; rows may be \
             mixed up, a column may be that of something else, or the loads are too small to be read",
            micrometres(read.sqrt()),
            micrometres(noise.sqrt())
        )
    })
}
