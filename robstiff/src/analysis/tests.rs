use nalgebra::Vector6;

use super::*;

fn diagonal(entries: [f64; 6]) -> Matrix6<f64> {
    Matrix6::from_diagonal(&Vector6::from(entries))
}

#[test]
fn rigid_robot_has_rank_zero() {
    let stiffness = Stiffness::of(&Matrix6::<f64>::zeros()).unwrap();
    assert_eq!(stiffness, Stiffness::Deficient { rank: 0, pseudo_inverse: Matrix6::zeros() });
    assert_eq!(translational_stiffness(&Matrix6::<f64>::zeros()), None);
    assert_eq!(directional_stiffness(&Matrix6::<f64>::zeros(), &Vector3::x_axis()), None);
}

#[test]
fn rank_does_not_depend_on_the_unit_of_length() {
    // Far enough apart that the translations alone would fill all digits.
    let full = [2e-7, 3e-7, 4e-7, 1e-6, 2e-6, 3e-6];
    let flat = [2e-7, 3e-7, 4e-7, 1e-6, 2e-6, 0.0];
    for (entries, rank) in [(full, 6), (flat, 5)] {
        for unit in [1e-9, 1.0, 1e9] {
            let [x, y, z, rx, ry, rz] = entries;
            let scaled = diagonal([x * unit * unit, y * unit * unit, z * unit * unit, rx, ry, rz]);
            assert_eq!(Stiffness::of(&scaled).unwrap().rank(), rank, "unit {unit:e}");
        }
    }
}

#[test]
fn no_infinity_and_no_nan_comes_out() {
    for bad in [f64::NAN, f64::INFINITY, 1e-310] {
        let compliance = diagonal([bad; 6]);
        assert_eq!(Stiffness::of(&compliance), None);
        assert_eq!(translational_stiffness(&compliance), None);
        assert_eq!(directional_stiffness(&compliance, &Vector3::x_axis()), None);
    }
    assert_eq!(principal_directions(&diagonal([f64::NAN; 6])), None);
}

#[test]
fn turning_only_and_sliding_only_robots_have_a_rank() {
    assert_eq!(Stiffness::of(&diagonal([0.0, 0.0, 0.0, 1e-6, 2e-6, 0.0])).unwrap().rank(), 2);
    assert_eq!(Stiffness::of(&diagonal([1e-8, 0.0, 1e-8, 0.0, 0.0, 0.0])).unwrap().rank(), 2);
}

#[test]
fn softest_direction_comes_first() {
    let principal = principal_directions(&diagonal([2e-7, 5e-7, 3e-7, 0.0, 0.0, 0.0])).unwrap();
    assert!((principal.compliances - Vector3::new(5e-7, 3e-7, 2e-7)).amax() < 1e-21);
    assert!((principal.directions.column(0)[1].abs() - 1.0).abs() < 1e-14);
    let stiff = directional_stiffness(&diagonal([2e-7, 5e-7, 3e-7, 0.0, 0.0, 0.0]), &Vector3::y_axis());
    assert!((stiff.unwrap() - 2e6).abs() < 1e-8);
}

#[cfg(feature = "generic")]
mod of_robots {
    use super::*;
    use crate::samples::{five_axis, linear_effects, odd, poses};
    use crate::{Generic, Robot};

    #[test]
    fn five_axes_have_rank_five() {
        let robot = Generic::<5>::new(&five_axis()).unwrap();
        for q in poses() {
            let compliance = robot.compliance(&q);
            let Some(Stiffness::Deficient { rank: 5, pseudo_inverse }) = Stiffness::of(&compliance) else {
                panic!("{q}");
            };
            let again = compliance * pseudo_inverse * compliance;
            assert!((again - compliance).amax() < 1e-9 * compliance.amax());
            let again = pseudo_inverse * compliance * pseudo_inverse;
            assert!((again - pseudo_inverse).amax() < 1e-9 * pseudo_inverse.amax());
            // The translations alone have an inverse.
            let product = translational_stiffness(&compliance).unwrap() * translational_compliance(&compliance);
            assert!((product - Matrix3::identity()).amax() < 1e-10);
            let narrow = robot.compliance(&q.map(|x| x as f32));
            assert_eq!(Stiffness::of(&narrow).unwrap().rank(), 5);
        }
    }

    #[test]
    fn six_axes_have_an_inverse() {
        let robot = Generic::<6>::new(&odd()).unwrap();
        for q in poses() {
            let compliance = robot.compliance(&q);
            let Some(Stiffness::Full(stiffness)) = Stiffness::of(&compliance) else { panic!("{q}") };
            assert!((stiffness * compliance - Matrix6::identity()).amax() < 1e-8);
        }
    }

    #[test]
    fn effects_yield_where_five_joints_do_not() {
        let mut description = five_axis();
        description.effects = linear_effects();
        let robot = Generic::<5>::new(&description).unwrap();
        for q in poses() {
            assert_eq!(Stiffness::of(&robot.compliance(&q)).unwrap().rank(), 6);
        }
    }

    #[test]
    fn principal_directions_rebuild_the_block() {
        let robot = Generic::<5>::new(&five_axis()).unwrap();
        for q in poses() {
            let compliance = robot.compliance(&q);
            let PrincipalDirections { compliances, directions } = principal_directions(&compliance).unwrap();
            let block = translational_compliance(&compliance);
            let rebuilt = directions * Matrix3::from_diagonal(&compliances) * directions.transpose();
            assert!((rebuilt - block).amax() < 1e-14 * block.amax());
            assert!(compliances[0] >= compliances[1] && compliances[1] >= compliances[2]);
            let softest = Unit::new_normalize(directions.column(0).into_owned());
            let along = directional_compliance(&compliance, &softest);
            assert!((along - compliances[0]).abs() < 1e-13 * along);
        }
    }
}

#[test]
fn principal_directions_are_told_in_one_way() {
    let turned = nalgebra::Rotation3::<f64>::from_euler_angles(0.3, -2.0, 1.1);
    let block: Matrix3<f64> =
        turned.matrix() * Matrix3::from_diagonal(&Vector3::new(0.0, 2e-7, 4e-7)) * turned.matrix().transpose();
    let found = PrincipalDirections::of(&block).unwrap();
    for column in found.directions.column_iter() {
        assert!(column[column.iamax()] > 0.0, "{column}");
    }
    let [softest, second, stiffest]: [Option<f64>; 3] = found.stiffnesses();
    assert!((softest.unwrap() * 4e-7 - 1.0).abs() < 1e-9 && (second.unwrap() * 2e-7 - 1.0).abs() < 1e-9);
    assert!(stiffest.is_none() && found.compliances[2] >= 0.0, "{found:?}");
}
