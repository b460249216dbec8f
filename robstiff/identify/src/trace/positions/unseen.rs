//! What a model says of poses that its fit has not seen.

use std::vec::Vec;

use super::bench::{Bench, Model};
use crate::identify::positions::regression::Solved;
use crate::identify::positions::residuals;
use crate::identify::problem::{Block, rms};
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
/// rows, or each by the fit without it; in rows that are left out, too.
pub fn unseen_rms(bench: &Bench<'_>, model: &Model, but: &[usize]) -> f64 {
    let (data, training) = (bench.prepared.data, &bench.rows.training);
    let mut left = residuals(&bench.regression, &model.solved.state);
    if training.contains(&false) {
        let held_out = (0..data.rows.len()).filter(|&row| !training[data.rows[row].pose] && !but.contains(&row));
        return rms(&left, 3, held_out);
    }
    let Solved { problem, fit, signs, .. } = &model.solved;
    for block in problem.blocks.iter() {
        let Some(without) = problem.solve_without(block, &fit.columns, Some(signs)) else { continue };
        let rows: Vec<usize> = (0..data.rows.len()).filter(|&row| data.rows[row].pose == block.pose).collect();
        let stacked: Vec<usize> = rows.iter().flat_map(|row| 3 * row..3 * (row + 1)).collect();
        let whole = Block { pose: block.pose, rows, stacked };
        let own = problem.block_residuals(&whole, &fit.columns, &without);
        whole.stacked.iter().zip(own.iter()).for_each(|(&i, &residual)| left[i] = residual);
    }
    rms(&left, 3, 0..data.rows.len())
}
