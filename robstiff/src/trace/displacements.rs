//! Tracing of displacements: the whole of a search, and what it is held against.

use std::format;
use std::string::String;

use super::bench::Bench;
use super::model::{Fitted, Setting};
use super::report::report;
use super::search::{Outcome, search};
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
    better.map_or_else(|| report(campaign, &prepared, &bench, &outcome, options), Ok)
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
    let mut bench = Bench::new(campaign, prepared)?;
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
    if let Some(model) = bench.tried(&outcome.selection.model.named, Bench::hold_lost) {
        outcome.selection.model = model;
    }
    outcome.judge_by_held_out(&bench, options)?;
    progress("asking what could be mistaken for what");
    Ok((bench, outcome))
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
