//! Forces along a path from a file.

use std::path::Path;

use nalgebra::{Matrix3, Unit, Vector3, Vector6};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::text::Lines;
use robstiff_robots::words::count;
use robstiff_robots::{Diagnostic, Diagnostics, Line, ReadError};

use super::load::{contact, rotation};
use super::{Load, Revolutions, Surface};
use crate::milling::ForceFrame;
use crate::path::SolvedPath;
use crate::path::read::LENGTHS;
use robstiff_robots::table::{Numbers, Record, Table, text_of};

/// Wrenches on the tool along a path: one a point, or by arc length.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceTable {
    /// The file's name.
    pub file: String,
    /// The arc length of each row (m), ascending; `None` where the rows are those of
    /// the path.
    pub s: Option<Vec<f64>>,
    /// Force and moment on the tool at the TCP (N, Nm), a row each.
    pub wrenches: Vec<Vector6<f64>>,
    /// What the reader noticed without refusing the file.
    pub warnings: Vec<String>,
    /// The lines (from 1) of the first and the last row, with what they say.
    ends: [(usize, String); 2],
}

/// Arc lengths that differ by less are the same (m).
const SAME_LENGTH: f64 = 1e-6;

impl ForceTable {
    /// Reads columns `Fx Fy Fz` (N), where they are there `Mx My Mz` (Nm), and `s`
    /// (m) where the rows are not those of the path.
    ///
    /// # Errors
    /// A file that cannot be read; everything that is wrong with it, each problem at
    /// its place.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        Self::parse(&path.display().to_string(), &text_of(path)?).map_err(ReadError::Invalid)
    }

    /// The same from a text; `file` is the name that problems show.
    ///
    /// # Errors
    /// Everything that is wrong with it, each problem at its place.
    pub fn parse(file: &str, text: &str) -> Result<Self, Diagnostics> {
        let table = Table::parse(file, text)?;
        let forces = ["Fx", "Fy", "Fz"].map(|name| table.require(name, Dimension::Force));
        let moments = ["Mx", "My", "Mz"].map(|name| table.numbers(name, Dimension::Torque));
        let s = table.numbers("s", Dimension::Length);
        s.iter().for_each(|&column| LENGTHS.check(&table, column));
        let mut last = f64::NEG_INFINITY;
        let row = |record| {
            let force = table.all(record, [forces[0]?, forces[1]?, forces[2]?]);
            let moment = moments.map(|column| column.map_or(Some(0.0), |column| table.number(record, column)));
            let s = s.map(|column| ascending(&table, record, column, &mut last));
            let (force, [x, y, z]) = (force?, [moment[0]?, moment[1]?, moment[2]?]);
            Some((Vector6::new(force[0], force[1], force[2], x, y, z), s.map_or(Some(None), |s| s.map(Some))?))
        };
        // Every row is checked before any gives the file up.
        let rows: Vec<_> = table.records.iter().map(row).collect();
        let rows: Option<Vec<_>> = rows.into_iter().collect();
        let number = |record: Option<&Record>| record.map_or(1, |record| record.line);
        let lines = Lines::new(text);
        let ends = [number(table.records.first()), number(table.records.last())];
        let ends = ends.map(|number| (number, lines.line(number).to_owned()));
        let (rows, warnings) = table.finish(rows)?;
        let (wrenches, s): (Vec<_>, Vec<Option<f64>>) = rows.into_iter().unzip();
        Ok(Self { file: file.to_owned(), s: s.into_iter().collect(), wrenches, warnings, ends })
    }

    /// The load along a path, by rows or between those nearest by arc length; the
    /// wrenches are along the axes of `frame`. Nothing acts in rapids. `axis` is that of the tool in the TCP's
    /// frame, from the spindle to the tip.
    ///
    /// # Errors
    /// A table that does not cover the path.
    pub fn load<const N: usize>(
        &self,
        path: &SolvedPath<N>,
        frame: ForceFrame,
        axis: Unit<Vector3<f64>>,
        surface: Surface,
    ) -> Result<Load, Diagnostics> {
        self.check(path)?;
        let mut undirected = Vec::new();
        let contacts = path.points.iter().enumerate().map(|(i, point)| {
            let mut contact = contact(point, axis, surface, 1.0);
            if point.rapid {
                return contact;
            }
            let turn = match (frame, &contact.frame) {
                (ForceFrame::Base, _) => Matrix3::identity(),
                (ForceFrame::Tool, _) => rotation(point),
                (ForceFrame::Cut, Some(frame)) => frame.matrix(),
                (ForceFrame::Cut, None) => {
                    undirected.push(point.line);
                    return contact;
                }
            };
            let wrench = self.s.as_ref().map_or(self.wrenches[i.min(self.wrenches.len() - 1)], |s| self.at(s, point.s));
            let (force, moment) = (turn * wrench.fixed_rows::<3>(0), turn * wrench.fixed_rows::<3>(3));
            contact.wrench = Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
            contact.turn = turn;
            contact
        });
        let contacts = contacts.collect();
        Ok(Load { contacts, revolution: Revolutions::None, undirected })
    }

    /// Holds the rows against those of a path.
    fn check<const N: usize>(&self, path: &SolvedPath<N>) -> Result<(), Diagnostics> {
        let [first, last] = &self.ends;
        let Some(s) = &self.s else {
            let (rows, points) = (self.wrenches.len(), path.points.len());
            let message = format!(
                "here {} {}, the path has {}",
                if rows == 1 { "is" } else { "are" },
                count(rows, "row"),
                count(points, "point")
            );
            let help = "give a row for each point, or the arc length of each row as `s [mm]`";
            return if rows == points { Ok(()) } else { Err(self.problem(last, message, help)) };
        };
        let of_path = path.points.iter().map(|point| point.s);
        let [from, to] = [f64::min, f64::max].map(|of| of_path.clone().reduce(of).unwrap_or(0.0));
        let mm = |length: f64| format!("{:.3} mm", length * 1e3);
        let help = format!("give forces for all of it, from {} to {}", mm(from), mm(to));
        if from < s[0] - SAME_LENGTH {
            let message = format!("the forces begin at s = {}, the path at {}", mm(s[0]), mm(from));
            return Err(self.problem(first, message, &help));
        }
        let end = s[s.len() - 1];
        if to > end + SAME_LENGTH {
            let message = format!("the forces end at s = {}, the path at {}", mm(end), mm(to));
            return Err(self.problem(last, message, &help));
        }
        Ok(())
    }

    /// A problem with a row, by its line and what that says.
    fn problem(&self, (number, text): &(usize, String), message: String, help: &str) -> Diagnostics {
        Diagnostic::of_line(&self.file, Line { number: *number, text }, message, help).into()
    }

    /// The wrench at an arc length, linear between rows.
    fn at(&self, s: &[f64], length: f64) -> Vector6<f64> {
        let after = s.partition_point(|&row| row < length);
        if after == 0 || after == s.len() {
            return self.wrenches[after.min(s.len() - 1)];
        }
        let part = (length - s[after - 1]) / (s[after] - s[after - 1]);
        self.wrenches[after - 1].lerp(&self.wrenches[after], part)
    }
}

fn ascending(table: &Table<'_>, record: &Record, column: Numbers, last: &mut f64) -> Option<f64> {
    let s = table.number(record, column)?;
    if s <= *last {
        table.report_number(
            record,
            column,
            "the arc length is not beyond that of the row before",
            "`s` is the length of the path so far, one row at a length",
        );
        return None;
    }
    *last = s;
    Some(s)
}
