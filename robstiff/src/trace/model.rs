//! A model: the description's own numbers and effects named from the
//! catalogue, fitted together and held against physics.

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::DVector;

use super::candidate::{Candidate, Variant};
use crate::elements::Parameter;
use crate::identify::normal::{Fit, Sign};
use crate::identify::problem::{Problem, rms};
use crate::identify::samples::{Column, Samples};

/// A problem with the catalogue behind it; the first columns are the
/// description's own numbers.
pub struct Setting {
    /// The rows on the robot.
    pub samples: Samples,
    /// The regression.
    pub problem: Problem,
    /// What may be missing.
    pub candidates: Vec<Candidate>,
    /// The sign of each column.
    pub signs: Vec<Sign>,
    /// The columns of the description's numbers that the data can see.
    pub base: Vec<usize>,
    /// How many numbers the description has.
    pub own: usize,
    /// The compliances of all joints, held ones included, from the fit of the
    /// description's own numbers.
    pub joint_values: Vec<f64>,
}

/// A candidate with one of its variants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Named {
    /// Index of the candidate.
    pub candidate: usize,
    /// Index of its variant.
    pub variant: usize,
}

/// A model with its fit.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The effects named.
    pub named: Vec<Named>,
    /// The fit of the description's numbers and then the effects'.
    pub fit: Fit,
    /// The Bayesian information criterion.
    pub bic: f64,
}

/// A joint's compliance below zero by this many standard deviations is no
/// accident of the noise.
const BELOW_ZERO: f64 = 2.0;

impl Setting {
    /// A named candidate's variant.
    pub fn variant(&self, named: Named) -> &Variant {
        &self.candidates[named.candidate].variants[named.variant]
    }

    /// The columns of a model.
    pub fn columns(&self, named: &[Named]) -> Vec<usize> {
        let effects = named.iter().flat_map(|&one| self.variant(one).columns.iter());
        self.base.iter().chain(effects).copied().collect()
    }

    /// Fits a model by least squares with nonnegative compliances.
    ///
    /// # Errors
    /// Why the model is no physical one: collinear columns, a named number
    /// that comes out at zero, a joint's compliance that is driven below zero,
    /// a coupling or a softening beyond what leaves `H_q` positive definite.
    pub fn fit(&self, named: &[Named]) -> Result<Fitted, String> {
        let columns = self.columns(named);
        let signs: Vec<Sign> = columns.iter().map(|&column| self.signs[column]).collect();
        let total = &self.problem.total;
        let collinear = || String::from("not to be told from the rest of the model");
        let fit = total.solve_signed(&columns, &signs).ok_or_else(collinear)?;
        self.check(&fit, named)?;
        let parameters = self.base.len() + named.iter().map(|&one| self.variant(one).parameters).sum::<usize>();
        let rows = total.rows as f64;
        let bic = rows * (fit.rss / rows).ln() + parameters as f64 * rows.ln();
        Ok(Fitted { named: named.to_vec(), fit, bic })
    }

    fn check(&self, fit: &Fit, named: &[Named]) -> Result<(), String> {
        let effects = self.base.len()..fit.columns.len();
        for k in effects {
            let (column, number) = (self.problem.columns[fit.columns[k]], fit.coefficients[k]);
            match column {
                Column::Linear(Parameter::Coupling([i, j])) => {
                    let bound = (self.joint_value(fit, i) * self.joint_value(fit, j)).sqrt();
                    if number.abs() >= bound {
                        return Err(format!("the coupling would be {number:.2e}, beyond {bound:.2e} rad/Nm"));
                    }
                }
                Column::Knee { joint, .. } => {
                    if number <= -self.joint_value(fit, joint) {
                        return Err(format!("the unloaded joint {joint} would have a negative compliance"));
                    }
                }
                Column::Linear(_) if number <= 0.0 => return Err(String::from("its compliance would be negative")),
                Column::Linear(_) => {}
            }
        }
        if named.is_empty() {
            return Ok(());
        }
        // A clipped joint is only held against the model where noise does not
        // explain it.
        let clipped = (0..self.base.len())
            .filter(|&k| self.signs[fit.columns[k]] == Sign::Nonnegative && fit.coefficients[k] == 0.0);
        for k in clipped {
            let total = &self.problem.total;
            let (Some(free), Some(inverse)) = (total.solve(&fit.columns), total.inverse(&fit.columns)) else {
                continue;
            };
            let freedom = (total.rows - fit.columns.len()).max(1) as f64;
            let std = (inverse[(k, k)] * free.rss / freedom).sqrt();
            if free.coefficients[k] < -BELOW_ZERO * std {
                return Err(format!("joint {} would have a negative compliance", fit.columns[k] + 1));
            }
        }
        Ok(())
    }

    /// The compliance of a joint (from 1) in a fit; its own where it was held.
    fn joint_value(&self, fit: &Fit, joint: usize) -> f64 {
        let column = joint - 1;
        let fitted = fit.columns.iter().position(|&c| c == column);
        fitted.map_or(self.joint_values[column], |k| fit.coefficients[k])
    }

    /// The fit of the same columns without one of the blocks; the whole fit
    /// where that block alone sees a column.
    pub fn fit_without(&self, fit: &Fit, block: usize) -> DVector<f64> {
        let rest = self.problem.total.without(&self.problem.blocks[block].normal);
        let signs: Vec<Sign> = fit.columns.iter().map(|&column| self.signs[column]).collect();
        rest.solve_signed(&fit.columns, &signs).map_or_else(|| fit.coefficients.clone(), |fit| fit.coefficients)
    }

    /// The residuals on poses the fit has not seen, stacked: of the poses held
    /// out, or where none are, of each pose by the fit without it. With the
    /// campaign's rows they are of.
    pub fn unseen_residuals(&self, fit: &Fit) -> (DVector<f64>, Vec<usize>) {
        let problem = &self.problem;
        if problem.held_out.is_empty() {
            return self.left_out_residuals(fit);
        }
        let rows = problem.held_out.iter().flat_map(|block| block.rows.iter().copied()).collect();
        (problem.residuals(&fit.columns, &fit.coefficients), rows)
    }

    /// The root mean square of [`unseen_residuals`](Self::unseen_residuals) (m):
    /// for judging a model, never for choosing one.
    pub fn holdout_rms(&self, fit: &Fit) -> f64 {
        let (residuals, rows) = self.unseen_residuals(fit);
        rms(&residuals, self.problem.axes, rows)
    }

    /// The residuals of each pose fitted to, by the fit without it, stacked;
    /// with the campaign's rows they are of.
    fn left_out_residuals(&self, fit: &Fit) -> (DVector<f64>, Vec<usize>) {
        let problem = &self.problem;
        let mut residuals = problem.readings.clone();
        for (p, block) in problem.blocks.iter().enumerate() {
            let coefficients = self.fit_without(fit, p);
            for &i in &block.stacked {
                let fitted: f64 =
                    fit.columns.iter().zip(coefficients.iter()).map(|(&c, value)| problem.raw[(i, c)] * value).sum();
                residuals[i] -= fitted;
            }
        }
        let rows = problem.blocks.iter().flat_map(|block| block.rows.iter().copied()).collect();
        (residuals, rows)
    }

    /// The root mean square error on each pose fitted to, by the fit without it
    /// (m): for choosing a model. Poses held out have no part in it.
    pub fn left_out_rms(&self, fit: &Fit) -> f64 {
        let (residuals, rows) = self.left_out_residuals(fit);
        rms(&residuals, self.problem.axes, rows)
    }

    /// The squared whitened residuals of each block.
    pub fn deviances(&self, fit: &Fit) -> Vec<f64> {
        self.problem.blocks.iter().map(|block| block.normal.rss(&fit.columns, &fit.coefficients)).collect()
    }
}
