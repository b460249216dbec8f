//! Reading RAPID.

use std::collections::HashMap;
use std::ops::Range;

use nalgebra::Isometry3;
use robstiff_robots::Diagnostics;

use super::data::{Data, NoPosition};
use super::statements::{Place as Statement, contents, first_word};
use super::{SPEEDS, ZONES};
use crate::program::document::Place;
use crate::program::order::in_order;
use crate::program::source::{Cursor, Sources};
use crate::program::{Document, Frame, Instruction, Language, Motion, Move, Program, Speed, TextFile, Zone};

/// Reads a module, and behind it those that it uses.
///
/// # Errors
/// No module, a routine or a statement that does not end, a quaternion that is none,
/// a motion without its four arguments, a tool that the robot does not hold.
pub fn read(files: Vec<TextFile>) -> Result<Document, Diagnostics> {
    let mut sources = Sources::new(files);
    let contents = contents(&mut sources);
    let mut reader = Reader::new(&sources);
    contents.outside.iter().for_each(|place| reader.declare(place));
    let routines: Vec<(&str, &[Statement])> =
        contents.routines.iter().map(|routine| (&*routine.name, &*routine.statements)).collect();
    let order = in_order(&routines, |(file, bytes)| {
        let mut cursor = sources.cursor(*file, bytes.clone());
        let name = cursor.word()?;
        (cursor.eat(";") && cursor.is_done()).then_some(name)
    });
    order.iter().for_each(|place| reader.statement(place));
    let Reader { instructions, places, problems, .. } = reader;
    for (file, bytes, message, help) in problems {
        sources.report(file, bytes, message, help);
    }
    let name = contents.module.unwrap_or_default();
    Ok(Document::new(Language::Rapid, sources.finish()?, Program { name, instructions }, places))
}

struct Reader<'s> {
    sources: &'s Sources,
    /// Data by upper-case name; `None` where the program changes it.
    values: HashMap<String, Option<(usize, Data)>>,
    tool: Option<Frame>,
    work: Option<Frame>,
    instructions: Vec<Instruction>,
    places: Vec<Place>,
    problems: Vec<(usize, Range<usize>, String, &'static str)>,
}

/// An argument of a motion: what it is, and what stands behind it from `\` on.
struct Argument {
    bytes: Range<usize>,
    main: String,
    options: String,
}

impl<'s> Reader<'s> {
    fn new(sources: &'s Sources) -> Self {
        let (values, instructions, places, problems) = Default::default();
        Self { sources, values, tool: None, work: None, instructions, places, problems }
    }

    /// `CONST robtarget p10:=[..];` and the like.
    fn declare(&mut self, (file, bytes): &Statement) {
        let mut cursor = self.sources.cursor(*file, bytes.clone());
        while cursor.eat_word("LOCAL") || cursor.eat_word("TASK") {}
        if !["CONST", "PERS", "VAR"].into_iter().any(|word| cursor.eat_word(word)) {
            return;
        }
        cursor.word();
        let Some(name) = cursor.word() else { return };
        if !cursor.eat(":=") {
            return;
        }
        cursor.skip_space();
        let start = cursor.at;
        match Data::read(&mut cursor) {
            Some(value) => {
                self.values.insert(name.to_ascii_uppercase(), Some((*file, value)));
            }
            None => self.not_closed(*file, start),
        }
    }

    fn not_closed(&mut self, file: usize, at: usize) {
        self.problems.push((file, at..at + 1, "the `[` is not closed".to_owned(), "write `]` behind the last value"));
    }

    fn statement(&mut self, place: &Statement) {
        let (file, bytes) = place;
        let line = self.sources.line_at(*file, bytes.start);
        let text = self.sources.text(*file)[bytes.clone()].to_owned();
        let first = first_word(self.sources, place);
        let mut cursor = self.sources.cursor(*file, bytes.clone());
        match first.as_str() {
            "MOVEL" | "MOVEJ" | "MOVEABSJ" => {
                cursor.word();
                self.motion(*file, line, &first, cursor, bytes, &text);
            }
            "MOVEC" => self.keep(*file, line, text, "a circular motion"),
            _ if is_other_motion(&first) => self.keep(*file, line, text, "no plain joint or linear motion"),
            _ if !text.starts_with('!') && text.split_whitespace().skip(1).any(is_motion) => {
                self.keep(*file, line, text, "a motion inside of another statement");
            }
            _ => {
                self.declare(place);
                self.changes(*file, cursor);
                self.instructions.push(Instruction::Statement { line, text });
            }
        }
    }

    fn keep(&mut self, file: usize, line: usize, text: String, why: impl Into<String>) {
        self.instructions.push(Instruction::KeptMove { file, line, text, why: why.into() });
    }

    /// Forgets what an assignment gives another value.
    fn changes(&mut self, file: usize, mut cursor: Cursor<'_>) {
        let Some(name) = cursor.word().map(str::to_ascii_uppercase) else { return };
        let is_part = cursor.peek() == Some('.') || cursor.peek() == Some('{');
        if is_part {
            cursor.until(&['=']);
        }
        if !(if is_part { cursor.eat("=") } else { cursor.eat(":=") }) || !self.values.contains_key(&name) {
            return;
        }
        let whole = !is_part && cursor.peek() == Some('[');
        let value = if whole { Data::read(&mut cursor) } else { None };
        self.values.insert(name, value.map(|value| (file, value)));
    }

    fn motion(
        &mut self,
        file: usize,
        line: usize,
        word: &str,
        mut cursor: Cursor<'_>,
        whole: &Range<usize>,
        text: &str,
    ) {
        // `\Conc` stands before the position.
        let mut before = String::new();
        if cursor.peek() == Some('\\') {
            before = cursor.until(&[',']).trim().to_owned();
            cursor.eat(",");
        }
        let arguments = arguments(self.sources.text(file), cursor.at..whole.end);
        let [to, speed, zone, tool] = &arguments[..] else {
            let help = "write position, speed, zone and tool, as in `MoveL p10,v100,fine,tool0;`";
            let message = format!("a motion has four arguments, not {}", arguments.len());
            self.problems.push((file, whole.clone(), message, help));
            return;
        };
        let (mut rest, mut work) = (before, None);
        for part in [&to.options, &tool.options].into_iter().flat_map(|options| options.split('\\')).map(str::trim) {
            let upper = part.to_ascii_uppercase();
            match upper.split_once(":=") {
                Some((name, _)) if name.trim() == "WOBJ" => work = part.split_once(":=").map(|(_, name)| name.trim()),
                _ if part.is_empty() => {}
                _ => rest += &format!("\\{part}"),
            }
        }
        let inline = to.main.starts_with('[');
        let found = if inline {
            let mut cursor = self.sources.cursor(file, to.bytes.clone());
            match Data::read(&mut cursor) {
                Some(value) => (file, value),
                None => return self.not_closed(file, to.bytes.start),
            }
        } else {
            match self.values.get(&to.main.to_ascii_uppercase()) {
                Some(Some(found)) => found.clone(),
                Some(None) => {
                    return self.keep(file, line, text.to_owned(), format!("the program changes `{}`", to.main));
                }
                None if to.main.contains(['(', '*', '{']) => {
                    return self.keep(file, line, text.to_owned(), "its position is computed at run time");
                }
                None => {
                    return self.keep(
                        file,
                        line,
                        text.to_owned(),
                        format!("`{}` is declared in none of the files", to.main),
                    );
                }
            }
        };
        let (at, value) = found;
        let position = if word == "MOVEABSJ" { value.jointtarget() } else { value.robtarget() };
        let (position, slots) = match position {
            Ok(found) => found,
            Err(NoPosition::Computed(why)) => return self.keep(file, line, text.to_owned(), why),
            Err(NoPosition::Wrong(bytes, message)) => {
                let help = "a turn is a quaternion of length 1, its scalar first";
                self.problems.push((at, bytes, message, help));
                return;
            }
        };
        self.set_tool(file, tool);
        // Without one the world is the work object.
        self.set_work(file, work.unwrap_or("wobj0"), &tool.bytes);
        let motion = if word == "MOVEL" { Motion::Linear } else { Motion::Joint };
        let (speed, zone) = (Some(self.speed(speed)), self.zone(zone));
        let point = (!inline).then(|| to.main.clone());
        self.instructions.push(Instruction::Move(Move {
            file,
            line,
            motion,
            position,
            point,
            speed,
            zone,
            options: rest,
        }));
        self.places.push(Place { file: at, slots });
    }

    fn value(&self, name: &str) -> Option<&Data> {
        self.values.get(&name.to_ascii_uppercase())?.as_ref().map(|(_, value)| value)
    }

    fn speed(&self, argument: &Argument) -> Speed {
        let named = || Speed::Named(argument.main.clone() + &argument.options);
        if !argument.options.is_empty() {
            return named();
        }
        if let Some(value) = self.value(&argument.main) {
            return value.item(0).and_then(Data::number).map_or_else(named, |mm| Speed::Tool(mm * 1e-3));
        }
        let number = argument.main.get(1..).and_then(|digits| digits.parse::<u32>().ok());
        match number.filter(|number| argument.main.starts_with(['v', 'V']) && SPEEDS.contains(number)) {
            Some(number) => Speed::Tool(f64::from(number) * 1e-3),
            None => named(),
        }
    }

    fn zone(&self, argument: &Argument) -> Zone {
        let named = || Zone::Named(argument.main.clone() + &argument.options);
        if !argument.options.is_empty() {
            return named();
        }
        if argument.main.eq_ignore_ascii_case("fine") {
            return Zone::Fine;
        }
        if let Some(value) = self.value(&argument.main) {
            if value.item(0).is_some_and(|stop| stop.is_word("TRUE")) {
                return Zone::Fine;
            }
            return value.item(1).and_then(Data::number).map_or_else(named, |mm| Zone::Within(mm * 1e-3));
        }
        let known = ZONES.iter().find(|(name, _)| name.eq_ignore_ascii_case(&argument.main));
        known.map_or_else(named, |(_, mm)| Zone::Within(mm * 1e-3))
    }

    fn set_tool(&mut self, file: usize, argument: &Argument) {
        let pose = if argument.main.eq_ignore_ascii_case("tool0") {
            Some(Isometry3::identity())
        } else {
            let value = self.value(&argument.main);
            if value.and_then(|value| value.item(0)).is_some_and(|held| held.is_word("FALSE")) {
                self.stands_still(file, argument.bytes.clone());
            }
            self.value(&argument.main).and_then(|value| value.item(1)).and_then(Data::pose)
        };
        let frame = Frame { name: argument.main.clone(), pose };
        if self.tool.as_ref() != Some(&frame) {
            self.tool = Some(frame.clone());
            self.instructions.push(Instruction::Tool(frame));
        }
    }

    fn set_work(&mut self, file: usize, name: &str, bytes: &Range<usize>) {
        let pose = if name.eq_ignore_ascii_case("wobj0") {
            Some(Isometry3::identity())
        } else {
            let value = self.value(name);
            if value.and_then(|value| value.item(0)).is_some_and(|held| held.is_word("TRUE")) {
                self.stands_still(file, bytes.clone());
            }
            let frame = |index| self.value(name)?.item(index)?.pose();
            frame(3).zip(frame(4)).map(|(user, object)| user * object)
        };
        let frame = Frame { name: name.to_owned(), pose };
        if self.work.as_ref() != Some(&frame) {
            self.work = Some(frame.clone());
            self.instructions.push(Instruction::Work(frame));
        }
    }

    fn stands_still(&mut self, file: usize, bytes: Range<usize>) {
        let help = "robstiff reads programs in which the robot holds the tool (`robhold` TRUE in the tool, FALSE in the work object)";
        self.problems.push((file, bytes, "the tool stands still and the robot holds the work".to_owned(), help));
    }
}

/// Whether a word begins a plain motion.
fn is_motion(word: &str) -> bool {
    ["MoveL", "MoveJ", "MoveAbsJ", "MoveC"].iter().any(|motion| word.eq_ignore_ascii_case(motion))
}

/// Whether a word in upper case begins a motion of another kind.
fn is_other_motion(word: &str) -> bool {
    let begins = |start: &str| word.starts_with(start);
    begins("MOVE")
        || ["TRIGGL", "TRIGGJ", "TRIGGC", "SEARCHL", "SEARCHC", "ARCL", "ARCC", "SPOTL", "SPOTJ"]
            .iter()
            .any(|start| begins(start))
}

/// The arguments up to the `;`, split at commas outside of brackets.
fn arguments(text: &str, bytes: Range<usize>) -> Vec<Argument> {
    let part = text[bytes.clone()].trim_end().trim_end_matches(';');
    let (mut depth, mut start, mut ends) = (0, 0, Vec::new());
    for (at, letter) in part.char_indices() {
        match letter {
            '[' | '(' | '{' => depth += 1,
            ']' | ')' | '}' => depth -= 1,
            ',' if depth == 0 => {
                ends.push((start, at));
                start = at + 1;
            }
            _ => {}
        }
    }
    ends.push((start, part.len()));
    let argument = |(from, to): (usize, usize)| {
        let text = &part[from..to];
        let from = bytes.start + from + text.len() - text.trim_start().len();
        let (main, options) = text.split_at(text.find('\\').unwrap_or(text.len()));
        let (main, options) = (main.trim().to_owned(), options.trim().to_owned());
        Argument { bytes: from..from + main.len(), main, options }
    };
    ends.into_iter().map(argument).collect()
}
