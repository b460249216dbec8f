//! Columns that a table has under other names: `columns: {q1: "Achse 1", dx: "Messuhr X"}`.

use std::borrow::ToOwned;
use std::format;
use std::string::String;
use std::vec::Vec;

use robstiff_robots::document::Map;
use robstiff_robots::table::Table;
use robstiff_robots::{Diagnostic, Diagnostics, Line};

/// A column under another name.
pub struct Renamed {
    /// What campaigns call it.
    key: String,
    /// What the table calls it.
    name: String,
    /// The line of the campaign file that says so.
    line: usize,
}

/// What campaigns call the columns that are not of joints.
const COLUMNS: [&str; 24] = [
    "pose",
    "visit",
    "time",
    "temperature",
    "Fx",
    "Fy",
    "Fz",
    "Mx",
    "My",
    "Mz",
    "dx",
    "dy",
    "dz",
    "d",
    "rx",
    "ry",
    "rz",
    "px",
    "py",
    "pz",
    "payload",
    "axis",
    "torque",
    "deflection",
];

/// What joints' columns begin with: coordinates, what the pendant shows, and what encoders and motors read.
const OF_JOINTS: [char; 4] = ['q', 't', 'j', 'm'];

fn is_column(key: &str) -> bool {
    let of_joint = || key.strip_prefix(OF_JOINTS).and_then(|number| number.parse::<usize>().ok());
    COLUMNS.contains(&key) || of_joint().is_some_and(|joint| joint > 0)
}

/// What a campaign file says of columns; `None` with the problems reported.
pub fn renamed(map: &Map<'_>) -> Option<Vec<Renamed>> {
    const EXAMPLE: &str = "e.g. `columns: {q1: \"Achse 1\", dx: \"Messuhr X\"}`";
    let Some(node) = map.get("columns") else { return Some(Vec::new()) };
    let (mut found, mut complete) = (Vec::<Renamed>::new(), true);
    for (key, node) in node.any_map(EXAMPLE)?.fields() {
        let known = is_column(key);
        if !known {
            let names = COLUMNS.join(", ");
            node.error(format!("there is no column `{key}` to rename"), format!("the columns are q1 .., {names}"));
        }
        let name = node.text();
        let twice = name.filter(|name| found.iter().any(|other| other.name == *name));
        if let Some(name) = twice {
            node.error(format!("the column `{name}` is named twice"), "a column is one quantity");
        }
        match name.filter(|_| known && twice.is_none()) {
            Some(name) => found.push(Renamed { key: key.to_owned(), name: name.to_owned(), line: node.line() }),
            None => complete = false,
        }
    }
    complete.then_some(found)
}

/// Takes the columns of a table by the names of a campaign file, of which the name and the text are
/// given.
///
/// # Errors
/// Every column that is not there, with its line in the campaign file.
pub fn take(table: &mut Table<'_>, columns: &[Renamed], (file, text): (&str, &str)) -> Result<(), Diagnostics> {
    let mut problems = Vec::new();
    for Renamed { key, name, line } in columns {
        if let Err([message, help]) = table.take(key, name) {
            let line = Line { number: *line, text: text.lines().nth(line - 1).unwrap_or_default() };
            problems.push(Diagnostic::of_line(file, line, message, help).at(format!("columns.{key}")));
        }
    }
    Diagnostics::new(problems).map_or(Ok(()), Err)
}
