//! Where the joint coordinates of a block come from.

use nalgebra::SVector;

use super::Float;
use super::block::{BLOCK, Joints};
use super::dispatch::Instructions;
use super::needs::Needs;

/// Poses, block after block.
pub trait Source<T, const N: usize> {
    /// Whether blocks may be rows.
    const ROWS: bool = false;

    /// How many there are.
    fn poses(&self) -> usize;

    /// One of them.
    fn pose(&self, pose: usize) -> SVector<T, N>;

    /// Fills in what is needed of the next block, which begins at pose `first`.
    /// `FUSED`: with an instruction that multiplies and adds.
    fn fill<const FUSED: bool>(
        &mut self,
        first: usize,
        needs: Needs,
        joints: &mut Joints<T, N>,
        instructions: impl Instructions,
    ) -> Filled;
}

/// What the block holds, and of how many poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filled {
    /// Every joint of every pose.
    Each(usize),
    /// The first joint of every pose, and the others, which all have in common,
    /// of the first pose.
    Row(usize),
    /// Nothing: some angle is out of the domain of the sine for vectors.
    Beyond(usize),
}

/// Poses whose sines and cosines are computed.
impl<T: Float, const N: usize> Source<T, N> for &[SVector<T, N>] {
    fn poses(&self) -> usize {
        self.len()
    }

    fn pose(&self, pose: usize) -> SVector<T, N> {
        self[pose]
    }

    #[inline(always)]
    fn fill<const FUSED: bool>(
        &mut self,
        first: usize,
        needs: Needs,
        joints: &mut Joints<T, N>,
        instructions: impl Instructions,
    ) -> Filled {
        let poses = &self[first..];
        let count = poses.len().min(BLOCK);
        if cfg!(feature = "platform-trig") {
            return Filled::Beyond(count);
        }
        let Joints { values, sines, cosines } = joints;
        if let Some(block) = poses.first_chunk::<BLOCK>() {
            for pose in 0..BLOCK {
                for joint in 0..N {
                    values[joint][pose] = block[pose][joint];
                }
            }
        } else {
            for joint in 0..N {
                values[joint][count..].fill(T::ZERO);
                for (value, pose) in values[joint].iter_mut().zip(poses) {
                    *value = pose[joint];
                }
            }
        }
        for joint in 0..N {
            let (angles, sines, cosines) = (&values[joint], &mut sines[joint], &mut cosines[joint]);
            if needs.sin_cos(joint) && !instructions.sin_cos_each::<T, FUSED>(angles, sines, cosines) {
                return Filled::Beyond(count);
            }
        }
        Filled::Each(count)
    }
}
