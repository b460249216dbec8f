//! The first poses and loads.

use std::vec::Vec;

use nalgebra::DMatrix;
use robstiff_robots::samples::five_axis;

use super::first::{RAMP, first, most_informative};
use super::{Options, space::directions};

#[test]
fn each_visit_is_the_one_that_tells_most() {
    // Two numbers; three visits tell the first, ever better, one the second, a little.
    let shown = [[1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [0.0, 1.5]].map(|row| DMatrix::from_row_slice(1, 2, &row));
    assert_eq!(most_informative(&shown, 3, |one, other| one == other), [2, 3, 1]);
    // What is alike is taken once.
    assert_eq!(most_informative(&shown, 3, |one, other| one == other || one.max(other) < 3), [2, 3]);
}

#[test]
fn first_poses_are_within_the_limits_with_a_margin() {
    let mut robot = five_axis();
    robot.joints.iter_mut().for_each(|joint| joint.limits = Some([-1.0, 2.0]));
    let options = Options { poses: 6, margin: 0.2, ..Options::default() };
    let found = first(&robot, &options).expect("poses");
    assert_eq!(found.visits.len(), 6);
    for visit in &found.visits {
        assert!(visit.q.iter().all(|q| (-0.4..=1.4).contains(q)), "{:?}", visit.q);
        assert_eq!(visit.loads.len(), RAMP.len());
        let whole = visit.q.iter().map(|q| q.to_degrees());
        assert!(whole.clone().all(|q| (q - q.round()).abs() < 1e-9), "{:?}", visit.q);
    }
    // Of several directions, not one: forces along one line tell little.
    let pulls: Vec<_> = found.visits.iter().map(|visit| visit.loads[2]).collect();
    assert!(pulls.iter().filter(|pull| **pull != pulls[0]).count() > 1, "{pulls:?}");
    assert!(directions().len() > 3);
    assert_eq!(first(&robot, &options).expect("the same").visits, found.visits);
}
