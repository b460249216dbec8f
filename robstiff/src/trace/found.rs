//! What was found, in the contract's names, and how it goes into a description.

use core::fmt;
use std::string::{String, ToString};
use std::vec::Vec;

use robstiff_robots::{Description, JointKind};

use super::catalogue::Kind;
use crate::Effect;

/// An effect that was found, with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    kind: &'static Kind,
    /// Where it is.
    pub place: Place,
    /// Its numbers with their uncertainty.
    pub parameters: Vec<EffectParameter>,
}

/// A number of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectParameter {
    /// Its name; `h` where the effect has one compliance.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// One standard deviation; none for a number out of a grid.
    pub std: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
}

/// Where an effect is; displays as the contract spells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// One joint, from 1.
    Joint(usize),
    /// Two joints, from 1.
    Joints([usize; 2]),
    /// One link, from 1.
    Link(usize),
    /// The foundation.
    Base,
    /// The flange and what is mounted on it.
    Tool,
    /// An entry of the DH table, `[theta, d, a, alpha]`, of a row from 1.
    Entry(usize, usize),
    /// The whole robot.
    Robot,
    /// The measurement.
    Rig,
}

/// The entries of a row of the DH table.
const ENTRIES: [&str; 4] = ["theta", "d", "a", "alpha"];

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Joint(i) => write!(f, "joint {i}"),
            Self::Joints([i, j]) => write!(f, "joints {i},{j}"),
            Self::Link(i) => write!(f, "link {i}"),
            Self::Base => f.write_str("base"),
            Self::Tool => f.write_str("tool"),
            Self::Entry(entry, row) => write!(f, "{}{row}", ENTRIES[*entry]),
            Self::Robot => f.write_str("robot"),
            Self::Rig => f.write_str("rig"),
        }
    }
}

/// Places of descriptions are spelt alike.
impl PartialEq<robstiff_robots::effect::Place> for Place {
    fn eq(&self, other: &robstiff_robots::effect::Place) -> bool {
        self.to_string() == other.to_string()
    }
}

impl Found {
    /// An effect of a kind.
    pub(super) fn new(kind: &'static Kind, place: Place, parameters: Vec<EffectParameter>) -> Self {
        Self { kind, place, parameters }
    }

    /// The kind, e.g. `transverse_compliance`.
    pub fn kind(&self) -> &'static str {
        self.kind.name
    }

    /// Where it is.
    pub fn place(&self) -> Place {
        self.place
    }

    /// Whether it is a fault of the measurement, which is corrected for and
    /// not written into the robot.
    pub fn is_of_rig(&self) -> bool {
        self.kind.of_rig
    }

    /// What it is, as a noun for a sentence.
    pub fn words(&self) -> String {
        (self.kind.words)(self)
    }

    /// The value of one of its numbers; zero where it does not have it.
    pub fn value(&self, name: &str) -> f64 {
        self.parameters.iter().find(|parameter| parameter.name == name).map_or(0.0, |parameter| parameter.value)
    }

    /// The effect as a description writes it, where it has a word for it.
    pub fn effect(&self) -> Option<Effect> {
        let value = |name| self.value(name);
        Some(match (self.kind.name, self.place) {
            ("transverse_compliance", Place::Joint(joint)) => Effect::TransverseCompliance { joint, value: value("h") },
            ("link_compliance", Place::Link(link)) => {
                Effect::LinkCompliance { link, bending: value("bending"), torsion: value("torsion") }
            }
            ("base_compliance", _) => Effect::BaseCompliance { tilt: value("tilt"), translation: value("translation") },
            ("tool_compliance", _) => {
                Effect::ToolCompliance { rotation: value("rotation"), translation: value("translation") }
            }
            ("joint_coupling", Place::Joints(joints)) => Effect::JointCoupling { joints, value: value("value") },
            ("stiffness_nonlinearity", Place::Joint(joint)) => {
                Effect::StiffnessNonlinearity { joint, added: value("added"), knee: value("knee") }
            }
            _ => return None,
        })
    }

    /// Writes the effect into a description; whether that has a place for it.
    pub(super) fn write_into(&self, description: &mut Description) -> bool {
        if self.is_of_rig() {
            return false;
        }
        if let Some(effect) = self.effect() {
            description.effects.push(effect);
            return true;
        }
        match (self.kind.name, self.place) {
            ("joint_zero_offset", Place::Joint(joint)) => {
                let row = &mut description.joints[joint - 1];
                match row.kind {
                    JointKind::Revolute => row.theta += self.value("offset"),
                    JointKind::Prismatic => row.d += self.value("offset"),
                }
                true
            }
            ("dh_error", Place::Entry(entry, row)) => {
                let joint = &mut description.joints[row - 1];
                let entry = [&mut joint.theta, &mut joint.d, &mut joint.a, &mut joint.alpha].into_iter().nth(entry);
                *entry.expect("a row has four entries") += self.value("value");
                true
            }
            _ => false,
        }
    }
}

/// The full name, `kind@at`.
impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}@{}", self.kind.name, self.place)
    }
}
