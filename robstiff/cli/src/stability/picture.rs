//! The depths over the feed, as a picture.

use robstiff_machining::milling::Cut;
use robstiff_machining::stability::{FeedLimit, best};

use super::{Predicted, page};
use crate::report::svg::{Svg, tick_label, ticks};
use crate::text::significant;

const SIZE: f64 = 520.0;
const CENTER: [f64; 2] = [SIZE / 2.0, SIZE / 2.0 + 14.0];
const RADIUS: f64 = 200.0;
/// The shortest arrow that shows where it points.
const SHORTEST: f64 = 24.0;

/// A file has no page around it that would bring a style.
const STYLE: &str = "<style>\n\
    text { font: 12px sans-serif; fill: #444; }\n\
    .grid { fill: none; stroke: #ddd; }\n\
    .sector { fill: #d9534f; fill-opacity: 0.3; }\n\
    .limit { fill: none; stroke: #b02a2a; stroke-width: 1.5; }\n\
    .depth { fill: none; stroke: #1f5fa8; stroke-dasharray: 5 4; }\n\
    .best { fill: none; stroke: #2b7a3d; stroke-width: 2; }\n\
    .dot { fill: #444; }\n\
    @media (prefers-color-scheme: dark) {\n\
    svg { background: #1b1b1b; } text { fill: #ccc; } .grid { stroke: #444; } .limit { stroke: #f08080; }\n\
    .depth { stroke: #7fb2f0; } .best { stroke: #7fcf8f; } }\n\
    </style>\n";

/// The picture: the feed's direction around, the depth outwards; red where it
/// chatters.
pub fn svg(predicted: &Predicted, cut: &Cut) -> String {
    let label = "Depths of cut with mode coupling over the direction of feed";
    let mut svg = Svg::new(SIZE, SIZE + 72.0, label);
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
    let closed = predicted.feeds.iter().chain(predicted.feeds.first());
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
        "red: mode coupling; white beyond the line: reached only through red",
        "dashed: the cut's depth; arrow: the best feed, to its limit",
        "not regenerative chatter of spindle, tool or workpiece",
    ];
    for (y, legend) in [14.0, 30.0, 46.0, 62.0].into_iter().zip(legends) {
        svg.text("small", [SIZE / 2.0, SIZE + y], "middle", legend);
    }
    svg.file(STYLE)
}
