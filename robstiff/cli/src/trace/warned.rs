//! What looks wrong with the files that a tracing is of.

use robstiff_identify::campaign::Campaign;
use robstiff_identify::identify::{ALL_JOINTS, noise_not_used, off_by_one_factor};
use robstiff_identify::trace::Trace;

/// What looks wrong, a sentence each.
pub fn warnings(trace: &Trace, campaign: &Campaign) -> Vec<String> {
    // Of the joints alone: what an effect changes in them is no unit.
    let other_unit = off_by_one_factor(campaign, &trace.estimates_before);
    let noise = noise_not_used(campaign, (trace.noise, trace.noise_source));
    other_unit.into_iter().chain(noise).collect()
}

/// The same but for a unit that is why nothing was told.
pub fn besides(trace: &Trace, campaign: &Campaign) -> impl Iterator<Item = String> {
    let is_why = trace.why.contains(ALL_JOINTS);
    warnings(trace, campaign).into_iter().filter(move |said| !(is_why && said.to_lowercase().starts_with(ALL_JOINTS)))
}
