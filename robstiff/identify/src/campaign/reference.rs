//! Rows of the unloaded reading itself. Many tables begin each visit with one: no load and,
//! since a displacement is loaded less unloaded, none of that, to the last digit. It is no
//! reading that could be off by noise, and would pass for one without any.

use std::format;
use std::string::String;

use super::Observation;

/// Whether a row is the unloaded reading itself. One with angles of its own, by encoders or
/// motors, is not: it says where these stand without a load.
pub fn is_reference(row: &Observation) -> bool {
    let has_own = |angles: &Option<std::vec::Vec<f64>>| angles.as_ref().is_some_and(|angles| *angles != row.q);
    let is_zero = |numbers: &[f64]| numbers.iter().all(|number| *number == 0.0);
    is_zero(&row.wrench)
        && is_zero(&row.displacement)
        && row.rotation.is_none_or(|rotation| is_zero(&rotation))
        && !has_own(&row.encoders)
        && !has_own(&row.motors)
}

/// What is said of such rows, by their lines, if there are any.
pub fn said(mut lines: impl ExactSizeIterator<Item = usize>) -> Option<String> {
    let first = lines.next()?;
    let more = match lines.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    Some(format!("line {first}{more}: no load and no displacement, which is the unloaded reading itself; left out"))
}
