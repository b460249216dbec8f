//! What wild rows may as well be: a curve of the gear that only few rows of an axis show.

use std::string::String;
use std::vec::Vec;

use super::bench::Bench;
use super::standing::weight;
use crate::trace::catalogue::{HYSTERESIS, LOST_MOTION, STIFFNESS_NONLINEARITY};
use crate::trace::found::Place;
use crate::trace::model::{Fitted, Named};
use crate::trace::selection::WITHIN_REACH;
use robstiff_robots::effect::Place as Part;

/// The names of effects of gears that say as much as all the wild rows of an axis, and whether
/// no other axis has such rows.
pub fn instead_of_rows(bench: &Bench, model: &Fitted, wild: &[usize]) -> (Vec<String>, bool) {
    let whole = bench.axes.whole();
    let of_axis = |axis: usize| whole.rows.iter().filter(|row| row.axis == axis && wild.contains(&row.line)).count();
    let mut names = Vec::new();
    let axes: Vec<usize> = whole.loaded().filter(|&axis| of_axis(axis) > 0).collect();
    for &axis in &axes {
        let others: Vec<usize> = (0..whole.rows.len())
            .filter(|&row| wild.contains(&whole.rows[row].line) && whole.rows[row].axis != axis)
            .collect();
        let back = Bench::new(whole.without(&others), Some(&bench.offers));
        let as_good = |candidate: &usize| {
            let with = with_gear(&back, &model.named, *candidate);
            with.is_some_and(|with| with < weight(bench, model) + WITHIN_REACH)
        };
        let gear = |candidate: &usize| {
            let one = &bench.candidates[*candidate];
            one.place == Place::from(Part::Joint(axis))
                && [&HYSTERESIS, &STIFFNESS_NONLINEARITY, &LOST_MOTION].contains(&one.kind)
        };
        let found = (0..bench.candidates.len()).filter(gear).filter(as_good);
        names.extend(found.map(|candidate| bench.candidates[candidate].name()));
    }
    (names, axes.len() == 1)
}

/// Schwarz's criterion, over all rows, of a model with one effect more.
fn with_gear(bench: &Bench, named: &[Named], candidate: usize) -> Option<f64> {
    if named.iter().any(|one| one.candidate == candidate) {
        return None;
    }
    let mut more = named.to_vec();
    more.push(Named { candidate, variant: 0 });
    more.sort_unstable();
    let (bench, model) = bench.anew_in_any_form(&more, candidate)?;
    Some(weight(&bench, &model))
}
