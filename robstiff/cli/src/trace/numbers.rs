//! What a tracing made of the description's own numbers, in sentences.

use robstiff_identify::campaign::{Campaign, Data};
use robstiff_identify::trace::{Estimate, NamedEffect, Trace, Verdict, Visibility};
use robstiff_robots::Joint;

use super::wording::{declared, name_of, sentence};
use crate::effect::parameters;
use crate::identify::at_bound;
use crate::text::{and, quantity};

/// What came of the numbers, a sentence each.
pub fn sentences(trace: &Trace, campaign: &Campaign) -> Vec<String> {
    if trace.verdict == Verdict::Insufficient {
        // Of values that are not taken, none is written.
        return vec!["The description keeps its declared values.".to_owned()];
    }
    let mut sentences: Vec<String> = fitted_again(trace).into_iter().collect();
    sentences.extend(table(trace, campaign));
    sentences.extend(changed(trace, campaign));
    let effects = || {
        let named = trace.effects.iter().map(|named| named.effect.to_string());
        named.chain(trace.description.effects.iter().map(ToString::to_string))
    };
    let clipped = trace.estimates.iter().filter(|estimate| estimate.at_bound);
    sentences.extend(clipped.map(|estimate| sentence(&at_bound(&estimate.name, effects()))));
    // What the joints alone seemed to show, and do not beside the effects.
    let was_seen = |(now, before): &(&Estimate, &Estimate)| {
        now.visibility == Visibility::Unseen && before.visibility == Visibility::Seen
    };
    let kept = trace.estimates.iter().zip(&trace.estimates_before).filter(was_seen);
    sentences.extend(
        kept.map(|(now, _)| {
            sentence(&format!("{} does not show in these data and keeps its declared value", now.name))
        }),
    );
    sentences
}

/// A number that is off what is declared by more standard deviations has changed.
const MOVED: f64 = 3.0;

/// Of the effects that a description declares, what was fitted again and is not what it
/// says.
pub fn fitted_again(trace: &Trace) -> Option<String> {
    let fitted = |estimate: &&Estimate| estimate.visibility == Visibility::Seen && estimate.name.contains('@');
    let seen: Vec<&Estimate> = trace.estimates.iter().filter(fitted).collect();
    if seen.is_empty() {
        return None;
    }
    let has_moved =
        |estimate: &&&Estimate| (estimate.value - estimate.declared).abs() > MOVED * estimate.std.unwrap_or_default();
    let change = |estimate: &&Estimate| {
        let was = quantity(estimate.declared, None, estimate.unit);
        let is = quantity(estimate.value, estimate.std, estimate.unit);
        format!("{} was {was} and is {is}", name_of(trace, estimate))
    };
    let moved: Vec<String> = seen.iter().filter(has_moved).map(change).collect();
    let of_others = match (moved.len(), seen.len() - moved.len()) {
        (0, _) => "none has changed",
        (_, 0) => "",
        _ => "; the rest has not changed",
    };
    Some(format!("The effects that the description declares were fitted again: {}{of_others}.", moved.join("; ")))
}

/// So many numbers of the table are reported.
const MOST_CHANGED: usize = 3;

/// Which numbers of the table changed most, of absolute positions.
fn table(trace: &Trace, campaign: &Campaign) -> Option<String> {
    if !matches!(campaign.data, Data::Position(_)) {
        return None;
    }
    let [mut lengths, mut angles] = [Vec::new(), Vec::new()];
    for (number, (is, was)) in (1..).zip(trace.description.joints.iter().zip(&campaign.robot.joints)) {
        let change = |name: &str, of: fn(&Joint) -> f64| (format!("{name}{number}"), of(is) - of(was));
        lengths.extend([change("d", |joint| joint.d), change("a", |joint| joint.a)]);
        angles.extend([change("theta", |joint| joint.theta), change("alpha", |joint| joint.alpha)]);
    }
    let mut changes: Vec<String> = Vec::new();
    for (unit, mut of) in [("m", lengths), ("rad", angles)] {
        of.retain(|(_, by)| *by != 0.0);
        of.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        changes
            .extend(of.iter().take(MOST_CHANGED).map(|(name, by)| format!("{name} by {}", quantity(*by, None, unit))));
    }
    (!changes.is_empty()).then(|| {
        format!("The numbers of the DH table were fitted with everything. These changed most: {}.", and(&changes))
    })
}

/// Of the named effects, what the description declares of them: what is reported and written is the
/// whole number, not the change.
fn changed(trace: &Trace, campaign: &Campaign) -> Option<String> {
    let was = |named: &NamedEffect| {
        let declared = declared(&campaign.robot, &named.effect)?;
        // An order does not change.
        let numbers = parameters(declared).into_iter().filter(|&(_, _, unit)| unit != "1");
        let numbers = numbers.map(|(parameter, value, unit)| {
            let of = if parameter == "value" { String::new() } else { format!("{parameter} ") };
            of + &quantity(value, None, unit)
        });
        Some(format!("{declared} was {}", and(&numbers.collect::<Vec<_>>())))
    };
    let changed: Vec<String> = trace.effects.iter().filter_map(was).collect();
    (!changed.is_empty()).then(|| {
        let (these, was) = (if changed.len() == 1 { "it" } else { "these" }, changed.join("; "));
        format!("What the description declared of {these} is replaced: {was}.")
    })
}
