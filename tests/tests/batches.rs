//! Batches of poses on generated code, in whatever vectors this machine has,
//! against the robots that are read at run time, pose by pose.

use nalgebra::{Matrix6, SVector, Vector3, Vector6};
use robstiff::batch::{self, Grid};
use robstiff::{Generic, JointKind, Robot};
use robstiff_tests::arms::{EveryLaw, ModifiedSlider, Rv130hsc, Snake, description};
use robstiff_tests::judge::{DOUBLE, Sizes, assert_close, blocks, trials};

/// Blocks of poses, and a rest that fills none.
const POSES: usize = 203;

/// An arm of each kind of code: a waist that is turned last, gears with laws, sliding
/// joints in the modified convention, and nothing at right angles. What is one arm's
/// own is judged on every arm without batches; each arm here is compiled for every
/// set of instructions, which takes rustc the longest of all tests.
macro_rules! for_arms_of_every_kind {
    ($check:ident: $($module:ident $arm:ident $file:literal),*) => {
        mod $check {
            $(
                #[test]
                fn $module() {
                    super::$check(super::$arm, $file);
                }
            )*
        }
    };
}

for_arms_of_every_kind! {
    agrees:
    every_law EveryLaw "every-law.yaml",
    modified_slider ModifiedSlider "modified-slider.yaml",
    rv130hsc Rv130hsc "rv130hsc.yaml",
    snake Snake "snake.yaml"
}

/// The compliance, and the deflection under one wrench.
fn agrees<const N: usize, R: Robot<N>>(robot: R, file: &str) {
    let description = description(file);
    let generic = Generic::<N>::new(&description).expect("as many joints as the generated robot");
    let mut poses: Vec<SVector<f64, N>> = trials::<N>(POSES, 7).map(|(q, _)| q).collect();
    let at = poses.clone();
    // A block of many turns within the domain of the sines for vectors, and one beyond.
    for (k, further) in [(70, 1e5), (71, -3e4), (135, 1e9), (140, 1e17)] {
        for i in (0..N).filter(|i| description.joints[*i].kind == JointKind::Revolute) {
            poses[k][i] *= further;
        }
    }
    // So small that the nonlinear joints are on both sides of their knees.
    let wrench = Vector6::new(30.0, -20.0, 10.0, 4.0, 5.0, -6.0);

    let mut compliances = vec![Matrix6::zeros(); POSES];
    batch::compliance(&robot, &poses, &mut compliances);
    let mut deflections = vec![Vector6::zeros(); POSES];
    batch::deflection(&robot, &poses, &wrench, &mut deflections);

    for (k, q) in poses.iter().enumerate() {
        let sizes = Sizes::of(&description, at[k].as_slice());
        let expected: Matrix6<f64> = generic.compliance(q);
        for (block, (found, expected)) in blocks(&compliances[k]).iter().zip(&blocks(&expected)).enumerate() {
            assert_close("compliance", found, expected, sizes.compliance()[block], DOUBLE);
        }
        assert_deflection(&generic, &sizes, q, &wrench, &deflections[k]);
    }
}

/// What is made of entries of the compliance. (Of the RV130HSC, robstiff's own tests compare
/// it on every set of instructions.)
#[test]
fn parts_of_the_compliance_agree() {
    parts_agree(ModifiedSlider, "modified-slider.yaml");
    parts_agree(Snake, "snake.yaml");
}

fn parts_agree<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    let generic = Generic::<N>::new(&description).expect("as many joints as the generated robot");
    let poses: Vec<SVector<f64, N>> = trials::<N>(POSES, 7).map(|(q, _)| q).collect();
    let direction = Vector3::new(0.6, 0.0, -0.8);
    let (mut traces, mut along) = (vec![0.0; POSES], vec![0.0; POSES]);
    batch::translational_trace(&robot, &poses, &mut traces);
    batch::directional_compliance(&robot, &poses, &direction, &mut along);
    for (k, q) in poses.iter().enumerate() {
        let size = Sizes::of(&description, q.as_slice()).compliance()[0];
        let expected: Matrix6<f64> = generic.compliance(q);
        let translational = expected.fixed_view::<3, 3>(0, 0);
        assert_close("trace", &[traces[k]], &[translational.trace()], size, DOUBLE);
        let directional = direction.dot(&(translational * direction));
        assert_close("directional compliance", &[along[k]], &[directional], size, DOUBLE);
    }
}

fn assert_deflection<const N: usize>(
    generic: &Generic<N>,
    sizes: &Sizes,
    q: &SVector<f64, N>,
    wrench: &Vector6<f64>,
    found: &Vector6<f64>,
) {
    let expected = generic.deflection(q, wrench);
    let torque = sizes.torque(wrench);
    for (part, size) in [(0..3, sizes.softest * sizes.reach * torque), (3..6, sizes.softest * torque)] {
        let (found, expected) = (&found.as_slice()[part.clone()], &expected.as_slice()[part]);
        assert_close("deflection", found, expected, size, DOUBLE);
    }
}

/// Grids: the compliance, and the deflection under a wrench a pose.
#[test]
fn grids_agree() {
    grid_agrees(ModifiedSlider, "modified-slider.yaml");
    grid_agrees(Snake, "snake.yaml");
}

fn grid_agrees<const N: usize>(robot: impl Robot<N>, file: &str) {
    let description = description(file);
    let generic = Generic::<N>::new(&description).expect("as many joints as the generated robot");
    let some: Vec<SVector<f64, N>> = trials::<N>(POSES, 7).map(|(q, _)| q).collect();
    // Rows longer than a vector, but no multiple; the first joint fixed.
    for lengths in [[37, 3, 2], [1, 3, 37]] {
        let axes: [Vec<f64>; N] = std::array::from_fn(|joint| {
            some.iter().map(|q| q[joint]).take(lengths.get(joint).copied().unwrap_or(1)).collect()
        });
        let coordinates = axes.each_ref().map(|axis| &axis[..]);
        let mut tables = vec![0.0; Grid::table_len(&coordinates)];
        let grid = Grid::new(coordinates, &mut tables);
        let count = grid.len();
        let wrenches: Vec<_> = (0..count)
            .map(|k| Vector6::new(30.0, -20.0, 10.0, 4.0, 5.0, -6.0) * (1.0 + k as f64 / count as f64))
            .collect();
        let (mut compliances, mut deflections) = (vec![Matrix6::zeros(); count], vec![Vector6::zeros(); count]);
        batch::compliance(&robot, grid, &mut compliances);
        batch::deflections(&robot, grid, &wrenches, &mut deflections);
        for k in 0..count {
            let q = grid.pose(k);
            let sizes = Sizes::of(&description, q.as_slice());
            let expected: Matrix6<f64> = generic.compliance(&q);
            for (block, (found, expected)) in blocks(&compliances[k]).iter().zip(&blocks(&expected)).enumerate() {
                assert_close("compliance", found, expected, sizes.compliance()[block], DOUBLE);
            }
            assert_deflection(&generic, &sizes, &q, &wrenches[k], &deflections[k]);
        }
    }
}
