//! What looks wrong with the files that a tracing is of.

use robstiff_identify::campaign::Campaign;
use robstiff_identify::identify::{Error, Misread, identify, misread, off_by_one_factor};
use robstiff_identify::trace::{Trace, Verdict};

use super::wording::sentence;

/// What looks wrong, a sentence each: by the joints alone, for what an effect changes in them is no unit.
pub fn warnings(trace: &Trace, campaign: &Campaign) -> Vec<String> {
    let found = match identify(campaign) {
        Ok(found) => found,
        Err(error @ (Error::AgainstTheLoads(_) | Error::OtherUnit(_))) => return vec![sentence(&error.to_string())],
        Err(_) => return Vec::new(),
    };
    let other_unit = off_by_one_factor(campaign, &found.estimates);
    let is_open = !matches!(trace.verdict, Verdict::Adequate | Verdict::Explained);
    // A mistake in the files, undone, leaves the joints alone less than all effects leave of the files as they are.
    let is_less = |misread: &Misread| misread.left < trace.after.rms;
    let misread = if is_open { misread(campaign, &found).filter(is_less) } else { None };
    let misread = misread.map(|misread| misread.sentence(trace.after.rms));
    other_unit.into_iter().chain(misread).collect()
}
