//! Whether a campaign is one. What is read from files was checked there, where each problem
//! has its line; a campaign that a program has made is checked by whatever takes it.

use std::string::String;
use std::vec::Vec;
use std::{format, vec};

use robstiff_robots::words::count;

use super::poses::{AtPose, SAME_POSE};
use super::{Campaign, ClampedRow, Data, Observation, PositionRow};

impl Campaign {
    /// Whether rows have as many joint coordinates as the robot, name poses, visits and axes
    /// that there are, hold numbers only, and are all where their pose is, those of a visit at
    /// one pose.
    ///
    /// # Errors
    /// The first row that does not, by its line, and what is wrong with it; no rows.
    pub fn check(&self) -> Result<(), String> {
        let joints = self.robot.joints.len();
        let (rows, wrong) = match &self.data {
            Data::Displacement(data) => {
                let names = [data.poses.len(), data.visits.len()];
                let rotations = data.rows.first().is_some_and(|row| row.rotation.is_some());
                let wrong = |row: &Observation| of_displacement(row, joints, names, rotations);
                let found = data.rows.iter().find_map(|row| Some((row.line, wrong(row)?)));
                (data.rows.len(), found.or_else(|| misplaced(&data.rows, |row| row.visit, names)))
            }
            Data::Position(data) => {
                let names = [data.poses.len(), data.visits.len()];
                let wrong = |row: &PositionRow| of_position(row, joints, names);
                let found = data.rows.iter().find_map(|row| Some((row.line, wrong(row)?)));
                (data.rows.len(), found.or_else(|| misplaced(&data.rows, |row| row.visit, names)))
            }
            Data::Clamped(rows) => (rows.len(), rows.iter().find_map(|row| Some((row.line, of_clamped(row, joints)?)))),
        };
        let poses = self.data.poses().len();
        let is_held_out = |pose: usize| self.held_out.contains(&pose);
        if let Some(pose) = self.held_out.iter().find(|pose| **pose >= poses) {
            return Err(format!("pose {pose}, counted from 0, is held out, and there are {poses}"));
        }
        if poses > 0 && (0..poses).all(is_held_out) {
            return Err(String::from("all poses are held out"));
        }
        match wrong {
            Some((line, wrong)) => Err(format!("the row of line {line} {wrong}")),
            None if rows == 0 => Err(String::from("there are no rows")),
            None => Ok(()),
        }
    }
}

fn of_displacement(row: &Observation, joints: usize, names: [usize; 2], rotations: bool) -> Option<String> {
    let readings = [&row.encoders, &row.motors].into_iter().flatten();
    of_coordinates(&row.q, joints)
        .or_else(|| readings.clone().find_map(|read| of_coordinates(read, joints)))
        .or_else(|| of_names([row.pose, row.visit], names))
        .or_else(|| {
            (row.rotation.is_some() != rotations).then(|| String::from("has a rotation, or none, unlike the first"))
        })
        .or_else(|| of_numbers(row.wrench.iter().chain(&row.displacement).chain(row.rotation.iter().flatten())))
        .or_else(|| of_numbers(row.time.iter().chain(&row.temperature)))
}

fn of_position(row: &PositionRow, joints: usize, names: [usize; 2]) -> Option<String> {
    of_coordinates(&row.q, joints)
        .or_else(|| of_names([row.pose, row.visit], names))
        .or_else(|| of_numbers(row.position.iter().chain([&row.payload]).chain(&row.time).chain(&row.temperature)))
}

fn of_clamped(row: &ClampedRow, joints: usize) -> Option<String> {
    if !(1..=joints).contains(&row.axis) {
        return Some(format!("loads axis {}, and the robot has {}", row.axis, count(joints, "joint")));
    }
    of_numbers([&row.torque, &row.deflection])
}

/// The first row that is not where its pose is, or not at the pose where its visit began, of
/// rows that name poses and visits that there are: by its line, and what is wrong with it.
fn misplaced<R: AtPose>(
    rows: &[R],
    visit: impl Fn(&R) -> usize,
    [poses, visits]: [usize; 2],
) -> Option<(usize, String)> {
    let (mut at, mut began): (Vec<Option<&R>>, Vec<Option<&R>>) = (vec![None; poses], vec![None; visits]);
    rows.iter().find_map(|row| {
        let pose = at[row.pose()].get_or_insert(row);
        let start = began[visit(row)].get_or_insert(row);
        let moved = row.q().iter().zip(pose.q()).any(|(here, there)| (here - there).abs() > SAME_POSE);
        let wrong = match (moved, start.pose() == row.pose()) {
            (true, _) => format!("has other joint coordinates than line {}, of the same pose", pose.line()),
            (_, false) => format!("is at another pose than line {}, of the same visit", start.line()),
            _ => return None,
        };
        Some((row.line(), wrong))
    })
}

fn of_coordinates(q: &[f64], joints: usize) -> Option<String> {
    if q.len() != joints {
        return Some(format!("has {} for {}", count(q.len(), "coordinate"), count(joints, "joint")));
    }
    of_numbers(q)
}

/// A row's pose and visit, and how many there are.
fn of_names(indices: [usize; 2], names: [usize; 2]) -> Option<String> {
    let mut named = ["pose", "visit"].into_iter().zip(indices).zip(names);
    named
        .find(|((_, index), names)| index >= names)
        .map(|((what, index), names)| format!("is of {what} {index}, counted from 0, and there are {names}"))
}

fn of_numbers<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> Option<String> {
    let strange = numbers.into_iter().find(|number| !number.is_finite())?;
    Some(format!("has {strange} for a number"))
}

#[cfg(test)]
mod tests {
    use super::super::made::Plan;
    use super::*;
    use crate::identify::{Error, identify};
    use crate::predict::predict;
    use crate::trace::{Options, trace};

    /// What is wrong with a campaign of which one row was changed.
    fn wrong(change: impl Fn(&mut Observation)) -> String {
        let mut campaign = Plan { poses: 4, ..Plan::new(1) }.run();
        assert_eq!(campaign.check(), Ok(()));
        let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements were planned") };
        change(&mut data.rows[2]);
        let wrong = campaign.check().expect_err("a row that was changed");
        // All that takes a campaign says so, and nothing panics.
        let told = Err(Error::Invalid(wrong.clone()));
        assert_eq!(identify(&campaign).map(|_| ()), told);
        assert_eq!(predict(&campaign.robot, &campaign).map(|_| ()), told);
        assert_eq!(trace(&campaign, &Options::default(), &|_| {}).map(|_| ()), told);
        wrong
    }

    #[test]
    fn a_row_that_is_none_is_named() {
        assert!(wrong(|row| row.q.truncate(4)).ends_with("has 4 coordinates for 5 joints"));
        assert!(wrong(|row| row.pose = 4).ends_with("is of pose 4, counted from 0, and there are 4"));
        assert!(wrong(|row| row.displacement[1] = f64::NAN).ends_with("has NaN for a number"));
        assert!(wrong(|row| row.encoders = Some(std::vec![0.0; 6])).ends_with("has 6 coordinates for 5 joints"));
        assert!(wrong(|row| row.rotation = Some([0.0; 3])).contains("unlike the first"));
        assert!(wrong(|row| row.q[0] += 0.1).contains("has other joint coordinates than line 2, of the same pose"));
        let mut campaign = Plan { poses: 4, ..Plan::new(1) }.run();
        campaign.data = Data::Clamped(vec![ClampedRow { line: 3, axis: 6, torque: 1.0, deflection: 1e-6 }]);
        let told = campaign.check().expect_err("an arm of five joints");
        assert_eq!(told, "the row of line 3 loads axis 6, and the robot has 5 joints");
        campaign.data = Data::Clamped(vec![]);
        assert_eq!(campaign.check(), Err(String::from("there are no rows")));
    }

    #[test]
    fn a_visit_is_at_one_pose() {
        let mut campaign = Plan { poses: 4, ..Plan::new(1) }.run();
        let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements were planned") };
        let last = data.rows.len() - 1;
        let line = data.rows[last].line;
        data.rows[last].visit = 0;
        let told = campaign.check().expect_err("a visit at two poses");
        assert_eq!(told, format!("the row of line {line} is at another pose than line 2, of the same visit"));
    }

    /// Whoever leaves rows out may leave all of a pose out.
    #[test]
    fn a_pose_without_rows_is_none() {
        let mut campaign = Plan { poses: 8, ..Plan::new(1) }.run();
        let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements were planned") };
        data.rows.retain(|row| row.pose != 3);
        assert_eq!(campaign.check(), Ok(()));
        assert!(identify(&campaign).is_ok());
        assert!(trace(&campaign, &Options { folds: 2, ..Options::default() }, &|_| {}).is_ok());
    }
}
