//! The lines of a table, and where its fields are in them.

/// A text by its lines. They end where the reader of CSV ends its rows: at a line feed, at
/// a carriage return, as some spreadsheets write it alone, or at both.
pub struct Lines<'t> {
    text: &'t str,
    starts: Vec<usize>,
}

impl<'t> Lines<'t> {
    /// The lines of a text.
    pub fn new(text: &'t str) -> Self {
        let bytes = text.as_bytes();
        let ends = bytes.iter().enumerate().filter(|&(at, &byte)| match byte {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        });
        let starts = [0].into_iter().chain(ends.map(|(at, _)| at + 1)).collect();
        Self { text, starts }
    }

    /// The line with this number, from 1, without its end; empty where there is none.
    pub fn line(&self, number: usize) -> &'t str {
        let start = |number: usize| self.starts.get(number).copied().unwrap_or(self.text.len());
        self.text[start(number - 1)..start(number)].trim_end_matches(['\r', '\n'])
    }

    /// All lines, in order.
    pub fn all(&self) -> impl Iterator<Item = &'t str> {
        (1..=self.starts.len()).map(|number| self.line(number))
    }

    /// The number of the line, from 1, of what comes first from a byte on. Where a reader
    /// began to look for a row is before the empty lines that it skips.
    pub fn number_at(&self, byte: usize) -> usize {
        let rest = self.text.as_bytes().iter().skip(byte);
        let begins = byte + rest.take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
        self.starts.partition_point(|&start| start <= begins)
    }
}

/// Where a field is in its line: its column in characters from 1, and its
/// width.
pub fn extent(line: &str, field: usize) -> (usize, usize) {
    let (mut quoted, mut index, mut column, mut width) = (false, 0, 1, 0);
    let mut before = None;
    for (i, character) in line.chars().enumerate() {
        match character {
            '"' if quoted => quoted = false,
            // In the middle of a field a quote is a character; two are one.
            '"' => quoted = width == 0 || before == Some('"'),
            ',' if !quoted => {
                if index == field {
                    break;
                }
                index += 1;
                (column, width, before) = (i + 2, 0, None);
                continue;
            }
            _ => {}
        }
        width += 1;
        before = Some(character);
    }
    if index < field { (1, line.chars().count()) } else { (column, width) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_found_in_their_line() {
        assert_eq!(extent("1,abc,3", 1), (3, 3));
        assert_eq!(extent("\"a,b\",x", 1), (7, 1));
        assert_eq!(extent("\"a\"\",b\",x", 1), (9, 1));
        assert_eq!(extent("3\" pipe,x", 1), (9, 1));
        assert_eq!(extent("1,\"2,3", 1), (3, 4));
        assert_eq!(extent("1,2", 5), (1, 3));
    }

    #[test]
    fn lines_end_as_rows_do() {
        for end in ["\n", "\r\n", "\r"] {
            let text = ["a", "", "b", ""].join(end);
            let lines = Lines::new(&text);
            assert_eq!([1, 2, 3, 4, 5].map(|number| lines.line(number)), ["a", "", "b", "", ""], "{end:?}");
            assert_eq!((lines.number_at(0), lines.number_at(1)), (1, 3), "{end:?}");
        }
    }
}
