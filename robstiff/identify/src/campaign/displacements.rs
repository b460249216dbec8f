//! The rows of a campaign of kind `displacement`.

use std::format;
use std::string::String;
use std::vec::Vec;

use robstiff_robots::Description;
use robstiff_robots::quantity::Dimension;

use super::beyond::{DISPLACEMENT, FORCE, MOMENT, ROTATION, Usual, warn_of};
use super::gauges::Gauges;
use super::poses::{AtPose, Columns as PoseColumns, Poses, dimension_of};
use super::{Displacements, Frame, Observation, alone, order, reference, revisited, times, unread};
use robstiff::JointKind;
use robstiff_robots::table::{Numbers, Record, Table};

/// The columns of the table.
struct Columns {
    at: PoseColumns,
    /// Of every row.
    time: Option<Vec<Option<f64>>>,
    temperature: Option<Numbers>,
    force: [Numbers; 3],
    moment: [Option<Numbers>; 3],
    gauges: Gauges,
    rotation: Option<[Numbers; 3]>,
    encoders: Option<Vec<Numbers>>,
    motors: Option<Vec<Numbers>>,
}

impl AtPose for Observation {
    const UNDER_LOAD: &str = ", and what the motors' encoders read under load columns `m1`, `m2` and so on";

    fn line(&self) -> usize {
        self.line
    }

    fn pose(&self) -> usize {
        self.pose
    }

    fn set_pose(&mut self, pose: usize) {
        self.pose = pose;
    }

    fn q(&self) -> &[f64] {
        &self.q
    }
}

/// Reads the rows; `None` with the problems reported to the table.
pub fn read(
    table: &Table<'_>,
    robot: &Description,
    (wrench_frame, wrench_at): (Frame, [f64; 3]),
    ((measured_frame, measured_at), along): ((Frame, [f64; 3]), Option<[f64; 3]>),
) -> Option<Displacements> {
    let columns = columns(table, robot, along)?;
    table.refuse_unfilled(&columns.gauges.columns, &columns.gauges.names(table))?;
    let (mut poses, mut rows) = (Poses::default(), Vec::new());
    let mut complete = true;
    let order = order::of_reading(table, &columns.at, columns.time.as_deref());
    let observed = order.into_iter().map(|row| (&table.records[row], row));
    let observed: Vec<_> = observed.map(|(record, row)| (record, observation(table, &columns, row, record))).collect();
    let is_reference = |row: &Option<Observation>| row.as_ref().is_some_and(reference::is_reference);
    // Where there are no others they are asked about as what nobody read.
    let all = observed.iter().all(|(_, row)| is_reference(row));
    let (references, observed): (Vec<_>, Vec<_>) = observed.into_iter().partition(|(_, row)| !all && is_reference(row));
    if let Some(said) = reference::said(references.iter().map(|(record, _)| record.line)) {
        table.warn(&said);
    }
    for (record, row) in observed {
        let (pose, visit, named) = poses.named(table, &columns.at, record);
        let Some(row) = row.filter(|_| named) else {
            complete = false;
            continue;
        };
        let row = Observation { pose, visit, ..row };
        poses.enter(table, &columns.at, record, (&row, visit), &rows);
        rows.push(row);
    }
    columns.at.check_ranges(table, &robot.joints, &rows);
    check_sizes(table, &columns, &rows);
    check_read(table, &columns, &rows);
    for (name, columns, angles) in [
        ('j', &columns.encoders, (|row| row.encoders.as_deref()) as fn(&Observation) -> Option<&[f64]>),
        ('m', &columns.motors, |row| row.motors.as_deref()),
    ] {
        for (index, &column) in columns.iter().flatten().enumerate() {
            check_under_load(table, (name, index, robot.joints[index].kind), column, &rows, angles);
        }
    }
    let [mut poses, mut visits] = poses.names();
    if let Some(said) = revisited::unite(&mut poses, &mut rows) {
        table.warn(&said);
    }
    if complete {
        leave_out_copies(table, &mut rows, &mut visits);
    }
    let directions = columns.gauges.directions;
    let mut data =
        Displacements { wrench_frame, wrench_at, measured_frame, measured_at, directions, poses, visits, rows };
    data.count_from_the_beginning();
    complete.then_some(data)
}

/// Warns of loads and displacements that no robot comes to, and of a load that stands
/// alone.
fn check_sizes(table: &Table<'_>, columns: &Columns, rows: &[Observation]) {
    let largest = |of: fn(&Observation) -> Option<[f64; 3]>| {
        rows.iter().filter_map(of).flatten().map(f64::abs).fold(0.0, f64::max)
    };
    let displaced = largest(|row| Some(row.displacement));
    for (k, &column) in columns.gauges.columns.iter().enumerate() {
        let read = |row: &Observation| columns.gauges.of(row.displacement).nth(k).unwrap_or_default();
        DISPLACEMENT.warn_among(table, column, rows.iter().map(|row| (row.line, read(row))), displaced);
    }
    let turned = largest(|row| row.rotation);
    for k in 0..3 {
        let force = rows.iter().map(|row| (row.line, row.wrench[k]));
        FORCE.warn(table, columns.force[k], force);
        if let Some(column) = columns.moment[k] {
            MOMENT.warn(table, column, rows.iter().map(|row| (row.line, row.wrench[3 + k])));
        }
        if let Some(columns) = columns.rotation {
            let rotation = rows.iter().filter_map(|row| Some((row.line, row.rotation?[k])));
            ROTATION.warn_among(table, columns[k], rotation, turned);
        }
    }
    if let Some(said) = alone::largest_force(rows) {
        table.warn(&said);
    }
}

/// Warns of what looks as if nobody had read it.
fn check_read(table: &Table<'_>, columns: &Columns, rows: &[Observation]) {
    let moved = unread::still(rows, |row| Some(row.displacement));
    let turned = unread::still(rows, |row| row.rotation);
    // A single gauge that read nothing is asked about as no readings at all.
    let of_displacement =
        columns.gauges.columns.iter().copied().zip(moved).filter(|_| columns.gauges.columns.len() == 3);
    let of_rotation = columns.rotation.into_iter().flatten().zip(turned);
    for (column, _) in of_displacement.chain(of_rotation).filter(|(_, is_still)| *is_still) {
        let name = table.name_of(column);
        table.warn(&format!("{name} is 0 in every row: was it read? each says that nothing moves that way"));
    }
}

/// Leaves out rows that were copied, and asks about those that may have been.
fn leave_out_copies(table: &Table<'_>, rows: &mut Vec<Observation>, visits: &mut Vec<String>) {
    let copies = unread::copies(rows);
    let lines: Vec<usize> = copies.iter().map(|&row| rows[row].line).collect();
    let what = "all numbers are those of an earlier row";
    if !unread::are_copies(&copies, rows) {
        warn_of(table, what, lines.into_iter(), ": are these copies?");
    } else if warn_of(table, what, lines.into_iter(), ": copies, which are left out") {
        unread::take_away(&copies, rows, visits);
    }
}

/// No joint gives way by more than this under a load (rad or m).
const FARTHEST: f64 = 0.05;

/// Warns of angles under load that are not near those of the unloaded arm.
fn check_under_load(
    table: &Table<'_>,
    (letter, index, kind): (char, usize, JointKind),
    column: Numbers,
    rows: &[Observation],
    angles: fn(&Observation) -> Option<&[f64]>,
) {
    let far = |row: &&Observation| angles(row).is_some_and(|angles| (angles[index] - row.q[index]).abs() > FARTHEST);
    let ask = match table.has_unit(column) {
        true => String::from(": they are angles of the joint, on its output side, like q"),
        false => Usual::of_joint(kind).asked(table, column),
    };
    let joint = index + 1;
    let what = format!("{letter}{joint} is far from q{joint}");
    warn_of(table, &what, rows.iter().filter(far).map(|row| row.line), &ask);
}

fn columns(table: &Table<'_>, robot: &Description, along: Option<[f64; 3]>) -> Option<Columns> {
    let all = |names: [&str; 3], dimension| {
        let found = names.map(|name| table.require(name, dimension));
        Some([found[0]?, found[1]?, found[2]?])
    };
    // All of a kind, or none.
    let under_load = |letter: char| -> Result<Option<Vec<Numbers>>, ()> {
        let name = |i: usize| format!("{letter}{}", i + 1);
        if (0..robot.joints.len()).all(|i| table.position(&name(i)).is_none()) {
            return Ok(None);
        }
        let found: Vec<Option<Numbers>> =
            (0..robot.joints.len()).map(|i| table.require(&name(i), dimension_of(robot.joints[i].kind))).collect();
        found.into_iter().collect::<Option<Vec<_>>>().map(Some).ok_or(())
    };
    let at = PoseColumns::find(table, robot);
    let time = times::read(table);
    let temperature = table.numbers("temperature", Dimension::Temperature);
    let force = all(["Fx", "Fy", "Fz"], Dimension::Force);
    let moment = ["Mx", "My", "Mz"].map(|name| table.numbers(name, Dimension::Torque));
    let gauges = Gauges::find(table, along);
    let turns = ["rx", "ry", "rz"];
    let rotation = turns.iter().any(|name| table.position(name).is_some()).then(|| all(turns, Dimension::Angle));
    let (encoders, motors) = (under_load('j'), under_load('m'));
    // Every missing column is reported before any gives up.
    let rotation = match rotation {
        Some(found) => Some(found?),
        None => None,
    };
    Some(Columns {
        at: at?,
        time,
        temperature,
        force: force?,
        moment,
        gauges: gauges?,
        rotation,
        encoders: encoders.ok()?,
        motors: motors.ok()?,
    })
}

/// One row, whose pose and visit are not numbered yet; every number is checked before any
/// gives it up.
fn observation(table: &Table<'_>, columns: &Columns, row: usize, record: &Record) -> Option<Observation> {
    let optional = |column: Option<Numbers>| column.map(|column| table.number(record, column));
    let time = columns.time.as_ref().map(|times| times[row]);
    let temperature = optional(columns.temperature);
    let q = columns.at.coordinates(table, record);
    let force = table.all(record, columns.force);
    let moment = columns.moment.map(|column| column.map_or(Some(0.0), |column| table.number(record, column)));
    let displacement = columns.gauges.read(table, record);
    let rotation = columns.rotation.map(|rotation| table.all(record, rotation));
    let under_load = |columns: &Option<Vec<Numbers>>| {
        let read = |columns: &Vec<Numbers>| -> Vec<Option<f64>> {
            columns.iter().map(|&column| table.number(record, column)).collect()
        };
        columns.as_ref().map(|columns| read(columns).into_iter().collect::<Option<Vec<f64>>>())
    };
    let (encoders, motors) = (under_load(&columns.encoders), under_load(&columns.motors));
    if encoders == Some(None) || motors == Some(None) {
        return None;
    }
    if time == Some(None) || temperature == Some(None) || rotation == Some(None) {
        return None;
    }
    let (force, q) = (force?, q?);
    Some(Observation {
        line: record.line,
        pose: 0,
        visit: 0,
        time: time.flatten(),
        temperature: temperature.flatten(),
        q,
        wrench: [force[0], force[1], force[2], moment[0]?, moment[1]?, moment[2]?],
        displacement: displacement?,
        rotation: rotation.flatten(),
        encoders: encoders.flatten(),
        motors: motors.flatten(),
    })
}
