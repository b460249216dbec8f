//! Our side of `benches/peers`: generated robots, robots read at run time, and a
//! plain loop over the DH table in nalgebra.

use std::hint::black_box;

use robstiff::batch::{ByJoint, Float};
use robstiff::nalgebra::{Matrix4, Matrix6, SMatrix, SVector, Vector6};
use robstiff::{Generic, Robot, Statics, batch, upper_triangle};
use robstiff_benches::{Rv130hsc, WRENCH};
use robstiff_robots::Description;

#[path = "../../peers/harness.rs"]
mod harness;
#[path = "../../peers/nalgebra.rs"]
mod nalgebra;

use harness::COUNT;

robstiff::robot!("six-axis.yaml");

const OURS: &str = "robstiff";
/// Poses a slice a joint, and the compliance a slice an entry.
const BY_JOINT: &str = "robstiff, by joint";

/// T and J by columns, the triangle of H_x, one after the other.
fn all<const N: usize, const ALL: usize>(
    transform: &Matrix4<f64>,
    jacobian: &SMatrix<f64, 6, N>,
    compliance: &Matrix6<f64>,
    out: &mut [f64; ALL],
) {
    let (first, rest) = out.split_at_mut(16);
    first.copy_from_slice(transform.as_slice());
    let (columns, upper) = rest.split_at_mut(6 * N);
    columns.copy_from_slice(jacobian.as_slice());
    upper.copy_from_slice(&upper_triangle(compliance));
}

/// One pose after the other; `J` and `ALL` are the numbers of entries of the
/// Jacobian, and of T, J and H_x together.
fn singles<const N: usize, const J: usize, const ALL: usize>(label: &str, name: &str, robot: &impl Robot<N>) {
    let poses: Vec<SVector<f64, N>> = harness::poses().into_iter().map(SVector::from).collect();
    let way = |quantity| [label, quantity, name];
    harness::one(way("T"), &poses, |q, out: &mut [f64; 16]| {
        out.copy_from_slice(robot.transform(q).as_slice());
    });
    harness::one(way("J"), &poses, |q, out: &mut [f64; J]| out.copy_from_slice(robot.jacobian(q).as_slice()));
    harness::one(way("H"), &poses, |q, out: &mut [f64; 21]| *out = upper_triangle(&robot.compliance(q)));
    harness::one(way("TJH"), &poses, |q, out: &mut [f64; ALL]| {
        let Statics { transform, jacobian, compliance } = robot.statics(q);
        all(&transform, &jacobian, &compliance, out);
    });
}

/// The same by the plain loop.
fn plain<const N: usize, const J: usize, const ALL: usize>(label: &str, arm: &nalgebra::Arm<N>) {
    let poses: Vec<SVector<f64, N>> = harness::poses().into_iter().map(SVector::from).collect();
    let way = |quantity| [label, quantity, "a loop in nalgebra 0.35"];
    harness::one(way("T"), &poses, |q, out: &mut [f64; 16]| out.copy_from_slice(arm.transform(q).as_slice()));
    harness::one(way("J"), &poses, |q, out: &mut [f64; J]| out.copy_from_slice(arm.jacobian(q).0.as_slice()));
    harness::one(way("H"), &poses, |q, out: &mut [f64; 21]| *out = upper_triangle(&arm.compliance(&arm.jacobian(q).0)));
    harness::one(way("TJH"), &poses, |q, out: &mut [f64; ALL]| {
        let (jacobian, tip) = arm.jacobian(q);
        all(&tip, &jacobian, &arm.compliance(&jacobian), out);
    });
}

/// Numbers of all poses, side by side. They begin at a line of the cache, as in C the
/// peers' arrays do.
#[repr(align(64))]
#[derive(Clone, Copy)]
struct Column<T>([T; COUNT]);

/// All poses in one call; `precision` is what the quantities' names end in.
fn batches<T: Float + Into<f64>, const N: usize>(label: &str, precision: &str, robot: &impl Robot<N>) {
    let poses: Vec<SVector<T, N>> = harness::poses().into_iter().map(|q| SVector::from(q.map(T::of))).collect();
    let columns: [Column<T>; N] = std::array::from_fn(|joint| Column(std::array::from_fn(|k| poses[k][joint])));
    let by_joint = ByJoint::new(columns.each_ref().map(|column| &column.0[..]));
    let wrench = WRENCH.map(T::of);
    let quantity = |name| format!("{name}, batch{precision}");

    let mut triangles = vec![[T::zero(); 21]; COUNT];
    harness::all(
        [label, &quantity("H"), OURS],
        &mut triangles,
        |out| batch::compliance_triangle(robot, &poses, out),
        |out, k| out[k].map(T::into).to_vec(),
    );
    let mut entries = Box::new([Column([T::zero(); COUNT]); 21]);
    harness::all(
        [label, &quantity("H"), BY_JOINT],
        &mut entries,
        |out| batch::compliance_by_entry(robot, by_joint, out.each_mut().map(|entry| &mut entry.0[..])),
        |out, k| out.iter().map(|entry| entry.0[k].into()).collect(),
    );
    // Handed over in blocks, and kept only where they are to be checked.
    let checking = harness::is_check();
    harness::all(
        [label, &quantity("H"), "robstiff, by block"],
        &mut entries,
        |out| {
            batch::compliance_blocks(robot, by_joint, |range, block| {
                if checking {
                    for (entry, numbers) in out.iter_mut().zip(block) {
                        entry.0[range.clone()].copy_from_slice(&numbers[..range.len()]);
                    }
                }
                black_box(block);
            });
        },
        |out, k| out.iter().map(|entry| entry.0[k].into()).collect(),
    );
    let mut traces = vec![T::zero(); COUNT];
    harness::all(
        [label, &quantity("trace"), OURS],
        &mut traces,
        |out| batch::translational_trace(robot, &poses, out),
        |out, k| vec![out[k].into()],
    );
    harness::all(
        [label, &quantity("trace"), BY_JOINT],
        &mut traces,
        |out| batch::translational_trace(robot, by_joint, out),
        |out, k| vec![out[k].into()],
    );
    let mut deflections = vec![Vector6::zeros(); COUNT];
    harness::all(
        [label, &quantity("deflection"), OURS],
        &mut deflections,
        |out| batch::deflection(robot, &poses, &wrench, out),
        |out, k| out[k].map(T::into).as_slice().to_vec(),
    );
    harness::all(
        [label, &quantity("deflection"), BY_JOINT],
        &mut deflections,
        |out| batch::deflection(robot, by_joint, &wrench, out),
        |out, k| out[k].map(T::into).as_slice().to_vec(),
    );
}

fn main() {
    let read = |text| Description::parse("the robot", text).expect("it has no mistakes");
    let five = read(include_str!("../../../robots/rv130hsc.yaml"));
    let six = read(include_str!("../../robots/six-axis.yaml"));
    let at_run_time = "robstiff read at run time";
    singles::<5, 30, 67>("R5", OURS, &Rv130hsc);
    singles::<6, 36, 73>("R6", OURS, &SixAxis);
    singles::<5, 30, 67>("R5", at_run_time, &Generic::<5>::new(&five).expect("five joints"));
    singles::<6, 36, 73>("R6", at_run_time, &Generic::<6>::new(&six).expect("six joints"));
    plain::<5, 30, 67>("R5", &nalgebra::Arm::new(&five));
    plain::<6, 36, 73>("R6", &nalgebra::Arm::new(&six));
    batches::<f64, 5>("R5", "", &Rv130hsc);
    batches::<f64, 6>("R6", "", &SixAxis);
    batches::<f32, 5>("R5", ", f32", &Rv130hsc);
    batches::<f32, 6>("R6", ", f32", &SixAxis);
}
