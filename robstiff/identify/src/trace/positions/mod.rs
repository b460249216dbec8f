//! Tracing of absolute positions: which effects they show that a description lacks.
//!
//! Positions show what differences of one pose hardly do: zeros, lengths and twists
//! of the table, periodic errors, the arm's sag; payloads show what yields. They are
//! read in a frame of their own, in which where the robot stands is fitted with
//! everything, so what is the same as another stand shows in nothing.
//!
//! The way is that of displacements: a catalogue (`offers`) becomes columns
//! (`bench`), which are tested against random signs of whole poses
//! ([`bootstrap`](super::bootstrap)); a `search` names what is significant, predicts
//! poses left out better, and is physical; moments of slips, knees of gears and time
//! constants, which the catalogue has in steps, are then looked for `between` them; rows that do not belong are
//! left out (`wild`); faults of the rig are held against the lengths that they can stand in for
//! (`stand_ins`); what remains is tested for `structure`; names are held against what
//! has none (`beyond`, `nameless`, `weight`; of slips, `wander`). Effects enter the forward model itself, and are fitted
//! in it.

pub mod bench;
mod between;
mod beyond;
#[cfg(test)]
mod beyond_tests;
mod confounded;
#[cfg(test)]
mod confounded_tests;
mod course;
mod crowd;
#[cfg(test)]
mod crowd_tests;
mod drift;
mod frames;
mod left_at_zero;
#[cfg(test)]
mod left_at_zero_tests;
mod nameless;
mod offers;
mod proposals;
mod report;
mod rig;
mod search;
#[cfg(test)]
mod slip_tests;
mod slips;
mod smooth;
mod spread;
mod stable;
#[cfg(test)]
mod stand_in_tests;
mod stand_ins;
mod structure;
#[cfg(test)]
mod tests;
mod unseen;
mod wander;
#[cfg(test)]
mod wander_tests;
mod weight;
#[cfg(test)]
mod weight_tests;
mod worth;
mod written;

use self::bench::Bench;
use super::{Options, Progress, Trace};
use crate::campaign::{Campaign, Positions};
use crate::identify::Error;

/// Traces a campaign of positions.
///
/// # Errors
/// Positions that do not tell where the robot stands; compliances that no description
/// takes beside its own effects.
pub fn trace(
    campaign: &Campaign,
    data: &Positions,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<Trace, Error> {
    progress("finding where the robot stands");
    let bench = Bench::new(campaign, data)?;
    let found = search::search(campaign, bench, options, progress).map_err(Error::NotShown)?;
    let found = worth::worth_naming(campaign, found, options);
    report::report(campaign, &found, options)
}
