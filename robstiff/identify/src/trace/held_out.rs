//! Are poses that were held out predicted as well as the fit says?
//!
//! What a fit leaves of poses that it has not seen is noise and the fit's own
//! error. Chow's predictive test (Econometrica 28, 1960) holds the sum of squares
//! against both. It takes noise to be normal and alike everywhere; so the poses
//! fitted to are asked as well, each by the fit without it: as many of them, drawn
//! at random, must leave less, too.
//!
//! Held-out poses judge and choose nothing: the test comes after the search.

use std::borrow::ToOwned;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::lack_of_fit::{LackOfFit, StructureTest, draws};
use super::model::{Fitted, Setting};
use super::{Options, Verdict, verdict};
use crate::identify::normal::{Fit, Normal, Scaled, Sign};
use crate::identify::problem::{Block, Problem};
use crate::probability::fisher_tail;

/// Asks the poses held out of displacements; `None` where there are none.
pub fn of_displacements(setting: &Setting<'_>, model: &Fitted, options: &Options) -> Option<StructureTest> {
    let (problem, fit) = setting.alone(&model.fit);
    let signs: Vec<Sign> = model.fit.columns.iter().map(|&column| setting.signs[column]).collect();
    predicted(&problem, &fit, &signs, &setting.undecided(&model.named), options)
}

/// What a test of poses held out makes of a verdict, if anything; it shares its level with
/// those of what is left, among which it is told.
pub fn judged(
    test: StructureTest,
    verdict: Verdict,
    left: &mut LackOfFit,
    options: &Options,
) -> Option<(Verdict, String)> {
    let level = options.alpha / (left.tests.len() + 1) as f64;
    let missed = (test.p_value <= level).then(|| verdict::missed(verdict, &test)).flatten();
    left.structure |= missed.is_some();
    left.tests.push(test);
    missed
}

/// Asks the poses held out of a problem that has the columns of a fit and no others, but for
/// some rows; `None` where there are none.
pub fn predicted(
    problem: &Problem,
    fit: &Fit,
    signs: &[Sign],
    but: &[usize],
    options: &Options,
) -> Option<StructureTest> {
    let without = |block: &Block| {
        let mut rest = block.clone();
        rest.rows.retain(|row| !but.contains(row));
        // Of a pose that loses rows, encoders have no part either.
        if rest.rows.len() < block.rows.len() {
            rest.stacked.retain(|reading| rest.rows.contains(&(reading / problem.axes)));
        }
        (!rest.rows.is_empty()).then_some(rest)
    };
    let judging: Vec<Block> = problem.held_out.iter().filter_map(without).collect();
    if judging.is_empty() {
        return None;
    }
    // What is held at zero has no error.
    let is_free = |&k: &usize| !(signs[k] == Sign::Nonnegative && fit.coefficients[k] == 0.0);
    let free: Vec<usize> = (0..fit.columns.len()).filter(is_free).collect();
    let left = |block: &Block| {
        let residuals = problem.block_residuals(block, &fit.columns, &fit.coefficients);
        let columns = DMatrix::from_fn(residuals.len(), free.len(), |i, j| problem.white[(block.stacked[i], free[j])]);
        Normal::small(&columns, &residuals)
    };
    let total = problem.total.gram_of(&free);
    let held_out: Vec<Normal> = judging.iter().map(left).collect();
    let together = beyond(&total, &Normal::sum(held_out.iter().cloned())?)?;
    let readings: usize = held_out.iter().map(|block| block.rows).sum();
    let freedom = problem.freedom(fit);
    let statistic = together / readings as f64 / problem.variance(fit);
    let by_normal = fisher_tail(statistic, [readings as f64, freedom])?;

    // Of each pose fitted to by the fit without it, `r^T (I - H)^-1 r`, a reading.
    let fitted = |block: &Block| {
        let of = left(block);
        let solved = Scaled::of(&(&total - &of.gram))?.solve(&of.moment);
        Some((of.energy + of.moment.dot(&solved)) / of.rows as f64)
    };
    let known: Vec<f64> = problem.blocks.iter().filter_map(fitted).collect();
    if known.is_empty() {
        return None;
    }
    let observed: f64 = held_out.iter().filter_map(|of| beyond(&total, of)).sum();
    let mut random = ChaCha8Rng::seed_from_u64(options.seed);
    let count = draws(options);
    let as_much = (0..count).filter(|_| {
        let drawn = |of: &Normal| known[random.random_range(0..known.len())] * of.rows as f64;
        held_out.iter().map(drawn).sum::<f64>() >= observed
    });
    let by_poses = (1 + as_much.count()) as f64 / (1 + count) as f64;
    let name = "poses held out against the others".to_owned();
    Some(StructureTest { name, statistic, p_value: by_normal.max(by_poses) })
}

/// `e^T (I + X G^-1 X^T)^-1 e` of residuals `e` and columns `X`, whose normal
/// equations are `of`, with the Gram matrix `G` of what was fitted to.
fn beyond(total: &DMatrix<f64>, of: &Normal) -> Option<f64> {
    let solved: DVector<f64> = Scaled::of(&(total + &of.gram))?.solve(&of.moment);
    Some((of.energy - of.moment.dot(&solved)).max(0.0))
}
