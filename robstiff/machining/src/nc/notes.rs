//! What a reader noticed without refusing the program.

use std::collections::BTreeMap;

/// What a warning is about.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Note {
    /// No unit of length is named.
    Unit,
    /// Lines that begin with `/`.
    Deletable,
    /// An M code that no table has.
    Function(u32),
    /// A word of APT that changes nothing here.
    Statement(String),
    /// Moves to a place of the machine, by the code in tenths.
    Home(u32),
    /// Feeds before a position is known.
    Before,
    /// Something after the end of the program.
    Behind,
    /// Several work offsets, none of which is given.
    Offset(&'static str),
    /// Arcs of more than half a turn from a circle of which only the axis says the direction.
    LongArc,
}

/// Warnings with their lines.
#[derive(Clone, Debug, Default)]
pub struct Notes {
    noted: BTreeMap<Note, Vec<[usize; 2]>>,
}

/// Kinds of warnings that are kept apart; a file may have any number of unknown codes.
const MOST_NOTES: usize = 100;

/// Runs of lines that a warning names.
const MOST_RUNS: usize = 10;

impl Notes {
    /// Notes a line (from 1).
    pub fn add(&mut self, note: Note, line: usize) {
        if self.noted.len() >= MOST_NOTES && !self.noted.contains_key(&note) {
            return;
        }
        let runs = self.noted.entry(note).or_default();
        match runs.last_mut() {
            Some([_, last]) if line <= *last + 1 => *last = line.max(*last),
            _ => runs.push([line; 2]),
        }
    }

    /// Notes a line behind the end of the program, unless it says nothing; whether reading goes on.
    pub fn behind(&mut self, says_nothing: bool, line: usize) -> bool {
        if !says_nothing {
            self.add(Note::Behind, line);
        }
        says_nothing
    }

    /// The warnings of a file.
    pub fn warnings(&self, file: &str) -> Vec<String> {
        let mut warnings: Vec<String> =
            self.noted.iter().map(|(note, runs)| format!("{file}: {}", note.sentence(&lines(runs)))).collect();
        if self.noted.len() >= MOST_NOTES {
            warnings.push(format!("{file}: there may be more that is not known"));
        }
        warnings
    }
}

impl Note {
    fn sentence(&self, at: &str) -> String {
        let code = |tenths: &u32| match tenths % 10 {
            0 => format!("{}", tenths / 10),
            tenth => format!("{}.{tenth}", tenths / 10),
        };
        match self {
            Self::Unit => format!("no unit is named before {at}: lengths are taken in mm"),
            Self::Deletable => format!("{at} with `/` in front: taken, as by a machine whose switch for it is off"),
            Self::Function(tenths) => format!("M{} on {at} is not known and changes nothing here", code(tenths)),
            Self::Statement(word) => format!("{word} on {at} is not known and changes nothing here"),
            Self::Home(tenths) => format!(
                "G{} on {at} goes to a place of the machine that is not known: the path ends there and goes on where X, Y \
                 and Z are known again",
                code(tenths)
            ),
            Self::Before => format!("feeds before X, Y and Z are known are left out: {at}"),
            Self::Behind => format!("what is behind the end of the program is not read, from {at} on"),
            Self::Offset(name) => format!("{name} on {at} has no zero: it is taken at that of the path's frame"),
            Self::LongArc => {
                format!(
                    "the arc of {at} takes more than half a turn about the axis of its CIRCLE: is that its direction?"
                )
            }
        }
    }
}

/// `lines 2 to 5, 9`.
fn lines(runs: &[[usize; 2]]) -> String {
    let run = |[first, last]: &[usize; 2]| match last - first {
        0 => first.to_string(),
        _ => format!("{first} to {last}"),
    };
    let shown: Vec<String> = runs.iter().take(MOST_RUNS).map(run).collect();
    let word = if matches!(runs, [[first, last]] if first == last) { "line" } else { "lines" };
    let more = if runs.len() > MOST_RUNS { format!(" and {} more", runs.len() - MOST_RUNS) } else { String::new() };
    format!("{word} {}{more}", shown.join(", "))
}
