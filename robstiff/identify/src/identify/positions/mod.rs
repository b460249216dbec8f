//! Absolute positions: what a description says of them, and the compliances that
//! payloads show.
//!
//! Positions are read in a frame of their own, wherever the tracker stands. Where the
//! robot stands in it is fitted with everything, and so are the reflector and the numbers
//! of the table.

#[cfg(test)]
mod tests;
mod unit;

use super::fitted::identification;
use super::{Error, Identification};
use crate::campaign::{Campaign, Positions};
use crate::fit::case::Case;
use crate::fit::own::Alone;
use crate::observe::position::Position;
use crate::observe::registration::{NOT_SPREAD, are_spread};

/// Identifies the compliances that payloads show, beside the errors of the table.
///
/// # Errors
/// Positions that show none, or not where the robot stands, or are in another unit; compliances
/// that no description takes beside its own effects.
pub fn identify(campaign: &Campaign, data: &Positions) -> Result<Identification, Error> {
    if let Some(why) = unit::other_unit(&campaign.robot, data) {
        return Err(Error::OtherUnit(why));
    }
    let is_seen = |why: &str| Error::NotShown(format!("{why}; `robstiff trace` asks what they show of the kinematics"));
    if data.rows.iter().all(|row| row.payload == 0.0) {
        return Err(is_seen("no row has a payload, so these positions show no compliance"));
    }
    if !are_spread(&Position::new(&campaign.robot, data).points(&campaign.robot)) {
        return Err(Error::NotShown(NOT_SPREAD.to_owned()));
    }
    let case = Case::new(campaign, &campaign.robot);
    let alone = Alone::fitted(&case, &campaign.robot, 0.0).ok_or(Error::NotFinite)?;
    if alone.seen().is_empty() {
        return Err(is_seen(match alone.moves_any() {
            true => "the positions scatter by more than the payloads do to any joint",
            false => "these payloads load no joint",
        }));
    }
    identification(campaign, (&case, &alone), data.poses.len())
}
