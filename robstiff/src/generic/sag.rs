//! How the joints yield to the arm's own weight.

use nalgebra::{Matrix4, SVector};
use robstiff_robots::effect::gravity_sag::GRAVITY;
use robstiff_robots::{Description, Link};

use crate::elements::{own_weight_torque, share_of_weight};
use crate::{Convention, JointKind, Real};

/// The masses of an arm that sags.
#[derive(Clone, Debug, PartialEq)]
pub struct Sag<const N: usize> {
    share: f64,
    links: [Link; N],
}

impl<const N: usize> Sag<N> {
    /// Of a description with an effect of that sort.
    pub fn of(description: &Description) -> Option<Self> {
        let share = description.effects.iter().filter_map(share_of_weight::<f64>).reduce(|sum, more| sum + more)?;
        Some(Self { share, links: core::array::from_fn(|i| description.links[i]) })
    }

    /// By how much each joint yields (rad or m): `share h_i g_i`, with the frames
    /// behind the joints where they stand without the sag.
    pub fn yields<T: Real>(
        &self,
        convention: Convention,
        kinds: [JointKind; N],
        compliance: &SVector<f64, N>,
        base: &Matrix4<f64>,
        frames: &[Matrix4<T>; N],
    ) -> [T; N] {
        core::array::from_fn(|i| {
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
            let torque = own_weight_torque(kinds[i], &joint_frame, weight, moment);
            T::of(self.share * compliance[i]) * torque
        })
    }
}
