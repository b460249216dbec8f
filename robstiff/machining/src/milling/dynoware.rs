//! The head of a file that Kistler's DynoWare exports.
//!
//! `DynoWare,Version ..`, then lines `name:,value` such as `Sampling rate [Hz]:,10000`, then a line
//! that names the columns and one with their units. Fields are separated by tabs, semicolons or
//! commas.

use robstiff_robots::{Diagnostic, Diagnostics, Line};

/// A file as a table with one line of header.
#[derive(Debug, PartialEq)]
pub(super) struct Export {
    /// The table: every row is in the line that it has in the file.
    pub table: String,
    /// Samples a second, where the head says so.
    pub rate: Option<f64>,
}

/// The columns are named within so many lines.
const HEAD: usize = 200;

/// The table of a file, where DynoWare exported it.
///
/// # Errors
/// A head that names no columns, or has no line of units below.
pub(super) fn export(file: &str, text: &str) -> Option<Result<Export, Diagnostics>> {
    let first = text.trim_start_matches('\u{feff}').lines().next()?;
    first.trim_start().starts_with("DynoWare").then(|| table(file, text))
}

fn table(file: &str, text: &str) -> Result<Export, Diagnostics> {
    let fields = |line: &str| -> (char, Vec<String>) {
        let separator = ['\t', ';', ','].into_iter().find(|&separator| line.contains(separator)).unwrap_or(',');
        (separator, line.split(separator).map(|field| field.trim().trim_matches('"').to_owned()).collect())
    };
    let mut rate = None;
    let mut lines = text.split_inclusive('\n').enumerate().take(HEAD);
    let names = lines.find_map(|(index, line)| {
        let (separator, fields) = fields(line);
        if fields[0].starts_with("Sampling rate") {
            rate = fields.get(1).and_then(|rate| rate.replace(',', ".").parse().ok()).filter(|rate| *rate > 0.0);
        }
        fields.iter().any(|name| name == "Fx").then_some((index, separator, fields))
    });
    let problem = |number: usize, message: &str, help: &str| {
        let line = Line { number, text: text.lines().nth(number - 1).unwrap_or_default() };
        Diagnostics::from(Diagnostic::of_line(file, line, message, help))
    };
    let Some((index, separator, names)) = names else {
        let help = "below the head is a line `Time,Fx,Fy,Fz`, and one with their units; export these channels";
        return Err(problem(1, "this DynoWare file names no column `Fx`", help));
    };
    let units = text.lines().nth(index + 1).map(|line| fields(line).1).unwrap_or_default();
    if units.len() != names.len() || units.iter().any(|unit| unit.parse::<f64>().is_ok()) {
        let help = "below the names of the columns DynoWare writes their units, `s,N,N,N`";
        return Err(problem(index + 2, "the columns have no units", help));
    }
    let named = |(name, unit): (&String, &String)| match (name.as_str(), unit.as_str()) {
        ("Time", unit) => format!("t [{unit}]"),
        (name, "") => name.to_owned(),
        (name, unit) => format!("{name} [{unit}]"),
    };
    let header: Vec<String> = names.iter().zip(&units).map(named).collect();
    let rows = text.split_inclusive('\n').skip(index + 2);
    // A row is shown by its line of the file.
    let table = "\n".repeat(index + 1) + &header.join(&separator.to_string()) + "\n" + &rows.collect::<String>();
    Ok(Export { table, rate })
}
