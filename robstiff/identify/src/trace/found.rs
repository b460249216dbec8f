//! What was found, in the contract's names, and how it goes into a description.

use core::fmt;
use std::format;
use std::string::String;
use std::vec::Vec;

use robstiff_robots::Description;
use robstiff_robots::effect::physics::{Parameter, Range};
use robstiff_robots::effect::{CATALOGUE, DhEntry, Place as Part};

use super::catalogue::{Kind, OUTLIERS, is_offered_as_change};
use super::slip::Slipping;
use crate::identify::readable::is_readable;
use robstiff::{Effect, JointKind};

/// An effect that was found, with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    kind: &'static Kind,
    place: Place,
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
    /// One standard deviation; none for what is counted, as an order or a line, and where the data
    /// do not tell.
    pub std: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
}

/// Where an effect is; displays as the contract spells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A part of the robot that descriptions have a word for.
    Part(Part),
    /// The measurement.
    Rig,
}

impl Place {
    /// The part of the robot, where it is one.
    fn part(self) -> Option<Part> {
        match self {
            Self::Part(part) => Some(part),
            Self::Rig => None,
        }
    }
}

impl From<Part> for Place {
    fn from(part: Part) -> Self {
        Self::Part(part)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Part(part) => part.fmt(f),
            Self::Rig => f.write_str("rig"),
        }
    }
}

impl Found {
    /// An effect of a kind.
    pub(crate) fn new(kind: &'static Kind, place: Place, parameters: Vec<EffectParameter>) -> Self {
        Self { kind, place, parameters }
    }

    /// Wild readings: the rig's, so many rows of them.
    pub(crate) fn outliers(rows: usize) -> Self {
        let rows = EffectParameter { name: "rows", value: rows as f64, std: None, unit: "1" };
        Self::new(&OUTLIERS, Place::Rig, std::vec![rows])
    }

    /// The kind, e.g. `transverse_compliance`.
    pub fn kind(&self) -> &'static str {
        self.kind.name
    }

    /// Whether it is of a kind.
    pub(super) fn is(&self, kind: &Kind) -> bool {
        self.kind == kind
    }

    /// What slips, if anything does.
    pub(super) fn slipping(&self) -> Option<Slipping> {
        Slipping::of(self.kind)
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

    /// What causes it and what one does about it, in full sentences.
    pub fn explanation(&self) -> &'static str {
        if let Some(effect) = self.effect() {
            return effect.explanation();
        }
        let about = CATALOGUE.iter().find(|about| about.kind == self.kind.name);
        about.map_or(self.kind.explanation, |about| about.explanation)
    }

    /// The value of one of its numbers; zero where it does not have it.
    pub fn value(&self, name: &str) -> f64 {
        self.parameters.iter().find(|parameter| parameter.name == name).map_or(0.0, |parameter| parameter.value)
    }

    /// The effect as a description writes it, where it has a word for it.
    pub fn effect(&self) -> Option<Effect> {
        let about = CATALOGUE.iter().find(|about| about.kind == self.kind.name)?;
        let number = |parameter: &Parameter| {
            let own = self.parameters.iter().find(|number| spelt(number.name) == parameter.name);
            own.map(|number| number.value).or(parameter.default).unwrap_or(0.0)
        };
        let numbers: Vec<f64> = about.parameters.iter().map(number).collect();
        Effect::of_kind(self.kind.name, self.place.part()?, &numbers)
    }

    /// The same as the description of a robot writes it, where a joint that slides has its zero
    /// in the table.
    pub fn effect_on(&self, robot: &Description) -> Option<Effect> {
        let slides = |joint: usize| robot.joints.get(joint - 1).is_some_and(|joint| joint.kind == JointKind::Prismatic);
        match self.effect()? {
            Effect::JointZeroOffset { joint, value } if slides(joint) => {
                Some(Effect::DhError { entry: DhEntry::D(joint), value })
            }
            effect => Some(effect),
        }
    }

    /// The same with its whole numbers, where it is a change to what a description declares.
    pub(super) fn in_whole(mut self, robot: &Description) -> Self {
        let Some(change) = self.effect_on(robot).filter(|_| !self.is_of_rig()) else { return self };
        let Some((_, whole)) = changed(robot, &change) else { return self };
        for (parameter, value) in whole.parameters() {
            let own = self.parameters.iter_mut().find(|number| spelt(number.name) == parameter.name);
            own.into_iter().for_each(|number| number.value = value);
        }
        self
    }

    /// Writes the effect into a description; whether that takes it.
    pub(super) fn write_into(&self, description: &mut Description) -> bool {
        let Some(effect) = self.effect_on(description).filter(|_| !self.is_of_rig()) else { return false };
        let mut with = description.clone();
        add(&mut with, effect);
        // What a fit allows may still be beyond what a description takes, such
        // as a periodic error too large for the code that is generated.
        let taken = is_readable(&with);
        if taken {
            *description = with;
        }
        taken
    }
}

/// Adds an effect to a description, as a change where that declares it already; its index there.
pub(super) fn add(description: &mut Description, effect: Effect) -> usize {
    let (at, effect) = changed(description, &effect).unwrap_or((description.effects.len(), effect));
    match description.effects.get_mut(at) {
        Some(declared) => *declared = effect,
        None => description.effects.push(effect),
    }
    at
}

/// What a change makes of the effect that a description declares at its place, with the index of
/// that. Of a periodic error the order stays: a change of another is none of it.
fn changed(description: &Description, change: &Effect) -> Option<(usize, Effect)> {
    // An error of theta that is declared is changed by what is told as the zero of its joint.
    let same = |effect: &Effect| is_offered_as_change(effect) && effect.is_same(change);
    let at = description.effects.iter().position(same)?;
    let sum = |((parameter, declared), by): ((&Parameter, f64), f64)| match parameter.range {
        Range::Whole(_) => (declared == by).then_some(declared),
        _ => Some(declared + by),
    };
    let declared = &description.effects[at];
    let numbers: Option<Vec<f64>> = declared.parameters().zip(change.numbers()).map(sum).collect();
    Some((at, Effect::of_kind(declared.kind(), declared.place(), &numbers?)?))
}

/// A number's name as descriptions spell it: there the only one of an effect
/// is its value.
fn spelt(name: &'static str) -> &'static str {
    match name {
        "h" | "offset" => "value",
        name => name,
    }
}

/// A number's full name, by that of its effect: the only one of an effect goes by the name of that.
pub(crate) fn full_name(effect: &str, number: &'static str) -> String {
    match spelt(number) {
        "value" => String::from(effect),
        number => format!("{effect} {number}"),
    }
}

/// The full name, `kind@at`.
impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}@{}", self.kind.name, self.place)
    }
}
