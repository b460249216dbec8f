//! The order in which the rows of a table were read. What slips, drifts or settles does so in
//! that order, whatever order a table was brought to since.

use std::collections::HashMap;
use std::vec::Vec;

use super::beyond::warn_of;
use super::poses::Columns;
use robstiff_robots::table::Table;

/// The records of a table in the order in which they were read, by index: that of their times,
/// where every row has one, else that of the file.
///
/// The rows of a visit are in load order, which a time is not said to be surer of. Where the two
/// differ the time of a row may be anything, and none is sorted by.
pub fn of_reading(table: &Table<'_>, columns: &Columns, times: Option<&[Option<f64>]>) -> Vec<usize> {
    let as_in_file: Vec<usize> = (0..table.records.len()).collect();
    let Some(times) = times.and_then(|times| times.iter().copied().collect::<Option<Vec<f64>>>()) else {
        return as_in_file;
    };
    let line = |row: usize| table.records[row].line;
    let back: Vec<usize> = (1..times.len()).filter(|&row| times[row] < times[row - 1]).map(line).collect();
    if back.is_empty() {
        return as_in_file;
    }
    let visits = Visits::new(table, columns, &times);
    let within = visits.back.iter().map(|&row| line(row));
    let ask =
        ": the rows are taken in the order of the file; if they were read in that of the times, sort them by time";
    if warn_of(table, "the time is earlier than that of a row of the same visit before", within, ask) {
        return as_in_file;
    }
    let ask = ": the rows are taken in the order of their times";
    warn_of(table, "the time is earlier than the one before", back.into_iter(), ask);
    let mut sorted = as_in_file;
    // Times that are told coarsely leave visits together.
    sorted.sort_by(|&a, &b| {
        let spans = [a, b].map(|row| visits.spans[visits.of[row]]);
        let one = |row: usize, [first, last]: [f64; 2]| [times[row], first, last];
        let [a, b] = [one(a, spans[0]), one(b, spans[1])];
        a.iter().zip(&b).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(core::cmp::Ordering::Equal)
    });
    sorted
}

/// When visits were.
struct Visits {
    /// That of each row, by index.
    of: Vec<usize>,
    /// The first and the last time of each.
    spans: Vec<[f64; 2]>,
    /// Rows with a time before that of an earlier row of their visit.
    back: Vec<usize>,
}

impl Visits {
    fn new(table: &Table<'_>, columns: &Columns, times: &[f64]) -> Self {
        let mut visits = Self { of: Vec::new(), spans: Vec::new(), back: Vec::new() };
        let mut known = HashMap::new();
        for (row, (record, &time)) in table.records.iter().zip(times).enumerate() {
            let next = visits.spans.len();
            // Without the column every row is a visit of its own.
            let visit = columns.visit_of(table, record).map_or(next, |id| *known.entry(id).or_insert(next));
            match visits.spans.get_mut(visit) {
                None => visits.spans.push([time; 2]),
                Some([_, last]) if time < *last => visits.back.push(row),
                Some([_, last]) => *last = time,
            }
            visits.of.push(visit);
        }
        visits
    }
}
