//! Faults of the rig that stand in for lengths of the arm.
//!
//! A scale of all that is read and a reflector that is elsewhere do together nearly what two
//! lengths of an arm do, and then some number of the table what they miss. The search replaces
//! one effect at a time, and so does not come from these to the lengths: beside any of them
//! either length is worth nothing. Where a model names such a fault, the search is therefore
//! made again from the model without any; at its end they are allowed again, for one may be
//! there as well; and the better of the two models stays.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::bench::Bench;
use super::course::Course;
use super::report::parts;
use crate::trace::catalogue::{DH_ERROR, Kind, REFLECTOR_OFFSET, REFLECTOR_SLIP, THERMAL_DRIFT, TRACKER_SCALE};
use crate::trace::model::Named;
use crate::trace::selection::{BETTER, WITHIN_REACH};
use crate::trace::step::Step;
use crate::trace::{Options, Rival};

/// What moves all readings alike, or by as much along the arm or the tool.
static STAND_INS: [&Kind; 4] = [&TRACKER_SCALE, &REFLECTOR_OFFSET, &REFLECTOR_SLIP, &THERMAL_DRIFT];

/// A course held against one without what stands in for lengths: the better of them, and the
/// other where that is about as good. `goes_on` is the search from a model on.
pub fn instead_of_stand_ins<'c>(
    bench: &mut Bench<'c>,
    course: Course,
    options: &Options,
    goes_on: impl FnOnce(Course, &mut Bench<'c>) -> Course,
) -> (Course, Option<Rival>) {
    let rest: Vec<Named> = course.model.named.iter().copied().filter(|&one| !stands_in(bench, one)).collect();
    if rest.len() == course.model.named.len() || course.model.leaves_nothing() {
        return (course, None);
    }
    let found = anew(bench, &course, &rest, options, goes_on);
    let Some((wide, mut other)) = found.filter(|(wide, other)| names(wide, other) != names(bench, &course)) else {
        bench.turn_to(&course.model);
        return (course, None);
    };
    let by = other.bic_of_all(&wide) - course.bic_of_all(bench);
    let takes = by < -BETTER || (by < WITHIN_REACH && is_likelier(&wide, &other, &course));
    let loser = if takes { names(bench, &course) } else { names(&wide, &other) };
    let bic_difference = if takes { -by } else { by };
    let rival = (bic_difference < WITHIN_REACH).then_some(Rival { names: loser, bic_difference });
    if !takes {
        bench.turn_to(&course.model);
        return (course, rival);
    }
    let mut step = Step::bare(names(bench, &course));
    step.outcome = format!("anew without what stands in for lengths: named {}", names(&wide, &other).join(", "));
    other.steps.splice(0..0, course.steps.into_iter().chain([step]));
    *bench = wide;
    (other, rival)
}

/// What a search comes to from a part of a course's model, at first without what stands in for
/// lengths, on a bench of its own: moments and grids move with it.
fn anew<'c>(
    bench: &mut Bench<'c>,
    course: &Course,
    rest: &[Named],
    options: &Options,
    goes_on: impl FnOnce(Course, &mut Bench<'c>) -> Course,
) -> Option<(Bench<'c>, Course)> {
    let (mut wide, model) = bench.widened(&course.model, []);
    let barred = (0..wide.candidates.len()).filter(|&one| STAND_INS.contains(&wide.candidates[one].kind));
    let mut barred: Vec<usize> = barred.collect();
    // Some numbers of the last row are a reflector elsewhere under other names: which of the
    // two is named is not asked here.
    barred.extend(parts_of_reflector(&wide));
    wide.barred = barred;
    let start = wide.solve(rest, &model.solved.state)?;
    wide.turn_to(&start);
    let without = Course::new(start).run(&mut wide, false, options, &|_| ());
    wide.barred.clear();
    let other = goes_on(Course::new(without.model), &mut wide);
    Some((wide, other))
}

/// The candidates that say no more than a reflector that is elsewhere.
fn parts_of_reflector(bench: &Bench<'_>) -> Vec<usize> {
    let Some(candidate) = bench.candidates.iter().position(|one| one.kind == &REFLECTOR_OFFSET) else {
        return Vec::new();
    };
    let anywhere = bench.candidates[candidate].variants.len() - 1;
    parts(bench, &[], Named { candidate, variant: anywhere })
}

/// Whether an effect of a model can stand in for lengths; a drift where the arm grows.
fn stands_in(bench: &Bench<'_>, one: Named) -> bool {
    let kind = bench.candidates[one.candidate].kind;
    let grows = || bench.numbers_of(one).any(|number| number.name == "expansion");
    STAND_INS.contains(&kind) && (kind != &THERMAL_DRIFT || grows())
}

/// Whether a model says by lengths of the arm alone, with no more numbers, what another says by
/// a scale beside lengths. A table is as exact as an arm was built, to some tenths of a
/// millimetre, a tracker's scale to some millionths, hundredths of that much; and where one
/// length is off, another one is no wonder. So where the positions do not tell, it is the length.
fn is_likelier(bench: &Bench<'_>, other: &Course, course: &Course) -> bool {
    let kind = |one: &Named| bench.candidates[one.candidate].kind;
    let has_scale = |course: &Course| course.model.named.iter().any(|one| kind(one) == &TRACKER_SCALE);
    let is_length = |one: &Named| kind(one) == &DH_ERROR && bench.numbers_of(*one).all(|number| number.unit == "m");
    let has_length = |course: &Course| course.model.named.iter().any(is_length);
    has_scale(course)
        && !has_scale(other)
        && has_length(course)
        && has_length(other)
        && bench.parameters(&other.model.named) <= bench.parameters(&course.model.named)
}

/// The full names of a course's effects.
fn names(bench: &Bench<'_>, course: &Course) -> Vec<String> {
    course.model.named.iter().map(|one| bench.candidates[one.candidate].name()).collect()
}
