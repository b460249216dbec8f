//! Whether the files say something else than what was measured ([`misread`](crate::identify::misread)),
//! where structure is left or names are those that such files get.

use std::string::String;

use super::bench::Bench;
use super::catalogue::TRANSMISSION_ERROR;
use super::model::Named;
use super::search::Outcome;
use super::too_little;
use super::verdict::Verdict;
use crate::campaign::Campaign;
use crate::identify::misread::{ALIKE, FAR_LESS, in_displacements};
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
/// could be told of the arm, and why.
///
/// # Errors
/// Why not even the description's own numbers can be fitted.
pub fn unless(bench: &Bench<'_>, outcome: Outcome) -> Result<Outcome, String> {
    if !may_be(bench, &outcome)? {
        return Ok(outcome);
    }
    let model = &outcome.selection.model;
    let residuals = bench.at(&model.named)?.residuals(&model.fit);
    let is_kept = |row: usize| bench.is_fitted_to(row) && !bench.left_out[row];
    let (data, axes) = (bench.prepared.data, bench.prepared.samples.axes);
    let left = rms(&residuals, axes, (0..data.rows.len()).filter(|&row| is_kept(row)));
    // A wave can make one angle of another, and takes numbers for it.
    let part = if names_wave(bench, &outcome) { ALIKE } else { FAR_LESS };
    let Some(misread) = in_displacements(bench.robot(), data, is_kept, left, part) else { return Ok(outcome) };
    let mut why = std::format!(
        "the files may say something else than what was measured: {} by the joints alone, and as the files are {} by the \
         best model",
        misread.said(),
        micrometres(left)
    );
    if outcome.verdict == Verdict::Insufficient {
        // That readings do not follow the loads is true as well.
        why = std::format!("{}; {why}", outcome.why);
    }
    let mut found = Outcome::nothing(bench.fit(&[])?, Verdict::Insufficient, why);
    found.looks_like = misread.mistakes;
    Ok(found.after(outcome))
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
