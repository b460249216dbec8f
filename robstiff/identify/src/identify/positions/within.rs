//! Payloads of one visit against each other.
//!
//! Where the robot stands and how its table is off, all rows of a visit have in
//! common. Taken less their mean, they show what payloads do and nothing else, so
//! compliances are identified from that where it tells them, whatever is wrong with
//! the kinematics.

use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::regression::STANDS;
use crate::campaign::Positions;
use crate::identify::normal::{Normal, independent};
use crate::identify::problem::{Block, Equations, Problem};

/// The regression on the numbers alone, rows and columns less the mean of their
/// visit; `None` where that does not tell all numbers from each other.
pub fn within_visits(problem: &Problem, data: &Positions) -> Option<Problem> {
    let count = problem.white.ncols() - STANDS;
    let mut white = problem.white.columns(STANDS, count).into_owned();
    let mut readings = (*problem.readings).clone();
    let mut visits: Vec<Vec<usize>> = vec![Vec::new(); data.visits.len()];
    let rows = problem.blocks.iter().flat_map(|block| &block.rows);
    rows.for_each(|&row| visits[data.rows[row].visit].push(row));
    visits.retain(|rows| rows.len() > 1);
    // A row alone in its visit says nothing, and a pose of such rows is no witness.
    let mut tells = vec![false; data.rows.len()];
    visits.iter().flatten().for_each(|&row| tells[row] = true);
    let telling = |block: &Block| -> Option<Block> {
        let rows: Vec<usize> = block.rows.iter().copied().filter(|&row| tells[row]).collect();
        let stacked = rows.iter().flat_map(|row| 3 * row..3 * row + 3).collect();
        (!rows.is_empty()).then_some(Block { pose: block.pose, rows, stacked })
    };
    let blocks: Vec<Block> = problem.blocks.iter().filter_map(telling).collect();
    for rows in &visits {
        for axis in 0..3 {
            let at: Vec<usize> = rows.iter().map(|row| 3 * row + axis).collect();
            let mean = |values: &dyn Fn(usize) -> f64| at.iter().map(|&i| values(i)).sum::<f64>() / at.len() as f64;
            for column in 0..count {
                let middle = mean(&|i| white[(i, column)]);
                at.iter().for_each(|&i| white[(i, column)] -= middle);
            }
            let middle = mean(&|i| readings[i]);
            at.iter().for_each(|&i| readings[i] -= middle);
        }
    }
    let stacked: Vec<usize> = blocks.iter().flat_map(|block| block.stacked.iter().copied()).collect();
    let mut total = Normal::of_rows(&white, &readings, &stacked);
    // Each visit's mean took as much as a row.
    total.rows = total.rows.checked_sub(3 * visits.len()).filter(|&rows| rows > count)?;
    let all: Vec<usize> = (0..count).collect();
    // Against what columns are with their means: a visit of one payload leaves rounding.
    let largest = problem.total.gram.diagonal().rows(STANDS, count).amax();
    let (kept, _) = independent(&total.gram, &all, NEXT_TO_NOTHING * largest);
    (kept.len() == count).then(|| of(problem, white, readings, (total, blocks)))
}

/// A column that is this small against the largest, squared, is zero but for rounding.
const NEXT_TO_NOTHING: f64 = 1e-14;

fn of(
    problem: &Problem,
    white: DMatrix<f64>,
    readings: DVector<f64>,
    (total, blocks): (Normal, Vec<Block>),
) -> Problem {
    let readings = std::rc::Rc::new(readings);
    let equations = Equations {
        blocks: blocks.into(),
        readings: std::rc::Rc::clone(&readings),
        white_readings: readings,
        total,
        ..problem.equations.clone()
    };
    Problem { equations, white }
}
