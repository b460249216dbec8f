//! An effect that was found, with its numbers.

use core::fmt;

use robstiff::Effect;

use crate::effects::{Kind, Number, OUTLIERS, Place, Side};

/// An effect that was found.
#[derive(Clone, Debug)]
pub struct Found {
    kind: &'static Kind,
    place: Place,
    /// Its numbers with their uncertainty.
    pub parameters: Vec<Number>,
    /// What a description writes of it.
    pub(crate) written: Vec<Effect>,
}

impl Found {
    pub(crate) fn new(kind: &'static Kind, place: Place, parameters: Vec<Number>, written: Vec<Effect>) -> Self {
        Self { kind, place, parameters, written }
    }

    /// So many rows that do not belong to the others.
    pub(crate) fn outliers(rows: usize) -> Self {
        let rows = Number { name: "rows", value: rows as f64, std: None, unit: "1" };
        Self::new(&OUTLIERS, Place::Rig, vec![rows], Vec::new())
    }

    /// The kind, e.g. `transverse_compliance`.
    pub fn kind(&self) -> &'static str {
        self.kind.name
    }

    /// Where it is.
    pub fn place(&self) -> Place {
        self.place
    }

    /// Whether it is a fault of the measurement, which is corrected for and not written into the robot.
    pub fn is_of_rig(&self) -> bool {
        self.kind.side == Side::Rig
    }

    /// What it is, as a noun for a sentence.
    pub fn words(&self) -> String {
        (self.kind.words)(&self.place, &self.parameters)
    }

    /// What causes it and what one does about it, in full sentences.
    pub fn explanation(&self) -> &'static str {
        if let Some(effect) = self.effect() {
            return effect.explanation();
        }
        let about = robstiff_robots::effect::CATALOGUE.iter().find(|about| about.kind == self.kind.name);
        about.map_or(self.kind.explanation, |about| about.explanation)
    }

    /// The value of one of its numbers; zero where it does not have it.
    pub fn value(&self, name: &str) -> f64 {
        self.parameters.iter().find(|number| number.name == name).map_or(0.0, |number| number.value)
    }

    /// The effect as a description writes it, the first where it writes several; none where it has no
    /// word for it.
    pub fn effect(&self) -> Option<Effect> {
        self.written.first().copied()
    }
}

/// The full name, `kind@at`.
impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}@{}", self.kind.name, self.place)
    }
}
