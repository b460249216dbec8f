//! What a tracing came to, in sentences.

use robstiff::JointKind;
use robstiff_identify::campaign::Campaign;
use robstiff_identify::identify::{EncodersRead, Estimate, Visibility, predict};
use robstiff_identify::trace::{EffectParameter, NamedEffect, Nested, Proposal, RowResidual, Trace, Verdict};
use robstiff_robots::{Description, Effect, Joint};

use super::doubts::doubts;
use super::warned;
use crate::effect::parameters;
use crate::identify::{at_bound, source_of};
use crate::report::terms::Terms;
use crate::text::words::spoken;
use crate::text::{Table, and, capital, count, course, decimals, fine_micrometres, p_value, quantity};

/// How a mistake ends that is of the angles of joints.
const BACKWARDS: &str = " counted the other way";

/// The finding in one sentence.
pub fn headline(trace: &Trace, nested: Option<&Nested>, terms: Terms) -> String {
    let Terms { unseen: [_, unseen], unit, .. } = terms;
    // What the search has not seen is the better witness.
    let (before, after) = match nested {
        Some(nested) => (nested.identified_rms, nested.rms),
        None => (trace.identified.holdout_rms, trace.after.holdout_rms),
    };
    let told = fine_micrometres(after);
    let words = |of_rig: bool| -> Vec<String> {
        let those = trace.effects.iter().filter(|named| named.effect.is_of_rig() == of_rig);
        those.map(|named| named.effect.words()).collect()
    };
    let shown = || match [words(false), words(true)] {
        [robot, rig] if rig.is_empty() => format!("The description lacks {}", and(&robot)),
        [robot, rig] if robot.is_empty() => format!("The measurement has {}", and(&rig)),
        // Beside the robot's, single faults of the rig would bury the finding.
        [robot, rig] => format!(
            "The description lacks {}, and the measurement has {} of its own",
            and(&robot),
            count(rig.len(), "fault")
        ),
    };
    match trace.verdict {
        Verdict::Adequate => {
            let what = match fitted_again(trace) {
                None => "identified joints predict",
                Some(_) => "the description's numbers, fitted again, predict",
            };
            format!("Nothing is missing: {what} unseen {unseen} to {told} {unit}")
        }
        Verdict::Explained | Verdict::Partial => format!(
            "{}; with {} the error on unseen {unseen} {} {unit}{}",
            shown(),
            if trace.effects.len() == 1 { "it" } else { "them" },
            course(before, after).join(" "),
            match trace.verdict {
                Verdict::Partial if trace.effects.iter().any(|named| named.partial) =>
                    ", but something more is missing",
                Verdict::Partial => ", but something more may be missing",
                _ => "",
            }
        ),
        Verdict::Unexplained => {
            format!(
                "Something is missing that no effect in the catalogue accounts for: {told} {unit} remain on unseen \
                 {unseen}"
            )
        }
        Verdict::Insufficient => match trace.looks_like.first().and_then(|words| words.strip_suffix(BACKWARDS)) {
            // Whoever sees nothing else sees this.
            Some(joints) if trace.looks_like.len() == 1 => {
                let count = if joints.contains(' ') { "count" } else { "counts" };
                format!("The files may say something else than what was measured: {joints} {count} the other way")
            }
            _ => "These data cannot tell whether anything is missing".to_owned(),
        },
    }
}

/// What follows the finding, a sentence each.
pub fn summary(trace: &Trace, nested: Option<&Nested>, campaign: &Campaign) -> Vec<String> {
    let mut sentences = vec![sentence(&trace.why)];
    sentences.extend(nested.map(|nested| searched_again(nested, Terms::of(campaign))));
    sentences.extend(warned::besides(trace, campaign));
    sentences.extend(trace.encoders.iter().flat_map(|read| encoders(read, trace)));
    sentences.extend(without_rows(trace, Terms::of(campaign)));
    sentences.extend(alone(trace, campaign));
    sentences.extend(undecided(trace));
    if trace.verdict == Verdict::Insufficient {
        sentences.push("The description keeps its declared values.".to_owned());
    }
    sentences.extend(fitted_again(trace));
    sentences.extend(changed(trace, campaign));
    // Of values that are not taken, none is written.
    let is_taken = trace.verdict != Verdict::Insufficient;
    let clipped = trace.estimates.iter().filter(|estimate| is_taken && estimate.at_bound);
    let declared = || trace.description.effects.iter().map(ToString::to_string);
    let effects = || trace.effects.iter().map(|named| named.effect.to_string()).chain(declared());
    sentences.extend(clipped.map(|estimate| sentence(&at_bound(&estimate.name, effects()))));
    // What the joints alone seemed to show, and do not beside the effects.
    let was_seen = |(now, before): &(&Estimate, &Estimate)| {
        now.visibility == Visibility::Unseen && before.visibility == Visibility::Seen
    };
    let kept = trace.estimates.iter().zip(&trace.estimates_before).filter(|both| is_taken && was_seen(both));
    sentences.extend(
        kept.map(|(now, _)| {
            sentence(&format!("{} does not show in these data and keeps its declared value", now.name))
        }),
    );
    if !trace.depends_on.is_empty() && matches!(trace.verdict, Verdict::Partial | Verdict::Unexplained) {
        sentences.push(format!("What is left depends on {}.", and(&trace.depends_on)));
    }
    sentences
}

/// A name that comes back in fewer of the searches is not told.
const SELDOM: f64 = 0.1;

/// What the search says of poses that it was without, and what it named again.
fn searched_again(nested: &Nested, Terms { unit, .. }: Terms) -> String {
    let [before, after] = [nested.identified_rms, nested.rms].map(fine_micrometres);
    let often = nested.names.iter().filter(|one| one.share >= SELDOM);
    let again: Vec<String> =
        often.map(|one| format!("{} in {} %", spoken(&one.name), decimals(100.0 * one.share, 0))).collect();
    let named = if again.is_empty() { String::from("no effect often") } else { and(&again) };
    format!(
        "The whole search was repeated {} times, each time without some poses: the error on these is {after} {unit} \
         ({before} {unit} with joints identified again). It named {named} of the searches.",
        nested.folds
    )
}

/// How well the description predicts that is written, where the fit has faults of the rig besides.
fn alone(trace: &Trace, campaign: &Campaign) -> Option<String> {
    if trace.verdict == Verdict::Insufficient || !trace.effects.iter().any(|named| named.effect.is_of_rig()) {
        return None;
    }
    let error = |robot| Some(fine_micrometres(predict(robot, campaign).ok()?.rms));
    let (written, declared) = (error(&trace.description)?, error(&campaign.robot)?);
    Some(format!(
        "The robot that is written has no faults of the measurement in it, and alone predicts the readings as they are \
         to {written} um ({declared} um as declared)."
    ))
}

/// What encoders were to the trace.
fn encoders(read: &EncodersRead, trace: &Trace) -> Vec<String> {
    let mut sentences = Vec::new();
    if let (false, Some(most)) = (read.joints.is_empty(), read.noise.iter().copied().reduce(f64::max)) {
        let turns = |joint: &usize| trace.description.joints[joint - 1].kind == JointKind::Revolute;
        let unit = if read.joints.iter().all(turns) { "urad" } else { "urad or um" };
        let joints: Vec<String> = read.joints.iter().map(usize::to_string).collect();
        sentences.push(format!(
            "The fit has to agree with the encoders behind the gears, too (joint{} {}, {} {unit} a reading): what they \
             do not see is in no gear.",
            if joints.len() == 1 { "" } else { "s" },
            and(&joints),
            decimals(most * 1e6, 1)
        ));
    }
    if read.unused {
        sentences.push(
            "The encoders behind the gears took no part: too few loads at a pose, or nothing but copies of q, to tell \
             how noisy they are."
                .to_owned(),
        );
    }
    if read.motors {
        sentences.push("What the motors let through of the load is taken from the readings.".to_owned());
    }
    sentences
}

/// Of the effects that a description declares, what was fitted again and is not what it
/// says.
fn fitted_again(trace: &Trace) -> Option<String> {
    let fitted = |estimate: &&Estimate| estimate.visibility == Visibility::Seen && estimate.name.contains('@');
    let seen: Vec<&Estimate> = trace.estimates.iter().filter(fitted).collect();
    if seen.is_empty() || trace.verdict == Verdict::Insufficient {
        return None;
    }
    let has_moved =
        |estimate: &&&Estimate| (estimate.value - estimate.declared).abs() > MOVED * estimate.std.unwrap_or_default();
    let said = |estimate: &&Estimate| {
        let was = quantity(estimate.declared, None, estimate.unit);
        let is = quantity(estimate.value, estimate.std, estimate.unit);
        format!("{} was {was} and is {is}", name_of(trace, estimate))
    };
    let moved: Vec<String> = seen.iter().filter(has_moved).map(said).collect();
    let of_others = match (moved.len(), seen.len() - moved.len()) {
        (0, _) => "none has changed",
        (_, 0) => "",
        _ => "; the rest has not changed",
    };
    Some(format!("The effects that the description declares were fitted again: {}{of_others}.", moved.join("; ")))
}

/// Of the named effects, what the description declares of them: what is told and written is the
/// whole number, not the change.
fn changed(trace: &Trace, campaign: &Campaign) -> Option<String> {
    let was = |named: &NamedEffect| {
        let declared = declared(&campaign.robot, named)?;
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

/// A number that is off what is declared by more standard deviations has changed.
const MOVED: f64 = 3.0;

/// A number of an effect that the description declares, in words.
pub fn name_of(trace: &Trace, estimate: &Estimate) -> String {
    let effects = trace.description.effects.iter().map(ToString::to_string);
    let mut of_effects = effects.filter_map(|name| match estimate.name.strip_prefix(&name)? {
        "" => Some(spoken(&name)),
        number => number.strip_prefix(' ').map(|number| format!("{} ({number})", spoken(&name))),
    });
    of_effects.next().unwrap_or_else(|| estimate.name.clone())
}

/// The lines of the table that the final model is not fitted to.
pub fn left_out(trace: &Trace) -> Vec<usize> {
    trace.effects.iter().flat_map(|named| named.lines.iter().copied()).collect()
}

/// The errors without the rows that the fit with the effects leaves out; all others are of all rows.
fn without_rows(trace: &Trace, Terms { unit, .. }: Terms) -> Option<String> {
    let lines = left_out(trace);
    if lines.is_empty() {
        return None;
    }
    let rms = |of: fn(&RowResidual) -> [f64; 3]| {
        let rows = trace.residuals.iter().filter(|row| !lines.contains(&row.line));
        let components = rows.flat_map(|row| of(row).into_iter().take(trace.components));
        let squares: Vec<f64> = components.map(|component| component * component).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    };
    let without = course(rms(|row| row.before), rms(|row| row.after)).join(" ");
    let [line, it] = if lines.len() == 1 { ["line", "it"] } else { ["lines", "them"] };
    Some(format!(
        "The fit with the effects leaves out {line} {}; the errors above have {it} in, by what the fit predicts. \
         Without {it} the error on fitted rows {without} {unit}.",
        and(&lines.iter().map(usize::to_string).collect::<Vec<_>>())
    ))
}

/// The lines of poses held out that nothing is judged by.
fn undecided(trace: &Trace) -> Option<String> {
    let lines: Vec<String> = trace.undecided.iter().map(usize::to_string).collect();
    let [line, is, it] = if lines.len() == 1 { ["Line", "is", "it was"] } else { ["Lines", "are", "they were"] };
    (!lines.is_empty()).then(|| {
        format!(
            "{line} {}, held out, {is} left out of the error on unseen poses: no line fitted tells on which side of \
             the slip {it}.",
            and(&lines)
        )
    })
}

/// Whether the description that is written has the effect.
pub fn is_written(trace: &Trace, named: &NamedEffect) -> bool {
    declared(&trace.description, named).is_some()
}

/// The effect of a description that a named one is, or is a change to.
pub fn declared<'d>(robot: &'d Description, named: &NamedEffect) -> Option<&'d Effect> {
    let own = named.effect.effect_on(robot).filter(|_| !named.effect.is_of_rig())?;
    robot.effects.iter().find(|effect| effect.is_same(&own))
}

/// The lines of the table that an effect is about, as ` (lines 3 and 7)`.
pub fn lines(named: &NamedEffect) -> String {
    let lines: Vec<String> = named.lines.iter().map(usize::to_string).collect();
    match lines.len() {
        0 => String::new(),
        1 => format!(" (line {})", lines[0]),
        _ => format!(" (lines {})", and(&lines)),
    }
}

/// The numbers of an effect that its words do not say.
pub fn told(named: &NamedEffect) -> impl Iterator<Item = &EffectParameter> {
    named
        .effect
        .parameters
        .iter()
        .filter(|parameter| !matches!(parameter.name, "rows" | "line" | "axis" | "tool_frame"))
}

/// A clause as a sentence.
fn sentence(clause: &str) -> String {
    format!("{}.", capital(clause).trim_end_matches('.'))
}

/// The noise of what is read (m): of one reading, or of the difference of a
/// loaded and an unloaded one; less where the unloaded one is an average of many.
pub fn noise(trace: &Trace) -> f64 {
    if trace.differences { trace.noise * std::f64::consts::SQRT_2 } else { trace.noise }
}

/// How the errors on unseen poses came about.
pub fn unseen(trace: &Trace, terms: Terms) -> String {
    match trace.held_out.len() {
        0 => format!("each {} predicted by the fit without it; the search has seen it", terms.unseen[0]),
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

/// The story for a terminal, with its [`summary`].
pub fn page(trace: &Trace, nested: Option<&Nested>, campaign: &Campaign, summary: &[String]) -> String {
    let terms = Terms::of(campaign);
    let Terms { unseen: [_, unseen], reading, unit, .. } = terms;
    let mut noise =
        format!("noise: {} {unit} a reading ({})", fine_micrometres(trace.noise), source_of(trace.noise_source));
    if trace.differences {
        let of_two = fine_micrometres(self::noise(trace));
        noise += &format!(", up to {of_two} {unit} a {reading}, the difference of two");
    }
    let mut page =
        format!("{}: {} at {}\n{noise}\n\n", trace.robot, count(trace.rows, "row"), terms.places(trace.poses));
    let header = [format!("error [{unit}]"), format!("fitted {unseen}"), format!("unseen {unseen}")];
    let mut errors = Table::new(1, header);
    let mut stages = vec![("as declared", trace.declared), ("joints identified again", trace.identified)];
    if !trace.effects.is_empty() {
        stages.push(("with the effects", trace.after));
    }
    for (name, misfit) in stages {
        errors.row([name.to_owned(), fine_micrometres(misfit.rms), fine_micrometres(misfit.holdout_rms)]);
    }
    let (judged, headline) = (self::unseen(trace, terms), headline(trace, nested, terms));
    page += &format!("{errors}  (unseen: {judged})\n\nVerdict: {}. {headline}.\n", trace.verdict);
    for said in summary {
        page += &format!("{said}\n");
    }
    let groups: [(&str, Vec<&NamedEffect>); 3] = [
        ("Missing in the robot, written into its description:", of(trace, |one| is_written(trace, one))),
        (
            "Missing in the robot, which descriptions cannot say:",
            of(trace, |one| !one.effect.is_of_rig() && !is_written(trace, one)),
        ),
        (
            "Faults of the measurement, corrected for, not written into the robot:",
            of(trace, |one| one.effect.is_of_rig()),
        ),
    ];
    for (heading, effects) in groups.iter().filter(|(_, effects)| !effects.is_empty()) {
        page += &format!("\n{heading}\n");
        effects.iter().for_each(|named| page += &effect(named));
    }
    let doubts = doubts(trace);
    if !doubts.is_empty() {
        page += &format!("\nWhat the data leave open:\n  {}\n", doubts.join("\n  "));
    }
    for group in trace.next.chunk_by(|a, b| a.separates == b.separates) {
        let [one, other] = group[0].separates.each_ref().map(|name| spoken(name));
        page += &format!("\nTo tell {one} from {other}, measure next:\n");
        for next in group {
            page += &format!("  q = {}, {}\n", pose(next, &trace.description.joints), load(next));
        }
    }
    page
}

/// What a proposal loads the arm with.
pub fn load(next: &Proposal) -> String {
    match next.payload {
        None => format!("force ({}) N", next.force.map(|newton| decimals(newton, 0)).join(", ")),
        Some(payload) => format!("payload {} kg", decimals(payload, 0)),
    }
}

fn of(trace: &Trace, which: impl Fn(&NamedEffect) -> bool) -> Vec<&NamedEffect> {
    trace.effects.iter().filter(|named| which(named)).collect()
}

/// An effect for a terminal.
fn effect(named: &NamedEffect) -> String {
    let p = p_value(named.p_value);
    let mut said = format!("  {}{}, {p}\n    {}", named.effect.words(), lines(named), named.effect);
    let number =
        |number: &EffectParameter| format!("{} = {}", number.name, quantity(number.value, number.std, number.unit));
    let numbers: Vec<String> = told(named).map(number).collect();
    if !numbers.is_empty() {
        said += &format!(": {}", numbers.join(", "));
    }
    if !named.same_as.is_empty() {
        said += &format!("\n    these data cannot tell it from {}", either(&named.same_as));
    }
    if !named.in_part.is_empty() {
        said += &format!("\n    some of it may as well be {}", either(&named.in_part));
    }
    said + "\n"
}

/// Names in words: `one, two or three`.
pub fn either(names: &[String]) -> String {
    let words: Vec<String> = names.iter().map(|name| spoken(name)).collect();
    match &words[..] {
        [start @ .., last] if !start.is_empty() => format!("{} or {last}", start.join(", ")),
        _ => words.concat(),
    }
}
