//! Numbers out of grids, knees, onsets and radii, taken to where they fit best.

use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::Bench;
use crate::golden::least;
use crate::identify::covariance::Whitener;
use crate::identify::normal::{Fit, Normal, Sign};
use crate::trace::catalogue::{Number, Refine, Variant};
use crate::trace::model::{Fitted, Named, Setting};
use crate::trace::point::Point;

/// Times that numbers out of grids are looked at in turn, by what factor from the
/// grid's value (grids double); how finely, and the step of differences, in logarithms.
const SWEEPS: usize = 2;
const REACH: f64 = 2.5;
const FINE: f64 = 0.02;
const LOG_STEP: f64 = 0.02;

/// A model in which one number out of a grid takes other values, everything
/// that enters other than linearly held.
struct Tried<'c> {
    point: Point<'c>,
    whitener: Whitener,
    /// The model's columns whitened, a row each, of the rows fitted to.
    white: DMatrix<f64>,
    readings: DVector<f64>,
    stacked: Vec<usize>,
    normal: Normal,
    signs: Vec<Sign>,
    shape: Vec<f64>,
    refine: Refine,
    /// The places of the form's columns, and which of its numbers it is.
    at: Vec<usize>,
    k: usize,
}

impl Tried<'_> {
    /// The sum of squares left with a value of the number.
    fn rss(&self, value: f64) -> f64 {
        let mut shape = self.shape.clone();
        shape[self.k] = value;
        let numbers = (self.refine)(&shape);
        let moved: Vec<DVector<f64>> = numbers.iter().map(|number| number.column(&self.point)).collect();
        let mut moved = DMatrix::from_columns(&moved);
        self.whitener.whiten(&mut moved);
        let moved = moved.select_rows(&self.stacked);
        let mut normal = self.normal.clone();
        let (along, moment) = (&self.white * &moved, moved.tr_mul(&self.readings));
        for (k, &at) in self.at.iter().enumerate().take(moved.ncols()) {
            normal.gram.set_column(at, &along.column(k));
            normal.gram.set_row(at, &along.column(k).transpose());
            normal.moment[at] = moment[k];
        }
        let among = moved.tr_mul(&moved);
        for (i, &row) in self.at.iter().enumerate().take(moved.ncols()) {
            for (j, &column) in self.at.iter().enumerate().take(moved.ncols()) {
                normal.gram[(row, column)] = among[(i, j)];
            }
        }
        let all: Vec<usize> = (0..self.signs.len()).collect();
        normal.solve_signed(&all, &self.signs).map_or(f64::INFINITY, |fit| fit.rss)
    }
}

impl<'c> Bench<'c> {
    /// The same with numbers out of grids taken to where they fit best, and
    /// what they are then; as it is where a model has none.
    pub fn polished(&self, named: &[Named]) -> Self {
        let mut bench = self.copy();
        for _ in 0..SWEEPS {
            for &one in named.iter().filter(|&&one| self.variant(one).refine.is_some()) {
                for k in 0..self.variant(one).shape.len() {
                    bench = bench.polished_in(named, one, k);
                }
            }
        }
        bench
    }

    /// With one number out of a grid where it fits best, the others as they are.
    fn polished_in(self, named: &[Named], one: Named, k: usize) -> Self {
        let rss = |bench: &Self| bench.state(named).map_or(f64::INFINITY, |state| state.fit.rss);
        let with = |log: f64| self.with_shape(one, k, log.exp());
        let Variant { shape, within: [lowest, highest], .. } = self.variant(one);
        let at = shape[k].value;
        let (low, high) = ((at / REACH).max(*lowest).ln(), (at * REACH).min(*highest).ln());
        let tried = self.at_hand(named, one, k);
        let unlikely = self.unlikely(named, one);
        let best = least(low, high, FINE, |log| {
            let left = match &tried {
                Some(tried) => tried.rss(log.exp()),
                None => rss(&with(log)),
            };
            left + unlikely(log)
        });
        let better = with(best);
        let is_better = rss(&better) + unlikely(best) < rss(&self) + unlikely(at.ln());
        if is_better { better } else { self }
    }

    /// The same with forms that have a number out of a grid for each of their
    /// own, play operators, in the simplest that the criterion asks for: of three
    /// on a grid that none of them fits, two taken to where they fit best may do.
    /// With the model as it is then.
    pub fn simplified(self, named: &[Named]) -> (Self, Vec<Named>) {
        let (mut bench, mut named) = (self, named.to_vec());
        for k in 0..named.len() {
            loop {
                // One that has come out at zero is no model at all.
                let whole = bench.fit(&named).map_or(f64::INFINITY, |fitted| fitted.bic);
                let simpler = bench.simpler_forms(named[k]).into_iter().filter_map(|form| {
                    let mut fewer = named.clone();
                    fewer[k] = form;
                    let bench = bench.polished(&fewer);
                    let bic = bench.fit(&fewer).ok()?.bic;
                    (bic <= whole).then_some((bic, bench, fewer))
                });
                let Some((_, simpler, fewer)) = simpler.min_by(|a, b| a.0.total_cmp(&b.0)) else { break };
                (bench, named) = (simpler, fewer);
            }
        }
        (bench, named)
    }

    /// A model after a change of how it is fitted, if there was one; none, and all
    /// as it was, where physics does not allow the model then.
    pub fn tried(
        &mut self,
        named: &[Named],
        change: impl FnOnce(&mut Self, &[Named]) -> Result<bool, String>,
    ) -> Option<Fitted> {
        let before = self.copy();
        match change(self, named).and_then(|changed| if changed { self.fit(named).map(Some) } else { Ok(None) }) {
            Ok(better) => better,
            Err(_) => {
                *self = before;
                None
            }
        }
    }

    /// Whether a model has numbers that [`simplified`](Self::simplified) looks at.
    pub fn may_be_simpler(&self, named: &[Named]) -> bool {
        named.iter().any(|&one| !self.simpler_forms(one).is_empty())
    }

    /// The forms of a candidate with one less of such numbers.
    fn simpler_forms(&self, one: Named) -> Vec<Named> {
        let own = self.variant(one);
        if own.refine.is_none() || own.shape.len() != own.columns.len() || own.columns.len() < 2 {
            return Vec::new();
        }
        let variants = &self.candidates[one.candidate].variants;
        let is_simpler = |form: &Variant| {
            form.columns.len() + 1 == own.columns.len()
                && form.columns.iter().all(|column| own.columns.contains(column))
        };
        let simpler = (0..variants.len()).filter(|&variant| is_simpler(&variants[variant]));
        simpler.map(|variant| Named { variant, ..one }).collect()
    }

    /// What is to be added to a sum of squares for a number out of a grid that is
    /// unlikely, by its logarithm.
    fn unlikely(&self, named: &[Named], one: Named) -> impl Fn(f64) -> f64 + use<> {
        let variance = self.state(named).map_or(0.0, |state| {
            let samples = &self.prepared.samples;
            let rows = self.left_out.iter().zip(&samples.rows);
            let fitted = rows.filter(|(out, row)| !**out && self.prepared.training[row.pose]).count();
            let readings = fitted * samples.length() / samples.rows.len();
            state.fit.rss / readings as f64
        });
        let likely = self.variant(one).likely;
        move |log| likely.map_or(0.0, |[middle, spread]| variance * ((log - middle.ln()) / spread).powi(2))
    }

    /// A model at its solution, ready for other values of a number out of a grid;
    /// none where what goes with that number enters other than linearly.
    fn at_hand(&self, named: &[Named], one: Named, k: usize) -> Option<Tried<'c>> {
        let variant = self.variant(one);
        let column = variant.columns[k];
        if self.numbers[column - self.own.len()].enters.is_some() {
            return None;
        }
        let state = self.state(named).ok()?;
        let point = self.point(state.setup.clone());
        let columns = &state.fit.columns;
        let of = |&column: &usize| match state.tangents.iter().find(|(of, _)| *of == column) {
            Some((_, tangent)) => tangent.clone(),
            None => self.linear(&point, column),
        };
        let raw: Vec<DVector<f64>> = columns.iter().map(of).collect();
        let problem = self.regression(&point, DMatrix::from_columns(&raw), Rc::clone(&state.readings));
        let stacked: Vec<usize> = problem.blocks.iter().flat_map(|block| block.stacked.iter().copied()).collect();
        let at = variant.columns.iter().filter_map(|column| columns.iter().position(|c| c == column)).collect();
        let weights = self.weights();
        Some(Tried {
            whitener: weights.covariance.whitener(weights.left_out),
            white: problem.white.select_rows(&stacked).transpose(),
            readings: problem.white_readings.select_rows(&stacked),
            normal: problem.equations.total,
            signs: columns.iter().map(|&column| self.signs[column]).collect(),
            shape: variant.shape.iter().map(|number| number.value).collect(),
            refine: variant.refine.clone()?,
            stacked,
            point,
            at,
            k,
        })
    }

    /// What the readings change by with the logarithm of a number out of a grid,
    /// stacked, at a model's solution.
    pub fn of_shape(&self, setting: &Setting<'_>, model: &Fitted, one: Named, k: usize) -> Option<DVector<f64>> {
        let variant = self.variant(one);
        let refine = variant.refine.as_ref()?;
        let fit = &model.fit;
        let value_of =
            |column: usize| fit.columns.iter().position(|&c| c == column).map_or(0.0, |at| fit.coefficients[at]);
        let enters = self.numbers[variant.columns[0] - self.own.len()].enters.is_some();
        let [there, back] = [LOG_STEP, -LOG_STEP].map(|step| {
            let mut shape: Vec<f64> = variant.shape.iter().map(|number| number.value).collect();
            shape[k] *= step.exp();
            if enters {
                let moved = self.with_shape(one, k, shape[k]);
                let nonlinear = moved.nonlinear(&model.named);
                let theta: Vec<f64> = nonlinear.iter().map(|(column, _)| value_of(*column)).collect();
                return moved.prediction(&moved.point(moved.setup(&nonlinear, &theta)), fit, &nonlinear);
            }
            let mut sum = DVector::zeros(setting.problem.readings.len());
            for (number, &column) in refine(&shape).into_iter().zip(&variant.columns) {
                sum.axpy(value_of(column), &number.column(&setting.point), 1.0);
            }
            sum
        });
        Some((there - back) / (2.0 * LOG_STEP))
    }

    /// How many numbers a model's effects take, those out of a grid among them.
    pub fn parameters(&self, named: &[Named]) -> usize {
        named.iter().map(|&one| self.variant(one).parameters).sum()
    }

    /// How many readings are fitted to.
    pub fn count_readings(&self) -> usize {
        self.fitted_to().count()
    }

    /// The fit of a model at its solution, whether physics allows it or not.
    ///
    /// # Errors
    /// Why it cannot be fitted.
    pub fn fit_at_solution(&self, named: &[Named]) -> Result<Fit, String> {
        Ok(self.state(named)?.fit.clone())
    }

    fn variant(&self, one: Named) -> &Variant {
        &self.candidates[one.candidate].variants[one.variant]
    }

    /// The same with some rows left out, for they are wild, and no others.
    pub fn leaving_out(&self, rows: &[usize]) -> Self {
        let mut bench = self.copy();
        bench.left_out.fill(false);
        rows.iter().for_each(|&row| bench.left_out[row] = true);
        bench
    }

    /// The same, with nothing known of models.
    pub fn copy(&self) -> Self {
        Self {
            own: Rc::clone(&self.own),
            base: Rc::clone(&self.base),
            candidates: Rc::clone(&self.candidates),
            numbers: Rc::clone(&self.numbers),
            signs: Rc::clone(&self.signs),
            invisible: self.invisible.clone(),
            events: Rc::clone(&self.events),
            left_out: self.left_out.clone(),
            noise: Rc::clone(&self.noise),
            strict: self.strict,
            moments: self.moments.clone(),
            stored: Rc::clone(&self.stored),
            settings: RefCell::default(),
            states: RefCell::default(),
            tests: RefCell::default(),
            readings: self.readings.clone(),
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
