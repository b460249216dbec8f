//! Many poses at once: slices of poses in, slices of results out.
//!
//! Poses are given one by one; or [joint by joint](ByJoint), which costs less: nothing
//! has to be put side by side; or as a [`Grid`] in joint space, which costs least: its
//! sines and cosines are in tables.
//!
//! ```
//! use robstiff::nalgebra::{SVector, Vector3};
//! use robstiff::{Robot, batch};
//!
//! robstiff::robot!("rv130hsc.yaml");
//!
//! let poses: Vec<_> = (0..1000).map(|i| SVector::from([0.0, -0.5, 0.5, 0.0, 0.001 * i as f64])).collect();
//! let mut along_x = vec![0.0; poses.len()];
//! batch::directional_compliance(&Rv130hsc, &poses, &Vector3::x(), &mut along_x);
//! let single: f64 = Rv130hsc.compliance(&poses[7])[(0, 0)];
//! assert!((along_x[7] - single).abs() < 1e-13 * single);
//! ```
//!
//! Any [`Robot`] will do; the code of [`robot!`](crate::robot!)
//! gains most, because the compiler sees through it: what a function does not
//! return is not computed, and several poses share every instruction. On
//! x86-64 with the feature `std` the widest vectors that the machine has (AVX2
//! with FMA, AVX-512) are found at run time. Nothing is allocated.
//!
//! With the feature `rayon`, `batch::parallel` has the same on all cores, for robots that are [`Sync`], as
//! generated ones and those read at run time are; code that is generic over the robot asks for it:
//!
//! ```
//! # #[cfg(feature = "rayon")] {
//! use robstiff::nalgebra::{Matrix6, SVector};
//! use robstiff::{Robot, batch};
//!
//! fn softness<const N: usize>(robot: &(impl Robot<N> + Sync), poses: &[SVector<f64, N>]) -> Vec<Matrix6<f64>> {
//!     let mut compliances = vec![Matrix6::zeros(); poses.len()]; // m/N, rad/Nm, in the base frame
//!     batch::parallel::compliance(robot, poses, &mut compliances);
//!     compliances
//! }
//!
//! robstiff::robot!("rv130hsc.yaml");
//! assert!(softness(&Rv130hsc, &[SVector::from([0.0, -0.5, 0.5, 0.0, 1.2])])[0][(0, 0)] > 0.0);
//! # }
//! ```
//!
//! Results are those of the single pose but for rounding, 1e-13 of the largest entry
//! for `f64`, however large coordinates are. Blocks with coordinates beyond 1.6e6 rad (of `f32`
//! 3000 rad) are computed as single poses are, but those of a [`Grid`] by the sines of each even
//! then.
//!
//! From the fastest on: [`compliance_blocks`], where results are used and not
//! kept; [`compliance_by_entry`], unless the slices begin a multiple of 4096
//! bytes apart; [`compliance_triangle`]; [`compliance`]. Who wants a trace or a
//! deflection only asks for that. Transforms, Jacobians and [`statics`](crate::Robot::statics) are
//! computed pose by pose, or several abreast with [`Lanes`](crate::Lanes).
//!
//! # Panics
//! Every function panics if there are not as many results as poses.

mod block;
mod by_joint;
mod dispatch;
mod grid;
mod instructions;
mod joints;
mod known;
mod needs;
#[cfg(feature = "rayon")]
pub mod parallel;
mod poses;
mod quantities;
mod sink;
mod source;
#[cfg(all(test, feature = "generic"))]
mod tests;

use core::ops::Range;

use nalgebra::{Matrix6, Vector3, Vector6};

pub use by_joint::ByJoint;
pub use grid::Grid;
pub use joints::BLOCK;
pub use poses::Poses;

use crate::{Real, Robot, trig};
use poses::View;
use quantities::{Deflection, Deflections, Directional, Trace, Triangle};
use sink::{Blocks, ByNumber, EachPose};

/// The floating point numbers that batches are made of: `f32` and `f64`.
#[expect(private_bounds, reason = "nobody else shall implement it")]
pub trait Float: Real + trig::Float + instructions::ByHand + PartialOrd + Send + Sync {}

impl Float for f32 {}
impl Float for f64 {}

/// [`Robot::compliance`] of every pose.
pub fn compliance<T: Float, const N: usize>(
    robot: &impl Robot<N>,
    poses: impl Poses<T, N>,
    compliances: &mut [Matrix6<T>],
) {
    dispatch::run(Triangle { robot }, poses.view().source(), EachPose(compliances));
}

/// The upper triangles of [`Robot::compliance`] by rows, 21 entries a pose.
pub fn compliance_triangle<T: Float, const N: usize>(
    robot: &impl Robot<N>,
    poses: impl Poses<T, N>,
    triangles: &mut [[T; 21]],
) {
    dispatch::run(Triangle { robot }, poses.view().source(), EachPose(triangles));
}

/// The upper triangles of [`Robot::compliance`], a slice an entry: by rows,
/// `entries[k][i]` belongs to pose `i`. Nothing has to be rearranged; slices that
/// begin at multiples of 32 bytes are written fastest.
pub fn compliance_by_entry<T: Float, const N: usize>(
    robot: &impl Robot<N>,
    poses: impl Poses<T, N>,
    entries: [&mut [T]; 21],
) {
    dispatch::run(Triangle { robot }, poses.view().source(), ByNumber(entries));
}

/// Calls a function with the upper triangles of [`Robot::compliance`] of up to
/// [`BLOCK`] poses at a time, in order: with the numbers of the poses, and with
/// the entries by rows, `entries[k][i]` of the `i`-th of these poses. Entries
/// beyond the last of them mean nothing.
///
/// The fastest way to whole compliances: what looks at them finds them in the
/// first-level cache, and there is no need to keep them.
///
/// ```
/// use robstiff::batch;
/// use robstiff::nalgebra::SVector;
///
/// robstiff::robot!("rv130hsc.yaml");
///
/// let poses: Vec<_> = (0..1000).map(|i| SVector::from([0.0, -0.5, 0.5, 0.0, 0.001 * i as f64])).collect();
/// // The softest of all poses along x, and how soft it is there.
/// let mut softest = (0, 0.0);
/// batch::compliance_blocks(&Rv130hsc, &poses, |range, entries| {
///     for (pose, xx) in range.zip(entries[0]) {
///         if xx > softest.1 {
///             softest = (pose, xx);
///         }
///     }
/// });
/// assert!(softest.1 > 1e-7);
/// ```
pub fn compliance_blocks<T: Float, const N: usize>(
    robot: &impl Robot<N>,
    poses: impl Poses<T, N>,
    look: impl FnMut(Range<usize>, &[[T; BLOCK]; 21]),
) {
    dispatch::run(Triangle { robot }, poses.view().source(), Blocks(look));
}

/// The traces of the translational blocks of [`Robot::compliance`] (m/N): how
/// much the robot gives way to forces, whatever their direction.
pub fn translational_trace<T: Float, const N: usize>(robot: &impl Robot<N>, poses: impl Poses<T, N>, traces: &mut [T]) {
    dispatch::run(Trace { robot }, poses.view().source(), EachPose(traces));
}

/// The displacement along a force per force, `u^T C u` (m/N), for the direction
/// `u` in the base frame: a unit vector.
pub fn directional_compliance<T: Float, const N: usize>(
    robot: &impl Robot<N>,
    poses: impl Poses<T, N>,
    direction: &Vector3<T>,
    compliances: &mut [T],
) {
    dispatch::run(Directional { robot, direction: *direction }, poses.view().source(), EachPose(compliances));
}

/// [`Robot::deflection`] of every pose under one wrench.
pub fn deflection<T: Float, const N: usize>(
    robot: &impl Robot<N>,
    poses: impl Poses<T, N>,
    wrench: &Vector6<T>,
    deflections: &mut [Vector6<T>],
) {
    dispatch::run(Deflection { robot, wrench: *wrench }, poses.view().source(), EachPose(deflections));
}

/// [`Robot::deflection`] of every pose under a wrench of its own.
///
/// ```
/// use robstiff::batch;
/// use robstiff::nalgebra::{SVector, Vector6};
///
/// robstiff::robot!("rv130hsc.yaml");
///
/// // Along a path, the force turns with the tool (N).
/// let poses: Vec<_> = (0..100).map(|i| SVector::from([0.01 * i as f64, -0.5, 0.5, 0.0, 1.0])).collect();
/// let wrench = |turn: f64| Vector6::new(400.0 * turn.cos(), 400.0 * turn.sin(), 0.0, 0.0, 0.0, 0.0);
/// let wrenches: Vec<_> = poses.iter().map(|q| wrench(q[0])).collect();
/// let mut deflections = vec![Vector6::zeros(); poses.len()];
/// batch::deflections(&Rv130hsc, &poses, &wrenches, &mut deflections);
/// let (first, last) = (deflections[0], deflections[99]);
/// // Turned about the base's axis, everything is the same but for the turn.
/// assert!((first.xyz().norm() - last.xyz().norm()).abs() < 1e-12);
/// ```
///
/// # Panics
/// Also if there are not as many wrenches as poses.
pub fn deflections<T: Float, const N: usize>(
    robot: &impl Robot<N>,
    poses: impl Poses<T, N>,
    wrenches: &[Vector6<T>],
    deflections: &mut [Vector6<T>],
) {
    let poses = poses.view();
    assert_eq!(wrenches.len(), poses.count(), "there must be as many wrenches as poses");
    dispatch::run(Deflections::new(robot, wrenches), poses.source(), EachPose(deflections));
}
