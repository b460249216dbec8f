//! What a tracing came to, in sentences.

use robstiff::JointKind;
use robstiff::trace::{NamedEffect, Proposal, Trace, Verdict};
use robstiff_robots::Joint;

use crate::identify::{at_bound, source_of};
use crate::text::{Table, and, count, decimals, micrometres, probability, uncertain};

/// The finding in one sentence.
pub fn headline(trace: &Trace) -> String {
    let (before, after) = (micrometres(trace.identified.holdout_rms), micrometres(trace.after.holdout_rms));
    let words = |of_rig: bool| -> Vec<String> {
        let those = trace.effects.iter().filter(|named| named.effect.is_of_rig() == of_rig);
        those.map(|named| named.effect.words()).collect()
    };
    let shown = || match [words(false), words(true)] {
        [robot, rig] if rig.is_empty() => format!("The description lacks {}", and(&robot)),
        [robot, rig] if robot.is_empty() => format!("The measurement has {}", and(&rig)),
        [robot, rig] => format!("The description lacks {}, and the measurement has {}", and(&robot), and(&rig)),
    };
    match trace.verdict {
        Verdict::Adequate => format!("Nothing is missing: identified joints predict unseen poses to {after} um"),
        Verdict::Explained | Verdict::Partial => format!(
            "{}; with {} the error on unseen poses falls from {before} to {after} um{}",
            shown(),
            if trace.effects.len() == 1 { "it" } else { "them" },
            if trace.verdict == Verdict::Partial { ", but something more is missing" } else { "" }
        ),
        Verdict::Unexplained => {
            format!(
                "Something is missing that no effect in the catalogue accounts for: {after} um remain on unseen poses"
            )
        }
        Verdict::Insufficient => "These data cannot tell whether anything is missing".to_owned(),
    }
}

/// What follows the finding, a sentence each.
pub fn summary(trace: &Trace) -> Vec<String> {
    let mut sentences = vec![sentence(&trace.why)];
    if trace.verdict == Verdict::Insufficient {
        sentences.push("The description keeps its declared values.".to_owned());
    }
    let clipped = trace.estimates.iter().filter(|estimate| estimate.at_bound);
    sentences.extend(clipped.map(|estimate| at_bound(&estimate.name) + "."));
    for named in trace.effects.iter().filter(|named| !named.lines.is_empty()) {
        let lines: Vec<String> = named.lines.iter().map(usize::to_string).collect();
        sentences.push(format!(
            "{} is seen on line{} {}.",
            named.effect,
            if lines.len() == 1 { "" } else { "s" },
            and(&lines)
        ));
    }
    for named in &trace.effects {
        if !named.same_as.is_empty() {
            sentences.push(format!("These data cannot tell {} from {}.", named.effect, and(&named.same_as)));
        }
    }
    if !trace.depends_on.is_empty() && matches!(trace.verdict, Verdict::Partial | Verdict::Unexplained) {
        sentences.push(format!("What is left depends on {}.", and(&trace.depends_on)));
    }
    sentences
}

/// A clause as a sentence.
fn sentence(clause: &str) -> String {
    let mut letters = clause.chars();
    let start = letters.next().map(|first| first.to_uppercase().to_string()).unwrap_or_default();
    format!("{start}{}.", letters.as_str().trim_end_matches('.'))
}

/// The noise of a displacement, the difference of a loaded and an unloaded
/// reading \[m\]; less where the unloaded one is an average of many.
pub fn displacement_noise(trace: &Trace) -> f64 {
    trace.noise * std::f64::consts::SQRT_2
}

/// How the errors on unseen poses came about.
pub fn unseen(trace: &Trace) -> String {
    match trace.held_out.len() {
        0 => "each pose predicted by the fit without it".to_owned(),
        held_out => format!("{} held out of the search and of every fit", count(held_out, "pose")),
    }
}

/// The numbers of an effect, each with its uncertainty.
pub fn numbers(named: &NamedEffect) -> Vec<String> {
    let number = |parameter: &robstiff::trace::EffectParameter| {
        let value = uncertain(parameter.value, parameter.std.unwrap_or(f64::NAN));
        format!("{} = {value} {}", parameter.name, parameter.unit)
    };
    named.parameters.iter().map(number).collect()
}

/// The joint coordinates of a proposal.
pub fn pose(next: &Proposal, joints: &[Joint]) -> String {
    let coordinates = next.q.iter().zip(joints).map(|(&q, joint)| match joint.kind {
        JointKind::Revolute => format!("{} deg", decimals(q.to_degrees(), 0)),
        JointKind::Prismatic => format!("{} mm", decimals(q * 1e3, 0)),
    });
    coordinates.collect::<Vec<_>>().join(", ")
}

/// The story for a terminal.
pub fn page(trace: &Trace) -> String {
    let noise = format!(
        "noise: {} um a reading ({}), up to {} um a displacement, the difference of two",
        micrometres(trace.noise),
        source_of(trace.noise_source),
        micrometres(displacement_noise(trace))
    );
    let mut page =
        format!("{}: {} at {}\n{noise}\n\n", trace.robot, count(trace.rows, "row"), count(trace.poses, "pose"));
    let mut errors = Table::new(1, ["error [um]", "fitted poses", "unseen poses"]);
    let mut stages = vec![("as declared", trace.declared), ("joints identified again", trace.identified)];
    if !trace.effects.is_empty() {
        stages.push(("with the effects", trace.after));
    }
    for (name, misfit) in stages {
        errors.row([name.to_owned(), micrometres(misfit.rms), micrometres(misfit.holdout_rms)]);
    }
    page += &format!("{errors}  (unseen: {})\n\n{}.\n", unseen(trace), headline(trace));
    for named in &trace.effects {
        page += &format!(
            "  {}: {}, p {}\n",
            named.effect,
            numbers(named).join(", "),
            match probability(named.p_value) {
                small if small.starts_with('<') => small,
                p => format!("= {p}"),
            }
        );
    }
    for said in summary(trace) {
        page += &format!("{said}\n");
    }
    for next in &trace.next {
        let [one, other] = &next.separates;
        page += &format!(
            "To tell {one} from {other}: q = ({}), force ({}) N\n",
            pose(next, &trace.description.joints),
            next.force.map(|newton| decimals(newton, 0)).join(", ")
        );
    }
    page + &format!("Verdict: {}\n", trace.verdict)
}
