//! How sure the numbers of a model of absolute positions are.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::bench::{Bench, Model};
use super::left_at_zero::LeftAtZero;
use crate::identify::normal::Sign;
use crate::identify::positions::of_numbers;
use crate::identify::positions::regression::STANDS;
use crate::identify::uncertainty::covariance;

/// The covariance of the description's own numbers before anything is named, which is of the
/// readings alone.
pub fn spread_as_declared(base: &Model) -> DMatrix<f64> {
    let solved = &base.solved;
    of_numbers(&covariance(&solved.problem, &solved.fit, &solved.signs, None))
}

/// The covariance of a model's numbers, and of those out of grids behind them, where
/// the rows tell these; with what numbers of the table do that it leaves at zero.
pub fn spread_of(bench: &Bench<'_>, model: &Model) -> DMatrix<f64> {
    let left = LeftAtZero::by(bench, model);
    let shapes: Vec<DVector<f64>> = bench.shape_columns(model).into_iter().map(|(_, column)| column).collect();
    let spread = with_shapes(bench, model, &shapes, &left);
    let own = model.solved.fit.columns.len() - STANDS;
    let told = (own..spread.nrows()).all(|k| spread[(k, k)] > 0.0);
    if told { spread } else { with_shapes(bench, model, &[], &left) }
}

fn with_shapes(bench: &Bench<'_>, model: &Model, shapes: &[DVector<f64>], left: &LeftAtZero) -> DMatrix<f64> {
    let solved = &model.solved;
    // Where shapes leave least their columns have nothing to add.
    let mut fit = solved.fit.clone();
    let (own, all) = (fit.columns.len(), fit.columns.len() + shapes.len());
    fit.columns.extend(own..all);
    fit.coefficients = fit.coefficients.resize_vertically(all, 0.0);
    let signs: Vec<Sign> = solved.signs.iter().copied().chain(shapes.iter().map(|_| Sign::Free)).collect();
    let columns = bench.columns_of(&left.numbers);
    let mut more = DMatrix::zeros(columns.nrows(), shapes.len() + columns.ncols());
    shapes.iter().enumerate().for_each(|(k, shape)| more.set_column(k, shape));
    more.columns_mut(shapes.len(), columns.ncols()).copy_from(&columns);
    let problem = bench.with_columns(model, &more);
    of_numbers(&(covariance(&problem, &fit, &signs, None) + left.covariance(&problem, &fit, &signs, all)))
}
