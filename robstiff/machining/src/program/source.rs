//! The texts of a program while they are read: words and numbers with their places,
//! and what is wrong with them.

use std::ops::Range;

use robstiff_robots::text::Lines;
use robstiff_robots::{Diagnostic, Diagnostics, Line};

use super::TextFile;

/// The files of a program and what was found to be wrong with them.
pub(super) struct Sources {
    files: Vec<(String, Lines<String>)>,
    problems: Vec<Diagnostic>,
}

impl Sources {
    pub(super) fn new(files: Vec<TextFile>) -> Self {
        let files = files.into_iter().map(|file| (file.name, Lines::new(file.text))).collect();
        Self { files, problems: Vec::new() }
    }

    pub(super) fn count(&self) -> usize {
        self.files.len()
    }

    pub(super) fn name(&self, file: usize) -> &str {
        &self.files[file].0
    }

    pub(super) fn lines(&self, file: usize) -> &Lines<String> {
        &self.files[file].1
    }

    pub(super) fn text(&self, file: usize) -> &str {
        self.files[file].1.text()
    }

    /// The number of the line, from 1, that a byte of a file is in.
    pub(super) fn line_at(&self, file: usize, byte: usize) -> usize {
        self.files[file].1.number_at(byte)
    }

    /// A cursor over some bytes of a file.
    pub(super) fn cursor(&self, file: usize, bytes: Range<usize>) -> Cursor<'_> {
        Cursor { text: self.text(file), at: bytes.start, end: bytes.end }
    }

    /// Reports a problem with some bytes of a file.
    pub(super) fn report(
        &mut self,
        file: usize,
        bytes: Range<usize>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        if self.problems.len() >= Diagnostics::MOST {
            return;
        }
        let (name, lines) = &self.files[file];
        let (number, column) = lines.place(bytes.start);
        let end = bytes.end.min(lines.range(number).end).max(bytes.start);
        // A byte may be the first of a letter.
        let width = lines.text().get(bytes.start..end).map_or(1, |text| text.chars().count());
        let line = Line { number, text: lines.line(number) };
        self.problems.push(Diagnostic::new(name.as_str(), line, (column, width), message, help));
    }

    /// The files again, if nothing is wrong with them.
    pub(super) fn finish(self) -> Result<Vec<TextFile>, Diagnostics> {
        match Diagnostics::new(self.problems) {
            Some(problems) => Err(problems),
            None => Ok(self
                .files
                .into_iter()
                .map(|(name, lines)| TextFile { name, text: lines.text().to_owned() })
                .collect()),
        }
    }
}

/// The bytes of a line before its comment, which a character begins outside of quotes.
pub(super) fn code(text: &str, bytes: Range<usize>, comment: char) -> Range<usize> {
    let mut quoted = false;
    let found = text[bytes.clone()].char_indices().find(|&(_, letter)| {
        quoted ^= letter == '"';
        letter == comment && !quoted
    });
    bytes.start..found.map_or(bytes.end, |(at, _)| bytes.start + at)
}

/// A place in a text, and how far it may go.
#[derive(Clone, Copy)]
pub(super) struct Cursor<'t> {
    text: &'t str,
    pub(super) at: usize,
    end: usize,
}

impl<'t> Cursor<'t> {
    /// What is left, without the space before it.
    pub(super) fn rest(&self) -> &'t str {
        self.text[self.at..self.end].trim_start()
    }

    pub(super) fn is_done(&self) -> bool {
        self.rest().is_empty()
    }

    pub(super) fn skip_space(&mut self) {
        self.at = self.end - self.rest().len();
    }

    pub(super) fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    /// Goes behind this text, in letters of either case, if it is next.
    pub(super) fn eat(&mut self, text: &str) -> bool {
        let rest = self.rest();
        let found = rest.get(..text.len()).is_some_and(|start| start.eq_ignore_ascii_case(text));
        if found {
            self.at = self.end - rest.len() + text.len();
        }
        found
    }

    /// Goes behind this word, if the next word is this one.
    pub(super) fn eat_word(&mut self, word: &str) -> bool {
        let mut ahead = *self;
        let found = ahead.word().is_some_and(|found| found.eq_ignore_ascii_case(word));
        if found {
            *self = ahead;
        }
        found
    }

    /// The next word: letters, digits, `_`, `$`, and it does not begin with a digit.
    pub(super) fn word(&mut self) -> Option<&'t str> {
        let rest = self.rest();
        if rest.starts_with(|first: char| first.is_ascii_digit()) {
            return None;
        }
        let of_word = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '$';
        let length = rest.find(|letter| !of_word(letter)).unwrap_or(rest.len());
        if length == 0 {
            return None;
        }
        self.at = self.end - rest.len() + length;
        Some(&rest[..length])
    }

    /// The next number, and its bytes.
    pub(super) fn number(&mut self) -> Option<(f64, Range<usize>)> {
        let rest = self.rest();
        let bytes = rest.as_bytes();
        let mut length = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
        let digits =
            |from: usize| bytes[from.min(bytes.len())..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        let whole = digits(length);
        length += whole;
        let mut any = whole > 0;
        if bytes.get(length) == Some(&b'.') {
            let fraction = digits(length + 1);
            any |= fraction > 0;
            length += 1 + fraction;
        }
        if !any {
            return None;
        }
        if matches!(bytes.get(length), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
            let exponent = digits(length + 1 + sign);
            if exponent > 0 {
                length += 1 + sign + exponent;
            }
        }
        let value = rest[..length].trim_end_matches('.').parse().ok().filter(|value: &f64| value.is_finite())?;
        let start = self.end - rest.len();
        self.at = start + length;
        Some((value, start..self.at))
    }

    /// Up to the next of these characters, which it stays before, or the end.
    pub(super) fn until(&mut self, stops: &[char]) -> &'t str {
        let rest = &self.text[self.at..self.end];
        let length = rest.find(stops).unwrap_or(rest.len());
        self.at += length;
        &rest[..length]
    }
}
