//! Reading responses from a table.

use std::path::Path;

use nalgebra::Complex;
use robstiff_robots::quantity::Dimension;
use robstiff_robots::table::{Numbers, Record, Table, text_of};
use robstiff_robots::words::and;
use robstiff_robots::{Diagnostics, ReadError};

use super::{Motion, Response, Responses};

/// What the directions are called.
const NAMES: [char; 3] = ['x', 'y', 'z'];

/// What the columns of a complete file are.
const EXAMPLE: &str = "`frequency [Hz],xx_re,xx_im,yx_re,yx_im,zx_re,zx_im`: the first letter is the direction of the \
                       response, the second that of the force";

/// The two columns of a response.
#[derive(Clone, Copy)]
struct Columns {
    directions: [usize; 2],
    parts: [Numbers; 2],
    /// Magnitude and phase, in place of the real and the imaginary part.
    are_polar: bool,
}

impl Responses {
    /// Reads a table with a column `frequency` (Hz) and of each response two: `xy_re` and `xy_im`, or `xy_mag` and
    /// `xy_phase` (rad), of the response along x to a force along y. Only lines of a band (Hz) are kept, and none
    /// at 0 Hz. With what the reader noticed without refusing the table.
    ///
    /// # Errors
    /// A file that cannot be read; everything that is wrong with it, each problem at its place.
    pub fn read(path: &Path, motion: Motion, band: [f64; 2]) -> Result<(Self, Vec<String>), ReadError> {
        Self::parse(&path.display().to_string(), &text_of(path)?, motion, band).map_err(ReadError::Invalid)
    }

    /// The same from a text; `file` is the name that problems show.
    ///
    /// # Errors
    /// Everything that is wrong with it, each problem at its place.
    pub fn parse(file: &str, text: &str, motion: Motion, band: [f64; 2]) -> Result<(Self, Vec<String>), Diagnostics> {
        let table = Table::parse(file, text)?;
        let frequency = table.require("frequency", Dimension::Frequency);
        let columns = columns(&table, motion);
        let read = || {
            let (frequency, columns) = (frequency?, columns?);
            let rows = rows(&table, frequency, &columns, band)?;
            let all = columns.iter().enumerate().map(|(place, column)| Response {
                directions: column.directions,
                values: rows.iter().map(|(_, values)| values[place]).collect(),
            });
            let frequencies = rows.iter().map(|(frequency, _)| *frequency).collect();
            let responses = Self { motion, frequencies, all: all.collect() };
            check(&table, &columns, &responses);
            Some(responses)
        };
        let responses = read();
        table.finish(responses)
    }
}

/// The responses that there are.
fn columns(table: &Table<'_>, motion: Motion) -> Option<Vec<Columns>> {
    let dimension = match motion {
        Motion::Receptance => Dimension::LinearCompliance,
        Motion::Mobility => Dimension::Mobility,
        Motion::Accelerance => Dimension::Accelerance,
    };
    let (mut found, mut are_good) = (Vec::new(), true);
    for directions in (0..9).map(|k| [k % 3, k / 3]) {
        let name = name(directions);
        let there =
            |ends: [&str; 2]| ends.map(|end| format!("{name}_{end}")).map(|name| table.position(&name).is_some());
        let [cartesian, polar] = [there(["re", "im"]), there(["mag", "phase"])];
        let (ends, dimensions, are_polar) = match (cartesian, polar) {
            ([false, false], [false, false]) => continue,
            (_, [false, false]) => (["re", "im"], [dimension; 2], false),
            ([false, false], _) => (["mag", "phase"], [dimension, Dimension::Angle], true),
            _ => {
                table.report_header(
                    &format!("the response {name} is there twice"),
                    "keep real and imaginary part, or magnitude and phase",
                );
                are_good = false;
                continue;
            }
        };
        let parts = [0, 1].map(|k| table.require(&format!("{name}_{}", ends[k]), dimensions[k]));
        match parts {
            [Some(one), Some(other)] => found.push(Columns { directions, parts: [one, other], are_polar }),
            _ => are_good = false,
        }
    }
    if found.is_empty() && are_good {
        table.report_header("there is no column of a response", &format!("e.g. {EXAMPLE}"));
        are_good = false;
    }
    are_good.then_some(found)
}

fn name([response, force]: [usize; 2]) -> String {
    [NAMES[response], NAMES[force]].iter().collect()
}

type Row = (f64, Vec<Complex<f64>>);

/// The lines in the band.
fn rows(table: &Table<'_>, frequency: Numbers, columns: &[Columns], [from, to]: [f64; 2]) -> Option<Vec<Row>> {
    let mut last = f64::NEG_INFINITY;
    let mut row = |record: &Record| -> Option<Option<Row>> {
        let hertz = table.number(record, frequency)?;
        if hertz < 0.0 || hertz <= last {
            let (message, help) = if hertz < 0.0 {
                ("a frequency below zero", "keep the lines from 0 Hz on")
            } else {
                ("the frequency is not above that of the row before", "one row a frequency, the lowest first")
            };
            table.report_number(record, frequency, message, help);
            return None;
        }
        last = hertz;
        // At rest there is no acceleration to divide by; what was measured elsewhere may be anything.
        if hertz == 0.0 || !(from..=to).contains(&hertz) {
            return Some(None);
        }
        let values: Vec<Option<Complex<f64>>> = columns
            .iter()
            .map(|column| {
                let [one, other] = table.all(record, column.parts)?;
                Some(if column.are_polar { Complex::from_polar(one, other) } else { Complex::new(one, other) })
            })
            .collect();
        Some(Some((hertz, values.into_iter().collect::<Option<_>>()?)))
    };
    // Every row is checked before any gives the file up.
    let rows: Vec<Option<Option<Row>>> = table.records.iter().map(&mut row).collect();
    let rows: Vec<Row> = rows.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().collect();
    if rows.is_empty() {
        let ends = [table.records.first(), table.records.last()];
        let [first, end] = ends.map(|record| record.map_or("", |record| table.written(record, frequency)));
        let upper = if to < f64::MAX { format!(" and below {to} Hz") } else { String::new() };
        let message = format!("no line is above {from} Hz{upper}");
        table.report_column(frequency, &message, &format!("the table goes from {first} to {end}"));
        return None;
    }
    Some(rows)
}

/// Holds the responses against those that a structure can have.
fn check(table: &Table<'_>, columns: &[Columns], responses: &Responses) {
    if !responses.is_complete() {
        let names: Vec<String> = columns.iter().map(|column| name(column.directions)).collect();
        let message = format!("of no force all three responses are there, only {}", and(&names));
        table.report_header(&message, &format!("measure x, y and z for one force at least, e.g. {EXAMPLE}"));
    }
    for place in responses.impossible() {
        let name = name(columns[place].directions);
        let message = format!("by `{name}` the structure would give power to the hammer, which none does");
        let help = format!(
            "turn the sign of all responses along {}, or of all phases; or is it no {}?",
            &name[..1],
            match responses.motion {
                Motion::Receptance => "receptance",
                Motion::Mobility => "mobility",
                Motion::Accelerance => "accelerance",
            }
        );
        table.report_column(columns[place].parts[0], &message, &help);
    }
}
