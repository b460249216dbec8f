//! The section `/POS`.

use std::collections::HashMap;
use std::ops::Range;

use nalgebra::{Isometry3, Translation3};

use super::POSE;
use crate::program::angles::from_abc;
use crate::program::document::Slot;
use crate::program::source::{Cursor, Sources};
use crate::program::{Configuration, Position, Target};

/// A position with its frames.
#[derive(Clone, Debug)]
pub(super) struct Taught {
    pub(super) frame: String,
    pub(super) tool: String,
    pub(super) position: Position,
    pub(super) slots: Vec<Slot>,
    pub(super) comment: Option<String>,
}

/// A problem: its bytes, what is wrong, what would be right.
type Problem = (Range<usize>, String, &'static str);

const FORM: &str = "write `P[1]{`, `GP1:`, `UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',`, `X = 1.000 mm, ..` or `J1 = 1.000 deg, ..`, `};`";

/// The positions by their number, or why one is not to be used.
pub(super) fn positions(
    sources: &mut Sources,
    file: usize,
    bytes: Range<usize>,
) -> HashMap<u32, Result<Taught, String>> {
    let mut taught = HashMap::new();
    let mut problems: Vec<Problem> = Vec::new();
    let mut cursor = sources.cursor(file, bytes);
    while !cursor.is_done() {
        cursor.skip_space();
        let start = cursor.at;
        match position(&mut cursor) {
            Ok((number, one)) => {
                if taught.insert(number, one).is_some() {
                    problems.push((start..cursor.at, format!("P[{number}] is given twice"), "keep one of the two"));
                }
            }
            Err(problem) => {
                problems.push(problem);
                // The next one may be right.
                cursor.until(&['}']);
                cursor.eat("}");
                cursor.eat(";");
            }
        }
    }
    for (bytes, message, help) in problems {
        sources.report(file, bytes, message, help);
    }
    taught
}

fn position(cursor: &mut Cursor<'_>) -> Result<(u32, Result<Taught, String>), Problem> {
    let wrong = |cursor: &Cursor<'_>, message: &str| {
        let mut at = *cursor;
        at.skip_space();
        (at.at..at.at + 1, message.to_owned(), FORM)
    };
    if !(cursor.eat("P") && cursor.eat("[")) {
        return Err(wrong(cursor, "a position `P[..]` is expected here"));
    }
    let Some((number, _)) = cursor.number() else { return Err(wrong(cursor, "the position has no number")) };
    let comment = cursor.eat(":").then(|| cursor.until(&[']']).trim().trim_matches('"').to_owned());
    if !(cursor.eat("]") && cursor.eat("{")) {
        return Err(wrong(cursor, "`]{` is expected here"));
    }
    let open = cursor.at - 1;
    let (mut fields, mut group) = (Fields::default(), 1);
    loop {
        if cursor.eat("}") {
            cursor.eat(";");
            break;
        }
        if cursor.is_done() {
            return Err((open..open + 1, "the `{` is not closed".to_owned(), FORM));
        }
        if cursor.eat(",") {
            continue;
        }
        cursor.skip_space();
        let start = cursor.at;
        let Some(name) = cursor.word().map(str::to_ascii_uppercase) else {
            return Err(wrong(cursor, "the name of a field is expected here"));
        };
        if let Some(digits) = name.strip_prefix("GP")
            && let Ok(number) = digits.parse::<u32>()
            && cursor.eat(":")
        {
            group = number;
            continue;
        }
        if !(cursor.eat(":") || cursor.eat("=")) {
            return Err((start..cursor.at, format!("`{name}` has no value"), FORM));
        }
        let value = Value::read(cursor);
        // Other groups are other machines.
        if group == 1 && !fields.add(name.clone(), value) {
            return Err((start..cursor.at, format!("`{name}` is given twice"), "keep one of the two"));
        }
    }
    Ok((number as u32, fields.taught(comment, open)?))
}

enum Value {
    Number(f64, Range<usize>, String),
    Text(String, Range<usize>),
}

impl Value {
    fn read(cursor: &mut Cursor<'_>) -> Self {
        cursor.skip_space();
        let mut ahead = *cursor;
        if let Some((value, bytes)) = ahead.number() {
            let unit = ahead.word().unwrap_or_default().to_ascii_lowercase();
            *cursor = ahead;
            return Self::Number(value, bytes, unit);
        }
        let start = cursor.at;
        if cursor.eat("'") {
            let text = cursor.until(&['\'']).to_owned();
            cursor.eat("'");
            return Self::Text(text, start..cursor.at);
        }
        let text = cursor.until(&[',', '}', '\n', '\r']).trim().to_owned();
        Self::Text(text, start..cursor.at)
    }
}

#[derive(Default)]
struct Fields(Vec<(String, Value)>);

impl Fields {
    /// Adds a field; whether it is the first of its name.
    fn add(&mut self, name: String, value: Value) -> bool {
        let is_first = self.get(&name).is_none();
        self.0.push((name, value));
        is_first
    }

    fn get(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|(field, _)| field == name).map(|(_, value)| value)
    }

    fn text(&self, name: &str) -> String {
        match self.get(name) {
            Some(Value::Number(value, ..)) => value.to_string(),
            Some(Value::Text(text, _)) => text.clone(),
            None => String::new(),
        }
    }

    /// A number in a unit, and its bytes; `None` where it is not taught (`****`).
    fn number(&self, name: &str, unit: &str, open: usize) -> Result<Option<(f64, Range<usize>)>, Problem> {
        match self.get(name) {
            Some(Value::Number(value, bytes, found)) if found == unit => Ok(Some((*value, bytes.clone()))),
            Some(Value::Number(_, bytes, found)) => {
                Err((bytes.clone(), format!("{name} is in `{found}`, not in `{unit}`"), FORM))
            }
            Some(Value::Text(text, _)) if text.starts_with('*') => Ok(None),
            Some(Value::Text(_, bytes)) => Err((bytes.clone(), format!("{name} is no number"), FORM)),
            None => Err((open..open + 1, format!("the position has no {name}"), FORM)),
        }
    }

    fn taught(&self, comment: Option<String>, open: usize) -> Result<Result<Taught, String>, Problem> {
        let joints = (1..).take_while(|number| self.get(&format!("J{number}")).is_some()).count();
        let names: Vec<(String, &str)> = if joints > 0 {
            (1..=joints).map(|number| (format!("J{number}"), "deg")).collect()
        } else {
            POSE.iter()
                .zip(["mm", "mm", "mm", "deg", "deg", "deg"])
                .map(|(name, unit)| ((*name).to_owned(), unit))
                .collect()
        };
        let (mut numbers, mut slots) = (Vec::new(), Vec::new());
        for (name, unit) in &names {
            if let Some(Value::Number(_, _, found)) = self.get(name)
                && joints > 0
                && found == "mm"
            {
                return Ok(Err(format!("{name} slides")));
            }
            let Some((value, bytes)) = self.number(name, unit, open)? else {
                return Ok(Err("its position is not taught".to_owned()));
            };
            numbers.push(value);
            slots.push(Slot::new(bytes));
        }
        let target = if joints > 0 {
            Target::Joints(numbers.iter().map(|degrees| degrees.to_radians()).collect())
        } else {
            let [x, y, z, w, p, r] = numbers[..] else { unreachable!("six numbers of a pose") };
            let turn = from_abc([r, p, w].map(f64::to_radians));
            let pose = Isometry3::from_parts(Translation3::new(x * 1e-3, y * 1e-3, z * 1e-3), turn);
            Target::Pose(pose, self.configuration()?)
        };
        let mut external = Vec::new();
        while let Some(value) = self.get(&format!("E{}", external.len() + 1)) {
            external.push(if let Value::Number(value, ..) = value { Some(*value) } else { None });
        }
        let position = Position { target, external };
        Ok(Ok(Taught { frame: self.text("UF"), tool: self.text("UT"), position, slots, comment }))
    }

    fn configuration(&self) -> Result<Option<Configuration>, Problem> {
        let Some(Value::Text(text, bytes)) = self.get("CONFIG") else { return Ok(None) };
        let parse = || {
            let mut parts = text.split(',').map(str::trim);
            let letters: Vec<&str> = parts.next()?.split_whitespace().collect();
            let turns: Vec<i32> = parts.map(|turn| turn.parse().ok()).collect::<Option<_>>()?;
            let either = |yes: &str, no: &str| match (letters.contains(&yes), letters.contains(&no)) {
                (true, false) => Some(true),
                (false, true) => Some(false),
                _ => None,
            };
            let [first, second, third] = turns[..] else { return None };
            let (flip, left, up, front) = (either("F", "N")?, either("L", "R"), either("U", "D")?, either("T", "B")?);
            let known = 3 + usize::from(left.is_some());
            let turns = [first, second, third];
            (letters.len() == known).then_some(Configuration::Fanuc { flip, left, up, front, turns })
        };
        let help = "write F or N, U or D, T or B, then the turns of axes 1, 4 and 6, as in `'N U T, 0, 0, 0'`";
        parse().map(Some).ok_or_else(|| (bytes.clone(), "the CONFIG is not known".to_owned(), help))
    }
}
