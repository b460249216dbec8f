//! A block of poses, three passes over it.

use nalgebra::SVector;

use super::Float;
use super::instructions::Instructions;
use super::known::Known;
use super::needs::{Needs, Traced};
use super::quantities::Quantity;
use super::sink::{Sink, Vectors};
use super::source::{Filled, Source};

/// Poses in a block: what a block needs stays in the first-level cache.
pub const BLOCK: usize = 64;

/// The poses of a vector, at least: blocks are filled up to a multiple.
const VECTOR: usize = 16;

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
/// 3. handing the numbers over, vector by vector from the registers
///    ([`Sink::take_vector`]) or by way of the block ([`Sink::take`]).
///
/// All is inlined, because it takes the instructions that may be used from the
/// function around it. `LANES` numbers fit into one, 1 where that is not known, and
/// `PART` are the poses whose results are rearranged at once.
#[inline(always)]
pub fn run<T, Q, S, K, const N: usize, const M: usize, const LANES: usize, const PART: usize, const FUSED: bool>(
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
    let mut kept = Numbers([[T::ZERO; BLOCK]; M]);
    // Constants, where the compiler sees through the robot.
    let mut needs = Needs::default();
    let traced = SVector::from_fn(|joint, _| Traced::joint(joint));
    quantity.put_numbers(0, &traced, |_| Traced::NUMBER, |_, number| needs.add(number));
    let poses = source.poses();
    let mut first = 0;
    while first < poses {
        let filled = source.fill::<FUSED>(first, needs, &mut joints, instructions);
        let (Filled::Each(count) | Filled::Row(count) | Filled::Beyond(count)) = filled;
        quantity.prepare(first..first + count);
        // `const`, so that the other ways are not compiled at all.
        let is_done = match filled {
            Filled::Each(_) if const { matches!(K::VECTORS, Vectors::Whole) } => {
                evaluate_vectors::<T, Q, K, N, M, LANES, FUSED>(quantity, first, count, &joints, sink, instructions)
            }
            Filled::Each(_) if const { matches!(K::VECTORS, Vectors::Parts) } => {
                evaluate_vectors::<T, Q, K, N, M, PART, FUSED>(quantity, first, count, &joints, sink, instructions)
            }
            _ => false,
        };
        if !is_done {
            // A sink that takes vectors needs this once at most, for the last poses.
            let numbers =
                if K::VECTORS == Vectors::No || S::ROWS { &mut kept } else { &mut Numbers([[T::ZERO; BLOCK]; M]) };
            match filled {
                Filled::Each(_) => evaluate::<T, Q, N, M, FUSED>(quantity, count, &joints, &mut numbers.0),
                Filled::Row(_) if const { S::ROWS } => {
                    evaluate_row::<T, Q, N, M, FUSED>(quantity, &joints, &mut numbers.0)
                }
                Filled::Row(_) => {}
                Filled::Beyond(_) => one_by_one(quantity, count, |pose| source.pose(first + pose), &mut numbers.0),
            }
            sink.take(first..first + count, &numbers.0, instructions);
        }
        first += count;
    }
}

/// The quantity at the first poses of a block.
#[inline(always)]
fn evaluate<T, Q, const N: usize, const M: usize, const FUSED: bool>(
    quantity: &Q,
    count: usize,
    joints: &Joints<T, N>,
    numbers: &mut [[T; BLOCK]; M],
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    for vector in 0..count.div_ceil(VECTOR).min(BLOCK / VECTOR) {
        // Of a length that leaves no doubt: no index needs a check, and no rest of a
        // vector a loop of its own.
        for lane in 0..VECTOR {
            let pose = vector * VECTOR + lane;
            evaluate_one::<T, Q, N, M, BLOCK, FUSED, false>(quantity, pose, joints, numbers, pose);
        }
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
        evaluate_one::<T, Q, N, M, BLOCK, FUSED, true>(quantity, pose, joints, numbers, pose);
    }
}

/// The quantity at the first poses of a block, from the registers to the sink; or
/// nothing, and `false`, where they are no whole vectors.
#[inline(always)]
fn evaluate_vectors<T, Q, K, const N: usize, const M: usize, const LANES: usize, const FUSED: bool>(
    quantity: &Q,
    first: usize,
    count: usize,
    joints: &Joints<T, N>,
    sink: &mut K,
    instructions: impl Instructions,
) -> bool
where
    T: Float,
    Q: Quantity<T, N, M>,
    K: Sink<T, M>,
{
    if const { LANES == 1 } || !count.is_multiple_of(LANES) {
        return false;
    }
    // In these words no index needs a check.
    for start in (0..BLOCK).step_by(LANES) {
        if start >= count {
            break;
        }
        let numbers = evaluate_vector::<T, Q, N, M, LANES, FUSED>(quantity, start, joints);
        sink.take_vector(first + start, &numbers, instructions);
    }
    true
}

/// The quantity at a vector of poses of a block, pose `first` and those behind it.
///
/// Of one vector each, and on their own, so that the numbers are in registers: the
/// compiler does not know that what lies behind references is apart.
#[inline(always)]
fn evaluate_vector<T, Q, const N: usize, const M: usize, const LANES: usize, const FUSED: bool>(
    quantity: &Q,
    first: usize,
    joints: &Joints<T, N>,
) -> [[T; LANES]; M]
where
    T: Float,
    Q: Quantity<T, N, M>,
{
    let mut numbers = [[T::ZERO; LANES]; M];
    for lane in 0..LANES {
        evaluate_one::<T, Q, N, M, LANES, FUSED, false>(quantity, first + lane, joints, &mut numbers, lane);
    }
    numbers
}

/// The quantity at a pose of a block, to a place among the numbers.
#[inline(always)]
fn evaluate_one<T, Q, const N: usize, const M: usize, const PLACES: usize, const FUSED: bool, const ROW: bool>(
    quantity: &Q,
    pose: usize,
    joints: &Joints<T, N>,
    numbers: &mut [[T; PLACES]; M],
    place: usize,
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    let q = SVector::from_fn(|joint, _| {
        let pose = if ROW && joint > 0 { 0 } else { pose };
        Known::<T, FUSED>::angle(joints.values[joint][pose], joints.sines[joint][pose], joints.cosines[joint][pose])
    });
    quantity.put_numbers(pose, &q, Known::number, |k, number| numbers[k][place] = number.value);
}

#[cold]
#[inline(never)]
fn one_by_one<T: Float, Q: Quantity<T, N, M>, const N: usize, const M: usize>(
    quantity: &Q,
    count: usize,
    q: impl Fn(usize) -> SVector<T, N>,
    numbers: &mut [[T; BLOCK]; M],
) {
    (0..count.min(BLOCK)).for_each(|pose| {
        quantity.put_numbers(pose, &q(pose), |x| x, |k, number| numbers[k][pose] = number);
    });
}
