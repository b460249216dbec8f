//! The words of a description that the runtime shares: conventions, kinds of
//! joints, and the catalogue of effects.
//!
//! An effect is one file: its parameters with their units and physical ranges,
//! its formula, and what a person is told of it, in the vocabulary of
//! [`physics`]. The list [`Effect`] is made from, below, is the registry; a file, its
//! module and a line there are all that a new effect needs which is made of the elements
//! and laws that there are: reading, writing, checking, generated code, the generic robot
//! and `robstiff show` take the rest from it. Tracing has a catalogue of its own of what it
//! looks for.

pub mod base_compliance;
pub mod dh_error;
pub mod gravity_preload;
pub mod gravity_sag;
pub mod hysteresis;
mod joint;
pub mod joint_coupling;
pub mod joint_zero_offset;
pub mod link_compliance;
pub mod lost_motion;
pub mod physics;
mod place;
pub mod pose_dependent_compliance;
#[macro_use]
mod registry;
mod scalar;
pub mod stiffness_nonlinearity;
pub mod tool_compliance;
pub mod transmission_error;
pub mod transverse_compliance;

use core::fmt;

use physics::{About, Joint, PLAYS, Parameter, Physics, Row, Spring};

pub use crate::dimension::Dimension;
pub use joint::{Convention, JointKind};
pub use place::{DhEntry, Place};
pub use registry::{MOST_PARAMETERS, Numbers};
pub use scalar::{Scalar, Tangent};

registry! {
    transverse_compliance::TransverseCompliance, Joint(joint: usize), value;
    link_compliance::LinkCompliance, Link(link: usize), bending, torsion;
    base_compliance::BaseCompliance, Base(), tilt, translation;
    tool_compliance::ToolCompliance, Tool(), rotation, translation;
    joint_coupling::JointCoupling, Joints(joints: [usize; 2]), value;
    stiffness_nonlinearity::StiffnessNonlinearity, Joint(joint: usize), added, knee;
    lost_motion::LostMotion, Joint(joint: usize), gap, knee;
    hysteresis::Hysteresis, Joint(joint: usize), radius1, weight1, radius2, weight2, radius3, weight3;
    pose_dependent_compliance::PoseDependentCompliance, Joint(joint: usize), cos1, sin1, cos2, sin2;
    joint_zero_offset::JointZeroOffset, Joint(joint: usize), value;
    dh_error::DhError, Entry(entry: DhEntry), value;
    transmission_error::TransmissionError, Joint(joint: usize), order, sin, cos;
    gravity_sag::GravitySag, Robot(), share;
    gravity_preload::GravityPreload, Robot(), share;
}

impl Effect {
    /// The kind as descriptions and reports spell it, e.g.
    /// `transverse_compliance`.
    pub const fn kind(&self) -> &'static str {
        self.about().kind
    }

    /// Whether it moves frames rather than yields to loads.
    pub const fn is_kinematic(&self) -> bool {
        self.about().kinematic
    }

    /// Whether another is one with it, whatever their numbers: of the same name, or an error of
    /// theta beside the zero offset of the joint that turns there.
    pub fn is_same(&self, other: &Self) -> bool {
        self.number() == other.number()
    }

    /// The number of the robot that it is, by kind and place: a joint's zero is the same as its
    /// `theta`.
    pub(crate) const fn number(&self) -> (&'static str, Place) {
        match *self {
            Self::DhError { entry: DhEntry::Theta(joint), .. } => ("joint_zero_offset", Place::Joint(joint)),
            _ => (self.kind(), self.place()),
        }
    }

    /// What the kind's numbers are, with this effect's, in order.
    pub fn parameters(&self) -> impl Iterator<Item = (&'static Parameter, f64)> + use<> {
        self.about().parameters.iter().zip(self.numbers())
    }

    /// The row of the DH table (from 1) that the effect sits at, if it sits at
    /// one.
    pub const fn row(&self) -> Option<usize> {
        match self.place() {
            Place::Joint(joint) => Some(joint),
            Place::Entry(entry) => Some(entry.row()),
            _ => None,
        }
    }

    /// [`turn`](Self::turn) of a gear that carries a torque before the load, less what that
    /// alone turns it by (rad): the torque of `joint` is the load's, and its play operators
    /// count from where they rest under the preload (Nm) of a joint that was never loaded.
    ///
    /// # Panics
    /// For another count of parameters.
    pub fn turn_beyond<S: Scalar>(&self, parameters: &[S], preload: S, joint: &Joint<S>) -> Option<S> {
        if self.is_linear() {
            return self.turn(parameters, joint);
        }
        let resting = self.resting(parameters, preload);
        let of = |torque: S, plays: [S; PLAYS]| self.turn(parameters, &Joint { torque, plays, ..*joint });
        let plays = core::array::from_fn(|k| resting[k] + joint.plays[k]);
        Some(of(preload + joint.torque, plays)? - of(preload, resting)?)
    }

    /// [`plays`](Self::plays) of such a gear, before and after the torque (Nm) of a load
    /// counted from where they rest under the preload (Nm).
    ///
    /// # Panics
    /// For another count of parameters.
    pub fn plays_beyond<S: Scalar>(&self, parameters: &[S], preload: S, torque: S, before: [S; PLAYS]) -> [S; PLAYS] {
        let resting = self.resting(parameters, preload);
        let before = core::array::from_fn(|k| resting[k] + before[k]);
        let after = self.plays(parameters, preload + torque, before);
        core::array::from_fn(|k| after[k] - resting[k])
    }

    /// The play operators (Nm) of a joint that was never loaded but by its preload (Nm).
    fn resting<S: Scalar>(&self, parameters: &[S], preload: S) -> [S; PLAYS] {
        self.plays(parameters, preload, [preload.times(0.0); PLAYS])
    }

    /// The slope of [`turn`](Self::turn) against the torque (rad/Nm) at a torque
    /// (Nm): derived from the law, not stated. The joint's play operators stay where
    /// they are: a small change turns back within their radii, and on a joint that was
    /// never loaded it does not move them yet.
    pub fn slope<S: Scalar>(
        &self,
        parameters: &[S],
        compliance: S,
        torque: S,
        harmonic: &dyn Fn(f64) -> (S, S),
    ) -> Option<S> {
        let zero = compliance.times(0.0);
        let mut constants = [Tangent::constant(zero); MOST_PARAMETERS];
        for (constant, &parameter) in constants.iter_mut().zip(parameters) {
            *constant = Tangent::constant(parameter);
        }
        let joint = Joint {
            compliance: Tangent::constant(compliance),
            torque: Tangent { value: torque, slope: zero.plus(1.0) },
            // The laws are linear in them, so that where they stand has no part in the slope.
            plays: [Tangent::constant(zero); PLAYS],
            harmonic: &|order| {
                let (s, c) = harmonic(order);
                (Tangent::constant(s), Tangent::constant(c))
            },
        };
        self.turn(&constants[..parameters.len()], &joint).map(|turn| turn.slope)
    }

    /// The effect as a noun, for a sentence: "the backlash of joint 3".
    pub fn noun(&self) -> impl fmt::Display {
        struct Noun(&'static str, Place);
        impl fmt::Display for Noun {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self.0.split_once("{}") {
                    Some((before, after)) => write!(f, "{before}{}{after}", self.1.words()),
                    None => f.write_str(self.0),
                }
            }
        }
        Noun(self.noun_of_numbers(), self.place())
    }
}

/// The full name, `kind@at`.
impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}@{}", self.kind(), self.place())
    }
}
