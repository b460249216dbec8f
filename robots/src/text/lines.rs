//! The lines of a text.

use std::ops::Range;

/// A text by its lines. They end at a line feed, at a carriage return, as some spreadsheets
/// write it alone, or at both; so do the rows of CSV and the lines of YAML.
///
/// Where they begin is looked up once: to find a place afterwards takes no pass over the text.
#[derive(Clone, Debug)]
pub struct Lines<T> {
    text: T,
    starts: Vec<usize>,
}

impl<T: AsRef<str>> Lines<T> {
    /// The lines of a text.
    pub fn new(text: T) -> Self {
        let bytes = text.as_ref().as_bytes();
        let ends = || {
            bytes.iter().enumerate().filter(|&(at, &byte)| match byte {
                b'\n' => true,
                b'\r' => bytes.get(at + 1) != Some(&b'\n'),
                _ => false,
            })
        };
        // A text may be nothing but line ends, and a vector that grows takes twice as much.
        let mut starts = Vec::with_capacity(1 + ends().count());
        starts.push(0);
        starts.extend(ends().map(|(at, _)| at + 1));
        Self { text, starts }
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        self.text.as_ref()
    }

    /// How many lines there are; behind a line end at the end is an empty one.
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// The line with this number, from 1, without its end; empty where there is none.
    pub fn line(&self, number: usize) -> &str {
        &self.text()[self.range(number)]
    }

    /// All lines, in order.
    pub fn all(&self) -> impl Iterator<Item = &str> {
        (1..=self.count()).map(|number| self.line(number))
    }

    /// The bytes of the line with this number, from 1, without its end.
    pub fn range(&self, number: usize) -> Range<usize> {
        let start = |index: usize| self.starts.get(index).copied().unwrap_or(self.text().len());
        let start = start(number.saturating_sub(1))..start(number);
        let line = self.text()[start.clone()].trim_end_matches(['\r', '\n']);
        start.start..start.start + line.len()
    }

    /// The number, from 1, of the line that a byte is in.
    pub fn number_at(&self, byte: usize) -> usize {
        self.starts.partition_point(|&start| start <= byte)
    }

    /// The line that a byte is in and the column of the byte there, in characters, both from 1.
    pub fn place(&self, byte: usize) -> (usize, usize) {
        let number = self.number_at(byte);
        (number, 1 + self.text()[self.starts[number - 1]..byte].chars().count())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_in_three_ways() {
        for end in ["\n", "\r\n", "\r"] {
            let text = ["a", "", "b", ""].join(end);
            let lines = Lines::new(&text);
            assert_eq!([1, 2, 3, 4, 5].map(|number| lines.line(number)), ["a", "", "b", "", ""], "{end:?}");
            assert_eq!([0, 1, 1 + end.len()].map(|byte| lines.number_at(byte)), [1, 1, 2], "{end:?}");
            assert_eq!(lines.count(), 4);
        }
    }

    #[test]
    fn columns_are_characters() {
        let lines = Lines::new("ä: 1\nöü: 2");
        assert_eq!(lines.place("ä: 1\nöü".len()), (2, 3));
        assert_eq!(lines.place(lines.text().len()), (2, 6));
        assert_eq!(Lines::new("").place(0), (1, 1));
    }
}
