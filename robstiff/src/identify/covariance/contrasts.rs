//! What readings at one pose say about their noise and about nothing else.
//!
//! Whatever is elastic and linear in the load moves the tool at one pose by
//! `C F` with some 6 x 6 matrix `C`, symmetric or not: every compliance, every
//! turned or scaled force or displacement, every lever arm. Contrasts are the
//! combinations of a pose's readings that are free of all of these, an
//! orthonormal basis of what is orthogonal to the loads. Those of one axis have
//! the covariance `v (I + lambda Z^T J Z)`, where `J` is one for two rows of a
//! visit; in the basis in which that is diagonal they are independent, each with
//! the variance `v (1 + lambda s)`, `s` the share of the unloaded readings in it.

use std::vec::Vec;

use nalgebra::{DMatrix, SymmetricEigen};

use super::super::samples::Samples;

/// What is free at a pose, from little to much. The more is free, the fewer
/// contrasts are left, and the less can hide in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// A displacement linear in the load.
    Linear,
    /// And a part that grows with the square of the load along each direction:
    /// gears that harden or soften.
    Curved,
    /// A displacement for every distinct load: only repeated loads are left.
    Repeated,
}

/// Loads that deviate from the span of the others by less than this fraction
/// make no direction of their own: a thousandth of a millimetre is less than the
/// noise.
const SAME_DIRECTION: f64 = 1e-3;

/// Loads within this fraction of the pose's largest count as the same load:
/// what they differ by moves the arm by less than a tenth of a micrometre.
const SAME_LOAD: f64 = 5e-5;

/// A pose with more rows than this is cut between visits, each part with its own
/// free response, since the effort is cubic.
const MOST_ROWS: usize = 60;

/// The contrasts of some rows of one pose.
#[derive(Clone, Debug)]
pub struct Chunk {
    /// The campaign's rows.
    pub rows: Vec<usize>,
    /// The visit of each, as the campaign counts them.
    pub visits: Vec<usize>,
    /// The basis, a column a contrast; its rows are those of `rows`.
    pub basis: DMatrix<f64>,
    /// The share of the unloaded readings in each contrast.
    pub shares: Vec<f64>,
    /// The contrasts, a row each, a column an axis (m, rad).
    pub values: DMatrix<f64>,
}

/// The contrasts of all poses for which `of_pose` holds, without the rows for
/// which `left_out` does. `readings` holds a row a row of the campaign, a column
/// an axis.
pub fn contrasts(
    samples: &Samples,
    readings: &DMatrix<f64>,
    level: Level,
    of_pose: impl Fn(usize) -> bool,
    left_out: impl Fn(usize) -> bool,
) -> Vec<Chunk> {
    let mut poses: Vec<Vec<usize>> = std::vec![Vec::new(); samples.poses];
    for (i, row) in samples.rows.iter().enumerate().filter(|(i, row)| of_pose(row.pose) && !left_out(*i)) {
        poses[row.pose].push(i);
    }
    let parts = poses.iter().flat_map(|rows| cut(samples, rows));
    parts.filter_map(|rows| chunk(samples, readings, level, rows)).collect()
}

/// Rows of one pose in parts that are not too large; visits stay whole.
fn cut(samples: &Samples, rows: &[usize]) -> Vec<Vec<usize>> {
    let mut visits: Vec<(usize, Vec<usize>)> = Vec::new();
    for &row in rows {
        let visit = samples.rows[row].visit;
        match visits.iter_mut().rev().find(|(known, _)| *known == visit) {
            Some((_, members)) => members.push(row),
            None => visits.push((visit, std::vec![row])),
        }
    }
    let mut parts: Vec<Vec<usize>> = Vec::new();
    for (_, members) in visits {
        match parts.last_mut().filter(|part| part.len() + members.len() <= MOST_ROWS) {
            Some(part) => part.extend(members),
            None => parts.push(members),
        }
    }
    parts
}

fn chunk(samples: &Samples, readings: &DMatrix<f64>, level: Level, rows: Vec<usize>) -> Option<Chunk> {
    let basis = complement(&design(samples, level, &rows), rows.len())?;
    let visits: Vec<usize> = rows.iter().map(|&row| samples.rows[row].visit).collect();
    let together = DMatrix::from_fn(rows.len(), rows.len(), |i, j| f64::from(u8::from(visits[i] == visits[j])));
    let shared = SymmetricEigen::new(basis.tr_mul(&(together * &basis)));
    let basis = basis * shared.eigenvectors;
    let values = basis.tr_mul(&readings.select_rows(&rows));
    let shares = shared.eigenvalues.iter().map(|share| share.max(0.0)).collect();
    Some(Chunk { rows, visits, basis, shares, values })
}

/// The columns of what is free at a pose.
fn design(samples: &Samples, level: Level, rows: &[usize]) -> DMatrix<f64> {
    let largest = rows.iter().map(|&row| samples.rows[row].wrench.norm()).fold(f64::MIN_POSITIVE, f64::max);
    match level {
        Level::Linear => DMatrix::from_fn(rows.len(), 6, |i, k| samples.rows[rows[i]].wrench[k] / largest),
        Level::Curved => DMatrix::from_fn(rows.len(), 12, |i, k| {
            let wrench = &samples.rows[rows[i]].wrench;
            let size = wrench.norm() / largest;
            wrench[k % 6] / largest * if k < 6 { 1.0 } else { size }
        }),
        Level::Repeated => {
            let loads = same_loads(samples, rows);
            let count = loads.iter().max().map_or(0, |last| last + 1);
            DMatrix::from_fn(rows.len(), count, |i, j| f64::from(u8::from(loads[i] == j)))
        }
    }
}

/// An orthonormal basis of what is orthogonal to some columns; `None` where
/// nothing is.
fn complement(design: &DMatrix<f64>, rows: usize) -> Option<DMatrix<f64>> {
    // The eigenvectors of `D D^T` are all there is, those of zero as well.
    let eigen = SymmetricEigen::new(design * design.transpose());
    let largest = eigen.eigenvalues.max();
    let kept: Vec<usize> =
        (0..rows).filter(|&k| eigen.eigenvalues[k] <= SAME_DIRECTION * SAME_DIRECTION * largest).collect();
    (!kept.is_empty()).then(|| eigen.eigenvectors.select_columns(&kept))
}

/// Numbers the distinct loads of some rows.
pub fn same_loads(samples: &Samples, rows: &[usize]) -> Vec<usize> {
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
