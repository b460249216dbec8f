//! The section on what the readings say before any model. A disc is a check that
//! fails, a ring one that holds or that what was named accounts for; the words say the same.

use super::content::{Check, Report, State};
use super::html::{Cell, Table, element, escape, number, text, words};
use super::micro;
use super::svg::Svg;
use crate::text::{and, count, p_value, probability};

const WIDTH: f64 = 860.0;
const LEFT: f64 = 150.0;
const RIGHT: f64 = 60.0;
const STEP: f64 = 22.0;
const TOP: f64 = 34.0;

/// Probabilities are shown down to this power of ten.
const POWERS: f64 = 4.0;

/// The level of all checks together.
const LEVEL: f64 = robstiff_identify::triage::LEVEL;

/// The section; empty where nothing was asked.
pub fn section(report: &Report) -> String {
    if report.checks.is_empty() {
        return String::new();
    }
    let note = format!(
        "What the readings say by themselves, before any compliance is fitted. p: the probability of as much under \
         noise alone, all checks counted (Holm); a check fails at {LEVEL}, where what it found is also large enough to \
         matter."
    );
    let of = |state: State| report.checks.iter().filter(move |check| check.state == state).collect::<Vec<&Check>>();
    let (fails, holds, not_asked) = (of(State::Violated), of(State::Holds), of(State::NotAsked));
    let accounted = of(State::AccountedFor);
    let mut html = element("h2", "Before any model");
    if fails.is_empty() && holds.is_empty() && accounted.is_empty() {
        html += &text("p", "No check of the readings by themselves could be made.");
    } else if fails.is_empty() && !accounted.is_empty() {
        html += &text("p", "The readings by themselves show nothing that the named effects do not account for.");
    } else if fails.is_empty() {
        // One check of many says little.
        let made = match not_asked.len() {
            0 => String::new(),
            _ => {
                format!(", as far as {} of {} could be made on them", holds.len(), count(report.checks.len(), "check"))
            }
        };
        html += &text("p", &format!("The readings by themselves show nothing wrong{made}."));
    } else {
        html += &text("p", &note);
        html += &fails.iter().map(|check| failing(check)).collect::<String>();
    }
    if !accounted.is_empty() {
        html += &table(&accounted);
    }
    if !holds.is_empty() {
        let judged = report.checks.iter().filter(|check| check.p_value.is_some()).count();
        let figure = if judged > 1 { format!("<figure>\n{}</figure>\n", figure(report)) } else { String::new() };
        let verb = if holds.len() == 1 { "holds" } else { "hold" };
        let names: Vec<String> = holds.iter().map(|check| check.name.clone()).collect();
        let summary = text("summary", &format!("{} that {verb}: {}", count(holds.len(), "check"), and(&names)));
        html += &element("details", summary + &figure + &table(&holds));
    }
    if !not_asked.is_empty() {
        let mut table = Table::new([words("Check"), words("what would let these data be asked")]);
        not_asked.iter().for_each(|check| table.row(false, [name(check), words(micro(&check.said))]));
        let summary = text("summary", &format!("{} that these data cannot be asked", count(not_asked.len(), "check")));
        html += &element("details", summary + &table.html());
    }
    if !report.outliers.is_empty() {
        let items: String = report.outliers.iter().map(|outlier| text("li", &micro(outlier))).collect();
        html += &format!("<h3>Readings that do not belong</h3>\n<ul class=\"warnings\">\n{items}</ul>\n");
    }
    html
}

/// A check that fails, with room for what it points to.
fn failing(check: &Check) -> String {
    let p = check.p_value.map_or_else(String::new, |p| format!(", {}", p_value(p)));
    let heading = format!("{} fails: {}{p}", check.name, check.found);
    let said = text("h3", &micro(&heading)) + &text("p", &micro(&check.said));
    format!("<article class=\"effect check\">\n{said}</article>\n")
}

fn table(checks: &[&Check]) -> String {
    let mut table = Table::new([words("Check"), words("found"), number("p"), words("what it means")]);
    for check in checks {
        table.row(
            false,
            [
                name(check),
                words(micro(&check.found)),
                number(check.p_value.map_or_else(|| "-".to_owned(), probability)),
                words(micro(&check.said)),
            ],
        );
    }
    table.html()
}

fn name(check: &Check) -> Cell {
    let question = escape(&micro(&check.question));
    Cell::Html(format!("{} <small class=\"under question\">{question}</small>", escape(&check.name)))
}

/// Each check that was asked, by its probability.
fn figure(report: &Report) -> String {
    let asked: Vec<(&Check, f64)> = report.checks.iter().filter_map(|check| Some((check, check.p_value?))).collect();
    let (width, height) = (WIDTH - LEFT - RIGHT, STEP * asked.len() as f64);
    let mut svg = Svg::new(WIDTH, TOP + height + 34.0, "Probability of what each check found under noise alone");
    let right = |p: f64| {
        let power = if p > 0.0 { -p.log10() } else { POWERS };
        LEFT + width * if power.is_finite() { (power / POWERS).clamp(0.0, 1.0) } else { 0.0 }
    };
    for power in 0..=POWERS as i32 {
        let x = right(10_f64.powi(-power));
        svg.line("grid", [x, TOP], [x, TOP + height]);
        let name = if power == 0 { "1".to_owned() } else { crate::text::decimals(10_f64.powi(-power), power as usize) };
        svg.text("small", [x, TOP + height + 16.0], "middle", &name);
    }
    let level = right(LEVEL);
    svg.line("noise", [level, TOP - 6.0], [level, TOP + height]);
    svg.text("small", [level + 6.0, TOP - 8.0], "start", "fails beyond");
    svg.text("axis", [LEFT + width / 2.0, TOP + height + 32.0], "middle", "p, all checks counted");
    for (k, (check, p)) in asked.iter().enumerate() {
        let y = TOP + STEP * (k as f64 + 0.5);
        let class = if check.state == State::Violated { "after" } else { "before" };
        svg.line("stem", [LEFT, y], [right(*p), y]);
        svg.circle(class, [right(*p), y], 5.0, &format!("{}: p {}", check.name, probability(*p)));
        svg.text("legend", [LEFT - 12.0, y + 4.0], "end", &check.name);
    }
    svg.html()
}
