//! Numbers out of grids, knees, onsets and radii, taken to where they fit best.

use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;
use std::vec::Vec;

use nalgebra::DVector;

use super::Bench;
use crate::identify::normal::Fit;
use crate::trace::catalogue::{Number, Variant};
use crate::trace::model::{Named, Setting};

/// Times that numbers out of grids are looked at in turn, how far from the
/// grid's value (grids double) and how finely, in logarithms; the golden
/// section; and the step of differences.
const SWEEPS: usize = 2;
const REACH: f64 = 2.5;
const FINE: f64 = 0.02;
const GOLDEN: f64 = 0.618_033_988_749_894_9;
const LOG_STEP: f64 = 0.02;

impl Bench<'_> {
    /// The same with numbers out of grids taken to where they fit best, and
    /// what they are then; as it is where a model has none.
    pub fn polished(&self, named: &[Named]) -> Self {
        let mut bench = self.copy();
        let rss = |bench: &Self| bench.state(named).map_or(f64::INFINITY, |state| state.fit.rss);
        for _ in 0..SWEEPS {
            for &one in named {
                for k in 0..self.variant(one).shape.len() {
                    if self.variant(one).refine.is_none() {
                        continue;
                    }
                    let at = bench.variant(one).shape[k].value;
                    let with = |value: f64| bench.with_shape(one, k, value);
                    let [least, most] = self.variant(one).within;
                    let (mut low, mut high) = ((at / REACH).max(least).ln(), (at * REACH).min(most).ln());
                    let inner = |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
                    let [mut left, mut right] = inner(low, high);
                    let (mut of_left, mut of_right) = (rss(&with(left.exp())), rss(&with(right.exp())));
                    while high - low > FINE {
                        if of_left < of_right {
                            (high, right, of_right) = (right, left, of_left);
                            left = inner(low, high)[0];
                            of_left = rss(&with(left.exp()));
                        } else {
                            (low, left, of_left) = (left, right, of_right);
                            right = inner(low, high)[1];
                            of_right = rss(&with(right.exp()));
                        }
                    }
                    let better = with((0.5 * (low + high)).exp());
                    if rss(&better) < rss(&bench) {
                        bench = better;
                    }
                }
            }
        }
        bench
    }

    /// What the readings change by with the logarithm of a number out of a grid,
    /// stacked, at a model's solution.
    pub fn of_shape(&self, setting: &Setting<'_>, fit: &Fit, one: Named, k: usize) -> Option<DVector<f64>> {
        let variant = self.variant(one);
        let refine = variant.refine.as_ref()?;
        let [there, back] = [LOG_STEP, -LOG_STEP].map(|step| {
            let mut shape: Vec<f64> = variant.shape.iter().map(|number| number.value).collect();
            shape[k] *= step.exp();
            let columns = refine(&shape).into_iter().zip(&variant.columns);
            let mut sum = DVector::zeros(setting.problem.readings.len());
            for (number, column) in columns {
                let value = fit.columns.iter().position(|c| c == column).map_or(0.0, |at| fit.coefficients[at]);
                sum.axpy(value, &number.column(&setting.point), 1.0);
            }
            sum
        });
        Some((there - back) / (2.0 * LOG_STEP))
    }

    fn variant(&self, one: Named) -> &Variant {
        &self.candidates[one.candidate].variants[one.variant]
    }

    fn copy(&self) -> Self {
        Self {
            own: Rc::clone(&self.own),
            candidates: Rc::clone(&self.candidates),
            numbers: Rc::clone(&self.numbers),
            signs: Rc::clone(&self.signs),
            invisible: self.invisible.clone(),
            left_out: self.left_out.clone(),
            noise: Rc::clone(&self.noise),
            strict: self.strict,
            moments: self.moments.clone(),
            settings: RefCell::default(),
            states: RefCell::default(),
            ..*self
        }
    }

    /// The same with one number out of a grid at another value.
    fn with_shape(&self, one: Named, k: usize, value: f64) -> Self {
        let mut bench = self.copy();
        let mut candidates = self.candidates.to_vec();
        let column = self.variant(one).columns[k];
        // Forms that share a column share its number out of the grid.
        for variant in &mut candidates[one.candidate].variants {
            let at = variant.columns.iter().position(|&c| c == column).filter(|_| variant.refine.is_some());
            if let Some(at) = at {
                variant.shape[at].value = value;
            }
        }
        bench.candidates = candidates.into();
        bench.numbers = bench.refined_numbers(one.candidate..one.candidate + 1);
        bench
    }

    /// The numbers with those of some candidates where their shapes have them.
    pub(super) fn refined_numbers(&self, candidates: Range<usize>) -> Rc<[Number]> {
        let mut numbers = self.numbers.to_vec();
        for variant in self.candidates[candidates].iter().flat_map(|candidate| &candidate.variants) {
            if let Some(refine) = &variant.refine {
                let shape: Vec<f64> = variant.shape.iter().map(|number| number.value).collect();
                for (column, number) in variant.columns.iter().zip(refine(&shape)) {
                    numbers[column - self.own.len()] = number;
                }
            }
        }
        numbers.into()
    }
}
