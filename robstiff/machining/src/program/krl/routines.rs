//! The routines of the files.

use std::ops::Range;

use crate::program::order::{Routine, Statement};
use crate::program::source::{self, Sources};

/// What begins a comment.
pub(super) const COMMENT: char = ';';

/// The lines of a file.
pub(super) fn lines(sources: &Sources, file: usize) -> impl Iterator<Item = Statement> {
    let lines = sources.lines(file);
    (1..=lines.count()).map(move |number| (file, lines.range(number)))
}

/// The bytes of a line before its comment.
pub(super) fn code(text: &str, bytes: Range<usize>) -> Range<usize> {
    source::code(text, bytes, COMMENT)
}

/// The routines of all files, in order; a `.dat` has none.
pub(super) fn routines(sources: &mut Sources) -> Vec<Routine> {
    let mut routines: Vec<Routine> = Vec::new();
    for file in 0..sources.count() {
        let is_data = sources.name(file).to_ascii_lowercase().ends_with(".dat");
        if is_data {
            continue;
        }
        let before = routines.len();
        let mut open: Option<Routine> = None;
        for (_, bytes) in lines(sources, file) {
            let mut cursor = sources.cursor(file, code(sources.text(file), bytes.clone()));
            if open.is_none() {
                cursor.eat_word("GLOBAL");
                let is_function = cursor.eat_word("DEFFCT");
                if is_function {
                    // The type of what it gives.
                    cursor.word();
                }
                if is_function || cursor.eat_word("DEF") {
                    let name = cursor.word().unwrap_or_default().to_owned();
                    open = Some(Routine { name, lines: Vec::new() });
                }
            } else if (cursor.eat_word("END") || cursor.eat_word("ENDFCT")) && cursor.is_done() {
                routines.extend(open.take());
            } else if let Some(routine) = &mut open {
                routine.lines.push((file, bytes));
            }
        }
        if let Some(routine) = open {
            let end = sources.text(file).trim_end().len();
            let message = format!("the routine `{}` does not end", routine.name);
            sources.report(file, end..end, message, "write `END` below its last line");
        } else if routines.len() == before {
            let first = sources.lines(file).range(1);
            let help = "a program begins with `DEF name( )` and ends with `END`";
            sources.report(file, first, "the file has no routine", help);
        }
    }
    routines
}
