//! The description's own numbers, with their uncertainty.

use robstiff_robots::{Description, Part};

use crate::select::Layout;
use crate::select::always::{Declared, Own};
use crate::select::solve::Solved;
use robstiff::Effect;

/// What a campaign can say about a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// It was identified.
    Seen,
    /// The readings say next to nothing of it; it kept its value.
    Unseen,
    /// They would show it, were it not for these others (by index); it kept its value.
    Confounded(Vec<usize>),
}

/// One number with its uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// `joint 3`, or an effect's number: `transverse_compliance@joint 3`,
    /// `link_compliance@link 2 bending`.
    pub name: String,
    /// What the description said.
    pub declared: f64,
    /// What it is now; the declared value where the data do not see it.
    pub value: f64,
    /// One standard deviation, where it could be estimated; not at a bound.
    pub std: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
    /// Whether the data see it.
    pub visibility: Visibility,
    /// Whether it is zero only because a compliance is not negative.
    pub at_bound: bool,
}

/// Beyond this deviation from the declared value a joint deserves a look: the seed paper's identified
/// compliances stayed below it against the maker's.
pub const NOTEWORTHY_DEVIATION: f64 = 0.25;

/// A number is seen if the readings bring its uncertainty below this part of what it was before.
const SEEN: f64 = 0.5;

impl Estimate {
    /// The relative deviation from the declared value; `None` where nothing was declared or seen, or
    /// the value is but a bound.
    pub fn deviation(&self) -> Option<f64> {
        (self.declared != 0.0 && self.visibility == Visibility::Seen && !self.at_bound)
            .then(|| self.value / self.declared - 1.0)
    }

    /// Whether the deviation is beyond [`NOTEWORTHY_DEVIATION`].
    pub fn is_noteworthy(&self) -> bool {
        self.deviation().is_some_and(|deviation| deviation.abs() > NOTEWORTHY_DEVIATION)
    }
}

/// The estimates of a description's own numbers in a model; without one, as declared.
pub fn estimates(robot: &Description, own: &[Declared], model: Option<(&Layout, &Solved)>) -> Vec<Estimate> {
    let one = |(k, number): (usize, &Declared)| {
        let parameter = &number.parameter;
        let declared = parameter.mean;
        let mut estimate = Estimate {
            name: name(robot, number),
            declared,
            value: declared,
            std: None,
            unit: parameter.unit,
            visibility: Visibility::Unseen,
            at_bound: false,
        };
        let Some((layout, solved)) = model else { return estimate };
        let column = layout.fixed + k;
        let before = match parameter.size {
            crate::model::Size::Of(sd) => sd,
            _ => f64::INFINITY,
        };
        if solved.held.contains(&column) {
            estimate.visibility = Visibility::Seen;
            estimate.value = 0.0;
            estimate.at_bound = declared > 0.0;
        } else if let Some(at) = solved.fit.place(column) {
            let std = solved.fit.std[at];
            if std < SEEN * before {
                estimate.visibility = Visibility::Seen;
                estimate.value = solved.fit.mean[at];
                estimate.std = Some(std);
            }
        }
        estimate
    };
    own.iter().enumerate().map(one).collect()
}

/// `joint 3`, or an effect's full name with its number's where it has several.
pub fn name(robot: &Description, number: &Declared) -> String {
    match number.what {
        Own::Joint(joint) => format!("joint {joint}"),
        Own::Effect(index, _) => {
            let effect = robot.effects[index].to_string();
            match number.parameter.name {
                "h" | "c" => effect,
                name => format!("{effect} {name}"),
            }
        }
    }
}

/// A description with the values of some estimates, those that were seen.
pub fn with_values(robot: &Description, own: &[Declared], estimates: &[Estimate]) -> Description {
    let seen = own.iter().zip(estimates).filter(|(_, of)| of.visibility == Visibility::Seen);
    seen.fold(robot.clone(), |changed, (number, estimate)| with_value(changed, number, estimate.value))
}

/// A description with another value of a number.
pub fn with_value(mut changed: Description, number: &Declared, value: f64) -> Description {
    match number.what {
        Own::Joint(joint) => set_compliance(&mut changed.joints[joint - 1].compliance, value),
        Own::Effect(index, place) => {
            let effect = &mut changed.effects[index];
            let mut numbers: Vec<f64> = effect.numbers().to_vec();
            numbers[place] = value;
            if let Some(new) = Effect::of_kind(effect.kind(), effect.place(), &numbers) {
                *effect = new;
            }
        }
    }
    changed
}

/// Sets the compliance of a joint; of a compound one the parts keep their proportion.
pub fn set_compliance(parts: &mut Vec<Part>, value: f64) {
    let sum: f64 = parts.iter().map(|part| part.value).sum();
    if parts.is_empty() {
        parts.push(Part { name: String::new(), value });
    } else if sum > 0.0 {
        parts.iter_mut().for_each(|part| part.value *= value / sum);
    } else {
        let count = parts.len() as f64;
        parts.iter_mut().for_each(|part| part.value = value / count);
    }
}
