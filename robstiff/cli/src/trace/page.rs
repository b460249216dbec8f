//! The story of a tracing for a terminal.

use robstiff_identify::campaign::Campaign;
use robstiff_identify::trace::{EffectParameter, Found, NamedEffect, Suspected, Trace};

use super::doubts::doubts;
use super::finding::headline;
use super::wording::{
    alternatives, certainty, is_repeated, is_written, lines, load, noise, pose, probability, reported, source_of,
    unseen,
};
use crate::report::terms::Terms;
use crate::text::words::spoken;
use crate::text::{Table, count, fine_micrometres, quantity};

/// The story, with its summary.
pub fn page(trace: &Trace, campaign: &Campaign, summary: &[String]) -> String {
    let terms = Terms::of(campaign);
    let headline = headline(trace, campaign);
    let mut page = format!(
        "{}: {} at {}\n{}\n\n{}  (unseen: {})\n\nVerdict: {}. {headline}.\n",
        trace.robot,
        count(trace.rows, "row"),
        terms.places(trace.poses),
        of_noise(trace, campaign),
        errors(trace, terms),
        unseen(trace, terms),
        trace.verdict
    );
    for sentence in summary {
        page += &format!("{sentence}\n");
    }
    page += &named(trace);
    if !trace.suspected.is_empty() {
        page += "\nSuspected, but not certain enough to be named:\n";
        trace.suspected.iter().for_each(|of| page += &suspected(trace, of));
    }
    let doubts = doubts(trace);
    if !doubts.is_empty() {
        page += &format!("\nWhat the data leave open:\n  {}\n", doubts.join("\n  "));
    }
    page + &next(trace)
}

fn of_noise(trace: &Trace, campaign: &Campaign) -> String {
    let Terms { reading, unit, .. } = Terms::of(campaign);
    let of_reading = fine_micrometres(trace.noise);
    let source = source_of(trace.noise_source);
    let of_two = noise(trace, campaign);
    if of_two > trace.noise {
        let of_two = fine_micrometres(of_two);
        return format!(
            "noise: {of_reading} {unit} a reading ({source}), up to {of_two} {unit} a {reading}, the difference of two"
        );
    }
    let what = if trace.differences { reading } else { "reading" };
    format!("noise: {of_reading} {unit} a {what} ({source})")
}

/// The table of errors.
fn errors(trace: &Trace, Terms { unseen: [_, unseen], unit, .. }: Terms) -> Table {
    let header = [format!("error [{unit}]"), format!("fitted {unseen}"), format!("unseen {unseen}")];
    let mut errors = Table::new(1, header);
    let mut stages = vec![("as declared", trace.declared), ("joints identified again", trace.identified)];
    let last = match (trace.effects.is_empty(), trace.suspected.is_empty()) {
        (true, true) => None,
        (false, true) => Some("with the effects"),
        (true, false) => Some("with what is suspected"),
        (false, false) => Some("with the effects and what is suspected"),
    };
    stages.extend(
        last.into_iter().flat_map(|name| [(name, trace.after), ("as the description is written", trace.written)]),
    );
    for (name, misfit) in stages {
        errors.row([name.to_owned(), fine_micrometres(misfit.rms), fine_micrometres(misfit.holdout_rms)]);
    }
    errors
}

/// What was named, by where it goes.
fn named(trace: &Trace) -> String {
    let of = |which: &dyn Fn(&NamedEffect) -> bool| trace.effects.iter().filter(|one| which(one)).collect();
    let groups: [(&str, Vec<&NamedEffect>); 3] = [
        ("Missing in the robot, written into its description:", of(&|one| is_written(trace, &one.effect))),
        (
            "Missing in the robot, which descriptions cannot say:",
            of(&|one| !one.effect.is_of_rig() && !is_written(trace, &one.effect)),
        ),
        ("Faults of the measurement, corrected for, not written into the robot:", of(&|one| one.effect.is_of_rig())),
    ];
    let mut page = String::new();
    for (heading, effects) in groups.iter().filter(|(_, effects)| !effects.is_empty()) {
        page += &format!("\n{heading}\n");
        for named in effects {
            page += &format!("  {}{}\n", named.effect.words(), lines(named));
            page += &numbers(&named.effect);
            page += &certain(trace, (named.probability, named.recurs), &named.class);
        }
    }
    page
}

fn suspected(trace: &Trace, of: &Suspected) -> String {
    let mut page = format!("  {}: {}\n", of.effect.words(), of.why_not);
    page += &numbers(&of.effect);
    page += &certain(trace, (of.probability, of.recurs), &of.class);
    if is_written(trace, &of.effect) {
        page += "    the description has it all the same: it predicts best with it\n";
    }
    page
}

/// The full name of an effect, and its numbers.
fn numbers(effect: &Found) -> String {
    let number =
        |number: &EffectParameter| format!("{} = {}", number.name, quantity(number.value, number.std, number.unit));
    let mut numbers: Vec<String> = reported(effect).map(number).collect();
    let more = numbers.len().saturating_sub(MOST_NUMBERS);
    if more > 0 {
        numbers.truncate(MOST_NUMBERS);
        numbers.push(format!("and {more} more"));
    }
    let colon = if numbers.is_empty() { "" } else { ": " };
    format!("    {effect}{colon}{}\n", numbers.join(", "))
}

/// So many numbers of an effect are shown: what wanders has one of each axis at many moments.
const MOST_NUMBERS: usize = 6;

/// How certain an effect is, and what it may be instead.
fn certain(trace: &Trace, (p, recurs): (f64, f64), class: &[(String, f64)]) -> String {
    let mut page = match is_repeated(trace) {
        true => format!("    {}\n", certainty(p, recurs)),
        false => format!("    probability {}\n", probability(p)),
    };
    let others = alternatives(class);
    if !others.is_empty() {
        page += &format!("    these data cannot tell it from {others}\n");
    }
    page
}

/// What to measure next.
fn next(trace: &Trace) -> String {
    let mut page = String::new();
    for group in trace.next.chunk_by(|a, b| a.separates == b.separates) {
        let [one, other] = group[0].separates.each_ref().map(|name| spoken(name));
        page += &format!("\nTo tell {one} from {other}, measure next:\n");
        for next in group {
            page += &format!("  q = {}, {}\n", pose(next, &trace.description.joints), load(next));
        }
    }
    page
}
