//! What these readings cannot tell apart.
//!
//! A *class* is an effect of the best set with all that may as well stand in its place: a candidate
//! with which the set would be nearly as probable, and two or three together where they do what one
//! effect does. The probability of a class is that any of it is there.

use std::collections::BTreeMap;

use super::search::{Visited, candidates_of};
use super::{Problem, Set};

/// A candidate in whose place another is less likely by more than this factor stands alone (Kass and
/// Raftery, JASA 90, 1995: odds of twenty are strong evidence).
pub const ODDS: f64 = 20.0;

/// A class that is less likely than this looks for others that take its place.
const LIKELY: f64 = 0.95;

/// Two that are there together in more than this part of the cases do not stand for each other.
const TOGETHER: f64 = 0.2;

/// One that is less likely than this stands for nothing.
const RARE: f64 = 0.02;

/// An effect with all that may stand in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Class {
    /// Its form in the best set.
    pub form: usize,
    /// Its candidates, the one of the best set first, with the probability of each.
    pub members: Vec<(usize, f64)>,
    /// The probability that any of them is there.
    pub probability: f64,
}

/// Sets of candidates with their probability: forms do not count.
pub struct ByCandidate {
    sets: Vec<(Vec<usize>, f64)>,
}

impl ByCandidate {
    /// Of all sets that were judged.
    pub fn of(problem: &Problem<'_>, visited: &Visited) -> Self {
        let mut sets: BTreeMap<Vec<usize>, f64> = BTreeMap::new();
        for (set, probability) in visited.posterior() {
            *sets.entry(candidates_of(problem, set)).or_default() += probability;
        }
        Self { sets: sets.into_iter().collect() }
    }

    /// The probability that any of some candidates is there.
    pub fn of_any(&self, candidates: &[usize]) -> f64 {
        let has = |set: &[usize]| candidates.iter().any(|of| set.contains(of));
        self.sets.iter().filter(|(set, _)| has(set)).map(|(_, p)| p).sum()
    }

    /// The probability that one is there with any of some others.
    fn of_both(&self, one: usize, others: &[usize]) -> f64 {
        let has = |set: &[usize]| set.contains(&one) && others.iter().any(|of| set.contains(of));
        self.sets.iter().filter(|(set, _)| has(set)).map(|(_, p)| p).sum()
    }

    fn of_set(&self, set: &[usize]) -> f64 {
        self.sets.iter().find(|(of, _)| of == set).map_or(0.0, |(_, p)| *p)
    }
}

/// The classes of the best set's effects.
pub fn classes(problem: &Problem<'_>, visited: &Visited, best: &Set) -> Vec<Class> {
    let by = ByCandidate::of(problem, visited);
    let of_best = candidates_of(problem, best);
    best.iter().map(|&form| class(problem, &by, &of_best, form)).collect()
}

/// The candidates in whose place a set is nearly as probable as with one of its candidates, or as with the
/// best in its place.
fn in_place_of(problem: &Problem<'_>, by: &ByCandidate, of_best: &[usize], own: usize) -> Vec<usize> {
    let others = (0..problem.layout.candidates.len()).filter(|other| !of_best.contains(other));
    let with = |other: usize| {
        let mut swapped: Vec<usize> = of_best.iter().map(|&of| if of == own { other } else { of }).collect();
        swapped.sort_unstable();
        by.of_set(&swapped)
    };
    let each: Vec<(usize, f64)> = others.map(|other| (other, with(other))).collect();
    let most = each.iter().map(|(_, p)| *p).fold(with(own), f64::max);
    each.into_iter().filter(|(_, p)| p * ODDS > most).map(|(other, _)| other).collect()
}

/// Adds to classes what may as well stand in the place of their effects under other priors.
pub fn extend(classes: &mut [Class], problem: &Problem<'_>, visited: &Visited, best: &Set) {
    let by = ByCandidate::of(problem, visited);
    let of_best = candidates_of(problem, best);
    for class in classes {
        for other in in_place_of(problem, &by, &of_best, class.members[0].0) {
            if class.members.iter().all(|(member, _)| *member != other) {
                class.members.push((other, 0.0));
            }
        }
    }
}

/// Weighs what is in classes again.
pub fn weigh_again(classes: &mut [Class], by: &ByCandidate) {
    for class in classes {
        class.members.iter_mut().for_each(|(of, p)| *p = by.of_any(&[*of]));
        class.members[1..].sort_by(|a, b| b.1.total_cmp(&a.1));
        class.probability = by.of_any(&class.members.iter().map(|(of, _)| *of).collect::<Vec<_>>());
    }
}

fn class(problem: &Problem<'_>, by: &ByCandidate, of_best: &[usize], form: usize) -> Class {
    let own = problem.layout.forms[form].candidate;
    let all = 0..problem.layout.candidates.len();
    let mut members = vec![own];
    members.extend(in_place_of(problem, by, of_best, own));
    // What is there where none of these is, and hardly ever with one of them.
    while by.of_any(&members) < LIKELY {
        let gain = |other: &usize| {
            let alone = by.of_any(&[*other]);
            let stands_in = alone > RARE && by.of_both(*other, &members) < TOGETHER * alone;
            let more = by.of_any(&[members.as_slice(), &[*other]].concat()) - by.of_any(&members);
            (stands_in && more > RARE).then_some((more, *other))
        };
        let others = all.clone().filter(|other| !members.contains(other) && !of_best.contains(other));
        let Some((_, other)) = others.filter_map(|other| gain(&other)).max_by(|a, b| a.0.total_cmp(&b.0)) else {
            break;
        };
        members.push(other);
    }
    let probability = by.of_any(&members);
    let mut members: Vec<(usize, f64)> = members.into_iter().map(|of| (of, by.of_any(&[of]))).collect();
    members[1..].sort_by(|a, b| b.1.total_cmp(&a.1));
    Class { form, members, probability }
}
