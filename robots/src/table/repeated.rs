//! Problems that many rows have are said once, with their count and their lines.

use crate::Diagnostic;
use crate::words::count;

/// So many of a kind are said one by one.
const ONE_BY_ONE: usize = 2;

/// So many of one line: columns that the header lacks are each another problem.
const IN_A_LINE: usize = 12;

/// So many ranges of lines are listed.
const RANGES: usize = 6;

/// Problems of one kind in one column.
pub struct Repeated {
    /// The column, by its index.
    pub field: usize,
    /// What they have in common.
    pub kind: String,
    /// The first of them.
    first: Vec<Diagnostic>,
    /// The lines of all others, in order, each once.
    others: Vec<usize>,
}

/// A message without what it quotes and without its numbers.
pub fn kind_of(message: &str) -> String {
    let outside = message.split('`').step_by(2).collect::<Vec<_>>().join("`");
    outside.chars().filter(|character| !character.is_ascii_digit()).collect()
}

impl Repeated {
    /// One problem.
    pub fn new(problem: Diagnostic, field: usize, kind: String) -> Self {
        Self { field, kind, first: vec![problem], others: Vec::new() }
    }

    /// One more of the kind.
    pub fn take(&mut self, problem: impl FnOnce() -> Diagnostic, line: usize) {
        let of_one_line = self.first.iter().all(|problem| problem.line == line);
        if self.first.len() < if of_one_line { IN_A_LINE } else { ONE_BY_ONE } {
            self.first.push(problem());
        } else if self.others.last() != Some(&line) {
            self.others.push(line);
        }
    }

    /// The problems as they are said: one by one, or the first with the count and the lines of the
    /// others.
    pub fn said(mut self) -> Vec<Diagnostic> {
        if self.others.is_empty() {
            return self.first;
        }
        let more = self.first.drain(1..).map(|problem| problem.line);
        let mut lines: Vec<usize> = more.chain(self.others).collect();
        lines.sort_unstable();
        lines.dedup();
        let more = format!("and {} more {} like it: {}", lines.len(), plural(lines.len()), ranges(&lines));
        let mut problem = self.first.remove(0);
        problem.help = if problem.help.is_empty() { more } else { format!("{}; .. {more}", problem.help) };
        vec![problem]
    }
}

fn plural(rows: usize) -> &'static str {
    if rows == 1 { "row" } else { "rows" }
}

/// `lines 7-125, 130 and 12 more`.
fn ranges(lines: &[usize]) -> String {
    let mut ranges: Vec<[usize; 2]> = Vec::new();
    for &line in lines {
        match ranges.last_mut() {
            Some([_, last]) if *last + 1 == line => *last = line,
            _ => ranges.push([line; 2]),
        }
    }
    let one = |&[first, last]: &[usize; 2]| match last - first {
        0 => format!("{first}"),
        1 => format!("{first}, {last}"),
        _ => format!("{first}-{last}"),
    };
    let said: Vec<String> = ranges.iter().take(RANGES).map(one).collect();
    let rest: usize = ranges.iter().skip(RANGES).map(|[first, last]| last - first + 1).sum();
    let rest = if rest > 0 { format!(" and {}", count(rest, "other line")) } else { String::new() };
    let lead = if lines.len() == 1 { "line" } else { "lines" };
    format!("{lead} {}{rest}", said.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_told_in_ranges() {
        assert_eq!(ranges(&[7]), "line 7");
        assert_eq!(ranges(&[7, 8]), "lines 7, 8");
        assert_eq!(ranges(&(7..=125).collect::<Vec<_>>()), "lines 7-125");
        assert_eq!(ranges(&[1, 3, 5, 7, 9, 11, 13, 14]), "lines 1, 3, 5, 7, 9, 11 and 2 other lines");
    }

    #[test]
    fn kinds_are_without_quotations_and_numbers() {
        assert_eq!(kind_of("`n/a` is not a number"), kind_of("`x` is not a number"));
        assert_eq!(kind_of("pose `1` has another q3 in line 4"), kind_of("pose `2` has another q3 in line 90"));
        assert_ne!(kind_of("`1` is not finite"), kind_of("`1` is not a number"));
    }
}
