//! `job.html`: what to expect of a job, on a page that needs nothing beside it.

mod advice;
mod chart;
pub mod content;
#[cfg(test)]
mod tests;
mod thin;
mod track;

use robstiff_machining::cell::is_too_fast;

use crate::report::html::{self, Cell, Table, element, escape, number, text, words};
use crate::report::{SHADES, STYLE};
use crate::text::{decimals, fine_micrometres, micrometres, significant};
use content::{Job, Travel};

const OF_JOB: &str = include_str!("job.css");

/// Characters of a line of the path's file that are shown.
const MOST_CHARACTERS: usize = 32;

/// The page.
pub fn html(job: &Job<'_>) -> String {
    let travels: Vec<Travel> = (0..job.joints.len()).map(|joint| job.travel(joint)).collect();
    let worst = job.worst();
    let body = [
        heading(job),
        finding(job, &travels, &worst),
        path(job, worst.first().map(|(i, _)| *i)),
        along(job),
        places(job, &worst),
        before_and_after(job),
        chatter(job),
        joints(job, &travels),
        help(job, &travels),
        footer(job),
    ]
    .concat();
    let title = format!("{} on {}", job.file, job.robot);
    html::page(&title, &[STYLE, SHADES, OF_JOB].concat(), &body, "")
}

fn heading(job: &Job<'_>) -> String {
    let mut under = format!("{} points, {} mm", job.points.len(), decimals(job.length() * 1e3, 0));
    if let Some((forces, _)) = &job.forces {
        under += &format!("; forces of {forces}");
    }
    format!(
        "<header>\n{}{}{}</header>\n",
        text("p", &format!("A job on {}", job.robot)),
        text("h1", &job.file),
        text("p", &under)
    )
}

/// Pass or fail at the top.
fn finding(job: &Job<'_>, travels: &[Travel], worst: &[(usize, f64)]) -> String {
    let commanded = job.commanded();
    let judged = commanded.iter().flatten().count();
    let largest = commanded.iter().flatten().copied().fold(0.0, f64::max);
    let broken = |limit: f64| commanded.iter().flatten().filter(|size| **size > limit).count();
    let what = error(job);
    let if_true = if job.corrected.is_some() { ", if the model is true" } else { "" };
    let (passes, headline) = match job.tolerance {
        _ if job.forces.is_none() => (None, "No force is given: the page shows the motion alone".to_owned()),
        _ if judged == 0 => (None, "Nothing pushes the tool where a surface is made".to_owned()),
        None => (None, format!("The {what} is at most {} µm{if_true}", fine_micrometres(largest))),
        Some(limit) if broken(limit) == 0 => (
            Some(true),
            format!(
                "Within the tolerance of ±{} µm{if_true}: the {what} is at most {} µm",
                micrometres(limit),
                fine_micrometres(largest)
            ),
        ),
        Some(limit) => (
            Some(false),
            format!(
                "Out of the tolerance of ±{} µm at {} of {judged} points{if_true}: the {what} is up to {} µm",
                micrometres(limit),
                broken(limit),
                fine_micrometres(largest)
            ),
        ),
    };
    let mut said = Vec::new();
    if let Some((i, size)) = worst.first() {
        let corrected = if job.corrected.is_some() { " without the correction" } else { "" };
        said.push(format!("The worst place{corrected} is at line {}: {} µm.", job.points[*i].line, micrometres(*size)));
    }
    if let Some(left) = job.corrected.as_ref().filter(|_| judged > 0) {
        let per_cent = decimals(left.by * 100.0, 0);
        let holds = match job.tolerance {
            Some(limit) if left.worst <= limit => ", within the tolerance",
            Some(_) => ", out of the tolerance",
            None => "",
        };
        said.push(format!(
            "If the true compliance is {per_cent} % larger or smaller, the tool is up to {} µm off with the correction{holds}.",
            micrometres(left.worst)
        ));
    }
    let fast: Vec<String> = too_fast(job, travels).map(|(joint, _)| format!("joint {joint}")).collect();
    if !fast.is_empty() {
        said.push(format!("Too fast at the feeds of the path: {}.", crate::text::and(&fast)));
    }
    let open = passes == Some(false) || !fast.is_empty();
    let verdict = passes.map_or(String::new(), |passes| {
        format!("<p><span class=\"verdict\">{}</span></p>\n", if passes { "pass" } else { "fail" })
    });
    let said: String = said.iter().map(|sentence| text("p", sentence)).collect();
    format!(
        "<section class=\"finding{}\">\n<p class=\"headline\">{}.</p>\n{said}{verdict}</section>\n",
        if open { " open" } else { "" },
        escape(&headline)
    )
}

fn error(job: &Job<'_>) -> String {
    let Some((_, surface)) = job.forces.as_ref().filter(|_| job.has_surface()) else {
        return "distance from the path".to_owned();
    };
    let peak = if job.is_peak { ", at the worst force of a revolution," } else { "" };
    format!("error of the {surface}{peak}")
}

/// Joints that move faster than they can, from 1, with the point at which they are fastest.
fn too_fast<'a>(job: &'a Job<'_>, travels: &'a [Travel]) -> impl Iterator<Item = (usize, usize)> {
    let each = travels.iter().zip(&job.joints).enumerate();
    each.filter_map(|(j, (travel, joint))| {
        let ((i, speed), fastest) = (travel.speed?, joint.fastest?);
        is_too_fast(speed, fastest).then_some((j + 1, i))
    })
}

fn path(job: &Job<'_>, worst: Option<usize>) -> String {
    let mut said = "Positions are in the frame of the path. ".to_owned();
    if worst.is_some() {
        said += "The line is wider where the error is larger; the ring is the worst place. ";
    }
    if job.points.iter().any(|point| point.rapid) {
        said += "Rapids are thin and grey; those far from what is cut are left out. ";
    }
    if job.stock.is_some() {
        said += "The dashed frame is the stock. ";
    }
    let figure = format!("{}{}", track::picture(job, worst), text("figcaption", said.trim_end()));
    element("section", format!("{}{}", text("h2", "The path"), element("figure", figure)))
}

fn along(job: &Job<'_>) -> String {
    let chart = chart::along(job);
    if chart.is_empty() {
        return String::new();
    }
    let caption = "Each stroke keeps the least and the largest value of the stretch that it stands for.";
    let figure = element("figure", format!("{chart}{}", text("figcaption", caption)));
    element("section", format!("{}{figure}", text("h2", "Along the job")))
}

fn places(job: &Job<'_>, worst: &[(usize, f64)]) -> String {
    if worst.is_empty() {
        return String::new();
    }
    let has_section = job.points.iter().any(|point| point.section.is_some());
    let is_corrected = job.corrected.is_some();
    let head = [number("line"), words(""), number("x [mm]"), number("y [mm]"), number("z [mm]")];
    let sections = has_section.then(|| [number("ae [mm]"), number("ap [mm]")]);
    let last = [number("force [N]"), number(if is_corrected { "before [µm]" } else { "error [µm]" })];
    let after = is_corrected.then(|| number("after [µm]"));
    let mut table = Table::new(head.into_iter().chain(sections.into_iter().flatten()).chain(last).chain(after));
    let or_none =
        |value: Option<f64>, digits: usize| number(value.map_or("-".to_owned(), |value| decimals(value, digits)));
    for (k, &(i, size)) in worst.iter().enumerate() {
        let point = &job.points[i];
        let mut cells = vec![number(point.line.to_string()), Cell::Html(element("code", escape(&short(point.text))))];
        cells.extend(point.at.map(|side| number(decimals(side * 1e3, 1))));
        if has_section {
            cells.extend([0, 1].map(|side| or_none(point.section.map(|section| section[side] * 1e3), 2)));
        }
        cells.push(or_none(point.force, 0));
        cells.push(number(micrometres(size)));
        if is_corrected {
            cells.push(number(point.after.map_or("-".to_owned(), fine_micrometres)));
        }
        table.row(k == 0, cells);
    }
    let note = format!("By the {}. Neighbouring places count as one.", error(job));
    element("section", format!("{}{}{}", text("h2", "The worst places"), text("p", &note), table.html()))
}

/// A line of a file, as much as there is room for.
fn short(line: &str) -> String {
    let line = line.trim();
    let mut short: String = line.chars().take(MOST_CHARACTERS).collect();
    if short.len() < line.len() {
        short += " ..";
    }
    short
}

fn before_and_after(job: &Job<'_>) -> String {
    if job.summary.is_empty() {
        return String::new();
    }
    let mut table = Table::new([words("[µm]"), number("mean"), number("rms"), number("worst")]);
    for (name, of) in &job.summary {
        table.row(false, [words(name.clone())].into_iter().chain(of.map(|value| number(fine_micrometres(value)))));
    }
    let title = if job.corrected.is_some() { "Before and after the correction" } else { "The deviation in numbers" };
    let note = "Mean and rms are by length. Positive errors are into the part, negative ones leave material.";
    element("section", format!("{}{}{}", text("h2", title), table.html(), text("p", note)))
}

fn chatter(job: &Job<'_>) -> String {
    let Some((said, worst)) = &job.chatter else { return String::new() };
    let mut table = Table::new([
        number("line"),
        number("speed [rpm]"),
        number("stable up to, of its depth"),
        number("stable at [rpm]"),
    ]);
    for row in worst {
        table.row(false, row.iter().map(|cell| number(cell.clone())));
    }
    let table = if worst.is_empty() { String::new() } else { table.html() };
    element(
        "section",
        format!("{}{}{table}", text("h2", "Chatter"), text("p", &format!("{}.", crate::text::capital(said)))),
    )
}

fn joints(job: &Job<'_>, travels: &[Travel]) -> String {
    let mut table = Table::new([
        words(""),
        number("from"),
        number("to"),
        number("limits"),
        number("nearest to a limit"),
        number("at line"),
        number("fastest"),
        number("can"),
        number("at line"),
        words(""),
    ]);
    let line = |i: usize| number(job.points[i].line.to_string());
    let none = || number("-");
    let fast: Vec<usize> = too_fast(job, travels).map(|(joint, _)| joint).collect();
    for (j, (joint, travel)) in job.joints.iter().zip(travels).enumerate() {
        let (unit, per) = joint.unit;
        let limits = joint.limits.map(|limits| limits.map(|limit| significant(limit * per, 4)));
        table.row(
            fast.contains(&(j + 1)),
            [
                words(format!("joint {}", j + 1)),
                number(decimals(travel.range[0] * per, 1)),
                number(decimals(travel.range[1] * per, 1)),
                number(limits.map_or("none".to_owned(), |[low, high]| format!("{low} .. {high}"))),
                travel.margin.map_or_else(none, |(_, margin)| number(decimals(margin * per, 1))),
                travel.margin.map_or_else(none, |(i, _)| line(i)),
                travel.speed.map_or_else(none, |(_, speed)| number(decimals(speed * per, 1))),
                joint.fastest.map_or_else(none, |fastest| number(significant(fastest * per, 3))),
                travel.speed.map_or_else(none, |(i, _)| line(i)),
                words(format!("{unit}, {unit}/s")),
            ],
        );
    }
    let mut note = "Speeds are those at the feeds of the path; a rapid's speed is the controller's.".to_owned();
    if job.corrected.is_some() {
        note += " Coordinates are those of the corrected path.";
    }
    if job.joints.iter().all(|joint| joint.fastest.is_none()) {
        note += " The field joint_speeds of the cell says how fast the joints can be.";
    }
    let figure = element("figure", chart::joints(job, travels));
    element("section", format!("{}{}{}{figure}", text("h2", "The joints"), text("p", &note), table.html()))
}

fn help(job: &Job<'_>, travels: &[Travel]) -> String {
    let fast: Vec<(usize, usize)> = too_fast(job, travels).collect();
    let advice: String = advice::of(job, travels, &fast).iter().map(|one| text("li", one)).collect();
    if advice.is_empty() {
        return String::new();
    }
    element("section", format!("{}{}", text("h2", "What would help most"), element("ul", advice)))
}

fn footer(job: &Job<'_>) -> String {
    let mut said = String::new();
    if !job.files.is_empty() {
        said += &format!("The program: {}. ", job.files.join(", "));
    }
    said += "Deviations and forces are static: mean forces, or those of a revolution as if they stayed.";
    if job.chatter.is_none() {
        said += " Whether the arm chatters was not asked: --damping or --modes.";
    }
    element("footer", text("p", &said))
}
