//! Factors of small dense matrices, in rows that lie side by side in memory.
//!
//! Thousands of sets are weighed by factors of a few dozen columns; what a general library spends on
//! views and strides is most of their time.

use nalgebra::DMatrix;

/// The lower factor of a symmetric positive definite matrix, `A = L L^T` (Cholesky).
#[derive(Clone, Debug)]
pub struct Factor {
    size: usize,
    /// Row by row, of each as many numbers as there are rows.
    rows: Vec<f64>,
}

/// The product of two vectors, summed in eight parts that the processor forms side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const PARTS: usize = 8;
    let mut parts = [0.0; PARTS];
    let (left, right) = (a.chunks_exact(PARTS), b.chunks_exact(PARTS));
    let rest: f64 = left.remainder().iter().zip(right.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in left.zip(right) {
        for k in 0..PARTS {
            parts[k] += a[k] * b[k];
        }
    }
    rest + parts.iter().sum::<f64>()
}

impl Factor {
    /// The factor of a matrix, of which the entries on and below the diagonal are asked for; none of
    /// one that is not positive definite.
    pub fn new(size: usize, entry: impl Fn(usize, usize) -> f64) -> Option<Self> {
        let mut rows = vec![0.0; size * size];
        for i in 0..size {
            let (before, own) = rows.split_at_mut(i * size);
            for j in 0..i {
                let other = &before[j * size..j * size + j];
                own[j] = (entry(i, j) - dot(&own[..j], other)) / before[j * size + j];
            }
            let square = entry(i, i) - dot(&own[..i], &own[..i]);
            if !(square > 0.0 && square.is_finite()) {
                return None;
            }
            own[i] = square.sqrt();
        }
        Some(Self { size, rows })
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * self.size..i * self.size + i + 1]
    }

    /// The logarithm of the determinant of `L`.
    pub fn log_det(&self) -> f64 {
        (0..self.size).map(|i| self.row(i)[i].ln()).sum()
    }

    /// `L^-1 v`, in place.
    pub fn solve_lower(&self, v: &mut [f64]) {
        for i in 0..self.size {
            let row = self.row(i);
            v[i] = (v[i] - dot(&row[..i], &v[..i])) / row[i];
        }
    }

    /// `L^-T v`, in place.
    pub fn solve_upper(&self, v: &mut [f64]) {
        for i in (0..self.size).rev() {
            let row = self.row(i);
            v[i] /= row[i];
            let own = v[i];
            v[..i].iter_mut().zip(row).for_each(|(v, l)| *v -= l * own);
        }
    }

    /// `L^-1 B`, in place; `B` is given by its transpose, a column for each row of it.
    pub fn solve_lower_transposed(&self, transposed: &mut DMatrix<f64>) {
        let height = transposed.nrows();
        let all = transposed.as_mut_slice();
        for i in 0..self.size {
            let (before, own) = all.split_at_mut(i * height);
            let own = &mut own[..height];
            let row = self.row(i);
            for (j, l) in row[..i].iter().enumerate() {
                let other = &before[j * height..(j + 1) * height];
                own.iter_mut().zip(other).for_each(|(own, other)| *own -= l * other);
            }
            own.iter_mut().for_each(|own| *own /= row[i]);
        }
    }

    /// The rows of `L^-1`, each as long as it has entries that are not zero.
    fn inverse_rows(&self) -> Vec<f64> {
        let size = self.size;
        let mut inverse = vec![0.0; size * size];
        for i in 0..size {
            let (before, own) = inverse.split_at_mut(i * size);
            let row = self.row(i);
            let own = &mut own[..=i];
            for (k, l) in row[..i].iter().enumerate() {
                let other = &before[k * size..k * size + k + 1];
                own.iter_mut().zip(other).for_each(|(own, other)| *own -= l * other);
            }
            own[i] += 1.0;
            own.iter_mut().for_each(|own| *own /= row[i]);
        }
        inverse
    }

    /// The diagonal of the inverse of the matrix.
    pub fn inverse_diagonal(&self) -> Vec<f64> {
        let (size, rows) = (self.size, self.inverse_rows());
        let mut diagonal = vec![0.0; size];
        for i in 0..size {
            let row = &rows[i * size..i * size + i + 1];
            diagonal.iter_mut().zip(row).for_each(|(sum, l)| *sum += l * l);
        }
        diagonal
    }

    /// The inverse of the matrix.
    pub fn inverse(&self) -> DMatrix<f64> {
        let (size, rows) = (self.size, self.inverse_rows());
        let lower = DMatrix::from_row_slice(size, size, &rows);
        lower.tr_mul(&lower)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_those_of_the_library() {
        for size in [0, 1, 3, 17, 40] {
            let root = DMatrix::from_fn(size, size + 2, |i, j| (1.1 * i as f64 + 0.7 * (j * j) as f64).sin());
            let matrix = &root * root.transpose() + DMatrix::identity(size, size) * 0.1;
            let factor = Factor::new(size, |i, j| matrix[(i, j)]).expect("positive");
            let expected = matrix.clone().cholesky().expect("positive");
            let inverse = expected.inverse();
            assert!((factor.inverse() - &inverse).amax() < 1e-10 || size == 0);
            let diagonal = factor.inverse_diagonal();
            assert!((0..size).all(|k| (diagonal[k] - inverse[(k, k)]).abs() < 1e-10));
            assert!((2.0 * factor.log_det() - expected.determinant().ln()).abs() < 1e-9);
            let mut v: Vec<f64> = (0..size).map(|k| k as f64 - 2.0).collect();
            let solved = expected.solve(&nalgebra::DVector::from_column_slice(&v));
            let mut many = DMatrix::from_fn(3, size, |k, j| (k + 1) as f64 * v[j]);
            factor.solve_lower(&mut v);
            factor.solve_lower_transposed(&mut many);
            assert!((0..size).all(|j| (many[(2, j)] - 3.0 * v[j]).abs() < 1e-12));
            factor.solve_upper(&mut v);
            assert!((0..size).all(|k| (v[k] - solved[k]).abs() < 1e-9));
        }
        assert!(Factor::new(2, |i, j| if i == j { 1.0 } else { 2.0 }).is_none());
    }
}
