//! A block of poses, three passes over it.

use nalgebra::SVector;

use super::Float;
use super::known::Known;
use super::quantities::Quantity;
use super::sink::Sink;
use crate::trig;

/// Poses in a block: what a block needs stays in the first-level cache.
pub const BLOCK: usize = 64;

/// The poses of a vector, at least: blocks are filled up to a multiple.
const VECTOR: usize = 16;

/// Computes the quantity at `poses`, block by block.
///
/// Number `k` of all poses of a block lies side by side, so that the loops
/// over the poses become loops over vectors of poses:
///
/// 1. sines and cosines, joint by joint;
/// 2. the algebra of the robot;
/// 3. handing the numbers over.
///
/// Everything but the last is inlined, because it takes the instructions that
/// may be used from the function around it.
#[inline(always)]
pub fn run<T, Q, const N: usize, const M: usize, const FUSED: bool>(
    quantity: &Q,
    poses: &[SVector<T, N>],
    sink: &mut impl Sink<T, M>,
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    let mut angles = [[[T::ZERO; BLOCK]; N]; 3];
    let mut numbers = [[T::ZERO; BLOCK]; M];
    for (block, poses) in poses.chunks(BLOCK).enumerate() {
        if turn::<T, N, FUSED>(poses, &mut angles) {
            evaluate::<T, Q, N, M, FUSED>(quantity, poses.len(), &angles, &mut numbers);
        } else {
            one_by_one(quantity, poses, &mut numbers);
        }
        sink.take(BLOCK * block..BLOCK * block + poses.len(), &numbers);
    }
}

/// Coordinates, sines and cosines; false if some angle is out of the domain.
#[inline(always)]
fn turn<T: Float, const N: usize, const FUSED: bool>(
    poses: &[SVector<T, N>],
    [values, sines, cosines]: &mut [[[T; BLOCK]; N]; 3],
) -> bool {
    if cfg!(feature = "platform-trig") {
        return false;
    }
    for (pose, q) in poses.iter().enumerate() {
        for joint in 0..N {
            values[joint][pose] = q[joint];
        }
    }
    for joint in 0..N {
        if !trig::all_within_domain(&values[joint]) {
            // The values that fill up a later block would be beyond it too.
            *values = [[T::ZERO; BLOCK]; N];
            return false;
        }
        for pose in 0..BLOCK {
            (sines[joint][pose], cosines[joint][pose]) = trig::within_domain::<T, T, FUSED>(values[joint][pose]);
        }
    }
    true
}

/// The quantity at the first `count` poses, and some more up to whole vectors.
#[inline(always)]
fn evaluate<T, Q, const N: usize, const M: usize, const FUSED: bool>(
    quantity: &Q,
    count: usize,
    [values, sines, cosines]: &[[[T; BLOCK]; N]; 3],
    numbers: &mut [[T; BLOCK]; M],
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    // Two loops, both of a length that leaves no doubt: no index needs a check,
    // and no rest of a vector a loop of its own.
    for vector in 0..count.div_ceil(VECTOR).min(BLOCK / VECTOR) {
        for lane in 0..VECTOR {
            let pose = vector * VECTOR + lane;
            let q = SVector::from_fn(|joint, _| {
                Known::<T, FUSED>::angle(values[joint][pose], sines[joint][pose], cosines[joint][pose])
            });
            let computed = quantity.numbers(&q, Known::number);
            for k in 0..M {
                numbers[k][pose] = computed[k].value;
            }
        }
    }
}

#[cold]
#[inline(never)]
fn one_by_one<T: Float, Q: Quantity<T, N, M>, const N: usize, const M: usize>(
    quantity: &Q,
    poses: &[SVector<T, N>],
    numbers: &mut [[T; BLOCK]; M],
) {
    for (pose, q) in poses.iter().enumerate() {
        for (number, own) in numbers.iter_mut().zip(quantity.numbers(q, |x| x)) {
            number[pose] = own;
        }
    }
}
