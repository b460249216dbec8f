//! The rows of a campaign of kind `position`.

use std::format;
use std::vec::Vec;

use robstiff_robots::Description;
use robstiff_robots::quantity::Dimension;

use super::beyond::{LENGTHS, PAYLOAD, warn_of};
use super::poses::{AtPose, Columns as PoseColumns, Poses};
use super::{PositionRow, Positions, order, revisited, times};
use robstiff_robots::table::{Numbers, Record, Table};

/// The columns of the table.
struct Columns {
    at: PoseColumns,
    /// Of every row.
    time: Option<Vec<Option<f64>>>,
    temperature: Option<Numbers>,
    position: [Numbers; 3],
    payload: Option<Numbers>,
}

impl AtPose for PositionRow {
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
pub fn read(table: &Table<'_>, robot: &Description, payload_at: [f64; 3], measured_at: [f64; 3]) -> Option<Positions> {
    let columns = columns(table, robot)?;
    table.refuse_unfilled(&columns.position, "px, py, pz")?;
    let (mut poses, mut rows) = (Poses::default(), Vec::new());
    let mut complete = true;
    for number in order::of_reading(table, &columns.at, columns.time.as_deref()) {
        let record = &table.records[number];
        let (pose, visit, named) = poses.named(table, &columns.at, record);
        let time = columns.time.as_ref().map(|times| times[number]);
        let Some(row) = row(table, &columns, record, (pose, visit, time)).filter(|_| named) else {
            complete = false;
            continue;
        };
        poses.enter(table, &columns.at, record, (&row, visit), &rows);
        rows.push(row);
    }
    columns.at.check_ranges(table, &robot.joints, &rows);
    check_sizes(table, &columns, &rows);
    let [mut poses, visits] = poses.names();
    if let Some(said) = revisited::unite(&mut poses, &mut rows) {
        table.warn(&said);
    }
    complete.then_some(Positions { payload_at, measured_at, poses, visits, rows })
}

/// No arm reaches so far (m); millimetres that are read as metres do.
const FARTHEST: f64 = 30.0;

/// Warns of positions and payloads that no arm comes to.
fn check_sizes(table: &Table<'_>, columns: &Columns, rows: &[PositionRow]) {
    for (k, &column) in columns.position.iter().enumerate() {
        let mut along: Vec<f64> = rows.iter().map(|row| row.position[k]).collect();
        along.sort_by(f64::total_cmp);
        let Some(middle) = along.get(along.len() / 2) else { continue };
        let far = rows.iter().filter(|row| (row.position[k] - middle).abs() > FARTHEST);
        let what = format!("{} is more than {FARTHEST} m off the middle of all", table.name_of(column));
        warn_of(table, &what, far.map(|row| row.line), &LENGTHS.asked(table, column));
    }
    if let Some(column) = columns.payload {
        PAYLOAD.warn(table, column, rows.iter().map(|row| (row.line, row.payload)));
    }
}

fn columns(table: &Table<'_>, robot: &Description) -> Option<Columns> {
    let at = PoseColumns::find(table, robot);
    let time = times::read(table);
    let temperature = table.numbers("temperature", Dimension::Temperature);
    let position = ["px", "py", "pz"].map(|name| table.require(name, Dimension::Length));
    let payload = table.numbers("payload", Dimension::Mass);
    let [x, y, z] = position;
    Some(Columns { at: at?, time, temperature, position: [x?, y?, z?], payload })
}

/// One row; every number is checked before any gives it up.
fn row(
    table: &Table<'_>,
    columns: &Columns,
    record: &Record,
    (pose, visit, time): (usize, usize, Option<Option<f64>>),
) -> Option<PositionRow> {
    let optional = |column: Option<Numbers>| column.map(|column| table.number(record, column));
    let temperature = optional(columns.temperature);
    let q = columns.at.coordinates(table, record);
    let position = table.all(record, columns.position);
    let payload = columns.payload.map_or(Some(0.0), |column| {
        let payload = table.number(record, column)?;
        if payload < 0.0 {
            table.report_number(record, column, "a payload is not negative", "0 where nothing hangs on the tool");
            return None;
        }
        Some(payload)
    });
    if time == Some(None) || temperature == Some(None) {
        return None;
    }
    Some(PositionRow {
        line: record.line,
        pose,
        visit,
        time: time.flatten(),
        temperature: temperature.flatten(),
        q: q?,
        position: position?,
        payload: payload?,
    })
}
