//! A sample of the poses that `--bin reach` solves by the million.

use nalgebra::Vector3;
use robstiff::Robot;
use robstiff_tests::arms;
use robstiff_tests::reach::{Asked, reach};

#[track_caller]
fn none_is_missed<const N: usize, R: Robot<N>>(robot: &R, asked: Asked, count: usize) {
    let reached = reach(robot, asked, count, 7);
    assert_eq!((reached.tried, reached.missed), (count, 0), "{}", robot.name());
    assert!(reached.distance < 1e-9 && reached.angle < 1e-9, "{}: {reached:?}", robot.name());
}

#[test]
fn six_axes_miss_no_reachable_pose() {
    none_is_missed(&arms::AbbIrb6600, Asked::Pose, 3000);
    none_is_missed(&arms::AbbIrb6640, Asked::Pose, 3000);
    none_is_missed(&arms::FanucM900ib700, Asked::Pose, 3000);
    none_is_missed(&arms::FanucR2000ic, Asked::Pose, 3000);
    none_is_missed(&arms::KukaKr210L150, Asked::Pose, 3000);
    none_is_missed(&arms::KukaKr270R2700, Asked::Pose, 3000);
    none_is_missed(&arms::StaubliRx160, Asked::Pose, 3000);
}

#[test]
fn five_axes_miss_no_reachable_pose_nor_direction() {
    none_is_missed(&arms::Rv130hsc, Asked::Pose, 3000);
    none_is_missed(&arms::Rv130hsc, Asked::Axis(Vector3::x_axis()), 3000);
    none_is_missed(&arms::Rv130hsc, Asked::Axis(Vector3::z_axis()), 2000);
}

#[test]
fn arms_without_a_closed_form_are_solved() {
    none_is_missed(&arms::Scara, Asked::Pose, 300);
    none_is_missed(&arms::Snake, Asked::Pose, 300);
    none_is_missed(&arms::Pendulum, Asked::Pose, 300);
}
