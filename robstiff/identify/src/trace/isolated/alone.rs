//! Wild rows that are alone at their poses, where these are few.
//!
//! No other reading at its pose contradicts such a row, and of few rows one that is far off
//! moves the fit: it leaves less of that row than there is, and more of all others, which raises
//! even their median. So a row is held against what the fit *without it* leaves of the others,
//! by its externally studentised residual, corrected for the number of rows. Several hide each
//! other in that, so the row whose loss makes the fit better by most is taken away
//! [one by one](crate::identify::one_by_one), once more than there may be wild ones.

use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Matrix3, SymmetricEigen, Vector3};

use super::{Event, OF_MEDIAN, STANDS_OUT_AS_IT_IS};
use crate::identify::covariance::NOISELESS;
use crate::identify::covariance::heavy::{freedom_of_tails, scale_of_tails};
use crate::identify::covariance::outliers::{FEW, STANDS_OUT, STRICT, by_median};
use crate::identify::normal::{Fit, Normal, Sign};
use crate::identify::one_by_one::up_to_the_last;
use crate::identify::problem::Problem;
use crate::probability::{as_normal, chi_square_tail, told};
use crate::trace::model::{Fitted, Setting};

/// One of more rows moves a fit by too little to hide in it.
const FEW_ENOUGH: usize = 100;

/// The regression of a model on rows that are alone at their poses.
struct Alone {
    problem: Problem,
    signs: Vec<Sign>,
    /// The columns, in their order.
    columns: Vec<usize>,
    /// The normal equations of each row.
    parts: Vec<(usize, Normal)>,
    strict: bool,
}

/// What is wrong in single rows of poses fitted to, where each of these is alone at its pose and
/// they are few; nothing elsewhere, or where that would be more than a few. With `strict`, the
/// rest is taken to be noise.
pub fn events(setting: &Setting<'_>, model: &Fitted, training: &[bool], strict: bool) -> Vec<Event> {
    let samples = &setting.point.samples;
    let rows: Vec<usize> = (0..samples.rows.len()).filter(|&row| training[samples.rows[row].pose]).collect();
    let mut poses = vec![0; samples.poses];
    rows.iter().for_each(|&row| poses[samples.rows[row].pose] += 1);
    if rows.len() > FEW_ENOUGH || poses.into_iter().any(|rows| rows > 1) {
        return Vec::new();
    }
    let (problem, Fit { columns, .. }) = setting.alone(&model.fit);
    let signs = model.fit.columns.iter().map(|&column| setting.signs[column]).collect();
    let part = |row: usize| {
        let of_tool = row * samples.axes..(row + 1) * samples.axes;
        let stacked: Vec<usize> = of_tool.chain(samples.encoders_of(row)).collect();
        let readings = DVector::from_iterator(stacked.len(), stacked.iter().map(|&at| problem.white_readings[at]));
        Normal::small(&problem.white.select_rows(&stacked), &readings)
    };
    // Rows that are left out already are judged again with all others.
    let parts = rows.into_iter().map(|row| (row, part(row))).collect();
    Alone { signs, columns, parts, strict, problem }.wild()
}

impl Alone {
    fn wild(mut self) -> Vec<Event> {
        let rows = self.parts.len();
        let most = (FEW * rows as f64).floor() as usize;
        let found = up_to_the_last(most + 1, || {
            let (at, without) = self.worst()?;
            let (row, _) = self.parts.remove(at);
            let p_value = self.judge(row, &without).map(|p| told(rows as f64 * p));
            Some((row, p_value.filter(|p| *p <= STRICT)))
        });
        let Some((wild, p_value)) = found.filter(|(wild, _)| wild.len() <= most) else { return Vec::new() };
        wild.into_iter().map(|row| Event { rows: vec![row], p_value, slip: None }).collect()
    }

    /// The place of the row without which the least is left, with the fit to the others.
    fn worst(&self) -> Option<(usize, Fit)> {
        let total = self.total()?;
        let without =
            |at: usize| Some((at, total.without(&self.parts[at].1).solve_signed(&self.columns, &self.signs)?));
        (0..self.parts.len()).filter_map(without).min_by(|a, b| a.1.rss.total_cmp(&b.1.rss))
    }

    fn total(&self) -> Option<Normal> {
        Normal::sum(self.parts.iter().map(|(_, part)| part.clone()))
    }

    /// The probability that noise alone takes this row so far from a fit to the others; `None`
    /// where it does not stand out from what structure may leave.
    fn judge(&self, row: usize, without: &Fit) -> Option<f64> {
        let left = self.problem.white_residuals(&self.columns, &without.coefficients);
        let axes = self.problem.axes;
        let of = |row: usize| Vector3::from_fn(|axis, _| left[row * axes + axis]);
        let rest: Vec<Vector3<f64>> = self.parts.iter().map(|&(row, _)| of(row).map(|left| left * left)).collect();
        let free = |k: &usize| self.signs[*k] == Sign::Free || without.coefficients[*k] != 0.0;
        let free: Vec<usize> = self.columns.iter().copied().filter(free).collect();
        // The share of their freedom that the fit leaves its readings.
        let total = self.total()?;
        let tells = total.rows.checked_sub(free.len()).filter(|freedom| *freedom > 0)? as f64 / total.rows as f64;
        let shown = DMatrix::from_fn(3, free.len(), |axis, k| self.problem.white[(row * axes + axis, free[k])]);
        let of_fit = &shown * total.inverse(&free)? * shown.transpose();
        let squares = studentised(of(row), &of_fit);
        let mut variance = Vector3::from_fn(|axis, _| rest.iter().map(|squares| squares[axis]).sum::<f64>())
            / (tells * rest.len() as f64);
        let mut freedom = tells * rest.len() as f64;
        let median = Vector3::from_fn(|axis, _| by_median(rest.iter().map(|squares| squares[axis]))) / tells;
        let all = || rest.iter().flat_map(|squares| squares.component_div(&variance).data.0[0]).collect::<Vec<f64>>();
        if !self.strict {
            // Structure is what most rows have.
            (variance, freedom) = (median * self.further_out(row, &left, &median), OF_MEDIAN * freedom);
        } else if let Some(tails) = freedom_of_tails(&all(), tells) {
            (variance, freedom) = (median * scale_of_tails(tails), freedom.min(tails));
        }
        let over = squares.component_div(&variance);
        // Of few rows no one can say how heavy the tails are that noise has.
        let stands_out = match self.strict {
            true => squares.component_div(&median).sum() > STANDS_OUT,
            false => over.sum() > STANDS_OUT_AS_IT_IS,
        };
        let statistic = over.map(|square| as_normal(square, freedom)).sum();
        // Readings without noise have only rounding to stand out from.
        let is_any = of(row).norm() > NOISELESS && statistic.is_finite();
        chi_square_tail(statistic, 3.0).filter(|_| stands_out && is_any)
    }

    /// How many times a variance those rows have, at least 1, where the arm gives way as far as
    /// at this one by the third of them that it is in: noise does not know of that, and
    /// structure does.
    fn further_out(&self, row: usize, left: &DVector<f64>, variance: &Vector3<f64>) -> f64 {
        let of = |stacked: &DVector<f64>, row: usize| stacked.fixed_rows::<3>(row * self.problem.axes).into_owned();
        let moved = |row: usize| (of(&self.problem.white_readings, row) - of(left, row)).norm();
        let mut all: Vec<(f64, usize)> = self.parts.iter().map(|&(row, _)| (moved(row), row)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let third = |at: usize| 3 * at / all.len();
        let own = third(all.partition_point(|(other, _)| *other < moved(row)).min(all.len() - 1));
        let alike = all.iter().enumerate().filter(|(at, _)| third(*at) == own);
        let squares =
            alike.flat_map(|(_, &(_, row))| of(left, row).map(|left| left * left).component_div(variance).data.0[0]);
        by_median(squares).max(1.0)
    }
}

/// The squares of a row's residuals against a fit without it, over what the uncertainty `of_fit`
/// of that adds to the variance of a reading, which is 1; each independent of the others.
fn studentised(left: Vector3<f64>, of_fit: &DMatrix<f64>) -> Vector3<f64> {
    let covariance = Matrix3::identity() + Matrix3::from_fn(|i, j| of_fit[(i, j)]);
    let parts = SymmetricEigen::new(covariance);
    let root = parts.eigenvalues.map(|eigenvalue| eigenvalue.max(1.0).sqrt().recip());
    let whole = parts.eigenvectors * Matrix3::from_diagonal(&root) * parts.eigenvectors.transpose() * left;
    whole.map(|left| left * left)
}
