//! The rows of a campaign of kind `clamped`.

use std::format;
use std::vec::Vec;

use robstiff_robots::Description;
use robstiff_robots::quantity::Dimension;

use super::ClampedRow;
use super::beyond::{MOMENT, ROTATION};
use crate::table::{Numbers, Table};

/// Reads the rows; `None` with the problems reported to the table.
pub fn read(table: &Table<'_>, robot: &Description) -> Option<Vec<ClampedRow>> {
    let axis = table.require("axis", Dimension::Number).map(Numbers::whole);
    let torque = table.require("torque", Dimension::Torque);
    let deflection = table.require("deflection", Dimension::Angle);
    let columns = [axis?, torque?, deflection?];
    let count = robot.joints.len();
    let rows = table.records.iter().map(|record| {
        let [axis, torque, deflection] = table.all(record, columns)?;
        if axis.fract() != 0.0 || !(1.0..=count as f64).contains(&axis) {
            let message = format!("the robot has no axis {axis}");
            table.report_number(record, columns[0], &message, &format!("axes count from 1 to {count}"));
            return None;
        }
        Some(ClampedRow { line: record.line, axis: axis as usize, torque, deflection })
    });
    // Collected before it is judged, so that every row is checked.
    let rows: Vec<Option<ClampedRow>> = rows.collect();
    let rows: Vec<ClampedRow> = rows.into_iter().collect::<Option<_>>()?;
    MOMENT.warn(table, columns[1], rows.iter().map(|row| (row.line, row.torque)));
    ROTATION.warn(table, columns[2], rows.iter().map(|row| (row.line, row.deflection)));
    Some(rows)
}
