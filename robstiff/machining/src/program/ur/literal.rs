//! Poses and angles as they stand in a program.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use crate::program::document::Slot;
use crate::program::source::Cursor;
use crate::program::{Position, Target};

/// `p[..]` or `[..]` with six numbers.
#[derive(Clone, Debug)]
pub(super) struct Literal {
    /// Which of the files, from 0.
    pub(super) file: usize,
    is_pose: bool,
    numbers: [f64; 6],
    pub(super) slots: Vec<Slot>,
}

impl Literal {
    /// The one that is next; `None` where something else is, or where it is computed.
    pub(super) fn read(file: usize, cursor: &mut Cursor<'_>) -> Option<Self> {
        let is_pose = cursor.eat("p[");
        if !is_pose && !cursor.eat("[") {
            return None;
        }
        let (mut numbers, mut slots) = ([0.0; 6], Vec::with_capacity(6));
        for (i, number) in numbers.iter_mut().enumerate() {
            let (value, bytes) = cursor.number()?;
            *number = value;
            slots.push(Slot::new(bytes));
            if !cursor.eat(if i < 5 { "," } else { "]" }) {
                return None;
            }
        }
        Some(Self { file, is_pose, numbers, slots })
    }

    /// The frame that it is; `None` of angles.
    pub(super) fn pose(&self) -> Option<Isometry3<f64>> {
        let [x, y, z, rx, ry, rz] = self.numbers;
        let turn = UnitQuaternion::from_scaled_axis(Vector3::new(rx, ry, rz));
        self.is_pose.then(|| Isometry3::from_parts(Translation3::new(x, y, z), turn))
    }

    /// The position that it is.
    pub(super) fn position(&self) -> Position {
        match self.pose() {
            Some(pose) => Target::Pose(pose, None).into(),
            None => Target::Joints(self.numbers.to_vec()).into(),
        }
    }
}
