//! Whether what is read is elsewhere on the tool than the campaign says.
//!
//! A displacement shows that only where the tool turns. What turns it are the same joints whose
//! lengths and zeros, with a lever of the load, come to nearly the same; and a search that has it
//! among its candidates from the beginning takes it early, for what several of them do together,
//! and does not come back from there, for it replaces one effect at a time. So it is no candidate
//! at first. Where structure is left, or what it may be told as is named, the search is gone
//! through once more with it, and it is told if that leaves less: no structure where the
//! other leaves some, else what is better by the criterion of Schwarz, with odds of 20 to 1, and
//! has fewer numbers or predicts poses that are left out no worse, or as good with fewer names.
//! Where the criterion does not tell them apart, the other is a rival of the one that is told.

use std::format;
use std::string::String;

use super::alias::Rival;
use super::bench::Bench;
use super::catalogue::{DH_ERROR, JOINT_ZERO_OFFSET, Kind, LEVER_ARM, REFLECTOR_OFFSET, TOOL_COMPLIANCE};
use super::model::{LeftOut, Named};
use super::search::Outcome;
use super::selection::WITHIN_REACH;
use super::step::Step;
use super::{Options, Progress, Verdict, displacements};
use crate::campaign::Campaign;
use crate::identify::prepare::Prepared;
use crate::identify::problem::rms;

/// What moves the tool's end, or the load on it, as a reflector elsewhere seems to.
static TOLD_AS: [&Kind; 4] = [&LEVER_ARM, &TOOL_COMPLIANCE, &JOINT_ZERO_OFFSET, &DH_ERROR];

/// What a campaign of displacements shows: the bench that it was found on, and what was.
///
/// # Errors
/// Why not even the description's own numbers can be fitted.
pub fn searched<'c>(
    campaign: &'c Campaign,
    prepared: &'c Prepared<'c>,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<(Bench<'c>, Outcome), String> {
    let (bench, mut outcome) = displacements::searched(Bench::new(campaign, prepared)?, prepared, options, progress)?;
    if outcome.verdict == Verdict::Insufficient || !may_be_it(&bench, &outcome) {
        return Ok((bench, outcome));
    }
    progress("asking whether the reflector is elsewhere");
    bench.spare_memory();
    // Its stages are those that were told before.
    let other = Bench::of(campaign, prepared, true).ok();
    let again = other.and_then(|other| displacements::searched(other, prepared, options, &|_| ()).ok());
    let names_it = |(bench, found): &(Bench<'_>, Outcome)| {
        found.selection.model.named.iter().any(|one| bench.candidates()[one.candidate].kind == &REFLECTOR_OFFSET)
    };
    let Some((other, mut found)) = again.filter(names_it) else { return Ok((bench, outcome)) };
    if !is_better((&other, &found), (&bench, &outcome)) {
        outcome.rival = rival((&other, &found), (&bench, &outcome));
        return Ok((bench, outcome));
    }
    found.rival = rival((&bench, &outcome), (&other, &found));
    let mut step = Step::bare(outcome.names(&bench));
    step.outcome = format!("anew with a reflector that may be elsewhere: named {}", found.names(&other).join(", "));
    outcome.selection.steps.push(step);
    Ok((other, found.after(outcome)))
}

/// Whether what was found may be a reflector elsewhere: something without a name, or what it is
/// told as where it has none.
fn may_be_it(bench: &Bench<'_>, outcome: &Outcome) -> bool {
    let kind = |one: &Named| bench.candidates()[one.candidate].kind;
    outcome.structure() || outcome.selection.model.named.iter().any(|one| TOLD_AS.contains(&kind(one)))
}

/// What was found, and the bench that it was found on.
type FoundOn<'s, 'c> = (&'s Bench<'c>, &'s Outcome);

/// Whether what was found with a reflector that is elsewhere accounts better for the data.
fn is_better(with: FoundOn<'_, '_>, without: FoundOn<'_, '_>) -> bool {
    let [own, other] = [with.1, without.1].map(|found| found.selection.model.named.len());
    match (with.1.structure(), without.1.structure()) {
        (false, true) => true,
        (true, false) => false,
        // Where nothing was worth a name, one that leaves structure is there for want of better.
        (true, true) if other == 0 => false,
        _ => match (with.1.bic_of_all(with.0), without.1.bic_of_all(without.0)) {
            // One fault of the rig is likelier than several of the robot that do the very same.
            (Some(new), Some(old)) if own < other && new < old + TIE => true,
            (Some(new), Some(old)) => {
                new < old - WITHIN_REACH && (is_simpler(with, without) || predicts(with, without))
            }
            _ => false,
        },
    }
}

/// Criteria closer than this are equal but for what fits are solved to.
const TIE: f64 = 1e-2;

/// What was found as a rival of what is told instead; `None` where structure tells them apart,
/// or the criterion.
fn rival(of: FoundOn<'_, '_>, told: FoundOn<'_, '_>) -> Option<Rival> {
    let bic_difference = (of.1.bic_of_all(of.0)? - told.1.bic_of_all(told.0)?).max(0.0);
    let is_near = of.1.structure() == told.1.structure() && bic_difference < WITHIN_REACH;
    is_near.then(|| Rival { names: of.1.names(of.0), bic_difference })
}

/// Whether a model has fewer numbers than another.
fn is_simpler(with: FoundOn<'_, '_>, without: FoundOn<'_, '_>) -> bool {
    let numbers = |(bench, outcome): FoundOn<'_, '_>| bench.parameters(&outcome.selection.model.named);
    numbers(with) < numbers(without)
}

/// Whether poses that are left out, each in turn, are predicted no worse, by rows that both have.
fn predicts(with: FoundOn<'_, '_>, without: FoundOn<'_, '_>) -> bool {
    let (Some(new), Some(old)) = (left_out(with.0, with.1), left_out(without.0, without.1)) else { return false };
    let both = || new.rows.iter().copied().filter(|row| old.rows.contains(row));
    let axes = with.0.prepared.samples.axes;
    rms(&new.residuals, axes, both()) <= rms(&old.residuals, axes, both())
}

/// What poses leave of fits of a model without them.
fn left_out(bench: &Bench<'_>, outcome: &Outcome) -> Option<LeftOut> {
    let model = &outcome.selection.model;
    Some(bench.at(&model.named).ok()?.left_out(&model.fit))
}
