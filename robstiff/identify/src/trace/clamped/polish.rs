//! Numbers out of grids where they fit best.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::bench::Bench;
use crate::identify::clamped::regression::by_axis;
use crate::identify::normal::{Normal, Sign};
use crate::identify::whitening::ByVisit;
use crate::trace::model::Named;

/// Times that numbers out of grids are looked at in turn, how far from the grid's
/// value, and how finely, in logarithms.
const SWEEPS: usize = 2;
const REACH: f64 = 0.9;
const FINE: f64 = 0.02;

/// The regression of a model by itself, in which the columns of one effect change at a time.
struct Own {
    axes: ByVisit,
    white: DMatrix<f64>,
    white_readings: DVector<f64>,
    normal: Normal,
    signs: Vec<Sign>,
    all: Vec<usize>,
}

impl Own {
    fn of(bench: &Bench, named: &[Named]) -> Self {
        let columns = bench.columns(named);
        Self {
            axes: by_axis(&bench.axes.rows),
            white: bench.problem.white.select_columns(&columns),
            white_readings: (*bench.problem.white_readings).clone(),
            normal: bench.problem.total.of(&columns),
            signs: columns.iter().map(|&column| bench.signs[column]).collect(),
            all: (0..columns.len()).collect(),
        }
    }

    /// Puts others in the place of the columns from `first` on.
    fn replace(&mut self, first: usize, columns: &[DVector<f64>]) {
        let mut white = DMatrix::from_columns(columns);
        self.axes.whiten(&mut white, 0, 1);
        self.white.columns_mut(first, white.ncols()).copy_from(&white);
        let gram = self.white.tr_mul(&white);
        self.normal.gram.columns_mut(first, white.ncols()).copy_from(&gram);
        self.normal.gram.rows_mut(first, white.ncols()).copy_from(&gram.transpose());
        self.normal.moment.rows_mut(first, white.ncols()).copy_from(&white.tr_mul(&self.white_readings));
    }

    /// The sum of squares that it leaves.
    fn left(&self) -> f64 {
        self.normal.solve_signed(&self.all, &self.signs).map_or(f64::INFINITY, |fit| fit.rss)
    }
}

impl Bench {
    /// The same with the numbers out of grids of some effects where they fit best.
    pub fn polished(&self, named: &[Named]) -> Self {
        let (mut offers, mut own) = (self.offers.clone(), Own::of(self, named));
        let variance = own.left() / self.axes.rows.len() as f64;
        for _ in 0..SWEEPS {
            let mut first = self.base;
            for one in named {
                let form = &mut offers[one.candidate].1.forms[one.variant];
                for k in 0..form.shape.len() {
                    let ([least, most], likely, at) = (form.within, form.likely, form.shape[k].value.ln());
                    let mut of = |log: f64| {
                        form.shape[k].value = log.exp();
                        own.replace(first, &(form.columns)(&form.values()));
                        let unlikely = likely.map_or(0.0, |[middle, spread]| ((log - middle.ln()) / spread).powi(2));
                        own.left() + variance * unlikely
                    };
                    let (low, high) = ((at - REACH).max(least.ln()), (at + REACH).min(most.ln()));
                    let steps = ((high - low) / FINE).ceil().max(1.0) as usize;
                    let tried = (0..=steps).map(|k| low + (high - low) * k as f64 / steps as f64);
                    let best = tried.map(|log| (of(log), log)).min_by(|a, b| a.0.total_cmp(&b.0));
                    let better = best.filter(|(found, _)| *found < of(at)).map_or(at, |(_, log)| log);
                    of(better);
                }
                first += form.numbers.len();
            }
        }
        Self::new(self.axes.clone(), Some(&offers))
    }
}

#[cfg(test)]
mod tests {
    use super::super::axes::Axes;
    use super::super::tests::{both_ways, measured, play};
    use super::*;
    use crate::campaign::Data;
    use crate::identify::clamped::slopes;
    use robstiff_robots::samples::five_axis;

    #[test]
    fn what_is_tried_leaves_what_a_bench_of_it_does() {
        let state = core::cell::Cell::new(0.0);
        let lags = |axis: usize, torque: f64| {
            state.set(play(torque, 200.0, if axis == 2 { state.get() } else { 0.0 }));
            if axis == 2 { 1e-7 * state.get() } else { 0.0 }
        };
        let campaign = measured(&five_axis(), &both_ways(), 930, lags);
        let Data::Clamped(rows) = &campaign.data else { unreachable!("made of clamped axes") };
        let identified = slopes(&campaign, rows, &[]).expect("every axis is loaded");
        let bench = Bench::new(Axes::new(&campaign.robot, rows, &identified), None);
        let best = bench.extended(&[]).into_iter().next().expect("something is missing");
        let polished = bench.polished(&best.named);
        let form = polished.form(best.named[0]);
        let mut own = Own::of(&bench, &best.named);
        own.replace(bench.base, &(form.columns)(&form.values()));
        let left = polished.fit(&best.named).expect("it is possible").fit.rss;
        assert!(
            (own.left() / left - 1.0).abs() < 1e-6 && left < best.fit.rss,
            "{} {left} {}",
            own.left(),
            best.fit.rss
        );
    }
}
