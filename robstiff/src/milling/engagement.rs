//! The part of a revolution in which a tooth cuts.

use core::f64::consts::PI;

/// Which way the teeth go through the material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Up (conventional) milling: the chip begins thin.
    Up,
    /// Down (climb) milling: the chip ends thin.
    Down,
}

/// The angles at which a tooth enters the material and leaves it (rad),
/// `0 <= entry < exit <= pi`, from the normal, as the spindle turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engagement {
    /// Where the tooth enters.
    pub entry: f64,
    /// Where it leaves.
    pub exit: f64,
}

impl Engagement {
    /// A slot as wide as the tool.
    pub const SLOT: Self = Self { entry: 0.0, exit: PI };

    /// The engagement at a radial width of cut from a wall, with the tool's
    /// diameter in the same unit; `None` where the width is not above zero and
    /// at most the diameter.
    pub fn of_width(direction: Direction, width: f64, diameter: f64) -> Option<Self> {
        if !(width > 0.0 && width <= diameter) {
            return None;
        }
        let arc = (1.0 - 2.0 * width / diameter).acos();
        Some(match direction {
            Direction::Up => Self { entry: 0.0, exit: arc },
            Direction::Down => Self { entry: PI - arc, exit: PI },
        })
    }

    /// The engagement between two angles (rad); `None` where they are not
    /// `0 <= entry < exit <= pi`.
    pub fn between(entry: f64, exit: f64) -> Option<Self> {
        (0.0 <= entry && entry < exit && exit <= PI).then_some(Self { entry, exit })
    }

    /// Where the wall is that the cut leaves behind: 1 at +normal (up milling),
    /// -1 at -normal (down milling); `None` where it leaves both or neither.
    pub fn wall(&self) -> Option<f64> {
        match (self.entry <= 0.0, self.exit >= PI) {
            (true, false) => Some(1.0),
            (false, true) => Some(-1.0),
            _ => None,
        }
    }
}
