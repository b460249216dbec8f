//! Positions that do not belong to the others.
//!
//! A row is held against what the fit leaves of the others: by how much the sum of
//! squares falls without it, which is Fisher's F with three degrees of freedom over
//! the rest's. Several outlying rows hide each other in that, so the row that stands out
//! most is taken away [one by one](crate::identify::one_by_one).

use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use crate::identify::covariance::outliers::{FEW, STANDS_OUT, STRICT};
use crate::identify::normal::Normal;
use crate::identify::one_by_one::up_to_the_last;
use crate::identify::problem::Problem;
use crate::probability::{fisher_tail, told};

/// The median of chi-square with three degrees of freedom.
const MEDIAN: f64 = 2.366;

/// Single rows that are outlying; by default, none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wild {
    /// The rows, by index, the one that stands out most first.
    pub rows: Vec<usize>,
    /// The probability of the last, over all rows.
    pub p: f64,
    /// What is left without them: the sum of squares (m^2).
    pub rss: f64,
}

/// More rows than [a few](FEW) stand out: what is wrong is no matter of single rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Many {
    /// As many as were asked for, by index, the one that stands out most first.
    pub rows: Vec<usize>,
    /// The probability of the last, over all rows.
    pub p: f64,
}

/// The rows of a regression that are outlying. Unless `strict`, structure may be left,
/// and they must stand out from that as well.
///
/// # Errors
/// Too many of them.
pub fn wild_rows(problem: &Problem, strict: bool) -> Result<Wild, Many> {
    let columns: Vec<usize> = (0..problem.white.ncols()).collect();
    let mut rows: Vec<usize> = problem.blocks.iter().flat_map(|block| block.rows.iter().copied()).collect();
    let most = (FEW * rows.len() as f64).floor() as usize;
    let mut total = problem.total.clone();
    let found = up_to_the_last(most + 1, || {
        let (fit, inverse) = (total.solve(&columns)?, total.inverse(&columns)?);
        let gains: Vec<f64> = rows.iter().map(|&row| gain(problem, row, &fit.coefficients, &inverse)).collect();
        let worst = (0..rows.len()).max_by(|&a, &b| gains[a].total_cmp(&gains[b]))?;
        let mut sorted = gains.clone();
        sorted.sort_by(f64::total_cmp);
        let variance = sorted[sorted.len() / 2] / MEDIAN;
        let freedom = total.rows as f64 - columns.len() as f64 - 3.0;
        let others = (fit.rss - gains[worst]).max(freedom * variance);
        let tail = fisher_tail(gains[worst] / 3.0 / (others / freedom), [3.0, freedom]);
        let p = tail.filter(|_| others > 0.0).map(|tail| told(rows.len() as f64 * tail))?;
        let over = gains[worst] / variance;
        let row = rows.remove(worst);
        let (x, y) = of_row(problem, row);
        total = total.without(&Normal::small(&x, &y));
        let stands_out = p <= STRICT && (strict || over > STANDS_OUT);
        Some((row, stands_out.then(|| (p, total.solve(&columns).map_or(f64::INFINITY, |fit| fit.rss)))))
    });
    match found {
        Some((rows, (p, _))) if rows.len() > most => Err(Many { rows, p }),
        Some((rows, (p, rss))) => Ok(Wild { rows, p, rss }),
        None => Ok(Wild::default()),
    }
}

fn of_row(problem: &Problem, row: usize) -> (DMatrix<f64>, DVector<f64>) {
    (problem.white.rows(3 * row, 3).into_owned(), problem.white_readings.rows(3 * row, 3).into_owned())
}

/// By how much the sum of squares falls without a row: `e^T (I - X M X^T)^-1 e`.
fn gain(problem: &Problem, row: usize, coefficients: &DVector<f64>, inverse: &DMatrix<f64>) -> f64 {
    let (x, y) = of_row(problem, row);
    let left: Vector3<f64> = (y - &x * coefficients).fixed_rows::<3>(0).into_owned();
    let pull: Matrix3<f64> = (&x * inverse * x.transpose()).fixed_view::<3, 3>(0, 0).into_owned();
    let own = Matrix3::identity() - pull;
    own.cholesky().map_or(0.0, |factor| left.dot(&factor.solve(&left)))
}
