//! Poses that have two ids, where each row, or each time that the arm came back, got one of
//! its own. Rows of one pose are one witness of what the arm does there, whatever they are
//! called: poses are drawn, left out and held out as a whole.

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

/// For each pose the first one that is alike.
fn first_alike(poses: &[&[f64]]) -> Vec<usize> {
    // Only poses that are near each other along some direction are compared.
    let weight = |joint: usize| ((joint + 1) as f64).sqrt();
    let along = |q: &[f64]| q.iter().enumerate().map(|(joint, q)| weight(joint) * q).sum::<f64>();
    let mut sorted: Vec<(f64, usize)> = poses.iter().enumerate().map(|(pose, q)| (along(q), pose)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let near = SAME_POSE * (0..poses.first().map_or(0, |q| q.len())).map(weight).sum::<f64>();
    let alike = |a: usize, b: usize| poses[a].iter().zip(poses[b]).all(|(a, b)| (a - b).abs() <= SAME_POSE);
    let mut first: Vec<usize> = (0..poses.len()).collect();
    for (place, &(at, pose)) in sorted.iter().enumerate() {
        let before = sorted[..place].iter().rev().take_while(|(other, _)| at - other <= near);
        for &(_, other) in before.filter(|(_, other)| alike(pose, *other)) {
            let (a, b) = (root(&first, pose), root(&first, other));
            first[a.max(b)] = a.min(b);
        }
    }
    (0..poses.len()).map(|pose| root(&first, pose)).collect()
}

fn root(first: &[usize], mut pose: usize) -> usize {
    while first[pose] != pose {
        pose = first[pose];
    }
    pose
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

    #[test]
    fn others_stay_as_they_are() {
        // As far along the direction that is looked along, but elsewhere.
        let (names, poses, said) = united(&[("a", [core::f64::consts::SQRT_2, 0.0]), ("b", [0.0, 1.0])]);
        assert_eq!((names.len(), poses, said), (2, std::vec![0, 1], None));
        assert_eq!(united(&[]), (Vec::new(), Vec::new(), None));
    }
}
