//! Where the numbers of a block go.

use core::array;
use core::ops::Range;

use super::Float;
use super::instructions::Instructions;
use super::joints::BLOCK;
use super::quantities::Results;

/// How a sink takes numbers that are still in registers. Gain: `benches/README.md`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Vectors {
    /// Not at all, but block by block.
    No,
    /// Those of a whole vector.
    Whole,
    /// Those of so many poses as are rearranged at once.
    Parts,
}

/// Takes the numbers of the poses in a range, `numbers[k][i]` of the `i`-th.
pub trait Sink<T, const M: usize> {
    /// Whether there is room for so many poses, and no more.
    fn fits(&self, poses: usize) -> bool;

    /// Whether it takes the numbers of vectors, and how.
    const VECTORS: Vectors = Vectors::No;

    /// Takes the numbers of a vector of poses, pose `first` and those behind it.
    fn take_vector<const LANES: usize>(
        &mut self,
        _first: usize,
        _numbers: &[[T; LANES]; M],
        _instructions: impl Instructions,
    ) {
    }

    /// Takes the numbers of the poses of a block.
    fn take(&mut self, poses: Range<usize>, numbers: &[[T; BLOCK]; M], instructions: impl Instructions);
}

/// A result a pose, put together from its numbers.
pub struct EachPose<'s, R>(pub &'s mut [R]);

/// Numbers and poses that are transposed at once.
const TILE: usize = 4;

impl<T: Float, R: Results<T, M>, const M: usize> Sink<T, M> for EachPose<'_, R> {
    fn fits(&self, poses: usize) -> bool {
        self.0.len() == poses
    }

    /// Many numbers of a whole vector do not stay in the registers while they are rearranged.
    const VECTORS: Vectors = if R::ENTRIES.len() <= 2 * TILE { Vectors::Whole } else { Vectors::Parts };

    #[inline(always)]
    fn take_vector<const LANES: usize>(
        &mut self,
        first: usize,
        numbers: &[[T; LANES]; M],
        instructions: impl Instructions,
    ) {
        let results: &mut [R; LANES] = self.0[first..].first_chunk_mut().expect("a vector");
        rearrange(numbers, results, instructions);
    }

    #[inline(always)]
    fn take(&mut self, poses: Range<usize>, numbers: &[[T; BLOCK]; M], instructions: impl Instructions) {
        rearrange(numbers, &mut self.0[poses], instructions);
    }
}

/// Puts results together, tile by tile: left to itself, the compiler takes one
/// number after the other, or with AVX-512 gathers and scatters, which are slower
/// still.
#[inline(always)]
fn rearrange<T: Float, R: Results<T, M>, const M: usize, const POSES: usize>(
    numbers: &[[T; POSES]; M],
    results: &mut [R],
    instructions: impl Instructions,
) {
    let mut done = 0;
    if let Some(last) = R::ENTRIES.len().checked_sub(TILE) {
        let (tiles, _) = results.as_chunks_mut::<TILE>();
        done = TILE * tiles.len();
        for (tile, results) in (0..POSES / TILE).zip(tiles) {
            for k in 0..R::ENTRIES.len().div_ceil(TILE) {
                // The last tile overlaps the one before.
                let entry = last.min(TILE * k);
                let rows = array::from_fn(|i| &numbers[R::ENTRIES[entry + i]].as_chunks().0[tile]);
                let columns = results.each_mut().map(|r| r.entries()[entry..].first_chunk_mut().expect("a tile"));
                instructions.transpose(rows, columns);
            }
        }
    }
    for (pose, result) in (done..POSES).zip(results.iter_mut().skip(done)) {
        for (entry, number) in result.entries().iter_mut().zip(R::ENTRIES) {
            *entry = numbers[*number][pose];
        }
    }
}

/// A slice a number, as the block has them: nothing to rearrange.
pub struct ByNumber<'s, T, const M: usize>(pub [&'s mut [T]; M]);

impl<T: Float, const M: usize> Sink<T, M> for ByNumber<'_, T, M> {
    fn fits(&self, poses: usize) -> bool {
        self.0.iter().all(|slice| slice.len() == poses)
    }

    const VECTORS: Vectors = Vectors::Whole;

    #[inline(always)]
    fn take_vector<const LANES: usize>(&mut self, first: usize, numbers: &[[T; LANES]; M], _: impl Instructions) {
        for (slice, numbers) in self.0.iter_mut().zip(numbers) {
            slice[first..first + LANES].copy_from_slice(numbers);
        }
    }

    #[inline(always)]
    fn take(&mut self, poses: Range<usize>, numbers: &[[T; BLOCK]; M], _: impl Instructions) {
        for (slice, numbers) in self.0.iter_mut().zip(numbers) {
            slice[poses.clone()].copy_from_slice(&numbers[..poses.len()]);
        }
    }
}

/// A function that looks at the blocks.
pub struct Blocks<F>(pub F);

impl<T: Float, F: FnMut(Range<usize>, &[[T; BLOCK]; M]), const M: usize> Sink<T, M> for Blocks<F> {
    fn fits(&self, _: usize) -> bool {
        true
    }

    #[inline(always)]
    fn take(&mut self, poses: Range<usize>, numbers: &[[T; BLOCK]; M], _: impl Instructions) {
        (self.0)(poses, numbers);
    }
}
