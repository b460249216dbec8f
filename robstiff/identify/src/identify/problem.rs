//! The regression a campaign poses: whitened columns and readings, in blocks
//! of poses.

use core::ops::Deref;
use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::column::Column;
use super::covariance::Covariance;
use super::normal::{Fit, Normal};
use super::samples::Samples;

/// Readings, and the normal equations of the columns that are to explain them.
#[derive(Clone, Debug)]
pub struct Equations {
    /// The readings, whitened; rotations in the displacements' unit (m), axes in
    /// the frame measured in.
    pub white_readings: Rc<DVector<f64>>,
    /// Axes per row of the campaign.
    pub axes: usize,
    /// The variance of an unloaded reading over that of a row's own.
    pub shared: f64,
    /// The blocks the problem is fitted to.
    pub blocks: Rc<[Block]>,
    /// The normal equations of all blocks fitted to.
    pub total: Normal,
}

/// The same with the columns themselves at hand.
#[derive(Clone, Debug)]
pub struct Problem {
    /// All but the columns.
    pub equations: Equations,
    /// The columns, whitened like the readings.
    pub white: DMatrix<f64>,
}

impl Deref for Problem {
    type Target = Equations;

    fn deref(&self) -> &Equations {
        &self.equations
    }
}

/// All rows of one pose. Visits do not span poses, so blocks are independent
/// of each other, and what is wrong with a pose is wrong with all its rows.
#[derive(Clone, Debug)]
pub struct Block {
    /// Index of the pose.
    pub pose: usize,
    /// The campaign's rows, without those that are left out.
    pub rows: Vec<usize>,
    /// Their indices in the stacked vectors.
    pub stacked: Vec<usize>,
}

/// How a campaign's rows are weighed.
#[derive(Clone, Copy, Debug)]
pub struct Weights<'a> {
    /// How noisy the readings are, and how they hang together.
    pub covariance: &'a Covariance,
    /// Whether each pose is fitted to.
    pub training: &'a [bool],
    /// Rows that are left out of everything.
    pub left_out: &'a [bool],
}

impl Problem {
    /// The problem of explaining `readings` by `columns`, both stacked like
    /// [`Samples::readings`], on the poses fitted to. `correction` is taken
    /// from what is whitened, but not from the readings that residuals are
    /// reported of.
    ///
    /// # Panics
    /// If no row belongs to a training pose.
    pub fn new(
        samples: &Samples,
        columns: DMatrix<f64>,
        readings: impl Into<Rc<DVector<f64>>>,
        correction: &DVector<f64>,
        weights: Weights<'_>,
    ) -> Self {
        let axes = samples.axes;
        let whitener = weights.covariance.whitener(weights.left_out);
        let mut white = columns;
        whitener.whiten(&mut white);
        let readings = readings.into();
        let white_readings = whitener.whitened(&*readings - correction);

        let mut rows = vec![Vec::new(); samples.poses];
        for (i, row) in samples.rows.iter().enumerate().filter(|&(i, _)| !weights.left_out[i]) {
            rows[row.pose].push(i);
        }
        let blocks: Vec<Block> = rows
            .into_iter()
            .enumerate()
            .filter(|(_, rows)| !rows.is_empty())
            .map(|(pose, rows)| {
                let of_tool = rows.iter().flat_map(|row| row * axes..(row + 1) * axes);
                let stacked = of_tool.chain(rows.iter().flat_map(|&row| samples.encoders_of(row))).collect();
                Block { pose, rows, stacked }
            })
            .filter(|block: &Block| weights.training[block.pose])
            .collect();
        let stacked: Vec<usize> = blocks.iter().flat_map(|block| block.stacked.iter().copied()).collect();
        assert!(!stacked.is_empty(), "a campaign has rows to train on");
        let total = Normal::of_rows(&white, &white_readings, &stacked);
        let equations = Equations {
            white_readings: Rc::new(white_readings),
            axes,
            shared: weights.covariance.shared,
            blocks: blocks.into(),
            total,
        };
        Self { equations, white }
    }

    /// What is left of the whitened readings, stacked (m).
    pub fn white_residuals(&self, columns: &[usize], coefficients: &DVector<f64>) -> DVector<f64> {
        let mut left = (*self.white_readings).clone();
        for (&column, &coefficient) in columns.iter().zip(coefficients.iter()) {
            left.axpy(-coefficient, &self.white.column(column), 1.0);
        }
        left
    }
}

impl Equations {
    /// The degrees of freedom that a fit leaves, at least one.
    pub fn freedom(&self, fit: &Fit) -> f64 {
        self.total.rows.saturating_sub(fit.columns.len()).max(1) as f64
    }

    /// The variance of a whitened reading by what a fit leaves (m^2, of clamped axes rad^2).
    pub fn variance(&self, fit: &Fit) -> f64 {
        fit.rss / self.freedom(fit)
    }
}

/// The columns of a description's numbers, stacked like [`Samples::readings`].
pub fn raw(samples: &Samples, columns: &[Column]) -> DMatrix<f64> {
    let mut raw = DMatrix::zeros(samples.length(), columns.len());
    for (j, &column) in columns.iter().enumerate() {
        raw.set_column(j, &samples.column(column));
    }
    raw
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
