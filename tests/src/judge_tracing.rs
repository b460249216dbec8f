//! What tracing said, held against what was hidden.
//!
//! - A name *stands for* something hidden where it is its full name, where
//!   `same_as` has it, or where the name would do as well at these poses and
//!   loads, which is found without tracing ([`would_do`]).
//! - A judgement is *right* where everything hidden has a name of its own that
//!   stands for it; *alone* where there are no more names than that.
//! - A name is *wrong* where it stands for nothing hidden.
//! - *Whole truth*: the verdict is `explained`, so the names are said to be all
//!   there is, or `adequate`, so nothing is said to be missing.
//!
//! [`would_do`]: crate::matrix::alias::would_do

use robstiff_identify::trace::{EffectParameter, Suspected, Trace, Verdict};

use crate::reliability::Claim;

/// Standard deviations that have 95 % of a normal distribution within.
const WITHIN: f64 = 1.959_964;

/// What was said, in the terms of `trace.json`.
#[derive(Clone, Debug)]
pub struct Told {
    /// The verdict.
    pub verdict: Verdict,
    /// The names.
    pub names: Vec<Name>,
    /// Value and standard deviation of each joint's compliance (rad/Nm).
    pub joints: Vec<(f64, Option<f64>)>,
}

/// What was suspected and why it has no name, for when a count fails.
pub fn suspected(trace: &Trace) -> String {
    let one = |of: &Suspected| format!("\n    suspected {}: {}", of.effect, of.why_not);
    trace.suspected.iter().map(one).collect()
}

/// A name with what was said about it.
#[derive(Clone, Debug)]
pub struct Name {
    /// `kind@at`.
    pub name: String,
    /// What the data are said not to tell it from.
    pub same_as: Vec<String>,
    /// Its numbers.
    pub parameters: Vec<Number>,
}

/// A number of a name.
#[derive(Clone, Debug)]
pub struct Number {
    /// What it is called.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its standard deviation.
    pub std: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
}

impl Told {
    /// What a trace says.
    pub fn of(trace: &Trace) -> Self {
        let number = |p: &EffectParameter| Number { name: p.name.into(), value: p.value, std: p.std, unit: p.unit };
        let names = trace.effects.iter().map(|named| Name {
            name: named.effect.to_string(),
            same_as: named.same_as(),
            parameters: named.effect.parameters.iter().map(number).collect(),
        });
        let joints = trace.estimates.iter().filter(|estimate| estimate.name.starts_with("joint "));
        Self {
            verdict: trace.verdict,
            names: names.collect(),
            joints: joints.map(|estimate| (estimate.value, estimate.std)).collect(),
        }
    }
}

/// A judgement.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Judgement {
    /// Everything hidden has a name.
    pub right: bool,
    /// And there are no other names.
    pub alone: bool,
    /// Every name is the hidden thing's own, not an alias.
    pub own: bool,
    /// Names that stand for nothing hidden.
    pub wrong: Vec<String>,
    /// The names, or that there are none, are said to be all there is.
    pub whole_truth: bool,
}

/// Judges names by the full names of what is hidden; `would_do` says whether a
/// name would do as well as a hidden thing, by its index.
pub fn judge(told: &Told, hidden: &[String], would_do: impl Fn(&str, usize) -> bool) -> Judgement {
    let stands = |name: &Name, index: usize| {
        let own = &hidden[index];
        name.name == *own || name.same_as.contains(own) || would_do(&name.name, index)
    };
    let table: Vec<Vec<bool>> =
        told.names.iter().map(|name| (0..hidden.len()).map(|index| stands(name, index)).collect()).collect();
    let right = covers(&table, hidden.len(), &mut vec![false; told.names.len()], 0);
    let wrong = told.names.iter().zip(&table).filter(|(_, stands)| !stands.contains(&true));
    Judgement {
        right,
        alone: right && told.names.len() == hidden.len(),
        own: told.names.len() == hidden.len() && told.names.iter().all(|name| hidden.contains(&name.name)),
        wrong: wrong.map(|(name, _)| name.name.clone()).collect(),
        whole_truth: matches!(told.verdict, Verdict::Explained | Verdict::Adequate),
    }
}

/// Every class that a trace reports a probability of, named or suspected: it is right where one of its
/// members is something hidden, or would do as well.
pub fn claims(trace: &Trace, hidden: &[String], would_do: impl Fn(&str, usize) -> bool) -> Vec<Claim> {
    let is_there = |class: &[(String, f64)]| {
        let mut pairs = class.iter().flat_map(|(member, _)| (0..hidden.len()).map(move |index| (member, index)));
        pairs.any(|(member, index)| *member == hidden[index] || would_do(member, index))
    };
    let named = trace.effects.iter().map(|of| Claim {
        name: of.effect.to_string(),
        probability: of.probability,
        why_not: None,
        is_right: is_there(&of.class),
    });
    let suspected = trace.suspected.iter().map(|of| Claim {
        name: of.effect.to_string(),
        probability: of.probability,
        why_not: Some(of.why_not.clone()),
        is_right: is_there(&of.class),
    });
    named.chain(suspected).collect()
}

/// Whether the hidden things from `index` on can each have a name that is not
/// taken.
fn covers(table: &[Vec<bool>], hidden: usize, taken: &mut Vec<bool>, index: usize) -> bool {
    if index == hidden {
        return true;
    }
    (0..table.len()).any(|name| {
        if taken[name] || !table[name][index] {
            return false;
        }
        taken[name] = true;
        let rest = covers(table, hidden, taken, index + 1);
        taken[name] = false;
        rest
    })
}

/// A number that was told with its uncertainty, held against what it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// Whose it is: `kind@at name`, `joint 3`.
    pub name: String,
    /// What was told.
    pub value: f64,
    /// Its standard deviation.
    pub std: f64,
    /// What it is.
    pub truth: f64,
}

impl Held {
    /// Whether the truth is within the 95 % interval.
    pub fn is_within(&self) -> bool {
        (self.value - self.truth).abs() <= WITHIN * self.std
    }
}

/// How many of some numbers are within their 95 % interval, of how many.
pub fn within(held: &[Held]) -> (usize, usize) {
    (held.iter().filter(|held| held.is_within()).count(), held.len())
}

/// The numbers of the names that are the hidden things' own, where they have an
/// interval.
pub fn held_numbers(told: &Told, hidden: &[(String, Vec<(String, f64)>)]) -> Vec<Held> {
    let mut held = Vec::new();
    for (name, truths) in hidden {
        let Some(named) = told.names.iter().find(|named| named.name == *name) else { continue };
        for number in &named.parameters {
            let truth = truths.iter().find(|(truth, _)| *truth == number.name);
            if let (Some(&(_, truth)), Some(std)) = (truth, number.std) {
                held.push(Held { name: format!("{name} {}", number.name), value: number.value, std, truth });
            }
        }
    }
    held
}

/// The same of the joints' compliances.
pub fn held_joints(told: &Told, truths: &[f64]) -> Vec<Held> {
    let joints = (1..).zip(told.joints.iter().zip(truths));
    let known = joints.filter_map(|(joint, (&(value, std), &truth))| {
        Some(Held { name: format!("joint {joint}"), value, std: std?, truth })
    });
    known.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(verdict: Verdict, names: &[(&str, &[&str])]) -> Told {
        let name = |(name, same_as): &(&str, &[&str])| Name {
            name: name.to_string(),
            same_as: same_as.iter().map(ToString::to_string).collect(),
            parameters: [("h", Some(0.1)), ("free", None)]
                .map(|(name, std)| Number { name: name.into(), value: 1.0, std, unit: "1" })
                .into(),
        };
        Told { verdict, names: names.iter().map(name).collect(), joints: vec![(2.0, Some(0.1)), (3.0, None)] }
    }

    fn judged(names: &[(&str, &[&str])], hidden: &[&str]) -> Judgement {
        let hidden: Vec<String> = hidden.iter().map(ToString::to_string).collect();
        judge(&told(Verdict::Explained, names), &hidden, |name, index| name == "twin" && hidden[index] == "a")
    }

    #[test]
    fn names_and_aliases_are_told_from_wrong_ones() {
        let own = judged(&[("a", &[])], &["a"]);
        assert!(own.right && own.alone && own.own && own.wrong.is_empty() && own.whole_truth);
        for alias in [judged(&[("b", &["a"])], &["a"]), judged(&[("twin", &[])], &["a"])] {
            assert!(alias.right && alias.alone && !alias.own && alias.wrong.is_empty());
        }
        let more = judged(&[("a", &[]), ("c", &[])], &["a"]);
        assert!(more.right && !more.alone && more.wrong == ["c"]);
        let wrong = judged(&[("c", &[])], &["a"]);
        assert!(!wrong.right && wrong.wrong == ["c"]);
        assert!(!judged(&[], &["a"]).right && judged(&[], &[]).alone);
    }

    #[test]
    fn one_name_does_not_stand_for_two() {
        assert!(!judged(&[("a", &["b"])], &["a", "b"]).right);
        // The first name could be either; the second only the first.
        let both = judged(&[("a", &["b"]), ("c", &["a"])], &["a", "b"]);
        assert!(both.right && both.alone && !both.own);
    }

    #[test]
    fn intervals_count_where_there_is_one() {
        let told = told(Verdict::Explained, &[("a", &[])]);
        let truth = |value: f64| [("a".to_string(), vec![("h".to_string(), value), ("free".to_string(), 1.0)])];
        let counts = |value: f64| within(&held_numbers(&told, &truth(value)));
        assert_eq!((counts(1.19), counts(1.2)), ((1, 1), (0, 1)));
        assert!(held_numbers(&told, &[("b".to_string(), Vec::new())]).is_empty());
        let joints = |value: f64| within(&held_joints(&told, &[value, 9.0]));
        assert_eq!((joints(2.1), joints(2.3)), ((1, 1), (0, 1)));
    }
}
