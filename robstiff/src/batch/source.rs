//! Where the joint coordinates of a block come from.

use core::array;

use nalgebra::SVector;

use super::Float;
use super::instructions::Instructions;
use super::joints::{BLOCK, Joints};
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

impl Filled {
    #[inline(always)]
    pub fn each_if(is_within: bool, count: usize) -> Self {
        if is_within { Self::Each(count) } else { Self::Beyond(count) }
    }
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
        let angles = array::from_fn(|joint| needs.sin_cos(joint).then_some(&values[joint]));
        Filled::each_if(instructions.sin_cos_all::<T, N, FUSED>(angles, sines, cosines), count)
    }
}
