//! The order in which the effects of a model are told.

use std::vec::Vec;

use super::model::{Named, all_but};

/// The places of a model's effects, that one first `without` which the measure of the rest is
/// largest; none where the rest is no model, which is more than any measure.
pub fn costliest_first(named: &[Named], without: impl Fn(&[Named]) -> Option<f64>) -> Vec<usize> {
    let cost = |k: usize| without(&all_but(named, k)).unwrap_or(f64::INFINITY);
    let mut costs: Vec<(f64, usize)> = (0..named.len()).map(|k| (cost(k), k)).collect();
    costs.sort_by(|a, b| b.0.total_cmp(&a.0));
    costs.into_iter().map(|(_, k)| k).collect()
}
