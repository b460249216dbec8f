//! Is there structure left in the residuals?
//!
//! These tests, each of what noise alone cannot do, together at the level
//! asked for (Bonferroni):
//!
//! 1. *Size*: where the noise is declared, or readings were repeated, the
//!    residual sum of squares against it (chi-square or F).
//! 2. *Resemblance*: residuals of rows that are alike in pose and load, or in
//!    time, temperature or order, resemble each other across poses
//!    ([`resemblance`](super::resemblance)).
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

use statrs::distribution::{ContinuousCDF, Normal as Gaussian};

use super::agreement::{Agreement, agreement};
use super::model::{Fitted, Setting};
use super::resemblance::Resemblance;
use super::sizes::{Shares, of_encoders, size};
use super::yardstick::Yardstick;
use crate::campaign::Displacements;
use crate::identify::covariance::Covariance;
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
