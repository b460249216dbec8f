//! What is found wrong with a table, and what its reader is warned of.

use crate::{Diagnostic, Diagnostics, Line};

use super::extent::extent;
use super::header::Header;
use super::repeated::{Repeated, kind_of};
use super::{Numbers, Record, Table};

impl Table<'_> {
    /// Reports a problem with a field (by its index) of a line.
    pub fn report(&self, line: usize, field: usize, message: &str, help: &str) {
        let kind = kind_of(message);
        let mut problems = self.problems.borrow_mut();
        if let Some(alike) = problems.iter_mut().find(|known| known.field == field && known.kind == kind) {
            alike.take(|| self.problem(line, field, message, help), line);
        } else if problems.len() < Diagnostics::MOST {
            problems.push(Repeated::new(self.problem(line, field, message, help), field, kind));
        }
    }

    /// Reports a problem with the header as a whole.
    pub fn report_header(&self, message: &str, help: &str) {
        self.report(self.header_line, usize::MAX, message, help);
    }

    /// Reports a problem with a row in a column of numbers.
    pub fn report_number(&self, record: &Record, column: Numbers, message: &str, help: &str) {
        self.report(record.line, column.index, message, help);
    }

    /// Reports a problem with a column of numbers, at its header.
    pub fn report_column(&self, column: Numbers, message: &str, help: &str) {
        self.report(self.header_line, column.index, message, help);
    }

    /// Warns of something that is no problem for the reader.
    pub fn warn(&self, message: &str) {
        self.warnings.borrow_mut().push(format!("{}: {message}", self.file));
    }

    /// The column that was looked for in vain and that has this name up to its case.
    fn meant_by(&self, name: &str) -> Option<String> {
        self.absent.borrow().iter().find(|meant| meant.eq_ignore_ascii_case(name)).cloned()
    }

    /// Warns of columns that are called as one that was looked for, up to their case.
    pub fn warn_of_misspelt(&self) {
        for Header { name, .. } in &self.header {
            if let Some(meant) = self.meant_by(name) {
                self.warn(&format!("the column `{name}` is not used: write `{meant}` if it is that"));
            }
        }
    }

    /// What was warned of so far.
    pub fn noticed(&self) -> Vec<String> {
        self.warnings.borrow().clone()
    }

    pub(super) fn problem(&self, line: usize, field: usize, message: &str, help: &str) -> Diagnostic {
        let source_line = self.lines.line(line);
        let line = Line { number: line, text: source_line };
        Diagnostic::new(self.file, line, extent(source_line, self.form.separator, field), message, help)
    }

    /// What was read with the warnings, if no problem was found on the way.
    ///
    /// # Errors
    /// All the problems found.
    ///
    /// # Panics
    /// If there is neither a value nor a problem.
    pub fn finish<T>(self, value: Option<T>) -> Result<(T, Vec<String>), Diagnostics> {
        if let Some(problems) = Diagnostics::new(self.problems.take().into_iter().flat_map(Repeated::said).collect()) {
            return Err(problems);
        }
        let asked_for = self.asked_for.borrow();
        let unused = self.header.iter().enumerate().filter(|(i, _)| !asked_for.contains(i));
        let mut warnings = self.warnings.take();
        warnings.extend(unused.map(|(_, Header { name, .. })| {
            let ask = self.meant_by(name).map(|meant| format!(": write `{meant}` if it is that")).unwrap_or_default();
            format!("{}: the column `{name}` is not used{ask}", self.file)
        }));
        Ok((value.expect("a value was given up without a problem being reported"), warnings))
    }
}
