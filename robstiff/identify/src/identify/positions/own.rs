//! The numbers of a description that positions can change: the compliances, which
//! payloads show, and the errors of the kinematics that it declares.

use std::format;
use std::rc::Rc;
use std::string::{String, ToString};
use std::vec::Vec;

use robstiff_robots::Description;
use robstiff_robots::effect::Dimension;
use robstiff_robots::effect::physics::{Parameter, Range};

use super::model::{ANGLE_STEP, COMPLIANCE_STEP, Enters, LENGTH_STEP, Model, SHARE_STEP};
use crate::identify::baseline::{Declared, declared};
use crate::identify::column::Column;
use crate::identify::normal::Sign;
use crate::identify::{element_name, unit_of};
use robstiff::Effect;

/// A number of a description that positions can change.
#[derive(Clone, Debug)]
pub struct Own {
    /// `joint 3`, or its effect's name with its own where the effect has several.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// The value that the description gives.
    pub value: f64,
    /// What values it may take.
    pub sign: Sign,
    /// The step of central differences.
    step: f64,
    which: Which,
}

/// Where a number is in its description.
#[derive(Clone, Copy, Debug)]
enum Which {
    /// A compliance, or play.
    Elastic(Declared),
    /// A number of an error of the kinematics, both by index.
    Kinematic { effect: usize, number: usize },
}

/// What gives way in a description: the joints' compliances in order, then those of its
/// effects, and their play.
pub fn compliances(description: &Description) -> Vec<Own> {
    let own = |number: Declared| Own {
        name: element_name(description, &number),
        unit: unit_of(description, number.column),
        value: number.value,
        sign: number.sign,
        step: if matches!(number.column, Column::Gap { .. }) { ANGLE_STEP } else { COMPLIANCE_STEP },
        which: Which::Elastic(number),
    };
    // Positions know no order of loads.
    let fits = |number: &Declared| !matches!(number.column, Column::Play { .. });
    declared(description).into_iter().filter(fits).map(own).collect()
}

/// The errors of the kinematics that a description declares, number by number. Of a
/// periodic error the order is none: it does not change by little.
pub fn kinematic(description: &Description) -> Vec<Own> {
    let effects = description.effects.iter().enumerate().filter(|(_, effect)| effect.is_kinematic());
    effects.flat_map(|(at, effect)| of_kinematic(at, effect)).collect()
}

fn of_kinematic(at: usize, effect: &Effect) -> Vec<Own> {
    let all = effect.parameters().enumerate();
    let numbers: Vec<_> = all.filter(|(_, (parameter, _))| !matches!(parameter.range, Range::Whole(_))).collect();
    let alone = numbers.len() == 1;
    let own = |(number, (parameter, value)): (usize, (&Parameter, f64))| {
        let (unit, step) = match parameter.quantity.at(effect.place()) {
            Dimension::Angle => ("rad", ANGLE_STEP),
            Dimension::Length => ("m", LENGTH_STEP),
            _ => ("1", SHARE_STEP),
        };
        let name = if alone { effect.to_string() } else { format!("{effect} {}", parameter.name) };
        let sign = if parameter.range == Range::Any { Sign::Free } else { Sign::Nonnegative };
        Own { name, unit, value, sign, step, which: Which::Kinematic { effect: at, number } }
    };
    numbers.into_iter().map(own).collect()
}

impl Own {
    /// Whether it shows under loads only, and is no error of the kinematics.
    pub fn is_compliance(&self) -> bool {
        matches!(self.which, Which::Elastic(_))
    }

    /// How it enters a model.
    pub fn enters(&self) -> Enters {
        let own = self.clone();
        Enters::Model(Rc::new(move |model: &mut Model, by| own.add_to(&mut model.description, by)), self.step)
    }

    /// Adds to the number of a description.
    pub fn add_to(&self, description: &mut Description, by: f64) {
        self.set(description, self.of(description) + by);
    }

    /// The value that a description has of it.
    fn of(&self, description: &Description) -> f64 {
        match self.which {
            Which::Elastic(number) => number.of(description),
            Which::Kinematic { effect, number } => description.effects[effect].numbers()[number],
        }
    }

    /// Gives a description another value of it.
    pub fn set(&self, description: &mut Description, value: f64) {
        match self.which {
            Which::Elastic(number) => number.set(description, value),
            Which::Kinematic { effect, number } => {
                let effect = &mut description.effects[effect];
                let mut numbers: Vec<f64> = effect.numbers().into_iter().collect();
                numbers[number] = value;
                *effect = Effect::of_kind(effect.kind(), effect.place(), &numbers).expect("an effect with its numbers");
            }
        }
    }
}

/// A description with other values of its numbers.
pub fn with_values(description: &Description, own: &[Own], values: &[f64]) -> Description {
    let mut changed = description.clone();
    own.iter().zip(values).for_each(|(own, &value)| own.set(&mut changed, value));
    changed
}
