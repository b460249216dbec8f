//! The rows of a campaign of kind `displacement`.

use std::borrow::ToOwned;
use std::format;
use std::string::String;
use std::vec::Vec;

use robstiff_robots::quantity::Dimension;
use robstiff_robots::{Description, Joint};

use super::{Displacements, Frame, Observation};
use crate::JointKind;
use crate::table::{Numbers, Record, Table};

/// Rows of one pose have the same joint coordinates within this (rad or m).
const SAME_POSE: f64 = 1e-6;

/// The columns of the table.
struct Columns {
    pose: usize,
    visit: Option<usize>,
    time: Option<Numbers>,
    temperature: Option<Numbers>,
    q: Vec<Numbers>,
    force: [Numbers; 3],
    moment: [Option<Numbers>; 3],
    displacement: [Numbers; 3],
    rotation: Option<[Numbers; 3]>,
    encoders: Option<Vec<Numbers>>,
    motors: Option<Vec<Numbers>>,
}

/// Reads the rows; `None` with the problems reported to the table.
pub fn read(
    table: &Table<'_>,
    robot: &Description,
    (wrench_frame, wrench_at): (Frame, [f64; 3]),
    (measured_frame, measured_at): (Frame, [f64; 3]),
) -> Option<Displacements> {
    let columns = columns(table, robot)?;
    let mut data = Displacements {
        wrench_frame,
        wrench_at,
        measured_frame,
        measured_at,
        poses: Vec::new(),
        visits: Vec::new(),
        rows: Vec::new(),
    };
    // The row that first named a pose or a visit, which later rows must match.
    let (mut of_pose, mut of_visit): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
    let mut complete = true;
    for record in &table.records {
        let pose = index_of(&mut data.poses, table.id(record, columns.pose));
        let visit = match columns.visit {
            Some(column) => index_of(&mut data.visits, table.id(record, column)),
            None => {
                data.visits.push(format!("line {}", record.line));
                data.visits.len() - 1
            }
        };
        let named = !data.poses[pose].is_empty() && !data.visits[visit].is_empty();
        let Some(row) = observation(table, &columns, record, pose, visit).filter(|_| named) else {
            complete = false;
            // Pose and visit stay without a row to compare with.
            of_pose.resize(data.poses.len(), usize::MAX);
            of_visit.resize(data.visits.len(), usize::MAX);
            continue;
        };
        first(&mut of_pose, pose, data.rows.len());
        first(&mut of_visit, visit, data.rows.len());
        check_pose(table, &columns, record, &row, data.rows.get(of_pose[pose]));
        let started = data.rows.get(of_visit[visit]).map(|row: &Observation| row.pose);
        if let (Some(column), Some(started)) = (columns.visit, started)
            && started != pose
        {
            let (visit, started, pose) = (&data.visits[visit], &data.poses[started], &data.poses[pose]);
            table.report(
                record.line,
                column,
                &format!("visit `{visit}` began at pose `{started}`, this row is at pose `{pose}`"),
                "a visit is one load sequence at one pose; give each its own id",
            );
        }
        data.rows.push(row);
    }
    for (index, (joint, &column)) in robot.joints.iter().zip(&columns.q).enumerate() {
        check_range(table, joint, index, column, &data.rows);
    }
    for (name, columns, angles) in [
        ('j', &columns.encoders, (|row| row.encoders.as_deref()) as fn(&Observation) -> Option<&[f64]>),
        ('m', &columns.motors, |row| row.motors.as_deref()),
    ] {
        for (index, &column) in columns.iter().flatten().enumerate() {
            check_under_load(table, (name, index, robot.joints[index].kind), column, &data.rows, angles);
        }
    }
    complete.then_some(data)
}

/// No joint is wound up further than this (rad); degrees that are read as
/// radians are.
const TWO_TURNS: f64 = 2.0 * core::f64::consts::TAU;

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
    let mut outside = rows.iter().filter(far);
    let Some(first) = outside.next() else { return };
    let (count, line, joint) = (1 + outside.count(), first.line, index + 1);
    let rows = if count == 1 { "row" } else { "rows" };
    let ask = match kind {
        _ if table.has_unit(column) => String::from("they are angles of the joint, on its output side, like q"),
        JointKind::Revolute => format!("are the angles in degrees? write `{letter}{joint} [deg]`"),
        JointKind::Prismatic => format!("are the lengths in millimetres? write `{letter}{joint} [mm]`"),
    };
    table.warn(&format!("{letter}{joint} is far from q{joint} in {count} {rows}, first on line {line}: {ask}"));
}

/// Warns of coordinates that a joint (by its index) does not reach.
fn check_range(table: &Table<'_>, joint: &Joint, index: usize, column: Numbers, rows: &[Observation]) {
    let unit_is_given = table.has_unit(column);
    let warn = |what: &str, is_outside: &dyn Fn(f64) -> bool| {
        let mut outside = rows.iter().filter(|row| is_outside(row.q[index]));
        let Some(first) = outside.next() else { return false };
        let (count, line, q) = (1 + outside.count(), first.line, index + 1);
        let rows = if count == 1 { "row" } else { "rows" };
        let ask = match joint.kind {
            _ if unit_is_given => String::new(),
            JointKind::Revolute => format!(": are the angles in degrees? write `q{q} [deg]`"),
            JointKind::Prismatic => format!(": are the lengths in millimetres? write `q{q} [mm]`"),
        };
        table.warn(&format!("q{q} is {what} in {count} {rows}, first on line {line}{ask}"));
        true
    };
    let limited = joint.outside_limits().is_some_and(|what| warn(&what, &|q| !joint.reaches(q)));
    if !limited && !unit_is_given && joint.kind == JointKind::Revolute {
        warn("more than two turns", &|q| q.abs() > TWO_TURNS);
    }
}

fn dimension_of(kind: JointKind) -> Dimension {
    if kind == JointKind::Revolute { Dimension::Angle } else { Dimension::Length }
}

fn columns(table: &Table<'_>, robot: &Description) -> Option<Columns> {
    let coordinate = |(i, kind): (usize, JointKind)| table.require(&format!("q{}", i + 1), dimension_of(kind));
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
    let pose = table.require_name("pose");
    let visit = table.position("visit");
    let time = table.numbers("time", Dimension::Time);
    let temperature = table.numbers("temperature", Dimension::Temperature);
    // Collected twice so that every missing column is reported, not the first.
    let q: Vec<Option<Numbers>> = robot.joints.iter().map(|joint| joint.kind).enumerate().map(coordinate).collect();
    let force = all(["Fx", "Fy", "Fz"], Dimension::Force);
    let moment = ["Mx", "My", "Mz"].map(|name| table.numbers(name, Dimension::Torque));
    let displacement = all(["dx", "dy", "dz"], Dimension::Length);
    let turns = ["rx", "ry", "rz"];
    let rotation = match turns.iter().any(|name| table.position(name).is_some()) {
        true => Some(all(turns, Dimension::Angle)?),
        false => None,
    };
    let (encoders, motors) = (under_load('j'), under_load('m'));
    let q: Option<Vec<Numbers>> = q.into_iter().collect();
    Some(Columns {
        pose: pose?,
        visit,
        time,
        temperature,
        q: q?,
        force: force?,
        moment,
        displacement: displacement?,
        rotation,
        encoders: encoders.ok()?,
        motors: motors.ok()?,
    })
}

/// One row; every number is checked before any gives it up.
fn observation(
    table: &Table<'_>,
    columns: &Columns,
    record: &Record,
    pose: usize,
    visit: usize,
) -> Option<Observation> {
    let optional = |column: Option<Numbers>| column.map(|column| table.number(record, column));
    let time = optional(columns.time);
    let temperature = optional(columns.temperature);
    let q: Vec<Option<f64>> = columns.q.iter().map(|&column| table.number(record, column)).collect();
    let force = table.all(record, columns.force);
    let moment = columns.moment.map(|column| column.map_or(Some(0.0), |column| table.number(record, column)));
    let displacement = table.all(record, columns.displacement);
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
    let (force, q) = (force?, q.into_iter().collect::<Option<Vec<f64>>>()?);
    Some(Observation {
        line: record.line,
        pose,
        visit,
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

/// The same pose id means the same joint coordinates.
fn check_pose(table: &Table<'_>, columns: &Columns, record: &Record, row: &Observation, first: Option<&Observation>) {
    let Some(first) = first else { return };
    for (i, (here, there)) in row.q.iter().zip(&first.q).enumerate() {
        if (here - there).abs() > SAME_POSE {
            let pose = table.text(record, columns.pose);
            table.report_number(
                record,
                columns.q[i],
                &format!("pose `{pose}` has another q{} in line {}", i + 1, first.line),
                "rows of one pose have the same joint coordinates; give another pose another id",
            );
        }
    }
}

fn first(rows: &mut Vec<usize>, index: usize, row: usize) {
    if rows.len() <= index {
        rows.resize(index + 1, usize::MAX);
    }
    if rows[index] == usize::MAX {
        rows[index] = row;
    }
}

/// The index of an id, new ones at the end.
fn index_of(ids: &mut Vec<String>, id: &str) -> usize {
    // Ids come in runs, so the last ones are the likely ones.
    ids.iter().rposition(|known| known == id).unwrap_or_else(|| {
        ids.push(id.to_owned());
        ids.len() - 1
    })
}
