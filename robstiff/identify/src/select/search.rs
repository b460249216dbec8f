//! Sets of forms by adding, dropping, swapping and changing.

use std::collections::HashMap;

use super::{Problem, Set};
use crate::select::problem::Judged;

/// How widely to search.
#[derive(Clone, Copy, Debug)]
pub struct Width {
    /// How many sets of each size are carried on.
    pub beam: usize,
    /// How many changes of each are judged.
    pub top: usize,
    /// How many effects a set has at most.
    pub most: usize,
}

impl Width {
    /// Of a search whose result counts.
    pub const WIDE: Self = Self { beam: 6, top: 12, most: 6 };
    /// Of one that only says where to linearise.
    pub const FIRST: Self = Self { beam: 2, top: 6, most: 6 };
    /// Of one that is repeated without some poses.
    pub const FOLD: Self = Self { beam: 3, top: 8, most: 6 };
    /// Where scales are learned, and an arm deviates in many small ways.
    pub const LEARNED: Self = Self { beam: 1, top: 8, most: 25 };
}

/// The sets that were judged.
#[derive(Clone, Debug, Default)]
pub struct Visited {
    /// Each with how good it is.
    pub sets: HashMap<Set, Judged>,
}

impl Visited {
    /// The best set; the empty one where none was judged.
    pub fn best(&self) -> Set {
        self.ranked().first().map(|(set, _)| (*set).clone()).unwrap_or_default()
    }

    /// All sets, the best first.
    pub fn ranked(&self) -> Vec<(&Set, &Judged)> {
        let mut ranked: Vec<(&Set, &Judged)> = self.sets.iter().collect();
        ranked.sort_by(|a, b| b.1.score.total_cmp(&a.1.score).then_with(|| a.0.cmp(b.0)));
        ranked
    }

    /// The probability of each set among all that were judged, the likeliest first.
    pub fn posterior(&self) -> Vec<(&Set, f64)> {
        let ranked = self.ranked();
        let Some(best) = ranked.first().map(|(_, judged)| judged.score) else { return Vec::new() };
        let sum: f64 = ranked.iter().map(|(_, judged)| (judged.score - best).exp()).sum();
        ranked.into_iter().map(|(set, judged)| (set, (judged.score - best).exp() / sum)).collect()
    }
}

/// Searches, with some set to begin with beside the empty one.
pub fn search(problem: &mut Problem<'_>, start: &Set, width: Width) -> Visited {
    let mut visited = Visited::default();
    judge(problem, &mut visited, Set::new());
    judge(problem, &mut visited, start.clone());
    for k in 0..start.len() {
        if !problem.learns() {
            judge(problem, &mut visited, without(start, k));
        }
    }
    if width.beam > 1 {
        grow(problem, &mut visited, width);
    }
    improve(problem, &mut visited, width);
    visited
}

/// Judges a set, once.
fn judge(problem: &Problem<'_>, visited: &mut Visited, set: Set) -> f64 {
    if let Some(known) = visited.sets.get(&set) {
        return known.score;
    }
    match problem.judge(&set) {
        Some(judged) => {
            visited.sets.insert(set, judged);
            judged.score
        }
        None => f64::NEG_INFINITY,
    }
}

/// Carries the best sets of each size on by one form.
fn grow(problem: &Problem<'_>, visited: &mut Visited, width: Width) {
    let mut front = vec![Set::new()];
    for size in 1..=width.most {
        for set in front {
            let own = visited.sets.get(&set).map_or(0, |judged| judged.kappa);
            // With a form more, less is left for a discrepancy.
            let mut kappas = vec![own, own.saturating_sub(1), 0];
            kappas.dedup();
            for kappa in kappas {
                for (_, form) in problem.additions(&set, kappa).into_iter().take(width.top) {
                    judge(problem, visited, with(&set, form));
                }
            }
        }
        front = best_of_size(problem, visited, size, width.beam);
        if front.is_empty() || size >= visited.best().len() + 2 {
            return;
        }
    }
}

/// The best sets of a size, one for the same candidates.
fn best_of_size(problem: &Problem<'_>, visited: &Visited, size: usize, count: usize) -> Vec<Set> {
    let mut known: Vec<Vec<usize>> = Vec::new();
    let mut best = Vec::new();
    for (set, _) in visited.ranked().into_iter().filter(|(set, _)| set.len() == size) {
        let candidates = candidates_of(problem, set);
        if !known.contains(&candidates) {
            known.push(candidates);
            best.push(set.clone());
        }
        if best.len() == count {
            break;
        }
    }
    best
}

/// The candidates of a set, in ascending order.
pub fn candidates_of(problem: &Problem<'_>, set: &[usize]) -> Vec<usize> {
    let mut of: Vec<usize> = set.iter().map(|&form| problem.layout.forms[form].candidate).collect();
    of.sort_unstable();
    of
}

/// Adds, drops, swaps and changes forms of the best set until nothing makes it better.
fn improve(problem: &mut Problem<'_>, visited: &mut Visited, width: Width) {
    // With scales that are learned again, a set may look better that was given up before.
    let mut left: Vec<Set> = Vec::new();
    let mut turned = !problem.learns();
    let mut best = visited.best();
    loop {
        if problem.learns() {
            learn(problem, visited, &best);
        }
        let kappa = visited.sets.get(&best).map_or(0, |judged| judged.kappa);
        let mut near: Vec<Set> = Vec::new();
        if best.len() < width.most {
            near = problem
                .additions(&best, kappa)
                .into_iter()
                .take(width.top)
                .map(|(_, form)| with(&best, form))
                .collect();
        }
        let mut next = better(problem, visited, &best, near, &left);
        if next.is_none() {
            next = better(problem, visited, &best, changes(problem, &best, kappa, width.top), &left);
        }
        if next.is_none() && !turned {
            turned = true;
            if let Some(set) = from_small_block(problem, &best) {
                visited.sets.clear();
                next = Some(set);
            }
        }
        let Some(next) = next else { return };
        left.push(core::mem::replace(&mut best, next));
    }
}

/// The best of some sets that is better than one, but those that were given up before.
fn better(problem: &Problem<'_>, visited: &mut Visited, than: &Set, sets: Vec<Set>, left: &[Set]) -> Option<Set> {
    let least = judge(problem, visited, than.clone()) + LEAST_BETTER;
    let judged =
        sets.into_iter().filter(|set| !left.contains(set)).map(|set| (judge(problem, visited, set.clone()), set));
    let best = judged.max_by(|a, b| a.0.total_cmp(&b.0).then_with(|| b.1.cmp(&a.1)));
    best.filter(|(score, _)| *score > least).map(|(_, set)| set)
}

/// A set that is better by less is not another one.
const LEAST_BETTER: f64 = 1e-6;

/// Rounds of learning beside each step of a search.
const ROUNDS: usize = 2;

/// Learns the noise and the scales with a set. What was judged with others is no longer comparable, and
/// is judged again.
fn learn(problem: &mut Problem<'_>, visited: &mut Visited, best: &Set) {
    problem.learn(best, ROUNDS);
    let known: Vec<Set> = visited.ranked().into_iter().take(KEPT).map(|(set, _)| set.clone()).collect();
    visited.sets.clear();
    for set in known.into_iter().chain([best.clone(), Set::new()]) {
        judge(problem, visited, set);
    }
}

/// So many sets are judged again.
const KEPT: usize = 40;

/// A better set where the block without a name is small: its scale has two optima, one where it says
/// what effects could say, and one where it does not.
fn from_small_block(problem: &mut Problem<'_>, best: &Set) -> Option<Set> {
    let small = problem.small_block()?;
    let now = problem.start.1.clone();
    let before = problem.learned(best, &now, FULL)?;
    let forms = problem.small_additions(best, &small)?;
    let sets = forms.into_iter().take(TURNED).map(|form| with(best, form)).chain([best.clone()]);
    let found = sets.filter_map(|set| Some((problem.learned(&set, &small, FULL)?, set)));
    let ((score, fit), set) = found.max_by(|a, b| a.0.0.total_cmp(&b.0.0))?;
    if score < before.0 + WORTH_IT {
        return None;
    }
    problem.begin_at(&fit);
    Some(set)
}

/// So many additions are tried at the other optimum.
const TURNED: usize = 2;

/// Rounds until scales are learned, and by how much another optimum must be better.
const FULL: usize = 8;
const WORTH_IT: f64 = 0.1;

/// The sets with a form of a set dropped, swapped for another, or in another form.
fn changes(problem: &Problem<'_>, set: &Set, kappa: usize, top: usize) -> Vec<Set> {
    let mut found: Vec<Set> = Vec::new();
    for k in 0..set.len() {
        let rest = without(set, k);
        let swaps = problem.additions(&rest, kappa).into_iter().take(2 * top).map(|(_, form)| form);
        let near: Vec<usize> = swaps.chain(problem.other_forms(set[k]).take(2 * top)).collect();
        found.extend(near.into_iter().map(|form| with(&rest, form)).filter(|changed| changed != set));
        found.push(rest);
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// A set without one of its forms, by its place.
pub fn without(set: &[usize], place: usize) -> Set {
    set.iter().enumerate().filter(|(k, _)| *k != place).map(|(_, form)| *form).collect()
}

/// A set with one form more.
pub fn with(set: &[usize], form: usize) -> Set {
    let mut with = set.to_vec();
    with.push(form);
    with.sort_unstable();
    with
}
