//! The functions of the files.

use std::ops::Range;

use crate::program::order::Routine;
use crate::program::source::{Sources, code};

/// What begins a comment.
pub(super) const COMMENT: char = '#';

/// A function that is not closed yet.
struct Open {
    routine: Routine,
    /// How many blocks are open in it.
    blocks: usize,
    line: Range<usize>,
}

/// The functions of all files: the one around all others first, and one that stands in another on its own.
pub(super) fn routines(sources: &mut Sources) -> Vec<Routine> {
    let mut routines: Vec<Routine> = Vec::new();
    for file in 0..sources.count() {
        let before = routines.len();
        let (mut open, mut closed): (Vec<Open>, Vec<(usize, Routine)>) = Default::default();
        let lines = sources.lines(file);
        for number in 1..=lines.count() {
            let bytes = lines.range(number);
            let mut cursor = sources.cursor(file, code(sources.text(file), bytes.clone(), COMMENT));
            let text = cursor.rest().trim_end();
            let closes_itself = text.split(|letter: char| !letter.is_alphanumeric()).next_back() == Some("end");
            match cursor.word().unwrap_or_default() {
                "def" | "thread" | "sec" => {
                    let name = cursor.word().unwrap_or_default().to_owned();
                    let routine = Routine { name, lines: Vec::new() };
                    open.push(Open { routine, blocks: 0, line: bytes });
                    continue;
                }
                "end" => match open.last_mut() {
                    Some(routine) if routine.blocks > 0 => routine.blocks -= 1,
                    Some(_) => {
                        closed.extend(open.pop().map(|open| (open.line.start, open.routine)));
                        continue;
                    }
                    None => continue,
                },
                "if" | "while" | "for" if !closes_itself => {
                    if let Some(routine) = open.last_mut() {
                        routine.blocks += 1;
                    }
                }
                _ => {}
            }
            if let Some(innermost) = open.last_mut() {
                innermost.routine.lines.push((file, bytes));
            }
        }
        closed.sort_by_key(|(start, _)| *start);
        routines.extend(closed.into_iter().map(|(_, routine)| routine));
        if let Some(Open { routine, line, .. }) = open.into_iter().next() {
            let message = format!("the function `{}` does not end", routine.name);
            sources.report(file, line, message, "write `end` below its last line");
        } else if routines.len() == before {
            let first = sources.lines(file).range(1);
            let help = "a program begins with `def name():` and ends with `end`";
            sources.report(file, first, "the file has no function", help);
        }
    }
    routines
}
