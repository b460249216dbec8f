//! What a tracing leaves open.

use robstiff_identify::identify::{Estimate, Visibility};
use robstiff_identify::trace::{Rival, Trace, is_offered_as_change};
use robstiff_robots::Effect;

use super::story::{declared, name_of};
use crate::text::words::{by_kind, spoken};
use crate::text::{and, decimals};

/// What else there could be, a sentence each.
pub fn doubts(trace: &Trace) -> Vec<String> {
    let mut doubts: Vec<String> = trace.rivals.iter().take(RIVALS).map(|rival| rivalry(trace, rival)).collect();
    if trace.rivals.len() > RIVALS {
        doubts.push(format!("{} more such models come close.", trace.rivals.len() - RIVALS));
    }
    doubts.extend(confounded(trace));
    let held = trace.description.effects.iter().filter(|effect| effect.is_kinematic());
    let held = held.filter(|effect| !is_fitted(trace, effect));
    // Of displacements, changes of most are looked for; what is left has none that shows.
    let of_displacements = trace.differences && trace.components == 3;
    let (unchanged, held): (Vec<&Effect>, Vec<&Effect>) =
        held.partition(|effect| of_displacements && is_offered_as_change(effect));
    let [unchanged, held] =
        [unchanged, held].map(|effects| effects.iter().map(ToString::to_string).collect::<Vec<_>>());
    if !unchanged.is_empty() {
        let names = and(&by_kind(&unchanged));
        doubts.push(format!("The description has these, of which no change shows, and they were kept: {names}."));
    }
    if !held.is_empty() {
        doubts.push(format!("The description has these, which were taken as they are: {}.", and(&by_kind(&held))));
    }
    if !trace.invisible.is_empty() {
        doubts.push(format!("These data could not show, if it were there: {}.", and(&by_kind(&trace.invisible))));
    }
    doubts
}

/// Which of the description's numbers may have some of an effect in them, a sentence for each effect.
fn confounded(trace: &Trace) -> impl Iterator<Item = String> {
    let mut effects: Vec<&String> = Vec::new();
    for name in trace.estimates.iter().flat_map(|estimate| &estimate.confounded_with) {
        if !effects.contains(&name) {
            effects.push(name);
        }
    }
    effects.into_iter().map(|effect| {
        let confounded = trace.estimates.iter().filter(|estimate| estimate.confounded_with.contains(effect));
        let numbers: Vec<String> = confounded.map(|estimate| name_of(trace, estimate)).collect();
        let (its, deviation) =
            if numbers.len() == 1 { ("its", "deviation allows") } else { ("their", "deviations allow") };
        format!(
            "These data do not tell {} from {}, of which any share fits as well: {its} standard {deviation} for that.",
            and(&numbers),
            trace
                .estimates
                .iter()
                .find(|own| own.name == *effect)
                .map_or_else(|| spoken(effect), |own| name_of(trace, own))
        )
    })
}

/// Whether the numbers of an effect are from these data.
fn is_fitted(trace: &Trace, effect: &Effect) -> bool {
    let name = effect.to_string();
    let of_it = |estimate: &&Estimate| {
        let number = estimate.name.strip_prefix(&name);
        number.is_some_and(|number| number.is_empty() || number.starts_with(' '))
    };
    trace.effects.iter().any(|named| declared(&trace.description, named) == Some(effect))
        || trace.estimates.iter().filter(of_it).any(|estimate| estimate.visibility == Visibility::Seen)
}

/// How many rivals are told.
const RIVALS: usize = 5;

/// A rival by what it has instead of what was named.
fn rivalry(trace: &Trace, rival: &Rival) -> String {
    // What is wrong in single visits is in no model.
    let of_model = trace.effects.iter().filter(|one| one.lines.is_empty());
    let named: Vec<String> = of_model.map(|one| one.effect.to_string()).collect();
    let odds = (0.5 * rival.bic_difference).exp();
    let behind = if rival.bic_difference < 0.2 {
        "fits as well".to_owned()
    } else {
        format!("comes close, with odds of {} to 1 against it", decimals(odds, usize::from(odds < 10.0)))
    };
    format!(
        "A model with {} in place of {} {behind}.",
        and(&without(&rival.names, &named)),
        and(&without(&named, &rival.names))
    )
}

/// Some names less others, in words; slips of several axes have one name, and count each.
fn without(names: &[String], others: &[String]) -> Vec<String> {
    let mut others = others.to_vec();
    let left = names.iter().filter(|name| match others.iter().position(|other| other == *name) {
        Some(same) => {
            others.swap_remove(same);
            false
        }
        None => true,
    });
    left.map(|name| spoken(name)).collect()
}
