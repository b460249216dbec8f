//! What positions cannot tell from what a model of them has: see [`confounded`](crate::trace::confounded).

use std::collections::BTreeSet;
use std::vec::Vec;

use super::bench::{Bench, Model};
use crate::identify::positions::regression::STANDS;
use crate::trace::catalogue::Candidate;
use crate::trace::confounded::{Alias, Asked, adds_up, columns_of, is_left_at_zero};

/// The aliases of a model of some joints, at it.
pub fn aliases(bench: &Bench<'_>, model: &Model, joints: usize) -> Vec<Alias> {
    let mut numbers = bench.chosen(&model.named);
    let chosen = numbers.len();
    let adding_up = || bench.candidates.iter().enumerate().filter(|(_, candidate)| adds_up(candidate));
    let numbers_of = |candidate: &Candidate| columns_of(candidate).into_iter().map(|column| column - STANDS);
    let prepared = &bench.prepared;
    let own: Vec<usize> = (joints..prepared.own.len())
        .filter(|&k| prepared.own[k].is_compliance() && is_left_at_zero(prepared.own[k].value, &prepared.visibility[k]))
        .collect();
    for number in adding_up().flat_map(|(_, candidate)| numbers_of(candidate)).chain(own.iter().copied()) {
        if !numbers[..chosen].contains(&number) {
            numbers.push(number);
        }
    }
    let problem = bench.with_columns(model, &bench.columns_of(&numbers[chosen..]));
    let fit = &model.solved.fit;
    let asked = Asked {
        total: &problem.total,
        fit,
        signs: model.solved.signs.clone(),
        // Where the robot stands comes first, then the joints' own.
        of_effect: (0..fit.columns.len()).map(|k| k >= STANDS && numbers[k - STANDS] >= joints).collect(),
        variance: problem.variance(fit),
    };
    let place = |number: usize| numbers.iter().position(|&of| of == number).map(|at| STANDS + at);
    let is_named = |index: usize| model.named.iter().any(|one| one.candidate == index);
    let columns = |candidate: &Candidate| numbers_of(candidate).filter_map(place).collect::<BTreeSet<usize>>();
    let of_catalogue = adding_up().map(|(index, candidate)| (candidate.name(), is_named(index), columns(candidate)));
    let of_description = own.iter().map(|&k| (prepared.own[k].name.clone(), true, place(k).into_iter().collect()));
    asked.aliases(of_catalogue.chain(of_description))
}
