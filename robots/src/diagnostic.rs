//! Problems in a file a person wrote, shown where they are and with what would
//! be right.

use std::fmt;

use crate::text::shown::{is_bidirectional, shown_in_line};

/// One problem, with its place in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The file's name as it is to be shown.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
    /// How many characters the problem covers in its line; shown as at least 1.
    pub width: usize,
    /// The path inside the document, e.g. `joints[1].theta`; empty where there
    /// is none. Of a long one its beginning.
    pub path: String,
    /// What is wrong; of a long message, which quotes the file, its beginning.
    pub message: String,
    /// What would be right; empty where nothing can be said. Of a long text its beginning.
    pub help: String,
    /// The line of the file the problem is in, without its line break; of a long line what is
    /// about the problem, between `..`.
    pub source_line: String,
    /// How many characters of `source_line` are before the problem.
    before: usize,
}

/// A line of a file.
#[derive(Clone, Copy, Debug)]
pub struct Line<'t> {
    /// Its number, from 1.
    pub number: usize,
    /// What it says, without its line break.
    pub text: &'t str,
}

impl Diagnostic {
    /// A problem with a part of a line: with as many characters as `width` from
    /// `column` (from 1) on. It has no path inside the document.
    pub fn new(
        file: impl Into<String>,
        line: Line<'_>,
        (column, width): (usize, usize),
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        // A hundred problems in one line of megabytes are not to hold it a hundred times.
        let (source_line, before) = around(line.text, column.saturating_sub(1));
        Self {
            file: file.into(),
            line: line.number,
            column,
            width,
            path: String::new(),
            message: beginning(message.into(), LONGEST),
            help: beginning(help.into(), LONGEST_HELP),
            source_line,
            before,
        }
    }

    /// The same with a path inside the document.
    #[must_use]
    pub fn at(self, path: impl Into<String>) -> Self {
        Self { path: beginning(path.into(), LONGEST), ..self }
    }

    /// A problem with a whole line.
    pub fn of_line(
        file: impl Into<String>,
        line: Line<'_>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self::new(file, line, (1, line.text.chars().count()), message, help)
    }
}

/// How many columns a terminal gives to a character; an approximation that
/// keeps carets in place behind accents, Greek, CJK text and emoji.
fn columns(character: char) -> usize {
    match u32::from(character) {
        0x0300..=0x036f | 0x200b..=0x200f | 0xfe00..=0xfe0f => 0,
        0x1100..=0x115f
        | 0x2e80..=0xa4cf
        | 0xac00..=0xd7a3
        | 0xf900..=0xfaff
        | 0xfe30..=0xfe6f
        | 0xff00..=0xff60
        | 0xffe0..=0xffe6
        | 0x1f300..=0x1faff
        | 0x20000..=0x3fffd => 2,
        _ => 1,
    }
}

/// The text as shown: tabs as four spaces, since their width is the terminal's
/// own; control characters, which could move its cursor, replaced; what turns the direction of
/// writing spelled out.
fn shown(text: impl Iterator<Item = char>) -> String {
    let mut line = String::new();
    for character in text {
        match character {
            '\t' => line.push_str("    "),
            turn if is_bidirectional(turn) => line.extend(turn.escape_unicode()),
            control if control.is_control() => line.push('\u{fffd}'),
            other => line.push(other),
        }
    }
    line
}

/// The longest line that is shown whole, and the longest message, in characters: more of
/// a table's row or of a list that somebody's program wrote fills a terminal.
const LONGEST: usize = 240;

/// The longest help, in characters: all kinds of effects and all units are less.
const LONGEST_HELP: usize = 2000;

/// How much is shown before the place in a line of which only a part is.
const BEFORE: usize = 80;

/// A line, or of a long one what is about the `column` (from 0), and the column in that.
fn around(line: &str, column: usize) -> (String, usize) {
    // Fewer bytes are fewer characters.
    let count = if line.len() <= LONGEST { 0 } else { line.chars().count() };
    if count <= LONGEST {
        return (line.to_owned(), column);
    }
    let from = column.saturating_sub(BEFORE).min(count - LONGEST);
    let (before, behind) = (if from > 0 { ".. " } else { "" }, if from + LONGEST < count { " .." } else { "" });
    let part: String = line.chars().skip(from).take(LONGEST).collect();
    (format!("{before}{part}{behind}"), column - from + before.len())
}

/// A text, or of one with more characters than `most` its beginning.
fn beginning(text: String, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => text[..end].to_owned() + " ..",
        None => text,
    }
}

fn shown_columns(text: impl Iterator<Item = char>) -> usize {
    shown(text).chars().map(columns).sum()
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, line, column, width, path, message, help, source_line, before } = self;
        let gutter = line.to_string().len();
        let indent = shown_columns(source_line.chars().take(*before));
        let carets = shown_columns(source_line.chars().skip(*before).take(*width)).max(1);
        // They quote the file, too.
        let [message, help] = [message, help].map(|text| shown(text.chars()));
        write!(f, "error: {message}\n{:gutter$}--> {}:{line}:{column}", "", shown_in_line(file))?;
        if !path.is_empty() {
            write!(f, "  ({})", shown_in_line(path))?;
        }
        let text = shown(source_line.chars());
        write!(f, "\n{:gutter$} |\n{line} | {}", "", text.trim_end())?;
        write!(f, "\n{:gutter$} | {:indent$}{}", "", "", "^".repeat(carets))?;
        if !help.is_empty() {
            write!(f, "\n{:gutter$} |\n{:gutter$} = help: {help}", "", "")?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostic {}

/// All the problems of a file: at least one, in the order of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics {
    problems: Vec<Diagnostic>,
    may_be_more: bool,
}

impl Diagnostics {
    /// Readers record no more problems than these: nobody reads them, and a column that is wrong
    /// is wrong in every row.
    pub const MOST: usize = 100;

    /// The problems in the order of the file, each said once; `None` if there
    /// are none.
    pub fn new(mut problems: Vec<Diagnostic>) -> Option<Self> {
        // Of as many as these, before repetitions are dropped, a reader may have lost some.
        let may_be_more = problems.len() >= Self::MOST;
        problems.sort_by_key(|problem| (problem.line, problem.column));
        // What an anchor holds is checked wherever an alias repeats it.
        problems.dedup_by(|b, a| (a.line, a.column, &a.message) == (b.line, b.column, &b.message));
        (!problems.is_empty()).then_some(Self { problems, may_be_more })
    }

    /// The problems, in the order of the file.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.problems.iter()
    }

    /// Whether the file may have more problems than these: the reader found as many as it
    /// [records](Self::MOST).
    pub fn may_be_more(&self) -> bool {
        self.may_be_more
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(problem: Diagnostic) -> Self {
        Self { problems: vec![problem], may_be_more: false }
    }
}

impl<'d> IntoIterator for &'d Diagnostics {
    type Item = &'d Diagnostic;
    type IntoIter = std::slice::Iter<'d, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// Every problem as a compiler would show it, an empty line between two.
impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.iter().enumerate() {
            if index > 0 {
                f.write_str("\n\n")?;
            }
            problem.fmt(f)?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}

#[cfg(test)]
mod tests {
    use super::*;

    fn diagnostic(source_line: &str, column: usize, width: usize) -> Diagnostic {
        Diagnostic::new("loads.csv", Line { number: 12, text: source_line }, (column, width), "not a number", "")
    }

    fn carets(source_line: &str, column: usize, width: usize) -> String {
        diagnostic(source_line, column, width).to_string().lines().last().unwrap().to_owned()
    }

    #[test]
    fn of_a_long_line_the_part_is_shown_that_matters() {
        let row = format!("{}abc,{}", "1.25,".repeat(1000), "3.5,".repeat(1000));
        let told = diagnostic(&row, 5001, 3).to_string();
        let lines: Vec<&str> = told.lines().collect();
        assert!(lines.iter().all(|line| line.chars().count() < 260), "{told}");
        assert!(told.contains("--> loads.csv:12:5001"), "{told}");
        let caret = lines[4].find('^').expect("a caret");
        assert_eq!(&lines[3][caret..caret + 4], "abc,");
        assert!(lines[3].starts_with("12 | .. ") && lines[3].ends_with(" .."), "{told}");
        let first = diagnostic(&row, 1, 4).to_string();
        assert!(first.lines().nth(3).is_some_and(|line| line.starts_with("12 | 1.25,")), "{first}");
        let long = "x".repeat(1000);
        let line = Line { number: 1, text: "1" };
        let quoting = Diagnostic::new("loads.csv", line, (1, 1), &*long, "").at(&*long).to_string();
        assert!(quoting.lines().all(|line| line.len() < 280), "{quoting}");
    }

    #[test]
    fn shows_file_line_and_carets() {
        assert_eq!(
            diagnostic("1,abc,3", 3, 3).to_string(),
            "error: not a number\n  --> loads.csv:12:3\n   |\n12 | 1,abc,3\n   |   ^^^"
        );
    }

    #[test]
    fn carets_stay_in_place_behind_tabs_and_wide_characters() {
        assert_eq!(carets("\t1,abc", 4, 3), "   |       ^^^");
        assert_eq!(carets("µ,é,x", 5, 1), "   |     ^");
        assert_eq!(carets("机器,x", 4, 1), "   |      ^");
        assert_eq!(carets("e\u{301},x", 4, 1), "   |   ^");
    }

    #[test]
    fn a_place_beyond_the_line_still_shows_a_caret() {
        assert_eq!(carets("ab", 9, 4), "   |   ^");
        assert_eq!(carets("", 0, 0), "   | ^");
    }

    /// Of a hundred problems in a line of megabytes none holds the line.
    #[test]
    fn a_problem_holds_what_it_shows() {
        let (line, name) = ("x,".repeat(1 << 20), "y".repeat(1 << 20));
        let line = Line { number: 1, text: &line };
        let problem = Diagnostic::new("loads.csv", line, (1 << 20, 1), &*name, &*name).at(&*name);
        let held = [&problem.message, &problem.help, &problem.path, &problem.source_line].map(String::len);
        assert!(held.iter().sum::<usize>() < 4000, "{held:?}");
    }

    /// A number may read as another one, and a caret is where it is.
    #[test]
    fn what_turns_the_direction_of_writing_is_spelled_out() {
        let line = Line { number: 1, text: "1\u{202e}21,x" };
        let told = Diagnostic::new("a\u{2066}\nb.csv", line, (6, 1), "`1\u{202e}21` is no number", "").to_string();
        assert_eq!(
            told,
            "error: `1\\u{202e}21` is no number\n --> a\\u{2066}\u{fffd}b.csv:1:6\n  |\n1 | 1\\u{202e}21,x\n  |             ^"
        );
    }

    #[test]
    fn the_order_is_the_files_and_repetitions_are_dropped() {
        let (late, early) = (diagnostic("1,2,3", 5, 1), diagnostic("1,2,3", 1, 1));
        let all = Diagnostics::new(vec![late.clone(), early.clone(), late.clone()]).unwrap();
        assert_eq!(all.iter().collect::<Vec<_>>(), [&early, &late]);
        assert_eq!(Diagnostics::new(Vec::new()), None);
    }

    #[test]
    fn repetitions_do_not_hide_that_there_may_be_more() {
        let all = |count: usize| {
            let problems = (1..=count).map(|column| diagnostic("1,2,3", column.div_ceil(2), 1));
            Diagnostics::new(problems.collect()).unwrap()
        };
        assert!(!all(Diagnostics::MOST - 1).may_be_more());
        let repeated = all(Diagnostics::MOST);
        assert_eq!((repeated.iter().count(), repeated.may_be_more()), (Diagnostics::MOST / 2, true));
    }
}
