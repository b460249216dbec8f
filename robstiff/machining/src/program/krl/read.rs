//! Reading KRL.

use std::collections::HashMap;
use std::ops::Range;

use nalgebra::Isometry3;
use robstiff_robots::Diagnostics;

use super::POSITIONS;
use super::aggregate::Aggregate;
use super::routines::{COMMENT, code, lines, routines};
use super::state::{State, Which};
use crate::program::document::Place;
use crate::program::order::lines_in_order;
use crate::program::source::{Cursor, Sources};
use crate::program::{Document, Frame, Instruction, Language, Motion, Move, Program, Speed, TextFile};

/// Words that begin a motion which is kept as it is, and what it is.
const KEPT: [(&str, &str); 11] = [
    ("CIRC", "a circular motion"),
    ("SCIRC", "a circular motion"),
    ("SPL", "a spline"),
    ("PTP_REL", "a relative motion"),
    ("SPTP_REL", "a relative motion"),
    ("LIN_REL", "a relative motion"),
    ("SLIN_REL", "a relative motion"),
    ("CIRC_REL", "a relative motion"),
    ("SCIRC_REL", "a relative motion"),
    ("SPL_REL", "a relative motion"),
    ("ASYPTP", "a motion of further axes"),
];

/// Reads a `.src` file, and behind it the `.dat` files and further `.src` files that it uses.
///
/// # Errors
/// No routine, one that does not end, an aggregate that is none, a tool that stands
/// still (`#TCP`).
pub fn read(files: Vec<TextFile>) -> Result<Document, Diagnostics> {
    let mut sources = Sources::new(files);
    let routines = routines(&mut sources);
    let order = lines_in_order(&sources, &routines, COMMENT);
    let mut reader = Reader::new(&sources);
    for file in 0..sources.count() {
        if sources.name(file).to_ascii_lowercase().ends_with(".dat") {
            lines(&sources, file).for_each(|(file, bytes)| reader.declaration(file, bytes));
        }
    }
    for (file, bytes) in order {
        reader.line(file, bytes);
    }
    let Reader { instructions, places, problems, .. } = reader;
    let name = routines.first().map(|routine| routine.name.clone()).unwrap_or_default();
    for (file, bytes, message, help) in problems {
        sources.report(file, bytes, message, help);
    }
    Ok(Document::new(Language::Krl, sources.finish()?, Program { name, instructions }, places))
}

struct Reader<'s> {
    sources: &'s Sources,
    /// Aggregates by the upper-case name of what holds them; `None` where the program
    /// changes a part.
    values: HashMap<String, Option<(usize, Aggregate)>>,
    state: State,
    instructions: Vec<Instruction>,
    places: Vec<Place>,
    problems: Vec<(usize, Range<usize>, String, &'static str)>,
}

impl<'s> Reader<'s> {
    fn new(sources: &'s Sources) -> Self {
        let (values, state) = (HashMap::new(), State::default());
        Self { sources, values, state, instructions: Vec::new(), places: Vec::new(), problems: Vec::new() }
    }

    fn cursor(&self, file: usize, bytes: &Range<usize>) -> Cursor<'s> {
        self.sources.cursor(file, code(self.sources.text(file), bytes.clone()))
    }

    /// An aggregate, or `None` with the problem reported.
    fn aggregate(&mut self, file: usize, cursor: &mut Cursor<'_>) -> Option<Aggregate> {
        Aggregate::read(cursor)
            .map_err(|wrong| {
                let help = "write a name and a value for each field, as in `{X 10.0,Y 0.0,Z 5.0,A 0.0,B 90.0,C 0.0}`";
                self.problems.push((file, wrong.bytes, wrong.message, help));
            })
            .ok()
    }

    /// `DECL E6POS XP1={..}` and the like.
    fn declaration(&mut self, file: usize, bytes: Range<usize>) {
        let mut cursor = self.cursor(file, &bytes);
        while cursor.eat_word("DECL") || cursor.eat_word("GLOBAL") || cursor.eat_word("CONST") {}
        let Some(first) = cursor.word() else { return };
        // `XP1={..}` has no type.
        let name = if cursor.peek() == Some('=') { Some(first) } else { cursor.word() };
        let Some(name) = name.filter(|_| cursor.eat("=") && cursor.peek() == Some('{')) else { return };
        if let Some(value) = self.aggregate(file, &mut cursor) {
            self.values.insert(name.to_ascii_uppercase(), Some((file, value)));
        }
    }

    fn line(&mut self, file: usize, bytes: Range<usize>) {
        let mut cursor = self.cursor(file, &bytes);
        let line = self.sources.line_at(file, bytes.start);
        let text = self.sources.text(file)[bytes.clone()].trim();
        // The editor's folds are layout.
        let start = text.get(..8).unwrap_or(text).to_ascii_uppercase();
        if text.is_empty() || start.starts_with(";FOLD") || start.starts_with(";ENDFOLD") {
            return;
        }
        let words = cursor;
        let first = cursor.word().unwrap_or_default().to_ascii_uppercase();
        let motion = match first.as_str() {
            "PTP" | "SPTP" => Some(Motion::Joint),
            "LIN" | "SLIN" => Some(Motion::Linear),
            _ => None,
        };
        if let Some(motion) = motion {
            return self.motion(file, line, motion, cursor, text);
        }
        if let Some((_, what)) = KEPT.iter().find(|(word, _)| *word == first) {
            return self.keep(file, line, text, what);
        }
        if !self.set(file, &first, cursor) {
            if self.is_change(words) {
                self.declaration(file, bytes);
            }
            self.instructions.push(Instruction::Statement { line, text: text.to_owned() });
        }
    }

    /// Whether a line gives a declared position, or a part of it, another value.
    fn is_change(&mut self, mut cursor: Cursor<'_>) -> bool {
        while cursor.eat_word("DECL") || POSITIONS.iter().any(|name| cursor.eat_word(name)) {}
        let Some(name) = cursor.word() else { return false };
        let is_part = cursor.peek() == Some('.');
        if is_part {
            cursor.until(&['=']);
        }
        if !cursor.eat("=") || cursor.peek() == Some('=') {
            return false;
        }
        let whole = !is_part && cursor.peek() == Some('{');
        if !whole && let Some(value) = self.values.get_mut(&name.to_ascii_uppercase()) {
            *value = None;
        }
        whole
    }

    fn keep(&mut self, file: usize, line: usize, text: &str, why: &str) {
        // Where it ends is not known.
        self.state.before = Default::default();
        let (text, why) = (text.to_owned(), why.to_owned());
        self.instructions.push(Instruction::KeptMove { file, line, text, why });
    }

    fn motion(&mut self, file: usize, line: usize, motion: Motion, mut cursor: Cursor<'_>, text: &str) {
        let (place, value, point) = if cursor.peek() == Some('{') {
            let Some(value) = self.aggregate(file, &mut cursor) else { return };
            (file, value, None)
        } else {
            let Some(name) = cursor.word() else {
                let bytes = cursor.at..cursor.at;
                let help = "write the name of a point or its numbers, as in `LIN {X 10.0,Y 0.0,Z 5.0}`";
                self.problems.push((file, bytes, "the motion has no position".to_owned(), help));
                return;
            };
            if matches!(cursor.peek(), Some('[' | ':' | '.')) {
                return self.keep(file, line, text, "its position is computed at run time");
            }
            match self.values.get(&name.to_ascii_uppercase()) {
                Some(Some((place, value))) => (*place, value.clone(), Some(name.to_owned())),
                Some(None) => return self.keep(file, line, text, &format!("the program changes `{name}`")),
                None => return self.keep(file, line, text, &format!("`{name}` is declared in none of the files")),
            }
        };
        if cursor.peek() == Some(':') {
            return self.keep(file, line, text, "its position is computed at run time");
        }
        let mut words = Vec::new();
        while let Some(word) = ["C_PTP", "C_DIS", "C_VEL", "C_ORI", "C_SPL"].iter().find(|word| cursor.eat_word(word)) {
            words.push((*word).to_owned());
        }
        let options = cursor.rest().trim_end().to_owned();
        self.with(&options);
        let (position, slots) = match value.position(&mut self.state.before) {
            Ok(found) => found,
            Err(why) => return self.keep(file, line, text, &why),
        };
        let zone = self.state.zone(motion, &words);
        let speed = match motion {
            Motion::Joint => self.state.joint_speed.clone(),
            Motion::Linear => self.state.line_speed.clone(),
        };
        self.instructions.push(Instruction::Move(Move { file, line, motion, position, point, speed, zone, options }));
        self.places.push(Place { file: place, slots });
    }

    /// `WITH $VEL=SVEL_CP(..), $TOOL=STOOL2(FP1), ..` behind a spline motion.
    fn with(&mut self, options: &str) {
        let upper = options.to_ascii_uppercase();
        let argument = |function: &str| {
            let (_, rest) = upper.split_once(function)?;
            rest.split([',', ')', '.'])
                .next()
                .map(|_| rest.split([',', ')']).next().unwrap_or_default().trim().to_owned())
        };
        if let Some(speed) = argument("SVEL_CP(") {
            self.state.line_speed = Some(speed_of(&speed, 1.0, Speed::Tool));
        }
        if let Some(speed) = argument("SVEL_JOINT(") {
            self.state.joint_speed = Some(speed_of(&speed, 1e-2, Speed::Share));
        }
        for function in ["STOOL2(", "STOOL("] {
            if let Some(name) = argument(function) {
                self.frames_of(name.split('.').next().unwrap_or_default());
                break;
            }
        }
    }

    /// Takes tool and base of an `FDAT`.
    fn frames_of(&mut self, name: &str) {
        let numbers = match self.values.get(name) {
            Some(Some((_, data))) => {
                if data.other("IPO_FRAME").is_some_and(|frame| frame.eq_ignore_ascii_case("#TCP")) {
                    return self.set_frames(Frame { name: name.to_owned(), pose: None });
                }
                [data.number("TOOL_NO"), data.number("BASE_NO")]
            }
            _ => return self.set_frames(Frame { name: name.to_owned(), pose: None }),
        };
        for (which, number) in [Which::Tool, Which::Work].into_iter().zip(numbers) {
            if let Some(number) = number {
                let frame = self.state.frame(which, number as i64);
                self.set_frame(which, frame);
            }
        }
    }

    fn set_frames(&mut self, frame: Frame) {
        self.set_frame(Which::Tool, frame.clone());
        self.set_frame(Which::Work, frame);
    }

    fn set_frame(&mut self, which: Which, frame: Frame) {
        let (now, instruction) = match which {
            Which::Tool => (&mut self.state.tool, Instruction::Tool(frame.clone())),
            Which::Work => (&mut self.state.work, Instruction::Work(frame.clone())),
        };
        if now.as_ref() != Some(&frame) {
            *now = Some(frame);
            self.state.before.pose = None;
            self.instructions.push(instruction);
        }
    }

    /// Takes a line that sets frames, speeds or zones; whether it is one.
    fn set(&mut self, file: usize, first: &str, mut cursor: Cursor<'_>) -> bool {
        match first {
            "$TOOL" | "$BASE" if cursor.eat("=") => {
                let which = if first == "$TOOL" { Which::Tool } else { Which::Work };
                if let Some(frame) = self.frame_value(file, which, &mut cursor) {
                    self.set_frame(which, frame);
                }
                true
            }
            "TOOL_DATA" | "BASE_DATA" => self.frame_data(file, first == "TOOL_DATA", cursor),
            "BAS" => self.bas(cursor),
            "$VEL" if cursor.eat(".") && cursor.eat_word("CP") && cursor.eat("=") => {
                self.state.line_speed = Some(speed_of(cursor.rest().trim_end(), 1.0, Speed::Tool));
                true
            }
            "$APO" if cursor.eat(".") => {
                let field = cursor.word().unwrap_or_default().to_ascii_uppercase();
                let value = if cursor.eat("=") { cursor.number().map(|(value, _)| value) } else { None };
                let value = value.filter(|_| cursor.is_done());
                match field.as_str() {
                    "CDIS" => self.state.distance = value.map(|mm| mm * 1e-3),
                    "CVEL" => self.state.velocity = value.map(|percent| percent * 1e-2),
                    "CPTP" => self.state.joints = value.map(|percent| percent * 1e-2),
                    _ => return false,
                }
                value.is_some()
            }
            "FDAT_ACT" if cursor.eat("=") => {
                self.frames_of(&cursor.rest().trim_end().to_ascii_uppercase());
                true
            }
            "LDAT_ACT" | "PDAT_ACT" if cursor.eat("=") => {
                let motion = if first == "LDAT_ACT" { Motion::Linear } else { Motion::Joint };
                if let Some(Some((_, data))) = self.values.get(&cursor.rest().trim_end().to_ascii_uppercase()) {
                    let data = data.clone();
                    self.state.take(&data, motion);
                }
                false
            }
            "$IPO_MODE" if cursor.eat("=") && cursor.rest().trim_end().eq_ignore_ascii_case("#TCP") => {
                let help = "robstiff reads programs in which the robot holds the tool (`$IPO_MODE=#BASE`)";
                let bytes = cursor.at..cursor.at + cursor.rest().trim_end().len();
                self.problems.push((
                    file,
                    bytes,
                    "the tool stands still and the robot holds the work".to_owned(),
                    help,
                ));
                true
            }
            _ => false,
        }
    }

    fn frame_value(&mut self, file: usize, which: Which, cursor: &mut Cursor<'_>) -> Option<Frame> {
        let text = cursor.rest().trim_end().to_owned();
        if cursor.peek() == Some('{') {
            let value = self.aggregate(file, cursor)?;
            return Some(match value.frame().filter(|_| cursor.is_done()) {
                Some(pose) => Frame { name: String::new(), pose: Some(pose) },
                None => Frame { name: text, pose: None },
            });
        }
        let name = cursor.word().unwrap_or_default().to_ascii_uppercase();
        if name == "$NULLFRAME" && cursor.is_done() {
            return Some(Frame { name: String::new(), pose: Some(Isometry3::identity()) });
        }
        if matches!((name.as_str(), which), ("TOOL_DATA", Which::Tool) | ("BASE_DATA", Which::Work))
            && cursor.eat("[")
            && let Some((number, _)) = cursor.number()
            && cursor.eat("]")
            && cursor.is_done()
        {
            return Some(self.state.frame(which, number as i64));
        }
        Some(Frame { name: text, pose: None })
    }

    /// `TOOL_DATA[1]={..}`.
    fn frame_data(&mut self, file: usize, is_tool: bool, mut cursor: Cursor<'_>) -> bool {
        let index = if cursor.eat("[") { cursor.number() } else { None };
        let Some((number, _)) = index.filter(|_| cursor.eat("]") && cursor.eat("=")) else { return false };
        let known = |value: Option<Isometry3<f64>>, reader: &mut Self| {
            let map = if is_tool { &mut reader.state.tools } else { &mut reader.state.works };
            match value {
                Some(pose) => map.insert(number as i64, pose),
                None => map.remove(&(number as i64)),
            };
        };
        if cursor.peek() != Some('{') {
            known(None, self);
            return false;
        }
        let value = self.aggregate(file, &mut cursor);
        let pose = value.and_then(|value| value.frame());
        known(pose, self);
        pose.is_some()
    }

    /// `BAS(#VEL_PTP,30)` and the like.
    fn bas(&mut self, mut cursor: Cursor<'_>) -> bool {
        if !(cursor.eat("(") && cursor.eat("#")) {
            return false;
        }
        let command = cursor.word().unwrap_or_default().to_ascii_uppercase();
        let argument = if cursor.eat(",") { cursor.until(&[')']).trim() } else { "" };
        if !cursor.eat(")") {
            return false;
        }
        let number = || argument.parse::<i64>().ok();
        match command.as_str() {
            "INITMOV" => true,
            "TOOL" | "BASE" => {
                let which = if command == "TOOL" { Which::Tool } else { Which::Work };
                let frame = match number() {
                    Some(number) => self.state.frame(which, number),
                    None => Frame { name: argument.to_owned(), pose: None },
                };
                self.set_frame(which, frame);
                true
            }
            "VEL_PTP" | "PTP_PARAMS" => {
                self.state.joint_speed = Some(speed_of(argument, 1e-2, Speed::Share));
                self.state.joints = self.state.next_joints.take().or(self.state.joints);
                true
            }
            "VEL_CP" | "CP_PARAMS" => {
                self.state.line_speed = Some(speed_of(argument, 1.0, Speed::Tool));
                self.state.distance = self.state.next_distance.take().or(self.state.distance);
                true
            }
            _ => false,
        }
    }
}

fn speed_of(text: &str, unit: f64, speed: impl Fn(f64) -> Speed) -> Speed {
    match text.parse::<f64>() {
        Ok(value) => speed(value * unit),
        Err(_) => Speed::Named(text.to_owned()),
    }
}
