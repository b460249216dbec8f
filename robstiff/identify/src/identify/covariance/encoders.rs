//! The noise of encoders on the output side of the gears, from the readings
//! themselves as that of displacements is: by what a free response, linear in
//! the load, leaves at each pose ([`contrasts`]).
//!
//! The unloaded angle `q` is one number a pose, which an encoder behind a gear
//! with errors of its own need not share; what its readings at a pose, or in a
//! visit, have in common is therefore not held to the noise of one reading, and
//! where it is far more, their level says nothing at all.

use std::vec::Vec;

use nalgebra::DMatrix;

use super::contrasts::{Chunk, Level, contrasts};
use super::estimated::{bartlett, beyond_noise};
use super::reml::{BEYOND, count, profile, share, sums};
use super::{EQUAL_AXES, FEWEST, NESTED};
use crate::identify::samples::Samples;
use crate::identify::whitening::ByVisit;

/// An angle known better than this (rad, m) was made by a program.
const NOISELESS: f64 = 1e-10;

/// In place of a share that is beyond what is looked for: what is common then
/// says nothing.
const NOTHING: f64 = 1e6;

/// How noisy encoders are.
#[derive(Clone, Debug, PartialEq)]
pub struct EncoderNoise {
    /// The standard deviation of what a row has to itself, by encoder (rad or m).
    pub own: Vec<f64>,
    /// The variance of what the rows of a pose, or of a visit, have in common, over
    /// that.
    pub shared: f64,
    /// What the contrasts leave, over the variance of each, and their number.
    pub pure: (f64, f64),
    /// What rows have in common a level with, by row.
    groups: Vec<usize>,
}

impl EncoderNoise {
    /// From the poses for which `of_pose` holds; none where too few readings are
    /// repeated in proportion.
    pub fn estimate(samples: &Samples, of_pose: impl Fn(usize) -> bool) -> Option<Self> {
        let axes = samples.encoders.len();
        if axes == 0 {
            return None;
        }
        let readings = DMatrix::from_fn(samples.rows.len(), axes, |row, k| samples.rows[row].turned[k]);
        let at = |grouped: &Samples, level| {
            let chunks = contrasts(grouped, &readings, level, &of_pose, |_| false);
            (count(&chunks) >= FEWEST).then_some(chunks)
        };
        // What is common is common to a visit or to the pose, whichever is likelier;
        // where every row is a visit, its angle without a load is still the pose's.
        let mut by_pose = samples.clone();
        by_pose.rows.iter_mut().for_each(|row| row.visit = row.pose);
        let tried = [&by_pose, samples].map(|grouped| {
            let chunks = at(grouped, Level::Linear)?;
            let shared = match share(&chunks, axes) {
                Some(share) if share.value > 0.99 * BEYOND => NOTHING,
                Some(share) => share.value,
                None => return None,
            };
            Some((profile(&chunks, axes, shared.min(BEYOND)).likelihood, grouped, chunks, shared))
        });
        let likeliest = tried.into_iter().flatten().max_by(|a, b| a.0.total_cmp(&b.0));
        let (grouped, linear, shared) = match likeliest {
            Some((_, grouped, chunks, shared)) => (grouped, chunks, shared),
            None => (&by_pose, at(&by_pose, Level::Linear)?, NOTHING),
        };
        let mut chunks = linear;
        let of = |chunks: &[Chunk]| (sums(chunks, axes, shared), known(chunks, shared));
        for level in [Level::Curved, Level::Repeated] {
            if let Some(freer) = at(grouped, level)
                && beyond_noise(of(&chunks), of(&freer)).is_some_and(|p| p <= NESTED)
            {
                chunks = freer;
            }
        }
        let known = known(&chunks, shared);
        let scale = count(&chunks) as f64 / known.max(1.0);
        let variances: Vec<f64> = profile(&chunks, axes, shared).variances.iter().map(|v| v * scale).collect();
        if known < FEWEST as f64 || variances.iter().any(|variance| *variance < NOISELESS * NOISELESS) {
            return None;
        }
        let mean = variances.iter().sum::<f64>() / axes as f64;
        let alike = bartlett(&variances, known).is_none_or(|p| p > EQUAL_AXES);
        let variances: Vec<f64> = variances.into_iter().map(|own| if alike { mean } else { own }).collect();
        let left = sums(&chunks, axes, shared);
        let pure = left.iter().zip(&variances).map(|(left, variance)| left / variance).sum();
        Some(Self {
            own: variances.into_iter().map(f64::sqrt).collect(),
            shared,
            pure: (pure, known * axes as f64),
            groups: grouped.visits(),
        })
    }

    /// How many numbers of a fit the levels of visits are, which say nothing.
    pub fn unknown_levels(&self) -> f64 {
        let groups: std::collections::BTreeSet<usize> = self.groups.iter().copied().collect();
        if self.shared < NOTHING { 0.0 } else { (groups.len() * self.own.len()) as f64 }
    }

    /// What whitens their readings; rows left out have nothing in common with
    /// others.
    pub fn by_group(&self, left_out: &[bool]) -> ByVisit {
        ByVisit::new(&super::alone(&self.groups, left_out), self.shared)
    }
}

/// The number of contrasts that say something: those that hold what is common
/// say nothing where that is not known.
fn known(chunks: &[Chunk], shared: f64) -> f64 {
    let all = chunks.iter().flat_map(|chunk| &chunk.shares);
    all.filter(|share| shared < NOTHING || **share < 1e-6).count() as f64
}
