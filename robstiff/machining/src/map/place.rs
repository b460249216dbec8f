//! Where a workpiece is best put.

use super::{Axis, Measure};

/// A place for a workpiece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorkpiecePlace {
    /// Its corner nearest to the origin of the axes: x, y and z (m).
    pub corner: [f64; 3],
    /// The index of that corner along each axis.
    pub first: [usize; 3],
    /// How many of the map's positions it spans along each axis.
    pub span: [usize; 3],
    /// The worst of the measure's first column within, in SI.
    pub worst: f64,
}

/// The place for a workpiece of a size (m along x, y and z of the map's frame) where the
/// worst value within it is best, of all places whose corner is a cell of the map
/// and that are reached everywhere; the first of those that are equal. `values` is
/// the first column of the measure at all cells.
///
/// The sampled points are the cells within the workpiece and just beyond its far
/// sides, so that it is covered. `None` where no place is large enough and reached
/// everywhere.
pub fn best_placement(axes: &[Axis; 3], values: &[f64], size: [f64; 3], measure: &Measure) -> Option<WorkpiecePlace> {
    let lengths = [0, 1, 2].map(|k| axes[k].values.len());
    let mut span = [1; 3];
    for k in 0..3 {
        let axis = &axes[k].values;
        // So many steps that the size is covered, but for rounding.
        let covers = |&count: &usize| axis[count - 1] - axis[0] >= size[k] * (1.0 - 1e-9);
        span[k] = (1..=lengths[k]).find(covers)?;
    }
    // The worst of runs of cells, axis after axis; NaN wins.
    let strides = [1, lengths[0], lengths[0] * lengths[1]];
    let mut worst = values.to_vec();
    for k in 0..3 {
        worst = runs(&worst, lengths[k], strides[k], span[k], measure);
    }
    let fits = |at: [usize; 3]| (0..3).all(|k| at[k] + span[k] <= lengths[k]);
    let mut best: Option<WorkpiecePlace> = None;
    for (cell, &worst) in worst.iter().enumerate() {
        let at = [cell % lengths[0], cell / lengths[0] % lengths[1], cell / strides[2]];
        if worst.is_nan() || !fits(at) {
            continue;
        }
        if best.is_none_or(|best| measure.is_clearly_worse(best.worst, worst)) {
            let corner = [0, 1, 2].map(|k| axes[k].values[at[k]]);
            best = Some(WorkpiecePlace { corner, first: at, span, worst });
        }
    }
    best
}

/// The worst of `span` cells from each on along an axis; NaN where one is or the
/// axis ends before.
fn runs(values: &[f64], length: usize, stride: usize, span: usize, measure: &Measure) -> Vec<f64> {
    let worse = |one: f64, other: f64| {
        if one.is_nan() || (!other.is_nan() && measure.is_worse(one, other)) { one } else { other }
    };
    let at = |cell: usize| {
        let index = cell / stride % length;
        if index + span > length {
            return f64::NAN;
        }
        (0..span).map(|step| values[cell + step * stride]).reduce(worse).unwrap_or(f64::NAN)
    };
    (0..values.len()).map(at).collect()
}
