//! Readings that do not belong: rows, and whole visits whose unloaded reading
//! is wrong.
//!
//! A shift of one row, or of all rows of a visit alike, is tested against the
//! contrasts: what it explains of them on all axes together, over what is left
//! without it (externally studentised, an F statistic), times the number of
//! shifts tested (Bonferroni). The largest is set aside and the rest is judged
//! again, so that one outlying reading does not hide another; in one pass at most
//! one a pose.

use std::format;
use std::string::String;

use super::NOISELESS;
use super::contrasts::Chunk;
use super::reml::{count, sums};
use crate::campaign::Displacements;
use crate::probability::{fisher_tail, told};

/// A reading that does not belong to the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlier {
    /// The campaign's rows: one, or those of a visit.
    pub rows: Vec<usize>,
    /// The visit, by index.
    pub visit: usize,
    /// Whether all rows of the visit are off alike: its unloaded reading is.
    pub whole_visit: bool,
    /// How far off it is on each axis, in the frame it was measured in (m, rad).
    pub shift: Vec<f64>,
    /// The same in standard deviations, the root mean square over the axes;
    /// externally studentised.
    pub size: f64,
    /// The probability of one so large among all, under normal noise.
    pub p_value: f64,
}

impl Outlier {
    /// It in a sentence, with visit and line of the campaign.
    pub fn told(&self, data: &Displacements) -> String {
        let visit = &data.visits[self.visit];
        let first = data.rows[self.rows[0]].line;
        let shift: Vec<String> = self.shift[..3].iter().map(|shift| format!("{:.0}", 1e6 * shift)).collect();
        let off = format!("off by ({}) um, {:.1} standard deviations an axis", shift.join(", "), self.size);
        if self.whole_visit {
            format!("visit {visit}, from line {first}: its unloaded reading is {off}")
        } else {
            format!("visit {visit}, line {first}: {off}")
        }
    }
}

/// A shift that the free response at the pose takes up but for this fraction
/// cannot be judged.
const LEFT: f64 = 0.05;

/// What is outlying at a level: at most one a chunk, the furthest off.
pub fn find(chunks: &[Chunk], axes: usize, shared: f64, variances: &[f64], level: f64) -> Vec<Outlier> {
    let sums = sums(chunks, axes, shared);
    let total: f64 = sums.iter().zip(variances).map(|(sum, variance)| sum / variance).sum();
    let (contrasts, between) = (count(chunks) as f64, axes as f64);
    let within = between * (contrasts - 1.0);
    if contrasts <= 2.0 {
        return Vec::new();
    }
    let suspects: Vec<Vec<Suspect>> = chunks.iter().map(|chunk| suspects(chunk, axes, shared)).collect();
    let tested = suspects.iter().map(Vec::len).sum::<usize>() as f64;
    let judged = |Suspect { mut reading, explained }: Suspect| {
        let all: f64 = explained.iter().zip(variances).map(|(explained, variance)| explained / variance).sum();
        // The mean square over the axes, over what is left without it.
        let ratio = all / between / ((total - all).max(f64::MIN_POSITIVE) / within);
        reading.p_value = told(fisher_tail(ratio, [between, within]).unwrap_or(1.0) * tested);
        // By axis, for what is off along one raises the variance of that alone.
        let of_axis = |(explained, sum): (&f64, &f64)| explained * (contrasts - 1.0) / (sum - explained).max(NOTHING);
        reading.size = (explained.iter().zip(&sums).map(of_axis).sum::<f64>() / between).sqrt();
        (ratio, reading)
    };
    let worst = |suspects: Vec<Suspect>| suspects.into_iter().map(judged).max_by(|(a, _), (b, _)| a.total_cmp(b));
    suspects.into_iter().filter_map(worst).map(|(_, reading)| reading).filter(|one| one.p_value <= level).collect()
}

/// Squares of less are rounding (m^2).
const NOTHING: f64 = NOISELESS * NOISELESS;

/// A reading that is judged, with what its shift explains of each axis.
struct Suspect {
    reading: Outlier,
    explained: Vec<f64>,
}

/// Every row and every visit of a chunk.
fn suspects(chunk: &Chunk, axes: usize, shared: f64) -> Vec<Suspect> {
    let mut visits = chunk.visits.clone();
    visits.dedup();
    let rows = (0..chunk.rows.len()).map(|i| (std::vec![i], chunk.visits[i], false));
    let members = |visit: usize| (0..chunk.rows.len()).filter(|&i| chunk.visits[i] == visit).collect::<Vec<usize>>();
    // With two rows, a shift of one and of the other are told apart at best.
    let visits = visits.iter().map(|&visit| (members(visit), visit, true)).filter(|(rows, ..)| rows.len() > 2);
    let one = |(rows, visit, whole_visit): (Vec<usize>, usize, bool)| {
        let along: Vec<f64> = (0..chunk.shares.len())
            .map(|j| rows.iter().map(|&i| chunk.basis[(i, j)]).sum::<f64>() / (1.0 + shared * chunk.shares[j]).sqrt())
            .collect();
        let leverage: f64 = along.iter().map(|a| a * a).sum();
        let free = rows.len() as f64 / (1.0 + shared * rows.len() as f64);
        if leverage < LEFT * free {
            return None;
        }
        let shift: Vec<f64> = (0..axes)
            .map(|axis| {
                let weighted = (0..along.len())
                    .map(|j| along[j] * chunk.values[(j, axis)] / (1.0 + shared * chunk.shares[j]).sqrt());
                weighted.sum::<f64>() / leverage
            })
            .collect();
        let explained = shift.iter().map(|shift| shift * shift * leverage).collect();
        let rows = rows.into_iter().map(|i| chunk.rows[i]).collect();
        Some(Suspect { reading: Outlier { rows, visit, whole_visit, shift, size: 0.0, p_value: 1.0 }, explained })
    };
    rows.chain(visits).filter_map(one).collect()
}
