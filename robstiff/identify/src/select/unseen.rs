//! The error of a set on poses that are left out in turn.

use nalgebra::DMatrix;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use super::engine::Engine;
use super::layout::Layout;
use super::problem::Problem;
use crate::observe::Readings;
use crate::regression::noise::rows_of_blocks;

/// Folds for the error that named effects leave one after the other.
const FOLDS: usize = 5;

/// The problems without the poses of each fold, with the columns of a layout as they were linearised.
pub struct Unseen<'u> {
    readings: &'u Readings,
    columns: &'u DMatrix<f64>,
    /// Each with the rows that have no part in it.
    folds: Vec<(Problem<'u>, Vec<usize>)>,
}

impl<'u> Unseen<'u> {
    /// Of the poses that an engine fits to.
    pub fn new(engine: &'u Engine<'_>, layout: &'u Layout, columns: &'u DMatrix<f64>) -> Self {
        let readings = engine.observation.readings();
        let group = groups(readings, &engine.training, FOLDS, 1);
        Self { readings, columns, folds: without_each_fold(engine, layout, columns, &group).collect() }
    }

    /// The error of a set under a discrepancy (m, rad); none where it cannot be fitted without some fold.
    pub fn rms(&self, set: &[usize], kappa: usize) -> Option<f64> {
        let (readings, columns) = (self.readings, self.columns);
        let (mut sum, mut count) = (0.0, 0);
        for (problem, rows) in &self.folds {
            let fit = problem.fit(set, kappa)?;
            for row in rows {
                for k in 0..readings.reported {
                    let at = row * readings.width + k;
                    let taken: f64 = fit.columns.iter().zip(fit.mean.iter()).map(|(&c, b)| columns[(at, c)] * b).sum();
                    sum += (columns[(at, columns.ncols() - 1)] - taken).powi(2);
                    count += 1;
                }
            }
        }
        (count > 0).then(|| (sum / f64::from(count)).sqrt())
    }
}

/// The problem without the blocks of each fold in turn, with the rows that are unseen there.
pub fn without_each_fold<'l>(
    engine: &Engine<'_>,
    layout: &'l Layout,
    columns: &DMatrix<f64>,
    group: &[Option<usize>],
) -> impl Iterator<Item = (Problem<'l>, Vec<usize>)> {
    let grams = engine.grams(columns, group);
    let count = group.iter().flatten().max().map_or(0, |last| last + 1);
    (0..count).map(move |fold| {
        let problem = engine.problem(layout, columns, grams.without(fold).total);
        (problem, unseen_rows(engine.observation.readings(), group, fold))
    })
}

/// The rows of the blocks of a fold.
pub fn unseen_rows(readings: &Readings, group: &[Option<usize>], fold: usize) -> Vec<usize> {
    let unseen: Vec<bool> = group.iter().map(|of| *of == Some(fold)).collect();
    rows_of_blocks(readings, &unseen).concat()
}

/// The fold of each block, drawn at random, alike from each stratum; none of one that is not fitted
/// to.
pub fn groups(readings: &Readings, training: &[bool], folds: usize, seed: u64) -> Vec<Option<usize>> {
    let mut blocks: Vec<usize> = (0..training.len()).filter(|&block| training[block]).collect();
    blocks.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
    blocks.sort_by_key(|&block| readings.stratum[block]);
    let folds = folds.min(blocks.len());
    let mut group = vec![None; training.len()];
    blocks.into_iter().enumerate().for_each(|(k, block)| group[block] = Some(k % folds.max(1)));
    group
}
