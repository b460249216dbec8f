//! A model: the description's own numbers and effects named from the
//! catalogue, fitted together and held against physics.

use std::cell::RefCell;
use std::format;
use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::catalogue::{Candidate, Number, Variant};
use super::point::Point;
use super::slip::{SLIPPED_AT, undecided};
use crate::identify::column::Column;
use crate::identify::covariance::Whitener;
use crate::identify::normal::{Fit, Sign};
use crate::identify::problem::{Block, Equations, Problem, rms};
use crate::probability::schwarz;

/// The regression of a campaign at one point, with the catalogue behind it; the
/// first columns are the description's own numbers. Nonlinear numbers that are
/// named have their tangents there for columns, and the readings are such that
/// the coefficients are the numbers themselves.
pub struct Setting<'c> {
    /// The rows at the point.
    pub point: Point<'c>,
    /// The regression.
    pub problem: Equations,
    /// Its columns, whitened; none where they are formed when asked for.
    pub columns: Stored,
    /// What whitens a column.
    pub whitener: Rc<Whitener>,
    /// What may be missing.
    pub candidates: Rc<[Candidate]>,
    /// The numbers of the candidates, one a column behind the own ones.
    pub numbers: Rc<[Number]>,
    /// The sign of each column.
    pub signs: Rc<[Sign]>,
    /// The columns of the description's numbers that the data can see.
    pub base: Vec<usize>,
    /// The columns of the description's numbers.
    pub own: Rc<[Column]>,
    /// The compliances of all joints as declared, which those have that are held.
    pub joint_values: Vec<f64>,
    /// What the readings may have besides that no column says, a model's effects
    /// being what they are, stacked: columns behind all others. No model is fitted
    /// with them, but what is to be named must account for more than they do.
    pub besides: Vec<DVector<f64>>,
    /// The tangents of nonlinear numbers that are named, by column.
    pub tangents: Vec<(usize, DVector<f64>)>,
    /// The second order of the joints' displacement, which the fit does not
    /// see (m).
    pub correction: DVector<f64>,
    /// Whether each pose is fitted to.
    pub training: &'c [bool],
}

/// The whitened columns of a regression, as long as there is memory for them.
pub type Stored = Rc<RefCell<Option<DMatrix<f64>>>>;

/// A candidate with one of its variants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Named {
    /// Index of the candidate.
    pub candidate: usize,
    /// Index of its variant.
    pub variant: usize,
}

/// The effects of a model without the one at place `k`.
pub fn all_but(named: &[Named], k: usize) -> Vec<Named> {
    let mut rest = named.to_vec();
    rest.remove(k);
    rest
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
    /// Whether physics allows it.
    pub physical: bool,
}

/// A joint's compliance below zero, or another number beyond what is possible, by
/// this many standard deviations is no accident of the noise.
const BELOW_ZERO: f64 = 2.0;

/// A joint that is held at zero may take this share of what an effect explains: so much a true
/// one loses to noise, or to being linear at numbers that are far off without it. A name for
/// something else takes its share from the joints, and loses most of it with them.
const LITTLE: f64 = 0.05;

/// Of what may be besides, that of which less is left says nothing new.
const OF_ITS_OWN: f64 = 1e-3;

impl Setting<'_> {
    /// What a unit of a column's number does to the readings as measured,
    /// stacked.
    pub fn raw(&self, column: usize) -> DVector<f64> {
        if let Some((_, tangent)) = self.tangents.iter().find(|(of, _)| *of == column) {
            return tangent.clone();
        }
        let Some(effect) = column.checked_sub(self.own.len()) else {
            return self.point.with_creep(self.point.samples.column(self.own[column]));
        };
        match self.numbers.get(effect) {
            Some(number) => number.column(&self.point),
            None => self.besides[effect - self.numbers.len()].clone(),
        }
    }

    /// A column, whitened.
    pub fn white(&self, column: usize) -> DVector<f64> {
        let stored = self.columns.borrow().as_ref().map(|all| all.column(column).into_owned());
        stored.unwrap_or_else(|| self.whitener.whitened(self.raw(column)))
    }

    /// The regression on some columns alone, in the order given.
    pub fn on(&self, columns: &[usize]) -> Problem {
        let white: Vec<DVector<f64>> = columns.iter().map(|&column| self.white(column)).collect();
        self.problem.with(columns, from_columns(&white, self.problem.readings.len()))
    }

    /// The regression on the columns of a fit alone, and the fit in these.
    pub fn alone(&self, fit: &Fit) -> (Problem, Fit) {
        (self.on(&fit.columns), in_place(fit))
    }

    /// What a fit leaves of the readings as measured, stacked; (m, rad).
    pub fn residuals(&self, fit: &Fit) -> DVector<f64> {
        let mut left = (*self.problem.readings).clone();
        for (&column, &coefficient) in fit.columns.iter().zip(fit.coefficients.iter()) {
            left.axpy(-coefficient, &self.raw(column), 1.0);
        }
        left
    }

    /// A named candidate's variant.
    pub fn variant(&self, named: Named) -> &Variant {
        &self.candidates[named.candidate].variants[named.variant]
    }

    /// The columns of a model.
    pub fn columns(&self, named: &[Named]) -> Vec<usize> {
        let effects = named.iter().flat_map(|&one| self.variant(one).columns.iter());
        self.base.iter().chain(effects).copied().collect()
    }

    /// Columns with those of what may be [`besides`](Self::besides) that they do not
    /// say themselves.
    pub fn with_besides(&self, mut columns: Vec<usize>) -> Vec<usize> {
        let total = &self.problem.total;
        let first = self.own.len() + self.numbers.len();
        for more in first..first + self.besides.len() {
            let Some(inverse) = total.inverse(&columns) else { break };
            let along = DVector::from_fn(columns.len(), |k, _| total.gram[(columns[k], more)]);
            let own = total.gram[(more, more)];
            if own - along.dot(&(&inverse * &along)) > OF_ITS_OWN * own {
                columns.push(more);
            }
        }
        columns
    }

    /// Fits a model by least squares with nonnegative compliances.
    ///
    /// # Errors
    /// Why the model is no physical one: collinear columns, a named number
    /// that comes out at zero, a joint's compliance that is driven below zero,
    /// couplings, each or together, or a softening beyond what leaves `H_q` positive definite.
    pub fn fit(&self, named: &[Named]) -> Result<Fitted, String> {
        let columns = self.columns(named);
        let signs: Vec<Sign> = columns.iter().map(|&column| self.signs[column]).collect();
        let total = &self.problem.total;
        let collinear = || String::from("not to be told from the rest of the model");
        let fit = total.solve_signed(&columns, &signs).ok_or_else(collinear)?;
        self.judge(named, fit)
    }

    /// A model with its fit, held against physics.
    ///
    /// # Errors
    /// As for [`fit`](Self::fit).
    pub fn judge(&self, named: &[Named], fit: Fit) -> Result<Fitted, String> {
        self.check(&fit, named)?;
        let bic = self.bic(named, &fit, 0);
        Ok(Fitted { named: named.to_vec(), fit, bic, physical: true })
    }

    /// Fits a model that physics may not allow: what is missing besides can
    /// drive the numbers of a true effect beyond what is possible.
    pub fn fit_loosely(&self, named: &[Named]) -> Option<Fitted> {
        let columns = self.columns(named);
        let signs: Vec<Sign> = columns.iter().map(|&column| self.signs[column]).collect();
        let fit = self.problem.total.solve_signed(&columns, &signs)?;
        let (bic, physical) = (self.bic(named, &fit, 0), self.check(&fit, named).is_ok());
        Some(Fitted { named: named.to_vec(), fit, bic, physical })
    }

    /// The Bayesian information criterion of a model with its fit, and so many numbers
    /// more.
    pub fn bic(&self, named: &[Named], fit: &Fit, more: usize) -> f64 {
        let of_effects = named.iter().map(|&one| self.variant(one).parameters).sum::<usize>();
        let parameters = self.base_of(fit) + of_effects + more;
        schwarz(fit.rss, self.problem.total.rows as f64, parameters as f64)
    }

    /// A fit as near to what is possible as noise lets it be, which can take numbers beyond:
    /// joints softer, and all other numbers nearer to zero.
    pub(super) fn nearer(&self, fit: &Fit) -> Option<Fit> {
        let inverse = self.problem.total.inverse(&fit.columns)?;
        let freedom = self.problem.freedom(fit);
        let mut nearer = fit.clone();
        for (k, value) in nearer.coefficients.iter_mut().enumerate() {
            let width = BELOW_ZERO * (inverse[(k, k)] * fit.rss / freedom).sqrt();
            *value = match fit.columns[k] < self.joint_values.len() {
                true => *value + width,
                false => *value - value.clamp(-width, width),
            };
        }
        Some(nearer)
    }

    /// How many of the description's own numbers a fit has; one with nonlinear
    /// numbers may see more of them than this point does.
    fn base_of(&self, fit: &Fit) -> usize {
        fit.columns.iter().filter(|&&column| column < self.own.len()).count()
    }

    /// Holds the numbers of one effect of a fit against physics.
    ///
    /// # Errors
    /// What it would be that physics does not allow.
    pub fn check_effect(&self, fit: &Fit, one: Named) -> Result<(), String> {
        let joint = |joint: usize| self.joint_value(fit, joint);
        let candidate = &self.candidates[one.candidate];
        let (mut numbers, mut places) = (Vec::new(), Vec::new());
        for &column in &self.variant(one).columns {
            let at = fit.columns.iter().position(|&of| of == column).expect("its own model has it");
            let (number, value) = (&self.numbers[column - self.own.len()], fit.coefficients[at]);
            let [least, most] = number.range;
            if !(least < value && value < most) {
                return Err(format!("its {} would be {value:.2e} {}", number.name, number.unit));
            }
            let whole = number.share_of.filter(|_| !candidate.is_nameless());
            if let Some(rigid) = whole.filter(|&of| joint(of) <= 0.0) {
                return Err(format!("joint {rigid} would have no compliance that it is a share of"));
            }
            numbers.push((number.name, value));
            places.push(at);
        }
        let Some(check) = &candidate.check else { return Ok(()) };
        let Err(why) = check(&numbers, &joint) else { return Ok(()) };
        let nearer = self.nearer(fit).ok_or(why)?;
        let of_nearer = places.iter().zip(&mut numbers);
        of_nearer.for_each(|(&at, (_, value))| *value = nearer.coefficients[at]);
        check(&numbers, &|joint| self.joint_value(&nearer, joint))
    }

    fn check(&self, fit: &Fit, named: &[Named]) -> Result<(), String> {
        for &one in named {
            self.check_effect(fit, one)?;
        }
        self.check_couplings(fit, named)?;
        if named.is_empty() {
            return Ok(());
        }
        // A clipped joint is only held against the model where noise does not
        // explain it, and where that takes much of what an effect explains.
        let clipped = (0..self.base_of(fit))
            .filter(|&k| self.signs[fit.columns[k]] == Sign::Nonnegative && fit.coefficients[k] == 0.0);
        for k in clipped {
            let total = &self.problem.total;
            let (Some(free), Some(inverse)) = (total.solve(&fit.columns), total.inverse(&fit.columns)) else {
                continue;
            };
            let std = (inverse[(k, k)] * free.rss / self.problem.freedom(&free)).sqrt();
            let taken = fit.rss - free.rss;
            if free.coefficients[k] < -BELOW_ZERO * std && taken > LITTLE * self.least_explained(fit, named) {
                return Err(self.below_zero(fit.columns[k]));
            }
        }
        Ok(())
    }

    /// By how much the sum of squares grows without one of the effects, the one without which
    /// it grows least.
    fn least_explained(&self, fit: &Fit, named: &[Named]) -> f64 {
        let without = |&one: &Named| {
            let own = &self.variant(one).columns;
            let rest: Vec<usize> = fit.columns.iter().copied().filter(|column| !own.contains(column)).collect();
            let signs: Vec<Sign> = rest.iter().map(|&column| self.signs[column]).collect();
            self.problem.total.solve_signed(&rest, &signs).map_or(0.0, |rest| rest.rss - fit.rss)
        };
        named.iter().map(without).fold(f64::INFINITY, f64::min)
    }

    /// The compliance of a joint (from 1) in a fit; its own where it was held.
    pub fn joint_value(&self, fit: &Fit, joint: usize) -> f64 {
        let column = joint - 1;
        let fitted = fit.columns.iter().position(|&c| c == column);
        fitted.map_or(self.joint_values[column], |k| fit.coefficients[k])
    }

    /// The rows held out of which the fit does not say on which side of a slip they are that
    /// a model names.
    pub fn undecided(&self, named: &[Named]) -> Vec<usize> {
        let slips = named.iter().filter(|one| self.candidates[one.candidate].slipping().is_some());
        let lines = slips.flat_map(|one| &self.variant(*one).shape).filter(|number| number.name == SLIPPED_AT);
        let rows = &self.point.data.rows;
        let moments = lines.filter_map(|line| rows.iter().position(|row| row.line as f64 == line.value));
        let among = |blocks: &[Block]| Block::among(blocks, rows.len());
        undecided(moments, &among(&self.problem.blocks), &among(&self.problem.held_out))
    }

    /// The campaign's rows of poses that are fitted to, or of those that are held out, with those
    /// that are left out.
    fn rows(&self, fitted_to: bool) -> impl Iterator<Item = usize> {
        let rows = self.point.samples.rows.iter().enumerate();
        rows.filter(move |(_, row)| self.training[row.pose] == fitted_to).map(|(i, _)| i)
    }

    /// The root mean square of what a fit leaves of the poses fitted to (m), in rows that it leaves
    /// out, too.
    pub fn fitted_rms(&self, fit: &Fit) -> f64 {
        rms(&self.residuals(fit), self.problem.axes, self.rows(true))
    }

    /// The root mean square on poses that the fit has not seen (m): of the poses held
    /// out but for some rows, or where none are, of each pose by the fit without it, in rows that
    /// are left out, too. For judging a model, never for choosing one.
    pub fn holdout_rms(&self, fit: &Fit, but: &[usize]) -> f64 {
        let axes = self.problem.axes;
        match self.training.contains(&false) {
            false => rms(&self.left_out(fit).residuals, axes, self.rows(true)),
            true => rms(&self.residuals(fit), axes, self.rows(false).filter(|row| !but.contains(row))),
        }
    }

    /// What each pose fitted to leaves of the fit without it: for choosing a model. Poses held out
    /// have no part in it.
    pub fn left_out(&self, fit: &Fit) -> LeftOut {
        let signs: Vec<Sign> = fit.columns.iter().map(|&column| self.signs[column]).collect();
        let raw: Vec<DVector<f64>> = fit.columns.iter().map(|&column| self.raw(column)).collect();
        let problem = match self.columns.borrow().as_ref() {
            Some(white) => self.problem.with(&fit.columns, white.select_columns(&fit.columns)),
            None => {
                let mut white = from_columns(&raw, self.problem.readings.len());
                self.whitener.whiten(&mut white);
                self.problem.with(&fit.columns, white)
            }
        };
        let columns = in_place(fit).columns;
        let (mut residuals, mut deviance) = ((*problem.readings).clone(), 0.0);
        for (column, &value) in raw.iter().zip(fit.coefficients.iter()) {
            residuals.axpy(-value, column, 1.0);
        }
        // Rows that are left out are predicted with the others of their pose.
        let samples = &self.point.samples;
        let in_the_fit = Block::among(&problem.blocks, samples.rows.len());
        let left_out: Vec<usize> = self.rows(true).filter(|&row| !in_the_fit[row]).collect();
        for block in problem.blocks.iter() {
            // The whole fit where that block alone sees a column.
            let without = problem.solve_without(block, &columns, Some(&signs));
            let coefficients = without.as_ref().unwrap_or(&fit.coefficients);
            deviance += problem.block_residuals(block, &columns, coefficients).norm_squared();
            let of_pose = left_out.iter().filter(|&&row| samples.rows[row].pose == block.pose);
            let of_pose = of_pose.flat_map(|row| row * problem.axes..(row + 1) * problem.axes);
            for i in block.stacked.iter().copied().chain(of_pose) {
                let fitted: f64 = raw.iter().zip(coefficients.iter()).map(|(column, value)| column[i] * value).sum();
                residuals[i] = problem.readings[i] - fitted;
            }
        }
        let rms = rms(&residuals, problem.axes, problem.blocks.iter().flat_map(|block| block.rows.iter().copied()));
        LeftOut { residuals, rms, deviance }
    }

    /// The squared whitened residuals of each block.
    pub fn deviances(&self, fit: &Fit) -> Vec<f64> {
        let (problem, fit) = self.alone(fit);
        let of = |block| problem.block_residuals(block, &fit.columns, &fit.coefficients).norm_squared();
        problem.blocks.iter().map(of).collect()
    }
}

/// What poses leave of fits without them.
pub struct LeftOut {
    /// Of the readings as measured, stacked (m, rad); of poses with no row in the fit by all others.
    pub residuals: DVector<f64>,
    /// The root mean square of the displacements in the fit (m), as people are told it.
    pub rms: f64,
    /// The sum of the squares of what is left, whitened: of all that is read, each by its noise. By
    /// this models are compared, for by it they are fitted.
    pub deviance: f64,
}

/// A fit in the regression on its columns alone.
fn in_place(fit: &Fit) -> Fit {
    Fit { columns: (0..fit.columns.len()).collect(), ..fit.clone() }
}

/// Columns side by side; so many rows where there is none.
fn from_columns(columns: &[DVector<f64>], rows: usize) -> DMatrix<f64> {
    if columns.is_empty() { DMatrix::zeros(rows, 0) } else { DMatrix::from_columns(columns) }
}
