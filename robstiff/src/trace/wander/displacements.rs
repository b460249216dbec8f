//! Slips held against what goes there and back, of displacements.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Vector3};

use super::{Beside, OF_READING};
use crate::identify::normal::{Normal, Sign};
use crate::trace::bench::Bench;
use crate::trace::model::{Fitted, Named, Setting, all_but};
use crate::trace::slip::Slipping;

/// Moments at which a second slip is looked for.
const MOMENTS: usize = 96;

/// What stays of a model without the slips that what is read says better by going there and
/// back; `None` where there are none of these.
pub fn instead_of_slips(bench: &Bench<'_>, model: &Fitted) -> Option<Fitted> {
    let name = |one: &Named| bench.candidates()[one.candidate].kind.name;
    let (mut model, mut best, whole) = (model.clone(), model.bic, model.named.len());
    loop {
        // Beside such a course a drift may be part of it.
        let first = model.named.len() == whole;
        let may_go = |one: &Named| Slipping::has(name(one)) || (!first && name(one) == OF_READING);
        let without = |k: usize| {
            let rest = all_but(&model.named, k);
            let smaller = bench.fit_or_loosely(&rest).ok()?;
            Some((beside_a_course(&*bench.at(&rest).ok()?, &smaller)?, smaller))
        };
        let found = (0..model.named.len()).filter(|&k| may_go(&model.named[k])).filter_map(without);
        let Some((bic, smaller)) = found.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(bic, _)| *bic < best) else {
            break;
        };
        if first && slipped_again(bench, &model).is_some_and(|again| again < bic) {
            break;
        }
        (model, best) = (smaller, bic);
    }
    (model.named.len() < whole).then_some(model)
}

/// What a model leaves of some more columns, stacked as they are read.
fn beside(setting: &Setting<'_>, model: &Fitted, columns: &[DVector<f64>]) -> Option<Beside> {
    let (problem, fit) = setting.alone(&model.fit);
    let own = problem.white.ncols();
    let mut white = problem.white.clone().resize_horizontally(own + columns.len(), 0.0);
    for (k, column) in columns.iter().enumerate() {
        white.set_column(own + k, &setting.whitener.whitened(column.clone()));
    }
    let stacked: Vec<usize> = problem.blocks.iter().flat_map(|block| block.stacked.iter().copied()).collect();
    let total = Normal::of_rows(&white, &problem.white_readings, &stacked);
    let signs: Vec<Sign> = model.fit.columns.iter().map(|&column| setting.signs[column]).collect();
    Beside::of(&total, &fit, &signs, model.bic)
}

/// The columns of shifts of what is read, along the axes of the base frame, by so much at each row.
fn shifts(setting: &Setting<'_>, at: &dyn Fn(usize) -> f64) -> [DVector<f64>; 3] {
    [0, 1, 2].map(|k| setting.point.of_reading(|row| Vector3::ith(k, at(row))))
}

/// Schwarz's criterion of a model with a course of what is read besides.
fn beside_a_course(setting: &Setting<'_>, model: &Fitted) -> Option<f64> {
    let rows = setting.point.samples.rows.len();
    let shifts = |course: &dyn Fn(f64) -> f64| shifts(setting, &|row| course((row as f64 + 0.5) / rows as f64));
    super::beside_a_course(rows, &shifts, &|columns| beside(setting, model, columns))
}

/// Schwarz's criterion of a model with a second slip: that has its own words.
fn slipped_again(bench: &Bench<'_>, model: &Fitted) -> Option<f64> {
    let setting = bench.at(&model.named).ok()?;
    let rows = setting.point.samples.rows.len();
    let moments = (1..rows).step_by(rows.div_ceil(MOMENTS));
    let of_one = |moment: usize| {
        let beside = beside(&setting, model, &shifts(&setting, &|row| f64::from(u8::from(row >= moment))))?;
        // The moment, too.
        beside.with(&DMatrix::identity(3, 3), 1)
    };
    moments.filter_map(of_one).min_by(f64::total_cmp)
}
