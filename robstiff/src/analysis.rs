//! What a 6 x 6 compliance says: stiffness, rank, weak and strong directions.
//!
//! The compliances are those of [`Robot::compliance`](crate::Robot::compliance):
//! symmetric, at the tool centre point in the base frame, translation first.
//! Nothing here answers with an infinity or a NaN; where there is no number,
//! there is `None`.

use nalgebra::{
    ClosedAddAssign, ClosedMulAssign, Matrix3, Matrix6, RealField, SMatrix, SVector, Scalar, SymmetricEigen, Unit,
    Vector3, convert,
};
use num_traits::{One, Zero};

#[cfg(test)]
mod tests;

/// The Cartesian stiffness that belongs to a compliance: the wrench per
/// displacement, 6 x 6 in the base frame; N/m, N/rad, Nm/m, Nm/rad by block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stiffness<T> {
    /// The robot yields to every wrench: the inverse of the compliance.
    Full(Matrix6<T>),
    /// There are wrenches that the robot does not yield to, such as the one
    /// direction that an arm with five elastic joints lacks: the compliance
    /// has no inverse.
    Deficient {
        /// In how many independent directions the robot yields.
        rank: usize,
        /// The wrench for every displacement that is possible; the component
        /// of a displacement that is not possible is ignored. What counts as
        /// a component depends on how an angle compares with a length, for
        /// which [`characteristic_length`] stands.
        pseudo_inverse: Matrix6<T>,
    },
}

impl<T: RealField + Copy> Stiffness<T> {
    /// The stiffness that belongs to a compliance; `None` where an entry is
    /// not finite, or too small to have a finite inverse.
    ///
    /// Rank and pseudo-inverse are those of `D C D` with
    /// `D = diag(1, 1, 1, L, L, L)`, whose entries all have the unit of the
    /// translational block, `L` being [`characteristic_length`]. A direction
    /// in which that yields less than [`resolution`] times the largest counts
    /// as rigid. The stiffness is then `D (D C D)^+ D`.
    pub fn of(compliance: &Matrix6<T>) -> Option<Self> {
        if !is_finite(compliance) {
            return None;
        }
        let length = characteristic_length(compliance);
        let scale = SVector::<T, 6>::from_fn(|i, _| if i < 3 { T::one() } else { length });
        let scaled = symmetric(compliance).component_mul(&(scale * scale.transpose()));
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(scaled);
        let (rank, inverse) = pseudo_inverse(&eigenvectors, &eigenvalues);
        let inverse = inverse.component_mul(&(scale * scale.transpose()));
        is_finite(&inverse).then_some(match rank {
            6 => Self::Full(inverse),
            _ => Self::Deficient { rank, pseudo_inverse: inverse },
        })
    }

    /// In how many independent directions the robot yields, 0 to 6.
    pub fn rank(&self) -> usize {
        match self {
            Self::Full(_) => 6,
            Self::Deficient { rank, .. } => *rank,
        }
    }

    /// The inverse or pseudo-inverse.
    pub fn matrix(&self) -> &Matrix6<T> {
        match self {
            Self::Full(matrix) | Self::Deficient { pseudo_inverse: matrix, .. } => matrix,
        }
    }
}

/// The length in m that makes rotations comparable with translations: the root
/// of the ratio of the traces of the two blocks of the compliance, so that both
/// weigh the same; about the lever of the softest joints. 1 where either block
/// is zero.
pub fn characteristic_length<T: RealField + Copy>(compliance: &Matrix6<T>) -> T {
    let translation = compliance.fixed_view::<3, 3>(0, 0).trace();
    let rotation = compliance.fixed_view::<3, 3>(3, 3).trace();
    let length = (translation / rotation).sqrt();
    if translation > T::zero() && length.is_finite() { length } else { T::one() }
}

/// How much less than in its softest direction a robot must yield to count as
/// rigid: 128 times the machine epsilon. The sum that makes up a compliance
/// leaves rounding of a few epsilons of its largest entry; what is smaller
/// than this has no two digits that can be trusted.
pub fn resolution<T: RealField + Copy>() -> T {
    T::default_epsilon() * convert(128.0)
}

/// The translational block: displacement of the TCP per force at the TCP in
/// the base frame, 3 x 3 (m/N).
pub fn translational_compliance<T: Scalar>(compliance: &Matrix6<T>) -> Matrix3<T> {
    compliance.fixed_view::<3, 3>(0, 0).into_owned()
}

/// The inverse of the translational block, 3 x 3 (N/m): the force per
/// displacement of a TCP that is free to turn. `None` where the robot does not
/// yield to some force, to [`resolution`], or an entry is not finite.
pub fn translational_stiffness<T: RealField + Copy>(compliance: &Matrix6<T>) -> Option<Matrix3<T>> {
    let block = translational_compliance(compliance);
    if !is_finite(&block) {
        return None;
    }
    let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(symmetric(&block));
    let (rank, inverse) = pseudo_inverse(&eigenvectors, &eigenvalues);
    (rank == 3 && is_finite(&inverse)).then_some(inverse)
}

/// The displacement of the TCP along a force per force, `u^T C u` (m/N); the
/// direction `u` in the base frame.
pub fn directional_compliance<T>(compliance: &Matrix6<T>, direction: &Unit<Vector3<T>>) -> T
where
    T: Scalar + Zero + One + ClosedAddAssign + ClosedMulAssign,
{
    direction.dot(&(translational_compliance(compliance) * direction.as_ref()))
}

/// The force per displacement along it, `1 / (u^T C u)` (N/m), when only that
/// force acts and the TCP may give way to the side. `None` where the robot does
/// not yield that way, to [`resolution`], or an entry is not finite.
pub fn directional_stiffness<T: RealField + Copy>(compliance: &Matrix6<T>, direction: &Unit<Vector3<T>>) -> Option<T> {
    let along = directional_compliance(compliance, direction);
    let rigid = translational_compliance(compliance).trace() * resolution();
    let stiffness = along.recip();
    (along > rigid && stiffness.is_finite()).then_some(stiffness)
}

/// The directions in which a force moves the TCP exactly along itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalDirections<T> {
    /// The displacement per force in each (m/N), the softest first; none is below zero.
    pub compliances: Vector3<T>,
    /// The directions in the base frame, perpendicular unit vectors, a column
    /// each. Either sign is right; they have the one of [`upright`].
    pub directions: Matrix3<T>,
}

impl<T: RealField + Copy> PrincipalDirections<T> {
    /// Those of a translational compliance, 3 x 3 and symmetric (m/N); `None` where an entry
    /// is not finite.
    pub fn of(block: &Matrix3<T>) -> Option<Self> {
        is_finite(block).then(|| sorted(block))
    }

    /// The force per displacement in each (N/m); `None` where the robot does not yield that
    /// way, to [`resolution`].
    pub fn stiffnesses(&self) -> [Option<T>; 3] {
        let rigid = self.compliances[0] * resolution();
        let stiffness = |compliance: T| (compliance > rigid).then(|| compliance.recip());
        [0, 1, 2].map(|i| stiffness(self.compliances[i]))
    }
}

/// A direction, or the opposite one: that of which the largest component is above zero, which
/// is easier to read.
pub fn upright<T: RealField + Copy>(direction: Vector3<T>) -> Vector3<T> {
    let largest = direction.iter().copied().reduce(|one, other| if other.abs() > one.abs() { other } else { one });
    if largest.is_some_and(|largest| largest < T::zero()) { -direction } else { direction }
}

/// The eigenvalues and eigenvectors of the translational block; `None` where
/// an entry is not finite.
pub fn principal_directions<T: RealField + Copy>(compliance: &Matrix6<T>) -> Option<PrincipalDirections<T>> {
    PrincipalDirections::of(&translational_compliance(compliance))
}

fn sorted<T: RealField + Copy>(block: &Matrix3<T>) -> PrincipalDirections<T> {
    let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(symmetric(block));
    let mut order = [0, 1, 2];
    order.sort_unstable_by(|&i, &j| eigenvalues[j].partial_cmp(&eigenvalues[i]).unwrap_or(core::cmp::Ordering::Equal));
    PrincipalDirections {
        // Rounding may leave a rigid direction a little below zero.
        compliances: Vector3::from_fn(|i, _| eigenvalues[order[i]].max(T::zero())),
        directions: Matrix3::from_columns(&order.map(|k| upright(eigenvectors.column(k).into_owned()))),
    }
}

/// Rank and Moore-Penrose inverse of a symmetric matrix from its eigenvectors
/// and eigenvalues.
fn pseudo_inverse<T: RealField + Copy, const D: usize>(
    vectors: &SMatrix<T, D, D>,
    values: &SVector<T, D>,
) -> (usize, SMatrix<T, D, D>) {
    let rigid = values.amax() * resolution();
    let mut inverse = SMatrix::<T, D, D>::zeros();
    let mut rank = 0;
    for (vector, &value) in vectors.column_iter().zip(values) {
        if value.abs() > rigid {
            rank += 1;
            inverse += vector * vector.transpose() * value.recip();
        }
    }
    (rank, inverse)
}

/// The eigensolver reads one triangle only; rounding must not depend on which.
fn symmetric<T: RealField + Copy, const D: usize>(matrix: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
    (matrix + matrix.transpose()) * convert::<f64, T>(0.5)
}

fn is_finite<T: RealField + Copy, const D: usize>(matrix: &SMatrix<T, D, D>) -> bool {
    matrix.iter().all(|entry| entry.is_finite())
}
