//! Slips held against what goes there and back, of displacements.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Vector3};

use super::{AGAIN, Beside, WORDS, beside_a_course};
use crate::identify::normal::{Fit, Normal, Sign};
use crate::identify::problem::Problem;
use crate::trace::bench::Bench;
use crate::trace::catalogue::THERMAL_DRIFT;
use crate::trace::model::{Fitted, Named, Setting, all_but};
use crate::trace::selection::WITHIN_REACH;

/// Moments at which a second slip is looked for.
const MOMENTS: usize = 64;

/// What stays of a model with slips where what is read says them better by going there and back,
/// or by slipping once more, and what it looks like; `None` where they are said best as they are.
pub fn instead_of_slips(bench: &Bench<'_>, model: &Fitted) -> Option<(Fitted, &'static str)> {
    let drifts = |one: &Named| bench.candidates()[one.candidate].kind == &THERMAL_DRIFT;
    let is_slip = |one: &Named| bench.candidates()[one.candidate].slipping().is_some();
    model.named.iter().find(|one| is_slip(one))?;
    let slipped_again = |model: &Fitted| Asked::new(&*bench.at(&model.named).ok()?, model).slipped_again();
    let (mut model, mut best, whole) = (model.clone(), model.bic, model.named.len());
    loop {
        // Beside such a course a drift may be part of it.
        let first = model.named.len() == whole;
        let may_go = |one: &Named| is_slip(one) || (!first && drifts(one));
        let enough = if first { best } else { best + WITHIN_REACH };
        let without = |k: usize| {
            let rest = all_but(&model.named, k);
            let smaller = bench.fit_or_loosely(&rest).ok()?;
            Some((Asked::new(&*bench.at(&rest).ok()?, &smaller).beside_a_course()?, smaller))
        };
        let found = (0..model.named.len()).filter(|&k| may_go(&model.named[k])).filter_map(without);
        let Some((bic, smaller)) = found.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(bic, _)| *bic < enough) else {
            break;
        };
        if first && slipped_again(&model).is_some_and(|again| again < bic) {
            return Some((model, AGAIN));
        }
        (model, best) = (smaller, bic);
    }
    if model.named.len() < whole {
        return Some((model, WORDS));
    }
    slipped_again(&model).filter(|again| *again < best - WITHIN_REACH).map(|_| (model, AGAIN))
}

/// A model, and what it leaves of more columns.
struct Asked<'s, 'c> {
    setting: &'s Setting<'c>,
    /// The regression on its own columns, and its fit in these.
    problem: Problem,
    fit: Fit,
    signs: Vec<Sign>,
    bic: f64,
    /// The places that are fitted to.
    stacked: Vec<usize>,
}

impl<'s, 'c> Asked<'s, 'c> {
    fn new(setting: &'s Setting<'c>, model: &Fitted) -> Self {
        let (problem, fit) = setting.alone(&model.fit);
        let signs = model.fit.columns.iter().map(|&column| setting.signs[column]).collect();
        let stacked = problem.blocks.iter().flat_map(|block| block.stacked.iter().copied()).collect();
        Self { setting, problem, fit, signs, bic: model.bic, stacked }
    }

    fn rows(&self) -> usize {
        self.setting.point.samples.rows.len()
    }

    /// The columns of shifts of what is read, along the axes of the base frame, by so much at each
    /// row.
    fn shifts(&self, at: &dyn Fn(usize) -> f64) -> [DVector<f64>; 3] {
        [0, 1, 2].map(|k| self.setting.point.of_reading(|row| Vector3::ith(k, at(row))))
    }

    /// What the model leaves of columns as they are read.
    fn beside(&self, columns: &[DVector<f64>]) -> Option<Beside> {
        let own = self.problem.white.ncols();
        let mut white = self.problem.white.clone().resize_horizontally(own + columns.len(), 0.0);
        for (k, column) in columns.iter().enumerate() {
            white.set_column(own + k, &self.setting.whitener.whitened(column.clone()));
        }
        let total = Normal::of_rows(&white, &self.problem.white_readings, &self.stacked);
        Beside::of(&total, &self.fit, &self.signs, self.bic)
    }

    /// Schwarz's criterion with a course of what is read besides.
    fn beside_a_course(&self) -> Option<f64> {
        let rows = self.rows();
        let shifts = |course: &dyn Fn(f64) -> f64| self.shifts(&|row| course((row as f64 + 0.5) / rows as f64));
        beside_a_course(rows, &shifts, &|columns| self.beside(columns))
    }

    /// The same with a slip more.
    fn slipped_again(&self) -> Option<f64> {
        let moments = (1..self.rows()).step_by(self.rows().div_ceil(MOMENTS));
        let of_one = |moment: usize| {
            let beside = self.beside(&self.shifts(&|row| f64::from(u8::from(row >= moment))))?;
            // The moment, too.
            beside.with(&DMatrix::identity(3, 3), 1)
        };
        moments.filter_map(of_one).min_by(f64::total_cmp)
    }
}
