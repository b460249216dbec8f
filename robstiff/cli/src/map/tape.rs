//! Robots read at run time at many poses: the expressions that generated code is
//! made of, interpreted several poses abreast.
//!
//! An operation is looked up once for [`WIDTH`] poses, so that most of the time
//! goes into the arithmetic.

use std::array;

use robstiff::nalgebra::{SVector, Vector6};
use robstiff::{Lanes, Real};
use robstiff_codegen::Function;
use robstiff_codegen::op::Op;
use robstiff_codegen::symbolic::{compliance, deflection};
use robstiff_machining::map::{Evaluate, Poses};
use robstiff_robots::Description;

/// Poses abreast.
const WIDTH: usize = 16;

type Abreast = Lanes<f64, WIDTH>;

/// A robot as two lists of operations.
pub struct Tape<const N: usize> {
    compliance: Program,
    deflection: Program,
}

/// The live nodes of a function in order, each with the slot of its result; a
/// slot serves again once nobody needs what is in it.
struct Program {
    steps: Vec<(Op, usize)>,
    angles: Vec<(Vec<(usize, f64)>, f64)>,
    /// Slots that hold a number from the start.
    numbers: Vec<(usize, f64)>,
    /// Slots that hold components of the wrench.
    wrench: Vec<(usize, usize)>,
    slots: usize,
    outputs: Vec<usize>,
}

impl Program {
    fn new(function: &Function) -> Self {
        let (nodes, uses) = (function.graph().nodes(), function.uses());
        let mut left = uses.clone();
        let (mut slot, mut free, mut slots) = (vec![0; nodes.len()], Vec::new(), 0);
        let (mut steps, mut numbers, mut wrench) = (Vec::new(), Vec::new(), Vec::new());
        let mut fresh = |free: &mut Vec<usize>| {
            free.pop().unwrap_or_else(|| {
                slots += 1;
                slots - 1
            })
        };
        for (id, node) in nodes.iter().enumerate().filter(|&(id, _)| uses[id] > 0) {
            // What is there from the start keeps its slot.
            let op = match (node.constant, node.op) {
                (Some(value), _) => {
                    slot[id] = fresh(&mut Vec::new());
                    numbers.push((slot[id], value));
                    continue;
                }
                // A robot that was never loaded.
                (None, Op::Play(..)) => {
                    slot[id] = fresh(&mut Vec::new());
                    numbers.push((slot[id], 0.0));
                    continue;
                }
                (None, Op::Wrench(index)) => {
                    slot[id] = fresh(&mut Vec::new());
                    wrench.push((slot[id], index));
                    continue;
                }
                (None, op) => op,
            };
            let placed = op.map_operands(|operand| slot[operand]);
            for operand in op.operands() {
                left[operand] -= 1;
                let kept =
                    nodes[operand].constant.is_some() || matches!(nodes[operand].op, Op::Wrench(_) | Op::Play(..));
                if left[operand] == 0 && !kept {
                    free.push(slot[operand]);
                }
            }
            slot[id] = fresh(&mut free);
            steps.push((placed, slot[id]));
        }
        let angles = function.graph().angles();
        let angles = angles.iter().map(|angle| {
            let terms = angle.terms().iter().map(|&(joint, factor)| (joint, f64::from(factor)));
            (terms.collect(), angle.offset())
        });
        Self {
            steps,
            angles: angles.collect(),
            numbers,
            wrench,
            slots,
            outputs: function.outputs().iter().map(|&id| slot[id]).collect(),
        }
    }

    /// Room for its values, with the numbers in it.
    fn room(&self) -> Vec<Abreast> {
        let mut values = vec![Lanes::splat(0.0); self.slots];
        for &(slot, value) in &self.numbers {
            values[slot] = Lanes::splat(value);
        }
        values
    }

    fn run<const N: usize>(&self, q: &[Abreast; N], values: &mut [Abreast], turns: &mut Vec<(Abreast, Abreast)>) {
        turns.clear();
        turns.extend(self.angles.iter().map(|(terms, offset)| {
            let sum = terms.iter().fold(Lanes::splat(*offset), |sum: Abreast, &(joint, factor)| {
                if factor == 1.0 { sum + q[joint] } else { sum + q[joint] * Lanes::splat(factor) }
            });
            sum.sin_cos()
        }));
        for &(op, slot) in &self.steps {
            values[slot] = match op {
                Op::Coordinate(joint) => q[joint],
                Op::Sin(angle) => turns[angle].0,
                Op::Cos(angle) => turns[angle].1,
                Op::Add(a, b) => values[a] + values[b],
                Op::Sub(a, b) => values[a] - values[b],
                Op::Mul(a, b) => values[a] * values[b],
                Op::Neg(a) => -values[a],
                Op::Sqrt(a) => values[a].sqrt(),
                Op::Recip(a) => values[a].recip(),
                Op::Max(a, b) => values[a].max(values[b]),
                Op::Min(a, b) => values[a].min(values[b]),
                Op::Number(_) | Op::NamedNumber(_) | Op::Wrench(_) | Op::Play(..) => {
                    unreachable!("these are there from the start")
                }
                op => unreachable!("compliance and deflection are computed in numbers, without {op:?}"),
            };
        }
    }
}

impl<const N: usize> Tape<N> {
    /// The robot that a description describes.
    pub fn new(robot: &Description) -> Self {
        Self {
            compliance: Program::new(&Function::of(|g| compliance(g, robot))),
            deflection: Program::new(&Function::of(|g| deflection(g, robot))),
        }
    }

    /// Runs a program at all poses under the wrench of each; `give` takes a pose's number
    /// and its lane of every output.
    fn run<const M: usize>(
        program: &Program,
        outputs: [usize; M],
        poses: Poses<'_, N>,
        wrench: impl Fn(usize) -> Vector6<f64>,
        mut give: impl FnMut(usize, [f64; M]),
    ) {
        let (mut values, mut turns) = (program.room(), Vec::new());
        let count = poses.len();
        for first in (0..count).step_by(WIDTH) {
            // The last pose fills up what is left of the last lanes.
            let q: [SVector<f64, N>; WIDTH] = array::from_fn(|lane| poses.pose((first + lane).min(count - 1)));
            for &(slot, index) in &program.wrench {
                values[slot] = Lanes(array::from_fn(|lane| wrench((first + lane).min(count - 1))[index]));
            }
            let q: [Abreast; N] = array::from_fn(|joint| Lanes(array::from_fn(|lane| q[lane][joint])));
            program.run(&q, &mut values, &mut turns);
            for pose in first..count.min(first + WIDTH) {
                give(pose, outputs.map(|output| values[program.outputs[output]][pose - first]));
            }
        }
    }
}

impl<const N: usize> Evaluate<N> for Tape<N> {
    fn deflections(&self, poses: Poses<'_, N>, wrench: &Vector6<f64>, deflections: &mut [Vector6<f64>]) {
        Self::run(&self.deflection, array::from_fn(|k| k), poses, |_| *wrench, |pose, d| deflections[pose] = d.into());
    }

    fn deflections_under(&self, poses: Poses<'_, N>, wrenches: &[Vector6<f64>], deflections: &mut [Vector6<f64>]) {
        let wrench = |pose: usize| wrenches[pose];
        Self::run(&self.deflection, array::from_fn(|k| k), poses, wrench, |pose, d| deflections[pose] = d.into());
    }

    fn triangles(&self, poses: Poses<'_, N>, triangles: &mut [[f64; 21]]) {
        let upper = (0..6).flat_map(|row| (row..6).map(move |column| 6 * row + column));
        let mut entries = [0; 21];
        for (entry, place) in entries.iter_mut().zip(upper) {
            *entry = place;
        }
        Self::run(&self.compliance, entries, poses, |_| Vector6::zeros(), |pose, triangle| triangles[pose] = triangle);
    }
}

#[cfg(test)]
mod tests {
    use robstiff::{Generic, Robot};
    use robstiff_machining::map::{Axis, JointSpace, Space};
    use robstiff_robots::catalogue::catalogue;

    use super::*;

    fn check<const N: usize>(robot: &Description) {
        let (tape, generic) = (Tape::<N>::new(robot), Generic::<N>::new(robot).unwrap());
        let q: Vec<SVector<f64, N>> =
            (0..37).map(|k| SVector::from_fn(|i, _| f64::sin(1.7 * f64::from(k) + 2.3 * i as f64))).collect();
        let wrench = Vector6::new(300.0, -500.0, 700.0, 40.0, -60.0, 80.0);
        let (mut deflections, mut triangles) = (vec![Vector6::zeros(); q.len()], vec![[0.0; 21]; q.len()]);
        tape.deflections(Poses::List(&q), &wrench, &mut deflections);
        tape.triangles(Poses::List(&q), &mut triangles);
        let wrenches: Vec<Vector6<f64>> = (0..q.len()).map(|k| wrench * (1.0 - 0.05 * k as f64)).collect();
        let mut under = deflections.clone();
        tape.deflections_under(Poses::List(&q), &wrenches, &mut under);
        for (k, q) in q.iter().enumerate() {
            let (d, h) = (generic.deflection(q, &wrench), generic.compliance(q));
            assert!((deflections[k] - d).norm() <= 1e-12 * d.norm(), "{}", robot.name);
            let own = generic.deflection(q, &wrenches[k]);
            assert!((under[k] - own).norm() <= 1e-12 * d.norm(), "{}", robot.name);
            let mut entry = 0;
            for row in 0..6 {
                for column in row..6 {
                    assert!((triangles[k][entry] - h[(row, column)]).abs() <= 1e-12 * h.amax(), "{}", robot.name);
                    entry += 1;
                }
            }
        }
    }

    #[test]
    fn it_says_what_the_reference_says() {
        for (file, text) in catalogue() {
            let robot = Description::parse(file, text).unwrap();
            match robot.joints.len() {
                5 => check::<5>(&robot),
                6 => check::<6>(&robot),
                count => panic!("{file} has {count} joints"),
            }
        }
    }

    #[test]
    fn effects_are_in_it() {
        let text = catalogue().iter().find(|(file, _)| file.starts_with("rv130hsc")).unwrap().1;
        let effects = "effects:\n  - {kind: transverse_compliance, at: joint 3, value: 6e-7}\n  \
                       - {kind: link_compliance, at: link 2, bending: 7e-8, torsion: 1.2e-7}\n  \
                       - {kind: lost_motion, at: joint 2, gap: 20 urad, knee: 50 Nm}\n";
        let robot = Description::parse("with-effects.yaml", &format!("{text}{effects}"));
        check::<5>(&robot.unwrap_or_else(|problems| panic!("{problems}")));
    }

    #[test]
    fn grids_are_poses_too() {
        let (file, text) = catalogue().iter().find(|(file, _)| file.starts_with("kuka-kr270")).unwrap();
        let robot = Description::parse(file, text).unwrap();
        let axes: [Axis; 6] = array::from_fn(|i| Axis::angles(&format!("q{}", i + 1), -0.4, 0.3, 1 + i % 3));
        let mut tables = Vec::new();
        let space = JointSpace::new(&axes, &mut tables);
        let measure = robstiff_machining::map::Measure::Stiffness;
        let by_tape = space.compute(&Tape::<6>::new(&robot), &measure, 5..30);
        let by_batch = space.compute(&Generic::<6>::new(&robot).unwrap(), &measure, 5..30);
        for (one, other) in by_tape[0].iter().zip(&by_batch[0]) {
            assert!((one - other).abs() < 1e-9 * other);
        }
    }
}
