//! Do the readings of a pose agree on something that the model does not say?
//!
//! What is left at a pose has two parts: what a response in proportion to the
//! load, and a displacement common to a visit's rows, could take up (`A`), and
//! the rest (`B`). Noise leaves as much a degree of freedom in either; whatever
//! a model lacks of the arm, of where it stands or of how it is read shows in
//! `A` sooner. Noise as well does not know the sign of a row: the ratio of the
//! two is held against what it is with random signs of whole rows, so neither
//! how noisy the readings are nor their tails need be known. Displacements and
//! rotations are asked apart.

use std::vec::Vec;

use nalgebra::{Cholesky, DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::lack_of_fit::resolving;
use super::model::{Fitted, Setting};
use crate::identify::normal::{Fit, Scaled};
use crate::identify::problem::{Block, Problem};
use crate::identify::samples::Samples;

/// With fewer poses that have both parts there is no test.
const FEWEST: usize = 8;

/// A column of which less is left beside those before it says nothing new.
const NEW: f64 = 1e-6;

/// Draws of signs are no more than these where they resolve the level asked for.
const DRAWS: usize = 999;

/// What the poses say.
#[derive(Clone, Copy, Debug)]
pub struct Agreement {
    /// The ratio of the variances of the two parts.
    pub statistic: f64,
    /// The probability of so much under noise alone.
    pub p_value: f64,
    /// The variance of a whitened displacement by what no response takes up (m^2).
    pub noise: f64,
}

/// What one pose leaves.
struct Pose {
    /// What a response and a common displacement can look like over its rows.
    taken: Vec<DVector<f64>>,
    /// What is left, a row each.
    left: DMatrix<f64>,
    /// What the fit has taken of either part, by axis.
    pulled: Vec<[f64; 2]>,
}

/// Asks the poses fitted to; `None` where they have too few rows for a rest.
pub fn agreement(setting: &Setting<'_>, model: &Fitted, options: &super::Options) -> Option<Agreement> {
    let (problem, fit) = setting.alone(&model.fit);
    let half = Cholesky::new(Scaled::of(&problem.total.gram_of(&fit.columns))?.inverse())?.l();
    let of_pose = |block| of_pose(&setting.point.samples, &problem, &fit, block, &half);
    let poses: Vec<Pose> = problem.blocks.iter().filter_map(of_pose).collect();
    if poses.len() < FEWEST {
        return None;
    }
    let kinds: Vec<usize> = (0..problem.axes).step_by(3).collect();
    // Both kinds share the level.
    let draws = DRAWS.min(options.draws).max(kinds.len() * resolving(options));
    let asked: Vec<Agreement> = kinds.iter().filter_map(|&first| ask(&poses, first, draws, options.seed)).collect();
    let noise = asked.first()?.noise;
    let least = asked.iter().min_by(|a, b| a.p_value.total_cmp(&b.p_value))?;
    Some(Agreement { p_value: (asked.len() as f64 * least.p_value).min(1.0), noise, ..*least })
}

/// The same of three axes.
fn ask(poses: &[Pose], first: usize, draws: usize, seed: u64) -> Option<Agreement> {
    let axes = first..first + 3;
    let mut freedom = [0.0; 2];
    for pose in poses {
        let (all, taken) = (pose.left.nrows(), pose.taken.len());
        for axis in axes.clone() {
            freedom[0] += taken as f64 - pose.pulled[axis][0];
            freedom[1] += (all - taken) as f64 - pose.pulled[axis][1];
        }
    }
    let whole: f64 = poses.iter().map(|pose| pose.left.columns(first, 3).norm_squared()).sum();
    let taken = |signs: &mut dyn FnMut() -> f64| -> f64 {
        let of_pose = |pose: &Pose| -> f64 {
            let signs: Vec<f64> = (0..pose.left.nrows()).map(|_| signs()).collect();
            let along = |axis: usize, response: &DVector<f64>| -> f64 {
                let left = pose.left.column(axis);
                (0..signs.len()).map(|row| signs[row] * left[row] * response[row]).sum()
            };
            axes.clone().flat_map(|axis| pose.taken.iter().map(move |one| along(axis, one).powi(2))).sum()
        };
        poses.iter().map(of_pose).sum()
    };
    let observed = taken(&mut || 1.0);
    let noise = (whole - observed) / freedom[1];
    let statistic = observed / freedom[0] / noise;
    if freedom.iter().any(|freedom| *freedom <= 0.0) || !statistic.is_finite() || noise <= 0.0 {
        return None;
    }
    // Signs give back what the fit has taken.
    let counts = [0, 1]
        .map(|k| freedom[k] + poses.iter().flat_map(|pose| &pose.pulled[first..first + 3]).map(|p| p[k]).sum::<f64>());
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let beyond = (0..draws).filter(|_| {
        let drawn = taken(&mut || if random.next_u32() & 1 == 0 { 1.0 } else { -1.0 });
        drawn / counts[0] / ((whole - drawn) / counts[1]) >= statistic
    });
    let p_value = (1 + beyond.count()) as f64 / (1 + draws) as f64;
    Some(Agreement { statistic, p_value, noise })
}

/// What one pose leaves of a fit to all columns of a regression; `half` is a root
/// of their covariance.
fn of_pose(samples: &Samples, problem: &Problem, fit: &Fit, block: &Block, half: &DMatrix<f64>) -> Option<Pose> {
    let (axes, count) = (problem.axes, block.rows.len());
    let taken = responses(samples, &block.rows);
    if taken.len() >= count {
        return None;
    }
    // Encoders, whose readings come behind, are not asked.
    let stacked = &block.stacked[..count * axes];
    let left = problem.block_residuals(block, &fit.columns, &fit.coefficients);
    let pull = problem.white.select_rows(stacked) * half;
    let pulled = |axis: usize| {
        let (mut whole, mut along) = (0.0, 0.0);
        for column in pull.column_iter() {
            whole += (0..count).map(|row| column[row * axes + axis].powi(2)).sum::<f64>();
            for response in &taken {
                let share: f64 = (0..count).map(|row| column[row * axes + axis] * response[row]).sum();
                along += share * share;
            }
        }
        [along, whole - along]
    };
    let pulled = (0..axes).map(pulled).collect();
    let left = DMatrix::from_row_slice(count, axes, &left.as_slice()[..stacked.len()]);
    Some(Pose { taken, left, pulled })
}

/// What a response in proportion to the load and a displacement of a visit's
/// rows, or of all rows that are a visit each, can look like over a pose's rows:
/// orthonormal. Whitening makes the same of it, for within a visit it takes away
/// a share of the mean.
fn responses(samples: &Samples, rows: &[usize]) -> Vec<DVector<f64>> {
    let visit = |row: usize| samples.rows[row].visit;
    let mut visits: Vec<usize> = rows.iter().map(|&row| visit(row)).collect();
    visits.sort_unstable();
    let alone = |of: usize| visits.iter().filter(|&&visit| visit == of).count() == 1;
    let group = |row: usize| if alone(visit(row)) { usize::MAX } else { visit(row) };
    let mut groups: Vec<usize> = rows.iter().map(|&row| group(row)).collect();
    groups.sort_unstable();
    groups.dedup();
    let constants = groups.iter().map(|&of| column(rows, |row| f64::from(u8::from(group(row) == of))));
    let loads = (0..6).map(|k| column(rows, |row| samples.rows[row].wrench[k]));
    let mut found: Vec<DVector<f64>> = Vec::new();
    for mut column in constants.chain(loads) {
        let size = column.norm();
        for _ in 0..2 {
            for known in &found {
                let share = known.dot(&column);
                column.axpy(-share, known, 1.0);
            }
        }
        let left = column.norm();
        if left > NEW * size {
            found.push(column / left);
        }
    }
    found
}

fn column(rows: &[usize], of: impl Fn(usize) -> f64) -> DVector<f64> {
    DVector::from_iterator(rows.len(), rows.iter().map(|&row| of(row)))
}
