//! What a model says of poses that its fit has not seen.

use std::vec::Vec;

use super::bench::{Bench, Model};
use crate::identify::positions::regression::Solved;
use crate::identify::positions::residuals;
use crate::identify::problem::rms;
use crate::trace::lack_of_fit::StructureTest;
use crate::trace::slip::{self, SLIPPED_AT};
use crate::trace::{Options, held_out};

/// The rows of poses held out that no row fitted to is between them and the moment of a slip
/// that a model names: on which side of it they are the fit does not say.
pub fn undecided(bench: &Bench<'_>, model: &Model) -> Vec<usize> {
    let rows = &bench.prepared.data.rows;
    let moment = |line: f64| rows.iter().position(|row| row.line as f64 == line);
    let slips = model.named.iter().filter(|one| bench.candidates[one.candidate].slipping().is_some());
    let lines = slips.flat_map(|one| &bench.variant(*one).shape).filter(|number| number.name == SLIPPED_AT);
    let fitted_to: Vec<bool> = (0..rows.len()).map(|row| bench.rows.has(row, bench.prepared.data)).collect();
    let held_out: Vec<bool> = rows.iter().map(|row| !bench.rows.training[row.pose]).collect();
    slip::undecided(lines.filter_map(|line| moment(line.value)), &fitted_to, &held_out)
}

/// Asks the poses held out, which had no part in the search, whether a model predicts
/// them, but for some rows.
pub fn unseen(model: &Model, but: &[usize], options: &Options) -> Option<StructureTest> {
    let Solved { problem, fit, signs, .. } = &model.solved;
    if model.leaves_nothing() {
        return None;
    }
    held_out::predicted(problem, fit, signs, but, options)
}

/// The error of a model on poses that its fit has not seen (m): those held out but for some
/// rows, or each by the fit without it.
pub fn unseen_rms(bench: &Bench<'_>, model: &Model, but: &[usize]) -> f64 {
    let (data, training) = (bench.prepared.data, &bench.rows.training);
    if !training.contains(&false) {
        return bench.left_out_rms(&model.solved);
    }
    let held_out = (0..data.rows.len()).filter(|&row| !training[data.rows[row].pose] && !but.contains(&row));
    rms(&residuals(&bench.regression, &model.solved.state), 3, held_out)
}
