//! Aggregates: `{E6POS: X 10.0,Y 0.0,..}`.

use std::ops::Range;

use nalgebra::Isometry3;

use super::{AXES, EXTERNAL, POSE, pose};
use crate::program::document::Slot;
use crate::program::source::Cursor;
use crate::program::{Configuration, Position, Target};

/// A value of several fields.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Aggregate {
    fields: Vec<(String, Value)>,
    /// The byte of the closing brace.
    end: usize,
}

#[derive(Clone, Debug, PartialEq)]
enum Value {
    Number(f64, Range<usize>),
    Other(String),
}

/// Why a text is no aggregate.
pub(super) struct NoAggregate {
    pub(super) bytes: Range<usize>,
    pub(super) message: String,
}

/// The posture and axes before, which a position that leaves some out keeps.
#[derive(Clone, Debug, Default)]
pub(super) struct Before {
    pub(super) pose: Option<[f64; 6]>,
    pub(super) axes: Option<Vec<f64>>,
}

impl Aggregate {
    /// Reads an aggregate, the cursor before its brace.
    pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<Self, NoAggregate> {
        cursor.skip_space();
        let open = cursor.at;
        let wrong = |bytes, message: &str| NoAggregate { bytes, message: message.to_owned() };
        if !cursor.eat("{") {
            return Err(wrong(open..open + 1, "`{` is expected here"));
        }
        let mut ahead = *cursor;
        if ahead.word().is_some() && ahead.eat(":") {
            *cursor = ahead;
        }
        let mut fields: Vec<(String, Value)> = Vec::new();
        loop {
            cursor.skip_space();
            let at = cursor.at;
            if cursor.eat("}") {
                return Ok(Self { fields, end: at });
            }
            let Some(name) = cursor.word() else {
                let message =
                    if cursor.is_done() { "the `{` is not closed" } else { "the name of a field is expected here" };
                let place = if cursor.is_done() { open..open + 1 } else { at..at + 1 };
                return Err(wrong(place, message));
            };
            if cursor.eat("[") {
                cursor.until(&[']']);
                cursor.eat("]");
            }
            let name = name.to_ascii_uppercase();
            if fields.iter().any(|(other, _)| *other == name) {
                return Err(wrong(at..cursor.at, &format!("`{name}` is given twice")));
            }
            fields.push((name, Value::read(cursor)));
            cursor.eat(",");
        }
    }

    /// A field that is a number.
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Number(value, _) => Some(*value),
            Value::Other(_) => None,
        }
    }

    /// A field that is no number, as it is written.
    pub(super) fn other(&self, name: &str) -> Option<&str> {
        match self.get(name)? {
            Value::Number(..) => None,
            Value::Other(text) => Some(text),
        }
    }

    fn get(&self, name: &str) -> Option<&Value> {
        self.fields.iter().find(|(field, _)| field == name).map(|(_, value)| value)
    }

    /// The frame that it is, if it gives all six numbers; those that a frame leaves out are 0.
    pub(super) fn frame(&self) -> Option<Isometry3<f64>> {
        let mut numbers = [0.0; 6];
        for (number, name) in numbers.iter_mut().zip(POSE) {
            *number = match self.get(name) {
                Some(Value::Number(value, _)) => *value,
                Some(Value::Other(_)) => return None,
                None => 0.0,
            };
        }
        Some(pose(numbers))
    }

    /// The position that it is, and where its numbers stand; or why it is none.
    pub(super) fn position(&self, before: &mut Before) -> Result<(Position, Vec<Slot>), String> {
        if let Some((name, Value::Other(text))) = self.fields.iter().find(|(name, value)| {
            let of_position = POSE.contains(&name.as_str()) || AXES.contains(&name.as_str());
            of_position && matches!(value, Value::Other(_))
        }) {
            return Err(format!("{name} is `{text}`, which is known at run time alone"));
        }
        let has = |names: &[&str]| names.iter().any(|name| self.get(name).is_some());
        let (target, slots) = match (has(&AXES), has(&POSE)) {
            (true, true) => return Err("it gives both axes and a pose".to_owned()),
            (false, false) => return Err("it gives neither axes nor a pose".to_owned()),
            (true, false) => self.axes(before)?,
            (false, true) => self.pose(before)?,
        };
        let last = EXTERNAL.iter().rposition(|name| self.get(name).is_some()).map_or(0, |last| last + 1);
        let external = EXTERNAL[..last].iter().map(|name| self.number(name)).collect();
        Ok((Position { target, external }, slots))
    }

    fn axes(&self, before: &mut Before) -> Result<(Target, Vec<Slot>), String> {
        let last = AXES.iter().rposition(|name| self.get(name).is_some()).map_or(0, |last| last + 1);
        // Arms of four and five axes are declared with as many.
        let count = before.axes.as_ref().map_or(last, |axes| axes.len().max(last));
        let complete = last >= 4 && AXES[..last].iter().all(|name| self.get(name).is_some());
        let count = if complete { last } else { count };
        let (mut axes, mut slots) = (Vec::new(), Vec::new());
        for (i, name) in AXES.iter().enumerate().take(count) {
            let known = before.axes.as_ref().and_then(|axes| axes.get(i)).copied().filter(|_| !complete);
            let (value, slot) = self.slot(name, known, [",A1 ", ",A2 ", ",A3 ", ",A4 ", ",A5 ", ",A6 "][i])?;
            axes.push(value);
            slots.push(slot);
        }
        if !complete && before.axes.is_none() {
            return Err("it leaves out axes, which no position before gives".to_owned());
        }
        *before = Before { axes: Some(axes.clone()), pose: None };
        Ok((Target::Joints(axes.into_iter().map(f64::to_radians).collect()), slots))
    }

    fn pose(&self, before: &mut Before) -> Result<(Target, Vec<Slot>), String> {
        let (mut numbers, mut slots) = ([0.0; 6], Vec::new());
        for (i, name) in POSE.iter().enumerate() {
            let known = before.pose.map(|numbers| numbers[i]);
            let (value, slot) = self.slot(name, known, [",X ", ",Y ", ",Z ", ",A ", ",B ", ",C "][i])?;
            numbers[i] = value;
            slots.push(slot);
        }
        *before = Before { axes: None, pose: Some(numbers) };
        let bits = |name: &str| {
            let value = self.number(name)?;
            (value >= 0.0 && value.fract() == 0.0 && value <= f64::from(u32::MAX)).then_some(value as u32)
        };
        let (status, turn) = (bits("S"), bits("T"));
        let configuration = (status.is_some() || turn.is_some()).then_some(Configuration::Kuka { status, turn });
        Ok((Target::Pose(pose(numbers), configuration), slots))
    }

    /// A number and where it stands; where it is left out, what it keeps and where to put it.
    fn slot(&self, name: &str, known: Option<f64>, before: &'static str) -> Result<(f64, Slot), String> {
        match (self.get(name), known) {
            (Some(Value::Number(value, bytes)), _) => Ok((*value, Slot::new(bytes.clone()))),
            (None, Some(value)) => Ok((value, Slot { bytes: self.end..self.end, before })),
            _ => Err(format!("it leaves out {name}, which no position before gives")),
        }
    }
}

impl Value {
    fn read(cursor: &mut Cursor<'_>) -> Self {
        cursor.skip_space();
        let mut ahead = *cursor;
        if let Some((value, bytes)) = ahead.number()
            && matches!(ahead.peek(), Some(',' | '}'))
        {
            *cursor = ahead;
            return Self::Number(value, bytes);
        }
        // A text in quotes, an aggregate inside, an enumeration, an expression.
        let rest = cursor.rest();
        let (mut depth, mut quoted) = (0, false);
        let end = rest.char_indices().find(|&(_, letter)| {
            match letter {
                '"' => quoted = !quoted,
                '{' | '(' | '[' if !quoted => depth += 1,
                '}' | ')' | ']' if !quoted && depth > 0 => depth -= 1,
                ',' | '}' if !quoted && depth == 0 => return true,
                _ => {}
            }
            false
        });
        let length = end.map_or(rest.len(), |(length, _)| length);
        cursor.at += length;
        Self::Other(rest[..length].trim_end().to_owned())
    }
}
