use std::vec;
use std::vec::Vec;

use nalgebra::{Matrix6, SVector, Vector3, Vector6};

use super::dispatch::{Level, run_at};
use super::quantities::{Quantity, Results};
use super::source::Source;
use super::*;
use crate::samples::{linear_effects, odd};
use crate::{Effect, Generic};

// One arm whose code is generated, and one read at run time. Arms of other kinds are
// compared in a crate of their own: each is compiled once more for every level and quantity.
crate::robot!("rv130hsc.yaml");

const WRENCH: Vector6<f64> = Vector6::new(300.0, -500.0, 700.0, 40.0, -60.0, 80.0);
const DIRECTION: Vector3<f64> = Vector3::new(0.36, -0.48, 0.8);

fn poses<const N: usize>(count: usize) -> Vec<SVector<f64, N>> {
    (0..count).map(|k| SVector::from_fn(|i, _| 3.0 * f64::sin(1.7 * k as f64 + 2.3 * i as f64))).collect()
}

/// On every level: what `expected` says of each pose, to 1e-13 of the largest
/// number of the pose.
fn check<V, Q, R, const N: usize, const M: usize>(
    quantity: impl Fn() -> Q,
    poses: V,
    expected: impl Fn(&SVector<f64, N>) -> R,
    numbers: impl Fn(&R) -> Vec<f64>,
) where
    V: View<f64, N>,
    Q: Quantity<f64, N, M>,
    R: Results<f64, M> + Clone,
{
    let source = poses.source();
    let expected: Vec<R> = (0..poses.count()).map(|k| expected(&source.pose(k))).collect();
    for level in Level::available() {
        let mut results = expected.clone();
        results.iter_mut().for_each(|result| result.entries().fill(f64::NAN));
        run_at(level, quantity(), poses.source(), EachPose(&mut results));
        for (k, (result, expected)) in results.iter().zip(&expected).enumerate() {
            let (result, expected) = (numbers(result), numbers(expected));
            let size = expected.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
            for (a, b) in result.iter().zip(&expected) {
                assert!((a - b).abs() <= 1e-13 * size, "{level:?}, pose {k}: {a:e} for {b:e}, size {size:e}");
            }
        }
    }
}

fn check_all<const N: usize>(robot: &impl Robot<N>, poses: impl View<f64, N>) {
    let (wrench, direction) = (WRENCH, DIRECTION);
    let compliance = |q: &SVector<f64, N>| robot.compliance(q);
    let block = |q: &SVector<f64, N>| compliance(q).fixed_view::<3, 3>(0, 0).into_owned();
    let triangle = |q: &SVector<f64, N>| {
        let entries: Vec<f64> = (0..6).flat_map(|i| (i..6).map(move |j| (i, j))).map(|at| compliance(q)[at]).collect();
        entries.try_into().unwrap()
    };
    check(|| Triangle { robot }, poses, triangle, |entries: &[f64; 21]| entries.to_vec());
    check(|| Trace { robot }, poses, |q| block(q).trace(), |x| vec![*x]);
    check(|| Directional { robot, direction }, poses, |q| direction.dot(&(block(q) * direction)), |x| vec![*x]);
    check(|| Deflection { robot, wrench }, poses, |q| robot.deflection(q, &wrench), |v| v.as_slice().to_vec());
    check_matrices_and_own_wrenches(robot, poses);
}

/// The widest results, and what differs from pose to pose.
fn check_matrices_and_own_wrenches<const N: usize>(robot: &impl Robot<N>, poses: impl View<f64, N>) {
    check(|| Triangle { robot }, poses, |q| robot.compliance(q), |m| m.as_slice().to_vec());
    let k = std::cell::Cell::new(0);
    let wrenches: Vec<_> = (0..poses.count()).map(own_wrench).collect();
    let own = |q: &SVector<f64, N>| robot.deflection(q, &wrenches[k.replace(k.get() + 1)]);
    check(|| Deflections::new(robot, &wrenches), poses, own, |v| v.as_slice().to_vec());
}

/// A wrench that differs from pose to pose.
fn own_wrench(pose: usize) -> Vector6<f64> {
    Vector6::from_fn(|i, _| WRENCH[i] * (1.0 + 0.5 * f64::sin(1.1 * pose as f64 + i as f64)))
}

#[test]
fn every_level_gives_what_single_poses_give() {
    // Nothing, parts of vectors, whole blocks, blocks and a tail.
    for count in [0, 1, 7, 16, 63, 64, 65, 128, 200] {
        check_all(&Rv130hsc, &poses(count)[..]);
    }
}

/// The coordinates of each joint.
fn columns<T: Float, const N: usize>(poses: &[SVector<T, N>]) -> [Vec<T>; N] {
    core::array::from_fn(|joint| poses.iter().map(|q| q[joint]).collect())
}

#[test]
fn by_joint_gives_what_single_poses_give() {
    let mut sliding = odd();
    sliding.effects = linear_effects();
    let sliding = Generic::<6>::new(&sliding).unwrap();
    for count in [0, 1, 63, 64, 65, 200] {
        let columns = columns(&poses::<5>(count));
        check_all(&Rv130hsc, ByJoint::new(columns.each_ref().map(|joint| &joint[..])));
        let columns = self::columns(&poses::<6>(count));
        let joints = columns.each_ref().map(|joint| &joint[..]);
        check_matrices_and_own_wrenches(&sliding, ByJoint::new(joints));
        check_matrices_and_own_wrenches(&sliding, ByJoint::new(joints).cut(count / 3..count));
    }
}

#[test]
fn by_joint_in_single_precision_is_the_same() {
    let poses: Vec<SVector<f32, 5>> = poses::<5>(150).iter().map(|q| q.map(|x| x as f32)).collect();
    let columns = columns(&poses);
    let joints = ByJoint::new(columns.each_ref().map(|joint| &joint[..]));
    for level in Level::available() {
        let (mut by_pose, mut by_joint) = (vec![[f32::NAN; 21]; 150], vec![[f32::NAN; 21]; 150]);
        run_at(level, Triangle { robot: &Rv130hsc }, &poses[..], EachPose(&mut by_pose));
        run_at(level, Triangle { robot: &Rv130hsc }, joints, EachPose(&mut by_joint));
        assert_eq!(by_pose, by_joint, "{level:?}");
    }
}

#[test]
#[should_panic(expected = "as many coordinates")]
fn joints_of_fewer_poses_are_refused() {
    let _ = ByJoint::new([&[0.1, 0.2][..], &[0.3]]);
}

#[test]
fn robots_read_at_run_time_come_in_batches_too() {
    let mut description = odd();
    description.effects = linear_effects();
    description.effects.push(Effect::StiffnessNonlinearity { joint: 5, added: 2e-6, knee: 300.0 });
    let [radius1, weight1] = [50.0, 5e-8];
    let [radius2, weight2, radius3, weight3] = [0.0; 4];
    let hysteresis = Effect::Hysteresis { joint: 5, radius1, weight1, radius2, weight2, radius3, weight3 };
    description.effects.push(hysteresis);
    check_all(&Generic::<6>::new(&description).unwrap(), &poses(70)[..]);
}

/// Coordinates of as many joints as there are lengths, wide apart.
fn coordinates<const N: usize>(lengths: [usize; N]) -> [Vec<f64>; N] {
    let mut joint = 0;
    lengths.map(|length| {
        joint += 1;
        (0..length).map(|i| 3.0 * f64::sin(1.3 * i as f64 + 2.3 * joint as f64)).collect()
    })
}

/// Checks part of a grid of so many coordinates a joint.
fn check_grid<const N: usize>(
    lengths: [usize; N],
    part: impl Fn(usize) -> Range<usize>,
    check: impl Fn(Grid<'_, f64, N>),
) {
    let coordinates = coordinates(lengths);
    let coordinates = coordinates.each_ref().map(|axis| &axis[..]);
    let mut tables = vec![0.0; Grid::table_len(&coordinates)];
    let grid = Grid::new(coordinates, &mut tables);
    check(grid.part(part(grid.len())));
}

#[test]
fn grids_give_what_single_poses_give() {
    // Rows and parts of rows, the first joint fixed, short rows, one pose, none.
    for lengths in [
        [65, 2, 3, 1, 2],
        [32, 1, 2, 2, 1],
        [31, 3, 2, 1, 1],
        [200, 1, 1, 1, 1],
        [1, 65, 3, 1, 1],
        [1, 1, 7, 1, 20],
        [7, 7, 1, 2, 3],
        [2, 1, 2, 2, 33],
        [1, 1, 1, 1, 1],
        [7, 65, 0, 1, 2],
    ] {
        check_grid(lengths, |len| 0..len, |grid| check_all(&Rv130hsc, grid));
        check_grid(lengths, |len| len / 3..len - len / 5, |grid| check_all(&Rv130hsc, grid));
    }
    let mut description = odd();
    description.effects = linear_effects();
    description.effects.push(Effect::StiffnessNonlinearity { joint: 5, added: 2e-6, knee: 300.0 });
    let robot = Generic::<6>::new(&description).unwrap();
    let check = |grid: Grid<'_, f64, 6>| check_matrices_and_own_wrenches(&robot, grid);
    check_grid([40, 2, 1, 1, 2, 1], |len| 0..len, check);
    check_grid([70, 2, 3, 1, 2, 1], |len| 0..len, check);
    check_grid([2, 3, 2, 1, 2, 3], |len| 0..len, check);
    check_grid([1, 7, 3, 2, 2, 3], |len| 1..len, check);
}

#[test]
fn the_first_joint_of_a_grid_changes_fastest() {
    let coordinates: [&[f64]; 3] = [&[1.0, 2.0], &[10.0, 20.0, 30.0], &[100.0, 200.0]];
    let mut tables = [0.0; 14];
    let grid = Grid::new(coordinates, &mut tables);
    assert_eq!(grid.len(), 12);
    assert_eq!(grid.pose(1 + 2 * (2 + 3)), SVector::from([2.0, 30.0, 200.0]));
    let part = grid.part(5..9).part(1..3);
    assert_eq!((part.len(), part.is_empty()), (2, false));
    assert_eq!(part.pose(1), grid.pose(7));
    assert!(part.part(2..2).is_empty());
}

#[test]
#[should_panic(expected = "there are 2 poses")]
fn a_part_lies_within_the_grid() {
    let mut tables = [0.0; 4];
    Grid::new([&[1.0, 2.0]], &mut tables).part(1..3);
}

#[test]
fn a_coordinate_out_of_the_domain_spoils_no_others() {
    let coordinates: [&[f64]; 5] = [&[0.1, f64::NAN, 1e9, 0.3], &[0.2, -0.2], &[0.5], &[0.1, f64::INFINITY], &[1.0]];
    let mut tables = vec![0.0; Grid::table_len(&coordinates)];
    let grid = Grid::new(coordinates, &mut tables);
    let mut deflections = vec![Vector6::zeros(); grid.len()];
    deflection(&Rv130hsc, grid, &WRENCH, &mut deflections);
    for (k, deflection) in deflections.iter().enumerate() {
        let q = grid.pose(k);
        let single = Rv130hsc.deflection(&q, &WRENCH);
        assert_eq!(q.iter().all(|x| x.is_finite()), deflection.iter().all(|x| x.is_finite()));
        assert!(!single[0].is_finite() || (deflection - single).amax() <= 1e-13 * single.amax());
    }
}

#[test]
fn blocks_come_in_order_and_hold_all_entries() {
    let poses = poses::<5>(150);
    let mut triangles = vec![[0.0; 21]; 150];
    compliance_triangle(&Rv130hsc, &poses, &mut triangles);
    let mut next = 0;
    compliance_blocks(&Rv130hsc, &poses, |range, entries| {
        assert_eq!(range.start, next);
        next = range.end;
        for (lane, pose) in range.enumerate() {
            assert_eq!(core::array::from_fn(|k| entries[k][lane]), triangles[pose]);
        }
    });
    assert_eq!(next, 150);
}

#[test]
fn poses_out_of_the_domain_spoil_no_others() {
    let mut poses = poses::<5>(200);
    poses[70][2] = 1e9;
    poses[150][0] = f64::NAN;
    let columns = columns(&poses);
    let (mut by_pose, mut by_joint) = (vec![0.0; 200], vec![0.0; 200]);
    translational_trace(&Rv130hsc, &poses, &mut by_pose);
    translational_trace(&Rv130hsc, ByJoint::new(columns.each_ref().map(|joint| &joint[..])), &mut by_joint);
    for traces in [by_pose, by_joint] {
        for (k, (q, trace)) in poses.iter().zip(&traces).enumerate() {
            let single = Rv130hsc.compliance(q).fixed_view::<3, 3>(0, 0).trace();
            assert!(if k == 150 { trace.is_nan() } else { (trace - single).abs() < 1e-13 * single }, "pose {k}");
        }
    }
}

#[test]
fn by_entry_is_the_same() {
    let poses = poses::<5>(150);
    let mut triangles = vec![[0.0; 21]; 150];
    compliance_triangle(&Rv130hsc, &poses, &mut triangles);
    let mut entries = vec![0.0; 21 * 150];
    let mut slices = entries.chunks_exact_mut(150);
    compliance_by_entry(&Rv130hsc, &poses, core::array::from_fn(|_| slices.next().unwrap()));
    for (k, entries) in entries.chunks_exact(150).enumerate() {
        assert!(entries.iter().zip(&triangles).all(|(entry, triangle)| *entry == triangle[k]));
    }
}

#[test]
fn by_entry_is_the_same_on_every_level() {
    fn check<T: Float + core::fmt::Debug>(level: Level, count: usize, of: impl Fn(f64) -> T) {
        let poses: Vec<SVector<T, 5>> = poses::<5>(count).iter().map(|q| q.map(&of)).collect();
        let quantity = || Triangle { robot: &Rv130hsc };
        let mut triangles = vec![[of(f64::NAN); 21]; count];
        run_at(level, quantity(), &poses[..], EachPose(&mut triangles));
        let mut entries = vec![of(f64::NAN); 21 * count];
        let mut slices = entries.chunks_exact_mut(count);
        run_at(level, quantity(), &poses[..], ByNumber::<_, 21>(core::array::from_fn(|_| slices.next().unwrap())));
        for (k, entries) in entries.chunks_exact(count).enumerate() {
            for (pose, (entry, triangle)) in entries.iter().zip(&triangles).enumerate() {
                assert_eq!(*entry, triangle[k], "{level:?}, pose {pose} of {count}, entry {k}");
            }
        }
    }
    for level in Level::available() {
        // A block that is not full, full ones, and full ones with a rest.
        for count in [7, 64, 128, 150] {
            check(level, count, |x| x);
            check(level, count, |x| x as f32);
        }
    }
}

/// Every level, against double precision: 2e-6 of the largest entry.
#[test]
fn single_precision_comes_in_batches_too() {
    let poses: Vec<SVector<f32, 5>> = poses::<5>(100).iter().map(|q| q.map(|x| x as f32)).collect();
    let wrench = WRENCH.map(|x| x as f32);
    for level in Level::available() {
        let (mut compliances, mut traces) = (vec![Matrix6::zeros(); 100], vec![0.0; 100]);
        run_at(level, Triangle { robot: &Rv130hsc }, &poses[..], EachPose(&mut compliances));
        run_at(level, Trace { robot: &Rv130hsc }, &poses[..], EachPose(&mut traces));
        let mut deflections = vec![Vector6::zeros(); 100];
        run_at(level, Deflection { robot: &Rv130hsc, wrench }, &poses[..], EachPose(&mut deflections));
        for (k, q) in poses.iter().enumerate() {
            let q = q.map(f64::from);
            let single: Matrix6<f64> = Rv130hsc.compliance(&q);
            assert!((compliances[k].map(f64::from) - single).amax() < 2e-6 * single.amax(), "{level:?}");
            let trace = single.fixed_view::<3, 3>(0, 0).trace();
            assert!((f64::from(traces[k]) - trace).abs() < 2e-6 * trace, "{level:?}");
            let single = Rv130hsc.deflection(&q, &WRENCH);
            assert!((deflections[k].map(f64::from) - single).amax() < 4e-6 * single.amax(), "{level:?}");
        }
    }
}

#[test]
#[should_panic(expected = "as many results as poses")]
fn too_few_results_are_refused() {
    translational_trace(&Rv130hsc, &poses::<5>(3), &mut [0.0; 2]);
}

#[test]
#[should_panic(expected = "as many wrenches as poses")]
fn too_few_wrenches_are_refused() {
    deflections(&Rv130hsc, &poses::<5>(3), &[WRENCH; 2], &mut [Vector6::zeros(); 3]);
}

#[cfg(feature = "rayon")]
#[test]
fn all_cores_give_what_one_gives() {
    let poses = poses::<5>(5000);
    let (mut one, mut all) = (vec![Vector6::zeros(); 5000], vec![Vector6::zeros(); 5000]);
    deflection(&Rv130hsc, &poses, &WRENCH, &mut one);
    parallel::deflection(&Rv130hsc, &poses, &WRENCH, &mut all);
    assert_eq!(one, all);
    let (mut one, mut all) = (vec![Matrix6::zeros(); 5000], vec![Matrix6::zeros(); 5000]);
    compliance(&Rv130hsc, &poses, &mut one);
    parallel::compliance(&Rv130hsc, &poses, &mut all);
    assert_eq!(one, all);
    let wrenches: Vec<_> = (0..5000).map(own_wrench).collect();
    let (mut one, mut all) = (vec![Vector6::zeros(); 5000], vec![Vector6::zeros(); 5000]);
    deflections(&Rv130hsc, &poses, &wrenches, &mut one);
    parallel::deflections(&Rv130hsc, &poses, &wrenches, &mut all);
    assert_eq!(one, all);
}

#[cfg(feature = "rayon")]
#[test]
fn all_cores_give_entries_what_one_gives() {
    let poses = poses::<5>(5000);
    let mut one = vec![vec![0.0; 5000]; 21];
    let mut all = one.clone();
    fn slices(entries: &mut [Vec<f64>]) -> [&mut [f64]; 21] {
        let mut entries = entries.iter_mut();
        core::array::from_fn(|_| &mut entries.next().expect("21 of them")[..])
    }
    compliance_by_entry(&Rv130hsc, &poses, slices(&mut one));
    parallel::compliance_by_entry(&Rv130hsc, &poses, slices(&mut all));
    assert_eq!(one, all);
    let seen = std::sync::Mutex::new(vec![f64::NAN; 5000]);
    parallel::compliance_blocks(&Rv130hsc, &poses, |range, entries| {
        let last = &entries[20][..range.len()];
        seen.lock().unwrap()[range].copy_from_slice(last);
    });
    assert_eq!(seen.into_inner().unwrap(), one[20]);
}

#[cfg(feature = "rayon")]
#[test]
#[should_panic(expected = "as many results as poses")]
fn too_few_entries_are_refused_on_all_cores() {
    let mut entries = [[0.0; 3]; 21];
    let mut slices = entries.each_mut().map(|entry| &mut entry[..]);
    slices[20] = &mut [];
    parallel::compliance_by_entry(&Rv130hsc, &poses::<5>(3), slices);
}

#[cfg(feature = "rayon")]
#[test]
fn all_cores_give_a_grid_what_one_gives() {
    let coordinates = coordinates([70, 9, 4, 1, 2]);
    let coordinates = coordinates.each_ref().map(|axis| &axis[..]);
    let mut tables = vec![0.0; Grid::table_len(&coordinates)];
    let grid = Grid::new(coordinates, &mut tables);
    let (mut one, mut all) = (vec![0.0; grid.len()], vec![0.0; grid.len()]);
    translational_trace(&Rv130hsc, grid, &mut one);
    parallel::translational_trace(&Rv130hsc, grid, &mut all);
    // The pieces of a row have other vectors: the same but for rounding.
    assert!(one.iter().zip(&all).all(|(one, all)| (one - all).abs() <= 1e-13 * one));
}
