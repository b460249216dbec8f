//! Is there structure left in the residuals?
//!
//! These tests, each of what noise alone cannot do, together at the level
//! asked for (Bonferroni):
//!
//! 1. *Size*: where the noise is declared, or readings were repeated, the
//!    residual sum of squares against it (chi-square or F).
//! 2. *Resemblance*: residuals of rows that are alike in pose and load, or in
//!    time, temperature or order, resemble each other across poses. For each
//!    column of the table a sum over pairs of rows of *different* poses,
//!    `sum K(x_i, x_j) r_i . r_j`, and one for all joint angles together; the
//!    largest of these, each less its mean and over its standard deviation
//!    under the null, against the wild cluster bootstrap (signs of whole poses;
//!    the model fitted again in every draw).
//! 3. *Growth*: the length of the residual grows with the force (Spearman's
//!    rank correlation); the noise of a reading does not know the load.
//! 4. *Agreement*: readings of a pose agree more than noise does
//!    ([`agreement`](mod@super::agreement)). A coarse gauge rounds small readings less than
//!    large ones, and those that are alike alike: then neither is asked.
//! 5. *Encoders*: where joints are read behind their gears, what is left of those readings
//!    against their own noise.
//!
//! Where poses are held out, these are asked last of all, when nothing is chosen any
//! more ([`held_out`](mod@super::held_out)).

use std::borrow::ToOwned;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use statrs::distribution::{ContinuousCDF, Normal as Gaussian};

use super::agreement::{Agreement, agreement};
use super::bootstrap::rademacher;
use super::features::features;
use super::model::{Fitted, Setting};
use super::sizes::{Shares, of_encoders, size};
use super::yardstick::Yardstick;
use crate::campaign::Displacements;
use crate::identify::covariance::Covariance;
use crate::identify::normal::{Fit, transposed_times};
use crate::identify::problem::Problem;
use crate::probability::told;

/// The most tests for structure that share a level, those of held-out poses among them.
const TESTS: f64 = 6.0;

/// The fewest draws that resolve the level of one of the tests for structure, which
/// share one.
pub(super) fn resolving(options: &super::Options) -> usize {
    (TESTS / options.alpha).ceil() as usize
}

/// As many draws as were asked for, or [as the level needs](resolving).
pub(super) fn draws(options: &super::Options) -> usize {
    options.draws.max(resolving(options))
}

/// The name of the test of agreement.
pub(super) const AGREE: &str = "readings of a pose agree";

/// What the tests say; by default, of what leaves nothing, there are none.
#[derive(Clone, Debug, Default)]
pub struct LackOfFit {
    /// Every test that could be done.
    pub tests: Vec<StructureTest>,
    /// Whether one of them finds structure at the level asked for.
    pub structure: bool,
    /// The share of the residual variance that is beyond the noise.
    pub fraction: f64,
    /// The columns the residual depends on, the strongest first.
    pub depends_on: Vec<String>,
}

/// One test for structure.
#[derive(Clone, Debug, PartialEq)]
pub struct StructureTest {
    /// What was tested.
    pub name: String,
    /// Its statistic.
    pub statistic: f64,
    /// The probability of so much under noise alone.
    pub p_value: f64,
}

/// Rows beyond about this many are thinned: the effort of pairwise sums is quadratic.
const MOST_ROWS: usize = 1200;

/// The rows fitted to that what is left is looked at in: all, or some of them.
pub(super) fn rows_looked_at(problem: &Problem) -> Vec<usize> {
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

/// Tests the residuals of a model.
pub fn test(
    setting: &Setting<'_>,
    model: &Fitted,
    data: &Displacements,
    yardstick: Yardstick,
    covariance: &Covariance,
    options: &super::Options,
) -> LackOfFit {
    let mut tests = Vec::new();
    let shares = Shares::of(setting, model);
    tests.extend(shares.as_ref().and_then(|shares| size(setting, model, shares, covariance, yardstick)));
    tests.extend(shares.as_ref().and_then(|shares| of_encoders(shares, covariance)));
    tests.extend(growth(setting, model));
    let agreement = agreement(setting, model, options).filter(|_| !is_coarse(setting, model));
    if let Some(Agreement { statistic, p_value, .. }) = agreement {
        tests.push(StructureTest { name: AGREE.to_owned(), statistic, p_value });
    }
    let resemblance = Resemblance::new(setting, model, data, options);
    if let Some(resemblance) = &resemblance {
        let (statistic, p_value) = resemblance.largest();
        tests.push(StructureTest { name: "residuals resemble each other".to_owned(), statistic, p_value });
    }
    // Poses held out are asked at the end.
    let held_out = usize::from(!setting.problem.held_out.is_empty());
    let level = options.alpha / (tests.len() + held_out).max(1) as f64;
    let structure = tests.iter().any(|test| test.p_value <= level);
    let fraction =
        if structure { fraction(setting, model, yardstick, resemblance.as_ref(), options.alpha) } else { 0.0 };
    let beyond_noise = agreement
        .filter(|found| found.p_value <= level)
        .map_or(0.0, |found| 1.0 - found.noise / setting.problem.variance(&model.fit));
    let fraction = fraction.max(beyond_noise);
    let depends_on = resemblance.filter(|_| structure).map_or_else(Vec::new, |found| found.significant(options.alpha));
    LackOfFit { tests, structure, fraction, depends_on }
}

/// Whether what a model leaves is little against the steps in which readings are read.
fn is_coarse(setting: &Setting<'_>, model: &Fitted) -> bool {
    setting.point.data.is_coarse(setting.problem.variance(&model.fit))
}

/// Spearman's rank correlation of squared residuals, each over what the fit
/// leaves of a unit variance there, with the force.
fn growth(setting: &Setting<'_>, model: &Fitted) -> Option<StructureTest> {
    if is_coarse(setting, model) {
        return None;
    }
    let (problem, fit) = setting.alone(&model.fit);
    let residuals = problem.white_residuals(&fit.columns, &fit.coefficients);
    let inverse = problem.total.inverse(&fit.columns)?;
    let (mut lengths, mut forces) = (Vec::new(), Vec::new());
    for row in problem.blocks.iter().flat_map(|block| &block.rows) {
        let at = row * problem.axes;
        let left: f64 = (at..at + 3)
            .map(|i| {
                let x = problem.white.row(i).transpose();
                1.0 - x.dot(&(&inverse * &x))
            })
            .sum();
        lengths.push(residuals.rows(at, 3).norm_squared() / left.max(f64::EPSILON));
        forces.push(setting.point.samples.rows[*row].wrench.fixed_rows::<3>(0).norm());
    }
    let statistic = correlation(&ranks(&lengths), &ranks(&forces));
    let p_value = told(Gaussian::standard().sf(statistic * ((lengths.len() - 1) as f64).sqrt()));
    Some(StructureTest { name: "residuals grow with the force".to_owned(), statistic, p_value })
        .filter(|_| statistic.is_finite())
}

/// The share of the residual variance that grows with the square of the force,
/// by a straight line, where residuals grow with the force significantly.
fn growing(setting: &Setting<'_>, model: &Fitted, alpha: f64) -> f64 {
    if growth(setting, model).is_none_or(|test| test.p_value > alpha) {
        return 0.0;
    }
    let (problem, fit) = setting.alone(&model.fit);
    let residuals = problem.white_residuals(&fit.columns, &fit.coefficients);
    let rows = problem.blocks.iter().flat_map(|block| &block.rows);
    let (forces, squares): (Vec<f64>, Vec<f64>) = rows
        .map(|row| {
            let force = setting.point.samples.rows[*row].wrench.fixed_rows::<3>(0).norm_squared();
            (force, residuals.rows(row * problem.axes, 3).norm_squared())
        })
        .unzip();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (force, square) = (mean(&forces), mean(&squares));
    let product: f64 = forces.iter().zip(&squares).map(|(f, s)| (f - force) * (s - square)).sum();
    let slope = product / forces.iter().map(|f| (f - force) * (f - force)).sum::<f64>();
    (slope * force / square).clamp(0.0, 1.0)
}

/// Ranks, those of equal values averaged.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = std::vec![0.0; values.len()];
    let mut below = 0;
    for equal in order.chunk_by(|&a, &b| values[a] == values[b]) {
        for &i in equal {
            ranks[i] = below as f64 + (equal.len() - 1) as f64 / 2.0;
        }
        below += equal.len();
    }
    ranks
}

/// The correlation of numbers with others; not finite where either are all alike.
pub fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let (ma, mb) = (mean(a), mean(b));
    let product =
        |x: &[f64], mx: f64, y: &[f64], my: f64| -> f64 { x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum() };
    product(a, ma, b, mb) / (product(a, ma, a, ma) * product(b, mb, b, mb)).sqrt()
}

/// The share of the residual variance beyond the noise: against the noise
/// where it is known, or the largest variance component that goes with a
/// resemblance, by the method of moments (`E r_i . r_j = v K_ij` between
/// poses); whichever is more, since what is no function of the load, such as
/// hysteresis, makes repeated readings differ and so counts as noise there.
fn fraction(
    setting: &Setting<'_>,
    model: &Fitted,
    yardstick: Yardstick,
    found: Option<&Resemblance>,
    alpha: f64,
) -> f64 {
    let variance = setting.problem.variance(&model.fit);
    let noise = match yardstick {
        Yardstick::Declared(noise) => Some(noise),
        Yardstick::Repeated(pure) => pure.variance(),
        Yardstick::Unknown => None,
    };
    let component = found.map_or(0.0, |found| found.component(alpha));
    let resembling = (component / variance).max(growing(setting, model, alpha));
    noise.map_or(resembling, |noise| 1.0 - noise / variance).max(resembling).clamp(0.0, 1.0)
}

/// The pairwise sums, observed and under the null.
struct Resemblance {
    names: Vec<String>,
    /// Of each sum, standardised.
    observed: Vec<f64>,
    /// The same of each draw, a vector a sum.
    under_null: Vec<DVector<f64>>,
    /// The variance that goes with each kernel (m^2).
    components: Vec<f64>,
}

impl Resemblance {
    fn new(setting: &Setting<'_>, model: &Fitted, data: &Displacements, options: &super::Options) -> Option<Self> {
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
    fn largest(&self) -> (f64, f64) {
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
    fn component(&self, alpha: f64) -> f64 {
        let significant = (0..self.observed.len()).filter(|&i| self.is_significant(i, alpha));
        significant.map(|i| self.components[i]).fold(0.0, f64::max)
    }

    /// The columns whose sums are significant, the largest first.
    fn significant(&self, alpha: f64) -> Vec<String> {
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
