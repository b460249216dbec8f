//! Joint coordinates of many turns, infinite ones and none: generated code, vectors, derivatives
//! and batches say what the robot read at run time says. With the feature `platform-trig`, too.

use std::vec::Vec;

use nalgebra::Vector6;

use super::*;
use crate::batch::{self, Float, Grid};
use crate::{Dual, Lanes};

crate::robot!("rv130hsc.yaml");

const WRENCH: [f64; 6] = [300.0, -500.0, 700.0, 40.0, -60.0, 80.0];

/// Poses with coordinates of up to this size, alike in size and not.
fn poses(largest: f64) -> Vec<SVector<f64, 5>> {
    let sizes = [33.0, 1e3, 4e3, 1e6, 1e8, 1e16, 1e30, 1e100, 1e300];
    let sizes = sizes.into_iter().filter(|size| *size <= largest);
    let digits = [1.237, -2.913, 0.771, -1.618, 2.239];
    let pose = |size: f64, k: usize| {
        SVector::from_fn(|i, _| match k {
            0 => digits[i] * size,
            1 => digits[i] * if i == 2 { -size } else { size.sqrt() },
            _ => digits[i] * if i == k { size } else { 1.0 },
        })
    };
    sizes.flat_map(|size| (0..5).map(move |k| pose(size, k))).collect()
}

fn generic() -> Generic<5> {
    let text = robstiff_robots::catalogue::find("rv130hsc").unwrap();
    Generic::new(&Description::parse("rv130hsc.yaml", text).unwrap()).unwrap()
}

/// What a robot calculates at a pose, with the scale that each part of it is judged by.
fn all<T: Real>(robot: &impl Robot<5>, q: &SVector<T, 5>) -> [(Vec<T>, f64); 6] {
    let wrench = Vector6::from(WRENCH.map(T::of));
    [
        (robot.transform(q).as_slice().to_vec(), 3.0),
        (robot.link_frames(q).iter().flat_map(|frame| frame.as_slice().to_vec()).collect(), 3.0),
        (robot.jacobian(q).as_slice().to_vec(), 3.0),
        (robot.compliance(q).as_slice().to_vec(), 1e-5),
        (robot.deflection(q, &wrench).as_slice().to_vec(), 1e-2),
        (robot.joint_torques(q, &wrench).as_slice().to_vec(), 3e3),
    ]
}

fn assert_close<T: Float + Into<f64>>(q: &SVector<T, 5>, found: &[T], expected: &[f64], most: f64) {
    for (found, expected) in found.iter().zip(expected) {
        let off = ((*found).into() - expected).abs();
        assert!(off <= most, "{q:?}: {found:?} and not {expected:e}, off by {off:e}");
    }
}

/// `f32` is held against the robot in `f64` at the same numbers.
fn agrees<T: Float + Into<f64>>(largest: f64, rounding: f64) {
    let generic = generic();
    let poses: Vec<SVector<T, 5>> = poses(largest).iter().map(|q| q.map(T::of)).collect();
    let mut compliances = std::vec![Matrix6::zeros(); poses.len()];
    batch::compliance(&Rv130hsc, &poses, &mut compliances);
    for (q, of_batch) in poses.iter().zip(&compliances) {
        let expected = all(&generic, &q.map(Into::into));
        let of_lanes = all::<Lanes<T, 3>>(&Rv130hsc, &q.map(Lanes::splat));
        let of_slopes = all::<Dual<T, 5>>(&Rv130hsc, &Dual::variables(*q));
        let singly = all(&Rv130hsc, q).into_iter().zip(all(&generic, q));
        for ((((generated, generic), (expected, scale)), (lanes, _)), (slopes, _)) in
            singly.zip(expected).zip(of_lanes).zip(of_slopes)
        {
            let most = rounding * scale;
            assert_close(q, &generated.0, &expected, most);
            assert_close(q, &generic.0, &expected, most);
            assert_close(q, &lanes.iter().map(|lanes| lanes[2]).collect::<Vec<_>>(), &expected, most);
            assert_close(q, &slopes.iter().map(|dual| dual.value).collect::<Vec<_>>(), &expected, most);
        }
        let compliance: Matrix6<f64> = generic.compliance(&q.map(Into::into));
        assert_close(q, of_batch.as_slice(), compliance.as_slice(), rounding * 1e-5);

        let coordinates: [[T; 1]; 5] = core::array::from_fn(|joint| [q[joint]]);
        let mut tables = [T::of(0.0); 10];
        let mut of_grid = [Matrix6::zeros()];
        let grid = Grid::new(coordinates.each_ref().map(|axis| &axis[..]), &mut tables);
        batch::compliance(&Rv130hsc, grid, &mut of_grid);
        assert_close(q, of_grid[0].as_slice(), compliance.as_slice(), rounding * 1e-5);
    }
}

#[test]
fn many_turns_are_answered_alike() {
    agrees::<f64>(1e300, 2e-15);
    agrees::<f32>(1e30, 2e-6);
}

/// Of a coordinate that is no number, all that depends on it is none, in both. The robot that
/// is read at run time multiplies zeros, too, which generated code leaves out.
#[test]
fn no_angle_has_no_answer() {
    let generic = generic();
    for none in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for joint in 0..5 {
            let mut q = SVector::from([0.3, -0.4, 0.5, 0.2, 1.2]);
            q[joint] = none;
            let results = all(&Rv130hsc, &q).into_iter().zip(all(&generic, &q));
            for (result, ((generated, scale), (generic, _))) in results.enumerate() {
                let depends = generated.iter().any(|entry| entry.is_nan());
                // Frames, compliance and deflection do on every joint of this arm.
                assert!(depends || [2, 5].contains(&result), "joint {joint}, result {result}: {generated:?}");
                for (generated, generic) in generated.iter().zip(&generic) {
                    let is_alike = generic.is_nan() || (generated - generic).abs() <= 2e-15 * scale;
                    assert!(is_alike, "joint {joint}: {generated}, {generic}");
                }
            }
        }
    }
}
