//! The sections of a report below its heading, each empty where there is
//! nothing to say.

use super::content::{Candidate, Number, Report, SearchStep};
use super::figure;
use super::html::{Cell, Table, element, escape, number, text, words};
use crate::text::{and, count, decimals, millionths, probability, significant};

/// The error of each model.
pub fn errors(report: &Report) -> String {
    let largest = report.stages.iter().flat_map(|stage| [stage.rms_um, stage.holdout_rms_um]).fold(0.0, f64::max);
    let mut table = Table::new([
        words("Model"),
        number("fitted poses [µm]"),
        number("unseen poses [µm]"),
        words("unseen, against the noise"),
    ]);
    for (index, stage) in report.stages.iter().enumerate() {
        let name = format!("{} <small class=\"under\">{}</small>", escape(&stage.name), escape(&stage.remark));
        table.row(
            index + 1 == report.stages.len(),
            [
                Cell::Html(name),
                number(decimals(stage.rms_um, 1)),
                number(decimals(stage.holdout_rms_um, 1)),
                Cell::Html(figure::meter(stage.holdout_rms_um, [report.reading_um, report.noise_um], largest)),
            ],
        );
    }
    let caption = format!(
        "Root mean square error of one axis, over {} at {}. Unseen: {}. Noise: {} µm a reading ({}), and up to {} µm a \
         displacement, which is the difference of two; the marks are these two.",
        count(report.rows, "row"),
        count(report.poses, "pose"),
        report.unseen,
        decimals(report.reading_um, 1),
        report.noise_source,
        decimals(report.noise_um, 1)
    );
    element("h2", "Error before and after") + &table.html() + &text("p", &caption)
}

/// The figures.
pub fn poses(report: &Report) -> String {
    if report.errors.is_empty() {
        return String::new();
    }
    let mut first = "Root mean square error of one axis in each pose, in the order of the campaign.".to_owned();
    if report.errors.iter().any(|pose| pose.held_out) {
        first += " Shaded: poses that were held out.";
    }
    if !report.effects.is_empty() {
        first += " Below: how far the named effects move the tool; fitted together with them, the joints give part of it back.";
    }
    let captions = [
        first.as_str(),
        "Residual vectors of single rows in the base frame. A model that lacks nothing leaves a round cloud the size of the noise.",
    ];
    let figures = [figure::errors(report), figure::residuals(report)];
    let figures: String = figures
        .iter()
        .zip(captions)
        .map(|(svg, caption)| format!("<figure>\n{svg}{}</figure>\n", text("figcaption", caption)))
        .collect();
    element("h2", "Pose by pose") + &figures
}

/// The effects named.
pub fn effects(report: &Report) -> String {
    if report.effects.is_empty() {
        return String::new();
    }
    let mut table = Table::new([
        words("Effect"),
        words("Numbers"),
        number("p"),
        number("unseen poses [µm]"),
        words("not told from"),
    ]);
    for effect in &report.effects {
        let name = format!("<code>{}</code><br>{}", escape(&effect.name), escape(&effect.words));
        let lines: Vec<String> = effect.numbers.iter().map(|number| escape(&number_line(number))).collect();
        table.row(
            false,
            [
                Cell::Html(name),
                Cell::Html(format!("<span class=\"whole\">{}</span>", lines.join("<br>"))),
                number(probability(effect.p_value)),
                number(decimals(effect.holdout_rms_um, 1)),
                codes(&effect.same_as),
            ],
        );
    }
    let note = "p: the probability that the model without this effect would show as much by chance, all candidates together. \
                Unseen poses: the error with this effect and those above it.";
    element("h2", "What was missing") + &table.html() + &text("p", note)
}

/// Compliances in millionths; a knee, in Nm, as it is.
fn number_line(number: &Number) -> String {
    let Number { name, value, std, unit } = number;
    match unit.as_str() {
        "rad/Nm" | "m/N" => format!("{name} = {} µ{unit}", millionths(*value, std.unwrap_or(f64::NAN))),
        _ => format!("{name} = {} {unit}", significant(*value, 3)),
    }
}

fn codes(names: &[String]) -> Cell {
    let codes: Vec<String> = names.iter().map(|name| format!("<code>{}</code>", escape(name))).collect();
    Cell::Html(if codes.is_empty() { "nothing".to_owned() } else { codes.join("<br>") })
}

/// The description's own numbers in the three models.
pub fn compliances(report: &Report) -> String {
    let with_effects = !report.effects.is_empty();
    let mut head = vec![words("Compliance"), number("declared"), number("identified")];
    if with_effects {
        head.push(number("with effects"));
    }
    head.extend([number("change"), words("")]);
    let mut table = Table::new(head);
    for one in &report.compliances {
        let fitted = |found: Option<(f64, f64)>| {
            number(found.map_or_else(|| "not seen".to_owned(), |(value, std)| millionths(value, std)))
        };
        let last = if with_effects { one.after } else { one.identified };
        let change = last.filter(|_| one.declared != 0.0).map(|(value, _)| value / one.declared - 1.0);
        let mut cells = vec![words(&one.name), number(significant(one.declared * 1e6, 4)), fitted(one.identified)];
        if with_effects {
            cells.push(fitted(one.after));
        }
        let change = change.map(|change| format!("{:+.0} %", change * 100.0)).unwrap_or_default();
        cells.extend([number(change), words(format!("µ{}", one.unit))]);
        table.row(false, cells);
    }
    let note = "With one standard deviation. Change: of the last model against the declared value. \
                Joints fitted without a missing effect take part of it on themselves.";
    element("h2", "Compliances") + &table.html() + &text("p", note)
}

/// What is left.
pub fn left(report: &Report) -> String {
    if report.left.tests.is_empty() {
        return String::new();
    }
    let mut said =
        format!("{} % of the variance of what is left is beyond the noise.", decimals(report.left.fraction * 100.0, 0));
    if !report.left.depends_on.is_empty() {
        said += &format!(" What is left depends on {}.", and(&report.left.depends_on));
    }
    let mut table = Table::new([words("Test for structure"), number("statistic"), number("p")]);
    for test in &report.left.tests {
        table
            .row(false, [words(&test.name), number(significant(test.statistic, 3)), number(probability(test.p_value))]);
    }
    element("h2", "What is left") + &text("p", &said) + &table.html()
}

/// What to measure next.
pub fn next(report: &Report) -> String {
    if report.next.is_empty() {
        return String::new();
    }
    let mut table = Table::new([words("To tell"), words("from"), words("pose"), words("force [N]")]);
    for next in &report.next {
        let [one, other] = &next.separates;
        let code = |name: &str| Cell::Html(format!("<code>{}</code>", escape(name)));
        table.row(false, [code(one), code(other), words(&next.pose), words(&next.force)]);
    }
    element("h2", "What to measure next") + &table.html()
}

/// The search, step by step; long tables are folded.
pub fn search(report: &Report) -> String {
    if report.steps.is_empty() {
        return String::new();
    }
    let note =
        "Every effect of the catalogue at every place, against the model so far. p: family-wise, over all of them.";
    let steps: String = report.steps.iter().enumerate().map(|(index, step)| search_step(index + 1, step)).collect();
    element("h2", "How it was found") + &text("p", note) + &steps
}

/// How many candidates of a step show without unfolding.
const SHOWN: usize = 8;

fn search_step(index: usize, step: &SearchStep) -> String {
    let before =
        if step.named.is_empty() { "the joints alone".to_owned() } else { format!("with {}", and(&step.named)) };
    let heading = text("h3", &format!("Step {index}, {before}: {}", step.outcome));
    let (first, rest) = step.candidates.split_at(step.candidates.len().min(SHOWN));
    let mut html = heading + &candidates(first);
    if !rest.is_empty() {
        let summary = text("summary", &count(rest.len(), "weaker candidate"));
        html += &element("details", summary + &candidates(rest));
    }
    html
}

fn candidates(candidates: &[Candidate]) -> String {
    let mut table = Table::new([
        words("Candidate"),
        number("statistic"),
        number("p"),
        number("poses left out [µm]"),
        words("why not"),
    ]);
    for candidate in candidates {
        let named = candidate.reason.is_empty();
        table.row(
            named,
            [
                Cell::Html(format!("<code>{}</code>", escape(&candidate.name))),
                number(candidate.statistic.map_or_else(|| "-".to_owned(), |statistic| significant(statistic, 3))),
                number(probability(candidate.p_value)),
                number(candidate.left_out_rms_um.map_or_else(|| "-".to_owned(), |um| decimals(um, 1))),
                words(if named { "named" } else { &candidate.reason }),
            ],
        );
    }
    table.html()
}

/// Where everything came from, and what the readers noticed.
pub fn origins(report: &Report) -> String {
    let mut html = element("h2", "Where this comes from");
    let entries: String = report.origins.iter().map(|(name, said)| text("dt", name) + &text("dd", said)).collect();
    html += &element("dl", entries);
    if !report.warnings.is_empty() {
        let items: String = report.warnings.iter().map(|warning| text("li", warning)).collect();
        html += &format!("<h3>Warnings</h3>\n<ul class=\"warnings\">\n{items}</ul>\n");
    }
    html
}
