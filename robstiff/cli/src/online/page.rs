//! What is left, as text, as a table and as JSON.

use robstiff_machining::online::{HeldBack, LeftOfSine};
use robstiff_robots::{Description, Joint};
use serde_json::{Value, json};

use super::loads::{Course, Outcome, Simulated, Stop};
use super::reach::Reach;
use super::{ControlArguments, Loss, Variant};
use crate::json::{number, numbers};
use crate::text::{Table, cell, decimals, field, micrometres, significant};

/// How many rows of places a person reads.
const ROWS: usize = 12;

pub fn page(robot: &Description, simulated: &Simulated, variants: &[Variant], control: &ControlArguments) -> String {
    let mut page = match &simulated.outcome {
        Outcome::Sine { q, wrench, deviation, .. } => {
            let coordinate = |(joint, &q): (&Joint, &f64)| {
                format!("{} {}", significant(joint.for_people(q), 4), joint.people_unit())
            };
            let q: Vec<String> = robot.joints.iter().zip(q).map(coordinate).collect();
            let force: Vec<String> = wrench.iter().take(3).map(|&part| significant(part, 4)).collect();
            format!(
                "{} at q = ({}) under {}, ({}) N, that comes and goes: {} um without correction\n",
                robot.name,
                q.join(", "),
                simulated.name,
                force.join(", "),
                micrometres(*deviation)
            )
        }
        Outcome::Along { stops, .. } => {
            let duration = stops.last().map_or(0.0, |stop| stop.time);
            format!("{} on {}: {} s\n", robot.name, simulated.name, significant(duration, 4))
        }
    };
    let delay =
        control.delay.map_or("one control step".to_owned(), |delay| format!("{} ms", significant(delay * 1e3, 4)));
    page += &format!(
        "position loops of {} Hz (damping ratio {}), a delay of {delay}; corrections to {} mrad, by {} rad/s\n",
        significant(control.bandwidth, 4),
        significant(control.loop_damping, 3),
        significant(control.most * 1e3, 4),
        significant(control.fastest, 4),
    );
    if let Some(Loss([from, length])) = control.lost {
        page += &format!(
            "the sensor falls silent after {} s for {} s; a correction is held {} ms\n",
            significant(from, 4),
            significant(length, 4),
            significant(control.hold * 1e3, 4)
        );
    }
    page + &match &simulated.outcome {
        Outcome::Sine { frequencies, left, useful, .. } => {
            let mut table = Table::new(
                1,
                std::iter::once(String::new()).chain(frequencies.iter().map(|f| format!("{} Hz", significant(*f, 4)))),
            );
            for (variant, left) in variants.iter().zip(left) {
                let cells = left.iter().map(|left| decimals(100.0 * left.rms, 1));
                table.row(std::iter::once(variant.name.clone()).chain(cells));
            }
            let mut page = format!("\nLeft of the deviation [%] (rms), by the frequency of the force\n{table}\n");
            let mut table = Table::new(1, ["", "half is gone to", "less is left to"]);
            for (variant, useful) in variants.iter().zip(useful) {
                let cells = useful.map(|reach| reach.to_string());
                table.row(std::iter::once(variant.name.clone()).chain(cells));
            }
            page += &format!("How fast a force it keeps up with\n{table}");
            page
        }
        Outcome::Along { stops, in_cut, without, with, .. } => along(variants, (stops, *in_cut), without, with),
    } + &limits(&simulated.outcome, variants)
}

/// A part of the time out of those of both limits.
type Share = fn(&HeldBack<f64>) -> f64;

/// Which limits hold a correction back, and when; nothing where none does.
fn limits(outcome: &Outcome, variants: &[Variant]) -> String {
    let options: [(&str, Share); 2] = [("--most", |held| held.by_size), ("--fastest", |held| held.by_rate)];
    let mut lines = String::new();
    for (k, variant) in variants.iter().enumerate() {
        for (option, share) in options {
            let when = match outcome {
                Outcome::Sine { frequencies, left, .. } => {
                    let each = frequencies.iter().zip(&left[k]).filter(|(_, left)| share(&left.held_back) > 0.0);
                    let at: Vec<String> = each.map(|(frequency, _)| significant(*frequency, 4)).collect();
                    (!at.is_empty()).then(|| format!("at {} Hz", at.join(", ")))
                }
                Outcome::Along { held_back, .. } => {
                    let share = share(&held_back[k]);
                    (share > 0.0).then(|| format!("{} % of the time", significant(100.0 * share, 2)))
                }
            };
            lines += &when.map_or_else(String::new, |when| format!("  {}: {option}, {when}\n", variant.name));
        }
    }
    if lines.is_empty() { lines } else { format!("\nA limit holds the correction back\n{lines}") }
}

fn along(variants: &[Variant], (stops, in_cut): (&[Stop], f64), without: &Course, with: &[Course]) -> String {
    let place = |at: usize| match stops[at].place {
        Some((line, _)) => format!("line {line}"),
        None => format!("{} s", significant(stops[at].time, 4)),
    };
    // Moves outside of the cut would make the figures as small as they are long.
    let part = in_cut < 1.0;
    let header = ["", "rms", "left [%]", "worst", "left [%]", "worst before"];
    let mut table = Table::new(1, header.into_iter().chain(part.then_some("worst outside")));
    let mut row = |name: &str, course: &Course| {
        let share = |part: f64, whole: f64| decimals(100.0 * part / whole, 1);
        let cells = [
            name.to_owned(),
            micrometres(course.rms),
            share(course.rms, without.rms),
            micrometres(course.worst),
            share(course.worst, without.worst),
            place(course.at),
        ];
        table.row(
            cells
                .into_iter()
                .chain(part.then(|| if course.aside.is_nan() { "-".to_owned() } else { micrometres(course.aside) })),
        );
    };
    row("without correction", without);
    variants.iter().zip(with).for_each(|(variant, course)| row(&variant.name, course));
    let duration = stops.last().map_or(0.0, |stop| stop.time);
    let over = match part {
        true => format!(", while there is a force: {} s of it", significant(in_cut * duration, 3)),
        false => String::new(),
    };
    let mut page = format!("\nDistance from where the tool should be [um]{over}\n{table}");
    let first = variants.len().min(3);
    let mut header = vec![if stops[0].place.is_some() { "line".to_owned() } else { "time [s]".to_owned() }];
    if stops[0].place.is_some() {
        header.push("s [mm]".to_owned());
    }
    header.push("without".to_owned());
    header.extend((1..=first).map(|k| format!("({k})")));
    let mut table = Table::new(0, header);
    let places: Vec<usize> = (0..stops.len()).filter(|&at| !without.since[at].is_nan()).collect();
    let stride = places.len().div_ceil(ROWS).max(1);
    for &at in places.iter().step_by(stride) {
        let mut row = match stops[at].place {
            Some((line, s)) => vec![line.to_string(), decimals(s * 1e3, 1)],
            None => vec![significant(stops[at].time, 4)],
        };
        row.push(micrometres(without.since[at]));
        row.extend(with[..first].iter().map(|course| micrometres(course.since[at])));
        table.row(row);
    }
    let what = if stops[0].place.is_some() { "point" } else { "time" };
    page += &format!("\nThe worst of it [um] from the {what} before on");
    let names: Vec<String> =
        (1..).zip(&variants[..first]).map(|(k, variant)| format!("({k}) {}", variant.name)).collect();
    page += &format!("; {}\n{table}", names.join("; "));
    page
}

/// The same as a table: a row for each frequency, or each point of the path.
pub fn table(simulated: &Simulated, variants: &[Variant]) -> String {
    let names = |unit: &str| -> String {
        // A semicolon needs no quotes; a file's name may still need them.
        let column = |variant: &Variant| field(&format!("{} [{unit}]", variant.name.replace(", ", "; ")));
        variants.iter().map(|variant| format!(",{}", column(variant))).collect()
    };
    match &simulated.outcome {
        Outcome::Sine { frequencies, left, .. } => {
            let mut csv = format!("frequency [Hz]{}\n", names("%"));
            for (k, frequency) in frequencies.iter().enumerate() {
                csv += &frequency.to_string();
                left.iter().for_each(|left| csv += &format!(",{}", cell(100.0 * left[k].rms, 4)));
                csv.push('\n');
            }
            csv
        }
        Outcome::Along { stops, without, with, .. } => {
            let mut csv = format!("t [s],line,s [mm],without [um]{}\n", names("um"));
            for (at, stop) in stops.iter().enumerate() {
                let (line, s) =
                    stop.place.map_or_else(Default::default, |(line, s)| (line.to_string(), cell(s * 1e3, 6)));
                csv += &format!("{},{line},{s}", cell(stop.time, 6));
                for course in std::iter::once(without).chain(with) {
                    let since = course.since[at];
                    csv += &format!(",{}", cell(since * 1e6, 4));
                }
                csv.push('\n');
            }
            csv
        }
    }
}

/// Everything in SI units; what does not exist is null.
pub fn document(robot: &Description, simulated: &Simulated, variants: &[Variant]) -> Value {
    let mut document = json!({ "robot": robot.name, "load": simulated.name });
    let entries = document.as_object_mut().expect("it is an object");
    let named = |variant: &Variant, what: Value| {
        let mut entry = json!({
            "name": variant.name,
            "step_s": number(variant.controller.step),
            "delay_s": number(variant.controller.delay),
        });
        entry.as_object_mut().expect("it is an object").append(&mut what.as_object().expect("so is this").clone());
        entry
    };
    match &simulated.outcome {
        Outcome::Sine { q, wrench, deviation, frequencies, left, useful } => {
            entries.insert("q".to_owned(), numbers(q.iter().copied()));
            entries.insert("wrench".to_owned(), numbers(wrench.iter().copied()));
            entries.insert("deviation_m".to_owned(), number(*deviation));
            entries.insert("frequencies_Hz".to_owned(), numbers(frequencies.iter().copied()));
            let of = |((variant, left), useful): ((&Variant, &Vec<LeftOfSine>), &[Reach; 2])| {
                let what = json!({
                    "left_rms": numbers(left.iter().map(|left| left.rms)),
                    "left_amplitude": numbers(left.iter().map(|left| left.amplitude)),
                    "half_gone_to": useful[0].to_string(),
                    "half_gone_to_Hz": useful[0].found(),
                    "less_left_to": useful[1].to_string(),
                    "less_left_to_Hz": useful[1].found(),
                    "held_back_by_most": numbers(left.iter().map(|left| left.held_back.by_size)),
                    "held_back_by_fastest": numbers(left.iter().map(|left| left.held_back.by_rate)),
                });
                named(variant, what)
            };
            entries.insert("control".to_owned(), variants.iter().zip(left).zip(useful).map(of).collect());
        }
        Outcome::Along { stops, in_cut, without, with, held_back } => {
            let course = |course: &Course| {
                json!({
                    "rms_m": number(course.rms),
                    "worst_m": number(course.worst),
                    "worst_before_line": stops[course.at].place.map(|(line, _)| line),
                    "worst_before_t_s": number(stops[course.at].time),
                    "worst_without_force_m": number(course.aside),
                    "since_m": numbers(course.since.iter().copied()),
                })
            };
            let stop = |stop: &Stop| {
                json!({
                    "t_s": number(stop.time),
                    "line": stop.place.map(|(line, _)| line),
                    "s_m": stop.place.map(|(_, s)| number(s)),
                })
            };
            entries.insert("with_force".to_owned(), number(*in_cut));
            entries.insert("points".to_owned(), stops.iter().map(stop).collect());
            entries.insert("without".to_owned(), course(without));
            let of = |((variant, of), held_back): ((&Variant, &Course), &HeldBack<f64>)| {
                let mut what = course(of);
                what["held_back_by_most"] = number(held_back.by_size);
                what["held_back_by_fastest"] = number(held_back.by_rate);
                named(variant, what)
            };
            entries.insert("control".to_owned(), variants.iter().zip(with).zip(held_back).map(of).collect());
        }
    }
    document
}
