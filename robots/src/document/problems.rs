//! A document, and what is found to be wrong with it.

use std::cell::RefCell;

use super::content::{Content, width};
use crate::diagnostic::{Diagnostic, Diagnostics, Line};
use crate::text::Lines;

/// A YAML document and the problems found in it so far.
#[derive(Debug)]
pub struct Document {
    file: String,
    pub(super) lines: Lines<String>,
    pub(super) root: Content,
    /// Whether bare numbers are refused that are certainly in another unit than SI.
    pub(super) wary: bool,
    problems: RefCell<Vec<Diagnostic>>,
}

impl Document {
    /// A document in which no problem is found yet.
    pub(super) fn new(file: &str, text: &str, root: Content) -> Self {
        let (file, lines) = (file.to_owned(), Lines::new(text.to_owned()));
        Self { file, lines, root, wary: false, problems: RefCell::default() }
    }

    /// The document, in which a number without a unit must be one that a robot
    /// can have in SI: in degrees or millimetres it is refused.
    #[must_use]
    pub fn wary(self) -> Self {
        Self { wary: true, ..self }
    }

    /// The value that was read, if no problem was found on the way.
    ///
    /// # Errors
    /// All the problems found, in the order of the file.
    ///
    /// # Panics
    /// If there is neither a value nor a problem: whoever gives up on a value
    /// must have reported why.
    pub fn finish<T>(self, value: Option<T>) -> Result<T, Diagnostics> {
        match Diagnostics::new(self.problems.into_inner()) {
            Some(problems) => Err(problems),
            None => Ok(value.expect("a value was given up without a problem being reported")),
        }
    }

    /// Whether as many problems are recorded as anybody reads: what is said of more is not even
    /// put into words.
    pub(super) fn is_full(&self) -> bool {
        self.problems.borrow().len() >= Diagnostics::MOST
    }

    pub(super) fn report(&self, content: &Content, path: String, message: String, help: String) {
        if self.is_full() {
            return;
        }
        let (number, column) = self.lines.place(content.at.start);
        let line = Line { number, text: self.lines.line(number) };
        let place = (column, width(self.rest_of_line(content), content));
        let problem = Diagnostic::new(&self.file, line, place, message, help).at(path);
        self.problems.borrow_mut().push(problem);
    }

    /// What stands in the line of a part from there on.
    pub(super) fn rest_of_line(&self, content: &Content) -> &str {
        let start = content.at.start;
        let end = self.lines.range(self.lines.number_at(start)).end;
        &self.lines.text()[start..end.max(start)]
    }
}
