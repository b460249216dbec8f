//! The order in which the statements of routines run.

use std::collections::{HashMap, HashSet};

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
