//! Batches of poses on generated code, in whatever vectors this machine has,
//! against the robots that are read at run time, pose by pose.

use nalgebra::{Matrix6, SVector, Vector3, Vector6};
use robstiff::{Generic, Robot, batch};
use robstiff_tests::arms::description;
use robstiff_tests::for_every_arm;
use robstiff_tests::judge::{DOUBLE, Sizes, assert_close, blocks, trials};

/// Blocks of poses, and a rest that fills none.
const POSES: usize = 203;

for_every_arm!(agrees);

fn agrees<const N: usize, R: Robot<N>>(robot: R, file: &str) {
    let description = description(file);
    let generic = Generic::<N>::new(&description).expect("as many joints as the generated robot");
    let poses: Vec<SVector<f64, N>> = trials::<N>(POSES, 7).map(|(q, _)| q).collect();
    let direction = Vector3::new(0.6, 0.0, -0.8);
    // So small that the nonlinear joints are on both sides of their knees.
    let wrench = Vector6::new(30.0, -20.0, 10.0, 4.0, 5.0, -6.0);

    let mut compliances = vec![Matrix6::zeros(); POSES];
    batch::compliance(&robot, &poses, &mut compliances);
    let (mut traces, mut along) = (vec![0.0; POSES], vec![0.0; POSES]);
    batch::translational_trace(&robot, &poses, &mut traces);
    batch::directional_compliance(&robot, &poses, &direction, &mut along);
    let mut deflections = vec![Vector6::zeros(); POSES];
    batch::deflection(&robot, &poses, &wrench, &mut deflections);

    for (k, q) in poses.iter().enumerate() {
        let sizes = Sizes::of(&description, q.as_slice());
        let expected: Matrix6<f64> = generic.compliance(q);
        for (block, (found, expected)) in blocks(&compliances[k]).iter().zip(&blocks(&expected)).enumerate() {
            assert_close("compliance", found, expected, sizes.compliance()[block], DOUBLE);
        }
        let translational = expected.fixed_view::<3, 3>(0, 0);
        let size = sizes.compliance()[0];
        assert_close("trace", &[traces[k]], &[translational.trace()], size, DOUBLE);
        let directional = direction.dot(&(translational * direction));
        assert_close("directional compliance", &[along[k]], &[directional], size, DOUBLE);
        let expected = generic.deflection(q, &wrench);
        let torque = sizes.torque(&wrench);
        for (part, size) in [(0..3, sizes.softest * sizes.reach * torque), (3..6, sizes.softest * torque)] {
            let (found, expected) = (&deflections[k].as_slice()[part.clone()], &expected.as_slice()[part]);
            assert_close("deflection", found, expected, size, DOUBLE);
        }
    }
}
