//! Whether residuals of rows that are alike resemble each other across poses.
//!
//! For each column of the table a sum over pairs of rows of *different* poses,
//! `sum K(x_i, x_j) r_i . r_j`, and one for all joint angles together; the largest of
//! these, each less its mean and over its standard deviation under the null, against the
//! wild cluster bootstrap (signs of whole poses; the model fitted again in every draw).

use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::Options;
use super::bootstrap::rademacher;
use super::features::features;
use super::lack_of_fit::draws;
use super::model::{Fitted, Setting};
use crate::campaign::Displacements;
use crate::identify::normal::{Fit, transposed_times};
use crate::identify::problem::Problem;

/// Rows beyond about this many are thinned: the effort of pairwise sums is quadratic.
const MOST_ROWS: usize = 1200;

/// The rows fitted to that what is left is looked at in: all, or some of them.
pub fn rows_looked_at(problem: &Problem) -> Vec<usize> {
    let trained: Vec<usize> = problem.blocks.iter().flat_map(|block| block.rows.iter().copied()).collect();
    thinned(trained.len()).map(|place| trained[place]).collect()
}

/// Places among so many that are looked at. Every other row can be the same step of every load
/// sequence; multiples of the golden ratio fall evenly on each step of any.
fn thinned(count: usize) -> impl Iterator<Item = usize> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let share = MOST_ROWS as f64 / count as f64;
    (0..count).filter(move |&place| (place as f64 * GOLDEN).fract() < share)
}

/// The pairwise sums, observed and under the null.
pub struct Resemblance {
    names: Vec<String>,
    /// Of each sum, standardised.
    observed: Vec<f64>,
    /// The same of each draw, a vector a sum.
    under_null: Vec<DVector<f64>>,
    /// The variance that goes with each kernel (m^2).
    components: Vec<f64>,
}

impl Resemblance {
    /// Of what a model leaves, for every column of the table; `None` where it cannot be fitted
    /// to its own columns.
    pub fn new(setting: &Setting<'_>, model: &Fitted, data: &Displacements, options: &Options) -> Option<Self> {
        let (problem, fit) = setting.alone(&model.fit);
        let columns = &fit.columns;
        let rows = rows_looked_at(&problem);
        let residuals = problem.white_residuals(columns, &problem.total.solve(columns)?.coefficients);
        let axis_rows = |axis: usize| rows.iter().map(|row| row * problem.axes + axis).collect::<Vec<_>>();
        let own = [0, 1, 2].map(|axis| residuals.select_rows(&axis_rows(axis)));
        let drawn = drawn_residuals(&problem, &fit, &rows)?;
        let mut rng = ChaCha8Rng::seed_from_u64(options.seed);
        let signs = rademacher(&mut rng, draws(options), problem.blocks.len());
        let draws = Draws::new(drawn, signs);

        let features = features(&setting.point.samples, data, &rows);
        let (mut observed, mut under_null) = (Vec::new(), Vec::new());
        let mut components = Vec::new();
        for feature in &features {
            let mut kernel = feature.kernel();
            let of_one_row = kernel.trace() / rows.len() as f64;
            keep_between_poses(&mut kernel, setting, &rows);
            let sum: f64 = own.iter().map(|own| own.dot(&(&kernel * own))).sum();
            components.push(of_one_row * sum / (3.0 * kernel.norm_squared()).max(f64::MIN_POSITIVE));
            let sums = draws.quadratic(&kernel);
            let (mean, spread) = (sums.mean(), sums.variance().sqrt().max(f64::MIN_POSITIVE));
            observed.push((sum - mean) / spread);
            under_null.push(sums.map(|sum| (sum - mean) / spread));
        }
        let names = features.into_iter().map(|feature| feature.name).collect();
        Some(Self { names, observed, under_null, components })
    }

    /// The largest sum and its family-wise p-value.
    pub fn largest(&self) -> (f64, f64) {
        let largest = self.observed.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let draws = self.under_null.first().map_or(0, DVector::len);
        let of_draw = |draw: usize| self.under_null.iter().map(|sums| sums[draw]).fold(f64::NEG_INFINITY, f64::max);
        let beyond = (0..draws).filter(|&draw| of_draw(draw) >= largest).count();
        (largest, (1 + beyond) as f64 / (1 + draws) as f64)
    }

    /// Whether a sum on its own is significant; to be asked only where
    /// structure was found by all tests together.
    fn is_significant(&self, i: usize, alpha: f64) -> bool {
        let sums = &self.under_null[i];
        let beyond = sums.iter().filter(|&&sum| sum >= self.observed[i]).count();
        (1 + beyond) as f64 <= alpha * (1 + sums.len()) as f64
    }

    /// The largest variance of a resemblance that is significant (m^2).
    pub fn component(&self, alpha: f64) -> f64 {
        let significant = (0..self.observed.len()).filter(|&i| self.is_significant(i, alpha));
        significant.map(|i| self.components[i]).fold(0.0, f64::max)
    }

    /// The columns whose sums are significant, the largest first.
    pub fn significant(&self, alpha: f64) -> Vec<String> {
        let mut order: Vec<usize> = (0..self.names.len()).collect();
        order.sort_by(|&a, &b| self.observed[b].total_cmp(&self.observed[a]));
        let kept = order.into_iter().filter(|&i| !self.names[i].is_empty() && self.is_significant(i, alpha));
        kept.map(|i| self.names[i].clone()).collect()
    }
}

/// The bootstrap draws of the residuals of some rows, by axis: a draw is the
/// sum over poses of what each adds, with random signs.
enum Draws {
    /// What each pose adds, a column a pose, and the signs, a row a draw.
    ByPose([DMatrix<f64>; 3], DMatrix<f64>),
    /// The sums, a column a draw: the less where poses outnumber the rows.
    Summed([DMatrix<f64>; 3]),
}

impl Draws {
    fn new(by_pose: [DMatrix<f64>; 3], signs: DMatrix<f64>) -> Self {
        let (rows, poses) = by_pose[0].shape();
        if poses <= rows {
            return Self::ByPose(by_pose, signs);
        }
        let signs = signs.transpose();
        Self::Summed(by_pose.map(|each| each * &signs))
    }

    /// `r^T K r` of each draw, summed over axes.
    fn quadratic(&self, kernel: &DMatrix<f64>) -> DVector<f64> {
        match self {
            Self::ByPose(by_pose, signs) => {
                let poses = signs.ncols();
                let add = |sum, each: &DMatrix<f64>| sum + transposed_times(each, &(kernel * each));
                let quadratic = by_pose.iter().fold(DMatrix::zeros(poses, poses), add);
                (signs * quadratic).component_mul(signs).column_sum()
            }
            Self::Summed(drawn) => {
                let of = |drawn: &DMatrix<f64>| (kernel * drawn).component_mul(drawn).row_sum_tr();
                drawn.iter().map(of).fold(DVector::zeros(drawn[0].ncols()), |sum, of| sum + of)
            }
        }
    }
}

/// By axis, of a model on its columns alone, one column a pose: its residual from
/// the fit without it, with the model fitted again when it alone is there, at some
/// rows.
fn drawn_residuals(problem: &Problem, fit: &Fit, rows: &[usize]) -> Option<[DMatrix<f64>; 3]> {
    let columns = &fit.columns;
    let inverse = problem.total.inverse(columns)?;
    let design = &problem.white;
    let at = [0, 1, 2].map(|axis| rows.iter().map(|row| row * problem.axes + axis).collect::<Vec<_>>());
    let design_at = at.each_ref().map(|at| design.select_rows(at));
    let mut place = std::vec![None; problem.white_readings.len()];
    for (axis, at) in at.iter().enumerate() {
        at.iter().enumerate().for_each(|(k, &i)| place[i] = Some((axis, k)));
    }
    let mut drawn = [0, 1, 2].map(|_| DMatrix::zeros(rows.len(), problem.blocks.len()));
    for (p, block) in problem.blocks.iter().enumerate() {
        let without = problem.solve_without(block, columns, None);
        let residual = problem.block_residuals(block, columns, without.as_ref().unwrap_or(&fit.coefficients));
        let own = design.select_rows(&block.stacked);
        let absorbed = &inverse * own.tr_mul(&residual);
        for (drawn, design) in drawn.iter_mut().zip(&design_at) {
            drawn.set_column(p, &(design * -&absorbed));
        }
        for (k, &i) in block.stacked.iter().enumerate() {
            if let Some((axis, row)) = place[i] {
                drawn[axis][(row, p)] += residual[k];
            }
        }
    }
    Some(drawn)
}

/// Makes a kernel zero within a pose, where residuals resemble each other by
/// their noise as well.
fn keep_between_poses(kernel: &mut DMatrix<f64>, setting: &Setting<'_>, rows: &[usize]) {
    let pose = |i: usize| setting.point.samples.rows[rows[i]].pose;
    for j in 0..rows.len() {
        for i in (0..rows.len()).filter(|&i| pose(i) == pose(j)) {
            kernel[(i, j)] = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All steps of a load sequence are looked at, and all of the campaign.
    #[test]
    fn rows_are_thinned_evenly() {
        assert_eq!(thinned(MOST_ROWS).count(), MOST_ROWS);
        for count in [1201, 1202, 2400, 7200, 40_000] {
            let places: Vec<usize> = thinned(count).collect();
            assert!(places.len().abs_diff(MOST_ROWS) < 10, "{} of {count}", places.len());
            for (parts, part) in [(2, 1), (5, 1), (10, 1), (10, count / 10 + 1)] {
                for k in 0..parts {
                    let own = places.iter().filter(|&place| place / part % parts == k).count();
                    let even = MOST_ROWS as f64 / parts as f64;
                    assert!((own as f64 - even).abs() < 0.1 * even, "{own} of {count} in part {k} of {parts}");
                }
            }
        }
    }
}
