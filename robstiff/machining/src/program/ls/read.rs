//! Reading FANUC TP programs.

use std::collections::HashMap;
use std::ops::Range;

use robstiff_robots::Diagnostics;

use super::positions::{Taught, positions};
use crate::program::document::Place;
use crate::program::source::{Cursor, Sources};
use crate::program::{Document, Frame, Instruction, Language, Motion, Move, Program, Speed, TextFile, Zone};

/// Parts of a motion that move its position by what the controller knows alone.
const MOVED: [&str; 6] = ["INC", "OFFSET", "TOOL_OFFSET", "VOFFSET", "FRAME_OFFSET", "COORD"];

/// Reads a `.ls` file.
///
/// # Errors
/// No `/PROG`, no `/MN`, a position that is none.
pub fn read(files: Vec<TextFile>) -> Result<Document, Diagnostics> {
    let mut sources = Sources::new(files);
    let (mut instructions, mut places) = (Vec::new(), Vec::new());
    let mut name = String::new();
    for file in 0..sources.count() {
        let sections = Sections::of(&mut sources, file);
        if file == 0 {
            name = sections.name;
        }
        let taught = sections.positions.map(|bytes| positions(&mut sources, file, bytes)).unwrap_or_default();
        let mut reader = Reader { sources: &sources, file, taught, frame: None, tool: None, instructions, places };
        sections.statements.into_iter().for_each(|bytes| reader.statement(bytes));
        Reader { instructions, places, .. } = reader;
    }
    Ok(Document::new(Language::Ls, sources.finish()?, Program { name, instructions }, places))
}

#[derive(Default)]
struct Sections {
    name: String,
    /// The bytes of each statement, without its number and its `;`.
    statements: Vec<Range<usize>>,
    positions: Option<Range<usize>>,
}

impl Sections {
    fn of(sources: &mut Sources, file: usize) -> Self {
        let mut sections = Self::default();
        let (mut section, mut wrong) = (String::new(), Vec::new());
        let lines = sources.lines(file);
        let (mut has_name, mut has_motions, mut open) = (false, false, false);
        for number in 1..=lines.count() {
            let bytes = lines.range(number);
            let text = lines.line(number);
            if text.trim_start().starts_with('/') {
                let mut words = text.split_whitespace();
                section = words.next().unwrap_or_default().to_ascii_uppercase();
                match section.as_str() {
                    "/PROG" => {
                        has_name = true;
                        sections.name = words.next().unwrap_or_default().to_owned();
                    }
                    "/MN" => has_motions = true,
                    "/POS" => sections.positions = Some(bytes.end..bytes.end),
                    _ => {}
                }
                continue;
            }
            match section.as_str() {
                "/MN" if !text.trim().is_empty() => {
                    let mut cursor = sources.cursor(file, bytes.clone());
                    let is_numbered = cursor.number().is_some();
                    cursor.eat(":");
                    cursor.skip_space();
                    let end = bytes.start + text.trim_end().trim_end_matches(';').trim_end().len();
                    match sections.statements.last_mut() {
                        // A long statement goes on in the next line.
                        Some(last) if open && !is_numbered => last.end = end.max(last.end),
                        _ => sections.statements.push(cursor.at.min(end)..end),
                    }
                    open = !text.trim_end().ends_with(';');
                }
                "/POS" => {
                    if let Some(positions) = &mut sections.positions {
                        positions.end = bytes.end;
                    }
                }
                _ => {}
            }
        }
        let first = lines.range(1);
        if !has_name {
            wrong.push(("the file has no `/PROG`", "a program begins with `/PROG  NAME`"));
        }
        if !has_motions {
            wrong.push(("the file has no `/MN`", "the instructions stand between `/MN` and `/POS`"));
        }
        for (message, help) in wrong {
            sources.report(file, first.clone(), message, help);
        }
        sections
    }
}

struct Reader<'s> {
    sources: &'s Sources,
    file: usize,
    taught: HashMap<u32, Result<Taught, String>>,
    frame: Option<String>,
    tool: Option<String>,
    instructions: Vec<Instruction>,
    places: Vec<Place>,
}

impl Reader<'_> {
    fn statement(&mut self, bytes: Range<usize>) {
        let line = self.sources.line_at(self.file, bytes.start);
        let text = self.sources.text(self.file)[bytes.clone()].to_owned();
        let mut cursor = self.sources.cursor(self.file, bytes);
        let mut ahead = cursor;
        match ahead.word().unwrap_or_default().to_ascii_uppercase().as_str() {
            word @ ("UFRAME_NUM" | "UTOOL_NUM") if ahead.eat("=") => {
                self.set(word == "UTOOL_NUM", ahead.rest().trim_end());
                return;
            }
            _ => {}
        }
        let first = cursor.word().unwrap_or_default().to_ascii_uppercase();
        let is_position = cursor.rest().starts_with(['P', 'p', '@']);
        match first.as_str() {
            "J" | "L" if is_position => {
                let motion = if first == "J" { Motion::Joint } else { Motion::Linear };
                if let Err(why) = self.motion(line, motion, cursor) {
                    self.instructions.push(Instruction::KeptMove { file: self.file, line, text, why });
                }
            }
            "C" | "A" | "S" if is_position => {
                let why = "a circular motion or a spline".to_owned();
                self.instructions.push(Instruction::KeptMove { file: self.file, line, text, why });
            }
            _ => self.instructions.push(Instruction::Statement { line, text }),
        }
    }

    fn set(&mut self, is_tool: bool, number: &str) {
        let now = if is_tool { &mut self.tool } else { &mut self.frame };
        if now.as_deref() == Some(number) {
            return;
        }
        *now = Some(number.to_owned());
        let frame = Frame { name: number.to_owned(), pose: None };
        self.instructions.push(if is_tool { Instruction::Tool(frame) } else { Instruction::Work(frame) });
    }

    fn motion(&mut self, line: usize, motion: Motion, mut cursor: Cursor<'_>) -> Result<(), String> {
        cursor.eat("@");
        if !(cursor.eat("P") && cursor.eat("[")) {
            return Err("its position is a register".to_owned());
        }
        let Some((number, _)) = cursor.number() else { return Err("its position is chosen at run time".to_owned()) };
        cursor.until(&[']']);
        cursor.eat("]");
        let taught = match self.taught.get(&(number as u32)) {
            Some(Ok(taught)) => taught.clone(),
            Some(Err(why)) => return Err(why.clone()),
            None => return Err(format!("P[{number}] has no position")),
        };
        let speed = speed(&mut cursor);
        let zone = zone(&mut cursor);
        let options = cursor.rest().trim_end().to_owned();
        let upper = options.to_ascii_uppercase();
        let mut words = upper.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
        if let Some(word) = words.find(|word| MOVED.contains(word)) {
            return Err(format!("`{word}` moves its position at run time"));
        }
        // `F` stands for whichever frame is set.
        for (is_tool, name) in [(false, &taught.frame), (true, &taught.tool)] {
            if !name.is_empty() && name != "F" {
                self.set(is_tool, name);
            }
        }
        let point = taught.comment.filter(|comment| !comment.is_empty());
        let position = taught.position;
        self.instructions.push(Instruction::Move(Move {
            file: self.file,
            line,
            motion,
            position,
            point,
            speed,
            zone,
            options,
        }));
        self.places.push(Place { file: self.file, slots: taught.slots });
        Ok(())
    }
}

fn speed(cursor: &mut Cursor<'_>) -> Option<Speed> {
    cursor.skip_space();
    let start = *cursor;
    if let Some((value, _)) = cursor.number() {
        for (unit, of) in
            [("mm/sec", 1e-3), ("cm/min", 1e-2 / 60.0), ("mm/min", 1e-3 / 60.0), ("inch/min", 0.0254 / 60.0)]
        {
            if cursor.eat(unit) {
                return Some(Speed::Tool(value * of));
            }
        }
        if cursor.eat("%") {
            return Some(Speed::Share(value * 1e-2));
        }
        *cursor = start;
    }
    let text = cursor.until(&[' ', '\t']).to_owned();
    (!text.is_empty()).then_some(Speed::Named(text))
}

fn zone(cursor: &mut Cursor<'_>) -> Zone {
    cursor.skip_space();
    let start = *cursor;
    if cursor.eat_word("FINE") {
        return Zone::Fine;
    }
    if cursor.eat("CNT")
        && let Some((value, _)) = cursor.number()
    {
        return Zone::Share(value * 1e-2);
    }
    *cursor = start;
    Zone::Named(cursor.until(&[' ', '\t']).to_owned())
}
