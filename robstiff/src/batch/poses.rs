//! What poses can be given as.

use core::ops::Range;

use nalgebra::SVector;

use super::Float;
use super::by_joint::ByJoint;
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
        self.part(poses)
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
