//! The residual against the quantities that account for most of it: rings
//! before, discs after.

use super::content::{Dependence, Report};
use super::figure::{Frame, ends};
use super::svg::{Svg, tick_label, ticks};
use crate::text::decimals;

const WIDTH: f64 = 860.0;
const LEFT: f64 = 52.0;
const GAP: f64 = 66.0;
const TOP: f64 = 58.0;
const HEIGHT: f64 = 190.0;
const AXES: [&str; 3] = ["x", "y", "z"];

/// The figure and its caption.
pub fn figure(report: &Report) -> (String, String) {
    let with_effects = report.has_effects();
    let count = report.dependences.len().max(3) as f64;
    let width = (WIDTH - LEFT - 16.0 - GAP * (count - 1.0)) / count;
    let mut svg = Svg::new(WIDTH, TOP + HEIGHT + 54.0, "Residual against what it depends on most");
    let class = |after: bool| if after || !with_effects { "after" } else { "before" };
    svg.circle(class(false), [LEFT + 6.0, 10.0], 4.0, "");
    svg.text("legend", [LEFT + 16.0, 14.0], "start", "joints identified again");
    if with_effects {
        svg.circle(class(true), [LEFT + 186.0, 10.0], 4.0, "");
        svg.text("legend", [LEFT + 196.0, 14.0], "start", "with the effects");
    }
    let finite = |one: &Dependence| -> Vec<[f64; 3]> {
        one.points.iter().filter(|point| point.iter().all(|number| number.is_finite())).copied().collect()
    };
    for (k, one) in report.dependences.iter().enumerate() {
        let points = finite(one);
        let x = LEFT + k as f64 * (width + GAP);
        let largest = points.iter().flat_map(|point| &point[1..]).map(|um| um.abs()).fold(1.0, f64::max);
        let marks = ticks(-largest, largest, 4);
        let frame = Frame { x, y: TOP, width, height: HEIGHT, range: ends(&marks) };
        frame.grid(&mut svg, &marks, &format!("{} [µm]", AXES[one.axis.min(2)]));
        let across =
            |largest: f64, other: fn(f64, f64) -> f64| points.iter().map(|point| point[0]).fold(largest, other);
        let values = ticks(across(f64::INFINITY, f64::min), across(f64::NEG_INFINITY, f64::max), 3);
        let right = Frame { x, y: TOP, width, height: HEIGHT, range: ends(&values) };
        for &value in &values {
            svg.text("small", [right.right(value), TOP + HEIGHT + 15.0], "middle", &tick_label(value, &values));
        }
        let unit = if one.unit.is_empty() { String::new() } else { format!(" [{}]", one.unit) };
        svg.text("axis", [x + width / 2.0, TOP + HEIGHT + 32.0], "middle", &format!("{}{unit}", one.name));
        let percent = one.share.map(|share| format!("{} %", decimals(100.0 * share, 0)));
        let share = if with_effects { percent.join(" → ") } else { percent[0].clone() };
        svg.text("legend", [x + width, TOP - 12.0], "end", &share);
        let radius = if points.len() > 120 { 1.8 } else { 2.8 };
        for after in if with_effects { &[false, true][..] } else { &[false] } {
            for point in &points {
                let y = frame.up(point[1 + usize::from(*after)]);
                svg.circle(class(*after), [right.right(point[0]), y], radius, "");
            }
        }
    }
    let caption = "Each row's residual, without outliers, against the quantities that account for most of it, in the direction where they do. \
                   Over each: how much of the variance a parabola accounts for, before and after; noise has none.";
    (svg.html(), caption.to_owned())
}
