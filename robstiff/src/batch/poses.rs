//! What poses can be given as.

use core::ops::Range;

use nalgebra::SVector;

use super::Float;
use super::grid::{Grid, Steps};
use super::source::Source;

/// Poses to compute something at: a slice, an array or a `Vec` of them, by
/// reference, a slice a joint ([`ByJoint`]), or a [`Grid`].
pub trait Poses<T: Float, const N: usize>: IntoView<T, N> {}

impl<T: Float, P: IntoView<T, N>, const N: usize> Poses<T, N> for P {}

/// What becomes a view.
pub trait IntoView<T: Float, const N: usize> {
    type View: View<T, N> + Poses<T, N>;

    fn view(self) -> Self::View;
}

/// A view of poses, which can be cut into parts.
pub trait View<T, const N: usize>: Copy + Send + Sync {
    fn count(&self) -> usize;

    fn cut(&self, poses: Range<usize>) -> Self;

    fn source(self) -> impl Source<T, N>;
}

/// Poses by joint: the coordinates of each joint (rad or m) side by side, those of pose
/// `i` at place `i` of every slice. As a column a joint in a table, and a view, too.
///
/// ```
/// use robstiff::batch::{self, ByJoint};
/// use robstiff::nalgebra::{SVector, Vector3};
///
/// robstiff::robot!("rv130hsc.yaml");
///
/// let turns: Vec<f64> = (0..100).map(|i| 0.02 * i as f64).collect();
/// let (shoulder, elbow, wrist) = ([-0.5; 100], [0.5; 100], [0.0; 100]);
/// let poses = ByJoint::new([&turns[..], &shoulder, &elbow, &wrist, &turns]);
/// let (mut columns, mut slice) = (vec![0.0; 100], vec![0.0; 100]);
/// batch::directional_compliance(&Rv130hsc, poses, &Vector3::x(), &mut columns);
/// // The same, pose by pose.
/// let poses: Vec<_> = turns.iter().map(|&q| SVector::from([q, -0.5, 0.5, 0.0, q])).collect();
/// batch::directional_compliance(&Rv130hsc, &poses, &Vector3::x(), &mut slice);
/// assert_eq!(columns, slice);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ByJoint<'p, T, const N: usize>([&'p [T]; N]);

impl<'p, T, const N: usize> ByJoint<'p, T, N> {
    /// Poses whose coordinates are given joint by joint.
    ///
    /// # Panics
    /// If some joint has more coordinates than another.
    pub fn new(joints: [&'p [T]; N]) -> Self {
        let poses = Self(joints);
        assert!(joints.iter().all(|joint| joint.len() == poses.len()), "every joint must have as many coordinates");
        poses
    }

    /// How many poses there are.
    pub fn len(&self) -> usize {
        self.0.first().map_or(0, |joint| joint.len())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The coordinates of a joint.
    pub(super) fn joint(&self, joint: usize) -> &'p [T] {
        self.0[joint]
    }
}

impl<T: Float, const N: usize> View<T, N> for &[SVector<T, N>] {
    fn count(&self) -> usize {
        self.len()
    }

    fn cut(&self, poses: Range<usize>) -> Self {
        &self[poses]
    }

    fn source(self) -> impl Source<T, N> {
        self
    }
}

impl<T: Float, const N: usize> View<T, N> for ByJoint<'_, T, N> {
    fn count(&self) -> usize {
        self.len()
    }

    fn cut(&self, poses: Range<usize>) -> Self {
        Self(self.0.map(|joint| &joint[poses.clone()]))
    }

    fn source(self) -> impl Source<T, N> {
        self
    }
}

impl<T: Float, const N: usize> View<T, N> for Grid<'_, T, N> {
    fn count(&self) -> usize {
        self.len()
    }

    fn cut(&self, poses: Range<usize>) -> Self {
        self.part(poses)
    }

    fn source(self) -> impl Source<T, N> {
        Steps::new(self)
    }
}

impl<T: Float, const N: usize> IntoView<T, N> for &[SVector<T, N>] {
    type View = Self;

    fn view(self) -> Self {
        self
    }
}

impl<'p, T: Float, const N: usize, const K: usize> IntoView<T, N> for &'p [SVector<T, N>; K] {
    type View = &'p [SVector<T, N>];

    fn view(self) -> Self::View {
        self
    }
}

#[cfg(feature = "std")]
impl<'p, T: Float, const N: usize> IntoView<T, N> for &'p std::vec::Vec<SVector<T, N>> {
    type View = &'p [SVector<T, N>];

    fn view(self) -> Self::View {
        self
    }
}

impl<T: Float, const N: usize> IntoView<T, N> for ByJoint<'_, T, N> {
    type View = Self;

    fn view(self) -> Self {
        self
    }
}

impl<T: Float, const N: usize> IntoView<T, N> for Grid<'_, T, N> {
    type View = Self;

    fn view(self) -> Self {
        self
    }
}
