//! The eigenvalues of a matrix that is not symmetric, of which some may nearly meet.

use nalgebra::{Complex, DMatrix, Schur};

/// How often the iteration may turn.
const MOST_ITERATIONS: usize = 10_000;

/// What of the size of a matrix is rounding.
const ROUNDING: f64 = 1e-14;

/// The eigenvalues of a real matrix, as its real Schur form has them: one by one, and in pairs.
pub(super) struct Spectrum {
    pub values: Vec<Complex<f64>>,
    /// Whether all are real, to rounding.
    pub are_real: bool,
}

impl Spectrum {
    /// `None` where the iteration does not end, or an entry is not finite.
    ///
    /// Whether a pair is complex is asked of its own block of the Schur form, by what is left of
    /// it without its mean: of eigenvalues that differ by a millionth, trace and determinant no
    /// longer tell, and a stiff direction would hide a pair of soft ones. What is rounding is
    /// so for the size of the whole matrix times that of the couplings within the pair.
    pub fn of(matrix: &DMatrix<f64>) -> Option<Self> {
        let (rotation, _) = Schur::try_new(matrix.clone(), f64::EPSILON, MOST_ITERATIONS)?.unpack();
        // What the iteration took for zero below the diagonal shows up again.
        let form = rotation.transpose() * matrix * &rotation;
        let rounding = ROUNDING * matrix.norm();
        let count = form.nrows();
        let below = |i: usize| if i + 1 < count { form[(i + 1, i)].abs() } else { 0.0 };
        let (mut values, mut are_real) = (Vec::with_capacity(count), true);
        let mut i = 0;
        while i < count {
            if below(i) <= rounding || below(i) < below(i + 1) {
                values.push(form[(i, i)].into());
                i += 1;
                continue;
            }
            let (a, b, c, d) = (form[(i, i)], form[(i, i + 1)], form[(i + 1, i)], form[(i + 1, i + 1)]);
            let squared = squared_difference(a, b, c, d);
            are_real &= squared >= -rounding * ((a - d).abs() + b.abs() + c.abs());
            let half = 0.5 * Complex::from(squared).sqrt();
            let mean = Complex::from(0.5 * (a + d));
            values.extend([mean - half, mean + half]);
            i += 2;
        }
        values.iter().all(|value| value.re.is_finite() && value.im.is_finite()).then_some(Self { values, are_real })
    }

    /// The product of the squared differences: zero where two meet, negative where a pair is
    /// complex.
    pub fn discriminant(&self) -> f64 {
        let pairs = (0..self.values.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let squared = |(i, j): (usize, usize)| (self.values[i] - self.values[j]).powi(2);
        pairs.map(squared).product::<Complex<f64>>().re
    }

    /// The least real part; infinite of none.
    pub fn least(&self) -> f64 {
        self.values.iter().map(|value| value.re).fold(f64::INFINITY, f64::min)
    }
}

/// The square of the difference of the eigenvalues of a 2 x 2 matrix `a b; c d`.
pub(super) fn squared_difference(a: f64, b: f64, c: f64, d: f64) -> f64 {
    (a - d) * (a - d) + 4.0 * b * c
}
