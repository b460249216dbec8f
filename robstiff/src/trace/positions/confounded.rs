//! What positions cannot tell from what a model of them has: see [`confounded`](crate::trace::confounded).

use std::collections::BTreeSet;
use std::vec::Vec;

use super::bench::{Bench, Model};
use crate::identify::positions::regression::STANDS;
use crate::trace::catalogue::Candidate;
use crate::trace::confounded::{Alias, Asked, adds_up, columns_of};

/// The aliases of a model of some joints, at it.
pub fn aliases(bench: &Bench<'_>, model: &Model, joints: usize) -> Vec<Alias> {
    let mut numbers = bench.chosen(&model.named);
    let chosen = numbers.len();
    let adding_up = || bench.candidates.iter().enumerate().filter(|(_, candidate)| adds_up(candidate));
    let numbers_of = |candidate: &Candidate| columns_of(candidate).into_iter().map(|column| column - STANDS);
    for number in adding_up().flat_map(|(_, candidate)| numbers_of(candidate)) {
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
    asked.aliases(adding_up().map(|(index, candidate)| (candidate, is_named(index), columns(candidate))))
}
