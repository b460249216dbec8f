//! What a tracing found, in sentences.

use robstiff::JointKind;
use robstiff_identify::campaign::{Campaign, Data};
use robstiff_identify::predict::predict;
use robstiff_identify::trace::{RowResidual, Trace, Verdict};

use super::numbers;
use super::wording::{is_repeated, numbered, outliers, sentence, share};
use crate::report::terms::Terms;
use crate::text::words::spoken;
use crate::text::{and, change_of_error, count, decimals, fine_micrometres};

/// The finding in one sentence, without its full stop.
pub fn headline(trace: &Trace, campaign: &Campaign) -> String {
    let Terms { unseen: [_, unseen], unit, .. } = Terms::of(campaign);
    let [declared, identified, after] =
        [trace.declared, trace.identified, trace.after].map(|misfit| misfit.holdout_rms);
    // What is a number of the table as well is fitted either way, and shows against the table as declared.
    let before = if after < identified || declared < after { identified } else { declared };
    let remain = |rms: f64| format!("{} {unit}", fine_micrometres(rms));
    match trace.verdict {
        Verdict::Adequate => {
            let what = match (&campaign.data, numbers::fitted_again(trace)) {
                (Data::Position(_), _) | (_, Some(_)) => "the description's numbers, fitted again, predict",
                _ => "identified joints predict",
            };
            format!("Nothing is missing: {what} unseen {unseen} to {}", remain(identified))
        }
        Verdict::Explained | Verdict::Partial => format!(
            "{}; with {} the error on unseen {unseen} {} {unit}{}",
            named(trace),
            match (trace.suspected.is_empty(), trace.effects.len()) {
                (false, _) => "what is suspected as well",
                (true, 1) => "it",
                (true, _) => "them",
            },
            change_of_error(before, after),
            if trace.verdict == Verdict::Partial { ", but something more may be missing" } else { "" }
        ),
        Verdict::Unexplained if trace.looks_like.is_empty() && !trace.suspected.is_empty() => format!(
            "Something is missing, and no effect is certain enough to be named: {} remain on unseen {unseen}",
            remain(after)
        ),
        Verdict::Unexplained => format!(
            "Something is missing that no effect in the catalogue accounts for: {} remain on unseen {unseen}",
            remain(after)
        ),
        Verdict::Insufficient => "These data cannot tell whether anything is missing".to_owned(),
    }
}

/// What was named, as a clause.
fn named(trace: &Trace) -> String {
    let words = |of_rig: bool| -> Vec<String> {
        let those = trace.effects.iter().filter(|named| named.effect.is_of_rig() == of_rig);
        those.map(|named| named.effect.words()).collect()
    };
    match [words(false), words(true)] {
        [robot, rig] if rig.is_empty() => format!("The description lacks {}", and(&robot)),
        [robot, rig] if robot.is_empty() => format!("The measurement has {}", and(&rig)),
        // Beside the robot's, single faults of the rig would bury the finding.
        [robot, rig] => {
            format!("The description lacks {}, and the measurement has {}", and(&robot), count(rig.len(), "fault"))
        }
    }
}

/// What follows the finding, a sentence each.
pub fn summary(trace: &Trace, campaign: &Campaign, warnings: &[String]) -> Vec<String> {
    let terms = Terms::of(campaign);
    let mut sentences = vec![sentence(&trace.why)];
    // What looks wrong with the files puts all that follows in doubt.
    sentences.extend(warnings.iter().cloned());
    sentences.extend(repeated(trace, terms));
    sentences.extend(encoders(trace));
    sentences.extend(without_outliers(trace, terms));
    sentences.extend(alone(trace, campaign));
    sentences.extend(numbers::sentences(trace, campaign));
    if !trace.depends_on.is_empty() && matches!(trace.verdict, Verdict::Partial | Verdict::Unexplained) {
        sentences.push(format!("The residual depends on {}.", and(&trace.depends_on)));
    }
    sentences
}

/// A name that fewer of the searches found is in the report only.
const OFTEN: f64 = 0.5;

/// What the repeated search says of poses that it was without, and what it found again.
fn repeated(trace: &Trace, Terms { unit, place: [_, places], .. }: Terms) -> Vec<String> {
    if !is_repeated(trace) {
        return Vec::new();
    }
    let nested = &trace.nested;
    let [before, after] = [nested.identified_rms, nested.rms].map(fine_micrometres);
    let mut sentences = vec![format!(
        "The whole search was repeated {} times, each time without some {places}: the error on these is {after} {unit}, \
         with the joints alone {before} {unit}.",
        nested.folds
    )];
    let often = nested.names.iter().filter(|(_, of)| *of >= OFTEN);
    let often: Vec<String> = often.map(|(name, of)| format!("{} ({})", spoken(name), share(*of))).collect();
    if !often.is_empty() {
        sentences.push(format!("Half of these searches or more found {}.", and(&often)));
    }
    sentences
}

/// How well the description predicts that is written, where the fit corrects for faults of the rig.
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
fn encoders(trace: &Trace) -> Vec<String> {
    let mut sentences = Vec::new();
    if let Some(most) = trace.encoders.iter().map(|(_, noise)| *noise).reduce(f64::max) {
        let turns = |joint: usize| trace.description.joints[joint - 1].kind == JointKind::Revolute;
        let unit = if trace.encoders.iter().all(|(joint, _)| turns(*joint)) { "urad" } else { "urad or um" };
        let joints: Vec<String> = trace.encoders.iter().map(|(joint, _)| joint.to_string()).collect();
        sentences.push(format!(
            "The fit has to agree with the encoders behind the gears (joint{} {}, {} {unit} a reading): what they \
             do not see is in no gear.",
            if joints.len() == 1 { "" } else { "s" },
            and(&joints),
            decimals(most * 1e6, 1)
        ));
    }
    if trace.motors {
        sentences.push("What the motors let through of the load is taken from the readings.".to_owned());
    }
    sentences
}

/// The errors without the readings that do not belong; all others are of all rows.
fn without_outliers(trace: &Trace, Terms { unit, .. }: Terms) -> Option<String> {
    let lines = outliers(trace);
    if lines.is_empty() {
        return None;
    }
    let rms = |of: fn(&RowResidual) -> [f64; 3]| {
        let rows = trace.residuals.iter().filter(|row| !lines.contains(&row.line));
        let components = rows.flat_map(|row| of(row).into_iter().take(trace.components));
        let squares: Vec<f64> = components.map(|component| component * component).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    };
    let without = change_of_error(rms(|row| row.before), rms(|row| row.after));
    let [is, it] = if lines.len() == 1 { ["does", "it"] } else { ["do", "them"] };
    Some(format!(
        "{} {is} not belong to the other readings. The fit gives {it} next to no weight, and every error above has {it} in. \
         Without {it} the error on fitted rows {without} {unit}.",
        crate::text::capital(&numbered(&lines))
    ))
}
