//! Whether the files say something else than what was measured ([`misread`](crate::identify::misread)),
//! where structure is left or names are those that such files get.

use std::string::String;
use std::vec::Vec;

use super::Options;
use super::bench::Bench;
use super::catalogue::TRANSMISSION_ERROR;
use super::displacements::too_little;
use super::model::{Fitted, Named};
use super::search::{Outcome, left_by};
use super::step::Step;
use super::verdict::{self, Besides, Verdict};
use crate::campaign::Campaign;
use crate::identify::misread::{ALIKE, FAR_LESS, Misread, in_displacements};
use crate::identify::prepare::Prepared;
use crate::identify::problem::rms;
use crate::words::micrometres;

/// What is told of a campaign of displacements in another unit than its files say, which
/// identification refuses: nothing of the arm, and why. `None` where that is not so.
pub fn in_other_unit<'c>(
    campaign: &'c Campaign,
    prepared: &'c Prepared<'c>,
) -> Option<Result<(Bench<'c>, Outcome), String>> {
    let why = crate::identify::in_other_unit(campaign)?;
    let found = Bench::new(campaign, prepared).and_then(|bench| {
        let base = bench.fit(&[])?;
        Ok((bench, Outcome::nothing(base, Verdict::Insufficient, why)))
    });
    Some(found)
}

/// What was found, unless the files say something else than what was measured: then nothing that
/// could be told of the arm, and why. Where the joints alone leave far less with a mistake undone
/// than they do as the files are, and the best model only clearly more, the arm may lack something
/// besides: then what the joints alone leave is told to look like it, and no name stands.
///
/// # Errors
/// Why not even the description's own numbers can be fitted.
pub fn unless(bench: &Bench<'_>, outcome: Outcome, options: &Options) -> Result<Outcome, String> {
    if !may_be(bench, &outcome)? {
        return Ok(outcome);
    }
    let is_kept = |row: usize| bench.is_fitted_to(row) && !bench.left_out[row];
    let (data, axes) = (bench.prepared.data, bench.prepared.samples.axes);
    let left_by = |model: &Fitted| -> Result<f64, String> {
        let residuals = bench.at(&model.named)?.residuals(&model.fit);
        Ok(rms(&residuals, axes, (0..data.rows.len()).filter(|&row| is_kept(row))))
    };
    let left = left_by(&outcome.selection.model)?;
    let with_part = |part: f64| in_displacements(bench.robot(), data, is_kept, left, part);
    let why = |misread: &Misread| {
        std::format!(
            "the files may say something else than what was measured: {} by the joints alone, and as the files are {} by \
             the best model",
            misread.said(),
            micrometres(left)
        )
    };
    let base = bench.fit(&[])?;
    // A wave can make one angle of another, and takes numbers for it.
    let part = if names_wave(bench, &outcome) { ALIKE } else { FAR_LESS };
    if let Some(misread) = with_part(part) {
        let why = match outcome.verdict {
            // That readings do not follow the loads is true as well.
            Verdict::Insufficient => std::format!("{}; {}", outcome.why, why(&misread)),
            _ => why(&misread),
        };
        let mut found = Outcome::nothing(base, Verdict::Insufficient, why);
        (found.looks_like, found.misread) = (misread.mistakes, true);
        return Ok(found.after(outcome));
    }
    let wider = (FAR_LESS * (left_by(&base)? / left).powi(2)).min(ALIKE.recip());
    match (part < wider).then(|| with_part(wider)).flatten() {
        Some(misread) => {
            let why = why(&misread);
            without_names(bench, (base, outcome), (misread.mistakes, why), options)
        }
        None => Ok(outcome),
    }
}

/// What the joints alone leave, told to look like mistakes, with the names taken back that were
/// found.
fn without_names(
    bench: &Bench<'_>,
    (base, mut before): (Fitted, Outcome),
    (mistakes, why): (Vec<String>, String),
    options: &Options,
) -> Result<Outcome, String> {
    let taken_back = before.names(bench);
    let mut left = left_by(bench, bench.prepared, &base, options)?;
    left.structure = true;
    let mut step = Step::bare(Vec::new());
    step.outcome = std::format!("{} taken back for what the files may say", taken_back.join(", "));
    before.selection.steps.push(step);
    let events = core::mem::take(&mut before.events);
    let mut found = Outcome::nothing(base, Verdict::Unexplained, String::new());
    let besides = Besides { isolated: events.len(), looks_like: &mistakes, ..Besides::default() };
    (found.verdict, _) = verdict::judge(&found.selection, &left, &besides);
    found.why = std::format!("{why}; in its place had fitted {}", taken_back.join(", "));
    (found.left, found.events, found.looks_like, found.misread) = (Some(left), events, mistakes, true);
    Ok(found.after(before))
}

/// Whether something is the matter that enough was measured to ask about.
fn may_be(bench: &Bench<'_>, outcome: &Outcome) -> Result<bool, String> {
    let is_found = outcome.structure() || outcome.verdict == Verdict::Insufficient || names_wave(bench, outcome);
    Ok(is_found && too_little(&*bench.at(&[])?).is_none())
}

fn names_wave(bench: &Bench<'_>, outcome: &Outcome) -> bool {
    let is_wave = |one: &Named| *bench.candidates()[one.candidate].kind == TRANSMISSION_ERROR;
    outcome.selection.model.named.iter().any(is_wave)
}
