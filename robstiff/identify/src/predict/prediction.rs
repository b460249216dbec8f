//! The error of a description, row by row.

use crate::identify::Error;

/// The error of a description on a campaign. An error is the length of a row's
/// residual over `sqrt(3)` (or the root of as many axes as are read), throughout, so that it compares with
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
    /// Along how many axes it is read: three, of a dial gauge one.
    pub axes: usize,
}

impl PredictedRow {
    /// The length of the residual over the root of the number of axes (m).
    pub fn error(&self) -> f64 {
        (self.off.iter().map(|off| off * off).sum::<f64>() / self.axes as f64).sqrt()
    }
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
