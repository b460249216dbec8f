//! What an encoder behind a gear is off by.
//!
//! The readings of an encoder at a pose have the covariance `s_e^2 [diag(v_r / w_r) + tau 1_level]`, with `v_r / w_r` as
//! displacements have it. A gear has errors: the angle of the unloaded arm behind it is not the coordinate. What the rows
//! of a pose, or of a visit, share is a level whose variance `tau` is learned. An encoder has no discrepancy: it sees the
//! gear alone, where a model lacks little.

use nalgebra::{DMatrix, DVector};

use crate::observe::Readings;
use crate::probability::median;

/// What the rows share that have an encoder's level in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// The pose.
    Block,
    /// The visit.
    Visit,
}

/// The variances `tau` of the levels that are tried, over that of one reading. Under the last a level says nothing.
const LEVELS: [f64; 10] = [0.0, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1e3, 1e4];

/// A level of which nothing is known.
pub const UNKNOWN: (Level, f64) = (Level::Block, LEVELS[LEVELS.len() - 1]);

/// A reading that is further from its level than this, over the noise, does not count.
const FAR: f64 = 4.0;

/// The median of `|x|` of a standard normal `x`.
const MEDIAN_OF_NORMAL: f64 = 0.674_489_75;

/// The levels of encoders and their noise.
pub struct Learned {
    /// Which rows share a level, and its variance over that of one reading.
    pub level: (Level, f64),
    /// The noise of each encoder by its axis of a row (rad).
    pub sizes: Vec<(usize, f64)>,
}

/// The level under which residuals of all encoders are likeliest, and their noise. `own` is the variance of a row's own
/// reading over that of one reading. None where there is no encoder.
pub fn learned(
    readings: &Readings,
    left: &DVector<f64>,
    rows: &[Vec<usize>],
    own: &dyn Fn(usize) -> f64,
) -> Option<Learned> {
    let axes: Vec<usize> = (0..readings.width).filter(|axis| readings.channels[*axis] >= 2).collect();
    let tried = [Level::Block, Level::Visit].into_iter().flat_map(|by| LEVELS.map(|tau| (by, tau)));
    let mut best: Option<(f64, Learned)> = None;
    for level in tried.filter(|_| !axes.is_empty()) {
        let white = white(readings, left, (rows, &axes), level, own);
        let each: Vec<(f64, f64)> = white.iter().map(size_of).collect();
        let likelihood: f64 = each.iter().map(|(likelihood, _)| likelihood).sum();
        if best.as_ref().is_none_or(|(most, _)| likelihood > *most + 1e-6) {
            let sizes = axes.iter().zip(each).map(|(&axis, (_, size))| (axis, size)).collect();
            best = Some((likelihood, Learned { level, sizes }));
        }
    }
    best.map(|(_, learned)| learned)
}

/// The covariance of an encoder over some rows of a block, over its variance.
pub fn covariance(
    readings: &Readings,
    rows: &[usize],
    (by, tau): (Level, f64),
    own: &dyn Fn(usize) -> f64,
) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), rows.len(), |i, j| {
        let own = if i == j { own(rows[i]) } else { 0.0 };
        let is_shared = by == Level::Block || readings.visit[rows[i]] == readings.visit[rows[j]];
        own + if is_shared { tau } else { 0.0 }
    })
}

/// The whitened residuals of each encoder, and the logarithm of the determinant of their covariance.
fn white(
    readings: &Readings,
    left: &DVector<f64>,
    (rows, axes): (&[Vec<usize>], &[usize]),
    level: (Level, f64),
    own: &dyn Fn(usize) -> f64,
) -> Vec<(Vec<f64>, f64)> {
    let mut white = vec![(Vec::new(), 0.0); axes.len()];
    for rows in rows.iter().filter(|rows| !rows.is_empty()) {
        let Some(factor) = covariance(readings, rows, level, own).cholesky() else { continue };
        let lower = factor.l();
        let log_det = 2.0 * lower.diagonal().iter().map(|d| d.ln()).sum::<f64>();
        let of = DMatrix::from_fn(rows.len(), axes.len(), |i, k| left[rows[i] * readings.width + axes[k]]);
        let Some(of) = lower.solve_lower_triangular(&of) else { continue };
        for (k, (numbers, sum)) in white.iter_mut().enumerate() {
            numbers.extend(of.column(k).iter());
            *sum += log_det;
        }
    }
    white
}

/// The log-likelihood of whitened residuals at their most likely size, and that size. Those that are far
/// from the others are brought near.
fn size_of((white, log_det): &(Vec<f64>, f64)) -> (f64, f64) {
    let most = FAR * median(white.iter().map(|one| one.abs()).collect()) / MEDIAN_OF_NORMAL;
    let count = white.len().max(1) as f64;
    let sum: f64 = white.iter().map(|one| one.abs().min(most).powi(2)).sum();
    let variance = (sum / count).max(f64::MIN_POSITIVE);
    (-0.5 * count * variance.ln() - 0.5 * log_det, variance.sqrt())
}
