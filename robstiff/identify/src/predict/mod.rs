//! What a description says a campaign should have read, and its error.

mod prediction;
#[cfg(test)]
mod tests;

use nalgebra::Vector3;
use robstiff_robots::Description;
use robstiff_robots::words::count;

pub use prediction::{PredictedRow, Prediction};

use crate::campaign::{Campaign, Data, Displacements, PositionRow, Positions};
use crate::identify::Error;
use crate::observe::displacement::Displacement;
use crate::observe::position::Position;
use crate::observe::registration::{NOT_SPREAD, are_spread, registration};
use crate::observe::{Observation, as_declared};

/// Predicts the rows of a campaign with a description, which need not be the
/// campaign's own.
///
/// # Errors
/// What [`Campaign::check`] finds; a campaign of another kind, a description with another
/// number of joints, positions that do not tell where the robot stands, or numbers so large that an
/// error is not finite.
pub fn predict(description: &Description, campaign: &Campaign) -> Result<Prediction, Error> {
    campaign.check().map_err(Error::Invalid)?;
    let (expected, found) = (campaign.robot.joints.len(), description.joints.len());
    if expected != found {
        let expected = count(expected, "joint");
        return Err(Error::OtherCampaign(format!("the campaign is of a robot with {expected}, this one has {found}")));
    }
    match &campaign.data {
        Data::Displacement(data) => displacements(description, data),
        Data::Position(data) => positions(description, data),
        Data::Clamped(_) => Err(Error::OtherCampaign(String::from(
            "predicting needs a campaign of kind `displacement` or `position`; the error of a description on clamped \
                 axes is what `trace` tells as declared, with it as the campaign's robot",
        ))),
    }
}

fn displacements(description: &Description, data: &Displacements) -> Result<Prediction, Error> {
    let observation = Displacement::new(description, data);
    let readings = observation.readings();
    let predicted = as_declared(&observation, observation.world(), description);
    let row = |row: usize| {
        let [measured, predicted] =
            [&readings.values, &predicted].map(|stacked| observation.in_base(row, &observation.moved(stacked, row)));
        PredictedRow {
            line: readings.lines[row],
            predicted: predicted.into(),
            measured: measured.into(),
            off: (measured - predicted).into(),
            axes: readings.reported,
        }
    };
    Prediction::of((0..readings.rows()).map(row).collect())
}

/// Where the robot stands is fitted, in the frame that positions are read in.
fn positions(description: &Description, data: &Positions) -> Result<Prediction, Error> {
    let points = Position::new(description, data).points(description);
    let read: Vec<Vector3<f64>> = data.rows.iter().map(|row| row.position.into()).collect();
    if !are_spread(&points) {
        return Err(Error::NotShown(NOT_SPREAD.to_owned()));
    }
    let stand = registration(&points, &read);
    let row = |(point, row): (&Vector3<f64>, &PositionRow)| {
        let predicted = stand.rotation * point + stand.translation.vector;
        let off = stand.rotation.inverse_transform_vector(&(Vector3::from(row.position) - predicted));
        PredictedRow { line: row.line, predicted: predicted.into(), measured: row.position, off: off.into(), axes: 3 }
    };
    Prediction::of(points.iter().zip(&data.rows).map(row).collect())
}
