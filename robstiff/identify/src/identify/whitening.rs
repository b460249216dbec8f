//! Generalised least squares for readings that share their unloaded reading.
//!
//! A displacement is a loaded reading minus the unloaded reading of its visit.
//! With `n` rows in a visit, what a row has to itself of variance `v` and an
//! unloaded reading of variance `lambda v` (`lambda` is 1 where one unloaded
//! reading as noisy as a loaded one serves the visit, 0 where each row has its
//! own, `1 / m` where it is a mean of `m`), the rows of one axis have the
//! covariance `v (I + lambda 1 1^T)`. The inverse square root of the matrix is
//! `I - (1 - 1/sqrt(1 + lambda n)) / n 1 1^T`, so whitening subtracts that share
//! of the visit's mean from each of its rows; ordinary least squares on whitened
//! rows is then generalised least squares on the readings.

use nalgebra::DMatrix;
use std::vec::Vec;

/// What whitening takes from every row of a visit of `rows` rows: this factor
/// times the visit's mean; `shared` is `lambda`.
pub fn mean_share(rows: usize, shared: f64) -> f64 {
    1.0 - (1.0 / (1.0 + shared * rows as f64)).sqrt()
}

/// The noise of a reading over that which a row has to itself: the row is the difference of
/// a loaded and an unloaded reading, of which `shared` is `lambda`.
pub fn reading_of(shared: f64) -> f64 {
    (0.5 * (1.0 + shared)).sqrt()
}

/// The rows of each visit, and what whitening takes from them: a whitening that
/// is done often.
#[derive(Clone, Debug)]
pub struct ByVisit {
    /// A visit each, with the share of the sum.
    visits: Vec<(Vec<usize>, f64)>,
}

impl ByVisit {
    /// Of rows that belong to `visits`; `shared` is `lambda`.
    pub fn new(visits: &[usize], shared: f64) -> Self {
        let share = |rows: &Vec<usize>| mean_share(rows.len(), shared) / rows.len() as f64;
        Self {
            visits: members(visits).into_iter().map(|rows| (share(&rows), rows)).map(|(s, rows)| (rows, s)).collect(),
        }
    }

    /// As [`whiten`], of rows that begin at `first` of every column.
    pub fn whiten(&self, stacked: &mut DMatrix<f64>, first: usize, axes: usize) {
        for mut column in stacked.column_iter_mut() {
            let column = &mut column.as_mut_slice()[first..];
            for (rows, share) in &self.visits {
                for axis in 0..axes {
                    let sum: f64 = rows.iter().map(|row| column[row * axes + axis]).sum();
                    let taken = share * sum;
                    rows.iter().for_each(|row| column[row * axes + axis] -= taken);
                }
            }
        }
    }
}

/// The rows of each visit, visits in order of their index.
fn members(visits: &[usize]) -> Vec<Vec<usize>> {
    let count = visits.iter().max().map_or(0, |last| last + 1);
    let mut members = std::vec![Vec::new(); count];
    for (row, &visit) in visits.iter().enumerate() {
        members[visit].push(row);
    }
    members.retain(|rows| !rows.is_empty());
    members
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `W^T W` is the inverse of the covariance of the rows of a visit.
    #[test]
    fn whitening_is_the_inverse_square_root_of_the_covariance() {
        let visits = [0, 0, 1, 0, 0, 2, 2];
        let rows = visits.len();
        for shared in [0.0, 0.3, 1.0] {
            let covariance = DMatrix::from_fn(rows, rows, |i, j| {
                f64::from(u8::from(i == j)) + shared * f64::from(u8::from(visits[i] == visits[j]))
            });
            let mut whitener = DMatrix::identity(rows, rows);
            ByVisit::new(&visits, shared).whiten(&mut whitener, 0, 1);
            let inverse = covariance.try_inverse().expect("positive definite");
            assert!((whitener.transpose() * &whitener - inverse).amax() < 1e-14);
        }
    }

    #[test]
    fn axes_do_not_mix() {
        let mut stacked = DMatrix::from_column_slice(6, 1, &[1.0, 10.0, 100.0, 3.0, 30.0, 300.0]);
        ByVisit::new(&[0, 0], 1.0).whiten(&mut stacked, 0, 3);
        for axis in 0..3 {
            let scale = 10.0_f64.powi(axis);
            let share = mean_share(2, 1.0) * 2.0 * scale;
            assert!((stacked[axis as usize] - (scale - share)).abs() < 1e-12);
            assert!((stacked[3 + axis as usize] - (3.0 * scale - share)).abs() < 1e-12);
        }
    }
}
