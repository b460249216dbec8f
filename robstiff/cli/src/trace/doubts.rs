//! What a tracing leaves open.

use robstiff_identify::trace::{Estimate, Rival, Trace, Visibility, is_offered_as_change};
use robstiff_robots::Effect;

use super::wording::declared;
use crate::text::words::{by_kind, spoken};
use crate::text::{and, decimals};

/// What else there could be, a sentence each.
pub fn doubts(trace: &Trace) -> Vec<String> {
    let mut doubts: Vec<String> = trace.rivals.iter().take(RIVALS).map(|rival| rivalry(trace, rival)).collect();
    if trace.rivals.len() > RIVALS {
        doubts.push(format!("{} more such models come close.", trace.rivals.len() - RIVALS));
    }
    let kept = trace.description.effects.iter().filter(|effect| effect.is_kinematic());
    let kept = kept.filter(|effect| !is_fitted(trace, effect));
    // Of displacements, a change of most of these is a candidate of the search.
    let of_displacements = trace.differences && trace.components == 3;
    let (unchanged, kept): (Vec<&Effect>, Vec<&Effect>) =
        kept.partition(|effect| of_displacements && is_offered_as_change(effect));
    let [unchanged, kept] =
        [unchanged, kept].map(|effects| effects.iter().map(ToString::to_string).collect::<Vec<_>>());
    if !unchanged.is_empty() {
        let names = and(&by_kind(&unchanged));
        doubts.push(format!("The description has these, of which no change shows, and they were kept: {names}."));
    }
    if !kept.is_empty() {
        doubts.push(format!("The description has these, which were taken as they are: {}.", and(&by_kind(&kept))));
    }
    if !trace.invisible.is_empty() {
        doubts.push(format!("These data could not show, if it were there: {}.", and(&by_kind(&trace.invisible))));
    }
    doubts
}

/// Whether the numbers of an effect are from these data.
fn is_fitted(trace: &Trace, effect: &Effect) -> bool {
    let name = effect.to_string();
    let of_it = |estimate: &&Estimate| {
        let number = estimate.name.strip_prefix(&name);
        number.is_some_and(|number| number.is_empty() || number.starts_with(' '))
    };
    trace.effects.iter().any(|named| declared(&trace.description, &named.effect) == Some(effect))
        || trace.estimates.iter().filter(of_it).any(|estimate| estimate.visibility == Visibility::Seen)
}

/// How many rivals are reported.
const RIVALS: usize = 5;

/// A rival by what it has instead of the best set.
fn rivalry(trace: &Trace, rival: &Rival) -> String {
    // Outliers are in no set.
    let named = trace.effects.iter().filter(|one| one.lines.is_empty()).map(|one| one.effect.to_string());
    let best: Vec<String> = named.chain(trace.suspected.iter().map(|one| one.effect.to_string())).collect();
    let odds = (0.5 * rival.bic_difference).exp();
    let behind = if rival.bic_difference < 0.2 {
        "is as probable".to_owned()
    } else {
        format!("comes close, with odds of {} to 1 against it", decimals(odds, usize::from(odds < 10.0)))
    };
    let [more, less] = [without(&rival.names, &best), without(&best, &rival.names)];
    match (more.is_empty(), less.is_empty()) {
        (false, false) => format!("A model with {} in place of {} {behind}.", and(&more), and(&less)),
        (false, true) => format!("A model with {} as well {behind}.", and(&more)),
        _ => format!("A model without {} {behind}.", and(&less)),
    }
}

/// Some names less others, in words; slips of several axes have one name, and count each.
fn without(names: &[String], others: &[String]) -> Vec<String> {
    let mut others = others.to_vec();
    let rest = names.iter().filter(|name| match others.iter().position(|other| other == *name) {
        Some(same) => {
            others.swap_remove(same);
            false
        }
        None => true,
    });
    rest.map(|name| spoken(name)).collect()
}
