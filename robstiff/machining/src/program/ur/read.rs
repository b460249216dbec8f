//! Reading URScript.

use std::collections::HashMap;
use std::ops::Range;

use nalgebra::Isometry3;
use robstiff_robots::Diagnostics;

use super::arguments::{Argument, arguments};
use super::literal::Literal;
use super::routines::{COMMENT, routines};
use crate::program::document::Place;
use crate::program::order::lines_in_order;
use crate::program::source::{Cursor, Sources, code};
use crate::program::{Document, Frame, Instruction, Language, Motion, Move, Program, Speed, TextFile, Zone};

/// What the arguments of a motion are, in order; those of the process motion have no time.
const ARGUMENTS: [&str; 5] = ["pose", "a", "v", "t", "r"];
const OF_PROCESS: [&str; 4] = ["pose", "a", "v", "r"];

/// Motions that are kept as they are, and what they are.
const KEPT: [(&str, &str); 8] = [
    ("movec", "a circular motion"),
    ("servoj", "a motion that a loop controls"),
    ("servoc", "a motion that a loop controls"),
    ("servol", "a motion that a loop controls"),
    ("speedj", "a motion that a loop controls"),
    ("speedl", "a motion that a loop controls"),
    ("force_mode", "a motion that a force controls"),
    ("path_offset_set", "an offset of motions"),
];

const COMPUTED: &str = "its position is computed at run time";

/// Reads a `.script` file, and behind it those whose functions it calls.
///
/// # Errors
/// No function, one that does not end, a motion without a position.
pub fn read(files: Vec<TextFile>) -> Result<Document, Diagnostics> {
    let mut sources = Sources::new(files);
    let routines = routines(&mut sources);
    let order = lines_in_order(&sources, &routines, COMMENT);
    let (values, instructions, places, problems) = Default::default();
    let mut reader = Reader { sources: &sources, values, tool: None, work: None, instructions, places, problems };
    order.into_iter().for_each(|(file, bytes)| reader.line(file, bytes));
    let Reader { instructions, places, problems, .. } = reader;
    let name = routines.first().map(|routine| routine.name.clone()).unwrap_or_default();
    for (file, bytes, message, help) in problems {
        sources.report(file, bytes, message, help);
    }
    Ok(Document::new(Language::Ur, sources.finish()?, Program { name, instructions }, places))
}

struct Reader<'s> {
    sources: &'s Sources,
    /// Poses and angles by the name of what holds them; `None` where the program computes it.
    values: HashMap<&'s str, Option<Literal>>,
    tool: Option<Frame>,
    work: Option<Frame>,
    instructions: Vec<Instruction>,
    places: Vec<Place>,
    problems: Vec<(usize, Range<usize>, &'static str, &'static str)>,
}

impl<'s> Reader<'s> {
    fn line(&mut self, file: usize, bytes: Range<usize>) {
        let all = self.sources.text(file);
        let code = code(all, bytes.clone(), COMMENT);
        let text = all[bytes.clone()].trim();
        if text.is_empty() {
            return;
        }
        let line = self.sources.line_at(file, bytes.start);
        let mut cursor = self.sources.cursor(file, code.clone());
        let mut ahead = cursor;
        let first = ahead.word().unwrap_or_default();
        let is_call = ahead.peek() == Some('(');
        match first {
            "movej" | "movel" | "movep" if is_call => return self.motion(file, line, first, &ahead, code.end, text),
            "set_tcp" if is_call => return self.tool(file, line, &ahead, code.end, text),
            _ => {}
        }
        if let Some((_, why)) = KEPT.iter().find(|(word, _)| *word == first && is_call) {
            return self.keep(file, line, text, *why);
        }
        if self.assigns(file, &mut cursor) {
            return;
        }
        let begins = |word: &str| all[code.clone()].contains(&format!("{word}("));
        if ["movej", "movel", "movep", "movec"].into_iter().any(begins) {
            return self.keep(file, line, text, "a motion inside of another statement");
        }
        self.instructions.push(Instruction::Statement { line, text: text.to_owned() });
    }

    fn keep(&mut self, file: usize, line: usize, text: &str, why: impl Into<String>) {
        let (text, why) = (text.to_owned(), why.into());
        self.instructions.push(Instruction::KeptMove { file, line, text, why });
    }

    /// `name = p[..]` and the like; whether a name has a pose or angles by it that are not computed.
    fn assigns(&mut self, file: usize, cursor: &mut Cursor<'s>) -> bool {
        while cursor.eat_word("global") || cursor.eat_word("local") {}
        let Some(name) = cursor.word() else { return false };
        let is_part = cursor.peek() == Some('[');
        if is_part {
            cursor.until(&['=']);
        }
        if !cursor.eat("=") || cursor.peek() == Some('=') {
            return false;
        }
        let literal = if is_part { None } else { Literal::read(file, cursor).filter(|_| cursor.is_done()) };
        let is_literal = literal.is_some();
        // What never was a position needs no place.
        if is_literal || self.values.contains_key(name) {
            self.values.insert(name, literal);
        }
        is_literal
    }

    fn tool(&mut self, file: usize, line: usize, open: &Cursor<'s>, end: usize, text: &str) {
        let all = self.sources.text(file);
        let Some(first) = opened(all, open, end).and_then(|(arguments, _)| arguments.into_iter().next()) else {
            self.instructions.push(Instruction::Statement { line, text: text.to_owned() });
            return;
        };
        let frame = self.frame(file, first.value);
        if self.tool.as_ref() != Some(&frame) {
            self.tool = Some(frame.clone());
            self.instructions.push(Instruction::Tool(frame));
        }
    }

    /// The frame that some bytes are, by its name or its numbers; where it stands is not known of what is computed.
    fn frame(&self, file: usize, bytes: Range<usize>) -> Frame {
        let text = &self.sources.text(file)[bytes.clone()];
        let mut cursor = self.sources.cursor(file, bytes);
        match Literal::read(file, &mut cursor).filter(|_| cursor.is_done()) {
            Some(literal) => Frame { name: String::new(), pose: literal.pose() },
            None => {
                let known = self.values.get(text).and_then(Option::as_ref);
                Frame { name: text.to_owned(), pose: known.and_then(Literal::pose) }
            }
        }
    }

    fn motion(&mut self, file: usize, line: usize, word: &str, open: &Cursor<'s>, end: usize, text: &str) {
        let all = self.sources.text(file);
        let Some((given, behind)) = opened(all, open, end) else {
            let at = open.at..open.at + 1;
            return self.problems.push((file, at, "the `(` is not closed", "write `)` behind the last argument"));
        };
        let names: &[&str] = if word == "movep" { &OF_PROCESS } else { &ARGUMENTS };
        let named = given.iter().enumerate().map(|(i, argument)| {
            let name = argument.name.or(names.get(i).copied()).unwrap_or_default();
            (if name == "q" { "pose" } else { name }, argument)
        });
        let named: Vec<(&str, &Argument<'_>)> = named.collect();
        let find = |name: &str| named.iter().find(|(of, _)| *of == name).map(|(_, argument)| argument.value.clone());
        let Some(to) = find("pose").filter(|bytes| !bytes.is_empty()) else {
            let at = open.at..behind;
            let help = "write a pose or angles, as in `movel(p[0.4, 0.1, 0.3, 0, 3.14, 0], v=0.1)`";
            return self.problems.push((file, at, "the motion has no position", help));
        };
        if !all[behind..end].trim().is_empty() {
            return self.keep(file, line, text, "a motion inside of another statement");
        }
        let found = match self.place(file, to) {
            Ok(found) => found,
            Err(why) => return self.keep(file, line, text, why),
        };
        let Found { literal, point, work } = found;
        if let Some(frame) = work
            && self.work.as_ref() != Some(&frame)
        {
            self.work = Some(frame.clone());
            self.instructions.push(Instruction::Work(frame));
        }
        let value = |name: &str| find(name).map(|bytes| all[bytes].to_owned());
        let timed = value("t").is_some_and(|time| time.parse() != Ok(0.0));
        let motion = if word == "movej" { Motion::Joint } else { Motion::Linear };
        let speed = value("v").filter(|_| !timed).map(|text| match (text.parse(), motion) {
            (Ok(speed), Motion::Joint) => Speed::Joints(speed),
            (Ok(speed), Motion::Linear) => Speed::Tool(speed),
            (Err(_), _) => Speed::Named(text),
        });
        let zone = value("r").map_or(Zone::Fine, |text| match text.parse() {
            Ok(0.0) => Zone::Fine,
            Ok(radius) => Zone::Within(radius),
            Err(_) => Zone::Named(text),
        });
        let others = named.iter().filter(|(name, _)| match *name {
            "pose" | "r" => false,
            "v" => timed,
            "t" => timed,
            _ => true,
        });
        let options: Vec<String> =
            others.map(|(name, argument)| format!("{name}={}", &all[argument.value.clone()])).collect();
        let (position, options) = (literal.position(), options.join(", "));
        self.instructions.push(Instruction::Move(Move { file, line, motion, position, point, speed, zone, options }));
        self.places.push(Place { file: literal.file, slots: literal.slots });
    }

    /// Where some bytes say that a motion goes, or why that is not known.
    fn place(&self, file: usize, bytes: Range<usize>) -> Result<Found, String> {
        let all = self.sources.text(file);
        let mut cursor = self.sources.cursor(file, bytes.clone());
        let (value, frame) = if cursor.eat_word("pose_trans") {
            cursor.skip_space();
            let (given, behind) = opened(all, &cursor, bytes.end).ok_or(COMPUTED)?;
            match &given[..] {
                [frame, value] if all[behind..bytes.end].trim().is_empty() => {
                    (value.value.clone(), Some(self.frame(file, frame.value.clone())))
                }
                _ => return Err(COMPUTED.to_owned()),
            }
        } else {
            (bytes, None)
        };
        let text = &all[value.clone()];
        let mut cursor = self.sources.cursor(file, value);
        let (literal, point) = match Literal::read(file, &mut cursor).filter(|_| cursor.is_done()) {
            Some(literal) => (literal, None),
            None => match self.values.get(text) {
                Some(Some(literal)) => (literal.clone(), Some(text.to_owned())),
                Some(None) => return Err(format!("the program changes `{text}`")),
                None => return Err(COMPUTED.to_owned()),
            },
        };
        // Without a frame the base is it.
        let base = || Frame { name: String::new(), pose: Some(Isometry3::identity()) };
        match (literal.pose(), frame) {
            (Some(_), frame) => Ok(Found { literal, point, work: Some(frame.unwrap_or_else(base)) }),
            (None, None) => Ok(Found { literal, point, work: None }),
            (None, Some(_)) => Err("angles of the joints stand in no frame".to_owned()),
        }
    }
}

/// Where a motion goes.
struct Found {
    literal: Literal,
    /// The name of what holds it.
    point: Option<String>,
    /// The frame of a pose.
    work: Option<Frame>,
}

/// The arguments of the call whose `(` is next.
fn opened<'t>(text: &'t str, at: &Cursor<'_>, end: usize) -> Option<(Vec<Argument<'t>>, usize)> {
    let mut at = *at;
    at.skip_space();
    text[at.at..end].starts_with('(').then(|| arguments(text, at.at, end))?
}
