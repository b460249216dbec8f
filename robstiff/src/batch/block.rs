//! A block of poses, three passes over it.

use nalgebra::SVector;

use super::Float;
use super::known::Known;
use super::quantities::Quantity;
use crate::trig;

/// Poses in a block: what a block needs stays in the first-level cache.
pub const BLOCK: usize = 64;

/// The poses of a vector, at least: blocks are filled up to a multiple.
const VECTOR: usize = 16;

/// Computes `results` of `poses`, block by block.
///
/// Number `k` of all poses of a block lies side by side, so that the loops
/// over the poses become loops over vectors of poses:
///
/// 1. sines and cosines, joint by joint;
/// 2. the algebra of the robot;
/// 3. putting the results together.
///
/// Everything is inlined, because it takes the instructions that may be used
/// from the function around it.
#[inline(always)]
pub fn run<T, Q, const N: usize, const M: usize, const FUSED: bool>(
    quantity: &Q,
    poses: &[SVector<T, N>],
    results: &mut [Q::Result],
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    let mut angles = [[[T::ZERO; BLOCK]; N]; 3];
    let mut numbers = [[T::ZERO; BLOCK]; M];
    for (poses, results) in poses.chunks(BLOCK).zip(results.chunks_mut(BLOCK)) {
        if !turn::<T, N, FUSED>(poses, &mut angles) {
            one_by_one(quantity, poses, results);
            continue;
        }
        evaluate::<T, Q, N, M, FUSED>(quantity, poses.len().next_multiple_of(VECTOR), &angles, &mut numbers);
        put_together::<T, Q, N, M>(&numbers, results);
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
            (sines[joint][pose], cosines[joint][pose]) = trig::within_domain::<T, FUSED>(values[joint][pose]);
        }
    }
    true
}

/// The quantity at the first `count` poses.
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
    for pose in 0..count.min(BLOCK) {
        let q = SVector::from_fn(|joint, _| {
            Known::<T, FUSED>::angle(values[joint][pose], sines[joint][pose], cosines[joint][pose])
        });
        let computed = quantity.numbers(&q, Known::number);
        for k in 0..M {
            numbers[k][pose] = computed[k].value;
        }
    }
}

/// The results of a block. Not inlined, because with AVX-512 the compiler makes
/// gather instructions of it, which are slow.
#[inline(never)]
fn put_together<T: Float, Q: Quantity<T, N, M>, const N: usize, const M: usize>(
    numbers: &[[T; BLOCK]; M],
    results: &mut [Q::Result],
) {
    for (pose, result) in results.iter_mut().enumerate().take(BLOCK) {
        let mut own = [T::ZERO; M];
        for k in 0..M {
            own[k] = numbers[k][pose];
        }
        *result = Q::result(own);
    }
}

#[cold]
#[inline(never)]
fn one_by_one<T: Float, Q: Quantity<T, N, M>, const N: usize, const M: usize>(
    quantity: &Q,
    poses: &[SVector<T, N>],
    results: &mut [Q::Result],
) {
    for (q, result) in poses.iter().zip(results) {
        *result = Q::result(quantity.numbers(q, |x| x));
    }
}
