//! Rows of displacements that the rest of the campaign contradicts: those of which the load is
//! wrong, above all.
//!
//! An outlying displacement is contradicted by the other readings of its own pose
//! ([`outliers`](super::covariance::outliers)), which have a free response to their loads. An outlying
//! load is not: one that is alone in its direction, or a thousand times the others, *is* that
//! response. It pulls the fit to all poses, the more the larger it is. So a row is held against
//! the fit to the others: by how much the sum of squares falls without it, over the variance that
//! the others then have. Of those the median counts, for the model may lack something. What it
//! lacks grows with the load, and the other rows of the visit and the pose have it, too: a row must
//! be off by many times the share of its displacement that they are off by. Several outlying rows hide
//! each other, so the row without which least is left is taken away [one by one](super::one_by_one),
//! and each is judged once more by the fit without all of them.

use std::rc::Rc;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::baseline::{Visibility, visibility};
use super::column::Column;
use super::covariance::outliers::{FEW, STRICT};
use super::covariance::{Covariance, NOISELESS, Outlier};
use super::normal::Fit;
use super::one_by_one::up_to_the_last;
use super::prepare::{Prepared, believed_noise};
use super::problem::{Block, Problem, Weights, raw};
use super::whitening::mean_share;
use crate::campaign::Campaign;
use crate::probability::{fisher_tail, told};

/// What an outlying row must explain over the variance of the others: beyond fourteen standard
/// deviations, since structure may be left.
const STANDS_OUT: f64 = 200.0;

/// What it must explain, of the square of its displacement, over what the others of its visit or
/// its pose do: four times the share.
const OF_ITS_OWN: f64 = 16.0;

/// So many rows may hide each other: further ones are looked for behind one that does not
/// stand out.
const HIDDEN: usize = 20;

/// What a row alone decides leaves this share of its readings' variance or less.
const ALONE: f64 = 1e-9;

/// Leaves out of a fit the rows that the rest of the campaign contradicts. A load that is wrong
/// makes the other readings of its pose look outlying, so where others do, what is outlying among these is
/// asked again without it. Whether there are any that the other readings of their pose did not
/// contradict.
pub fn leave_out(prepared: &mut Prepared<'_>, campaign: &Campaign) -> bool {
    let wild = wild_rows(prepared);
    let known = prepared.covariance.beyond_doubt();
    let is_known = |row: &usize| known.iter().any(|outlier| outlier.rows.contains(row));
    let is_wild = |outlier: &Outlier| outlier.rows.iter().all(|row| wild.contains(row));
    if wild.is_empty() || (wild.iter().all(is_known) && known.iter().all(is_wild)) {
        return false;
    }
    let (training, frame) = (|pose: usize| prepared.training[pose], prepared.data.measured_frame);
    let mut covariance = Covariance::estimate_without(&prepared.straight, frame, campaign.noise, training, &wild);
    if covariance.encoders.is_none() {
        covariance.encoders = prepared.covariance.encoders.clone();
    }
    covariance.outliers.extend(prepared.covariance.outliers.iter().filter(|outlier| is_wild(outlier)).cloned());
    covariance.outliers.sort_by_key(|outlier| outlier.rows[0]);
    prepared.declared_noise = believed_noise(campaign, &covariance);
    prepared.covariance = covariance;
    wild.iter().for_each(|&row| prepared.left_out[row] = true);
    true
}

/// The rows that the others contradict, by index, of those that are fitted to; none where they
/// are more than a few, and none of a pose most of whose rows are: that is the pose, and may be
/// what the description lacks.
fn wild_rows(prepared: &Prepared<'_>) -> Vec<usize> {
    let look = Look::new(prepared);
    let mut left_out = prepared.left_out.clone();
    let Some(mut fitted) = look.without(&left_out) else { return Vec::new() };
    let rows = fitted.rows.len();
    let most = (FEW * rows as f64).floor() as usize;
    let mut behind = 0;
    let found = up_to_the_last(most + 1, || {
        if behind == HIDDEN {
            return None;
        }
        let &worst = fitted.rows.iter().max_by(|a, b| a.gain.total_cmp(&b.gain))?;
        left_out[worst.row] = true;
        fitted = look.without(&left_out)?;
        let stood_out = fitted.contradict(&worst, &look, rows);
        behind = if stood_out { 0 } else { behind + 1 };
        Some((worst.row, stood_out.then_some(())))
    });
    let Some((mut taken, ())) = found.filter(|(taken, ())| taken.len() <= most) else { return Vec::new() };
    left_out.clone_from(&prepared.left_out);
    taken.iter().for_each(|&row| left_out[row] = true);
    let Some(others) = look.without(&left_out) else { return Vec::new() };
    taken.retain(|&row| others.contradict(&Row { row, gain: look.beyond(row, &others) }, &look, rows));
    let pose = |row: usize| prepared.samples.rows[row].pose;
    let wild = taken.clone();
    taken.retain(|&row| {
        let of_pose = look.training.iter().filter(|&&other| pose(other) == pose(row)).count();
        let wild = wild.iter().filter(|&&other| pose(other) == pose(row)).count();
        of_pose == 1 || 2 * wild <= of_pose
    });
    taken
}

/// What fits have in common that are to different rows.
struct Look<'p> {
    prepared: &'p Prepared<'p>,
    raw: DMatrix<f64>,
    readings: Rc<DVector<f64>>,
    training: Vec<usize>,
    /// The median of what a row explains of noise with variance 1.
    median: f64,
}

/// A fit to some of the rows.
struct Fitted {
    rows: Vec<Row>,
    problem: Problem,
    fit: Fit,
    inverse: DMatrix<f64>,
}

#[derive(Clone, Copy)]
struct Row {
    row: usize,
    /// By how much the sum of squares falls without it (m^2).
    gain: f64,
}

impl<'p> Look<'p> {
    fn new(prepared: &'p Prepared<'p>) -> Self {
        let samples = &prepared.samples;
        let columns: Vec<Column> = prepared.seen().into_iter().map(|i| prepared.own[i].column).collect();
        let is_fitted_to = |&row: &usize| prepared.training[samples.rows[row].pose] && !prepared.left_out[row];
        Self {
            raw: raw(samples, &columns),
            readings: Rc::new(prepared.readings(samples)),
            training: (0..samples.rows.len()).filter(is_fitted_to).collect(),
            median: ChiSquared::new(samples.axes as f64).map_or(1.0, |square| square.inverse_cdf(0.5)),
            prepared,
        }
    }

    /// The fit without some rows, of the numbers that the others show.
    fn without(&self, left_out: &[bool]) -> Option<Fitted> {
        let Prepared { samples, covariance, training, correction, .. } = self.prepared;
        if self.training.iter().all(|&row| left_out[row]) {
            return None;
        }
        let weights = Weights { covariance, training, left_out };
        let problem = Problem::new(samples, self.raw.clone(), Rc::clone(&self.readings), correction, weights);
        let shown = visibility(&problem.total, self.raw.ncols());
        let columns: Vec<usize> = (0..shown.len()).filter(|&k| shown[k] == Visibility::Seen).collect();
        let fit = problem.total.solve(&columns)?;
        let inverse = problem.total.inverse(&columns)?;
        let mut rows = Vec::new();
        for block in problem.blocks.iter() {
            rows.extend(self.gains(&problem, block, &fit, &inverse));
        }
        Some(Fitted { rows, problem, fit, inverse })
    }

    /// What each row of a pose explains: by numbers of its own, one an axis, which whitening
    /// spreads over the rows that share its unloaded reading.
    fn gains(&self, problem: &Problem, block: &Block, fit: &Fit, inverse: &DMatrix<f64>) -> Vec<Row> {
        let samples = &self.prepared.samples;
        let mut visits: Vec<usize> = block.rows.iter().map(|&row| samples.rows[row].visit).collect();
        visits.sort_unstable();
        visits.dedup();
        let mut gains = Vec::new();
        for visit in visits {
            let rows: Vec<usize> = block.rows.iter().copied().filter(|&row| samples.rows[row].visit == visit).collect();
            let count = rows.len() as f64;
            let share = mean_share(rows.len(), problem.shared) / count;
            let of_rows: Vec<(DMatrix<f64>, DVector<f64>)> =
                rows.iter().map(|&row| of_row(problem, fit, row)).collect();
            let common: DMatrix<f64> = of_rows.iter().map(|(shown, _)| shown).sum::<DMatrix<f64>>() * share;
            let common_left: DVector<f64> = of_rows.iter().map(|(_, left)| left).sum::<DVector<f64>>() * share;
            let length = 1.0 - 2.0 * share + count * share * share;
            for (row, (shown, left)) in rows.into_iter().zip(of_rows) {
                let (shown, left) = (shown - &common, left - &common_left);
                let own = DMatrix::identity(left.len(), left.len()) * length - &shown * inverse * shown.transpose();
                gains.push(Row { row, gain: over(&left, own, ALONE * length) });
            }
        }
        gains
    }

    /// How far a row is beyond a fit without it, as what it explains of a fit with it (m^2).
    fn beyond(&self, row: usize, others: &Fitted) -> f64 {
        let (shown, left) = of_row(&others.problem, &others.fit, row);
        let own = DMatrix::identity(left.len(), left.len()) + &shown * &others.inverse * shown.transpose();
        over(&left, own, 0.0)
    }

    /// How far the arm gave way at a row (m), as it was read or as a fit has it, whichever is less:
    /// one of the two is right.
    fn given(&self, row: usize, fit: &Fit) -> f64 {
        let axes = self.prepared.samples.axes;
        self.moved(row, fit).min(self.readings.fixed_rows::<3>(row * axes).norm())
    }

    /// How far the arm gives way at a row, by a fit (m).
    fn moved(&self, row: usize, fit: &Fit) -> f64 {
        let of_axis = |axis: usize| {
            let parts = fit.columns.iter().zip(fit.coefficients.iter());
            parts.map(|(&k, value)| self.raw[(row * self.prepared.samples.axes + axis, k)] * value).sum::<f64>()
        };
        (0..3).map(|axis| of_axis(axis).powi(2)).sum::<f64>().sqrt()
    }
}

/// The whitened columns of a row, and what a fit leaves of its readings, axes below each other.
fn of_row(problem: &Problem, fit: &Fit, row: usize) -> (DMatrix<f64>, DVector<f64>) {
    let first = row * problem.axes;
    let shown =
        DMatrix::from_fn(problem.axes, fit.columns.len(), |axis, k| problem.white[(first + axis, fit.columns[k])]);
    let left = problem.white_readings.rows(first, problem.axes) - &shown * &fit.coefficients;
    (shown, left)
}

/// The square of what is left over its covariance, along what that is more than so much of.
fn over(left: &DVector<f64>, covariance: DMatrix<f64>, least: f64) -> f64 {
    let parts = SymmetricEigen::new(covariance);
    let along = parts.eigenvectors.tr_mul(left);
    let told = along.iter().zip(&parts.eigenvalues).filter(|(_, own)| **own > least);
    told.map(|(along, own)| along * along / own).sum()
}

impl Fitted {
    /// Whether a row that this is without stands out from the others, of so many rows.
    fn contradict(&self, wild: &Row, look: &Look<'_>, rows: usize) -> bool {
        let mut moved: Vec<(f64, f64)> =
            self.rows.iter().map(|other| (look.moved(other.row, &self.fit), other.gain)).collect();
        moved.sort_by(|a, b| a.0.total_cmp(&b.0));
        let third = |at: usize| 3 * at.min(moved.len().saturating_sub(1)) / moved.len().max(1);
        let own = third(moved.partition_point(|(other, _)| *other < look.moved(wild.row, &self.fit)));
        let variance = |of: &dyn Fn(usize) -> bool| {
            let mut gains: Vec<f64> =
                moved.iter().enumerate().filter(|(at, _)| of(*at)).map(|(_, (_, gain))| *gain).collect();
            gains.sort_by(f64::total_cmp);
            gains.get(gains.len() / 2).copied().unwrap_or(0.0) / look.median
        };
        let variance = variance(&|_| true).max(variance(&|at| third(at) == own));
        let axes = look.prepared.samples.axes as f64;
        let freedom = self.problem.freedom(&self.fit);
        let others = self.fit.rss.max(freedom * variance).max(f64::MIN_POSITIVE);
        let ratio = wild.gain / axes / (others / freedom);
        let p = fisher_tail(ratio, [axes, freedom]).map_or(1.0, |tail| told(rows as f64 * tail));
        // Readings without noise have only rounding to stand out from.
        let stands_out = wild.gain > STANDS_OUT * variance && wild.gain > NOISELESS * NOISELESS;
        p <= STRICT
            && stands_out
            && wild.gain > OF_ITS_OWN * self.share(wild.row, look) * look.given(wild.row, &self.fit).powi(2)
    }

    /// What other rows explain of the square of how far the arm gave way at them: those of a
    /// row's visit or those of its pose, whichever is more; all, of one that is alone there.
    fn share(&self, row: usize, look: &Look<'_>) -> f64 {
        let of = |row: usize| &look.prepared.samples.rows[row];
        let among = |is_one: &dyn Fn(usize) -> bool| {
            let rows = self.rows.iter().filter(|other| other.row != row && is_one(other.row));
            let (explained, given) = rows.fold((0.0, 0.0), |(explained, given), other| {
                (explained + other.gain, given + look.given(other.row, &self.fit).powi(2))
            });
            (given > 0.0).then(|| explained / given)
        };
        let of_visit = among(&|other| of(other).visit == of(row).visit);
        let of_pose = among(&|other| of(other).pose == of(row).pose);
        let alike = of_visit.into_iter().chain(of_pose).reduce(f64::max);
        alike.or_else(|| among(&|_| true)).unwrap_or(0.0)
    }
}
