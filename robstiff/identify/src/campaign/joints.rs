//! Tables of joint coordinates, such as a solved tool path.

use std::borrow::ToOwned;
use std::format;
use std::path::Path;
use std::string::{String, ToString};
use std::vec::Vec;

use robstiff_robots::quantity::Dimension;
use robstiff_robots::{Description, ReadError};

use super::beyond::{FORCE, MOMENT};
use super::poses::{check_range, dimension_of};
use robstiff_robots::table::{Table, text_of};

/// Joint coordinates row by row, with what is written beside them.
#[derive(Clone, Debug, PartialEq)]
pub struct JointTable {
    /// Joint coordinates (rad or m), one a joint.
    pub q: Vec<Vec<f64>>,
    /// The force and the moment on the tool in the base frame (N, Nm), where there
    /// are any.
    pub wrenches: Option<Vec<[f64; 6]>>,
    /// The column that was asked for.
    pub column: Option<Column>,
    /// Whether each row is reached by a rapid, in which nothing is cut: what a column `rapid` says by 1 and 0.
    pub rapids: Option<Vec<bool>>,
    /// What looks as if the table were another robot's, or in another unit.
    pub warnings: Vec<String>,
}

/// A column of any numbers, as the file gives them.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its unit; empty where the header has none.
    pub unit: String,
    /// Its numbers, in that unit; none where the cell is empty.
    pub values: Vec<Option<f64>>,
}

impl JointTable {
    /// Reads columns `q1` .. `qn`, where they are there `Fx Fy Fz`, all three, and of `Mx My Mz`
    /// those that are, `rapid`, and the one of any other name that is asked for. Columns beyond these are left alone.
    ///
    /// # Errors
    /// A file that cannot be read, and every problem in it at its place.
    pub fn read(path: &Path, robot: &Description, column: Option<&str>) -> Result<Self, ReadError> {
        let (name, text) = (path.display().to_string(), text_of(path)?);
        let mut table = Table::parse(&name, &text).map_err(ReadError::Invalid)?;
        table.take_joints(robot.joints.len());
        let mut warnings = beyond(&table, &name, robot);
        let read = rows(&table, robot, column);
        table.warn_of_misspelt();
        warnings.extend(table.noticed());
        let read = read.map(|read| JointTable { warnings, ..read });
        table.finish(read).map(|(read, _)| read).map_err(ReadError::Invalid)
    }
}

/// Says so of columns for joints that the robot does not have, up to as many as there are.
fn beyond(table: &Table<'_>, file: &str, robot: &Description) -> Vec<String> {
    let beyond = robot.joints.len() + 1..;
    let there = beyond.take_while(|joint| table.position(&format!("q{joint}")).is_some());
    let said = |joint| format!("{file}: the column `q{joint}` is not used, {} has no joint {joint}", robot.name);
    there.map(said).collect()
}

/// `None` with the problems reported to the table.
fn rows(table: &Table<'_>, robot: &Description, column: Option<&str>) -> Option<JointTable> {
    if table.position("q1").is_none() && table.position("x").is_some() {
        let help = "`robstiff path ROBOT.yaml PATH.csv --out SOLVED.csv` solves a path of poses";
        table.report_header("there are poses here, and no joint coordinates `q1` ..", help);
        return None;
    }
    let joints = (1..).zip(&robot.joints);
    let q = joints.map(|(k, joint)| table.require(&format!("q{k}"), dimension_of(joint.kind)));
    // Collected before it is judged, so that every column is looked for.
    let q: Vec<_> = q.collect();
    // One that is missing may be misspelt, and is not zero.
    let names = ["Fx", "Fy", "Fz"];
    let is_forced = names.map(|name| table.position(name)).iter().any(Option::is_some);
    let forces = names.map(|name| if is_forced { table.require(name, Dimension::Force) } else { None });
    let moments = ["Mx", "My", "Mz"].map(|name| table.numbers(name, Dimension::Torque));
    let wrench: Vec<_> = forces.into_iter().chain(moments).collect();
    let rapid = table.numbers("rapid", Dimension::Number);
    let column = column.map(|name| table.raw(name));
    let q: Vec<_> = q.into_iter().collect::<Option<_>>()?;
    let forced = wrench.iter().any(Option::is_some);
    let rows: Vec<_> = table
        .records
        .iter()
        .map(|record| {
            let q: Vec<_> = q.iter().map(|&column| table.number(record, column)).collect();
            let wrench = wrench.iter().map(|column| column.map_or(Some(0.0), |column| table.number(record, column)));
            let wrench: Vec<_> = wrench.collect();
            let mut components = [0.0; 6];
            for (component, value) in components.iter_mut().zip(wrench) {
                *component = value?;
            }
            Some((q.into_iter().collect::<Option<Vec<_>>>()?, components))
        })
        .collect();
    let rapids = rapid.map(|column| {
        let of = |record| table.number(record, column).map(|number| number != 0.0);
        table.records.iter().map(of).collect::<Vec<_>>()
    });
    let rapids = match rapids {
        Some(rapids) => Some(rapids.into_iter().collect::<Option<Vec<_>>>()?),
        None => None,
    };
    let column = match column {
        None => None,
        Some(column) => {
            let (column, name, unit) = column?;
            let value = |record| {
                if table.is_empty(record, column) { Some(None) } else { table.number(record, column).map(Some) }
            };
            let values: Vec<_> = table.records.iter().map(value).collect();
            let values = values.into_iter().collect::<Option<Vec<_>>>()?;
            if values.iter().all(Option::is_none) {
                table.report_header(&format!("the column `{name}` is empty"), "name a column with numbers");
                return None;
            }
            Some(Column { name: name.to_owned(), unit: unit.to_owned(), values })
        }
    };
    let (coordinates, wrenches): (Vec<_>, Vec<_>) = rows.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
    for (k, column) in wrench.iter().enumerate().filter_map(|(k, column)| Some((k, (*column)?))) {
        let read = table.records.iter().zip(&wrenches).map(|(record, wrench)| (record.line, wrench[k]));
        let beyond = if k < 3 { FORCE } else { MOMENT };
        beyond.warn(table, column, read);
    }
    for (index, (joint, &column)) in robot.joints.iter().zip(&q).enumerate() {
        let read = table.records.iter().zip(&coordinates);
        check_range(table, joint, index, column, read.map(|(record, q)| (record.line, q[index])));
    }
    Some(JointTable { q: coordinates, wrenches: forced.then_some(wrenches), column, rapids, warnings: Vec::new() })
}
