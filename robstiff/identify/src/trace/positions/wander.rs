//! Slips held against what goes there and back ([`wander`](crate::trace::wander)), of positions.

use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Vector3};

use super::bench::{Bench, Model};
use super::course::Course;
use crate::identify::positions::model::Enters;
use crate::trace::catalogue::THERMAL_DRIFT;
use crate::trace::model::{Named, all_but};
use crate::trace::slip::Slipping;
use crate::trace::step::Step;
use crate::trace::wander::{self, Beside, WORDS};

/// A course without the slips that what is read says better by going there and back, and what
/// it looks like; `None` where there are none of these.
pub fn instead_of_slips(bench: &mut Bench<'_>, course: &Course) -> Option<(Course, String)> {
    let drifts = |one: &Named| bench.candidates[one.candidate].kind == &THERMAL_DRIFT;
    let is_slip = |one: &Named| bench.candidates[one.candidate].slipping().is_some();
    let (mut model, mut best) = (course.model.clone(), course.model.bic);
    if model.leaves_nothing() {
        return None;
    }
    loop {
        // Beside such a course a drift may be part of it.
        let first = model.named.len() == course.model.named.len();
        let may_go = |one: &Named| is_slip(one) || (!first && drifts(one));
        let without = |k: usize| {
            let smaller = bench.solve(&all_but(&model.named, k), &model.solved.state)?;
            Some((beside_a_course(bench, &smaller)?, smaller))
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
    if model.named.len() == course.model.named.len() {
        return None;
    }
    let names: Vec<String> = model.named.iter().map(|one| bench.candidates[one.candidate].name()).collect();
    let stays = |one: &Named| model.named.contains(one);
    let gone = course.model.named.iter().filter(|one| !stays(one));
    let taken_back = gone.map(|one| bench.candidates[one.candidate].name());
    let taken_back = course.taken_back.iter().cloned().chain(taken_back).collect();
    let with_p = course.model.named.iter().zip(&course.p_values).filter(|(one, _)| stays(one));
    let p_values = with_p.map(|(_, p)| *p).collect();
    let steps = course.steps.iter().cloned().chain([Step::beside_nameless(names, &[WORDS])]).collect();
    bench.turn_to(&model);
    let (wild, left, unnamed) = (course.wild.clone(), course.left.clone(), course.unnamed);
    Some((Course { model, wild, p_values, steps, unnamed, left, taken_back }, WORDS.to_string()))
}

/// What a model leaves of some more columns.
fn beside(bench: &Bench<'_>, model: &Model, columns: &[DVector<f64>]) -> Option<Beside> {
    let total = bench.with_columns(model, &DMatrix::from_columns(columns)).equations.total;
    Beside::of(&total, &model.solved.fit, &model.solved.signs, model.bic)
}

/// Schwarz's criterion of a model with a course of what is read besides.
fn beside_a_course(bench: &Bench<'_>, model: &Model) -> Option<f64> {
    let rows = bench.prepared.data.rows.len();
    // Along each axis of the frame that positions are read in.
    let shifts = |course: &dyn Fn(f64) -> f64| {
        let at = |i: usize| course(((i / 3) as f64 + 0.5) / rows as f64);
        [0, 1, 2].map(|k| DVector::from_fn(3 * rows, |i, _| if i % 3 == k { at(i) } else { 0.0 }))
    };
    wander::beside_a_course(rows, &shifts, &|columns| beside(bench, model, columns))
}

/// Schwarz's criterion of a model with a second slip like one that it names: that has its own
/// words.
fn slipped_again(bench: &Bench<'_>, model: &Model) -> Option<f64> {
    let slips = model.named.iter().filter_map(|one| bench.candidates[one.candidate].slipping());
    let moments = || (1..bench.prepared.data.rows.len()).step_by(bench.rig.apart());
    let turn = model.solved.state.registration.turn;
    let of_one = |(slipping, moment): (Slipping, usize)| {
        let moved = bench.rig.slipped(slipping, moment).into_iter().filter_map(|enters| match enters {
            Enters::Reading(moved) => Some(moved),
            Enters::Model(..) => None,
        });
        let column = |by: &Vec<Vector3<f64>>| {
            let stacked = by.iter().flat_map(|by| <[f64; 3]>::from(turn * by));
            DVector::from_vec(stacked.collect())
        };
        let columns: Vec<DVector<f64>> = moved.map(|moved| column(&moved.rows)).collect();
        let beside = beside(bench, model, &columns)?;
        let first = |count: usize| beside.with(&DMatrix::identity(columns.len(), count), 1);
        [3, columns.len()].into_iter().filter_map(first).min_by(f64::total_cmp)
    };
    let all = slips.flat_map(|slipping| moments().map(move |moment| (slipping, moment)));
    all.filter_map(of_one).min_by(f64::total_cmp)
}
