//! What one number does to the world, and what it is likely to be.

use core::fmt;
use std::rc::Rc;

use nalgebra::Vector3;

use super::{Spring, Stand, World};

/// Where and when a row was read.
#[derive(Clone, Copy, Debug)]
pub struct At<'a> {
    /// The row, in the order in which they were read.
    pub row: usize,
    /// The joint coordinates (rad or m).
    pub q: &'a [f64],
    /// Those of the row before; its own where there is none.
    pub before: &'a [f64],
    /// When, from 0 at the first row to 1 at the last; the order of rows where no time is given.
    pub time: f64,
    /// For how long the visit has lasted (s); a minute a row where no time is given.
    pub in_visit: f64,
    /// By how much it is warmer than on average (K); zero where no temperature is given.
    pub warmer: f64,
    /// The force over the root mean square of all forces; zero where nothing loads the arm.
    pub load: f64,
    /// Whether the load is larger than that of the row before in its visit (1), or not (-1).
    pub growing: f64,
    /// The tool centre point as declared, from the middle of all rows, in the base frame (m).
    pub place: Vector3<f64>,
    /// Where the arm stands.
    pub stand: &'a Stand,
}

/// The torque of one joint through all rows, in the order in which they were read.
#[derive(Clone, Copy, Debug)]
pub struct Torques<'a> {
    /// Of the load (Nm or N).
    pub load: &'a [f64],
    /// What the arm's own weight puts on the gear before, as declared (Nm or N).
    pub preload: &'a [f64],
    /// What it would put there if no compensator carried a part (Nm or N); zero where no mass is
    /// known.
    pub weight: &'a [f64],
    /// The joint's coordinate (rad or m).
    pub q: &'a [f64],
    /// Those of all joints, a list each; none on clamped axes.
    pub all: &'a [Vec<f64>],
    /// The visit of each row: a sequence of loads that begins on an arm at rest.
    pub visit: &'a [usize],
    /// For how long the visit has lasted (s).
    pub in_visit: &'a [f64],
}

/// How far a joint turns under its torque through all rows, per unit.
pub type Law = Rc<dyn Fn(&Torques<'_>) -> Vec<f64>>;

/// The same for each joint (from 1).
pub type LawOfEach = Rc<dyn Fn(usize, &Torques<'_>) -> Vec<f64>>;

/// A number of the time since something happened (s).
pub type OfTime = Rc<dyn Fn(f64) -> f64>;

/// A number of each row.
pub type OfRow = Rc<dyn Fn(&At<'_>) -> f64>;

/// A number of each row and joint (from 1).
pub type OfJoint = Rc<dyn Fn(&At<'_>, usize) -> f64>;

/// A vector of each row.
pub type VectorOfRow = Rc<dyn Fn(&At<'_>) -> Vector3<f64>>;

/// What a number makes of the arm and the rig.
pub type OnWorld = Rc<dyn Fn(&mut World, f64)>;

/// Calls something with each row in turn.
pub type EachRow<'a> = dyn FnMut(&mut dyn FnMut(&At<'_>)) + 'a;

/// What a unit of a number does.
#[derive(Clone)]
pub enum Term {
    /// It is the compliance of a spring.
    Spring(Spring),
    /// A joint (from 1) yields to its torque by a law.
    Law(usize, Law),
    /// Every joint yields to its torque by a law, with one number for all.
    Laws(LawOfEach),
    /// A joint (from 1) stands aside of its coordinate without any load, by a turn about an axis of
    /// its own frame (rad); along z by a shift (m) where it slides.
    Aside(usize, usize, OfRow),
    /// Every joint stands aside so along its own coordinate, by a number of each row and joint (from 1).
    Asides(OfJoint),
    /// It is a number of the table: of a joint (from 1), and which ([`THETA`](super::arm::THETA) and so
    /// on).
    Table(usize, usize),
    /// It changes the arm or the rig; what the readings make of that is not linear.
    World(OnWorld),
    /// It adds to a position or displacement, in the base frame (m).
    Reading(VectorOfRow),
    /// The arm yields more by this share.
    Gain(OfRow),
    /// Whatever a change of the load makes the arm yield, it yields further by this share of it.
    Creep(OfTime),
    /// A spring whose compliance falls as `1 / sqrt(1 + (m / knee)^2)` with the load `m` on it, the knee over the
    /// largest of all rows.
    Hardening(Spring, f64),
}

impl Term {
    /// Whether it is the same as another: an equal spring or number of the table, or one and the same function.
    pub fn is(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Spring(a), Self::Spring(b)) => a == b,
            (Self::Hardening(a, knee), Self::Hardening(b, other)) => a == b && knee == other,
            (Self::Table(joint, number), Self::Table(other, another)) => joint == other && number == another,
            (Self::Law(joint, a), Self::Law(other, b)) => joint == other && Rc::ptr_eq(a, b),
            (Self::Laws(a), Self::Laws(b)) => Rc::ptr_eq(a, b),
            (Self::Aside(i, x, a), Self::Aside(j, y, b)) => i == j && x == y && Rc::ptr_eq(a, b),
            (Self::Asides(a), Self::Asides(b)) => Rc::ptr_eq(a, b),
            (Self::World(a), Self::World(b)) => Rc::ptr_eq(a, b),
            (Self::Reading(a), Self::Reading(b)) => Rc::ptr_eq(a, b),
            (Self::Gain(a), Self::Gain(b)) => Rc::ptr_eq(a, b),
            (Self::Creep(a), Self::Creep(b)) => Rc::ptr_eq(a, b),
            _ => false,
        }
    }
}

impl fmt::Debug for Term {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Spring(spring) => write!(f, "{spring:?}"),
            Self::Law(joint, _) => write!(f, "law of joint {joint}"),
            Self::Laws(_) => f.write_str("laws of all joints"),
            Self::Aside(joint, axis, _) => write!(f, "joint {joint} aside about axis {axis}"),
            Self::Asides(_) => f.write_str("all joints aside"),
            Self::Table(joint, number) => write!(f, "number {number} of row {joint}"),
            Self::World(_) => f.write_str("world"),
            Self::Reading(_) => f.write_str("reading"),
            Self::Gain(_) => f.write_str("gain"),
            Self::Creep(_) => f.write_str("creep"),
            Self::Hardening(spring, _) => write!(f, "hardening {spring:?}"),
        }
    }
}

/// Which values a number can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Any.
    Free,
    /// None below zero.
    Nonnegative,
}

/// What a number is likely to be: the standard deviation of its prior, normal where it can have any
/// sign and half-normal where it cannot be negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// In its unit.
    Of(f64),
    /// So much that it moves the readings by this, in the root mean square (m, rad).
    Moves(f64),
    /// Learned with all others of a group, beginning with this.
    Learned(usize, f64),
    /// As much as the noise of one reading.
    Noise,
    /// Nothing is known (the standard deviation is far beyond any value, in its unit).
    Flat(f64),
}

/// A number that can be off.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it does.
    pub term: Term,
    /// What it is likely to be.
    pub size: Size,
    /// Which values it can have.
    pub sign: Sign,
    /// The value about which it is likely to be: zero, but for what a description declares.
    pub mean: f64,
}

impl Parameter {
    /// A number that is zero as declared and can have any sign.
    pub fn new(name: &'static str, unit: &'static str, size: Size, term: Term) -> Self {
        Self { name, unit, term, size, sign: Sign::Free, mean: 0.0 }
    }

    /// The same where it cannot be negative.
    #[must_use]
    pub fn nonnegative(mut self) -> Self {
        self.sign = Sign::Nonnegative;
        self
    }

    /// The compliance of a spring.
    pub fn compliance(name: &'static str, unit: &'static str, size: f64, spring: Spring) -> Self {
        Self::new(name, unit, Size::Of(size), Term::Spring(spring)).nonnegative()
    }

    /// A number of the arm or the rig.
    pub fn of_world(
        name: &'static str,
        unit: &'static str,
        size: f64,
        changes: impl Fn(&mut World, f64) + 'static,
    ) -> Self {
        Self::new(name, unit, Size::Of(size), Term::World(Rc::new(changes)))
    }
}
