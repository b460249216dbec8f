//! Words that the page and the report of a tracing have in common.

use robstiff::JointKind;
use robstiff_identify::campaign::{Campaign, Data};
use robstiff_identify::trace::{EffectParameter, Estimate, Found, NamedEffect, Proposal, SUSPECTED, Trace, Verdict};
use robstiff_robots::{Description, Effect, Joint};

pub use crate::identify::source_of;
use crate::report::terms::Terms;
use crate::text::words::spoken;
use crate::text::{and, capital, count, decimals};

/// A clause as a sentence.
pub fn sentence(clause: &str) -> String {
    format!("{}.", capital(clause).trim_end_matches('.'))
}

/// A share of searches: `80 %`.
pub fn share(share: f64) -> String {
    format!("{} %", decimals(100.0 * share, 0))
}

/// A probability that is never reported as certain: `97 %`, `> 99.9 %`.
pub fn probability(p: f64) -> String {
    match p {
        p if p > 0.999 => "> 99.9 %".to_owned(),
        p if p < 0.001 => "< 0.1 %".to_owned(),
        p if !(0.01..=0.99).contains(&p) => format!("{} %", decimals(100.0 * p, 1)),
        p => share(p),
    }
}

/// Whether the whole search was repeated without some poses.
pub fn is_repeated(trace: &Trace) -> bool {
    trace.nested.folds > 0
}

/// How probable an effect is, and in how many of the repeated searches it came back.
pub fn certainty(p: f64, recurs: f64) -> String {
    format!("probability {}, back in {} of the searches", probability(p), share(recurs))
}

/// What the data cannot tell an effect from: the members of its class but itself that are likely enough to
/// be suspected, in words, each with its probability.
pub fn alternatives(class: &[(String, f64)]) -> String {
    let words = |(name, p): &(String, f64)| format!("{} ({})", spoken(name), probability(*p));
    let words: Vec<String> = class.iter().skip(1).filter(|(_, p)| *p >= SUSPECTED).map(words).collect();
    match &words[..] {
        [start @ .., last] if !start.is_empty() => format!("{} or {last}", start.join(", ")),
        _ => words.concat(),
    }
}

/// The lines of the table that an effect is about, as ` (lines 3 and 7)`.
pub fn lines(named: &NamedEffect) -> String {
    match named.lines.len() {
        0 => String::new(),
        _ => format!(" ({})", numbered(&named.lines)),
    }
}

/// `line 3`, `lines 3 and 7`.
pub fn numbered(lines: &[usize]) -> String {
    let numbers: Vec<String> = lines.iter().map(usize::to_string).collect();
    format!("line{} {}", if lines.len() == 1 { "" } else { "s" }, and(&numbers))
}

/// The lines of the table with readings that do not belong to the others.
pub fn outliers(trace: &Trace) -> Vec<usize> {
    trace.effects.iter().flat_map(|named| named.lines.iter().copied()).collect()
}

/// The numbers of an effect that its words do not say.
pub fn reported(effect: &Found) -> impl Iterator<Item = &EffectParameter> {
    effect.parameters.iter().filter(|parameter| !matches!(parameter.name, "rows" | "line" | "axis" | "tool_frame"))
}

/// Whether the description that is written has the effect.
pub fn is_written(trace: &Trace, effect: &Found) -> bool {
    trace.verdict != Verdict::Insufficient && declared(&trace.description, effect).is_some()
}

/// The effect of a description that one that was found is, or is a change to.
pub fn declared<'d>(robot: &'d Description, found: &Found) -> Option<&'d Effect> {
    let effect = found.effect().filter(|_| !found.is_of_rig())?;
    robot.effects.iter().find(|declared| declared.is_same(&effect))
}

/// A number of an effect that the description declares, in words.
pub fn name_of(trace: &Trace, estimate: &Estimate) -> String {
    let effects = trace.description.effects.iter().map(ToString::to_string);
    let mut of_effects = effects.filter_map(|name| match estimate.name.strip_prefix(&name)? {
        "" => Some(spoken(&name)),
        number => number.strip_prefix(' ').map(|number| format!("{} ({number})", spoken(&name))),
    });
    of_effects.next().unwrap_or_else(|| estimate.name.clone())
}

/// The noise of what is read (m; of clamped axes, rad): of one reading, or of the difference of a loaded and
/// an unloaded one. Where each row has an unloaded reading for itself, the noise is that of the difference.
pub fn noise(trace: &Trace, campaign: &Campaign) -> f64 {
    let shared = match &campaign.data {
        Data::Displacement(data) => data.visits.len() < data.rows.len(),
        Data::Clamped(_) => true,
        Data::Position(_) => false,
    };
    if trace.differences && shared { trace.noise * std::f64::consts::SQRT_2 } else { trace.noise }
}

/// How the errors on unseen poses came about.
pub fn unseen(trace: &Trace, terms: Terms) -> String {
    match trace.held_out.len() {
        0 if is_repeated(trace) => {
            format!("each {} predicted by a whole search that was without it", terms.place[0])
        }
        0 => format!("no {} was left out of the fit", terms.place[0]),
        held_out => format!("{} held out of the search and of every fit", count(held_out, "pose")),
    }
}

/// The joint coordinates of a proposal.
pub fn pose(next: &Proposal, joints: &[Joint]) -> String {
    let numbers = next.q.iter().zip(joints).map(|(&q, joint)| decimals(joint.for_people(q), 0));
    let slides = |joint: &Joint| joint.kind == JointKind::Prismatic;
    if !joints.iter().any(slides) {
        return format!("({}) deg", numbers.collect::<Vec<_>>().join(", "));
    }
    let coordinates = numbers.zip(joints).map(|(number, joint)| format!("{number} {}", joint.people_unit()));
    format!("({})", coordinates.collect::<Vec<_>>().join(", "))
}

/// What a proposal loads the arm with.
pub fn load(next: &Proposal) -> String {
    match next.payload {
        None => format!("force ({}) N", next.force.map(|newton| decimals(newton, 0)).join(", ")),
        Some(payload) => format!("payload {} kg", decimals(payload, 0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_told_as_certain() {
        let told = [1.0, 0.9991, 0.9985, 0.973, 0.5, 0.004, 0.0].map(probability);
        assert_eq!(told, ["> 99.9 %", "> 99.9 %", "99.9 %", "97 %", "50 %", "0.4 %", "< 0.1 %"]);
        assert_eq!(share(1.0), "100 %");
    }

    #[test]
    fn alternatives_are_the_likely_ones_but_the_first() {
        let class = |names: &[&str]| -> Vec<(String, f64)> {
            names.iter().zip([0.7, 0.2, 0.06, 0.04]).map(|(name, p)| ((*name).to_owned(), p)).collect()
        };
        let names = ["lost_motion@joint 1", "stiffness_nonlinearity@joint 1", "lever_arm@rig", "creep@joint 2"];
        assert_eq!(alternatives(&class(&names[..1])), "");
        assert_eq!(alternatives(&class(&names[..2])), "stiffness nonlinearity of joint 1 (20 %)");
        assert_eq!(
            alternatives(&class(&names)),
            "stiffness nonlinearity of joint 1 (20 %) or lever arm (measurement) (6 %)"
        );
    }
}
