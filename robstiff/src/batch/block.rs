//! A block of poses, three passes over it.

use nalgebra::SVector;

use super::Float;
use super::instructions::Instructions;
use super::joints::{BLOCK, Joints};
use super::known::Known;
use super::needs::{Needs, Traced};
use super::quantities::Quantity;
use super::sink::{Sink, Vectors};
use super::source::{Filled, Source};

/// The poses of a vector, at least: blocks are filled up to a multiple.
const VECTOR: usize = 16;

#[repr(align(64))]
struct Numbers<T, const M: usize>([[T; BLOCK]; M]);

/// How many numbers are in a vector, 1 where that is not known, and whether there is an
/// instruction that multiplies and adds: a value, so that a call says no more than this
/// and leaves the other types to the compiler.
#[derive(Clone, Copy)]
pub struct Width<const LANES: usize, const FUSED: bool>;

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
/// function around it. Results that are rearranged are computed `part` by part.
#[inline(always)]
pub fn run<T, S, K, const N: usize, const M: usize, const LANES: usize, const PART: usize, const FUSED: bool>(
    quantity: &mut impl Quantity<T, N, M>,
    source: &mut S,
    sink: &mut K,
    instructions: impl Instructions,
    whole: Width<LANES, FUSED>,
    part: Width<PART, FUSED>,
) where
    T: Float,
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
                evaluate_vectors(quantity, first, count, &joints, sink, instructions, whole)
            }
            Filled::Each(_) if const { matches!(K::VECTORS, Vectors::Parts) } => {
                evaluate_vectors(quantity, first, count, &joints, sink, instructions, part)
            }
            _ => false,
        };
        if !is_done {
            // A sink that takes vectors needs this once at most, for the last poses.
            let numbers =
                if K::VECTORS == Vectors::No || S::ROWS { &mut kept } else { &mut Numbers([[T::ZERO; BLOCK]; M]) };
            match filled {
                Filled::Each(_) => evaluate(quantity, count, &joints, &mut numbers.0, whole),
                Filled::Row(_) if const { S::ROWS } => evaluate_row(quantity, &joints, &mut numbers.0, whole),
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
fn evaluate<T: Float, const N: usize, const M: usize, const LANES: usize, const FUSED: bool>(
    quantity: &impl Quantity<T, N, M>,
    count: usize,
    joints: &Joints<T, N>,
    numbers: &mut [[T; BLOCK]; M],
    width: Width<LANES, FUSED>,
) {
    for vector in 0..count.div_ceil(VECTOR).min(BLOCK / VECTOR) {
        // Of a length that leaves no doubt: no index needs a check, and no rest of a
        // vector a loop of its own.
        for lane in 0..VECTOR {
            let pose = vector * VECTOR + lane;
            evaluate_one(quantity, pose, pose, joints, numbers, pose, width);
        }
    }
}

/// The quantity at a row of poses that differ in the first joint: what depends
/// on the others alone, the compiler computes before the loop.
#[inline(always)]
fn evaluate_row<T: Float, const N: usize, const M: usize, const LANES: usize, const FUSED: bool>(
    quantity: &impl Quantity<T, N, M>,
    joints: &Joints<T, N>,
    numbers: &mut [[T; BLOCK]; M],
    width: Width<LANES, FUSED>,
) {
    for pose in 0..BLOCK {
        evaluate_one(quantity, pose, 0, joints, numbers, pose, width);
    }
}

/// The quantity at the first poses of a block, from the registers to the sink; or
/// nothing, and `false`, where they are no whole vectors.
#[inline(always)]
fn evaluate_vectors<T: Float, const N: usize, const M: usize, const LANES: usize, const FUSED: bool>(
    quantity: &impl Quantity<T, N, M>,
    first: usize,
    count: usize,
    joints: &Joints<T, N>,
    sink: &mut impl Sink<T, M>,
    instructions: impl Instructions,
    width: Width<LANES, FUSED>,
) -> bool {
    if const { LANES == 1 } || !count.is_multiple_of(LANES) {
        return false;
    }
    // In these words no index needs a check.
    for start in (0..BLOCK).step_by(LANES) {
        if start >= count {
            break;
        }
        let numbers = evaluate_vector(quantity, start, joints, width);
        sink.take_vector(first + start, &numbers, instructions);
    }
    true
}

/// The quantity at a vector of poses of a block, pose `first` and those behind it.
///
/// Of one vector each, and on their own, so that the numbers are in registers: the
/// compiler does not know that what lies behind references is apart.
#[inline(always)]
fn evaluate_vector<T: Float, const N: usize, const M: usize, const LANES: usize, const FUSED: bool>(
    quantity: &impl Quantity<T, N, M>,
    first: usize,
    joints: &Joints<T, N>,
    width: Width<LANES, FUSED>,
) -> [[T; LANES]; M] {
    let mut numbers = [[T::ZERO; LANES]; M];
    for lane in 0..LANES {
        evaluate_one(quantity, first + lane, first + lane, joints, &mut numbers, lane, width);
    }
    numbers
}

/// The quantity at a pose of a block, to a place among the numbers; the coordinates of
/// all joints but the first are those of `others`.
#[inline(always)]
fn evaluate_one<T, const N: usize, const M: usize, const PLACES: usize, const LANES: usize, const FUSED: bool>(
    quantity: &impl Quantity<T, N, M>,
    pose: usize,
    others: usize,
    joints: &Joints<T, N>,
    numbers: &mut [[T; PLACES]; M],
    place: usize,
    _: Width<LANES, FUSED>,
) where
    T: Float,
{
    let q = SVector::from_fn(|joint, _| {
        let pose = if joint > 0 { others } else { pose };
        Known::<T, FUSED>::angle(joints.values[joint][pose], joints.sines[joint][pose], joints.cosines[joint][pose])
    });
    quantity.put_numbers(pose, &q, Known::number, |k, number| numbers[k][place] = number.value);
}

#[cold]
#[inline(never)]
fn one_by_one<T: Float, const N: usize, const M: usize>(
    quantity: &impl Quantity<T, N, M>,
    count: usize,
    q: impl Fn(usize) -> SVector<T, N>,
    numbers: &mut [[T; BLOCK]; M],
) {
    (0..count.min(BLOCK)).for_each(|pose| {
        quantity.put_numbers(pose, &q(pose), |x| x, |k, number| numbers[k][pose] = number);
    });
}
