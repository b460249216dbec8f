//! The mass that the tool has on the arm.

use core::f64::consts::TAU;
use core::fmt;

use nalgebra::{DMatrix, Matrix3, SVector, SymmetricEigen};
use robstiff_robots::Link;

use crate::Robot;
use crate::elements::Pose;

/// Why the masses of the links give no mass at the tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassError {
    /// No link has a mass.
    Unknown,
    /// There is a movement of the joints that moves no mass, such as the turn of
    /// a wrist of point masses, or the tool has a direction in which no elastic
    /// joint moves it.
    Singular,
}

impl fmt::Display for MassError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unknown => "the description gives no masses of the links",
            Self::Singular => "the masses of the links leave the mass at the tool open",
        })
    }
}

impl core::error::Error for MassError {}

/// The least mass over the largest: where directions differ by more, the mass matrix is
/// singular to rounding.
const SINGULAR: f64 = 1e-9;

/// The mass at the TCP in the base frame, 3 x 3 (kg): `(J M^-1 J^T)^-1` with the
/// translational Jacobian `J` and the joints' mass matrix `M` of the links'
/// point masses (a description gives no moments of inertia). Joints without
/// compliance stand still.
///
/// # Errors
/// [`MassError`], where the links do not say.
pub fn mass_of_links<const N: usize, R: Robot<N>>(
    robot: &R,
    links: &[Link],
    q: &SVector<f64, N>,
) -> Result<Matrix3<f64>, MassError> {
    if links.iter().all(|link| link.mass == 0.0) {
        return Err(MassError::Unknown);
    }
    let compliance = robot.joint_compliance();
    let elastic: std::vec::Vec<usize> = (0..N).filter(|&i| compliance[i] > 0.0).collect();
    if elastic.is_empty() {
        return Err(MassError::Singular);
    }
    let pose = Pose::of(robot, q);
    let frames = robot.link_frames(q);
    let mut inertia = DMatrix::<f64>::zeros(elastic.len(), elastic.len());
    for (body, link) in links.iter().enumerate().take(N) {
        let mut geometry = pose.geometry();
        let center = frames[body].fixed_view::<3, 3>(0, 0) * nalgebra::Vector3::from(link.center_of_mass)
            + frames[body].fixed_view::<3, 1>(0, 3);
        geometry.tcp.fixed_view_mut::<3, 1>(0, 3).copy_from(&center);
        // A joint moves the bodies behind it.
        let moves = DMatrix::from_fn(3, elastic.len(), |row, column| match elastic[column] {
            joint if joint <= body => geometry.joint_twist(joint + 1)[row],
            _ => 0.0,
        });
        inertia += moves.transpose() * moves * link.mass;
    }
    let jacobian = robot.jacobian(q);
    let jacobian = DMatrix::from_fn(3, elastic.len(), |row, column| jacobian[(row, elastic[column])]);
    let mobility = &jacobian * inverse(&inertia)? * jacobian.transpose();
    let mass = inverse(&mobility)?;
    Ok(Matrix3::from_fn(|row, column| mass[(row, column)]))
}

fn inverse(matrix: &DMatrix<f64>) -> Result<DMatrix<f64>, MassError> {
    let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(0.5 * (matrix + matrix.transpose()));
    let (least, greatest) = (eigenvalues.min(), eigenvalues.max());
    let regular = !eigenvalues.is_empty() && least > SINGULAR * greatest;
    if !regular {
        return Err(MassError::Singular);
    }
    Ok(&eigenvectors * DMatrix::from_diagonal(&eigenvalues.map(f64::recip)) * eigenvectors.transpose())
}

/// The mass, the same in all directions, with which an arm of a translational
/// compliance (m/N) has its first mode at a measured frequency (Hz), 3 x 3
/// (kg). `None` where the arm does not yield, or the frequency is not above
/// zero.
pub fn mass_of_first_mode(compliance: &Matrix3<f64>, frequency: f64) -> Option<Matrix3<f64>> {
    let softest = compliance.symmetric_eigenvalues().max();
    let mass = (softest * (TAU * frequency).powi(2)).recip();
    (softest > 0.0 && frequency > 0.0 && mass.is_finite()).then(|| Matrix3::identity() * mass)
}
