//! What fits need to know of the rows.
//!
//! With columns `Z` and readings `y`, whitened by their covariance, all that a fit asks for is
//! `[Z y]^T [Z y]`. It is kept for groups of poses, so that leaving a group out is a subtraction.

use nalgebra::{DMatrix, DVector, Matrix3};

use super::noise::{Noise, discrepancies, rows_of_blocks};
use crate::observe::Readings;

/// The Gram matrix of whitened columns and, behind them, the readings.
#[derive(Clone, Debug)]
pub struct Gram {
    /// The matrix.
    pub matrix: DMatrix<f64>,
    /// The logarithm of the determinant of the covariance, over `s^2`.
    pub log_det: f64,
    /// How many readings there are.
    pub count: f64,
}

impl Gram {
    fn zero(columns: usize) -> Self {
        Self { matrix: DMatrix::zeros(columns, columns), log_det: 0.0, count: 0.0 }
    }

    /// The sum of squares of a column that some others leave. None where these do not stand by themselves.
    pub fn left_of(&self, column: usize, others: &[usize]) -> Option<f64> {
        let among = self.matrix.select_columns(others).select_rows(others);
        let with = self.matrix.select_columns(&[column]).select_rows(others);
        let taken = among.cholesky()?.solve(&with).dot(&with);
        Some((self.matrix[(column, column)] - taken).max(0.0))
    }

    fn add(&mut self, other: &Self, sign: f64) {
        self.matrix += &other.matrix * sign;
        self.log_det += other.log_det * sign;
        self.count += other.count * sign;
    }
}

/// Gram matrices under each discrepancy, of groups of blocks.
#[derive(Clone, Debug)]
pub struct Grams {
    /// Under each discrepancy, of all groups together.
    pub total: Vec<Gram>,
    /// Under each discrepancy, of each group; empty where there is one group only.
    groups: Vec<Vec<Gram>>,
}

impl Grams {
    /// Of columns with the readings behind them, a row of which is a reading. `group` says the group
    /// of each block from 0; none for one that is not fitted to.
    pub fn new(readings: &Readings, noise: &Noise, columns: &DMatrix<f64>, group: &[Option<usize>]) -> Self {
        let kappas = discrepancies(readings);
        let training: Vec<bool> = group.iter().map(Option::is_some).collect();
        let rows = rows_of_blocks(readings, &training);
        let count = group.iter().flatten().max().map_or(0, |last| last + 1);
        let groups: Vec<Vec<Gram>> = {
            let mut by_group = Vec::with_capacity(count);
            for of in 0..count {
                let blocks: Vec<&[usize]> = rows
                    .iter()
                    .zip(group)
                    .filter(|(rows, group)| **group == Some(of) && !rows.is_empty())
                    .map(|(rows, _)| rows.as_slice())
                    .collect();
                by_group.push(of_group(readings, noise, columns, &blocks, kappas));
            }
            (0..kappas.len()).map(|k| by_group.iter().map(|grams: &Vec<Gram>| grams[k].clone()).collect()).collect()
        };
        let total = groups.iter().map(|groups: &Vec<Gram>| {
            let mut total = Gram::zero(columns.ncols());
            groups.iter().for_each(|group| total.add(group, 1.0));
            total
        });
        let total = total.collect();
        Self { total, groups: if count > 1 { groups } else { Vec::new() } }
    }

    /// The same without one of the groups.
    pub fn without(&self, group: usize) -> Self {
        let less = |(total, groups): (&Gram, &Vec<Gram>)| {
            let mut total = total.clone();
            total.add(&groups[group], -1.0);
            total
        };
        Self { total: self.total.iter().zip(&self.groups).map(less).collect(), groups: Vec::new() }
    }
}

/// The Gram matrix of the whitened columns of each block, under one discrepancy.
pub fn of_each_block(readings: &Readings, noise: &Noise, columns: &DMatrix<f64>, kappa: f64) -> Vec<DMatrix<f64>> {
    let rows = rows_of_blocks(readings, &vec![true; readings.blocks]);
    let of_block = |rows: &Vec<usize>| {
        let gram = of_group(readings, noise, columns, &[rows.as_slice()], &[kappa]).pop();
        gram.map_or_else(|| DMatrix::zeros(columns.ncols(), columns.ncols()), |gram| gram.matrix)
    };
    rows.iter().map(of_block).collect()
}

/// The Gram matrices of some blocks, under each discrepancy.
fn of_group(
    readings: &Readings,
    noise: &Noise,
    columns: &DMatrix<f64>,
    blocks: &[&[usize]],
    kappas: &[f64],
) -> Vec<Gram> {
    let (width, wide) = (readings.width, columns.ncols());
    let count: usize = blocks.iter().map(|rows| rows.len() * width).sum();
    let shared: Vec<usize> = (0..width).filter(|k| readings.channels[*k] < 2).collect();
    let encoders: Vec<usize> = (0..width).filter(|k| readings.channels[*k] >= 2).collect();
    let mut white = DMatrix::zeros(count, wide);
    let mut plain = 0.0;
    let is_discrepant = kappas.iter().any(|kappa| *kappa > 0.0);
    // The directions of the load in each block, whitened: three for each axis that yields.
    let mut loads: Vec<(Matrix3<f64>, usize)> = Vec::new();
    let mut loaded = DMatrix::zeros(if is_discrepant { 3 * shared.len() * blocks.len() } else { 0 }, wide);
    let (mut at, mut at_load) = (0, 0);
    for rows in blocks {
        let Some(factor) = noise.of_block(readings, rows).cholesky() else { continue };
        let lower = factor.l();
        plain += 2.0 * lower.diagonal().iter().map(|d| d.ln()).sum::<f64>() * shared.len() as f64;
        let forces = DMatrix::from_fn(rows.len(), 3, |i, k| readings.force[rows[i]][k]);
        let forces = lower.solve_lower_triangular(&forces).unwrap_or(forces);
        for &axis in &shared {
            let scale = noise.scales[readings.channels[axis]];
            let of_axis = DMatrix::from_fn(rows.len(), wide, |i, j| columns[(rows[i] * width + axis, j)] * scale);
            let of_axis = lower.solve_lower_triangular(&of_axis).unwrap_or(of_axis);
            plain -= 2.0 * scale.ln() * rows.len() as f64;
            if is_discrepant {
                loaded.rows_mut(at_load, 3).copy_from(&forces.tr_mul(&of_axis));
                at_load += 3;
            }
            white.rows_mut(at, rows.len()).copy_from(&of_axis);
            at += rows.len();
        }
        if !encoders.is_empty() {
            let Some(factor) = noise.of_encoder(readings, rows).cholesky() else { continue };
            let lower = factor.l();
            let log_det = 2.0 * lower.diagonal().iter().map(|d| d.ln()).sum::<f64>();
            for &axis in &encoders {
                let scale = noise.scales[readings.channels[axis]];
                let of_axis = DMatrix::from_fn(rows.len(), wide, |i, j| columns[(rows[i] * width + axis, j)] * scale);
                let of_axis = lower.solve_lower_triangular(&of_axis).unwrap_or(of_axis);
                plain += log_det - 2.0 * scale.ln() * rows.len() as f64;
                white.rows_mut(at, rows.len()).copy_from(&of_axis);
                at += rows.len();
            }
        }
        loads.push(((forces.tr_mul(&forces)).fixed_view::<3, 3>(0, 0).into_owned(), shared.len()));
    }
    let whole = square(&white);
    let under = |&kappa: &f64| {
        let kappa = noise.lack() * kappa;
        if kappa == 0.0 {
            return Gram { matrix: whole.clone(), log_det: plain, count: count as f64 };
        }
        let mut log_det = plain;
        let mut taken = loaded.clone();
        let mut at = 0;
        for (square, axes) in &loads {
            // By Woodbury's identity, with (I / kappa + W^T W)^-1 = N N^T.
            let inner = Matrix3::identity() / kappa + square;
            log_det += *axes as f64 * (inner.determinant() * kappa.powi(3)).ln();
            let Some(root) = inner.cholesky().map(|factor| factor.l()) else { continue };
            for _ in 0..*axes {
                let mut rows = taken.fixed_rows_mut::<3>(at);
                root.solve_lower_triangular_mut(&mut rows);
                at += 3;
            }
        }
        Gram { matrix: &whole - square(&taken), log_det, count: count as f64 }
    };
    kappas.iter().map(under).collect()
}

/// Columns that are multiplied at once: a product of so many is as quick, each, as of all.
const AT_ONCE: usize = 128;

/// `M^T M`; by products of some columns with those from there on, for it is symmetric.
fn square(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let (wide, turned) = (matrix.ncols(), matrix.transpose());
    let mut square = DMatrix::zeros(wide, wide);
    for first in (0..wide).step_by(AT_ONCE) {
        let (some, rest) = (AT_ONCE.min(wide - first), wide - first);
        let mut below = square.view_mut((first, first), (rest, some));
        below.gemm(1.0, &turned.rows(first, rest), &matrix.columns(first, some), 0.0);
    }
    square.fill_upper_triangle_with_lower_triangle();
    square
}

/// Columns with the readings behind them.
pub fn with_target(columns: DMatrix<f64>, target: &DVector<f64>) -> DMatrix<f64> {
    let last = columns.ncols();
    let mut all = columns.resize_horizontally(last + 1, 0.0);
    all.set_column(last, target);
    all
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::regression::encoders::Level;
    use crate::regression::noise::DISCREPANCIES;

    fn readings() -> Readings {
        let rows = 7;
        Readings {
            values: DVector::from_fn(rows * 4, |i, _| (1.3 * i as f64).sin()),
            width: 4,
            reported: 3,
            channels: vec![0, 0, 0, 2],
            block: vec![0, 0, 0, 1, 1, 2, 2],
            blocks: 3,
            stratum: vec![0; 3],
            visit: vec![0, 0, 1, 2, 2, 3, 4],
            force: (0..rows).map(|i| Vector3::new((i as f64).cos(), 0.3, (2.0 * i as f64).sin())).collect(),
            lines: (2..rows + 2).collect(),
            differences: true,
        }
    }

    /// Woodbury's way gives what the whole covariance does, and groups add up.
    #[test]
    fn grams_are_those_of_the_whole_covariance() {
        let readings = readings();
        let mut noise = Noise::plain(&readings, 0.5);
        noise.weights[2] = 0.2;
        noise.level = (Level::Block, 40.0);
        let columns = DMatrix::from_fn(readings.values.len(), 2, |i, j| ((3 * i + 5 * j) as f64).cos());
        let all = with_target(columns, &readings.values);
        let grams = Grams::new(&readings, &noise, &all, &[Some(0), Some(1), Some(1)]);
        for (k, kappa) in DISCREPANCIES.into_iter().enumerate() {
            let size = readings.values.len();
            let of = |i: usize, j: usize| {
                let (a, b) = ((i / 4, i % 4), (j / 4, j % 4));
                let scale = noise.scales[readings.channels[a.1]] * noise.scales[readings.channels[b.1]];
                let same = readings.block[a.0] == readings.block[b.0] && a.1 == b.1;
                let own = if i == j { noise.of_row(a.0) } else { 0.0 };
                let shared = if same && a.1 == 3 {
                    // What the rows of a pose share in an encoder says nothing, and has no part of the load.
                    noise.level.1
                } else if same {
                    let visit = if readings.visit[a.0] == readings.visit[b.0] { 1.0 } else { 0.0 };
                    visit + kappa * readings.force[a.0].dot(&readings.force[b.0])
                } else {
                    0.0
                };
                (own + shared) / scale
            };
            let covariance = DMatrix::from_fn(size, size, of);
            let expected = all.tr_mul(&covariance.clone().cholesky().expect("positive").solve(&all));
            let found = &grams.total[k];
            assert!((&found.matrix - &expected).amax() < 1e-9 * expected.amax(), "{kappa}");
            assert!((found.log_det - covariance.determinant().ln()).abs() < 1e-9, "{kappa}");
            assert_eq!(found.count, size as f64);
            let rest = Grams::new(&readings, &noise, &all, &[Some(0), None, None]);
            let each = of_each_block(&readings, &noise, &all, kappa);
            assert!((each.iter().sum::<DMatrix<f64>>() - &expected).amax() < 1e-9 * expected.amax());
            assert!((&each[0] - &rest.total[k].matrix).amax() < 1e-9 * expected.amax());
            let without = grams.without(1);
            assert!((&without.total[k].matrix - &rest.total[k].matrix).amax() < 1e-9 * expected.amax());
            assert!((without.total[k].log_det - rest.total[k].log_det).abs() < 1e-9);
        }
    }
}
