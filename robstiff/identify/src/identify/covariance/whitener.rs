//! Whitening by a covariance that is known.

use std::sync::Arc;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Matrix3};

use crate::identify::whitening::ByVisit;

/// What makes independent rows of equal variance of a campaign's readings, and
/// whatever is to explain them.
#[derive(Clone, Debug)]
pub struct Whitener {
    pub(super) turns: Option<Arc<[Matrix3<f64>]>>,
    pub(super) by_visit: ByVisit,
    /// To the unit of displacements, by axis.
    pub(super) scale: Vec<f64>,
    /// Rows of the campaign.
    pub(super) rows: usize,
    /// The same of the encoders, whose readings follow.
    pub(super) encoders: Option<(ByVisit, Vec<f64>)>,
}

impl Whitener {
    /// Whitens stacked columns in place.
    pub fn whiten(&self, stacked: &mut DMatrix<f64>) {
        let axes = self.scale.len();
        turn(stacked, self.turns.as_deref(), axes);
        let first = self.rows * axes;
        self.by_visit.whiten(stacked, 0, axes);
        if let Some((by_group, scale)) = &self.encoders {
            by_group.whiten(stacked, first, scale.len());
        }
        for mut column in stacked.column_iter_mut() {
            let (of_tool, of_encoders) = column.as_mut_slice().split_at_mut(first);
            of_tool.iter_mut().enumerate().for_each(|(i, value)| *value *= self.scale[i % axes]);
            if let Some((_, scale)) = &self.encoders {
                of_encoders.iter_mut().enumerate().for_each(|(i, value)| *value *= scale[i % scale.len()]);
            }
        }
    }

    /// One column, whitened.
    pub fn whitened(&self, stacked: DVector<f64>) -> DVector<f64> {
        let rows = stacked.len();
        let mut column = DMatrix::from_vec(rows, 1, stacked.data.into());
        self.whiten(&mut column);
        DVector::from_vec(column.data.into())
    }
}

/// The visits of rows, each row left out a visit of its own.
pub fn alone(visits: &[usize], left_out: &[bool]) -> Vec<usize> {
    let mut visits = visits.to_vec();
    let next = visits.iter().max().map_or(0, |last| last + 1);
    let alone = visits.iter_mut().zip(left_out).filter(|(_, out)| **out);
    alone.enumerate().for_each(|(k, (visit, _))| *visit = next + k);
    visits
}

/// Stacked columns from the base frame to that measured in.
pub(super) fn turn(stacked: &mut DMatrix<f64>, turns: Option<&[Matrix3<f64>]>, axes: usize) {
    for mut column in stacked.column_iter_mut() {
        for (row, turn) in turns.unwrap_or_default().iter().enumerate() {
            for first in (0..axes).step_by(3) {
                let at = row * axes + first;
                let turned = turn * column.fixed_rows::<3>(at);
                column.fixed_rows_mut::<3>(at).copy_from(&turned);
            }
        }
    }
}
