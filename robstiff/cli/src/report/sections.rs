//! The sections of a report below its heading, each empty where there is
//! nothing to say.

use super::content::{Effect, Number, Report};
use super::html::{Cell, Table, element, escape, number, text, words};
use super::terms::Terms;
use super::{arm, figure, micro, scatter};
use crate::text::{and, capital, change, count, decimals, is_compliance, plus_minus, quantity, significant};

/// The error of each model.
pub fn errors(report: &Report) -> String {
    let stages = report.stages.iter().flat_map(|stage| [stage.rms_um, stage.holdout_rms_um]);
    let largest = stages.chain(report.effects.iter().map(|effect| effect.holdout_rms_um)).fold(0.0, f64::max);
    let Terms { unseen: [_, unseen], reading, component, printed, .. } = report.terms;
    let mut table = Table::new([
        words("Model"),
        number(format!("fitted {unseen} [{printed}]")),
        number(format!("unseen {unseen} [{printed}]")),
        words("unseen, against the noise"),
    ]);
    let meter = |um: f64| Cell::Html(figure::meter(um, [report.reading_um, report.noise_um], largest));
    for (index, stage) in report.stages.iter().enumerate() {
        let is_last = index + 1 == report.stages.len();
        // What each effect does on the way from the joints alone to the last model.
        for effect in report.effects.iter().filter(|_| is_last && report.effects.len() > 1) {
            let name = format!("<span class=\"under step\">+ {}</span>", escape(&effect.words));
            table.row(
                false,
                [
                    Cell::Html(name),
                    number(""),
                    number(decimals(effect.holdout_rms_um, 1)),
                    meter(effect.holdout_rms_um),
                ],
            );
        }
        let name = format!("{} <small class=\"under\">{}</small>", escape(&stage.name), escape(&stage.remark));
        table.row(
            is_last,
            [
                Cell::Html(name),
                number(decimals(stage.rms_um, 1)),
                number(decimals(stage.holdout_rms_um, 1)),
                meter(stage.holdout_rms_um),
            ],
        );
    }
    let displaced = match report.noise_um > report.reading_um {
        true => format!(
            ", and up to {} {printed} a {reading}, which is the difference of two; the marks are these two",
            decimals(report.noise_um, 1)
        ),
        false => "; the mark is this".to_owned(),
    };
    let caption = format!(
        "Root mean square {component}, over {} at {}. Unseen: {}. Noise: {} {printed} a reading ({}){displaced}.",
        count(report.rows, "row"),
        report.terms.places(report.poses),
        report.unseen,
        decimals(report.reading_um, 1),
        report.noise_source,
    );
    element("h2", "Error before and after") + &table.html() + &text("p", &caption) + &by_pose(report)
}

/// The error of each pose.
fn by_pose(report: &Report) -> String {
    if report.errors.is_empty() {
        return String::new();
    }
    let Terms { place: [place, places], component, moves, .. } = report.terms;
    let mut caption = format!("Root mean square {component} in each {place}, in the order of the campaign.");
    if report.errors.iter().any(|pose| pose.held_out) {
        caption += &format!(" Shaded: {places} that were held out.");
    }
    if report.has_effects() {
        caption += &format!(
            " Below: how far the effects that the description now has {moves}; fitted together with them, the joints give part of it back."
        );
    }
    framed(&figure::errors(report), &caption)
}

fn framed(svg: &str, caption: &str) -> String {
    format!("<figure>\n{svg}{}</figure>\n", text("figcaption", caption))
}

/// The pictures of residuals.
pub fn residuals(report: &Report) -> String {
    if report.residuals.is_empty() {
        return String::new();
    }
    let mut figures = Vec::new();
    if !report.arms.is_empty() {
        figures.push(arm::figure(report));
    }
    if !report.dependences.is_empty() {
        figures.push(scatter::figure(report));
    }
    let cloud = "Residual vectors of single rows in the frame that they were read in. A model that lacks nothing leaves a round cloud the \
                 size of the noise.";
    figures.push((figure::residuals(report), cloud.to_owned()));
    let figures: String = figures.iter().map(|(svg, caption)| framed(svg, caption)).collect();
    element("h2", "Where the residuals are") + &figures
}

/// The effects named: those of the robot, and the faults of the measurement,
/// which are something else.
pub fn effects(report: &Report) -> String {
    let (rig, robot): (Vec<&Effect>, Vec<&Effect>) = report.effects.iter().partition(|effect| effect.of_rig);
    let mut html = String::new();
    if !robot.is_empty() {
        let note = if robot.iter().all(|effect| effect.written) {
            "Written into the robot's description."
        } else {
            "Written into the robot's description, but for what is marked: descriptions have no word for it, or not for \
             so much of it."
        };
        html += &(element("h2", "What the model of the robot lacks") + &text("p", note));
        html += &robot.into_iter().map(effect).collect::<String>();
    }
    if !rig.is_empty() {
        let note = "Corrected for, not written into the robot: the next measurement does better without them.";
        html += &(element("h2", "What is wrong with the measurement") + &text("p", note));
        html += &rig.into_iter().map(effect).collect::<String>();
    }
    if !html.is_empty() {
        let note = "Probability: that the effect is there, or one that these data cannot tell from it. Numbers with one \
                    standard deviation.";
        html += &format!("<p class=\"note\">{}</p>\n", escape(note));
    }
    html
}

/// What is likely, but not certain enough to be named.
pub fn suspected(report: &Report) -> String {
    if report.suspected.is_empty() {
        return String::new();
    }
    let note = "These would account for some of the residual. Each misses a condition for a name.";
    let effects: String = report.suspected.iter().map(effect).collect();
    element("h2", "What is suspected") + &text("p", note) + &effects
}

fn effect(effect: &Effect) -> String {
    let mark = if effect.of_rig { "measurement" } else { "robot" };
    let mut html = format!(
        "<article class=\"effect {mark}\">\n<h3>{} <code>{}</code></h3>\n{}",
        escape(&capital(&effect.words)),
        escape(&effect.name),
        text("p", &effect.explanation)
    );
    let mut facts: Vec<(&str, String)> = Vec::new();
    if !effect.numbers.is_empty() {
        let mut numbers: Vec<String> = effect.numbers.iter().take(MOST_NUMBERS).map(number_line).collect();
        if effect.numbers.len() > MOST_NUMBERS {
            numbers.push(format!("and {} more", effect.numbers.len() - MOST_NUMBERS));
        }
        facts.push(("Found", numbers.join(", ")));
    }
    let mut certain = effect.probability.clone();
    if !effect.recurs.is_empty() {
        certain += &format!(", back in {} of the searches without some poses", effect.recurs);
    }
    facts.push(("Probability", certain));
    if !effect.same_as.is_empty() {
        facts.push(("Or else", format!("{}: these data cannot tell", effect.same_as)));
    }
    if !effect.why_not.is_empty() {
        facts.push(("Not named", effect.why_not.clone()));
        if effect.written {
            facts.push(("Written", "the description has it: it predicts best with it".to_owned()));
        }
    } else if !effect.of_rig && !effect.written {
        facts.push(("Not written", "the description does not take it".to_owned()));
    }
    let list: String = facts.iter().map(|(name, said)| text("dt", name) + &text("dd", &micro(said))).collect();
    html += &element("dl", list);
    html + "</article>\n"
}

/// So many numbers of an effect are shown.
const MOST_NUMBERS: usize = 6;

fn number_line(number: &Number) -> String {
    format!("{} = {}", number.name, quantity(number.value, number.std, &number.unit))
}

/// What else there could be.
pub fn doubts(report: &Report) -> String {
    if report.doubts.is_empty() {
        return String::new();
    }
    let items: String = report.doubts.iter().map(|doubt| text("li", &micro(doubt))).collect();
    element("h2", "What the data leave open") + &element("ul", items)
}

/// The description's own numbers in the three models.
pub fn compliances(report: &Report) -> String {
    let with_effects = !report.effects.is_empty();
    let only_compliances = report.compliances.iter().all(|one| is_compliance(&one.unit));
    let (heading, first) = match only_compliances {
        true => ("Compliances", "Compliance"),
        false => ("The description's own numbers", "Number"),
    };
    let mut head = vec![words(first), number("declared"), number("identified")];
    if with_effects {
        head.push(number("with effects"));
    }
    head.extend([number("change"), words("")]);
    let mut table = Table::new(head);
    for one in &report.compliances {
        let (factor, unit) = if one.unit == "1" { (1.0, String::new()) } else { (1e6, format!("µ{}", one.unit)) };
        let fitted = |found: Option<(f64, f64)>| {
            let shown = |(value, std)| plus_minus(value * factor, std * factor);
            number(found.map_or_else(|| "not seen".to_owned(), shown))
        };
        let last = if with_effects { one.after } else { one.identified };
        let changed = last.filter(|_| one.declared != 0.0).map(|(value, _)| value / one.declared - 1.0);
        let mut cells = vec![words(&one.name), number(significant(one.declared * factor, 4)), fitted(one.identified)];
        if with_effects {
            cells.push(fitted(one.after));
        }
        let changed = changed.map(change).unwrap_or_default();
        cells.extend([number(changed), words(unit)]);
        table.row(false, cells);
    }
    let note = "With one standard deviation. Change: of the last model against the declared value. \
                Joints fitted without a missing effect take part of it on themselves.";
    element("h2", heading) + &table.html() + &text("p", note)
}

/// What stays unexplained.
pub fn unexplained(report: &Report) -> String {
    let of = &report.unexplained;
    if of.fraction <= 0.0 && of.depends_on.is_empty() {
        return String::new();
    }
    let mut sentence =
        format!("{} % of the variance of the residual is beyond the noise.", decimals(of.fraction * 100.0, 0));
    if !of.depends_on.is_empty() {
        sentence += &format!(" The residual depends on {}.", and(&of.depends_on));
    }
    element("h2", "What stays unexplained") + &text("p", &sentence)
}

/// What to measure next.
pub fn next(report: &Report) -> String {
    if report.next.is_empty() {
        return String::new();
    }
    let mut table = Table::new([words("To tell"), words("from"), words("pose"), words("load")]);
    for next in &report.next {
        let [one, other] = &next.separates;
        table.row(false, [words(one), words(other), words(&next.pose), words(&next.load)]);
    }
    element("h2", "What to measure next") + &table.html()
}

/// The most probable sets of effects, and what the repeated search found.
pub fn search(report: &Report) -> String {
    if report.sets.is_empty() {
        return String::new();
    }
    let note = "Each set of effects is weighed by its evidence: how probable the readings are with it, whatever its \
                numbers, times a prior that makes large sets less probable.";
    let mut sets = Table::new([words("Effects"), number("probability")]);
    for (index, set) in report.sets.iter().enumerate() {
        sets.row(index == 0, [codes(&set.names), number(&set.probability)]);
    }
    element("h2", "How it was found") + &text("p", note) + &sets.html() + &repeated(report)
}

fn repeated(report: &Report) -> String {
    let repeated = &report.repeated;
    if repeated.folds == 0 || repeated.names.is_empty() {
        return String::new();
    }
    let note = format!(
        "The whole search was repeated {} times, each time without some {}. The best set of so many of these searches has \
         each effect:",
        repeated.folds, report.terms.place[1]
    );
    let mut table = Table::new([words("Effect"), number("share of the searches")]);
    for (name, share) in &repeated.names {
        table.row(false, [codes(std::slice::from_ref(name)), number(share)]);
    }
    text("p", &note) + &table.html()
}

/// Full names of effects for a cell.
fn codes(names: &[String]) -> Cell {
    if names.is_empty() {
        return words("the joints alone");
    }
    let names: Vec<String> = names.iter().map(|name| format!("<code>{}</code>", escape(name))).collect();
    Cell::Html(names.join(", "))
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
