//! Aggregates: `[[x,y,z],[q1,q2,q3,q4],..]`.

use std::ops::Range;

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use crate::program::document::Slot;
use crate::program::source::Cursor;
use crate::program::{Configuration, Position, Target};

/// Coordinates from here on stand for an axis that is not there: `9E9`.
const NO_AXIS: f64 = 8.9e9;

/// A unit quaternion is rounded by less than this.
const ROUNDED: f64 = 2e-3;

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Data {
    List(Vec<Data>),
    Number(f64, Range<usize>),
    Other(String),
}

/// Why a value is no position.
pub(super) enum NoPosition {
    /// It is known at run time alone.
    Computed(String),
    /// It is wrong.
    Wrong(Range<usize>, String),
}

impl Data {
    /// Reads a value; `None` where a list does not end.
    pub(super) fn read(cursor: &mut Cursor<'_>) -> Option<Self> {
        // Lists inside lists: nobody writes more than five.
        Self::nested(cursor, 16)
    }

    fn nested(cursor: &mut Cursor<'_>, depth: usize) -> Option<Self> {
        if cursor.eat("[") {
            let mut items = Vec::new();
            loop {
                if cursor.eat("]") {
                    return Some(Self::List(items));
                }
                let before = cursor.at;
                if depth == 0 || cursor.is_done() {
                    return None;
                }
                items.push(Self::nested(cursor, depth - 1)?);
                cursor.eat(",");
                // At a `;` nothing more comes.
                if cursor.at == before {
                    return None;
                }
            }
        }
        let mut ahead = *cursor;
        if let Some((value, bytes)) = ahead.number()
            && matches!(ahead.peek(), None | Some(',' | ']' | ';'))
        {
            *cursor = ahead;
            return Some(Self::Number(value, bytes));
        }
        let text = cursor.until(&[',', ']', ';']).trim().to_owned();
        Some(Self::Other(text))
    }

    fn list(&self) -> Option<&[Self]> {
        match self {
            Self::List(items) => Some(items),
            _ => None,
        }
    }

    pub(super) fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value, _) => Some(*value),
            _ => None,
        }
    }

    pub(super) fn item(&self, index: usize) -> Option<&Self> {
        self.list()?.get(index)
    }

    pub(super) fn is_word(&self, word: &str) -> bool {
        matches!(self, Self::Other(text) if text.eq_ignore_ascii_case(word))
    }

    /// The numbers of a list and where they stand.
    fn numbers(&self) -> Option<Vec<(f64, Range<usize>)>> {
        let number = |item: &Self| match item {
            Self::Number(value, bytes) => Some((*value, bytes.clone())),
            _ => None,
        };
        self.list()?.iter().map(number).collect()
    }

    /// `[[x,y,z],[q1,q2,q3,q4]]`.
    pub(super) fn pose(&self) -> Option<Isometry3<f64>> {
        let (at, turn) = (self.item(0)?.numbers()?, self.item(1)?.numbers()?);
        pose(&at, &turn)?.ok()
    }

    /// The `robtarget` that it is, and where its numbers stand.
    pub(super) fn robtarget(&self) -> Result<(Position, Vec<Slot>), NoPosition> {
        let computed = || NoPosition::Computed("a part of its position is known at run time alone".to_owned());
        let part = |index| self.item(index).and_then(Self::numbers).ok_or_else(computed);
        let (at, turn, conf, external) = (part(0)?, part(1)?, part(2)?, part(3)?);
        let pose = match pose(&at, &turn) {
            None => return Err(computed()),
            Some(Err(norm)) => {
                let bytes = turn[0].1.start..turn[3].1.end;
                return Err(NoPosition::Wrong(bytes, format!("the quaternion's length is {norm:.4}, not 1")));
            }
            Some(Ok(pose)) => pose,
        };
        let [cf1, cf4, cf6, cfx] = conf.iter().map(|(value, _)| *value as i32).collect::<Vec<_>>()[..] else {
            return Err(computed());
        };
        let target = Target::Pose(pose, Some(Configuration::Abb([cf1, cf4, cf6, cfx])));
        let slots = at.into_iter().chain(turn).map(|(_, bytes)| Slot::new(bytes)).collect();
        Ok((Position { target, external: axes(&external) }, slots))
    }

    /// The `jointtarget` that it is, and where its numbers stand.
    pub(super) fn jointtarget(&self) -> Result<(Position, Vec<Slot>), NoPosition> {
        let computed = || NoPosition::Computed("a part of its position is known at run time alone".to_owned());
        let part = |index| self.item(index).and_then(Self::numbers).ok_or_else(computed);
        let (mut joints, external) = (part(0)?, part(1)?);
        // Arms of four axes have six numbers, too.
        while joints.last().is_some_and(|(value, _)| *value > NO_AXIS) {
            joints.pop();
        }
        let target = Target::Joints(joints.iter().map(|(degrees, _)| degrees.to_radians()).collect());
        let slots = joints.into_iter().map(|(_, bytes)| Slot::new(bytes)).collect();
        Ok((Position { target, external: axes(&external) }, slots))
    }
}

fn axes(numbers: &[(f64, Range<usize>)]) -> Vec<Option<f64>> {
    let mut axes: Vec<Option<f64>> = numbers.iter().map(|(value, _)| (*value < NO_AXIS).then_some(*value)).collect();
    while axes.last() == Some(&None) {
        axes.pop();
    }
    axes
}

/// A pose, or the length of a quaternion that is no unit one; `None` for other counts.
fn pose(at: &[(f64, Range<usize>)], turn: &[(f64, Range<usize>)]) -> Option<Result<Isometry3<f64>, f64>> {
    let ([x, y, z], [w, i, j, k]) = (at, turn) else { return None };
    let quaternion = Quaternion::new(w.0, i.0, j.0, k.0);
    if (quaternion.norm() - 1.0).abs() > ROUNDED {
        return Some(Err(quaternion.norm()));
    }
    let at = Translation3::new(x.0 * 1e-3, y.0 * 1e-3, z.0 * 1e-3);
    Some(Ok(Isometry3::from_parts(at, UnitQuaternion::from_quaternion(quaternion))))
}
