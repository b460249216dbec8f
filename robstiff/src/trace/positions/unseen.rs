//! What a model says of poses that its fit has not seen.

use std::vec::Vec;

use super::bench::{Bench, Model};
use crate::identify::positions::regression::Solved;
use crate::identify::positions::residuals;
use crate::identify::problem::{Block, Equations, Problem, rms};
use crate::trace::lack_of_fit::StructureTest;
use crate::trace::slip::{SLIPPED_AT, Slipping};
use crate::trace::{Options, held_out};

/// The rows of poses held out that no row fitted to is between them and the moment of a slip
/// that a model names: on which side of it they are the fit does not say.
pub fn undecided(bench: &Bench<'_>, model: &Model) -> Vec<usize> {
    let rows = &bench.prepared.data.rows;
    let is_fitted_to = |row: &usize| bench.rows.has(*row, bench.prepared.data);
    let beside = |slip: usize| {
        let before = (0..slip).rev().take_while(|row| !is_fitted_to(row));
        before.chain((slip..rows.len()).take_while(|row| !is_fitted_to(row)))
    };
    let moment = |line: f64| rows.iter().position(|row| row.line as f64 == line);
    let slips = model.named.iter().filter(|one| Slipping::has(bench.candidates[one.candidate].kind.name));
    let lines = slips.flat_map(|one| &bench.variant(*one).shape).filter(|number| number.name == SLIPPED_AT);
    let mut undecided: Vec<usize> = lines.filter_map(|line| moment(line.value)).flat_map(beside).collect();
    undecided.retain(|&row| !bench.rows.training[rows[row].pose]);
    undecided.sort_unstable();
    undecided.dedup();
    undecided
}

/// Asks the poses held out, which had no part in the search, whether a model predicts
/// them, but for some rows.
pub fn unseen(model: &Model, but: &[usize], options: &Options) -> Option<StructureTest> {
    let Solved { problem, fit, signs, .. } = &model.solved;
    if model.leaves_nothing() {
        return None;
    }
    if but.is_empty() {
        return held_out::predicted(problem, fit, signs, options);
    }
    let rest = |block: &Block| {
        let rows: Vec<usize> = block.rows.iter().copied().filter(|row| !but.contains(row)).collect();
        let stacked = rows.iter().flat_map(|row| 3 * row..3 * row + 3).collect();
        (!rows.is_empty()).then_some(Block { pose: block.pose, rows, stacked })
    };
    let held_out = problem.held_out.iter().filter_map(rest).collect::<Vec<Block>>().into();
    let equations = Equations { held_out, ..problem.equations.clone() };
    held_out::predicted(&Problem { equations, white: problem.white.clone() }, fit, signs, options)
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
