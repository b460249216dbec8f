//! Where effects sit.

use core::fmt;

/// Where an effect sits; displays as descriptions spell it (`joint 3`,
/// `joints 2,3`, `link 2`, `base`, `tool`, `a2`, `robot`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Place {
    /// One joint, from 1.
    Joint(usize),
    /// Two joints, from 1.
    Joints([usize; 2]),
    /// One link, from 1: the body between joints `i` and `i + 1`.
    Link(usize),
    /// The foundation.
    Base,
    /// The flange and what is mounted on it.
    Tool,
    /// One entry of the DH table.
    Entry(DhEntry),
    /// The whole robot.
    Robot,
}

impl Place {
    /// The place in a sentence: "joint 3", "joints 2 and 3", "the base".
    pub fn words(self) -> impl fmt::Display {
        struct Words(Place);
        impl fmt::Display for Words {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self.0 {
                    Place::Joints([i, j]) => write!(f, "joints {i} and {j}"),
                    Place::Base => f.write_str("the base"),
                    Place::Tool => f.write_str("the tool"),
                    Place::Robot => f.write_str("the robot"),
                    Place::Entry(entry) => write!(f, "{} of row {}", entry.column(), entry.row()),
                    place => place.fmt(f),
                }
            }
        }
        Words(self)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Joint(i) => write!(f, "joint {i}"),
            Self::Joints([i, j]) => write!(f, "joints {i},{j}"),
            Self::Link(i) => write!(f, "link {i}"),
            Self::Base => f.write_str("base"),
            Self::Tool => f.write_str("tool"),
            Self::Entry(entry) => entry.fmt(f),
            Self::Robot => f.write_str("robot"),
        }
    }
}

/// An entry of the DH table, by its column and its row, from 1; displays as
/// `a2`, `alpha1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DhEntry {
    /// The length along x.
    A(usize),
    /// The twist about x.
    Alpha(usize),
    /// The offset along z.
    D(usize),
    /// The angle about z.
    Theta(usize),
}

impl DhEntry {
    /// The column, as descriptions name it.
    pub const fn column(self) -> &'static str {
        match self {
            Self::A(_) => "a",
            Self::Alpha(_) => "alpha",
            Self::D(_) => "d",
            Self::Theta(_) => "theta",
        }
    }

    /// The row, from 1.
    pub const fn row(self) -> usize {
        let (Self::A(row) | Self::Alpha(row) | Self::D(row) | Self::Theta(row)) = self;
        row
    }

    /// Whether the entry is an angle; else it is a length.
    pub const fn is_angle(self) -> bool {
        matches!(self, Self::Alpha(_) | Self::Theta(_))
    }
}

impl fmt::Display for DhEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.column(), self.row())
    }
}
