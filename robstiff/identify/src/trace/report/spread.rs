//! How sure the numbers of a model are.

use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use crate::identify::normal::{Fit, Sign};
use crate::identify::problem::Problem;
use crate::identify::uncertainty::{covariance, covariance_with, of_held, shifts};
use crate::trace::bench::Bench;
use crate::trace::model::{Fitted, Setting};

/// The covariance of a model's coefficients, and behind them of the logarithms
/// of its numbers out of grids, in the order of its effects; with what readings
/// may have besides that no column says, and what numbers may be off by that are
/// [held](crate::identify::prepare::Prepared::held).
pub fn spread_of(bench: &Bench<'_>, setting: &Setting<'_>, model: &Fitted) -> DMatrix<f64> {
    let mut signs: Vec<Sign> = model.fit.columns.iter().map(|&column| setting.signs[column]).collect();
    let mut known = vec![0.0; signs.len()];
    let mut shapes: Vec<DVector<f64>> = Vec::new();
    let mut unsure: Vec<Vec<DVector<f64>>> = Vec::new();
    for &one in &model.named {
        let variant = setting.variant(one);
        for k in 0..variant.shape.len() {
            if let Some(change) = bench.of_shape(setting, model, one, k) {
                shapes.push(change);
                let spread = variant.likely.map_or(ANYTHING, |[_, spread]| spread);
                known.push(spread.powi(-2));
            }
        }
        if let Some(of) = &variant.unsure {
            let value = |column: &usize| {
                let at = model.fit.columns.iter().position(|c| c == column);
                at.map_or(0.0, |at| model.fit.coefficients[at])
            };
            unsure.push(of(&setting.point, &variant.columns.iter().map(value).collect::<Vec<f64>>()));
        }
    }
    let (held, noise) = (bench.prepared.held(&model.fit), bench.prepared.declared_noise);
    if shapes.is_empty() && unsure.is_empty() && held.is_empty() {
        let (problem, fit) = setting.alone(&model.fit);
        return covariance(&problem, &fit, &signs, noise);
    }
    let count = model.fit.columns.len() + shapes.len();
    let examples = unsure.iter().flatten().cloned();
    let mut raw: Vec<DVector<f64>> =
        model.fit.columns.iter().map(|&column| setting.raw(column)).chain(shapes).chain(examples).collect();
    let first_held = raw.len();
    raw.extend(held.iter().map(|&(column, _)| setting.raw(column)));
    let readings = Rc::clone(&setting.problem.readings);
    let samples = &setting.point.samples;
    let problem = Problem::new(samples, DMatrix::from_columns(&raw), readings, &setting.correction, bench.weights());
    let columns: Vec<usize> = (0..count).collect();
    let coefficients = model.fit.coefficients.clone().resize_vertically(count, 0.0);
    signs.resize(count, Sign::Free);
    let fit = Fit { columns, coefficients, rss: model.fit.rss };
    let mut spread = covariance_with(&problem, &fit, &signs, &known, noise);
    let mut next = count;
    for examples in &unsure {
        let columns: Vec<usize> = (next..next + examples.len()).collect();
        let shifts = shifts(&problem, &fit, &signs, &columns);
        spread += &shifts * shifts.transpose() / examples.len().max(1) as f64;
        next += examples.len();
    }
    let held: Vec<(usize, f64)> = held.iter().enumerate().map(|(k, &(_, spread))| (first_held + k, spread)).collect();
    spread + of_held(&problem, &fit, &signs, &held, noise)
}

/// A number out of a grid of which nothing is known beforehand is within ten
/// times of what it is, up and down: this many logarithms.
const ANYTHING: f64 = 2.3;

/// A compliance as a share of that of a joint (from 1), with its standard
/// deviation to the first order.
pub fn share_of(setting: &Setting<'_>, model: &Fitted, spread: &DMatrix<f64>, at: usize, joint: usize) -> (f64, f64) {
    let (value, own) = (model.fit.coefficients[at], setting.joint_value(&model.fit, joint));
    let share = value / own;
    let variance = match model.fit.columns.iter().position(|&column| column == joint - 1) {
        Some(k) => spread[(at, at)] - 2.0 * share * spread[(at, k)] + share * share * spread[(k, k)],
        None => spread[(at, at)],
    };
    (share, variance.max(0.0).sqrt() / own)
}
