//! What a description says a campaign should have read.

use std::string::String;

use nalgebra::{DVector, Vector3};
use robstiff_robots::Description;
use robstiff_robots::words::count;

use super::baseline::declared;
use super::prediction::{PredictedRow, Prediction};
use super::samples::Samples;
use super::{Error, positions};
use crate::campaign::{Campaign, Data, Displacements};

/// Predicts the rows of a campaign with a description, which need not be the
/// campaign's own.
///
/// # Errors
/// What [`Campaign::check`] finds; a campaign of another kind, a description with another
/// number of joints, or numbers so large that an error is not finite.
pub fn predict(description: &Description, campaign: &Campaign) -> Result<Prediction, Error> {
    campaign.check().map_err(Error::Invalid)?;
    let (expected, found) = (campaign.robot.joints.len(), description.joints.len());
    if expected != found {
        let expected = count(expected, "joint");
        return Err(Error::OtherCampaign(std::format!(
            "the campaign is of a robot with {expected}, this one has {found}"
        )));
    }
    super::whole(campaign)?;
    match &campaign.data {
        Data::Displacement(data) => displacements(description, data),
        Data::Position(data) => positions::predict(description, data),
        Data::Clamped(_) => Err(Error::OtherCampaign(String::from(
            "predicting needs a campaign of kind `displacement` or `position`; the error of a description on clamped \
                 axes is what `trace` tells as declared, with it as the campaign's robot",
        ))),
    }
}

fn displacements(description: &Description, data: &Displacements) -> Result<Prediction, Error> {
    let samples = Samples::of_description(description, data);
    let mut predicted = DVector::zeros(samples.length());
    for number in declared(description) {
        if number.value != 0.0 {
            predicted.axpy(number.value, &samples.column(number.column), 1.0);
        }
    }
    let row = |(i, sample): (usize, &super::samples::Sample)| {
        let predicted: Vector3<f64> = predicted.fixed_rows::<3>(i * samples.axes).into_owned();
        PredictedRow {
            line: data.rows[i].line,
            predicted: predicted.into(),
            measured: sample.displacement.into(),
            off: (sample.displacement - predicted).into(),
        }
    };
    Prediction::of(samples.rows.iter().enumerate().map(row).collect())
}
