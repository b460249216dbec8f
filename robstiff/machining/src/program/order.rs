//! The order in which the statements of routines run.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use super::source::{Sources, code};

/// A statement, which is a line: the file and the bytes, without the line end.
pub(super) type Statement = (usize, Range<usize>);

/// A routine: its name and its lines.
pub(super) struct Routine {
    pub(super) name: String,
    pub(super) lines: Vec<Statement>,
}

/// The lines of routines in the order in which they run, where a line that calls one has its name and `()` alone;
/// `comment` begins a comment.
pub(super) fn lines_in_order(sources: &Sources, routines: &[Routine], comment: char) -> Vec<Statement> {
    let all: Vec<(&str, &[Statement])> = routines.iter().map(|routine| (&*routine.name, &*routine.lines)).collect();
    in_order(&all, |(file, bytes)| {
        let mut cursor = sources.cursor(*file, code(sources.text(*file), bytes.clone(), comment));
        let name = cursor.word()?;
        (cursor.eat("(") && cursor.eat(")") && cursor.is_done()).then_some(name)
    })
}

/// The statements of routines (name, statements) in the order in which they run: a
/// routine that is called stands in place of its first call, and those that none
/// calls stand behind all. `called` gives the name of the routine that a statement
/// is a call of; names are the same in letters of either case.
pub(super) fn in_order<'t, S: Clone>(routines: &[(&str, &[S])], called: impl Fn(&S) -> Option<&'t str>) -> Vec<S> {
    let by_name: HashMap<String, usize> =
        routines.iter().enumerate().rev().map(|(i, (name, _))| (name.to_ascii_uppercase(), i)).collect();
    let (mut seen, mut statements) = (HashSet::new(), Vec::new());
    for first in 0..routines.len() {
        if !seen.insert(first) {
            continue;
        }
        // Calls may be nested as deep as the file likes.
        let mut stack = vec![(first, 0)];
        while let Some((routine, next)) = stack.pop() {
            let Some(statement) = routines[routine].1.get(next) else { continue };
            stack.push((routine, next + 1));
            let call = called(statement).and_then(|name| by_name.get(&name.to_ascii_uppercase()).copied());
            match call {
                Some(call) if seen.insert(call) => stack.push((call, 0)),
                _ => statements.push(statement.clone()),
            }
        }
    }
    statements
}
