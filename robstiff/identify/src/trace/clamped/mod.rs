//! Tracing of axes that were loaded one by one, those before each clamped: what
//! such readings can show of the catalogue.
//!
//! An axis turns by `h tau` and by what its gear does besides. Its rows follow
//! each other and share one unloaded reading, so they are whitened like the rows
//! of a visit; what is left is independent, which makes every row a witness of
//! its own where a campaign of displacements has poses. The tests are the same:
//! the largest score over all candidates against its own distribution under
//! random signs ([`bootstrap`](super::bootstrap)), rows left out that must be
//! predicted better, numbers that must be physical, rivals that are shown.
//!
//! Nothing here shows where links bend, how joints are coupled or where the tool
//! is: nothing of that moves. A load cell's scale is a scale of all compliances.

mod alike;
mod apart;
mod axes;
mod bench;
#[cfg(test)]
mod creep_tests;
mod curves;
mod noise;
mod one_off;
mod polish;
#[cfg(test)]
mod reading_tests;
mod report;
mod scatter;
mod search;
mod slips;
mod spread;
mod standing;
mod structure;
#[cfg(test)]
mod tests;
mod worth;

pub use self::axes::{Axes, AxisNumber, OnAxes, SLIPPED_AXIS, axes_column};
use std::string::String;

use super::{Options, Progress, Trace};
use crate::campaign::{Campaign, ClampedRow};
use crate::identify::clamped::slopes;
use crate::identify::{Error, in_other_unit};

/// Traces a campaign of clamped axes. Lengths of the result are angles (rad), its
/// poses the axes.
///
/// # Errors
/// A campaign that loads no axis, or both axes that turn and axes that slide, or an axis that
/// deflects against its torque; declared effects that do not go with the compliances found.
pub fn trace(
    campaign: &Campaign,
    rows: &[ClampedRow],
    options: &Options,
    progress: &Progress<'_>,
) -> Result<Trace, Error> {
    let kind = |row: &ClampedRow| campaign.robot.joints[row.axis - 1].kind;
    if rows.iter().any(|row| kind(row) != kind(&rows[0])) {
        return Err(Error::OtherCampaign(String::from(
            "some axes turn and some slide, and radians and metres have no noise in common: give the axes that slide a \
             campaign of their own",
        )));
    }
    progress("identifying the axes");
    // It refuses what no search should be begun with.
    let identified = slopes(campaign, rows, &[])?;
    let axes = Axes::new(&campaign.robot, rows, &identified);
    let found = search::search(axes, in_other_unit(campaign), options, progress).map_err(Error::NotShown)?;
    let found = worth::worth_naming(campaign, found, options);
    report::report(campaign, &identified, &found, options)
}
