//! Absolute positions: what a description says of them, and the compliances that
//! payloads show.
//!
//! Positions are read in a frame of their own, wherever the tracker stands. Where the
//! robot stands in it is fitted with everything, and so are the reflector and the numbers
//! of the table.

pub mod model;
pub mod registration;
#[cfg(test)]
mod tests;
mod unit;

use nalgebra::Vector3;
use robstiff_robots::Description;

use self::model::Model;
use self::registration::Registration;
use super::fitted::identification;
use super::prediction::{PredictedRow, Prediction};
use super::{Error, Identification};
use crate::campaign::{Campaign, Positions};
use crate::fit::case::Case;
use crate::fit::own::Alone;

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
    standing(&Model::new(&campaign.robot, data), data)?;
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

/// Predicts the positions of a campaign with a description; where the robot stands
/// is fitted, in the frame that positions are read in.
///
/// # Errors
/// Positions that do not tell where the robot stands, numbers so large that an error is
/// not finite.
pub fn predict(description: &Description, data: &Positions) -> Result<Prediction, Error> {
    let model = Model::new(description, data);
    let registration = standing(&model, data)?;
    let row = |(point, row): (Vector3<f64>, &crate::campaign::PositionRow)| PredictedRow {
        line: row.line,
        predicted: registration.placed(&point).into(),
        measured: row.position,
        off: (registration.in_base(&row.position.into()) - point).into(),
    };
    Prediction::of(model.points(data).into_iter().zip(&data.rows).map(row).collect())
}

/// Where the robot stands by a model.
///
/// # Errors
/// Rows that do not tell.
fn standing(model: &Model, data: &Positions) -> Result<Registration, Error> {
    let points = model.points(data);
    let pairs = points.iter().zip(&data.rows).map(|(point, row)| (*point, Vector3::from(row.position)));
    Registration::fitted(pairs).ok_or_else(|| {
        Error::NotShown(String::from(
            "the positions do not tell where the robot stands: they are fewer than three, or on a line by its description",
        ))
    })
}
