//! The regression a campaign poses: whitened columns and readings, in blocks
//! of poses.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::covariance::Covariance;
use super::normal::Normal;
use super::samples::{Column, Samples};

/// Readings and the columns that are to explain them.
#[derive(Clone, Debug)]
pub struct Problem {
    /// What the columns are.
    pub columns: Vec<Column>,
    /// The columns as measured, stacked like [`Samples::readings`].
    pub raw: DMatrix<f64>,
    /// The readings as measured (m, rad).
    pub readings: DVector<f64>,
    /// The columns, whitened; rotations in the displacements' unit (m), axes in
    /// the frame measured in.
    pub white: DMatrix<f64>,
    /// The readings, whitened alike.
    pub white_readings: DVector<f64>,
    /// Axes per row of the campaign.
    pub axes: usize,
    /// The blocks the problem is fitted to.
    pub blocks: Vec<Block>,
    /// The blocks kept for judging.
    pub held_out: Vec<Block>,
    /// The sum of the normal equations of the blocks fitted to.
    pub total: Normal,
}

/// All rows of one pose. Visits do not span poses, so blocks are independent
/// of each other, and what is wrong with a pose is wrong with all its rows.
#[derive(Clone, Debug)]
pub struct Block {
    /// Index of the pose.
    pub pose: usize,
    /// The campaign's rows.
    pub rows: Vec<usize>,
    /// Their indices in the stacked vectors.
    pub stacked: Vec<usize>,
    /// The normal equations of these rows, whitened.
    pub normal: Normal,
}

impl Problem {
    /// The problem of explaining `readings` (stacked like
    /// [`Samples::readings`]) on the poses for which `training` holds.
    /// `correction` is taken from what is whitened, but not from the readings
    /// that residuals are reported of.
    ///
    /// # Panics
    /// If no row belongs to a training pose.
    pub fn new(
        samples: &Samples,
        columns: Vec<Column>,
        readings: DVector<f64>,
        correction: &DVector<f64>,
        covariance: &Covariance,
        training: &[bool],
    ) -> Self {
        let axes = samples.axes;
        let mut raw = DMatrix::zeros(readings.len(), columns.len());
        for (j, &column) in columns.iter().enumerate() {
            raw.set_column(j, &samples.column(column));
        }
        let mut white = raw.clone().insert_column(columns.len(), 0.0);
        white.set_column(columns.len(), &(&readings - correction));
        covariance.whiten(&mut white);
        let white_readings = white.column(columns.len()).into_owned();
        let white = white.remove_column(columns.len());

        let (blocks, held_out): (Vec<Block>, Vec<Block>) = (0..samples.poses)
            .filter_map(|pose| {
                let rows: Vec<usize> = (0..samples.rows.len()).filter(|&i| samples.rows[i].pose == pose).collect();
                let stacked: Vec<usize> = rows.iter().flat_map(|row| row * axes..(row + 1) * axes).collect();
                let normal = Normal::new(&white.select_rows(&stacked), &white_readings.select_rows(&stacked));
                (!rows.is_empty()).then_some(Block { pose, rows, stacked, normal })
            })
            .partition(|block: &Block| training[block.pose]);
        let total = Normal::sum(blocks.iter().map(|block| &block.normal)).expect("a campaign has rows to train on");
        Self { columns, raw, readings, white, white_readings, axes, blocks, held_out, total }
    }

    /// What is left of the readings as measured, stacked; (m, rad).
    pub fn residuals(&self, columns: &[usize], coefficients: &DVector<f64>) -> DVector<f64> {
        let mut left = self.readings.clone();
        for (&column, &coefficient) in columns.iter().zip(coefficients.iter()) {
            left.axpy(-coefficient, &self.raw.column(column), 1.0);
        }
        left
    }

    /// What is left of the whitened readings, stacked (m).
    pub fn white_residuals(&self, columns: &[usize], coefficients: &DVector<f64>) -> DVector<f64> {
        let mut left = self.white_readings.clone();
        for (&column, &coefficient) in columns.iter().zip(coefficients.iter()) {
            left.axpy(-coefficient, &self.white.column(column), 1.0);
        }
        left
    }
}

/// The root mean square over rows of the length of the displacement residual,
/// over `sqrt(3)` so that it compares with the noise of one axis (m); `rows`
/// are the campaign's rows to count.
pub fn rms(residuals: &DVector<f64>, axes: usize, rows: impl IntoIterator<Item = usize>) -> f64 {
    let (sum, count) = rows
        .into_iter()
        .fold((0.0, 0_usize), |(sum, count), row| (sum + residuals.rows(row * axes, 3).norm_squared(), count + 1));
    (sum / (3 * count.max(1)) as f64).sqrt()
}
