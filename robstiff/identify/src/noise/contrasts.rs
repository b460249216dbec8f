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

use nalgebra::linalg::QR;
use nalgebra::{DMatrix, SymmetricEigen};

use super::samples::Samples;

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
/// free response, since the effort is quadratic.
const MOST_ROWS: usize = 60;

/// Of the unloaded reading of a row, what is left by rounding.
const NOTHING: f64 = 1e-9;

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
    let visits: Vec<usize> = rows.iter().map(|&row| samples.rows[row].visit).collect();
    let mut distinct = visits.clone();
    distinct.sort_unstable();
    distinct.dedup();
    let free = free(samples, level, &rows);
    // What is left of the unloaded readings, made orthonormal: those contrasts hold
    // them, all others do not.
    let unloaded = DMatrix::from_fn(rows.len(), distinct.len(), |i, j| f64::from(u8::from(visits[i] == distinct[j])));
    let unloaded = &unloaded - &free * free.tr_mul(&unloaded);
    let shared = SymmetricEigen::new(unloaded.tr_mul(&unloaded));
    let left: Vec<usize> = (0..distinct.len()).filter(|&k| shared.eigenvalues[k] > NOTHING).collect();
    let mut shares: Vec<f64> = left.iter().map(|&k| shared.eigenvalues[k]).collect();
    let mut holding = unloaded * shared.eigenvectors.select_columns(&left);
    holding.column_iter_mut().zip(&shares).for_each(|(mut column, share)| column /= share.sqrt());
    let rest = complement(&beside(&free, &holding));
    shares.resize(left.len() + rest.ncols(), 0.0);
    let basis = beside(&holding, &rest);
    let values = basis.tr_mul(&readings.select_rows(&rows));
    (!shares.is_empty()).then_some(Chunk { rows, visits, basis, shares, values })
}

/// An orthonormal basis of what is free at a pose.
fn free(samples: &Samples, level: Level, rows: &[usize]) -> DMatrix<f64> {
    let largest = rows.iter().map(|&row| samples.rows[row].wrench.norm()).fold(f64::MIN_POSITIVE, f64::max);
    let design = match level {
        Level::Linear => DMatrix::from_fn(rows.len(), 6, |i, k| samples.rows[rows[i]].wrench[k] / largest),
        Level::Curved => DMatrix::from_fn(rows.len(), 12, |i, k| {
            let wrench = &samples.rows[rows[i]].wrench;
            let size = wrench.norm() / largest;
            wrench[k % 6] / largest * if k < 6 { 1.0 } else { size }
        }),
        Level::Repeated => {
            let loads = same_loads(samples, rows);
            let count = loads.iter().max().map_or(0, |last| last + 1);
            let mut same = DMatrix::from_fn(rows.len(), count, |i, j| f64::from(u8::from(loads[i] == j)));
            same.column_iter_mut().for_each(|mut column| _ = column.normalize_mut());
            return same;
        }
    };
    let directions = SymmetricEigen::new(design.tr_mul(&design));
    let from = SAME_DIRECTION * SAME_DIRECTION * directions.eigenvalues.max();
    let kept: Vec<usize> = (0..design.ncols()).filter(|&k| directions.eigenvalues[k] > from).collect();
    QR::new(design * directions.eigenvectors.select_columns(&kept)).q()
}

/// An orthonormal basis of what is orthogonal to some orthonormal columns.
fn complement(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let (rows, count) = columns.shape();
    let mut turned = DMatrix::identity(rows, rows);
    QR::new(columns.clone()).q_tr_mul(&mut turned);
    turned.rows(count.min(rows), rows.saturating_sub(count)).transpose()
}

fn beside(left: &DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(left.nrows(), left.ncols() + right.ncols(), |i, j| match j.checked_sub(left.ncols()) {
        Some(j) => right[(i, j)],
        None => left[(i, j)],
    })
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
