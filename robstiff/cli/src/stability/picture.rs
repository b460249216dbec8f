//! The depths over the feed and over the speed of the spindle, as a picture.

use robstiff_machining::milling::Cut;
use robstiff_machining::stability::{FeedLimit, best};

use super::lobes::Lobe;
use super::{Predicted, page};
use crate::report::svg::{Svg, tick_label, ticks};
use crate::text::significant;

const SIZE: f64 = 520.0;
const CENTER: [f64; 2] = [SIZE / 2.0, SIZE / 2.0 + 14.0];
const RADIUS: f64 = 200.0;
/// The shortest arrow that shows where it points.
const SHORTEST: f64 = 24.0;
/// The lobe diagram below it: its left and right, its top and bottom.
const ACROSS: [f64; 2] = [48.0, SIZE - 20.0];
const DOWN: [f64; 2] = [SIZE + 122.0, SIZE + 302.0];

/// A file has no page around it that would bring a style.
const STYLE: &str = "<style>\n\
    text { font: 12px sans-serif; fill: #444; }\n\
    .grid { fill: none; stroke: #ddd; }\n\
    .sector { fill: #d9534f; fill-opacity: 0.3; }\n\
    .limit { fill: none; stroke: #b02a2a; stroke-width: 1.5; }\n\
    .without { fill: none; stroke: #888; stroke-dasharray: 2 3; }\n\
    .depth { fill: none; stroke: #1f5fa8; stroke-dasharray: 5 4; }\n\
    .best { fill: none; stroke: #2b7a3d; stroke-width: 2; }\n\
    .dot { fill: #444; }\n\
    @media (prefers-color-scheme: dark) {\n\
    svg { background: #1b1b1b; } text { fill: #ccc; } .grid { stroke: #444; } .limit { stroke: #f08080; }\n\
    .depth { stroke: #7fb2f0; } .best { stroke: #7fcf8f; } }\n\
    </style>\n";

/// The picture.
pub fn svg(predicted: &Predicted, cut: &Cut) -> String {
    let label = "Depths of cut with chatter over the direction of feed and the speed of the spindle";
    let mut svg = Svg::new(SIZE, DOWN[1] + 72.0, label);
    over_feeds(&mut svg, predicted, cut);
    over_speeds(&mut svg, predicted, cut);
    svg.file(STYLE)
}

/// The feed's direction around, the depth outwards; red where it chatters.
fn over_feeds(svg: &mut Svg, predicted: &Predicted, cut: &Cut) {
    let greatest = predicted.greatest * 1e3;
    let marks: Vec<f64> = ticks(0.0, greatest, 4).into_iter().filter(|mark| *mark <= greatest * (1.0 + 1e-9)).collect();
    let out = |depth: f64| depth * 1e3 / greatest * RADIUS;
    let at = |angle: f64, radius: f64| [CENTER[0] + radius * angle.cos(), CENTER[1] + radius * angle.sin()];

    let step = std::f64::consts::TAU / predicted.feeds.len() as f64;
    for feed in &predicted.feeds {
        for &[from, to] in &feed.limits.unstable {
            let half = 0.5 * step;
            let corners = [(-half, from), (half, from), (half, to), (-half, to), (-half, from)];
            svg.polygon("sector", corners.map(|(turn, depth)| at(feed.angle + turn, out(depth))));
        }
    }
    for &mark in marks.iter().filter(|mark| **mark > 0.0) {
        svg.circle("grid", CENTER, out(mark * 1e-3), "");
        svg.text("small", [CENTER[0] + 4.0, CENTER[1] - out(mark * 1e-3) - 3.0], "start", &tick_label(mark, &marks));
    }
    for k in 0..12 {
        let angle = f64::from(k) * std::f64::consts::TAU / 12.0;
        svg.line("grid", CENTER, at(angle, RADIUS));
        let [x, y] = at(angle, RADIUS + 20.0);
        svg.text("small", [x, y + 4.0], "middle", &format!("{}°", 30 * k));
    }
    let limiting = |feed: &FeedLimit| feed.limits.limiting().unwrap_or(predicted.greatest);
    let without = |feed: &FeedLimit| feed.without_delay.limiting().unwrap_or(predicted.greatest);
    let closed = predicted.feeds.iter().chain(predicted.feeds.first());
    svg.polyline("without", closed.clone().map(|feed| at(feed.angle, out(without(feed)))));
    svg.polyline("limit", closed.map(|feed| at(feed.angle, out(limiting(feed)))));
    if cut.depth <= predicted.greatest {
        svg.circle("depth", CENTER, out(cut.depth), &format!("{} mm", significant(cut.depth * 1e3, 3)));
    }
    if let Some(best) = best(&predicted.feeds) {
        // To where that feed begins to chatter, and so far at least that it is seen.
        svg.arrow("best", CENTER, at(best.angle, out(limiting(best)).max(SHORTEST)));
    }
    svg.text("title", [SIZE / 2.0, 18.0], "middle", "Limiting depth of cut [mm] over the direction of feed");
    let first = predicted.feeds.first().map(|feed| page::direction(&feed.feed)).unwrap_or_default();
    let first = format!("0°: along {first} in the base frame; seen from the spindle");
    let legends = [
        first.as_str(),
        "red: chatter; white beyond the line: reached only through red",
        "dashed: the cut's depth; arrow: the best feed, to its limit; dotted: without delay",
        "not the modes of spindle, tool or workpiece",
    ];
    for (y, legend) in [14.0, 30.0, 46.0, 62.0].into_iter().zip(legends) {
        svg.text("small", [SIZE / 2.0, SIZE + y], "middle", legend);
    }
}

/// The lobe diagram: the speed of the spindle to the right, the depth upwards.
fn over_speeds(svg: &mut Svg, predicted: &Predicted, cut: &Cut) {
    let Some(place) = best(&predicted.feeds).and_then(|best| predicted.feeds.iter().position(|feed| feed == best))
    else {
        return;
    };
    let rpm = |speed: f64| speed * 60.0 / std::f64::consts::TAU;
    let speeds = predicted.lobes.iter().map(|lobe| rpm(lobe.speed));
    let (from, to) = speeds.fold((f64::INFINITY, 0.0), |(from, to), speed| (speed.min(from), speed.max(to)));
    let greatest = predicted.greatest * 1e3;
    let [left, right] = ACROSS;
    let [top, bottom] = DOWN;
    let right_of = |speed: f64| left + (speed - from) / (to - from) * (right - left);
    let up = |depth: f64| bottom - depth * 1e3 / greatest * (bottom - top);
    let limit = |limit: Option<f64>| limit.unwrap_or(predicted.greatest);
    let line = |of: &dyn Fn(&Lobe) -> Option<f64>| -> Vec<[f64; 2]> {
        predicted.lobes.iter().map(|lobe| [right_of(rpm(lobe.speed)), up(limit(of(lobe)))]).collect()
    };
    let best_feed = line(&|lobe| lobe.limits[place]);
    let corners = [[right, top], [left, top]];
    svg.polygon("sector", best_feed.iter().copied().chain(corners));
    let depths: Vec<f64> =
        ticks(0.0, greatest, 4).into_iter().filter(|mark| *mark <= greatest * (1.0 + 1e-9)).collect();
    for &mark in &depths {
        let y = up(mark * 1e-3);
        svg.line("grid", [left, y], [right, y]);
        svg.text("small", [left - 6.0, y + 4.0], "end", &tick_label(mark, &depths));
    }
    let marks: Vec<f64> = ticks(from, to, 5).into_iter().filter(|mark| (from..=to).contains(mark)).collect();
    for &mark in &marks {
        let x = right_of(mark);
        svg.line("grid", [x, top], [x, bottom]);
        svg.text("small", [x, bottom + 16.0], "middle", &tick_label(mark, &marks));
    }
    svg.polyline("best", best_feed);
    svg.polyline("limit", line(&Lobe::least));
    if cut.depth <= predicted.greatest {
        svg.line("depth", [left, up(cut.depth)], [right, up(cut.depth)]);
    }
    if let Some(speed) = cut.speed.map(rpm).filter(|speed| (from..=to).contains(speed)) {
        svg.line("depth", [right_of(speed), top], [right_of(speed), bottom]);
    }
    svg.text("title", [SIZE / 2.0, top - 14.0], "middle", "Limiting depth of cut [mm] over the spindle speed [rpm]");
    let legends = [
        "green: the feed of the arrow; red area: it chatters there",
        "red line: the worst feed; dashed: the cut's depth and speed",
    ];
    for (y, legend) in [38.0, 54.0].into_iter().zip(legends) {
        svg.text("small", [SIZE / 2.0, bottom + y], "middle", legend);
    }
}
