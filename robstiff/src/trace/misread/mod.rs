//! Whether a file was written otherwise than it is read.
//!
//! Two columns that are exchanged, a sign, a frame, an angle in another unit: no effect of an arm
//! looks like that, but where there are only effects to choose from, one is found that fits a little.
//! A mistake is told from an effect by what undoing it does: it takes no number, and then the
//! joints alone, each with a compliance that is not negative, leave far less of the readings than
//! the best model did. Mistakes are made one at a time here; of two, none is found.
//!
//! Which mistakes there are, [`mistakes`] says.

mod axes;
mod mistakes;
mod positions;
#[cfg(test)]
mod tests;

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use robstiff_robots::Description;

use self::mistakes::{Mistake, of_displacements};
pub use self::positions::in_positions;
use super::bench::Bench;
use super::catalogue::TRANSMISSION_ERROR;
use super::model::Named;
use super::search::Outcome;
use super::too_little;
use super::verdict::Verdict;
use crate::campaign::Displacements;
use crate::identify::baseline::declared;
use crate::identify::normal::{Normal, independent};
use crate::identify::samples::Samples;
use crate::words::micrometres;

/// A mistake leaves at most so much of what the best model leaves, by squares: none of an arm
/// that lacks something the catalogue has no name for comes near it by chance.
const FAR_LESS: f64 = 0.25;

/// What is left of one mistake is told from what is left of another by this factor, by squares.
const ALIKE: f64 = 1.5;

/// So many mistakes that do alike are told.
const MOST_TOLD: usize = 3;

/// Rows that are looked at, of whole visits: more say no more of a mistake.
const ROWS: usize = 1000;

/// What was found, unless the files say something else than what was measured: then nothing that
/// could be told of the arm, and why.
///
/// # Errors
/// Why not even the description's own numbers can be fitted.
pub fn unless(bench: &Bench<'_>, outcome: Outcome) -> Result<Outcome, String> {
    if !may_be(bench, &outcome)? {
        return Ok(outcome);
    }
    let Some(rows) = Rows::of(bench, &outcome)? else { return Ok(outcome) };
    // A wave can make one angle of another, and takes numbers for it.
    let enough = if names_wave(bench, &outcome) { ALIKE } else { FAR_LESS };
    let likely = rows.likely(bench.robot(), enough);
    let Some((left, _)) = likely.first() else { return Ok(outcome) };
    let words = words(&likely);
    let why = format!(
        "the files may say something else than what was measured: {}; with that undone the joints alone leave {}, and \
         as the files are {} stay unaccounted for",
        joined(&words),
        micrometres(left.rms()),
        micrometres(rows.left.rms())
    );
    let mut found = Outcome::nothing(bench.fit(&[])?, Verdict::Insufficient, why);
    found.looks_like = words;
    Ok(found.after(outcome))
}

/// Whether something is the matter that enough was measured to ask about.
fn may_be(bench: &Bench<'_>, outcome: &Outcome) -> Result<bool, String> {
    let is_found = outcome.structure() || outcome.verdict == Verdict::Insufficient || names_wave(bench, outcome);
    Ok(is_found && too_little(&*bench.at(&[])?).is_none())
}

fn names_wave(bench: &Bench<'_>, outcome: &Outcome) -> bool {
    let is_wave = |one: &Named| bench.candidates()[one.candidate].kind.name == TRANSMISSION_ERROR.name;
    outcome.selection.model.named.iter().any(is_wave)
}

/// What a model leaves of what is read.
#[derive(Clone, Copy)]
struct Left {
    /// The sum of squares that is left (m^2).
    squares: f64,
    /// That of what was read, of positions from their middle (m^2).
    read: f64,
    /// How many rows there are.
    rows: usize,
}

impl Left {
    /// The share of what was read that is left, by squares.
    fn share(&self) -> f64 {
        self.squares / self.read
    }

    /// The root mean square of one axis (m).
    fn rms(&self) -> f64 {
        (self.squares / (3 * self.rows) as f64).sqrt()
    }
}

/// What was read, as the files say it.
struct Rows {
    data: Displacements,
    /// What the best model leaves of it.
    left: Left,
}

impl Rows {
    /// The rows that were fitted to, of some visits where there are many.
    fn of(bench: &Bench<'_>, outcome: &Outcome) -> Result<Option<Self>, String> {
        let model = &outcome.selection.model;
        let setting = bench.at(&model.named)?;
        let residuals = setting.residuals(&model.fit);
        let (samples, mut data) = (&bench.prepared.samples, bench.prepared.data.clone());
        let step = data.rows.len().div_ceil(ROWS);
        let is_asked =
            |row: usize| bench.is_fitted_to(row) && !bench.left_out[row] && data.rows[row].visit.is_multiple_of(step);
        let asked: Vec<usize> = (0..data.rows.len()).filter(|&row| is_asked(row)).collect();
        let squares = asked.iter().map(|&row| residuals.fixed_rows::<3>(row * samples.axes).norm_squared()).sum();
        let read: f64 = asked.iter().map(|&row| samples.rows[row].displacement.norm_squared()).sum();
        data.rows = asked.iter().map(|&row| data.rows[row].clone()).collect();
        let left = Left { squares, read, rows: asked.len() };
        Ok((read > 0.0).then_some(Self { data, left }))
    }

    /// The mistakes that leave no more than a part of the share that the model leaves.
    fn likely(&self, robot: &Description, part: f64) -> Vec<(Left, Mistake)> {
        let left = |mistake: &Mistake| {
            let (robot, data) = mistake.undone(robot, &self.data);
            left_by_joints(&robot, &data)
        };
        likely(of_displacements(robot), left, part * self.left.share())
    }
}

/// The mistakes that leave at most a share where they are undone, each with what it leaves, the
/// least share first; those only that leave about as little as it.
fn likely(all: Vec<Mistake>, left: impl Fn(&Mistake) -> Option<Left>, most: f64) -> Vec<(Left, Mistake)> {
    let mut tried: Vec<(Left, Mistake)> =
        all.into_iter().filter_map(|mistake| Some((left(&mistake)?, mistake))).collect();
    tried.sort_by(|a, b| a.0.share().total_cmp(&b.0.share()));
    let least = tried.first().map_or(f64::INFINITY, |(left, _)| left.share());
    tried.retain(|(left, _)| left.share() <= most.min(ALIKE * least));
    tried
}

/// Mistakes as the files have them, as many as are told.
fn words(likely: &[(Left, Mistake)]) -> Vec<String> {
    let told = likely.iter().take(MOST_TOLD).map(|(_, mistake)| mistake.to_string());
    let more = (likely.len() > MOST_TOLD).then(|| String::from("one of some more mistakes that do alike"));
    told.chain(more).collect()
}

/// Mistakes of which one was made, in a sentence.
fn joined(words: &[String]) -> String {
    words.join(", or ")
}

/// What the description's own numbers leave of the displacements, fitted to all rows alike; `None`
/// where these show none of them. What is not linear in the load, a thousandth of it, is not asked
/// for.
fn left_by_joints(robot: &Description, data: &Displacements) -> Option<Left> {
    let samples = Samples::of_description(robot, data).without_encoders();
    let displacements = |stacked: &DVector<f64>| {
        let of_row = |row: usize| stacked.as_slice()[row * samples.axes..][..3].to_vec();
        DVector::from_vec((0..samples.rows.len()).flat_map(of_row).collect())
    };
    let own = declared(robot);
    let columns: Vec<DVector<f64>> = own.iter().map(|number| displacements(&samples.column(number.column))).collect();
    let normal = Normal::new(&DMatrix::from_columns(&columns), &displacements(&samples.readings()));
    let (kept, _) = independent(&normal.gram, &(0..own.len()).collect::<Vec<usize>>(), 0.0);
    let signs = kept.iter().map(|&k| own[k].sign).collect::<Vec<_>>();
    let fit = normal.solve_signed(&kept, &signs)?;
    Some(Left { squares: fit.rss, read: normal.energy, rows: samples.rows.len() })
}
