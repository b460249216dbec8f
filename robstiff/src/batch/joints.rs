//! The joint coordinates of a block of poses.

/// Poses in a block: what a block needs stays in the first-level cache.
pub const BLOCK: usize = 64;

/// The joint coordinates of a block of poses, number by number.
///
/// Aligned, because a vector that is half in one line of the cache and half in
/// the next takes twice as long.
#[repr(align(64))]
pub struct Joints<T, const N: usize> {
    pub values: [[T; BLOCK]; N],
    pub sines: [[T; BLOCK]; N],
    pub cosines: [[T; BLOCK]; N],
}
