//! Rows of clamped axes that are outlying.
//!
//! A row is held against what the fit leaves of the others, by its externally
//! studentised residual. Several outlying rows hide each other in that, so the row that
//! stands out most is taken away [one by one](crate::identify::one_by_one), as many times
//! as there may be outlying ones. Which stands out most a median tells, which outlying rows do
//! not move.
//!
//! Outlying rows are few, of every axis. Where many rows of one stand out, or one slip says
//! the same of them with fewer numbers, something is missing that they all have: none of
//! that axis is outlying then.

use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::regression::{loaded, problem, rows_of};
use super::rounding::of_rounding;
use crate::campaign::ClampedRow;
use crate::identify::covariance::outliers::{FEW, STANDS_OUT, STRICT, by_median};
use crate::identify::normal::Fit;
use crate::identify::one_by_one::up_to_the_last;
use crate::identify::problem::Problem;
use crate::identify::whitening::mean_share;
use crate::probability::{student_tail, told};

/// The row that stands out most.
struct Worst {
    row: usize,
    /// Its square over a variance that outlying rows do not move.
    over: f64,
    /// The probability of that much against the other rows, over all.
    p: f64,
}

/// How many rows may be outlying, of all and of each axis (from 0).
#[derive(Clone, Debug)]
pub struct Room {
    /// Of all.
    pub all: usize,
    of_axis: Vec<usize>,
}

/// Of an axis two rows may be outlying, or this share of them, but not as many as the others.
const FEW_OF_AXIS: f64 = 0.2;
const TWO: usize = 2;

impl Room {
    /// That of a campaign.
    pub fn new(rows: &[ClampedRow]) -> Self {
        let few = |rows: usize| ((FEW_OF_AXIS * rows as f64) as usize).max(TWO).min(rows.saturating_sub(1) / 2);
        let axes = rows.iter().map(|row| row.axis).max().unwrap_or(0);
        Self {
            all: (FEW * rows.len() as f64).floor() as usize,
            of_axis: (1..=axes).map(|axis| few(rows_of(rows, axis).len())).collect(),
        }
    }

    /// An axis of which more of some rows are outlying than may be.
    fn exceeded(&self, rows: &[ClampedRow], wild: &[usize]) -> Option<usize> {
        let count = |axis: usize| wild.iter().filter(|&&row| rows[row].axis == axis).count();
        (1..=self.of_axis.len()).find(|&axis| count(axis) > self.of_axis[axis - 1])
    }
}

/// The rows that are outlying, by index, the one that stands out most first, with the
/// probability of the last; `raw` are the columns of the model. Unless `strict`,
/// structure may be left, and they must stand out from that as well.
pub fn wild_rows(rows: &[ClampedRow], raw: &DMatrix<f64>, strict: bool, room: &Room) -> Option<(Vec<usize>, f64)> {
    let mut at: Vec<usize> = (0..rows.len()).collect();
    loop {
        let own: Vec<ClampedRow> = at.iter().map(|&row| rows[row]).collect();
        let columns = of_rows(raw, &at);
        let (wild, p) = stand_out(&own, &columns, strict, room.all)?;
        let slipped = || loaded(&own).into_iter().find(|&axis| slips(&own, &columns, &wild, axis));
        let Some(axis) = room.exceeded(&own, &wild).or_else(slipped) else {
            return Some((wild.into_iter().map(|row| at[row]).collect(), p));
        };
        at.retain(|&row| rows[row].axis != axis);
    }
}

/// Columns in some rows, but those that are zero there.
fn of_rows(raw: &DMatrix<f64>, rows: &[usize]) -> DMatrix<f64> {
    let own = raw.select_rows(rows);
    let moved: Vec<usize> = (0..own.ncols()).filter(|&k| own.column(k).amax() > 0.0).collect();
    own.select_columns(&moved)
}

/// Whether one slip says of several outlying rows of an axis as much with fewer numbers, by
/// Schwarz's criterion: which row and how far it is off are two of each, and of a slip.
fn slips(rows: &[ClampedRow], raw: &DMatrix<f64>, wild: &[usize], axis: usize) -> bool {
    let (here, there): (Vec<usize>, Vec<usize>) = wild.iter().partition(|&&row| rows[row].axis == axis);
    if here.len() < TWO {
        return false;
    }
    let left_by = |without: &[usize], slip: bool| -> Option<f64> {
        let kept: Vec<usize> = (0..rows.len()).filter(|row| !without.contains(row)).collect();
        let own: Vec<ClampedRow> = kept.iter().map(|&row| rows[row]).collect();
        let raw = of_rows(raw, &kept);
        let base: Vec<usize> = (0..raw.ncols()).collect();
        if !slip {
            return Some(problem(&own, raw).total.solve(&base)?.rss);
        }
        let at = rows_of(&own, axis);
        let step = |from: usize| DVector::from_fn(own.len(), |row, _| f64::from(u8::from(at[from..].contains(&row))));
        let steps = (0..at.len()).map(step);
        let columns: Vec<DVector<f64>> = raw.column_iter().map(|column| column.into_owned()).chain(steps).collect();
        let total = problem(&own, DMatrix::from_columns(&columns)).equations.total;
        let with = |k: usize| total.solve(&[&base[..], &[base.len() + k]].concat()).map(|fit| fit.rss);
        (0..at.len()).filter_map(with).min_by(f64::total_cmp)
    };
    let Some((without, with)) = left_by(wild, false).zip(left_by(&there, true)) else { return false };
    let (count, more) = (rows.len() as f64, 2.0 * (here.len() - 1) as f64);
    count * (with / without).ln() < more * count.ln()
}

/// The rows that stand out, `most` or fewer, as [`wild_rows`] gives them.
fn stand_out(rows: &[ClampedRow], raw: &DMatrix<f64>, strict: bool, most: usize) -> Option<(Vec<usize>, f64)> {
    let (mut rows, mut raw) = (rows.to_vec(), raw.clone());
    let mut at: Vec<usize> = (0..rows.len()).collect();
    let rounding = of_rounding(&rows);
    up_to_the_last(most, || {
        let worst = worst(&rows, &raw, &rounding)?;
        rows.remove(worst.row);
        raw = core::mem::take(&mut raw).remove_row(worst.row);
        let stands_out = worst.p <= STRICT && (strict || worst.over > STANDS_OUT);
        Some((at.remove(worst.row), stands_out.then_some(worst.p)))
    })
}

/// By how much the sum of squares falls without each row: by a number of its own,
/// which whitening spreads over the rows that share its unloaded reading.
pub fn gains(rows: &[ClampedRow], problem: &Problem, fit: &Fit) -> Option<Vec<f64>> {
    let inverse = problem.total.inverse(&fit.columns)?;
    let residuals = problem.white_residuals(&fit.columns, &fit.coefficients);
    let columns = problem.white.select_columns(&fit.columns);
    let mut gains = vec![0.0; residuals.len()];
    for axis in loaded(rows) {
        let rows = rows_of(rows, axis);
        let spread = mean_share(rows.len(), 1.0) / rows.len().max(1) as f64;
        let common = columns.select_rows(&rows).row_sum_tr() * spread;
        let left = residuals.select_rows(&rows).sum() * spread;
        let length = 1.0 - 2.0 * spread + rows.len() as f64 * spread * spread;
        for row in rows {
            let x = columns.row(row).transpose() - &common;
            let own = (length - x.dot(&(&inverse * &x))).max(f64::EPSILON);
            gains[row] = (residuals[row] - left).powi(2) / own;
        }
    }
    Some(gains)
}

/// The probability that the largest of so many gains is at least this much, against
/// what the others leave. `None` where they leave nothing.
pub fn tail(gain: f64, others: f64, rows: usize, columns: usize) -> Option<f64> {
    let freedom = rows as f64 - columns as f64 - 1.0;
    let tail = student_tail((gain * freedom / others).sqrt(), freedom).filter(|_| others > 0.0)?;
    Some(told(rows as f64 * 2.0 * tail))
}

/// The row that stands out most, with the variances that rounding lets be.
fn worst(rows: &[ClampedRow], raw: &DMatrix<f64>, rounding: &[f64]) -> Option<Worst> {
    let problem = problem(rows, raw.clone());
    let columns: Vec<usize> = (0..raw.ncols()).collect();
    let fit = problem.total.solve(&columns)?;
    let all = gains(rows, &problem, &fit)?;
    let whole = by_median(all.iter().copied());
    let own = of_most(rows, &(problem.readings.as_ref() - raw * &fit.coefficients));
    // One step of a gauge is no outlying reading where all others fit exactly.
    let own = |row: usize| own[rows[row].axis - 1].max(rounding[rows[row].axis - 1]);
    let over = |row: usize| all[row] / own(row).max(whole);
    let row = (0..all.len()).max_by(|&a, &b| over(a).total_cmp(&over(b)))?;
    let freedom = all.len() as f64 - columns.len() as f64 - 1.0;
    let others = (fit.rss - all[row]).max(freedom * own(row));
    let p = tail(all[row], others, all.len(), columns.len()).filter(|_| whole > 0.0)?;
    Some(Worst { row, over: over(row), p })
}

/// By axis, the variance of what is left of most of its rows, by the slope that
/// leaves least of them. A curve of its gear is in most of them; outlying rows, a
/// minority, are not.
fn of_most(rows: &[ClampedRow], residuals: &DVector<f64>) -> Vec<f64> {
    let mut variances = vec![0.0; rows.iter().map(|row| row.axis).max().unwrap_or(0)];
    for axis in loaded(rows) {
        let left: Vec<(f64, f64)> =
            rows_of(rows, axis).into_iter().map(|row| (rows[row].torque, residuals[row])).collect();
        let beside = |slope: f64| by_median(left.iter().map(|(torque, left)| (left - slope * torque).powi(2)));
        let slopes = left.iter().filter(|(torque, _)| *torque != 0.0).map(|(torque, left)| left / torque);
        variances[axis - 1] = slopes.map(beside).min_by(f64::total_cmp).unwrap_or(0.0);
    }
    variances
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::clamped::regression::torques;

    /// What a row explains is what the fit leaves less of without it.
    #[test]
    fn a_gain_is_what_the_others_leave_less() {
        let readings = [3.1e-5, 5.7e-5, 9.6e-5, 1.17e-4, 2.8e-5, 6.3e-5, 8.8e-5];
        let rows = readings.into_iter().enumerate().map(|(i, deflection)| {
            let (axis, torque) = if i < 4 { (1, 100.0 * (i + 1) as f64) } else { (3, 100.0 * (i - 3) as f64) };
            ClampedRow { line: i + 2, axis, torque, deflection }
        });
        let rows: Vec<ClampedRow> = rows.collect();
        let fitted = |rows: &[ClampedRow]| {
            let problem = problem(rows, torques(rows));
            let fit = problem.total.solve(&[0, 1]).expect("two axes");
            (problem, fit)
        };
        let (problem, fit) = fitted(&rows);
        for (row, gain) in gains(&rows, &problem, &fit).expect("two axes").into_iter().enumerate() {
            let mut others = rows.clone();
            others.remove(row);
            let without = fitted(&others).1;
            assert!(((fit.rss - without.rss) / gain - 1.0).abs() < 1e-9, "row {row}");
        }
    }
}
