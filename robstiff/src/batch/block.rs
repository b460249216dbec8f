//! A block of poses, three passes over it.

use nalgebra::SVector;

use super::Float;
use super::dispatch::Instructions;
use super::known::Known;
use super::needs::{Needs, Traced};
use super::quantities::Quantity;
use super::sink::Sink;
use super::source::{Filled, Source};

/// Poses in a block: what a block needs stays in the first-level cache.
pub const BLOCK: usize = 64;

/// The poses of a vector, at least: blocks are filled up to a multiple.
pub const VECTOR: usize = 16;

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

#[repr(align(64))]
struct Numbers<T, const M: usize>([[T; BLOCK]; M]);

/// Computes the quantity at all poses of a source, block by block.
///
/// Number `k` of all poses of a block lies side by side, so that the loops
/// over the poses become loops over vectors of poses:
///
/// 1. sines and cosines, joint by joint ([`Source::fill`]);
/// 2. the algebra of the robot;
/// 3. handing the numbers over ([`Sink::take`]).
///
/// All is inlined, because it takes the instructions that may be used from the
/// function around it.
#[inline(always)]
pub fn run<T, Q, S, K, const N: usize, const M: usize, const FUSED: bool>(
    quantity: &mut Q,
    source: &mut S,
    sink: &mut K,
    instructions: impl Instructions,
) where
    T: Float,
    Q: Quantity<T, N, M>,
    S: Source<T, N>,
    K: Sink<T, M>,
{
    let mut joints =
        Joints { values: [[T::ZERO; BLOCK]; N], sines: [[T::ZERO; BLOCK]; N], cosines: [[T::ZERO; BLOCK]; N] };
    let mut numbers = Numbers([[T::ZERO; BLOCK]; M]);
    // Constants, where the compiler sees through the robot.
    let needs = Needs::of(&quantity.numbers(0, &SVector::from_fn(|joint, _| Traced::joint(joint)), |_| Traced::NUMBER));
    let poses = source.poses();
    let mut first = 0;
    while first < poses {
        let filled = source.fill::<FUSED>(first, needs, &mut joints);
        let (Filled::Each(count) | Filled::Row(count) | Filled::Beyond(count)) = filled;
        quantity.prepare(first..first + count);
        match filled {
            Filled::Beyond(_) => one_by_one(quantity, count, |pose| source.pose(first + pose), &mut numbers.0),
            Filled::Row(_) if S::ROWS => evaluate_row::<T, Q, N, M, FUSED>(quantity, &joints, &mut numbers.0),
            _ => {}
        }
        for vector in 0..count.div_ceil(VECTOR).min(BLOCK / VECTOR) {
            if matches!(filled, Filled::Each(_)) {
                evaluate::<T, Q, N, M, FUSED>(quantity, vector, &joints, &mut numbers.0);
            }
            if K::BY_VECTOR {
                let (start, end) = (vector * VECTOR, count.min((vector + 1) * VECTOR));
                sink.take(first + start..first + end, start, &numbers.0, instructions);
            }
        }
        if !K::BY_VECTOR {
            sink.take(first..first + count, 0, &numbers.0, instructions);
        }
        first += count;
    }
}

/// The quantity at a vector of poses.
#[inline(always)]
fn evaluate<T, Q, const N: usize, const M: usize, const FUSED: bool>(
    quantity: &Q,
    vector: usize,
    joints: &Joints<T, N>,
    numbers: &mut [[T; BLOCK]; M],
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    // Of a length that leaves no doubt: no index needs a check, and no rest of a
    // vector a loop of its own.
    for lane in 0..VECTOR {
        evaluate_one::<T, Q, N, M, FUSED, false>(quantity, vector * VECTOR + lane, joints, numbers);
    }
}

/// The quantity at a row of poses that differ in the first joint: what depends
/// on the others alone, the compiler computes before the loop.
#[inline(always)]
fn evaluate_row<T, Q, const N: usize, const M: usize, const FUSED: bool>(
    quantity: &Q,
    joints: &Joints<T, N>,
    numbers: &mut [[T; BLOCK]; M],
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    for pose in 0..BLOCK {
        evaluate_one::<T, Q, N, M, FUSED, true>(quantity, pose, joints, numbers);
    }
}

#[inline(always)]
fn evaluate_one<T, Q, const N: usize, const M: usize, const FUSED: bool, const ROW: bool>(
    quantity: &Q,
    pose: usize,
    joints: &Joints<T, N>,
    numbers: &mut [[T; BLOCK]; M],
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    let q = SVector::from_fn(|joint, _| {
        let pose = if ROW && joint > 0 { 0 } else { pose };
        Known::<T, FUSED>::angle(joints.values[joint][pose], joints.sines[joint][pose], joints.cosines[joint][pose])
    });
    let computed = quantity.numbers(pose, &q, Known::number);
    for k in 0..M {
        numbers[k][pose] = computed[k].value;
    }
}

#[cold]
#[inline(never)]
fn one_by_one<T: Float, Q: Quantity<T, N, M>, const N: usize, const M: usize>(
    quantity: &Q,
    count: usize,
    q: impl Fn(usize) -> SVector<T, N>,
    numbers: &mut [[T; BLOCK]; M],
) {
    for pose in 0..count.min(BLOCK) {
        for (number, own) in numbers.iter_mut().zip(quantity.numbers(pose, &q(pose), |x| x)) {
            number[pose] = own;
        }
    }
}
