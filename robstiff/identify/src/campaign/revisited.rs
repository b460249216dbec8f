//! Poses that have two ids, where each row, or each time that the arm came back, got one of
//! its own. Rows of one pose are one witness of what the arm does there, whatever they are
//! called: poses are drawn, left out and held out as a whole.

use std::collections::BTreeMap;
use std::format;
use std::string::String;
use std::vec::Vec;

use super::poses::{AtPose, SAME_POSE};

/// Gives all rows with the same joint coordinates to the first of their poses, whose ids are
/// `names`; what is said of it, if there are any.
pub fn unite<R: AtPose>(names: &mut Vec<String>, rows: &mut [R]) -> Option<String> {
    let first = first_alike(&coordinates(names.len(), rows)?);
    let mut again = (0..names.len()).filter(|&pose| first[pose] != pose);
    let one = again.next()?;
    let more = match again.count() {
        0 => String::new(),
        more => format!(", and of {more} more those of another"),
    };
    let said = format!(
        "pose `{}` has the joint coordinates of pose `{}`{more}; rows with the same count as one pose",
        names[one], names[first[one]]
    );
    let (mut kept, mut place) = (Vec::new(), std::vec![0; names.len()]);
    for pose in (0..names.len()).filter(|&pose| first[pose] == pose) {
        place[pose] = kept.len();
        kept.push(core::mem::take(&mut names[pose]));
    }
    rows.iter_mut().for_each(|row| row.set_pose(place[first[row.pose()]]));
    *names = kept;
    Some(said)
}

/// The joint coordinates of each pose; `None` where one has no row that could be read.
fn coordinates<R: AtPose>(poses: usize, rows: &[R]) -> Option<Vec<&[f64]>> {
    let mut coordinates = std::vec![None; poses];
    for row in rows.iter().rev() {
        coordinates[row.pose()] = Some(row.q());
    }
    coordinates.into_iter().collect()
}

/// For each pose the first that it is alike, within [`SAME_POSE`] in each joint; itself, where it
/// is alike none.
fn first_alike(poses: &[&[f64]]) -> Vec<usize> {
    // In a cell of this size any two are alike, so that each has one first at most.
    let cell = |q: &[f64]| q.iter().map(|q| (q / SAME_POSE).floor() as i64).collect::<Vec<i64>>();
    let mut firsts: BTreeMap<Vec<i64>, usize> = BTreeMap::new();
    let pose_of = |(pose, q): (usize, &&[f64])| {
        let at = cell(q);
        let alike = |other: usize| q.iter().zip(poses[other]).all(|(a, b)| (a - b).abs() <= SAME_POSE);
        beside(&firsts, &mut Vec::new(), &at, &alike).unwrap_or_else(|| {
            firsts.insert(at, pose);
            pose
        })
    };
    poses.iter().enumerate().map(pose_of).collect()
}

/// The first of the poses in a cell or one beside it that is alike. Cells are looked for joint by
/// joint, for most have none beside them.
fn beside(
    firsts: &BTreeMap<Vec<i64>, usize>,
    begun: &mut Vec<i64>,
    cell: &[i64],
    alike: &impl Fn(usize) -> bool,
) -> Option<usize> {
    let Some(&here) = cell.get(begun.len()) else {
        return firsts.get(begun).copied().filter(|&pose| alike(pose));
    };
    let mut first: Option<usize> = None;
    for step in -1..=1 {
        begun.push(here.saturating_add(step));
        let is_any = firsts.range(begun.clone()..).next().is_some_and(|(cell, _)| cell.starts_with(begun));
        let found = if is_any { beside(firsts, begun, cell, alike) } else { None };
        first = first.into_iter().chain(found).min();
        begun.pop();
    }
    first
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::*;

    #[derive(Debug, PartialEq)]
    struct Row(usize, [f64; 2]);

    impl AtPose for Row {
        fn line(&self) -> usize {
            0
        }

        fn pose(&self) -> usize {
            self.0
        }

        fn set_pose(&mut self, pose: usize) {
            self.0 = pose;
        }

        fn q(&self) -> &[f64] {
            &self.1
        }
    }

    /// Names and the poses of rows afterwards, and what is said.
    fn united(of_rows: &[(&str, [f64; 2])]) -> (Vec<String>, Vec<usize>, Option<String>) {
        let mut names: Vec<String> = of_rows.iter().map(|(name, _)| name.to_string()).collect();
        let mut rows: Vec<Row> = of_rows.iter().enumerate().map(|(pose, (_, q))| Row(pose, *q)).collect();
        let said = unite(&mut names, &mut rows);
        (names, rows.iter().map(AtPose::pose).collect(), said)
    }

    #[test]
    fn poses_that_are_the_same_are_one() {
        let (names, poses, said) = united(&[
            ("a", [0.3, -1.0]),
            ("b", [0.3, 1.0]),
            ("c", [0.3, -1.0 + 5e-7]),
            ("d", [-0.2, 0.0]),
            ("e", [0.3, 1.0]),
        ]);
        assert_eq!((names.join(" ").as_str(), poses), ("a b d", std::vec![0, 1, 0, 2, 1]));
        let said = said.expect("two come again");
        assert_eq!(
            said,
            "pose `c` has the joint coordinates of pose `a`, and of 1 more those of another; rows with the same count \
             as one pose"
        );
    }

    /// As many rows as a file holds, each of a pose of its own where the arm always is, or all on a
    /// line: a reader that compares each with each does not come to the end of this.
    #[test]
    fn there_may_be_many() {
        let all = |q: &dyn Fn(usize) -> [f64; 2]| -> Vec<Row> { (0..300_000).map(|pose| Row(pose, q(pose))).collect() };
        for (q, left) in [
            (&(|_| [0.3, -1.0]) as &dyn Fn(usize) -> [f64; 2], 1),
            (&|pose| [1e-12 * pose as f64, 0.0], 1),
            (&|pose| [core::f64::consts::SQRT_2 * pose as f64 * 1e-3, -1e-3 * pose as f64], 300_000),
        ] {
            let mut rows = all(q);
            let mut names: Vec<String> = rows.iter().map(|row| row.0.to_string()).collect();
            unite(&mut names, &mut rows);
            assert_eq!(names.len(), left);
        }
    }

    #[test]
    fn others_stay_as_they_are() {
        // As far along the direction that is looked along, but elsewhere.
        let (names, poses, said) = united(&[("a", [core::f64::consts::SQRT_2, 0.0]), ("b", [0.0, 1.0])]);
        assert_eq!((names.len(), poses, said), (2, std::vec![0, 1], None));
        assert_eq!(united(&[]), (Vec::new(), Vec::new(), None));
    }
}
