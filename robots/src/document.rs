//! YAML documents that people write, read so that every problem is reported
//! with its line, its column and what would be right.
//!
//! A [`Document`] is walked with [`Node`]s. A check that fails records a
//! problem and gives `None`; the reader goes on, and [`Document::finish`] hands
//! out either the value or all the problems:
//!
//! ```
//! use robstiff_robots::document::Document;
//! use robstiff_robots::quantity::Dimension;
//!
//! let document = Document::parse("spindle.yaml", "name: HSC\nlength: 120 mn\n").unwrap();
//! let value = document.root().map(&["name", "length"]).and_then(|map| {
//!     let name = map.require("name", "name: HSC").and_then(|node| node.text());
//!     let length = map.require("length", "length: 120 mm").and_then(|node| node.quantity(Dimension::Length));
//!     Some((name?.to_owned(), length?))
//! });
//! let problems = document.finish(value).unwrap_err();
//! assert!(problems.to_string().starts_with("error: unknown unit `mn` for a length\n --> spindle.yaml:2:9  (length)"));
//! ```

mod content;
mod nesting;
mod node;

pub(crate) use content::Content;
pub(crate) use nesting::too_deep;
pub use node::{Map, Node};

use crate::diagnostic::{Diagnostic, Diagnostics, Line};
use content::{Step, extent, line_count, locate, source_line};
use nesting::MOST_NESTED;
use serde::Deserialize;
use std::cell::RefCell;

/// A YAML document and the problems found in it so far.
#[derive(Debug)]
pub struct Document {
    file: String,
    text: String,
    root: Content,
    /// Whether bare numbers are refused that are certainly in another unit than SI.
    wary: bool,
    problems: RefCell<Vec<Diagnostic>>,
}

impl Document {
    /// Reads a document; `file` is the name that problems show.
    ///
    /// # Errors
    /// What is not YAML, with its place.
    pub fn parse(file: &str, text: &str) -> Result<Self, Diagnostics> {
        let text = without_byte_order_mark(text);
        if let Some(place) = too_deep(text) {
            return Err(nested(file, text, place).into());
        }
        let root = Content::deserialize(serde_yaml::Deserializer::from_str(text));
        let root = root.map_err(|error| syntax_problem(file, text, &error))?;
        let (file, text) = (file.to_owned(), text.to_owned());
        let document = Self { file, text, root, wary: false, problems: RefCell::default() };
        document.root().check_keys();
        Ok(document)
    }

    /// The document, in which a number without a unit must be one that a robot
    /// can have in SI: in degrees or millimetres it is refused.
    #[must_use]
    pub fn wary(self) -> Self {
        Self { wary: true, ..self }
    }

    /// The document's top value.
    pub fn root(&self) -> Node<'_> {
        Node::root(self)
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

    fn report(&self, steps: &[Step], path: &str, content: &Content, message: String, help: String) {
        if self.problems.borrow().len() >= Diagnostics::MOST {
            return;
        }
        let (line, column, rest) = self.place(steps);
        let place = (column, extent(&rest, content));
        let problem = Diagnostic::new(&self.file, line, place, message, help);
        self.problems.borrow_mut().push(Diagnostic { path: path.to_owned(), ..problem });
    }

    /// The line and the column (from 1) of a part, and what stands in the line from there on.
    fn place(&self, steps: &[Step]) -> (Line<'_>, usize, String) {
        let (number, column) = locate(&self.text, steps);
        let (number, column) = within(&self.text, number, column);
        let line = Line { number, text: source_line(&self.text, number) };
        (line, column, line.text.chars().skip(column - 1).collect())
    }
}

/// The text as the parser wants it: it takes a mark for a document of its own.
pub(crate) fn without_byte_order_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// The line (from 1) at which a second document begins, behind the end of the
/// first if that is marked.
fn second_document(text: &str) -> Option<usize> {
    let is_marker = |line: &str| line.trim_end() == "..." || line.starts_with("... ");
    let begins = |line: &str| line.trim_end() == "---" || line.starts_with("--- ");
    let is_before = |line: &str| begins(line) || line.trim().is_empty() || line.starts_with(['#', '%']);
    let mut ended = false;
    let mut lines = text.lines().enumerate().skip_while(|(_, line)| is_before(line));
    let second = lines.find(|(_, line)| {
        let is_second = begins(line) || (ended && !is_before(line) && !is_marker(line));
        ended |= is_marker(line);
        is_second
    });
    second.map(|(index, _)| index + 1)
}

/// The line (from 1) that is indented less than the first one, which the parser takes for
/// a second document.
fn outdented(text: &str) -> Option<usize> {
    let says_something = |line: &str| !matches!(line.trim_start().chars().next(), None | Some('#' | '%'));
    let indent = |line: &str| line.len() - line.trim_start_matches(' ').len();
    let mut lines = text.lines().enumerate().filter(|(_, line)| says_something(line));
    let first = indent(lines.next()?.1);
    lines.find(|(_, line)| indent(line) < first).map(|(index, _)| index + 1)
}

/// Line and column of the byte that the parser tells in place of them, where it does: of
/// characters that no YAML may have.
fn place_of_byte(text: &str, message: &str) -> Option<(usize, usize)> {
    let before = text.get(..message.rsplit_once(" at position ")?.1.parse().ok()?)?;
    let line = before.rsplit('\n').next().unwrap_or_default();
    Some((1 + before.matches('\n').count(), 1 + line.chars().count()))
}

fn nested(file: &str, text: &str, (line, column): (usize, usize)) -> Diagnostic {
    Diagnostic::new(
        file,
        Line { number: line, text: text.lines().nth(line - 1).unwrap_or_default() },
        (column, 1),
        format!("this is nested more than {MOST_NESTED} deep"),
        "close every bracket; a list or a map of a document is in a few others at most",
    )
}

/// A place, or the end of the last line where the parser counts one more than there is.
fn within(text: &str, line: usize, column: usize) -> (usize, usize) {
    let lines = line_count(text);
    if line <= lines { (line, column) } else { (lines, 1 + source_line(text, lines).chars().count()) }
}

fn syntax_problem(file: &str, text: &str, error: &serde_yaml::Error) -> Diagnostic {
    let told = error.to_string();
    let place = place_of_byte(text, &told)
        .or_else(|| error.location().map(|at| (at.line(), at.column())))
        // The parser does not tell where a second document begins, nor what it takes for one.
        .or_else(|| Some((second_document(text)?, 1)));
    let outdented = if place.is_none() { outdented(text) } else { None };
    let (line, column) = place.or(outdented.map(|line| (line, 1))).unwrap_or((1, 1));
    // The place is shown on its own; a second place in the message is of use.
    let message = told.replacen(&format!(" at line {line} column {column}"), "", 1);
    let (line, column) = within(text, line, column);
    let at = source_line(text, line).chars().nth(column - 1);
    let message = match outdented {
        Some(_) => "this line is indented less than the first",
        None if at == Some('\t') => "a tab cannot stand here",
        None => message.split(" at position ").next().unwrap_or_default(),
    };
    Diagnostic::new(
        file,
        Line { number: line, text: source_line(text, line) },
        (column, 1),
        format!("this cannot be read as YAML: {message}"),
        "one document a file; indent with spaces, put a space after every `:`, close every bracket and quote",
    )
}
