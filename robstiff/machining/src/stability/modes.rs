//! The modes of an arm at its tool, and whether they are stable in a cut.

use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, SymmetricEigen};

use super::spectrum::{Spectrum, squared_difference};
use robstiff::analysis::resolution;

/// The modes of the tool on the arm, without a cut: of one mass at the tool as many as there
/// are directions in which the arm yields, one to three; of the links' masses more.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// The translational compliance (m/N).
    pub(super) compliance: Matrix3<f64>,
    /// Natural frequencies (rad/s), the lowest first.
    pub(super) frequencies: DVector<f64>,
    /// What a unit of each mode moves the tool by, 3 x modes, where a force on the tool
    /// accelerates it by `shapes^T f` (1/sqrt(kg)).
    pub(super) shapes: DMatrix<f64>,
    /// What of the compliance no mode has (m/N): what it moves has no mass.
    pub(super) massless: Matrix3<f64>,
    /// The damping ratio of each mode.
    pub(super) damping: DVector<f64>,
}

impl Modes {
    /// The modes with a translational compliance (m/N) and a mass at the tool
    /// (kg), both 3 x 3, symmetric and in one frame; `damping` is the damping
    /// ratio of every mode, 0 for none.
    ///
    /// A direction in which the arm yields less than
    /// [`resolution`](robstiff::analysis::resolution) times what it yields in its
    /// softest is rigid. `None` where an entry is not finite, the mass is not
    /// positive definite, or the damping is negative.
    pub fn new(compliance: &Matrix3<f64>, mass: &Matrix3<f64>, damping: f64) -> Option<Self> {
        let finite = compliance.iter().chain(mass.iter()).all(|entry| entry.is_finite());
        if !(finite && damping.is_finite() && damping >= 0.0) {
            return None;
        }
        let compliance = 0.5 * (compliance + compliance.transpose());
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(compliance);
        let rigid = eigenvalues.amax() * resolution::<f64>();
        let soft: std::vec::Vec<usize> = (0..3).filter(|&i| eigenvalues[i] > rigid).collect();
        let count = soft.len();
        mass.cholesky()?;
        if count == 0 {
            // Where nothing moves there is nothing to solve.
            let (frequencies, shapes) = (DVector::zeros(0), DMatrix::zeros(3, 0));
            let damping = DVector::zeros(0);
            return Some(Self { compliance, frequencies, shapes, massless: Matrix3::zeros(), damping });
        }
        let directions = DMatrix::from_fn(3, count, |row, i| eigenvectors[(row, soft[i])]);
        let stiffness = DMatrix::from_fn(count, count, |i, j| if i == j { 1.0 / eigenvalues[soft[i]] } else { 0.0 });
        let mass = directions.transpose() * mass * &directions;
        let half = (0.5 * (&mass + mass.transpose())).cholesky()?.l();
        // Coordinates in which the mass is the identity.
        let to_tool = directions * half.clone().try_inverse()?.transpose();
        let inverse = half.try_inverse()?;
        let scaled = &inverse * stiffness * inverse.transpose();
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(0.5 * (&scaled + scaled.transpose()));
        let mut order: std::vec::Vec<usize> = (0..count).collect();
        order.sort_by(|&i, &j| eigenvalues[i].total_cmp(&eigenvalues[j]));
        let vectors = DMatrix::from_fn(count, count, |row, i| eigenvectors[(row, order[i])]);
        let frequencies = DVector::from_fn(count, |i, _| eigenvalues[order[i]].max(0.0).sqrt());
        let shapes = to_tool * vectors;
        let finite = frequencies.iter().chain(shapes.iter()).all(|entry| entry.is_finite());
        let damping = DVector::from_element(count, damping);
        finite.then_some(Self { compliance, frequencies, shapes, massless: Matrix3::zeros(), damping })
    }

    /// The translational compliance of the arm (m/N), 3 x 3.
    pub fn compliance(&self) -> &Matrix3<f64> {
        &self.compliance
    }

    /// The natural frequencies (rad/s), the lowest first.
    pub fn frequencies(&self) -> &[f64] {
        self.frequencies.as_slice()
    }

    /// The damping ratio of each mode.
    pub fn damping(&self) -> &[f64] {
        self.damping.as_slice()
    }

    /// Whether no mode is damped.
    pub(super) fn is_undamped(&self) -> bool {
        self.damping.iter().all(|damping| *damping == 0.0)
    }

    /// What a unit of each mode moves the tool by, 3 x modes (1/sqrt(kg)).
    pub fn shapes(&self) -> &DMatrix<f64> {
        &self.shapes
    }

    /// A change of the force with the displacement of the tool, 3 x 3 (N/m), as
    /// the modes see it (1/s^2). What has no mass gives way at once: of `x = shapes w +
    /// massless f` and `f = process x` the force is `(I - process massless)^-1 process
    /// shapes w`. `None` where it runs away: an eigenvalue of `process massless` is real and
    /// not below 1.
    pub(super) fn seen(&self, process: &Matrix3<f64>) -> Option<DMatrix<f64>> {
        if self.massless == Matrix3::zeros() {
            return Some(self.shapes.transpose() * process * &self.shapes);
        }
        let yielding = process * self.massless;
        if largest_real(&yielding) >= 1.0 {
            return None;
        }
        let force = (Matrix3::identity() - yielding).try_inverse()? * process;
        Some(self.shapes.transpose() * force * &self.shapes)
    }

    /// Whether small movements of the tool die down (without damping: do not
    /// grow) under a force that changes with its displacement by `process x`,
    /// 3 x 3 (N/m).
    ///
    /// Without damping, by the eigenvalues of `M^-1 (K - P)`, which must be real
    /// and positive: a complex pair flutters, a negative one runs away. With
    /// damping, by those of the state matrix, whose real parts must be negative.
    pub fn is_stable(&self, process: &Matrix3<f64>) -> bool {
        self.seen(process).is_some_and(|seen| self.margin(&seen).is_stable)
    }

    /// How far the modes are from growing under a change of the force that they see so.
    pub(super) fn margin(&self, seen: &DMatrix<f64>) -> Margin {
        let count = self.frequencies.len();
        if count == 0 {
            return Margin { is_stable: true, distances: [1.0; 2] };
        }
        let squares = DMatrix::from_diagonal(&self.frequencies.component_mul(&self.frequencies));
        let stiffness = squares - seen;
        let scale = stiffness.amax();
        if !(scale > 0.0 && scale.is_finite()) {
            return Margin::LOST;
        }
        let stiffness = stiffness / scale;
        if self.is_undamped() {
            let Some(spectrum) = Spectrum::of(&stiffness) else { return Margin::LOST };
            let distances = [spectrum.discriminant(), stiffness.determinant()];
            return Margin { is_stable: spectrum.are_real && spectrum.least() > 0.0, distances };
        }
        // x'' + 2 zeta Omega x' + A x = 0, each mode with its zeta, with time in units of 1 / sqrt(scale).
        let mut state = DMatrix::zeros(2 * count, 2 * count);
        state.view_mut((0, count), (count, count)).fill_with_identity();
        state.view_mut((count, 0), (count, count)).copy_from(&-stiffness);
        for i in 0..count {
            state[(count + i, count + i)] = -2.0 * self.damping[i] * self.frequencies[i] / scale.sqrt();
        }
        let Some(spectrum) = Spectrum::of(&-state) else { return Margin::LOST };
        let dying = spectrum.least();
        Margin { is_stable: dying > 0.0, distances: [dying; 2] }
    }
}

/// Whether small movements die down, and by how much.
#[derive(Clone, Copy, Debug)]
pub(super) struct Margin {
    pub is_stable: bool,
    /// What is smooth and zero at a limit: without damping the discriminant, where modes meet,
    /// and the determinant, where one runs away; with damping how fast the slowest movement dies
    /// down.
    pub distances: [f64; 2],
}

impl Margin {
    /// What does not converge is not called stable.
    pub(super) const LOST: Self = Self { is_stable: false, distances: [0.0; 2] };
}

/// The largest real eigenvalue of a 3 x 3 matrix.
pub(super) fn largest_real(matrix: &Matrix3<f64>) -> f64 {
    let eigenvalues = matrix.complex_eigenvalues();
    let real = eigenvalues.iter().filter(|eigenvalue| eigenvalue.im == 0.0).map(|eigenvalue| eigenvalue.re);
    real.fold(f64::NEG_INFINITY, f64::max)
}

/// Whether a 2 x 2 matrix has a pair of complex eigenvalues: the criterion of
/// mode coupling without damping, `(a - d)^2 + 4 b c < 0`. The product `b c` of
/// the couplings must be negative, and larger than what keeps the modes apart.
pub fn has_complex_pair(matrix: &Matrix2<f64>) -> bool {
    squared_difference(matrix[(0, 0)], matrix[(0, 1)], matrix[(1, 0)], matrix[(1, 1)]) < 0.0
}
