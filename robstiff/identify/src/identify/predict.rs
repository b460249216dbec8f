//! What a description says a campaign should have read.

use std::string::String;
use std::vec::Vec;

use nalgebra::{DVector, Vector3};
use robstiff_robots::Description;
use robstiff_robots::words::count;

use super::baseline::declared;
use super::samples::Samples;
use super::{Error, positions};
use crate::campaign::{Campaign, Data, Displacements};

/// The error of a description on a campaign. An error is the length of a row's
/// residual over `sqrt(3)`, throughout, so that it compares with
/// the noise of one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// What is predicted for each row, of the point that is read (m), and what the
    /// campaign read: displacements in the base frame, or positions in the frame that
    /// they are read in.
    pub rows: Vec<PredictedRow>,
    /// The root mean square error (m).
    pub rms: f64,
    /// The 95th percentile of the errors (m), the smallest that 95 % of the
    /// rows do not exceed.
    pub p95: f64,
    /// The largest error (m).
    pub max: f64,
}

/// One row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PredictedRow {
    /// The line of the CSV file, from 1.
    pub line: usize,
    /// The displacement or position predicted (m).
    pub predicted: [f64; 3],
    /// The one read, in the same frame (m).
    pub measured: [f64; 3],
    /// What was read less what is predicted, in the base frame (m).
    pub off: [f64; 3],
}

impl PredictedRow {
    /// The length of the residual over `sqrt(3)` (m).
    pub fn error(&self) -> f64 {
        (self.off.iter().map(|off| off * off).sum::<f64>() / 3.0).sqrt()
    }
}

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

impl Prediction {
    /// The errors of rows that were predicted.
    ///
    /// # Errors
    /// One that is not finite.
    pub(crate) fn of(rows: Vec<PredictedRow>) -> Result<Self, Error> {
        let mut errors: Vec<f64> = rows.iter().map(PredictedRow::error).collect();
        errors.sort_by(f64::total_cmp);
        let count = errors.len();
        let rms = (errors.iter().map(|error| error * error).sum::<f64>() / count as f64).sqrt();
        if !rms.is_finite() {
            return Err(Error::NotFinite);
        }
        Ok(Self {
            rms,
            p95: errors[((0.95 * count as f64).ceil() as usize).clamp(1, count) - 1],
            max: errors[count - 1],
            rows,
        })
    }
}
