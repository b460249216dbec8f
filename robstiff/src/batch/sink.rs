//! Where the numbers of a block go.

use core::ops::Range;

use super::Float;
use super::block::BLOCK;

/// Takes the numbers of the poses in a range, `numbers[k][i]` of the `i`-th.
pub trait Sink<T, const M: usize> {
    /// Whether there is room for so many poses, and no more.
    fn fits(&self, poses: usize) -> bool;

    /// Takes a block, or what is left for the last one.
    fn take(&mut self, poses: Range<usize>, numbers: &[[T; BLOCK]; M]);
}

/// A result a pose, put together from its numbers.
pub struct EachPose<'s, R, F> {
    pub results: &'s mut [R],
    pub result: F,
}

impl<T: Float, R, F: Fn([T; M]) -> R, const M: usize> Sink<T, M> for EachPose<'_, R, F> {
    fn fits(&self, poses: usize) -> bool {
        self.results.len() == poses
    }

    // Not inlined: with AVX-512 the compiler makes gather instructions of it,
    // which are slow. It remains two fifths of the time of a triangle.
    #[inline(never)]
    fn take(&mut self, poses: Range<usize>, numbers: &[[T; BLOCK]; M]) {
        for (i, result) in self.results[poses].iter_mut().enumerate().take(BLOCK) {
            let mut own = [T::ZERO; M];
            for k in 0..M {
                own[k] = numbers[k][i];
            }
            *result = (self.result)(own);
        }
    }
}

/// A slice a number, as the block has them: nothing to rearrange.
pub struct ByNumber<'s, T, const M: usize> {
    pub slices: [&'s mut [T]; M],
}

impl<T: Float, const M: usize> Sink<T, M> for ByNumber<'_, T, M> {
    fn fits(&self, poses: usize) -> bool {
        self.slices.iter().all(|slice| slice.len() == poses)
    }

    fn take(&mut self, poses: Range<usize>, numbers: &[[T; BLOCK]; M]) {
        for (slice, numbers) in self.slices.iter_mut().zip(numbers) {
            slice[poses.clone()].copy_from_slice(&numbers[..poses.len()]);
        }
    }
}
