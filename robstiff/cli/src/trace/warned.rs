//! What looks wrong with the files that a tracing is of.

use robstiff_identify::campaign::Campaign;
use robstiff_identify::identify::{Error, identify, misread, off_by_one_factor};
use robstiff_identify::trace::{Trace, Verdict};

use super::wording::sentence;

/// What looks wrong, a sentence each: by the joints alone, for what an effect changes in them is no unit.
pub fn warnings(trace: &Trace, campaign: &Campaign) -> Vec<String> {
    let mut found = match identify(campaign) {
        Ok(found) => found,
        Err(error @ (Error::AgainstTheLoads(_) | Error::OtherUnit(_))) => return vec![sentence(&error.to_string())],
        Err(_) => return Vec::new(),
    };
    let other_unit = off_by_one_factor(campaign, &found.estimates);
    // A mistake in the files leaves far less than the best model does.
    found.rms = found.rms.map(|rms| rms.min(trace.after.rms));
    let is_open = !matches!(trace.verdict, Verdict::Adequate | Verdict::Explained);
    let misread = if is_open { misread(campaign, &found) } else { None };
    other_unit.into_iter().chain(misread).collect()
}
