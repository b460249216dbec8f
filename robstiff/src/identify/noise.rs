//! The noise of a reading, from readings that were repeated.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::samples::Samples;
use super::whitening::whiten;

/// Loads within this fraction of the pose's largest count as the same load:
/// what they differ by moves the arm by less than a tenth of a micrometre.
const SAME_LOAD: f64 = 5e-5;

/// A sum of squares due to noise alone, and its degrees of freedom.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PureError {
    /// The sum of squares of what repeated readings differ by, whitened.
    pub sum: f64,
    /// Its degrees of freedom.
    pub freedom: usize,
}

impl PureError {
    /// The variance of one reading, if enough was repeated to say.
    pub fn variance(&self) -> Option<f64> {
        (self.freedom >= FEWEST_REPETITIONS).then(|| self.sum / self.freedom as f64)
    }
}

/// With fewer degrees of freedom a variance is uncertain by half and more
/// (`sqrt(2 / 10)` is 45 %), and says too little to judge a model by.
const FEWEST_REPETITIONS: usize = 10;

/// Displacements and rotations, each with its own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Repetitions {
    /// Of displacements (m^2).
    pub displacement: PureError,
    /// Of rotations (rad^2).
    pub rotation: PureError,
}

/// What rows of one pose under one load differ by. Each pose gets a free
/// displacement per load, fitted by generalised least squares: any model of
/// the robot in which the load alone decides is inside that, so what it leaves
/// is noise (or something that is not a function of the load, such as
/// hysteresis and drift).
pub fn repetitions(samples: &Samples, of_pose: impl Fn(usize) -> bool) -> Repetitions {
    let mut found = Repetitions::default();
    for pose in (0..samples.poses).filter(|&pose| of_pose(pose)) {
        let rows: Vec<usize> = (0..samples.rows.len()).filter(|&i| samples.rows[i].pose == pose).collect();
        let loads = same_loads(samples, &rows);
        let count = loads.iter().max().map_or(0, |last| last + 1);
        if count == rows.len() {
            continue;
        }
        let mut visits: Vec<usize> = rows.iter().map(|&i| samples.rows[i].visit).collect();
        renumber(&mut visits);
        let mut design = DMatrix::from_fn(rows.len(), count, |i, j| f64::from(u8::from(loads[i] == j)));
        whiten(&mut design, &visits, 1);
        let Some(inverse) = design.tr_mul(&design).try_inverse() else { continue };
        for axis in 0..samples.axes {
            let mut values = DMatrix::from_fn(rows.len(), 1, |i, _| {
                let row = &samples.rows[rows[i]];
                if axis < 3 { row.displacement[axis] } else { row.rotation[axis - 3] }
            });
            whiten(&mut values, &visits, 1);
            let values: DVector<f64> = values.column(0).into_owned();
            let fitted = &design * (&inverse * design.tr_mul(&values));
            let into = if axis < 3 { &mut found.displacement } else { &mut found.rotation };
            into.sum += (values - fitted).norm_squared();
            into.freedom += rows.len() - count;
        }
    }
    found
}

/// Numbers the distinct loads of some rows.
fn same_loads(samples: &Samples, rows: &[usize]) -> Vec<usize> {
    let largest = rows.iter().map(|&i| samples.rows[i].wrench.norm()).fold(0.0, f64::max);
    let mut distinct: Vec<usize> = Vec::new();
    rows.iter()
        .map(|&i| {
            let near = |&j: &usize| (samples.rows[i].wrench - samples.rows[j].wrench).norm() <= SAME_LOAD * largest;
            distinct.iter().position(near).unwrap_or_else(|| {
                distinct.push(i);
                distinct.len() - 1
            })
        })
        .collect()
}

/// Visit indices counted from 0 without gaps.
fn renumber(visits: &mut [usize]) {
    let mut seen: Vec<usize> = Vec::new();
    for visit in visits {
        let index = seen.iter().position(|v| v == visit).unwrap_or_else(|| {
            seen.push(*visit);
            seen.len() - 1
        });
        *visit = index;
    }
}
