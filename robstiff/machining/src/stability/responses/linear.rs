//! Residues by linear least squares, the poles being known.

use nalgebra::{Cholesky, Complex, DMatrix, DVector, Matrix3, Vector3};

use super::lines::Lines;
use super::model::{Mode, Model, resonance};
use super::poles::Pole;

/// What of the diagonal of scaled normal equations is rounding.
const ROUNDING: f64 = 1e-12;

/// The normal equations of all responses: they have their columns in common, and differ in the right side.
/// The columns are those of the poles, of the modes below the band and of those above it.
pub struct Linear {
    gram: DMatrix<f64>,
    right: Vec<DVector<f64>>,
    scale: DVector<f64>,
    poles: Vec<Pole>,
}

impl Linear {
    /// For these poles.
    pub fn new(lines: &Lines, poles: &[Pole]) -> Self {
        let count = poles.len() + 2;
        let mut gram = DMatrix::zeros(count, count);
        let mut right = vec![DVector::zeros(count); lines.responses.len()];
        for (k, (&frequency, &factor)) in lines.frequencies.iter().zip(&lines.factors).enumerate() {
            let mut row: Vec<Complex<f64>> =
                poles.iter().map(|pole| factor * resonance(pole.frequency, pole.damping, frequency)).collect();
            row.extend([-factor / (frequency * frequency), factor]);
            for (i, one) in row.iter().enumerate() {
                for (j, other) in row.iter().enumerate() {
                    gram[(i, j)] += (one.conj() * other).re;
                }
                for (right, (_, values)) in right.iter_mut().zip(&lines.responses) {
                    right[i] += (one.conj() * values[k]).re;
                }
            }
        }
        let scale = DVector::from_fn(count, |i, _| {
            let size: f64 = gram[(i, i)];
            if size > 0.0 { size.sqrt().recip() } else { 1.0 }
        });
        let gram = DMatrix::from_fn(count, count, |i, j| scale[i] * gram[(i, j)] * scale[j]);
        right.iter_mut().for_each(|right| right.component_mul_assign(&scale));
        Self { gram, right, scale, poles: poles.to_vec() }
    }

    /// The right side of each response for some of the columns, with its solution.
    fn solved(&self, kept: &[usize]) -> Option<Vec<[DVector<f64>; 2]>> {
        let gram = DMatrix::from_fn(kept.len(), kept.len(), |i, j| {
            self.gram[(kept[i], kept[j])] + if i == j { ROUNDING } else { 0.0 }
        });
        let gram = Cholesky::new(gram)?;
        let right = self.right.iter().map(|right| DVector::from_fn(kept.len(), |i, _| right[kept[i]]));
        let solved = |right: DVector<f64>| {
            let solution = gram.solve(&right);
            [right, solution]
        };
        Some(right.map(solved).collect())
    }

    fn without(&self, left_out: Option<usize>) -> Vec<usize> {
        (0..self.poles.len() + 2).filter(|column| Some(*column) != left_out).collect()
    }

    /// The pole of which the responses lose least where it is left out.
    pub fn least(&self) -> Option<usize> {
        let explained = |pole: usize| -> f64 {
            let solved = self.solved(&self.without(Some(pole)));
            solved.iter().flatten().map(|[right, solved]| right.dot(solved)).sum()
        };
        let all = (0..self.poles.len()).map(|pole| (pole, explained(pole)));
        all.max_by(|(_, one), (_, other)| one.total_cmp(other)).map(|(pole, _)| pole)
    }

    /// The model of the poles that have a real shape, a force along some direction moving it that way; with
    /// all of the residual terms.
    pub fn model(&self, lines: &Lines) -> Option<Model> {
        let solved = self.solved(&self.without(None))?;
        let solved: Vec<DVector<f64>> = solved.iter().map(|[_, solved]| solved.component_mul(&self.scale)).collect();
        // Of each pair, the mean of what was measured in both ways.
        let of_pair = |column: usize, pair: usize| {
            let both =
                lines.responses.iter().zip(&solved).filter(|((directions, _), _)| lines.pair(*directions) == pair);
            let (count, sum) = both.fold((0_usize, 0.0), |(count, sum), (_, x)| (count + 1, sum + x[column]));
            sum / count.max(1) as f64
        };
        let pairs = lines.pairs.len();
        let modes = self.poles.iter().enumerate().filter_map(|(column, pole)| {
            let residues: Vec<f64> = (0..pairs).map(|pair| of_pair(column, pair)).collect();
            let shape = shape(&lines.pairs, &residues)?;
            Some(Mode { frequency: pole.frequency, damping: pole.damping, shape })
        });
        let count = self.poles.len();
        let rest = |column: usize| (0..pairs).map(|pair| of_pair(column, pair)).collect();
        Some(Model { modes: modes.collect(), below: Some(rest(count)), above: Some(rest(count + 1)) })
    }
}

/// The shape of which the residues are the products: by all, or by those of the force that moves it most.
fn shape(pairs: &[[usize; 2]], residues: &[f64]) -> Option<Vector3<f64>> {
    let of = |i: usize, j: usize| {
        let place = pairs.iter().position(|pair| *pair == [i.min(j), i.max(j)])?;
        Some(residues[place])
    };
    let shape = if pairs.len() == 6 {
        let matrix = Matrix3::from_fn(|i, j| of(i, j).unwrap_or_default());
        let parts = matrix.symmetric_eigen();
        let most = parts.eigenvalues.imax();
        parts.eigenvectors.column(most) * parts.eigenvalues[most].max(0.0).sqrt()
    } else {
        let column = |j: usize| Some(Vector3::new(of(0, j)?, of(1, j)?, of(2, j)?));
        let columns = (0..3).filter_map(|j| Some((j, column(j)?)));
        let (j, column) = columns.max_by(|(i, one), (j, other)| one[*i].total_cmp(&other[*j]))?;
        column / column[j].max(0.0).sqrt()
    };
    (shape.iter().all(|part| part.is_finite()) && shape.norm() > 0.0).then_some(shape)
}
