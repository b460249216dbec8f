//! Programs, move by move.

use std::collections::VecDeque;
use std::path::Path;

use robstiff_robots::text::Lines;
use robstiff_robots::{Diagnostic, Diagnostics, Line};

use super::apt::Apt;
use super::gcode::GCode;
use super::moves::{Move, Options};
use super::notes::Notes;

/// Languages of programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// G-code.
    GCode,
    /// APT or CLDATA as text.
    Apt,
}

impl Format {
    /// The language of a file by the end of its name; `None` where it is no program.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "ngc" | "nc" | "tap" | "gcode" | "cnc" => Some(Self::GCode),
            "apt" | "cls" | "cl" => Some(Self::Apt),
            _ => None,
        }
    }
}

enum Language<'t> {
    GCode(Box<GCode<'t>>),
    Apt(Box<Apt<'t>>),
}

/// Reads a program, once from its beginning to its end. Each item is a move, or a problem of a line;
/// behind a problem reading goes on, until there are as many as anybody reads.
///
/// It holds the moves of one block, and the program's modal state.
pub struct Reader<'t> {
    file: &'t str,
    lines: &'t Lines<String>,
    number: usize,
    language: Language<'t>,
    moves: VecDeque<Move>,
    notes: Notes,
    problems: usize,
    is_done: bool,
}

impl<'t> Reader<'t> {
    /// A reader of a program's lines; `file` is the name that problems show.
    pub fn new(format: Format, file: &'t str, lines: &'t Lines<String>, options: &'t Options) -> Self {
        let language = match format {
            Format::GCode => Language::GCode(Box::new(GCode::new(options))),
            Format::Apt => Language::Apt(Box::new(Apt::new(options))),
        };
        let (moves, notes) = (VecDeque::new(), Notes::default());
        Self { file, lines, number: 0, language, moves, notes, problems: 0, is_done: false }
    }

    /// What was noticed so far without refusing the program.
    pub fn warnings(&self) -> Vec<String> {
        self.notes.warnings(self.file)
    }

    /// All moves, and what was noticed.
    ///
    /// # Errors
    /// Everything that is wrong with the program, each problem at its place.
    pub fn all(mut self) -> Result<(Vec<Move>, Vec<String>), Diagnostics> {
        let (mut moves, mut problems) = (Vec::new(), Vec::new());
        for each in &mut self {
            match each {
                Ok(each) if problems.is_empty() => moves.push(each),
                Ok(_) => {}
                Err(problem) => problems.push(problem),
            }
        }
        match Diagnostics::new(problems) {
            Some(problems) => Err(problems),
            None => Ok((moves, self.warnings())),
        }
    }
}

impl Iterator for Reader<'_> {
    type Item = Result<Move, Diagnostic>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(next) = self.moves.pop_front() {
                return Some(Ok(next));
            }
            if self.is_done {
                return None;
            }
            self.number += 1;
            let (number, moves, notes) = (self.number, &mut self.moves, &mut self.notes);
            let has_line = number <= self.lines.count();
            let read = match (&mut self.language, has_line) {
                (Language::GCode(reader), true) => {
                    let text = self.lines.line(number);
                    reader.line(number, text, moves, notes).map_err(|fault| (number, fault))
                }
                (Language::GCode(_), false) => Ok(false),
                (Language::Apt(reader), true) => reader.line(number, self.lines.line(number), moves, notes),
                (Language::Apt(reader), false) => reader.finish(moves, notes).map(|()| false),
            };
            match read {
                Ok(goes_on) => self.is_done = !goes_on,
                Err((number, fault)) => {
                    self.problems += 1;
                    self.is_done = !has_line || self.problems >= Diagnostics::MOST;
                    let line = Line { number, text: self.lines.line(number) };
                    return Some(Err(fault.diagnostic(self.file, line)));
                }
            }
        }
    }
}
