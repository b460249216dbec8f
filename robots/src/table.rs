//! A CSV file as a table of checked numbers, every problem at its place.

mod columns;
mod extent;
mod form;
mod header;
mod problems;
mod repeated;
mod spreadsheet;

use core::cell::RefCell;
use std::collections::HashSet;
use std::path::Path;

use crate::quantity::{Dimension, QuantityError, finite, scale};
use crate::text::{self, Lines};
use crate::words::count;
use crate::{Diagnostics, ReadError};

use form::Form;
use header::Header;
use repeated::Repeated;

/// A table, and the problems found in it so far.
pub struct Table<'t> {
    file: &'t str,
    lines: Lines<&'t str>,
    form: Form,
    header: Vec<Header>,
    /// The line of the header, from 1.
    header_line: usize,
    /// The rows below the header; all as long as it.
    pub records: Vec<Record>,
    asked_for: RefCell<Vec<usize>>,
    /// The names of columns that were asked for and are not there.
    absent: RefCell<Vec<String>>,
    problems: RefCell<Vec<Repeated>>,
    warnings: RefCell<Vec<String>>,
}

/// The columns of a table, at the most: what is recorded has some ten.
const MOST_COLUMNS: usize = 1000;

/// The text of a table's file; a byte order mark, as spreadsheets write it, is no part
/// of it. Of a spreadsheet (`.xlsx`, with the feature `xlsx`) it is the only sheet that has cells, as CSV.
///
/// # Errors
/// A file that cannot be read, or is no text; a spreadsheet with several sheets.
pub fn text_of(path: &Path) -> Result<String, ReadError> {
    text_of_sheet(path, None)
}

/// The same of a spreadsheet's sheet by its name.
///
/// # Errors
/// A file that cannot be read, or is no text; a spreadsheet without such a sheet.
pub fn text_of_sheet(path: &Path, sheet: Option<&str>) -> Result<String, ReadError> {
    let bytes = spreadsheet::bytes_of(path, sheet)?;
    let mut text = text::decoded(&path.display().to_string(), bytes).map_err(ReadError::Invalid)?;
    if text.starts_with('\u{feff}') {
        text.drain(..'\u{feff}'.len_utf8());
    }
    Ok(text)
}

/// One row.
pub struct Record {
    /// The line of the file, from 1.
    pub line: usize,
    fields: csv::StringRecord,
}

/// A column of numbers: where it is, and what makes its unit SI.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    index: usize,
    scale: f64,
    /// Whether only whole numbers make sense.
    whole: bool,
}

impl Numbers {
    /// The same, where only whole numbers make sense.
    pub fn whole(self) -> Self {
        Self { whole: true, ..self }
    }
}

impl<'t> Table<'t> {
    /// Reads a table; `file` is the name that problems show.
    ///
    /// # Errors
    /// A file without a header or without rows.
    pub fn parse(file: &'t str, text: &'t str) -> Result<Self, Diagnostics> {
        let mut table = Self {
            file,
            lines: Lines::new(text),
            form: Form::default(),
            header: Vec::new(),
            header_line: 1,
            records: Vec::new(),
            asked_for: RefCell::default(),
            absent: RefCell::default(),
            problems: RefCell::default(),
            warnings: RefCell::default(),
        };
        match Form::of(text) {
            Ok(form) => table.form = form,
            Err(ambiguous) => {
                let form::Ambiguous { line, field, message, help } = ambiguous;
                return Err(table.problem(line, field, &message, &help).into());
            }
        }
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(table.form.separator as u8)
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let mut rows = reader.records();
        let Some(Ok(header)) = rows.next() else {
            return Err(table.problem(1, 0, "the file is empty", "the first line names the columns").into());
        };
        table.header_line = table.line_of(&header);
        if let Some(field) = open_quote(&header) {
            return Err(table.problem(table.header_line, field, NOT_CLOSED, CLOSE).into());
        }
        if header.get(0).is_some_and(|name| name.starts_with('#')) {
            return Err(table.problem(table.header_line, usize::MAX, "a comment line?", HEADER).into());
        }
        // An id or two may be no numbers; no column is called as one.
        if 2 * header.iter().filter(|name| name.parse::<f64>().is_ok()).count() > header.len() {
            return Err(table
                .problem(table.header_line, usize::MAX, "numbers, and no header above them", HEADER)
                .into());
        }
        if header.len() > MOST_COLUMNS {
            let message =
                format!("the header has {}, a table has {MOST_COLUMNS} at most", count(header.len(), "column"));
            return Err(table
                .problem(table.header_line, MOST_COLUMNS, &message, "keep the columns that are read")
                .into());
        }
        table.header = header.iter().map(Header::parse).collect();
        table.check_header();
        for row in rows {
            match row {
                Ok(row) => table.push(&row, table.line_of(&row)),
                Err(error) => table.report(1, 0, &format!("this is not CSV: {error}"), ""),
            }
        }
        if table.records.is_empty() && table.problems.borrow().is_empty() {
            let line = table.header_line;
            return Err(table.problem(line, 0, "there are no rows", "each line below the header is one row").into());
        }
        Ok(table)
    }

    /// The line that a record begins in, from 1.
    fn line_of(&self, record: &csv::StringRecord) -> usize {
        record.position().map_or(1, |position| {
            // Where the reader began to look for a row is before the empty lines that it skips.
            let byte = position.byte() as usize;
            let rest = self.lines.text().as_bytes().get(byte..).unwrap_or_default();
            let empty = rest.iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
            self.lines.number_at(byte + empty)
        })
    }

    fn check_header(&self) {
        let line = self.header_line;
        let mut names = HashSet::new();
        for (i, header) in self.header.iter().enumerate() {
            if header.name.is_empty() {
                self.report(line, i, "a column without a name", "write `name [unit]` or `name`");
            } else if !names.insert(&header.name) {
                self.report(line, i, &format!("the column `{}` is there twice", header.name), "keep one of them");
            }
            if !header.closed {
                let (name, unit) = (&header.name, header.unit.as_deref().unwrap_or_default());
                let help = match unit {
                    "" => format!("write `{name} [unit]` or `{name}`"),
                    unit => format!("write `{name} [{unit}]`"),
                };
                self.report(line, i, "the bracket of the unit is not closed", &help);
            }
        }
    }

    fn push(&mut self, row: &csv::StringRecord, line: usize) {
        if let Some(field) = open_quote(row) {
            return self.report(line, field, NOT_CLOSED, CLOSE);
        }
        let (expected, found) = (self.header.len(), row.len());
        if found == 1 && expected > 1 && row.iter().all(|field| field.trim().is_empty()) {
            // An empty line, but for blanks that nobody sees.
        } else if found == expected {
            self.records.push(Record { line, fields: row.clone() });
        } else {
            let message = format!("this row has {}, the header has {expected}", count(found, "field"));
            let help = match self.form.separator {
                ',' => "give every row one field a column, with a point as decimal sign",
                _ => "give every row one field a column",
            };
            let help = match found.checked_sub(expected) {
                Some(1) if row.get(expected).is_some_and(str::is_empty) => Some(one_too_many(self.form.separator)),
                Some(more) if self.form.separator == ',' => decimal_comma(row, more),
                _ => None,
            }
            .unwrap_or_else(|| help.to_owned());
            self.report(line, found.min(expected), &message, &help);
        }
    }

    /// A column of numbers; `None` where there is none or where its unit is
    /// wrong, which is reported.
    pub fn numbers(&self, name: &str, dimension: Dimension) -> Option<Numbers> {
        let index = self.position(name)?;
        let scale = match &self.header[index].unit {
            // What is between broken brackets was reported with the header.
            Some(_) if !self.header[index].closed => Ok(1.0),
            None => Ok(1.0),
            Some(unit) => scale(unit, dimension),
        };
        match scale {
            Ok(scale) => Some(Numbers { index, scale, whole: false }),
            Err(error) => {
                self.report(self.header_line, index, &error.message, &dimension.header_help(name));
                None
            }
        }
    }

    /// A column of numbers in whatever unit it has, with its name and unit; its
    /// absence is reported.
    pub fn raw(&self, name: &str) -> Option<(Numbers, &str, &str)> {
        let index = self.require_name(name)?;
        let header = &self.header[index];
        Some((Numbers { index, scale: 1.0, whole: false }, &header.name, header.unit.as_deref().unwrap_or_default()))
    }

    /// A column of numbers whose absence is reported.
    pub fn require(&self, name: &str, dimension: Dimension) -> Option<Numbers> {
        self.require_name(name)?;
        self.numbers(name, dimension)
    }

    /// The index of a column of ids whose absence is reported.
    pub fn require_name(&self, name: &str) -> Option<usize> {
        let index = self.position(name);
        if index.is_none() && self.in_round_brackets(name).is_none() {
            let names: Vec<_> = self.header.iter().map(|header| format!("`{}`", header.name)).collect();
            let other = self.header.iter().position(|header| header.key.eq_ignore_ascii_case(name));
            let help = match other {
                Some(field) => format!("write `{name}` in place of `{}`", self.header[field].name),
                None => format!("the header line has {}", names.join(", ")),
            };
            let place = other.unwrap_or(0);
            self.report(self.header_line, place, &format!("the column `{name}` is missing"), &help);
        }
        index
    }

    /// Counts columns as known where they are there, whatever is in them.
    pub fn ask_for(&self, names: &[&str]) {
        for name in names {
            self.position(name);
        }
    }

    /// Whether a column's name differs from this one in capitals only, or has its unit in round brackets.
    pub fn is_near(&self, name: &str) -> bool {
        self.in_round_brackets(name).is_some() || self.header.iter().any(|header| header.key.eq_ignore_ascii_case(name))
    }

    /// The index of a column. One whose unit is in round brackets is reported.
    pub fn position(&self, name: &str) -> Option<usize> {
        let index = self.header.iter().position(|header| header.key == name);
        match (index, self.in_round_brackets(name)) {
            (Some(index), _) => self.asked_for.borrow_mut().push(index),
            (None, Some((field, unit))) => {
                let help = format!("write `{name} [{unit}]`");
                self.report(self.header_line, field, "the unit is in round brackets", &help);
            }
            (None, None) => self.absent.borrow_mut().push(name.to_owned()),
        }
        index
    }

    /// The column that is called so up to a round bracket, by index, and what is in the
    /// bracket.
    fn in_round_brackets(&self, name: &str) -> Option<(usize, &str)> {
        self.header.iter().enumerate().find_map(|(field, header)| {
            let (before, unit) = header.name.split_once('(')?;
            (before.trim() == name).then(|| (field, unit.trim_end_matches(')').trim()))
        })
    }

    /// A number of a row in SI; what is not a finite number, or beyond all sums, is reported.
    pub fn number(&self, record: &Record, column: Numbers) -> Option<f64> {
        let text = &record.fields[column.index];
        let written = self.form.with_point(text);
        if let Some([message, help]) = self.form.mixed(text) {
            self.report(record.line, column.index, &message, &help);
            return None;
        }
        let number = written.parse::<f64>().map(|number| (number.is_finite(), number * column.scale));
        let problem = match number {
            Ok((true, number)) if number.is_infinite() => format!("`{text}` in SI units is too large"),
            Ok((true, number)) => {
                let report = |error: QuantityError| self.report(record.line, column.index, &error.message, &error.help);
                return finite(number).map_err(report).ok();
            }
            Ok(_) => format!("`{text}` is not finite"),
            Err(_) if text.is_empty() => "a number is missing".to_owned(),
            Err(_) => format!("`{text}` is not a number"),
        };
        let name = &self.header[column.index].name;
        let point = text.replacen(',', ".", 1);
        let help = match text.contains(',') && point.parse::<f64>().is_ok() {
            true if self.form.comma.is_none() => comma_help(&point),
            _ if column.whole => format!("the column `{name}` holds whole numbers, e.g. `1`"),
            _ => format!("the column `{name}` holds finite numbers, e.g. `0.25`"),
        };
        self.report(record.line, column.index, &problem, &help);
        None
    }

    /// Reports it, once, where nothing is written in any row of some columns.
    pub fn refuse_unfilled(&self, columns: &[Numbers], of: &str) -> Option<()> {
        let first = self.records.first()?;
        let unfilled = |record: &Record| columns.iter().all(|&column| self.is_empty(record, column));
        if self.records.iter().all(unfilled) {
            let message = format!("no readings yet: fill in {of}");
            self.report(first.line, columns[0].index, &message, "measure, and write what was read into every row");
            return None;
        }
        Some(())
    }

    /// Whether nothing is written there.
    pub fn is_empty(&self, record: &Record, column: Numbers) -> bool {
        record.fields[column.index].is_empty()
    }

    /// A number of a row in SI, unchecked.
    pub fn peek(&self, record: &Record, column: Numbers) -> Option<f64> {
        self.form.with_point(&record.fields[column.index]).parse::<f64>().ok().map(|number| number * column.scale)
    }

    /// The numbers of several columns, all checked.
    pub fn all<const K: usize>(&self, record: &Record, columns: [Numbers; K]) -> Option<[f64; K]> {
        let numbers = columns.map(|column| self.number(record, column));
        numbers.iter().all(Option::is_some).then(|| numbers.map(Option::unwrap_or_default))
    }

    /// The id of a row in a column; a blank one, or the `nan` that programs write for one, is
    /// reported, and is no id.
    pub fn id<'r>(&self, record: &'r Record, index: usize) -> &'r str {
        let id = Some(self.text(record, index)).filter(|id| !id.eq_ignore_ascii_case("nan")).unwrap_or_default();
        if id.is_empty() {
            let name = &self.header[index].name;
            let help = format!("give every row the id of its {name}, e.g. `1`");
            self.report(record.line, index, &format!("the {name} has no id"), &help);
        }
        id
    }

    /// The text of a row in a column.
    pub fn text<'r>(&self, record: &'r Record, index: usize) -> &'r str {
        &record.fields[index]
    }

    /// What is written in a row in a column of numbers.
    pub fn written<'r>(&self, record: &'r Record, column: Numbers) -> &'r str {
        &record.fields[column.index]
    }

    /// The name of a column, without its unit.
    pub fn name_of(&self, column: Numbers) -> &str {
        &self.header[column.index].name
    }

    /// Whether the header gives a column its unit.
    pub fn has_unit(&self, column: Numbers) -> bool {
        self.header[column.index].unit.is_some()
    }
}

/// What is right where the first line is something else.
const HEADER: &str = "the first line must be the header, which names the columns: `pose,q1 [deg],Fx [N]`";

/// What is said of a quote that takes in the end of its line, and what is right.
const NOT_CLOSED: &str = "the quote is not closed on its line";
const CLOSE: &str = "a row is one line: close the quote, or leave it out; no field goes on in the next line";

/// The field, if there is one, in which a row goes on over the end of its line. A quote that
/// is not closed takes in all rows up to the next one, and these would be lost without a word.
fn open_quote(row: &csv::StringRecord) -> Option<usize> {
    row.iter().position(|field| field.contains(['\r', '\n']))
}

/// What is right where a row ends in a separator.
fn one_too_many(separator: char) -> String {
    let name = match separator {
        ';' => "semicolon",
        '\t' => "tab",
        _ => "comma",
    };
    format!("leave out the {name} at the end")
}

/// What is said of a number with a comma, written with a point.
fn comma_help(point: &str) -> String {
    format!("a decimal comma? write `{point}`")
}

/// The same of a row with so many fields more than its header, if it has as many places where a
/// comma may divide a number: a whole number and three digits or more. Of the first.
fn decimal_comma(row: &csv::StringRecord, more: usize) -> Option<String> {
    let fields: Vec<&str> = row.iter().collect();
    let is_divided = |pair: &&[&str]| {
        let digits = pair[1].len() >= 3 && pair[1].bytes().all(|byte| byte.is_ascii_digit());
        digits && pair[0].parse::<i64>().is_ok()
    };
    let divided: Vec<&[&str]> = fields.windows(2).filter(is_divided).collect();
    let first = divided.first().filter(|_| divided.len() == more)?;
    Some(comma_help(&format!("{}.{}", first[0], first[1])))
}
