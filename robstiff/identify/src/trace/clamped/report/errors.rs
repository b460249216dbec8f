//! How far off the models of a tracing are.

use std::format;
use std::vec::Vec;

use nalgebra::DVector;

use crate::campaign::{Campaign, ClampedRow};
use crate::identify::normal::Fit;
use crate::trace::clamped::bench::Bench;
use crate::trace::model::Fitted;
use crate::trace::{Misfit, PoseError, RowResidual};

/// Errors as declared, with compliances alone, and with the effects (rad).
pub struct Errors {
    pub declared: Misfit,
    pub identified: Misfit,
    /// As declared where nothing is written.
    pub after: Misfit,
    /// Of every row, wild ones and all.
    pub residuals: Vec<RowResidual>,
    /// Of every axis that is loaded.
    pub of_axes: Vec<PoseError>,
}

impl Errors {
    /// `written`: the model that is written, none where the data can tell nothing.
    pub fn of(campaign: &Campaign, bench: &Bench, model: &Fitted, written: Option<&Fitted>) -> Self {
        // Before anything was left out.
        let whole = Bench::new(bench.axes.whole(), Some(&bench.offers));
        let base = whole.fit(&[]).unwrap_or_else(|| model.clone());
        let left_declared = as_declared(campaign, &whole);
        let declared = Misfit { rms: rms(&left_declared), holdout_rms: rms(&left_declared) };
        let left_before = whole.residuals(&base.fit);
        let (after, left_after) = match written {
            Some(written) => {
                let left = whole.residuals(&written.fit);
                (Misfit { rms: rms(&left), holdout_rms: unseen_rms(bench, &written.fit, &left) }, left)
            }
            None => (declared, left_declared),
        };
        let residual = |(i, row): (usize, &ClampedRow)| RowResidual {
            line: row.line,
            pose: row.axis - 1,
            before: [left_before[i], 0.0, 0.0],
            after: [left_after[i], 0.0, 0.0],
        };
        let of_axis = |axis: usize| {
            let of = |left: &DVector<f64>| rms(&left.select_rows(&whole.axes.rows_of(axis)));
            let pose = format!("axis {axis}");
            PoseError { pose, held_out: false, before: of(&left_before), after: of(&left_after) }
        };
        Self {
            declared,
            identified: Misfit { rms: rms(&left_before), holdout_rms: whole.left_out_rms(&base.fit) },
            after,
            residuals: whole.axes.rows.iter().enumerate().map(residual).collect(),
            of_axes: bench.axes.loaded().map(of_axis).collect(),
        }
    }
}

/// What the declared compliances leave of each row (rad).
fn as_declared(campaign: &Campaign, whole: &Bench) -> DVector<f64> {
    let left = |row: &ClampedRow| row.deflection - campaign.robot.joints[row.axis - 1].compliance() * row.torque;
    DVector::from_iterator(whole.axes.rows.len(), whole.axes.rows.iter().map(left))
}

/// The root mean square of each row's residual by the fit without it (rad): of rows that have no part
/// in the fit, of `left`, what it leaves of all rows.
pub fn unseen_rms(bench: &Bench, fit: &Fit, left: &DVector<f64>) -> f64 {
    let whole = bench.axes.whole();
    let is_out = |row: &ClampedRow| bench.axes.left_out().any(|out| out.line == row.line);
    let out: f64 =
        (0..).zip(&whole.rows).filter(|(_, row)| is_out(row)).map(|(i, _): (usize, _)| left[i].powi(2)).sum();
    let rows = bench.axes.rows.len() as f64;
    ((rows * bench.left_out_rms(fit).powi(2) + out) / whole.rows.len().max(1) as f64).sqrt()
}

/// The root mean square of what is left (rad).
pub fn rms(left: &DVector<f64>) -> f64 {
    (left.norm_squared() / left.len().max(1) as f64).sqrt()
}
