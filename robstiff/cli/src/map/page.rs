//! A map as a page that needs nothing beside it.

use std::fmt::Write as _;

use super::document::Mapped;
use super::heat::{self, Room, beside, heat};
use super::slices::Slices;
use super::table::{heading, single};
use crate::report;
use crate::report::html::{self, Table, escape, number, text, words};
use crate::text::{capital, count};

const SCRIPT: &str = include_str!("page.js");

/// The picture as a file of its own.
pub fn svg(mapped: &Mapped, slices: &Slices) -> String {
    heat(mapped, slices, Room::Wide).svg.document(&format!("svg {{ background: #fff; }}\n{}", heat::STYLE))
}

/// The page: the picture, what it comes to, and a value wherever one points.
pub fn html(mapped: &Mapped, slices: &Slices) -> String {
    let [wide, narrow] = [Room::Wide, Room::Narrow].map(|room| heat(mapped, slices, room));
    let title = format!("{}: {}", mapped.robot, mapped.words());
    let mut body = format!("<header>\n{}{}", text("p", "Map of a robot's elastostatics"), text("h1", &mapped.robot));
    let mut said = capital(&mapped.words());
    if !mapped.fixed().is_empty() {
        write!(said, ", with {}", mapped.fixed()).expect("a string takes any text");
    }
    body += &text("p", &format!("{said}."));
    if let Some(frame) = mapped.framed() {
        body += &text("p", &format!("Positions {frame}."));
    }
    body += "</header>\n<section class=\"finding\">\n";
    for sentence in [headline(mapped)].into_iter().chain(mapped.placed()) {
        body += &text("p", &micro(&sentence));
    }
    body += "</section>\n";
    let pictures = [("wide", &wide.svg), ("narrow", &narrow.svg)];
    let pictures = pictures.map(|(room, svg)| format!("<div class=\"{room}\">{}</div>\n", svg.html())).concat();
    writeln!(body, "<figure class=\"map\">\n{pictures}<output class=\"tip\" hidden></output></figure>")
        .expect("a string takes any text");
    let caption = escape(&caption(mapped, slices));
    writeln!(body, "<figcaption>{caption}<span class=\"point\"> Point at the map to read a value.</span></figcaption>")
        .expect("a string takes any text");
    body += &extremes(mapped);
    body += &html::data("map", &data(mapped, slices, [&wide.frames, &narrow.frames]));
    html::page(&title, &[report::STYLE, heat::STYLE, TIP].concat(), &body, SCRIPT)
}

const TIP: &str = "figure.map { position: relative; }\nfigure.map svg { min-width: 0; }\n.wide svg { max-height: 88vh; }\n\
                   .narrow { display: none; }\n\
                   @media screen and (max-width: 40rem) { .wide { display: none; } .narrow { display: block; } }\n\
                   .tip { position: absolute; pointer-events: none; padding: .3rem .6rem; font-size: .85rem; \
                   line-height: 1.35; white-space: pre; background: var(--paper); color: var(--ink); \
                   border: 1px solid var(--soft); border-radius: 4px; }\n.tip[hidden] { display: none; }\n\
                   .finding p { font-size: 1.05rem; }\n\
                   @media print { .wide svg { max-height: 58vh; } .point { display: none; } table { break-inside: avoid; } }\n";

fn headline(mapped: &Mapped) -> String {
    let summary = &mapped.summary;
    let (Some(best), Some(worst)) = (&summary.best, &summary.worst) else {
        return "No pose reaches any of it.".to_owned();
    };
    let mut said = format!(
        "From {} at {} to {} at {}.",
        mapped.with_unit(best.values[0]),
        mapped.place(best.cell),
        mapped.with_unit(worst.values[0]),
        mapped.place(worst.cell),
    );
    if let Some(rigid) = mapped.rigid() {
        write!(said, " {}.", capital(&rigid)).expect("a string takes any text");
    }
    if summary.unreachable > 0 {
        write!(said, " {} of the {} are out of reach.", summary.unreachable, count(summary.cells, "cell"))
            .expect("a string takes any text");
    }
    said
}

fn caption(mapped: &Mapped, slices: &Slices) -> String {
    let mut said = format!("{} cells", mapped.summary.cells);
    if slices.slices.len() > 1 {
        said += &format!(", {} slices of them", slices.slices.len());
    }
    let coarse = slices.drawn.iter().zip(slices.pixels).any(|(&axis, pixels)| mapped.axes[axis].values.len() > pixels);
    if coarse {
        said += ", each colour the worst of the cells that it stands for";
    }
    said += ". Lines connect equal values; a cross marks the worst cell, a ring the best";
    if mapped.placements.iter().any(|placed| placed.best.is_some()) {
        said += ", a dashed frame the best place for the workpiece";
    }
    said + "."
}

fn extremes(mapped: &Mapped) -> String {
    let (Some(best), Some(worst)) = (&mapped.summary.best, &mapped.summary.worst) else { return String::new() };
    let mut table = Table::new([words(""), number("best"), number("worst")]);
    let cells = [mapped.indices(best.cell), mapped.indices(worst.cell)];
    for (k, axis) in mapped.axes.iter().enumerate().filter(|(_, axis)| axis.varies()) {
        let at = |cell: &Vec<usize>| number(crate::text::significant(axis.for_people(cell[k]), 6));
        table.row(false, [words(format!("{} [{}]", axis.name, axis.unit())), at(&cells[0]), at(&cells[1])]);
    }
    for (k, column) in mapped.columns.iter().enumerate() {
        let value = |values: &[f64]| match k {
            0 => number(mapped.figure(values[0])),
            _ => number(crate::text::significant(values[k] * column.scale, 4)),
        };
        table.row(k == 0, [words(micro(&heading(column))), value(&best.values), value(&worst.values)]);
    }
    table.html()
}

/// What the script reads: each slice's frames in the wide and the narrow picture, axes,
/// and values by rows from below.
fn data(mapped: &Mapped, slices: &Slices, [wide, narrow]: [&[heat::Frame]; 2]) -> serde_json::Value {
    let column = &mapped.columns[0];
    let axis = |k: usize| {
        let axis = &mapped.axes[slices.drawn[k]];
        let last = axis.values.len() - 1;
        serde_json::json!({
            "name": axis.name, "unit": axis.unit(), "from": axis.for_people(0), "to": axis.for_people(last),
            "count": slices.pixels[k],
        })
    };
    let slice = |(k, slice): (usize, &super::slices::Slice)| {
        let values = slice.values.iter().map(|&value| {
            let value = single(value, column).map(f64::from);
            let shown = value.and_then(|value| crate::text::significant(value, 4).parse::<f64>().ok());
            shown.map_or(serde_json::Value::Null, serde_json::Value::from)
        });
        let frames = [&wide[k], &narrow[k]].map(|frame| [frame.corner, frame.size]);
        serde_json::json!({
            "title": beside(mapped, slices, slice),
            "frames": frames,
            "values": values.collect::<Vec<_>>(),
        })
    };
    serde_json::json!({
        "name": column.name,
        "unit": column.unit.replace('u', "µ"),
        "right": axis(0),
        "up": axis(1),
        "slices": slices.slices.iter().enumerate().map(slice).collect::<Vec<_>>(),
    })
}

fn micro(text: &str) -> String {
    text.replace(" um", "\u{a0}µm").replace("[um]", "[µm]").replace("/um", "/µm")
}
