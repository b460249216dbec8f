//! What a reading is off by.
//!
//! The readings of a pose have the covariance, for each of their axes alike,
//!
//! `S = s^2 [diag(v_r / w_r) + rho 1_visit + kappa F_r . F_s / F_0^2]`.
//!
//! `s` is the noise of one reading. `rho` is the unloaded reading that the rows of a visit share.
//! `v_r = 1 + (a |d_r|)^2` grows with the displacement. `w_r` is small where a row is outlying: see
//! [`tails`](super::tails). The last part is what the model does not account for at a pose, its *discrepancy* (Kennedy and
//! O'Hagan, J. R. Statist. Soc. B 63, 2001): a random compliance of each pose, which adds the more,
//! the larger the load. Encoders have another covariance: see [`encoders`].

use nalgebra::{DMatrix, DVector, Vector3};

use super::encoders;
use super::tails::{Apart, most_apart, weigh};
use crate::observe::Readings;
use crate::probability::median;

/// The discrepancies `kappa` that are weighed against each other; none has half the prior.
pub const DISCREPANCIES: [f64; 5] = [0.0, 0.03, 0.3, 3.0, 30.0];

/// The shares `rho` of the unloaded reading that are tried: none, some, and as noisy as the loaded
/// one.
const SHARED: [f64; 3] = [0.0, 0.3, 1.0];

/// The parts of a displacement by which noise may grow that are tried.
const PROPORTIONAL: [f64; 5] = [0.0, 0.005, 0.01, 0.02, 0.04];

/// The log-odds against noise that grows, and against an unusual share, before the data speak.
const AGAINST_GROWTH: f64 = 4.0;
/// See [`AGAINST_GROWTH`].
const AGAINST_SOME: f64 = 2.0;

/// Rounds until noise that grows is of its own size.
const GROWING: usize = 4;

/// A row with less weight than this is outlying.
pub const OUTLYING: f64 = 0.3;

/// What the noise takes where the description's own numbers are fitted alone, and what is missing stays. A row that
/// does not belong to the others weighs by its own residual then. Where candidates are searched it does not: what is
/// missing looks like such rows.
#[derive(Clone, Copy, Debug)]
pub struct Lacking {
    /// What discrepancies are times [`DISCREPANCIES`]: as much as is missing.
    pub times: f64,
    /// How many numbers the residuals are free of.
    pub fitted: f64,
}

impl Default for Lacking {
    fn default() -> Self {
        Self { times: 1.0, fitted: 0.0 }
    }
}

/// The noise of the readings, up to its size.
#[derive(Clone, Debug)]
pub struct Noise {
    /// The weight `w` of each row.
    pub weights: Vec<f64>,
    /// The share `rho` of the unloaded reading.
    pub shared: f64,
    /// The growth `a` with the displacement (1/m).
    pub growth: f64,
    /// Where the description's own numbers are fitted alone, what that takes; none where candidates are searched.
    pub lacking: Option<Lacking>,
    /// What brings each channel to the noise of the first.
    pub scales: Vec<f64>,
    /// Which rows of an encoder share a level, and its variance `tau` over that of one reading.
    pub level: (encoders::Level, f64),
    /// The rows that do not belong to the others.
    pub apart: Apart,
    /// The size of the displacement of each row (m).
    sizes: Vec<f64>,
}

impl Noise {
    /// Alike for all rows; rotations and encoders as noisy as if read over `lever` (m).
    pub fn plain(readings: &Readings, lever: f64) -> Self {
        let channels = readings.channels.iter().max().map_or(1, |last| last + 1);
        let sizes = match readings.differences {
            true => (0..readings.rows()).map(|row| readings.square(&readings.values, row).sqrt()).collect(),
            false => vec![0.0; readings.rows()],
        };
        Self {
            weights: vec![1.0; readings.rows()],
            shared: if has_shared(readings) { 1.0 } else { 0.0 },
            growth: 0.0,
            lacking: None,
            scales: (0..channels).map(|channel| if channel == 0 { 1.0 } else { lever }).collect(),
            level: encoders::UNKNOWN,
            apart: Apart::default(),
            sizes,
        }
    }

    /// What discrepancies are times [`DISCREPANCIES`].
    pub fn lack(&self) -> f64 {
        self.lacking.map_or(1.0, |of| of.times)
    }

    /// The variance of a row's own reading, over that of one reading.
    fn own(&self, row: usize, growth: f64) -> f64 {
        1.0 + (growth * self.sizes[row]).powi(2)
    }

    /// Learns from what a model leaves, under some discrepancy, of the blocks that it was fitted to.
    pub fn learn(&mut self, readings: &Readings, left: &DVector<f64>, kappa: f64, training: &[bool]) {
        let rows: Vec<Vec<usize>> = rows_of_blocks(readings, training);
        self.learn_scales(readings, left, &rows);
        let shares: &[f64] = if has_shared(readings) { &SHARED } else { &SHARED[..1] };
        for _ in 0..2 {
            let parts: &[f64] = if may_grow(readings) { &PROPORTIONAL } else { &PROPORTIONAL[..1] };
            let tried = shares.iter().flat_map(|share| parts.iter().map(move |part| (*share, *part)));
            let judged = tried.map(|(share, part)| {
                let price = if part > 0.0 { AGAINST_GROWTH } else { 0.0 }
                    + if share > 0.0 && share < 1.0 { AGAINST_SOME } else { 0.0 }
                    + self.hidden(readings, share);
                let (likelihood, growth) = self.grown(readings, left, kappa, &rows, (share, part));
                (likelihood - price, share, growth)
            });
            if let Some((_, share, growth)) = judged.max_by(|a, b| a.0.total_cmp(&b.0)) {
                (self.shared, self.growth) = (share, growth);
            }
            self.learn_weights(readings, left, kappa, &rows);
        }
        self.learn_encoders(readings, left, kappa, &rows);
    }

    /// How much of the log-likelihood of an unloaded reading the numbers of a fit may have taken: each takes at most one of
    /// those that visits share.
    fn hidden(&self, readings: &Readings, share: f64) -> f64 {
        let visits = readings.visit.iter().max().map_or(1, |last| last + 1);
        let of_visit = readings.rows() as f64 / visits as f64;
        let fitted = self.lacking.map_or(0.0, |of| of.fitted);
        0.5 * fitted * ((1.0 + of_visit) / (1.0 + share * of_visit)).ln()
    }

    /// The log-likelihood where noise has a part in proportion to the displacement, and how it grows
    /// then: by this part over its own size.
    fn grown(
        &self,
        readings: &Readings,
        left: &DVector<f64>,
        kappa: f64,
        rows: &[Vec<usize>],
        (share, part): (f64, f64),
    ) -> (f64, f64) {
        let mut growth = 0.0;
        let (mut likelihood, mut size) = self.likelihood(readings, left, kappa, rows, (share, growth));
        if part > 0.0 {
            for _ in 0..GROWING {
                growth = part / size;
                (likelihood, size) = self.likelihood(readings, left, kappa, rows, (share, growth));
            }
            // Nothing grows by a part that is nearer to the one below, or to none.
            if size * growth < 0.5 * part {
                return (f64::NEG_INFINITY, 0.0);
            }
        }
        (likelihood, growth)
    }

    /// Rotations by the medians of their residuals: these have the covariance of displacements.
    fn learn_scales(&mut self, readings: &Readings, left: &DVector<f64>, rows: &[Vec<usize>]) {
        let median = |channel: usize| {
            let numbers = rows.iter().flatten().flat_map(|row| {
                let of_row = (0..readings.width).filter(move |k| readings.channels[*k] == channel);
                of_row.map(move |k| left[row * readings.width + k].abs())
            });
            median(numbers.collect())
        };
        let first = median(0);
        for channel in 1..self.scales.len().min(2) {
            let own = median(channel);
            if own > 0.0 && first > 0.0 {
                self.scales[channel] = first / own;
            }
        }
    }

    /// The levels of encoders, and the noise of each over that of displacements.
    fn learn_encoders(&mut self, readings: &Readings, left: &DVector<f64>, kappa: f64, rows: &[Vec<usize>]) {
        let Some(learned) = encoders::learned(readings, left, rows, &|row| self.of_row(row)) else { return };
        let size = self.likelihood(readings, left, kappa, rows, (self.shared, self.growth)).1;
        self.level = learned.level;
        for (axis, of_axis) in learned.sizes {
            if of_axis > 0.0 && size > 0.0 {
                self.scales[readings.channels[axis]] = size / of_axis;
            }
        }
    }

    /// The covariance of an encoder over some rows of a block, over its variance.
    pub fn of_encoder(&self, readings: &Readings, rows: &[usize]) -> DMatrix<f64> {
        encoders::covariance(readings, rows, self.level, &|row| self.of_row(row))
    }

    /// The log-likelihood of the residuals, at their most likely size, and that size (m).
    fn likelihood(
        &self,
        readings: &Readings,
        left: &DVector<f64>,
        kappa: f64,
        rows: &[Vec<usize>],
        (share, growth): (f64, f64),
    ) -> (f64, f64) {
        let (mut sum, mut log_det, mut count) = (0.0, 0.0, 0);
        for rows in rows.iter().filter(|rows| !rows.is_empty()) {
            let Some(factor) = self.covariance(readings, rows, kappa, (share, growth)).cholesky() else { continue };
            let reported = self.reported(readings, left, rows);
            sum += reported.dot(&factor.solve(&reported));
            log_det += factor.l_dirty().diagonal().iter().map(|d| 2.0 * d.ln()).sum::<f64>() * reported.ncols() as f64;
            count += reported.len();
        }
        let count = count.max(1) as f64;
        let variance = (sum / count).max(f64::MIN_POSITIVE);
        (-0.5 * count * variance.ln() - 0.5 * log_det, variance.sqrt())
    }

    /// Weighs rows by how likely each is outlying, once what its visit and pose share is taken out.
    fn learn_weights(&mut self, readings: &Readings, left: &DVector<f64>, kappa: f64, rows: &[Vec<usize>]) {
        let size = self.likelihood(readings, left, kappa, rows, (self.shared, self.growth)).1;
        let mut squares = vec![0.0; readings.rows()];
        // How far a row is off what the others of its pose say of it, and the variance of what they say, over that of
        // one reading.
        let mut beside = vec![(0.0, 0.0); readings.rows()];
        for rows in rows.iter().filter(|rows| !rows.is_empty()) {
            let covariance = self.covariance(readings, rows, kappa, (self.shared, self.growth));
            let Some(factor) = covariance.cholesky() else { continue };
            let solved = factor.solve(&self.reported(readings, left, rows));
            let inverse = self.lacking.map(|_| factor.inverse());
            for (k, &row) in rows.iter().enumerate() {
                let own = self.own(row, self.growth);
                let weighed = own / self.weights[row];
                let solved = solved.row(k).norm_squared() / (size * size);
                squares[row] = solved * weighed * weighed / own;
                if let Some(inverse) = &inverse {
                    let said = (1.0 / inverse[(k, k)] - weighed).max(0.0);
                    beside[row] = (solved / inverse[(k, k)].powi(2), said);
                    squares[row] = beside[row].0 / (own + said);
                }
            }
        }
        let rows: Vec<usize> = rows.iter().flatten().copied().collect();
        let of_rows: Vec<f64> = rows.iter().map(|&row| squares[row]).collect();
        let axes = readings.reported as f64;
        let (weights, apart) = weigh(&of_rows, axes, may_be_anything(readings));
        rows.iter().zip(weights).for_each(|(&row, weight)| self.weights[row] = weight);
        let mut beyond: Vec<usize> = apart.beyond.iter().map(|&k| rows[k]).collect();
        if self.lacking.is_some() && is_loaded(readings) {
            // What is missing grows with the load, too.
            let most = |row: usize| (PROPORTIONAL[PROPORTIONAL.len() - 1] * self.sizes[row] / size).powi(2);
            beyond.retain(|&row| beside[row].0 > most(row));
        }
        beyond.sort_unstable();
        self.apart = Apart { beyond, ..apart };
        // A row that does not belong to the others may be off by anything: by its own residual it is likeliest.
        // Many of them are what the noise is like.
        if self.lacking.is_some() && self.apart.rows().len() <= most_apart(rows.len()) {
            for &row in self.apart.rows() {
                let (own, (off, said)) = (self.own(row, self.growth), beside[row]);
                self.weights[row] = self.weights[row].min(own / (off / axes - said).max(own));
            }
        }
    }

    /// The reported part of some rows, a column an axis.
    fn reported(&self, readings: &Readings, left: &DVector<f64>, rows: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), readings.reported, |i, k| left[rows[i] * readings.width + k])
    }

    /// The covariance of one axis over some rows of a block, over `s^2`.
    fn covariance(&self, readings: &Readings, rows: &[usize], kappa: f64, (share, growth): (f64, f64)) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), rows.len(), |i, j| {
            let (a, b) = (rows[i], rows[j]);
            let own = if i == j { self.own(a, growth) / self.weights[a] } else { 0.0 };
            let visit = if readings.visit[a] == readings.visit[b] { share } else { 0.0 };
            own + visit + self.lack() * kappa * readings.force[a].dot(&readings.force[b])
        })
    }

    /// The covariance of one axis over some rows of a block without any discrepancy, over `s^2`.
    pub fn of_block(&self, readings: &Readings, rows: &[usize]) -> DMatrix<f64> {
        self.covariance(readings, rows, 0.0, (self.shared, self.growth))
    }

    /// The variance of the middle one of all rows over `s^2`, as weighed.
    pub fn of_middle_row(&self) -> f64 {
        median((0..self.weights.len()).map(|row| self.of_row(row)).collect())
    }

    /// The variance of a row's own reading over `s^2`, as weighed.
    pub fn of_row(&self, row: usize) -> f64 {
        self.own(row, self.growth) / self.weights[row]
    }
}

/// The rows of the blocks that are fitted to, a list each.
pub fn rows_of_blocks(readings: &Readings, training: &[bool]) -> Vec<Vec<usize>> {
    let mut rows = vec![Vec::new(); readings.blocks];
    for (row, &block) in readings.block.iter().enumerate() {
        if training[block] {
            rows[block].push(row);
        }
    }
    rows
}

/// Whether rows share an unloaded reading with others.
fn has_shared(readings: &Readings) -> bool {
    let visits = readings.visit.iter().max().map_or(0, |last| last + 1);
    // Of a clamped axis every row has its own; what turns it is no force on the tool.
    readings.differences && is_loaded(readings) && visits < readings.rows()
}

/// Whether noise may grow with the displacement. An axis has few rows, and those without a load may read exactly zero: by
/// them noise would be all growth.
fn may_grow(readings: &Readings) -> bool {
    readings.differences && is_loaded(readings)
}

/// Whether a row may be off by anything, and then has no pull on the others. Under loads it may not: what is missing
/// looks like such rows, and is no larger than what was read.
fn may_be_anything(readings: &Readings) -> bool {
    !readings.differences
}

fn is_loaded(readings: &Readings) -> bool {
    readings.force.iter().any(|force: &Vector3<f64>| *force != Vector3::zeros())
}

/// Whether anything loads the arm, so that there can be a discrepancy.
pub fn discrepancies(readings: &Readings) -> &'static [f64] {
    if is_loaded(readings) { &DISCREPANCIES } else { &DISCREPANCIES[..1] }
}
