//! Is what is missing something that has no name, and not what was named?
//!
//! As of [displacements](crate::trace::beyond): the search goes on among more, the catalogue
//! and what has [no name](super::nameless), from where one such thing stands beside what was
//! named, or in place of some of it. If it comes to a model with something nameless in it,
//! admitted by the same tests, and no structure is left, the names in that model are the true
//! ones. Where no structure had been left, that model must also take a name's place, and be
//! better by the criterion and not for being simpler alone.

use std::string::String;
use std::vec::Vec;

use super::bench::{Bench, Model, Proposed};
use super::course::Course;
use super::nameless::{OF, again, is_nameless, middle, offers, reach};
use super::proposals::refitted;
use super::weight::{SAG, WEIGHT};
use crate::campaign::Campaign;
use crate::identify::positions::regression::STANDS;
use crate::trace::beyond::AKAIKE;
use crate::trace::catalogue::JOINT_ZERO_OFFSET;
use crate::trace::found::Found;
use crate::trace::model::{Named, all_but};
use crate::trace::selection::WITHIN_REACH;
use crate::trace::slip::Slipping;
use crate::trace::step::Step;

/// A course that came to something nameless, told without it.
pub struct Beyond<'c> {
    /// The bench without what has no name.
    pub bench: Bench<'c>,
    /// The effects that have a name, fitted without the rest; as they were tested with it.
    pub course: Course,
    /// What there is besides, each as a noun for a sentence.
    pub looks_like: Vec<String>,
}

/// Holds what a course came to against what has no name; `goes_on` is the search from a
/// model on.
pub fn search<'c>(
    campaign: &Campaign,
    bench: &mut Bench<'c>,
    course: &Course,
    goes_on: impl FnOnce(Course, &mut Bench<'c>) -> Course,
) -> Option<Beyond<'c>> {
    let unsaid = course.left.structure || course.unnamed;
    if course.model.leaves_nothing() || (!unsaid && course.model.named.is_empty()) {
        return None;
    }
    let found = among_more(campaign, bench, course, unsaid, goes_on);
    if found.is_none() {
        bench.turn_to(&course.model);
    }
    found
}

/// The same, where there is something to hold against; `unsaid` is whether something is left.
fn among_more<'c>(
    campaign: &Campaign,
    bench: &mut Bench<'c>,
    course: &Course,
    unsaid: bool,
    goes_on: impl FnOnce(Course, &mut Bench<'c>) -> Course,
) -> Option<Beyond<'c>> {
    let slipped = |slipping: Slipping| {
        let mut named = course.model.named.iter().map(|one| &bench.candidates[one.candidate]);
        named.any(|candidate| candidate.slipping() == Some(slipping))
            || course.taken_back.iter().any(|name| name.starts_with(slipping.kind().name))
    };
    let nameless = offers(&campaign.robot, bench.prepared.data, &bench.rig, slipped);
    let (mut wide, model) = bench.widened(&course.model, nameless);
    let start = refitted(&wide, &seeds(&wide, &model), &model).into_iter().next()?;
    if start.bic > model.bic - WITHIN_REACH {
        return None;
    }
    wide.turn_to(&start);
    let found = goes_on(Course::new(start), &mut wide);
    let mut kinds = found.model.named.iter().map(|one| &wide.candidates[one.candidate]);
    let has_nameless = kinds.clone().any(is_nameless);
    // One slip has a name.
    let first = |slipping: Slipping| {
        found.model.named.iter().any(|one| wide.candidates[one.candidate].slipping() == Some(slipping))
    };
    let is_told = kinds.all(|candidate| again(candidate).is_none_or(first));
    if !has_nameless || !is_told || found.left.structure || found.unnamed {
        return None;
    }
    let (nameless, named) = told(campaign, &wide, &found.model);
    // Weight in place of a sag is the sag, told by what is not its name.
    let hangs = |one: &Named| wide.candidates[one.candidate].kind == &WEIGHT;
    let is_lost = |name: &String| name != SAG || !nameless.iter().any(hangs);
    let loses = names_lost(&wide, course, &named).iter().any(is_lost);
    if !(unsaid || loses && is_better(&wide, &found.model, &model)) {
        return None;
    }
    without_nameless(wide, (bench.candidates.len(), course), found, (&nameless, &named))
}

/// Models with one thing without a name beside what a model names, or in place of one or all
/// of it, and without what that makes needless, the best first.
fn seeds(wide: &Bench<'_>, model: &Model) -> Vec<Proposed> {
    let mut rests: Vec<Vec<Named>> = (0..model.named.len()).map(|k| all_but(&model.named, k)).collect();
    rests.extend([model.named.clone(), Vec::new()]);
    let nameless = |candidate: &usize| is_nameless(&wide.candidates[*candidate]);
    let with = |rest: &Vec<Named>| -> Vec<Proposed> {
        let candidates = (0..wide.candidates.len()).filter(nameless);
        candidates.filter_map(|candidate| wide.with(rest, candidate)).map(|one| wide.pruned(one)).collect()
    };
    let mut seeds: Vec<Proposed> = rests.iter().flat_map(with).collect();
    seeds.retain(|seed| seed.named.iter().any(|one| nameless(&one.candidate)));
    seeds.sort_by(|a, b| a.bic.total_cmp(&b.bic));
    seeds.dedup_by(|a, b| a.named == b.named);
    seeds
}

/// Whether a model with something nameless is better than one without, on its own rows.
fn is_better(wide: &Bench<'_>, other: &Model, model: &Model) -> bool {
    let Some(model) = wide.solve(&model.named, &model.solved.state) else { return true };
    let (fit, solved) = (&model.solved.fit, &other.solved.fit);
    // What is told by many numbers can be like it without being it.
    let saved = wide.parameters(&model.named).saturating_sub(wide.parameters(&other.named)) as f64;
    let price = AKAIKE * model.solved.problem.variance(fit);
    other.bic < model.bic - WITHIN_REACH && solved.rss < fit.rss + price * saved
}

/// What is nameless in a model, and the rest without zeros that are where something nameless
/// counts from.
fn told(campaign: &Campaign, wide: &Bench<'_>, model: &Model) -> (Vec<Named>, Vec<Named>) {
    let (robot, data) = (&campaign.robot, wide.prepared.data);
    let (nameless, mut named): (Vec<Named>, Vec<Named>) =
        model.named.iter().partition(|one| is_nameless(&wide.candidates[one.candidate]));
    let value = |one: Named| model.solved.state.values[wide.variant(one).columns[0] - STANDS].abs();
    let counts_from = |zero: Named, one: Named| {
        let shape = &wide.variant(one).shape;
        let Some(of) = shape.iter().find(|mark| mark.name == OF).map(|mark| mark.value as usize) else { return false };
        wide.candidates[one.candidate].place == wide.candidates[zero.candidate].place
            && middle(data, of).is_some()
            && value(zero) <= value(one) * reach(robot, data, of)
    };
    named.retain(|&zero| {
        let is_zero = wide.candidates[zero.candidate].kind == &JOINT_ZERO_OFFSET;
        !(is_zero && nameless.iter().any(|&one| counts_from(zero, one)))
    });
    (nameless, named)
}

/// Full names of a course, those taken back among them, that are not among others.
fn names_lost(wide: &Bench<'_>, course: &Course, named: &[Named]) -> Vec<String> {
    let names =
        |named: &[Named]| -> Vec<String> { named.iter().map(|one| wide.candidates[one.candidate].name()).collect() };
    let (kept, mut lost) = (names(named), names(&course.model.named));
    lost.extend(course.taken_back.iter().cloned());
    lost.retain(|name| !kept.contains(name));
    lost
}

/// A course told without what has no name in it, which had begun from another with so many
/// candidates.
fn without_nameless<'c>(
    wide: Bench<'c>,
    (candidates, before): (usize, &Course),
    found: Course,
    (nameless, named): (&[Named], &[Named]),
) -> Option<Beyond<'c>> {
    let words = |one: &Named| {
        let candidate = &wide.candidates[one.candidate];
        Found::new(candidate.kind, candidate.place, wide.variant(*one).shape.clone()).words()
    };
    let looks_like: Vec<String> = nameless.iter().map(words).collect();
    let p_value = |one: &Named| {
        let at = found.model.named.iter().position(|other| other == one);
        at.map_or(1.0, |at| found.p_values[at])
    };
    let (mut bench, state) = wide.narrowed(candidates, &found.model.solved.state);
    // What is possible only beside something nameless is not told, but that it is taken back.
    let (named, model) = match bench.solve(named, &state) {
        Some(model) => (named, model),
        None => (&[][..], bench.solve(&[], &state)?),
    };
    bench.turn_to(&model);
    let lost = names_lost(&bench, before, named);
    let names = named.iter().map(|one| bench.candidates[one.candidate].name()).collect();
    let mut steps = before.steps.clone();
    steps.push(Step::beside_nameless(names, &looks_like));
    let p_values = named.iter().map(p_value).collect();
    Some(Beyond { bench, course: Course { model, p_values, steps, taken_back: lost, ..found }, looks_like })
}
