//! How far off the models of a tracing are.

use std::string::String;
use std::vec::Vec;

use nalgebra::{DVector, Vector3};

use crate::campaign::{Campaign, PositionRow};
use crate::identify::positions::residuals;
use crate::identify::problem::rms;
use crate::trace::positions::bench::{Bench, Model};
use crate::trace::positions::search::Searched;
use crate::trace::positions::unseen::unseen_rms;
use crate::trace::{Misfit, PoseError, RowResidual};

/// Errors as declared, with the declared numbers identified again, and with the effects (m).
pub struct Errors {
    pub declared: Misfit,
    pub identified: Misfit,
    /// As declared where the data cannot tell.
    pub after: Misfit,
    /// Of every row.
    pub residuals: Vec<RowResidual>,
    /// Of every pose.
    pub of_poses: Vec<PoseError>,
}

impl Errors {
    /// Of the model that is `written`, if the data can tell (`tells`); rows that are `undecided`
    /// do not count among those of unseen poses.
    pub fn of(
        campaign: &Campaign,
        found: &Searched<'_>,
        (written, tells): (&Model, bool),
        undecided: &[usize],
    ) -> Self {
        let (bench, base) = (&found.bench, &found.base);
        let (data, training) = (bench.prepared.data, &bench.rows.training);
        let rows = || 0..data.rows.len();
        let is_fitted_to = |row: &usize| training[data.rows[*row].pose];
        let left_declared = bench.prepared.declared_residuals(campaign);
        let rms_declared = rms(&left_declared, 3, rows().filter(is_fitted_to));
        let unseen_declared = match training.contains(&false) {
            true => rms(&left_declared, 3, rows().filter(|row| !is_fitted_to(row) && !undecided.contains(row))),
            false => rms_declared,
        };
        let declared = Misfit { rms: rms_declared, holdout_rms: unseen_declared };
        let left_before = residuals(&bench.regression, &base.solved.state);
        let rms_before = rms(&left_before, 3, rows().filter(is_fitted_to));
        let identified = Misfit { rms: rms_before, holdout_rms: unseen_rms(bench, base, undecided) };
        // Data that can tell nothing change nothing.
        let (after, left_after) = match tells {
            true => {
                let left = residuals(&bench.regression, &written.solved.state);
                let rms = rms(&left, 3, rows().filter(is_fitted_to));
                (Misfit { rms, holdout_rms: unseen_rms(bench, written, undecided) }, left)
            }
            false => (declared, left_declared),
        };
        let left = [&left_before, &left_after];
        let (residuals, of_poses) = (of_rows(bench, written, left), of_poses(bench, left));
        Self { declared, identified, after, residuals, of_poses }
    }
}

/// What is left of each row before and after, stacked in the frame of what reads it (m), in
/// the base frame of the robot where a model has it stand.
fn of_rows(bench: &Bench<'_>, model: &Model, left: [&DVector<f64>; 2]) -> Vec<RowResidual> {
    let turn = model.solved.state.registration.turn.inverse();
    let residual = |(i, row): (usize, &PositionRow)| {
        let in_base = |left: &DVector<f64>| -> [f64; 3] {
            let left: Vector3<f64> = left.fixed_rows::<3>(3 * i).into_owned();
            (turn * left).into()
        };
        let [before, after] = left.map(in_base);
        RowResidual { line: row.line, pose: row.pose, before, after }
    };
    bench.prepared.data.rows.iter().enumerate().map(residual).collect()
}

/// The rms of each pose of what is left before and after, stacked (m).
fn of_poses(bench: &Bench<'_>, left: [&DVector<f64>; 2]) -> Vec<PoseError> {
    let data = bench.prepared.data;
    let error = |(pose, id): (usize, &String)| {
        let rows = || (0..data.rows.len()).filter(|&row| data.rows[row].pose == pose);
        let [before, after] = left.map(|left| rms(left, 3, rows()));
        PoseError { pose: id.clone(), held_out: !bench.rows.training[pose], before, after }
    };
    data.poses.iter().enumerate().map(error).collect()
}
