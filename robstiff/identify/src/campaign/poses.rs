//! The poses and visits that the rows of a table name, and their joint
//! coordinates.

use std::borrow::ToOwned;
use std::collections::HashMap;
use std::format;
use std::string::String;
use std::vec::Vec;

use robstiff_robots::quantity::Dimension;
use robstiff_robots::words::count;
use robstiff_robots::{Controller, Description, Joint};

use super::beyond::{Usual, warn_of};
use robstiff::JointKind;
use robstiff_robots::table::{Numbers, Record, Table};

/// Rows of one pose have the same joint coordinates within this (rad or m).
pub const SAME_POSE: f64 = 1e-6;

/// No joint is wound up further than this (rad); degrees that are read as
/// radians are.
const TWO_TURNS: f64 = 2.0 * core::f64::consts::TAU;

/// A row that is read at a pose.
pub trait AtPose {
    /// Where else joint coordinates go that differ between the rows of a pose, if anywhere.
    const UNDER_LOAD: &str = "";

    /// Its line in the file, from 1.
    fn line(&self) -> usize;

    /// The index of its pose.
    fn pose(&self) -> usize;

    /// Gives it to another.
    fn set_pose(&mut self, pose: usize);

    /// Its joint coordinates (rad or m).
    fn q(&self) -> &[f64];
}

/// The columns that say where a row is read.
pub struct Columns {
    pose: usize,
    visit: Option<usize>,
    /// Whether visits are numbered within each pose.
    within_pose: bool,
    q: Vec<Numbers>,
    /// How joint coordinates follow from these, where they are what the pendant shows.
    pendant: Option<Controller>,
}

/// Ids in order of appearance, each with the row that first named it.
#[derive(Default)]
struct Ids {
    names: Vec<String>,
    /// The index of each name.
    known: HashMap<String, usize>,
    /// `usize::MAX` where no row is complete.
    first: Vec<usize>,
}

/// The poses and visits named so far.
#[derive(Default)]
pub struct Poses {
    poses: Ids,
    visits: Ids,
}

impl Columns {
    /// Finds them; `None` with every missing one reported.
    pub fn find(table: &Table<'_>, robot: &Description) -> Option<Self> {
        let pose = table.require_name("pose");
        let visit = table.position("visit");
        let of_pendant = table.position("q1").is_none() && table.position("t1").is_some();
        let pendant = robot.controller.clone().filter(|_| of_pendant);
        if of_pendant && pendant.is_none() {
            table.report_header(
                "`t1` .. are what the pendant shows, and the robot's description does not say how joint coordinates follow from it",
                "call them `q1` .. if they are the joint coordinates, or add `controller:` to the description",
            );
            return None;
        }
        let letter = if of_pendant { 't' } else { 'q' };
        let coordinate =
            |(i, joint): (usize, &Joint)| table.require(&format!("{letter}{}", i + 1), dimension_of(joint.kind));
        // Collected twice so that every missing column is reported, not the first.
        let q: Vec<Option<Numbers>> = robot.joints.iter().enumerate().map(coordinate).collect();
        let q: Vec<Numbers> = q.into_iter().collect::<Option<_>>()?;
        // Another robot's loads can be fitted to this one, and what comes of it looks like a result.
        let beyond = format!("{letter}{}", q.len() + 1);
        if table.position(&beyond).is_some() {
            let joints = count(q.len(), "joint");
            table.warn(&format!(
                "the column `{beyond}` is not used, {} has {joints}: is the campaign's `robot:` the right one?",
                robot.name
            ));
        }
        let pose = pose?;
        let within_pose = visit.is_some_and(|visit| counts_within_poses(table, pose, visit));
        Some(Self { pose, visit, within_pose, q, pendant })
    }

    /// What names a row's visit, where there is a column of them: its id, behind that of its pose
    /// where visits are numbered within each.
    pub fn visit_of<'r>(&self, table: &Table<'_>, record: &'r Record) -> Option<[&'r str; 2]> {
        let visit = table.text(record, self.visit?);
        Some([if self.within_pose { table.text(record, self.pose) } else { "" }, visit])
    }

    /// The joint coordinates of a row; every number is checked before any gives it up.
    pub fn coordinates(&self, table: &Table<'_>, record: &Record) -> Option<Vec<f64>> {
        let read: Vec<Option<f64>> = self.q.iter().map(|&column| table.number(record, column)).collect();
        let read: Vec<f64> = read.into_iter().collect::<Option<_>>()?;
        Some(match &self.pendant {
            Some(pendant) => pendant.pendant_to_q(&read),
            None => read,
        })
    }

    /// Warns of coordinates that joints do not reach.
    pub fn check_ranges<R: AtPose>(&self, table: &Table<'_>, joints: &[Joint], rows: &[R]) {
        for (index, (joint, &column)) in joints.iter().zip(&self.q).enumerate() {
            check_range(table, joint, index, column, rows.iter().map(|row| (row.line(), row.q()[index])));
        }
    }
}

impl Ids {
    /// The index of an id, new ones at the end.
    fn index_of(&mut self, id: &str) -> usize {
        self.known.get(id).copied().unwrap_or_else(|| {
            let index = self.push(id.to_owned());
            self.known.insert(id.to_owned(), index);
            index
        })
    }

    /// The index of an id that no row comes back to.
    fn push(&mut self, id: String) -> usize {
        self.names.push(id);
        self.first.push(usize::MAX);
        self.names.len() - 1
    }
}

impl Poses {
    /// The pose and the visit that a row names, by index; without the column every
    /// row is a visit of its own. Whether they have names is the third.
    pub fn named(&mut self, table: &Table<'_>, columns: &Columns, record: &Record) -> (usize, usize, bool) {
        let pose = self.poses.index_of(table.id(record, columns.pose));
        let visit = match columns.visit {
            Some(column) => match table.id(record, column) {
                id if columns.within_pose && !id.is_empty() => {
                    self.visits.index_of(&format!("{id} of pose {}", table.text(record, columns.pose)))
                }
                id => self.visits.index_of(id),
            },
            None => self.visits.push(format!("line {}", record.line)),
        };
        (pose, visit, !self.poses.names[pose].is_empty() && !self.visits.names[visit].is_empty())
    }

    /// Takes note of a row, to come behind `rows`, and checks it against those of
    /// its pose and its visit.
    pub fn enter<R: AtPose>(
        &mut self,
        table: &Table<'_>,
        columns: &Columns,
        record: &Record,
        (row, visit): (&R, usize),
        rows: &[R],
    ) {
        let pose = row.pose();
        for (ids, index) in [(&mut self.poses, pose), (&mut self.visits, visit)] {
            ids.first[index] = ids.first[index].min(rows.len());
        }
        if let Some(first) = rows.get(self.poses.first[pose]) {
            check_pose(table, columns, record, row, first);
        }
        let started = rows.get(self.visits.first[visit]).map(R::pose);
        if let (Some(column), Some(started)) = (columns.visit, started.filter(|&started| started != pose)) {
            let (visit, names) = (&self.visits.names[visit], &self.poses.names);
            table.report(
                record.line,
                column,
                &format!("visit `{visit}` began at pose `{}`, this row is at pose `{}`", names[started], names[pose]),
                "a visit is one load sequence at one pose; give each its own id",
            );
        }
    }

    /// The ids of poses and of visits, in order of appearance.
    pub fn names(self) -> [Vec<String>; 2] {
        [self.poses.names, self.visits.names]
    }
}

/// Whether the visits of every pose are numbered from the same first number on. Ids that go through all
/// poses begin with another at each.
fn counts_within_poses(table: &Table<'_>, pose: usize, visit: usize) -> bool {
    let mut first = HashMap::new();
    for record in &table.records {
        first.entry(table.text(record, pose)).or_insert_with(|| table.text(record, visit));
    }
    let mut ids = first.values();
    let one = ids.next();
    first.len() > 1 && one.is_some_and(|id| id.parse::<u32>().is_ok()) && ids.all(|id| Some(id) == one)
}

/// The same pose id means the same joint coordinates.
fn check_pose<R: AtPose>(table: &Table<'_>, columns: &Columns, record: &Record, row: &R, first: &R) {
    for (i, (here, there)) in row.q().iter().zip(first.q()).enumerate() {
        if (here - there).abs() > SAME_POSE {
            let pose = table.text(record, columns.pose);
            table.report_number(
                record,
                columns.q[i],
                &format!("pose `{pose}` has another q{} in line {}", i + 1, first.line()),
                &format!(
                    "rows of one pose have the same joint coordinates; give another pose another id{}",
                    R::UNDER_LOAD
                ),
            );
        }
    }
}

/// Warns of coordinates, each with its line, that a joint (by its index) does not reach.
pub fn check_range(
    table: &Table<'_>,
    joint: &Joint,
    index: usize,
    column: Numbers,
    rows: impl Iterator<Item = (usize, f64)> + Clone,
) {
    let ask = Usual::of_joint(joint.kind).asked(table, column);
    let warn = |what: &str, is_outside: &dyn Fn(f64) -> bool| {
        let lines = rows.clone().filter(|(_, q)| is_outside(*q)).map(|(line, _)| line);
        warn_of(table, &format!("q{} is {what}", index + 1), lines, &ask)
    };
    let limited = joint.outside_limits().is_some_and(|what| warn(&what, &|q| !joint.reaches(q)));
    if !limited && !table.has_unit(column) && joint.kind == JointKind::Revolute {
        warn("more than two turns", &|q| q.abs() > TWO_TURNS);
    }
}

/// What a joint's coordinates are.
pub fn dimension_of(kind: JointKind) -> Dimension {
    if kind == JointKind::Revolute { Dimension::Angle } else { Dimension::Length }
}
