//! The vocabulary in which a file of the catalogue states its effect; the
//! generator interprets it on symbols, the runtime on numbers.

#[cfg(feature = "read")]
use {
    crate::words::significant,
    std::{borrow::ToOwned, format, string::String},
};

use super::{DhEntry, Place, Scalar};
use crate::dimension::Dimension;

/// What is known of a kind of effect besides its formulas.
#[derive(Debug)]
pub struct About {
    /// The kind as descriptions and reports spell it, e.g. `lost_motion`.
    pub kind: &'static str,
    /// Where effects of this kind sit.
    pub at: At,
    /// Whether it moves frames rather than yields to loads.
    pub kinematic: bool,
    /// The effect as a noun, for a sentence; `{}` is the place.
    pub noun: &'static str,
    /// What it is, what causes it, and what one does about it.
    pub explanation: &'static str,
    /// How large it is on real robots; empty where no source tells.
    pub typical: &'static str,
    /// The numbers it takes, in order.
    pub parameters: &'static [Parameter],
}

/// Where effects of a kind can sit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// Any joint.
    Joint,
    /// A joint that turns.
    TurningJoint,
    /// Two joints that turn.
    TurningJoints,
    /// A link between two joints.
    Link,
    /// The foundation.
    Base,
    /// The tool.
    Tool,
    /// An entry of the DH table.
    Entry,
    /// The whole robot.
    Robot,
}

impl At {
    /// An example of such a place, as a description writes it.
    pub const fn example(self) -> &'static str {
        match self {
            Self::Joint | Self::TurningJoint => "joint 3",
            Self::TurningJoints => "\"joints 2,3\"",
            Self::Link => "link 2",
            Self::Base => "base",
            Self::Tool => "tool",
            Self::Entry => "a2",
            Self::Robot => "robot",
        }
    }

    /// Whether a place is of this sort.
    pub const fn takes(self, place: Place) -> bool {
        matches!(
            (self, place),
            (Self::Joint | Self::TurningJoint, Place::Joint(_))
                | (Self::TurningJoints, Place::Joints(_))
                | (Self::Link, Place::Link(_))
                | (Self::Base, Place::Base)
                | (Self::Tool, Place::Tool)
                | (Self::Entry, Place::Entry(_))
                | (Self::Robot, Place::Robot)
        )
    }
}

/// One number of an effect.
#[derive(Debug)]
pub struct Parameter {
    /// The name in descriptions; reports may call a `value` by another, such as `h`.
    pub name: &'static str,
    /// The name in generated code, before the number of the place.
    pub symbol: &'static str,
    /// What it is, for generated docs; "of joint 3", "of the base" follows.
    pub what: &'static str,
    /// The quantity, which gives the unit.
    pub quantity: Quantity,
    /// What values are physical.
    pub range: Range,
    /// The value where it is left out; without one it must be given.
    pub default: Option<f64>,
    /// A value as a description writes it.
    pub example: &'static str,
}

/// What sort of quantity a parameter is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The same wherever the effect sits.
    Of(Dimension),
    /// That of the entry of the DH table: a length or an angle.
    Entry,
}

impl Quantity {
    /// The dimension of the parameter of an effect at a place.
    pub const fn at(self, place: Place) -> Dimension {
        match (self, place) {
            (Self::Of(dimension), _) => dimension,
            (Self::Entry, Place::Entry(entry)) if entry.is_angle() => Dimension::Angle,
            (Self::Entry, _) => Dimension::Length,
        }
    }
}

/// The values that are physical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Any finite number.
    Any,
    /// Zero or more.
    NotNegative,
    /// More than zero.
    Positive,
    /// A whole number from 1 to this.
    Whole(u16),
}

impl Range {
    /// Whether a finite number is within.
    pub const fn contains(self, value: f64) -> bool {
        match self {
            Self::Any => true,
            Self::NotNegative => value >= 0.0,
            Self::Positive => value > 0.0,
            Self::Whole(most) => value >= 1.0 && value <= most as f64 && value == (value as u16) as f64,
        }
    }
}

/// A linear elastic element: a few elastic coordinates with one compliance
/// `h`; each adds `h s s^T` to the Cartesian compliance, `s` being the twist of
/// the tool centre point when the coordinate moves by one.
///
/// Joints and links count from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spring {
    /// A joint along its own coordinate [rad/Nm or m/N].
    Joint(usize),
    /// The tilt of a joint about x and y of its joint frame (rad/Nm).
    Transverse(usize),
    /// The bending of a uniform, round beam from the origin of joint frame
    /// `i` to that of joint frame `i + 1`: `L / EI` (rad/Nm).
    LinkBending(usize),
    /// Its torsion: `L / GJ` (rad/Nm).
    LinkTorsion(usize),
    /// The tilt of the base about x and y of frame 0 (rad/Nm).
    BaseTilt,
    /// The displacement of the base in every direction (m/N).
    BaseTranslation,
    /// The turn of what is mounted on the flange, about every axis through the
    /// flange frame's origin (rad/Nm).
    ToolRotation,
    /// The displacement of what is mounted on the flange in every direction
    /// (m/N).
    ToolTranslation,
    /// The off-diagonal entry of `H_q` that two joints share (rad/Nm).
    Coupling([usize; 2]),
}

/// How many play operators a joint has.
pub const PLAYS: usize = 3;

/// What the law of a joint may depend on.
pub struct Joint<'a, S> {
    /// The joint's own compliance (rad/Nm).
    pub compliance: S,
    /// The torque (Nm).
    pub torque: S,
    /// The play operators after this load (Nm).
    pub plays: [S; PLAYS],
    /// Sine and cosine of a whole multiple of the joint coordinate.
    pub harmonic: &'a dyn Fn(f64) -> (S, S),
}

/// A row of the DH table [rad, m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The angle about z.
    pub theta: f64,
    /// The offset along z.
    pub d: f64,
    /// The length along x.
    pub a: f64,
    /// The twist about x.
    pub alpha: f64,
}

impl Row {
    /// One entry.
    pub fn entry(&mut self, entry: DhEntry) -> &mut f64 {
        match entry {
            DhEntry::A(_) => &mut self.a,
            DhEntry::Alpha(_) => &mut self.alpha,
            DhEntry::D(_) => &mut self.d,
            DhEntry::Theta(_) => &mut self.theta,
        }
    }
}

/// What is wrong with the numbers of an effect.
#[cfg(feature = "read")]
pub struct Complaint {
    /// The parameter at fault.
    pub parameter: &'static str,
    /// The one that asks for it, shown where it is left out.
    pub otherwise: Option<&'static str>,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
}

/// The least torque at a knee (Nm): no gear settles on so little, and in `f32` the square of
/// a torque over a much smaller one is infinite, and the law lost.
#[cfg(feature = "read")]
pub const LEAST_KNEE: f64 = 1e-6;

/// What is wrong with the knee of a law.
#[cfg(feature = "read")]
pub(super) fn tiny_knee(knee: f64) -> Option<Complaint> {
    (knee < LEAST_KNEE).then(|| Complaint {
        parameter: "knee",
        otherwise: None,
        message: format!("a knee of {} Nm is below {LEAST_KNEE:e} Nm: no gear settles on so little", significant(knee)),
        help: "give the torque at which the law bends, e.g. `knee: 30 Nm`; check the unit".to_owned(),
    })
}

/// A kind of effect with `P` parameters: a file of the catalogue implements
/// what its effect has, and leaves the rest.
///
/// Formulas are generic: `parameters` are numbers where the runtime computes,
/// symbols where code is generated.
pub trait Physics<const P: usize> {
    /// Name, place, parameters, and what a person is told.
    const ABOUT: About;

    /// Whether [`turn`](Self::turn) is linear in the torque and the play operators, so that
    /// what the gear carries before the load makes no difference to it.
    const LINEAR: bool = false;

    /// The linear elements, one for each parameter, its compliance.
    fn springs(_place: Place) -> [Option<Spring>; P] {
        [None; P]
    }

    /// By how much the joint turns more (rad) than by its own compliance.
    fn turn<S: Scalar>(_parameters: [S; P], _joint: &Joint<S>) -> Option<S> {
        None
    }

    /// How many of the joint's play operators the effect uses.
    fn plays_in_use(_numbers: [f64; P]) -> usize {
        0
    }

    /// The joint's play operators (Nm) after a torque (Nm) that follows
    /// the state `before`.
    fn plays<S: Scalar>(_parameters: [S; P], _torque: S, before: [S; PLAYS]) -> [S; PLAYS] {
        before
    }

    /// Corrects the row of the DH table that the effect sits at.
    fn correct(_numbers: [f64; P], _place: Place, _row: &mut Row) {}

    /// By how much the joint stands aside (rad) of its coordinate, without
    /// load; at most [`MOST_DEVIATION`].
    fn deviation<S: Scalar>(_numbers: [f64; P], _parameters: [S; P], _harmonic: &dyn Fn(f64) -> (S, S)) -> Option<S> {
        None
    }

    /// The share of the arm's own weight that every joint yields to, unloaded.
    fn share_of_weight<S: Scalar>(_parameters: [S; P]) -> Option<S> {
        None
    }

    /// The share of the arm's own weight that gears carry before the load.
    fn share_of_preload<S: Scalar>(_parameters: [S; P]) -> Option<S> {
        None
    }

    /// The effect as a noun, where it depends on the numbers.
    fn noun(_numbers: [f64; P]) -> &'static str {
        Self::ABOUT.noun
    }

    /// What it is, what causes it and what one does about it, where that depends on the numbers.
    fn explanation(_numbers: [f64; P]) -> &'static str {
        Self::ABOUT.explanation
    }

    /// What physics asks of the numbers beyond their ranges, on a joint with
    /// this compliance of its own (rad/Nm).
    #[cfg(feature = "read")]
    fn check(_numbers: [f64; P], _place: Place, _compliance: f64) -> Option<Complaint> {
        None
    }

    /// What the effect adds at least to the tangent compliance of its joint,
    /// over all poses and torques (rad/Nm); negative where it takes away.
    #[cfg(feature = "read")]
    fn least(_numbers: [f64; P], _compliance: f64) -> f64 {
        0.0
    }
}

/// The most a joint may stand aside of its coordinate (rad), 17 arcmin: up to
/// here the generator's series for its sine and cosine are exact to rounding,
/// and more is no error of a gear.
pub const MOST_DEVIATION: f64 = 5e-3;

/// The most a joint may yield to the arm's own weight (rad), 1.1 degrees: as
/// [`MOST_DEVIATION`], with longer series.
pub const MOST_SAG: f64 = 2e-2;
