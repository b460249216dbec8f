//! What goes into the description.

use std::slice;

use robstiff_robots::effect::Place;
use robstiff_robots::effect::physics::{Parameter, Range};
use robstiff_robots::{Description, Effect};

use super::found::Found;
use crate::campaign::Campaign;
use crate::fit::estimate::{Estimate, with_values};
use crate::fit::readable::is_readable;
use crate::identify::Error;
use crate::select::always::{Declared, Own};
use robstiff_robots::DhEntry;

/// A description with estimates, corrections of the table, and effects, which says where they are
/// from.
///
/// # Errors
/// Numbers that no description takes beside its own effects.
pub fn described(
    campaign: &Campaign,
    (own, estimates): (&[Declared], &[Estimate]),
    table: &[[f64; 5]],
    effects: &[Found],
) -> Result<Description, Error> {
    let mut description = with_values(&campaign.robot, own, estimates);
    if !is_readable(&description) {
        // A number that the readings hardly show may be fitted beyond what it can be; it stays as declared.
        let (joints, effects): (Vec<_>, Vec<_>) =
            own.iter().zip(estimates).partition(|(own, _)| matches!(own.what, Own::Joint(_)));
        let with = |description: Description, (own, estimate): (&Declared, &Estimate)| {
            with_values(&description, slice::from_ref(own), slice::from_ref(estimate))
        };
        let readable = |description: Description, of: (&Declared, &Estimate)| {
            let changed = with(description.clone(), of);
            if is_readable(&changed) { changed } else { description }
        };
        // Joints together: a coupling may ask for two that are softer, and one that is too strong for them is refused
        // below. A joint that would only sag too far under the arm's own weight stays as declared.
        description = joints.iter().copied().fold(campaign.robot.clone(), with);
        if !is_readable(&description) && is_readable(&weightless(&description)) {
            description = joints.into_iter().fold(campaign.robot.clone(), readable);
        }
        description = effects.into_iter().fold(description, readable);
    }
    for (joint, by) in description.joints.iter_mut().zip(table) {
        for (number, by) in [&mut joint.theta, &mut joint.d, &mut joint.a, &mut joint.alpha].into_iter().zip(by) {
            *number += by;
        }
    }
    if !is_readable(&description) {
        return Err(Error::NoDescription);
    }
    let mut names = Vec::new();
    for found in effects {
        let mut with = description.clone();
        for effect in &found.written {
            add(&mut with, *effect);
        }
        // What a fit allows may still be beyond what a description takes.
        if !found.written.is_empty() && is_readable(&with) {
            description = with;
            names.push(found.to_string());
        }
    }
    let from = if campaign.name.is_empty() { "a campaign" } else { &campaign.name };
    let with = if names.is_empty() { "nothing added".to_owned() } else { names.join(", ") };
    let said = format!("Traced from {from}: {with}.");
    description.source = match description.source.trim() {
        "" => said,
        source => format!("{source}\n{said}"),
    };
    Ok(description)
}

/// A description without what the arm's own weight does.
fn weightless(description: &Description) -> Description {
    let mut weightless = description.clone();
    weightless.effects.retain(|effect| effect.place() != Place::Robot);
    weightless
}

/// Whether an effect adds up with one that is declared: an error of the kinematics.
pub fn is_offered_as_change(effect: &Effect) -> bool {
    matches!(effect, Effect::JointZeroOffset { .. } | Effect::DhError { .. } | Effect::TransmissionError { .. })
}

/// Adds an effect to a description, as a change where that declares it already. The preload of gears is one, whatever
/// laws show it.
fn add(description: &mut Description, effect: Effect) {
    let slides = |joint: usize| {
        description.joints.get(joint - 1).is_some_and(|joint| joint.kind == robstiff::JointKind::Prismatic)
    };
    let effect = match effect {
        Effect::JointZeroOffset { joint, value } if slides(joint) => {
            Effect::DhError { entry: DhEntry::D(joint), value }
        }
        effect => effect,
    };
    let same = |declared: &Effect| is_offered_as_change(declared) && declared.is_same(&effect);
    let place = description.effects.iter().position(|declared| same(declared) && sum(declared, &effect).is_some());
    if !is_offered_as_change(&effect) && description.effects.contains(&effect) {
        return;
    }
    match place.and_then(|at| Some((at, sum(&description.effects[at], &effect)?))) {
        Some((at, whole)) => description.effects[at] = whole,
        None => description.effects.push(effect),
    }
}

/// A declared effect with a change; none of a periodic error whose order is another.
fn sum(declared: &Effect, change: &Effect) -> Option<Effect> {
    let number = |((parameter, declared), by): ((&Parameter, f64), f64)| match parameter.range {
        Range::Whole(_) => (declared == by).then_some(declared),
        _ => Some(declared + by),
    };
    let numbers: Option<Vec<f64>> = declared.parameters().zip(change.numbers()).map(number).collect();
    Effect::of_kind(declared.kind(), declared.place(), &numbers?)
}
