//! A program that was read, with its texts.

use std::collections::HashMap;
use std::ops::Range;

use super::{Instruction, Language, Move, Position, Program, TextFile, krl, ls, rapid, ur};

/// Where a number of a position stands in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Slot {
    /// The bytes of the number; none where the number is to be put in.
    pub(super) bytes: Range<usize>,
    /// What to put before the number.
    pub(super) before: &'static str,
}

impl Slot {
    pub(super) fn new(bytes: Range<usize>) -> Self {
        Self { bytes, before: "" }
    }
}

/// Where a position stands: the file, and its numbers in the order of the language.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) file: usize,
    pub(super) slots: Vec<Slot>,
}

/// A program that was read, with its texts.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    language: Language,
    files: Vec<TextFile>,
    program: Program,
    /// One for each move, in order.
    places: Vec<Place>,
}

/// Two motions that share a point which cannot be both.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shared {
    /// The lines of the two motions.
    pub lines: [usize; 2],
    /// The name of the point, where it has one.
    pub point: Option<String>,
}

impl std::fmt::Display for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { lines: [first, second], point } = self;
        let point = point.as_ref().map(|name| format!(" `{name}`")).unwrap_or_default();
        write!(
            f,
            "the motions on lines {first} and {second} go to one point{point}, which is to be in two places: \
             give each motion a point"
        )
    }
}

impl std::error::Error for Shared {}

impl Document {
    pub(super) fn new(language: Language, files: Vec<TextFile>, program: Program, places: Vec<Place>) -> Self {
        Self { language, files, program, places }
    }

    /// The language it is in.
    pub fn language(&self) -> Language {
        self.language
    }

    /// The files as they were read.
    pub fn files(&self) -> &[TextFile] {
        &self.files
    }

    /// What the files say.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The motions, in order.
    pub fn moves(&self) -> impl Iterator<Item = &Move> {
        self.program.instructions.iter().filter_map(|instruction| match instruction {
            Instruction::Move(to) => Some(to),
            _ => None,
        })
    }

    /// The files with other positions: one for each of the [`moves`](Self::moves), of
    /// the form (angles or pose) that the file has. A position that is the same stays
    /// as it is written, byte for byte, and so does all else.
    ///
    /// # Errors
    /// Two motions to one point that are to be in different places.
    ///
    /// # Panics
    /// If there is another number of positions than moves, or one has another form
    /// than its move.
    pub fn with_positions(&self, positions: &[Position]) -> Result<Vec<TextFile>, Shared> {
        let moves: Vec<&Move> = self.moves().collect();
        assert_eq!(positions.len(), moves.len(), "a position for every motion");
        let mut taken: HashMap<(usize, usize), usize> = HashMap::new();
        let mut edits: Vec<Vec<(Range<usize>, String)>> = vec![Vec::new(); self.files.len()];
        for (i, (position, place)) in positions.iter().zip(&self.places).enumerate() {
            let numbers = |position: &Position| match self.language {
                Language::Krl => krl::numbers(position),
                Language::Rapid => rapid::numbers(position),
                Language::Ls => ls::numbers(position),
                Language::Ur => ur::numbers(position),
            };
            let Some(first) = place.slots.first() else { continue };
            if let Some(&before) = taken.get(&(place.file, first.bytes.start)) {
                if numbers(&positions[before]) != numbers(position) {
                    let lines = [moves[before].line, moves[i].line];
                    return Err(Shared { lines, point: moves[i].point.clone() });
                }
                continue;
            }
            taken.insert((place.file, first.bytes.start), i);
            if *position == moves[i].position {
                continue;
            }
            let numbers = numbers(position);
            assert_eq!(numbers.len(), place.slots.len(), "a position of the form that the file has");
            let written = place.slots.iter().zip(numbers);
            edits[place.file]
                .extend(written.map(|(slot, number)| (slot.bytes.clone(), slot.before.to_owned() + &number)));
        }
        Ok(self.files.iter().zip(edits).map(|(file, edits)| edited(file, edits)).collect())
    }
}

fn edited(file: &TextFile, mut edits: Vec<(Range<usize>, String)>) -> TextFile {
    // Numbers that are put in at one place stay in their order.
    edits.sort_by_key(|(bytes, _)| bytes.start);
    let mut text = String::with_capacity(file.text.len());
    let mut at = 0;
    for (bytes, number) in edits {
        text += &file.text[at..bytes.start];
        text += &number;
        at = bytes.end;
    }
    text += &file.text[at..];
    TextFile { name: file.name.clone(), text }
}
