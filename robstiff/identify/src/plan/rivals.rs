//! Who rivals whom: the effects that a trace could not tell apart.

use std::string::String;
use std::vec::Vec;

use crate::trace::{SUSPECTED, Trace};

/// Rivals of one effect beyond these many are not followed: all pairs count,
/// and the best fitting are the likely ones.
const MOST: usize = 4;

/// Kinds that depend on when something is measured, not on pose and load: what
/// to propose for them is not computed.
const OF_TIME: [&str; 6] = ["thermal_drift", "creep", "base_slip", "reflector_slip", "wandering", "outliers"];

/// The rivals with their columns, among the numbers that planning looks at.
#[derive(Clone, Debug)]
pub struct Rivals {
    /// What every model has and nobody asks for.
    pub nuisance: Vec<usize>,
    /// The model: the description's numbers and those of the effects named.
    pub model: Vec<Number>,
    /// The columns of the effects' numbers, within the model.
    pub effects: Vec<usize>,
    /// The pairs.
    pub pairs: Vec<Contest>,
}

/// A number of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Its column.
    pub column: usize,
    /// `joint 3`, or an effect's number.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// Its value.
    pub value: f64,
}

/// An effect in the running.
#[derive(Clone, Debug, PartialEq)]
pub struct Rival {
    /// Its columns.
    pub columns: Vec<usize>,
    /// What fits best.
    pub values: Vec<f64>,
    /// How many numbers it takes, a knee counting as one.
    pub parameters: usize,
}

/// Two effects, one of which is the truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Contest {
    /// Their full names.
    pub names: [String; 2],
    /// What they are.
    pub rivals: [Rival; 2],
    /// The columns that both models have, nuisance among them.
    pub core: Vec<usize>,
    rest: [Vec<usize>; 2],
}

impl Contest {
    /// Two effects beside what both models have.
    pub fn new(names: [String; 2], rivals: [Rival; 2], core: Vec<usize>) -> Self {
        let beside = |rival: &Rival| core.iter().chain(&rival.columns).copied().collect();
        let rest = [beside(&rivals[1]), beside(&rivals[0])];
        Self { names, rivals, core, rest }
    }

    /// The columns of the wrong model, when rival 0 or 1 is the truth.
    pub fn without(&self, truth: usize) -> &[usize] {
        &self.rest[truth]
    }

    /// How many numbers one has more than the other.
    pub fn further_numbers(&self) -> usize {
        self.rivals[1].parameters.abs_diff(self.rivals[0].parameters)
    }
}

/// Effects of which one is the truth, by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// The one that was named, by its index in the trace.
    pub named: Option<usize>,
    /// Those in the running, the named or best fitting first.
    pub names: Vec<String>,
}

/// The names of those in the running that poses and loads have to do with.
pub fn computed(names: &[String]) -> impl Iterator<Item = &String> {
    names.iter().filter(|name| !is_of_time(name))
}

/// Whether an effect depends on when something is measured, by its full name.
pub fn is_of_time(name: &str) -> bool {
    OF_TIME.contains(&name.split('@').next().unwrap_or(name))
}

/// Every two of some rivals, beside the columns that all their models have.
pub fn pairs(rivals: &[(String, Rival)], core: &[usize]) -> Vec<Contest> {
    let with_later = |(k, (one, of_one)): (usize, &(String, Rival))| -> Vec<Contest> {
        let pair = |(other, of_other): &(String, Rival)| {
            Contest::new([one.clone(), other.clone()], [of_one.clone(), of_other.clone()], core.to_vec())
        };
        rivals[k + 1..].iter().map(pair).collect()
    };
    rivals.iter().enumerate().flat_map(with_later).collect()
}

/// The groups of a trace: each class of effects, named or suspected, without the members that are not
/// even suspected. One of a single member has no rival.
pub fn groups(trace: &Trace) -> Vec<Group> {
    let likely = |class: &[(String, f64)]| -> Vec<String> {
        let rivals = class.iter().skip(1).filter(|(_, probability)| *probability >= SUSPECTED);
        class.iter().take(1).chain(rivals).map(|(name, _)| name.clone()).take(MOST).collect()
    };
    let group = |named: Option<usize>, class: &[(String, f64)]| Group { named, names: likely(class) };
    let named = trace.effects.iter().enumerate().map(|(k, named)| group(Some(k), &named.class));
    let suspected = trace.suspected.iter().map(|of| group(None, &of.class));
    named.chain(suspected).filter(|group| !group.names.is_empty()).collect()
}
