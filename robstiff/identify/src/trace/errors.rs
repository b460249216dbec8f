//! How far off models are.

use nalgebra::DVector;

use crate::fit::case::Case;

/// How far off a model is (m; of clamped axes, rad).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Misfit {
    /// On the rows fitted to, all of them.
    pub rms: f64,
    /// On poses that had no part in the fit, the choice of effects included: those held out, or each
    /// fold's by the whole search without them.
    pub holdout_rms: f64,
}

/// The residual of a row (m; of clamped axes, the angle in rad): of a displacement in the frame that it
/// is read in, of a position likewise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowResidual {
    /// The line of the CSV file, from 1.
    pub line: usize,
    /// Index of the pose, or of the clamped axis.
    pub pose: usize,
    /// With the description's own numbers fitted again.
    pub before: [f64; 3],
    /// With everything that was found.
    pub after: [f64; 3],
}

/// The rms of one pose, or of one clamped axis, in the unit of [`Misfit`].
#[derive(Clone, Debug, PartialEq)]
pub struct PoseError {
    /// The pose's id.
    pub pose: String,
    /// Whether the pose was held out.
    pub held_out: bool,
    /// With the description's own numbers fitted again.
    pub before: f64,
    /// With everything that was found.
    pub after: f64,
}

/// The error of the residuals of all rows, and of those of unseen ones; where poses are held out,
/// these are what is unseen.
pub fn misfit(case: &Case<'_>, left: &DVector<f64>, unseen: &DVector<f64>) -> Misfit {
    let readings = case.observation.readings();
    let (fitted, held_out) = (case.rows(true), case.rows(false));
    let holdout_rms = match held_out.is_empty() {
        true => readings.rms(unseen, fitted.iter().copied()),
        false => readings.rms(left, held_out),
    };
    Misfit { rms: readings.rms(left, fitted), holdout_rms }
}

/// The residual of each row before and after.
pub fn rows(case: &Case<'_>, before: &DVector<f64>, after: &DVector<f64>) -> Vec<RowResidual> {
    let readings = case.observation.readings();
    let of = |left: &DVector<f64>, row: usize| -> [f64; 3] {
        core::array::from_fn(|k| if k < readings.reported { left[row * readings.width + k] } else { 0.0 })
    };
    let row = |row: usize| RowResidual {
        line: readings.lines[row],
        pose: case.group[row],
        before: of(before, row),
        after: of(after, row),
    };
    (0..readings.rows()).map(row).collect()
}

/// The error of each pose before and after.
pub fn poses(case: &Case<'_>, before: &DVector<f64>, after: &DVector<f64>) -> Vec<PoseError> {
    let readings = case.observation.readings();
    let mut rows: Vec<Vec<usize>> = vec![Vec::new(); case.groups.len()];
    case.group.iter().enumerate().for_each(|(row, &group)| rows[group].push(row));
    let pose = |(group, id): (usize, &String)| PoseError {
        pose: id.clone(),
        held_out: rows[group].iter().any(|&row| !case.training[readings.block[row]]),
        before: readings.rms(before, rows[group].iter().copied()),
        after: readings.rms(after, rows[group].iter().copied()),
    };
    case.groups.iter().enumerate().map(pose).collect()
}
