//! Whether residuals are larger than noise, where it is known how much that is.

use std::borrow::ToOwned;

use super::lack_of_fit::StructureTest;
use super::model::{Fitted, Setting};
use super::yardstick::Yardstick;
use crate::identify::covariance::Covariance;
use crate::probability::{chi_square_tail, fisher_tail, told};

/// Sums of squares with their degrees of freedom, of the readings of the tool and
/// of those of encoders.
pub(super) struct Shares {
    tool: (f64, f64),
    encoders: Option<(f64, f64)>,
}

impl Shares {
    pub(super) fn of(setting: &Setting<'_>, model: &Fitted) -> Option<Self> {
        let whole = (model.fit.rss, setting.problem.freedom(&model.fit));
        let samples = &setting.point.samples;
        if samples.encoders.is_empty() {
            return Some(Self { tool: whole, encoders: None });
        }
        let (problem, fit) = setting.alone(&model.fit);
        let residuals = problem.white_residuals(&fit.columns, &fit.coefficients);
        let inverse = problem.total.inverse(&fit.columns)?;
        let mut encoders = (0.0, 0.0);
        for row in problem.blocks.iter().flat_map(|block| &block.rows) {
            for i in samples.encoders_of(*row) {
                let x = problem.white.row(i).transpose();
                encoders.0 += residuals[i] * residuals[i];
                encoders.1 += 1.0 - x.dot(&(&inverse * &x));
            }
        }
        Some(Self { tool: (whole.0 - encoders.0, whole.1 - encoders.1), encoders: Some(encoders) })
    }
}

/// Encoders against what they leave where every pose has a free response to its
/// loads.
pub(super) fn of_encoders(shares: &Shares, covariance: &Covariance) -> Option<StructureTest> {
    let (rss, freedom) = shares.encoders?;
    let noise = covariance.encoders.as_ref()?;
    let (sum, pure) = noise.pure;
    let (rss, freedom) = (rss / covariance.reading()?.powi(2), freedom - noise.unknown_levels());
    let rest = freedom - pure;
    if rest < 1.0 {
        return None;
    }
    let statistic = (rss - sum).max(0.0) / rest / (sum / pure);
    let p_value = told(fisher_tail(statistic, [rest, pure])?);
    Some(StructureTest { name: "encoders against their own noise".to_owned(), statistic, p_value })
}

/// Readings of the tool against a variance that is declared. The axes count as much
/// as they were read, not as they weigh: a weight that few contrasts tell makes
/// residuals too large on the mean. Where their variances differ, their sum is that
/// of fewer degrees of freedom (Satterthwaite).
fn of_declared(
    setting: &Setting<'_>,
    model: &Fitted,
    shares: &Shares,
    covariance: &Covariance,
    variance: f64,
) -> Option<StructureTest> {
    let (problem, fit) = setting.alone(&model.fit);
    let residuals = problem.white_residuals(&fit.columns, &fit.coefficients);
    let (weights, axes) = (covariance.shares_of_axes(), problem.axes);
    let of_row = |row: &usize| (0..axes).map(|axis| weights[axis] * residuals[row * axes + axis].powi(2)).sum::<f64>();
    let sum: f64 = problem.blocks.iter().flat_map(|block| &block.rows).map(of_row).sum();
    // The mean of the weights is one.
    let unequal = weights.iter().map(|weight| weight * weight).sum::<f64>() / axes as f64;
    let statistic = sum / variance / unequal;
    let p_value = told(chi_square_tail(statistic, shares.tool.1 / unequal)?);
    Some(StructureTest { name: "residuals against the declared noise".to_owned(), statistic, p_value })
}

pub(super) fn size(
    setting: &Setting<'_>,
    model: &Fitted,
    shares: &Shares,
    covariance: &Covariance,
    yardstick: Yardstick,
) -> Option<StructureTest> {
    let (rss, freedom) = shares.tool;
    match yardstick {
        Yardstick::Declared(variance) => of_declared(setting, model, shares, covariance, variance),
        Yardstick::Repeated(pure) => {
            let variance = pure.variance()?;
            let rest = freedom - pure.freedom as f64;
            if rest < 1.0 {
                return None;
            }
            let statistic = (rss - pure.sum).max(0.0) / rest / variance;
            let freedoms = [rest, pure.freedom as f64].map(|freedom| freedom / pure.unequal);
            let p_value = told(fisher_tail(statistic, freedoms)?);
            Some(StructureTest { name: "residuals against repeated readings".to_owned(), statistic, p_value })
        }
        Yardstick::Unknown => None,
    }
}
