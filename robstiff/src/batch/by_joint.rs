//! Joint coordinates with those of each joint side by side.

use core::ops::Range;

use nalgebra::SVector;

use super::Float;
use super::instructions::Instructions;
use super::joints::{BLOCK, Joints};
use super::needs::Needs;
use super::source::{Filled, Source};

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

    /// Some of the poses.
    pub(super) fn part(&self, poses: Range<usize>) -> Self {
        Self(self.0.map(|joint| &joint[poses.clone()]))
    }

    /// The coordinates of a joint.
    pub(super) fn joint(&self, joint: usize) -> &'p [T] {
        self.0[joint]
    }
}

/// Sines read the coordinates of a joint where they are. Gain: `benches/README.md`.
impl<T: Float, const N: usize> Source<T, N> for ByJoint<'_, T, N> {
    fn poses(&self) -> usize {
        self.len()
    }

    fn pose(&self, pose: usize) -> SVector<T, N> {
        SVector::from_fn(|joint, _| self.joint(joint)[pose])
    }

    #[inline(always)]
    fn fill<const FUSED: bool>(
        &mut self,
        first: usize,
        needs: Needs,
        joints: &mut Joints<T, N>,
        instructions: impl Instructions,
    ) -> Filled {
        let count = (self.len() - first).min(BLOCK);
        if cfg!(feature = "platform-trig") {
            return Filled::Beyond(count);
        }
        let Joints { values, sines, cosines } = joints;
        let mut angles = [None; N];
        for (joint, values) in values.iter_mut().enumerate() {
            let given = &self.joint(joint)[first..];
            let block = if let Some(block) = given.first_chunk() {
                if needs.value(joint) {
                    *values = *block;
                }
                block
            } else {
                values[..count].copy_from_slice(given);
                values[count..].fill(T::ZERO);
                &*values
            };
            angles[joint] = needs.sin_cos(joint).then_some(block);
        }
        Filled::each_if(instructions.sin_cos_all::<T, N, FUSED>(angles, sines, cosines), count)
    }
}
