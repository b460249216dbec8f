//! The part of a revolution in which a tooth cuts.

use core::f64::consts::PI;

/// An angle within this of a wall is at it (rad), a tenth of a degree: of a tool of 20 mm less than
/// a tenth of a micrometre is left of what is between them.
const AT_WALL: f64 = 2e-3;

/// Rounding of an angle that was written as half a turn (rad).
const ROUNDING: f64 = 1e-6;

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
    /// `0 <= entry < exit <= pi`, but for the rounding of pi.
    pub fn between(entry: f64, exit: f64) -> Option<Self> {
        let exit = if exit <= PI + ROUNDING { exit.min(PI) } else { exit };
        (0.0 <= entry && entry < exit && exit <= PI).then_some(Self { entry, exit })
    }

    /// Where the wall is that the cut leaves behind: 1 at +normal (up milling),
    /// -1 at -normal (down milling); `None` where it leaves both or neither. An angle a
    /// tenth of a degree from a wall is at it.
    pub fn wall(&self) -> Option<f64> {
        match self.meets() {
            [true, false] => Some(1.0),
            [false, true] => Some(-1.0),
            _ => None,
        }
    }

    /// Whether it leaves a wall on either side.
    pub fn is_slot(&self) -> bool {
        self.meets() == [true; 2]
    }

    /// Whether it meets the walls at +normal and at -normal.
    pub(crate) fn meets(&self) -> [bool; 2] {
        [self.entry <= AT_WALL, self.exit >= PI - AT_WALL]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Angles are written with some digits.
    #[test]
    fn angles_need_not_meet_the_wall_exactly() {
        let wall = |entry, exit| Engagement::between(entry, exit).expect("part of a turn").wall();
        assert_eq!([wall(1.77, PI - 1e-3), wall(1.77, PI + 5e-8), wall(1.77, PI)], [Some(-1.0); 3]);
        assert_eq!([wall(0.0, 1.4), wall(1e-3, 1.4)], [Some(1.0); 2]);
        assert_eq!([wall(0.5, 2.1), wall(0.0, PI), wall(1e-3, PI - 1e-3)], [None; 3]);
        assert_eq!(Engagement::between(1.0, 3.1417), None);
        assert!(Engagement::SLOT.is_slot() && !Engagement { entry: 0.5, exit: 2.1 }.is_slot());
    }
}
