//! Tracing of displacements: the whole of a search, and what it is held against.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::alias::{Rival, swaps};
use super::bench::Bench;
use super::catalogue::REFLECTOR_OFFSET;
use super::model::{Fitted, Named, Setting};
use super::report::report;
use super::search::{Outcome, search};
use super::selection::WITHIN_REACH;
use super::step::Step;
use super::verdict::{self, Verdict};
use super::{Options, Progress, Trace, follows, misread, overlooked, preload};
use crate::campaign::Campaign;
use crate::identify::prepare::Prepared;
use crate::identify::{AGAINST_THE_LOADS, Error};
use crate::words::count;

/// Traces a campaign of displacements.
///
/// # Errors
/// A campaign that shows none of the robot's compliances, or whose description could not be read
/// back with what was found.
pub fn trace(campaign: &Campaign, options: &Options, progress: &Progress<'_>) -> Result<Trace, Error> {
    progress("identifying the joints");
    let prepared = Prepared::new(campaign)?;
    let in_other_unit = misread::in_other_unit(campaign, &prepared);
    let searched = in_other_unit.unwrap_or_else(|| of_campaign(campaign, &prepared, options, progress));
    let (bench, outcome) = searched.map_err(Error::NotShown)?;
    let outcome = misread::unless(&bench, outcome, options).map_err(Error::NotShown)?;
    let found = overlooked::instead((bench, outcome), &prepared, options);
    let (bench, outcome) = found.map_err(Error::NotShown)?;
    let preloaded = preload::worth_a_try(campaign, &outcome);
    let better = preloaded.and_then(|preloaded| {
        progress("asking whether gears carry the arm's own weight");
        bench.spare_memory();
        preload::better(&preloaded, (&bench, &outcome), options)
    });
    match better {
        Some(better) => Ok(better),
        None => report(campaign, &prepared, &bench, outcome, options),
    }
}

/// What a campaign of displacements shows: the bench that it was found on, and what was.
///
/// # Errors
/// Why not even the description's own numbers can be fitted.
pub fn of_campaign<'c>(
    campaign: &'c Campaign,
    prepared: &'c Prepared<'c>,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<(Bench<'c>, Outcome), String> {
    let (bench, mut outcome) = of_bench(Bench::new(campaign, prepared)?, prepared, options, progress)?;
    let is_named = |one: &Named| bench.candidates()[one.candidate].kind == &REFLECTOR_OFFSET;
    if !outcome.selection.model.named.iter().any(is_named) {
        return Ok((bench, outcome));
    }
    progress("searching again without a reflector that sits elsewhere");
    bench.spare_memory();
    // Its stages are those that were told before.
    let without = Bench::of(campaign, prepared, false).and_then(|on| of_bench(on, prepared, options, &|_| ())).ok();
    let other = without.as_ref().and_then(|without| searched_on(campaign, prepared, without, options));
    Ok(match other.filter(|other| is_better((&other.0, &other.1), (&bench, &outcome))) {
        Some((on, mut found)) => {
            found.rival = rival((&bench, &outcome), (&on, &found));
            let mut step = Step::bare(outcome.names(&bench));
            step.outcome = format!("without the reflector first: named {}", found.names(&on).join(", "));
            outcome.selection.steps.push(step);
            (on, found.after(outcome))
        }
        None => {
            // What several others do together is no swap of one name.
            let near = without.and_then(|(on, found)| rival((&on, &found), (&bench, &outcome)));
            outcome.rival = outcome.rival.take().or(near);
            (bench, outcome)
        }
    })
}

/// What is found from the model on that a search `without` the reflector came to, where one has it: what
/// turns the tool is much like one, so that it can be named early for what several do together, and
/// effects are replaced one at a time.
fn searched_on<'c>(
    campaign: &'c Campaign,
    prepared: &'c Prepared<'c>,
    (on, found): &(Bench<'c>, Outcome),
    options: &Options,
) -> Option<(Bench<'c>, Outcome)> {
    let bench = Bench::new(campaign, prepared).ok()?;
    let same = |one: &Named| {
        let name = on.candidates()[one.candidate].name();
        let candidate = bench.candidates().iter().position(|candidate| candidate.name() == name)?;
        Some(Named { candidate, variant: one.variant })
    };
    let mut named: Vec<Named> = found.selection.model.named.iter().map(same).collect::<Option<_>>()?;
    named.sort_unstable();
    let start = bench.fit(&named).ok()?;
    searched_from(bench, prepared, start, options, &|_| ()).ok()
}

/// What was found, and the bench that it was found on.
type FoundOn<'s, 'c> = (&'s Bench<'c>, &'s Outcome);

/// Whether one outcome accounts better for all rows than another.
fn is_better(one: FoundOn<'_, '_>, other: FoundOn<'_, '_>) -> bool {
    match (one.1.structure(), other.1.structure()) {
        (false, true) => true,
        (true, false) => false,
        _ => matches!((one.1.bic_of_all(one.0), other.1.bic_of_all(other.0)), (Some(a), Some(b)) if a < b),
    }
}

/// What was found as a rival of what is told instead; `None` where structure tells them apart, or the
/// criterion.
fn rival(of: FoundOn<'_, '_>, told: FoundOn<'_, '_>) -> Option<Rival> {
    let bic_difference = (of.1.bic_of_all(of.0)? - told.1.bic_of_all(told.0)?).max(0.0);
    let is_near = of.1.structure() == told.1.structure() && bic_difference < WITHIN_REACH;
    is_near.then(|| Rival { names: of.1.names(of.0), bic_difference })
}

/// What a campaign of displacements shows on a fresh bench.
fn of_bench<'c>(
    mut bench: Bench<'c>,
    prepared: &Prepared<'c>,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<(Bench<'c>, Outcome), String> {
    let setting = bench.at(&[])?;
    let base = setting.fit(&[])?;
    if let Some(why) = too_little(&setting).or_else(|| against_the_loads(prepared, &base)) {
        return Ok((bench, Outcome::nothing(base, Verdict::Insufficient, why)));
    }
    drop(setting);
    let base = if bench.fit_doubted()? { bench.fit(&[])? } else { base };
    searched_from(bench, prepared, base, options, progress)
}

/// The same from a model on.
///
/// # Errors
/// Why not even the description's own numbers can be fitted.
pub fn searched_from<'c>(
    mut bench: Bench<'c>,
    prepared: &Prepared<'c>,
    start: Fitted,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<(Bench<'c>, Outcome), String> {
    let mut outcome = search(&mut bench, prepared, start, options, progress)?;
    if outcome.structure() && prepared.left_out.contains(&true) {
        // Rows that the others of their pose contradict look like structure.
        bench.spare_memory();
        let again = closer(&bench, prepared, options, progress).ok();
        if let Some((closer, again)) = again.filter(|(_, again)| !again.structure()) {
            (bench, outcome) = (closer, again.after(outcome));
        }
    }
    if !outcome.structure() {
        // With structure accounted for, rows need stand out from noise alone.
        bench.strict = true;
        let before = bench.copy();
        if let Some(model) = bench.tried(&outcome.selection.model.named, Bench::look_again) {
            match search(&mut bench, prepared, model, options, progress) {
                Ok(again) => outcome = again.after(outcome),
                Err(_) => bench = before,
            }
        }
        // The same rows may be wild in another way.
        outcome.events = bench.events.to_vec();
    }
    if let Some(why) = follows::hardly(prepared, &bench, &outcome) {
        let base = bench.fit(&[])?;
        return Ok((bench, Outcome::nothing(base, Verdict::Insufficient, why).after(outcome)));
    }
    outcome = swapped(&mut bench, prepared, outcome, options, progress);
    if let Some(model) = bench.tried(&outcome.selection.model.named, Bench::hold_lost) {
        outcome.selection.model = model;
    }
    outcome.judge_by_held_out(&bench, options)?;
    progress("asking what could be mistaken for what");
    Ok((bench, outcome))
}

/// How often the search may go on from a model with one effect replaced.
const SWAPS: usize = 3;

/// Goes on from a model that has another effect in the place of one of those found, as long as that
/// accounts clearly better for all rows.
fn swapped<'c>(
    bench: &mut Bench<'c>,
    prepared: &Prepared<'c>,
    mut outcome: Outcome,
    options: &Options,
    progress: &Progress<'_>,
) -> Outcome {
    for _ in 0..SWAPS {
        let best = swaps(bench, &outcome.selection.model, &outcome.events).into_iter().next();
        let (Some(best), Some(own)) = (best, outcome.bic_of_all(bench)) else { break };
        if best.behind > -WITHIN_REACH {
            break;
        }
        let before = bench.copy();
        let again = search(bench, prepared, best.model, options, progress).ok();
        let is_better = |again: &Outcome| {
            let structure = again.structure() && !outcome.structure();
            !structure && again.bic_of_all(bench).is_some_and(|bic| bic < own - WITHIN_REACH)
        };
        let Some(again) = again.filter(is_better) else {
            *bench = before;
            break;
        };
        outcome = again.after(outcome);
    }
    outcome
}

/// What a campaign shows where rows are wild, too, that the others of their own pose contradict.
///
/// # Errors
/// Why the description's own numbers cannot be fitted without such rows.
fn closer<'c>(
    bench: &Bench<'c>,
    prepared: &Prepared<'c>,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<(Bench<'c>, Outcome), String> {
    let mut closer = bench.anew()?;
    closer.by_own_pose = true;
    closer.fit_doubted()?;
    let base = closer.fit(&[])?;
    let outcome = search(&mut closer, prepared, base, options, progress)?;
    Ok((closer, outcome))
}

/// That the readings do not follow the loads, if so: every joint they show
/// would be less than rigid. Whatever is found then, is found in readings of
/// something else, or of the wrong sign.
fn against_the_loads(prepared: &Prepared<'_>, base: &Fitted) -> Option<String> {
    prepared.is_against_the_loads(&base.fit).then(|| String::from(AGAINST_THE_LOADS))
}

/// Why a campaign cannot tell what is missing, if so.
pub fn too_little(setting: &Setting<'_>) -> Option<String> {
    let (readings, numbers) = (setting.problem.total.rows, setting.base.len());
    let of_readings = || format!("{readings} readings are too few for {}", count(numbers, "compliance"));
    verdict::too_few(setting.problem.blocks.len()).or_else(|| (readings < 2 * numbers).then(of_readings))
}
