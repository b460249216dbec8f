//! What every robot can do, generated or read at run time.

use nalgebra::{Matrix4, Matrix6, SMatrix, SVector, Vector6};
use robstiff_robots::{Convention, Effect, JointKind};

use crate::{Real, State};

/// The elastostatics of a serial arm with `N` joints, over any scalar [`Real`].
///
/// Vectors of six have the translation first: a wrench `[f; m]` (N, Nm) acts
/// at the tool centre point (TCP) in the base frame, a displacement `[d; r]`
/// (m, rad) is that of the TCP in the base frame, `r` a small rotation vector.
/// Joint coordinates `q` are in rad (revolute) or m (prismatic). Transforms
/// are homogeneous 4 x 4 matrices.
pub trait Robot<const N: usize> {
    /// The robot's name.
    fn name(&self) -> &str;

    /// The Denavit-Hartenberg convention of the robot's table, which says
    /// where the joint frames are.
    fn convention(&self) -> Convention;

    /// Turning or sliding, a joint each.
    fn joint_kinds(&self) -> [JointKind; N];

    /// The joints' own compliances, the diagonal of `H_q` (rad/Nm or m/N).
    fn joint_compliance(&self) -> SVector<f64, N>;

    /// Lower and upper limits of the joint coordinates (rad or m), where they are known.
    fn limits(&self) -> [Option<[f64; 2]>; N];

    /// What the description adds to the table and to the joints' own compliance.
    fn effects(&self) -> &[Effect];

    /// Frame 0 in the base frame (m).
    fn base(&self) -> Matrix4<f64>;

    /// The tool centre point's frame in the flange frame (m).
    fn tool(&self) -> Matrix4<f64>;

    /// The tool centre point's frame in the base frame (m).
    fn transform<T: Real>(&self, q: &SVector<T, N>) -> Matrix4<T>;

    /// Frames 1 to N (m), each fixed to the link behind its joint, in the base
    /// frame; the last is the flange frame.
    fn link_frames<T: Real>(&self, q: &SVector<T, N>) -> [Matrix4<T>; N];

    /// The 6 x N Jacobian of the TCP in the base frame, translation first: the
    /// twist of the TCP per turn of each joint's output, which is what a load
    /// moves. With a transmission error, a unit of the coordinate `q` is
    /// [`commanded_rates`](crate::elements::commanded_rates) of that.
    fn jacobian<T: Real>(&self, q: &SVector<T, N>) -> SMatrix<T, 6, N>;

    /// The 6 x 6 Cartesian compliance at the TCP in the base frame,
    /// `H_x = J H_q J^T` and what the effects add: the displacement per small
    /// wrench about the unloaded state. Units by block: m/N, m/Nm, rad/N,
    /// rad/Nm.
    fn compliance<T: Real>(&self, q: &SVector<T, N>) -> Matrix6<T>;

    /// Hands over the entries of the [`upper_triangle`] of [`compliance`](Self::compliance),
    /// each once with its place there, in any order: generated code as soon as it knows
    /// one, so that who stores it needs no register for it any more.
    #[inline(always)]
    fn compliance_entries<T: Real>(&self, q: &SVector<T, N>, mut put: impl FnMut(usize, T)) {
        for (place, entry) in upper_triangle(&self.compliance(q)).into_iter().enumerate() {
            put(place, entry);
        }
    }

    /// The displacement of the TCP under a wrench at the TCP; beyond
    /// `H_x` times the wrench it knows the nonlinear effects. Joints with
    /// hysteresis are those of a robot that was never loaded before.
    fn deflection<T: Real>(&self, q: &SVector<T, N>, wrench: &Vector6<T>) -> Vector6<T>;

    /// The displacement of the TCP under a wrench at the TCP that follows the
    /// loads in `state`, which it joins: the one method that tells joints with
    /// hysteresis on their way up from those on their way down. For robots
    /// without hysteresis it is [`deflection`](Self::deflection).
    ///
    /// The wrench is reached from the one before without turning back on the
    /// way; unloading is a load, too: the wrench zero. After one that is not a
    /// number neither deflection nor state tells anything: go on from the state
    /// before it.
    fn deflection_with<T: Real>(&self, q: &SVector<T, N>, wrench: &Vector6<T>, state: &mut State<N, T>) -> Vector6<T> {
        let _ = state;
        self.deflection(q, wrench)
    }

    /// The torques that a wrench which acts on the TCP puts on the joints, `J^T F` (Nm, of
    /// sliding joints forces in N). Drives hold the arm with the negative.
    fn joint_torques<T: Real>(&self, q: &SVector<T, N>, wrench: &Vector6<T>) -> SVector<T, N>;

    /// What the arm's own weight puts on the gears before any load does (Nm, of sliding
    /// joints forces in N), and the laws of joints begin at: zero but where the description
    /// has [`gravity_preload`](robstiff_robots::effect::gravity_preload).
    fn preload<T: Real>(&self, q: &SVector<T, N>) -> SVector<T, N> {
        let _ = q;
        SVector::zeros()
    }

    /// [`transform`](Self::transform), [`jacobian`](Self::jacobian) and
    /// [`compliance`](Self::compliance) of one pose; generated code shares what
    /// they have in common, the sines and cosines above all.
    fn statics<T: Real>(&self, q: &SVector<T, N>) -> Statics<N, T> {
        Statics { transform: self.transform(q), jacobian: self.jacobian(q), compliance: self.compliance(q) }
    }
}

/// The elastostatics of one pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statics<const N: usize, T: Real = f64> {
    /// The tool centre point's frame in the base frame (m).
    pub transform: Matrix4<T>,
    /// The 6 x N Jacobian of the TCP in the base frame, translation first.
    pub jacobian: SMatrix<T, 6, N>,
    /// The 6 x 6 Cartesian compliance at the TCP in the base frame.
    pub compliance: Matrix6<T>,
}

/// Row and column of the entries of the upper triangle, by rows.
pub(crate) const TRIANGLE: [(usize, usize); 21] = {
    let mut entries = [(0, 0); 21];
    let (mut k, mut i) = (0, 0);
    while i < 6 {
        let mut j = i;
        while j < 6 {
            entries[k] = (i, j);
            (k, j) = (k + 1, j + 1);
        }
        i += 1;
    }
    entries
};

/// The upper triangle of a compliance by rows: xx, xy, .. of which the rest is
/// the mirror image. After [`Robot::compliance`] of generated code it costs
/// nothing: the entries below are then not computed, nor is a matrix stored.
///
/// ```
/// use robstiff::nalgebra::SVector;
/// use robstiff::{Robot, upper_triangle};
///
/// robstiff::robot!("rv130hsc.yaml");
///
/// let compliance = Rv130hsc.compliance(&SVector::from([0.3, -0.4, 0.5, 0.0, 1.2]));
/// let entries: [f64; 21] = upper_triangle(&compliance);
/// assert_eq!(entries[7], compliance[(1, 2)]);
/// ```
#[inline(always)]
pub fn upper_triangle<T: Real>(compliance: &Matrix6<T>) -> [T; 21] {
    // Neither `map`, which is not always inlined, nor an iterator over rows,
    // which the compiler does not always unroll.
    let mut entries = [T::zero(); 21];
    for (k, entry) in entries.iter_mut().enumerate() {
        *entry = compliance[TRIANGLE[k]];
    }
    entries
}

/// The operations of one call of a generated function. Constants cost nothing:
/// the compiler computes them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Sines and cosines, counted singly.
    pub trig: usize,
    /// Multiplications.
    pub mul: usize,
    /// Additions, subtractions, and choices of the larger or smaller of two.
    pub add: usize,
    /// Changes of sign that no addition absorbed.
    pub neg: usize,
    /// Square roots and reciprocals.
    pub root: usize,
}
