//! Least squares from its normal equations, with coefficients that must not
//! be negative where they are compliances.

use std::vec;
use std::vec::Vec;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Which values a coefficient may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Zero or more: a compliance.
    Nonnegative,
    /// Anything: a coupling, the change of a compliance with torque.
    Free,
}

/// The normal equations of a least-squares problem `y = X b`: `X^T X`,
/// `X^T y`, `y^T y` and the number of rows. They add up over blocks of rows,
/// so that leaving a block out is a subtraction.
#[derive(Clone, Debug)]
pub struct Normal {
    /// `X^T X`.
    pub gram: DMatrix<f64>,
    /// `X^T y`.
    pub moment: DVector<f64>,
    /// `y^T y`.
    pub energy: f64,
    /// The number of rows.
    pub rows: usize,
}

/// Coefficients of some of the columns.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The columns, by their index in the normal equations.
    pub columns: Vec<usize>,
    /// Their coefficients, in the same order.
    pub coefficients: DVector<f64>,
    /// The sum of squared residuals.
    pub rss: f64,
}

/// A coefficient that is a constant and so much of others, by their place.
#[derive(Clone, Debug, Default)]
pub struct Tie {
    /// The constant.
    pub constant: f64,
    /// The others with their factors.
    pub to: Vec<(usize, f64)>,
}

impl Normal {
    /// The normal equations of `x`, `y`.
    pub fn new(x: &DMatrix<f64>, y: &DVector<f64>) -> Self {
        // The product of two stored matrices is the one that is fast, of parts that fit a cache.
        // Of a symmetric one the half below the diagonal is enough, in strips that hang from it.
        let (rows, count) = x.shape();
        let mut gram = DMatrix::zeros(count, count);
        for from in (0..rows).step_by(PART) {
            let part = x.rows(from, PART.min(rows - from));
            let transposed = part.transpose();
            for first in (0..count).step_by(STRIP) {
                let (width, below) = (STRIP.min(count - first), count - first);
                let mut strip = gram.view_mut((first, first), (below, width));
                strip.gemm(1.0, &transposed.rows(first, below), &part.columns(first, width), 1.0);
            }
        }
        gram.fill_upper_triangle_with_lower_triangle();
        Self { gram, moment: x.tr_mul(y), energy: y.norm_squared(), rows: y.len() }
    }

    /// The normal equations of some rows of `x`, `y`, each once.
    pub fn of_rows(x: &DMatrix<f64>, y: &DVector<f64>, rows: &[usize]) -> Self {
        if rows.len() == x.nrows() {
            return Self::new(x, y);
        }
        let part = |rows: &[usize]| Self::new(&x.select_rows(rows), &y.select_rows(rows));
        Self::sum(rows.chunks(COPIED).map(part)).unwrap_or_else(|| part(&[]))
    }

    /// The sum over blocks of rows; `None` without any.
    pub fn sum(blocks: impl IntoIterator<Item = Self>) -> Option<Self> {
        let mut blocks = blocks.into_iter();
        let mut sum = blocks.next()?;
        for block in blocks {
            sum.gram += &block.gram;
            sum.moment += &block.moment;
            sum.energy += block.energy;
            sum.rows += block.rows;
        }
        Some(sum)
    }

    /// The Gram matrix of some columns.
    pub fn gram_of(&self, columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(columns.len(), columns.len(), |i, j| self.gram[(columns[i], columns[j])])
    }

    /// `X^T y` of some columns.
    pub fn moment_of(&self, columns: &[usize]) -> DVector<f64> {
        DVector::from_fn(columns.len(), |i, _| self.moment[columns[i]])
    }

    /// The sum of squared residuals with given coefficients.
    pub fn rss(&self, columns: &[usize], coefficients: &DVector<f64>) -> f64 {
        let quadratic = coefficients.dot(&(self.gram_of(columns) * coefficients));
        (self.energy - 2.0 * coefficients.dot(&self.moment_of(columns)) + quadratic).max(0.0)
    }

    /// Ordinary least squares on some columns; `None` where they are collinear.
    pub fn solve(&self, columns: &[usize]) -> Option<Fit> {
        let coefficients = Scaled::new(self, columns)?.solve(&self.moment_of(columns));
        let rss = self.rss(columns, &coefficients);
        Some(Fit { columns: columns.to_vec(), coefficients, rss })
    }

    /// Least squares with signs, by the active-set method of Lawson and Hanson
    /// (Solving Least Squares Problems, 1974, chapter 23) on the normal
    /// equations; `signs` holds one for each of `columns`. `None` where the
    /// columns are collinear.
    pub fn solve_signed(&self, columns: &[usize], signs: &[Sign]) -> Option<Fit> {
        let count = columns.len();
        let (gram, moment) = (self.gram_of(columns), self.moment_of(columns));
        // A column's share of the energy, by which a gradient counts as zero.
        let tolerance = |i: usize| GRADIENT_TOLERANCE * (gram[(i, i)] * self.energy).sqrt();
        let mut passive: Vec<bool> = signs.iter().map(|sign| *sign == Sign::Free).collect();
        let mut solution = restricted(&gram, &moment, &passive)?;
        // Every pass but the last lets one column in, and the sum of squares
        // falls each time, so no set comes twice; the bound is for rounding.
        for _ in 0..3 * count + 3 {
            let gradient = &moment - &gram * &solution;
            let entering = (0..count)
                .filter(|&i| !passive[i] && gradient[i] > tolerance(i))
                .max_by(|&i, &j| gain(&gradient, &gram, i).total_cmp(&gain(&gradient, &gram, j)));
            let Some(entering) = entering else { break };
            passive[entering] = true;
            loop {
                let target = restricted(&gram, &moment, &passive)?;
                let blocked = |i: &usize| passive[*i] && signs[*i] == Sign::Nonnegative && target[*i] <= 0.0;
                let step = |i: usize| solution[i] / (solution[i] - target[i]);
                let Some(first) = (0..count).filter(blocked).min_by(|&i, &j| step(i).total_cmp(&step(j))) else {
                    solution = target;
                    break;
                };
                let fraction = step(first).clamp(0.0, 1.0);
                solution += (target - &solution) * fraction;
                passive[first] = false;
                solution[first] = 0.0;
            }
        }
        let rss = self.rss(columns, &solution);
        Some(Fit { columns: columns.to_vec(), coefficients: solution, rss })
    }

    /// The same with coefficients that are tied to others, one for each of `columns`.
    pub fn solve_tied(&self, columns: &[usize], signs: &[Sign], ties: &[Option<Tie>]) -> Option<Fit> {
        let free: Vec<usize> = (0..columns.len()).filter(|&k| ties[k].is_none()).collect();
        let place = |k: usize| free.iter().position(|&other| other == k);
        let mut spread = DMatrix::zeros(columns.len(), free.len());
        let mut constant = DVector::zeros(columns.len());
        free.iter().enumerate().for_each(|(i, &k)| spread[(k, i)] = 1.0);
        for (k, tie) in ties.iter().enumerate() {
            let Some(tie) = tie else { continue };
            constant[k] = tie.constant;
            for &(to, factor) in &tie.to {
                spread[(k, place(to)?)] += factor;
            }
        }
        let gram = self.gram_of(columns);
        let rest = Self {
            moment: spread.tr_mul(&(self.moment_of(columns) - &gram * &constant)),
            gram: spread.tr_mul(&(gram * &spread)),
            energy: self.energy,
            rows: self.rows,
        };
        let signs: Vec<Sign> = free.iter().map(|&k| signs[k]).collect();
        let fit = rest.solve_signed(&(0..free.len()).collect::<Vec<_>>(), &signs)?;
        let coefficients = spread * fit.coefficients + constant;
        let rss = self.rss(columns, &coefficients);
        Some(Fit { columns: columns.to_vec(), coefficients, rss })
    }

    /// The inverse of the Gram matrix of some columns, the covariance of their
    /// least-squares coefficients over the variance of a row; `None` where
    /// they are collinear.
    pub fn inverse(&self, columns: &[usize]) -> Option<DMatrix<f64>> {
        Some(Scaled::new(self, columns)?.inverse())
    }
}

/// Rows whose products are added to a Gram matrix at once, and columns of a strip of it.
const PART: usize = 256;
const STRIP: usize = 64;

/// Rows that are copied at once where not all are asked for.
const COPIED: usize = 512;

/// A gradient this small against the largest there can be is zero.
const GRADIENT_TOLERANCE: f64 = 1e-12;

/// Columns that are this near to the span of those before them, by the square
/// of the sine of the angle between, are collinear: a few digits above what
/// rounding leaves in the normal equations.
pub const COLLINEAR: f64 = 1e-9;

fn gain(gradient: &DVector<f64>, gram: &DMatrix<f64>, i: usize) -> f64 {
    gradient[i] * gradient[i] / gram[(i, i)]
}

/// Least squares on the passive columns, zero elsewhere.
fn restricted(gram: &DMatrix<f64>, moment: &DVector<f64>, passive: &[bool]) -> Option<DVector<f64>> {
    let set: Vec<usize> = (0..passive.len()).filter(|&i| passive[i]).collect();
    let mut solution = DVector::zeros(passive.len());
    if set.is_empty() {
        return Some(solution);
    }
    let inner = DMatrix::from_fn(set.len(), set.len(), |i, j| gram[(set[i], set[j])]);
    let right = DVector::from_fn(set.len(), |i, _| moment[set[i]]);
    let part = Scaled::of(&inner)?.solve(&right);
    for (k, &i) in set.iter().enumerate() {
        solution[i] = part[k];
    }
    Some(solution)
}

/// A Gram matrix scaled to a unit diagonal and factorised: compliances differ
/// by orders of magnitude, and so do their columns.
pub struct Scaled {
    factor: Cholesky<f64, Dyn>,
    scale: DVector<f64>,
}

impl Scaled {
    fn new(normal: &Normal, columns: &[usize]) -> Option<Self> {
        Self::of(&normal.gram_of(columns))
    }

    /// The factors of a Gram matrix; `None` where its columns are collinear.
    pub fn of(gram: &DMatrix<f64>) -> Option<Self> {
        Self::apart(gram, COLLINEAR)
    }

    /// The same; `None` where a column is nearer than this, by the square of
    /// the sine of the angle between, to the span of those before it.
    pub fn apart(gram: &DMatrix<f64>, least: f64) -> Option<Self> {
        let scale = gram.diagonal().map(|norm| 1.0 / norm.sqrt());
        if !scale.iter().all(|s| s.is_finite()) {
            return None;
        }
        let scaled = DMatrix::from_fn(gram.nrows(), gram.ncols(), |i, j| gram[(i, j)] * scale[i] * scale[j]);
        let factor = Cholesky::new(scaled)?;
        let near = factor.l_dirty().diagonal().iter().any(|d| d * d < least);
        (!near).then_some(Self { factor, scale })
    }

    /// The solution for a right-hand side.
    pub fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        self.factor.solve(&right.component_mul(&self.scale)).component_mul(&self.scale)
    }

    /// The solutions for the columns of a right-hand side.
    pub fn solve_columns(&self, right: &DMatrix<f64>) -> DMatrix<f64> {
        let mut scaled = right.clone();
        for mut column in scaled.column_iter_mut() {
            column.component_mul_assign(&self.scale);
        }
        let mut solved = self.factor.solve(&scaled);
        for mut column in solved.column_iter_mut() {
            column.component_mul_assign(&self.scale);
        }
        solved
    }

    /// The inverse of the Gram matrix.
    pub fn inverse(&self) -> DMatrix<f64> {
        self.solve_columns(&DMatrix::identity(self.scale.len(), self.scale.len()))
    }
}

/// Columns in order, without those that are zero or collinear with the ones
/// kept before them; and those left out.
pub fn independent(gram: &DMatrix<f64>, columns: &[usize], smallest: f64) -> (Vec<usize>, Vec<usize>) {
    let (mut kept, mut left_out): (Vec<usize>, Vec<usize>) = (vec![], vec![]);
    for &column in columns {
        let mut with = kept.clone();
        with.push(column);
        let seen = gram[(column, column)] > smallest;
        let inner = DMatrix::from_fn(with.len(), with.len(), |i, j| gram[(with[i], with[j])]);
        if seen && Scaled::of(&inner).is_some() { kept = with } else { left_out.push(column) }
    }
    (kept, left_out)
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// A problem whose unconstrained solution has coefficients of both signs.
    fn problem(seed: u64) -> (Normal, DMatrix<f64>, DVector<f64>) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let x = DMatrix::from_fn(40, 6, |_, j| rng.random_range(-1.0..1.0) * 10_f64.powi(j as i32));
        let truth = DVector::from_fn(6, |j, _| rng.random_range(-1.0..1.0) / 10_f64.powi(j as i32));
        let y = &x * truth + DVector::from_fn(40, |_, _| rng.random_range(-0.5..0.5));
        (Normal::new(&x, &y), x, y)
    }

    #[test]
    fn signed_solutions_meet_the_kuhn_tucker_conditions() {
        let columns = [0, 1, 2, 3, 4, 5];
        for seed in 0..50 {
            let (normal, x, y) = problem(seed);
            let signs = core::array::from_fn::<_, 6, _>(|i| if i == 3 { Sign::Free } else { Sign::Nonnegative });
            let fit = normal.solve_signed(&columns, &signs).expect("independent columns");
            let gradient = x.tr_mul(&(&y - &x * &fit.coefficients));
            for i in columns {
                let scale = normal.gram[(i, i)].sqrt() * normal.energy.sqrt();
                let stationary = gradient[i].abs() < 1e-9 * scale;
                let held_back = signs[i] == Sign::Nonnegative && fit.coefficients[i] == 0.0 && gradient[i] < 0.0;
                assert!(stationary || held_back, "seed {seed}, column {i}");
                assert!(signs[i] == Sign::Free || fit.coefficients[i] >= 0.0);
            }
            assert!((fit.rss - (&y - &x * &fit.coefficients).norm_squared()).abs() < 1e-9 * normal.energy);
        }
    }

    #[test]
    fn blocks_add_up() {
        let (whole, x, y) = problem(7);
        let part =
            |from: usize, rows: usize| Normal::new(&x.rows(from, rows).into_owned(), &y.rows(from, rows).into_owned());
        let (first, second) = (part(0, 15), part(15, 25));
        let sum = Normal::sum([first, second]).expect("two blocks");
        assert!((&sum.gram - &whole.gram).amax() < 1e-9 * whole.gram.amax());
        assert_eq!(sum.rows, 40);
    }

    #[test]
    fn collinear_columns_are_found() {
        let (_, x, y) = problem(1);
        let mut doubled = x.clone().insert_column(6, 0.0);
        let sum = x.column(0) * 3.0 - x.column(2);
        doubled.set_column(6, &sum);
        let normal = Normal::new(&doubled, &y);
        assert!(normal.solve(&[0, 1, 2, 6]).is_none());
        assert_eq!(independent(&normal.gram, &[0, 1, 2, 6, 4], 0.0), (vec![0, 1, 2, 4], vec![6]));
    }
}
