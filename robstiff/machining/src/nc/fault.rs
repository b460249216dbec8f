//! A problem in a line, before it is known which line that is.

use robstiff_robots::{Diagnostic, Line};

/// What is wrong with a part of a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Where it begins, in bytes.
    pub at: usize,
    /// How many bytes it has.
    pub width: usize,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
}

impl Fault {
    /// A problem with one character.
    pub fn new(line: &str, at: usize, message: impl Into<String>, help: impl Into<String>) -> Self {
        let width = line.get(at..).and_then(|rest| rest.chars().next()).map_or(1, char::len_utf8);
        Self { at, width, message: message.into(), help: help.into() }
    }

    /// A problem with a whole line.
    pub fn whole(line: &str, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { at: 0, width: line.len(), message: message.into(), help: help.into() }
    }

    /// The problem with its place in a file.
    pub fn diagnostic(self, file: &str, line: Line<'_>) -> Diagnostic {
        let characters =
            |from: usize, to: usize| line.text.get(from..to).map_or(to - from, |part| part.chars().count());
        let end = (self.at + self.width).min(line.text.len()).max(self.at);
        let place = (1 + characters(0, self.at), characters(self.at, end));
        Diagnostic::new(file, line, place, self.message, self.help)
    }
}
