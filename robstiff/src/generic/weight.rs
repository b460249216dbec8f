//! What the arm's own weight puts on its joints.

use core::array::from_fn;

use nalgebra::{Matrix4, SVector};
use robstiff_robots::effect::gravity_sag::GRAVITY;
use robstiff_robots::{Description, Effect, Link};

use crate::elements::{own_weight_torque, share_of_preload, share_of_weight};
use crate::{Convention, JointKind, Real};

/// The masses of an arm to whose description they matter.
#[derive(Clone, Debug, PartialEq)]
pub struct Weight<const N: usize> {
    links: [Link; N],
    /// How much of it the joints yield to, unloaded, if they do.
    pub sag: Option<f64>,
    /// How much of it the gears carry, if the description says so.
    pub preload: Option<f64>,
}

impl<const N: usize> Weight<N> {
    /// Of a description with an effect of that sort.
    pub fn of(description: &Description) -> Option<Self> {
        let sum =
            |of: fn(&Effect) -> Option<f64>| description.effects.iter().filter_map(of).reduce(|sum, more| sum + more);
        let (sag, preload) = (sum(share_of_weight), sum(share_of_preload));
        sag.or(preload)?;
        Some(Self { links: from_fn(|i| description.links[i]), sag, preload })
    }

    /// The torque `g_i` of what hangs on each joint (Nm, of sliding joints forces in N),
    /// with the frames behind the joints where they stand without a sag.
    pub fn torques<T: Real>(
        &self,
        convention: Convention,
        kinds: [JointKind; N],
        base: &Matrix4<f64>,
        frames: &[Matrix4<T>; N],
    ) -> SVector<T, N> {
        SVector::from_fn(|i, _| {
            let joint_frame = match (convention, i) {
                (Convention::Modified, _) => frames[i],
                (Convention::Standard, 0) => base.map(T::of),
                (Convention::Standard, _) => frames[i - 1],
            };
            let (mut weight, mut moment) = (T::zero(), [T::zero(); 2]);
            for (link, frame) in self.links.iter().zip(frames).skip(i) {
                let own = T::of(GRAVITY * link.mass);
                let [x, y, z] = link.center_of_mass.map(T::of);
                weight += own;
                for (k, moment) in moment.iter_mut().enumerate() {
                    *moment += own * (frame[(k, 0)] * x + frame[(k, 1)] * y + frame[(k, 2)] * z + frame[(k, 3)]);
                }
            }
            own_weight_torque(kinds[i], &joint_frame, weight, moment)
        })
    }
}
