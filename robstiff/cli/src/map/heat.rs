//! A map as a picture: colours, contour lines with their values, a scale.

use std::fmt::Write as _;

use robstiff_machining::map::Axis;

use super::contour::contours;
use super::document::Mapped;
use super::raster;
use super::slices::{Slice, Slices};
use super::table::heading;
use crate::report::svg::{Svg, tick_label, ticks};
use crate::text::significant;

/// How the parts of the picture look, on screen and on paper.
pub const STYLE: &str = include_str!("heat.css");

/// Contour lines shorter than this many pixels of the figure have no label.
const LABELLED: f64 = 60.0;

/// Where a slice is drawn, in pixels of the figure.
pub struct Frame {
    /// Left and top.
    pub corner: [f64; 2],
    /// Width and height.
    pub size: [f64; 2],
}

/// The picture, and where its slices are in it.
pub struct Heat {
    /// The figure.
    pub svg: Svg,
    /// A frame a slice.
    pub frames: Vec<Frame>,
}

/// The range of values that colours tell apart, in the unit of people.
pub struct Scale {
    low: f64,
    high: f64,
    marks: Vec<f64>,
}

impl Scale {
    /// Of all slices. A few cells far off, about a singular pose, do not squeeze
    /// the others.
    fn new(slices: &Slices, unit: f64) -> Self {
        let finite = slices.slices.iter().flat_map(|slice| &slice.values).filter(|value| value.is_finite());
        let mut values: Vec<f64> = finite.map(|value| value * unit).collect();
        values.sort_unstable_by(f64::total_cmp);
        let quantile = |share: f64| values.get((share * (values.len().max(1) - 1) as f64) as usize).copied();
        let at = |share: f64| quantile(share).unwrap_or(0.0);
        let (mut low, mut high) = (at(0.0), at(1.0));
        if high - low > 3.0 * (at(0.98) - at(0.02)) {
            (low, high) = (at(0.02), at(0.98));
        }
        if high - low <= 1e-9 * high.abs() {
            (low, high) = (low - 0.5 * low.abs().max(1e-9), high + 0.5 * high.abs().max(1e-9));
        }
        let marks = ticks(low, high, 7).into_iter().filter(|mark| (low..=high).contains(mark)).collect();
        Self { low, high, marks }
    }

    /// Where a value is on the scale, from 0 to 1.
    pub fn share(&self, value: f64) -> f64 {
        ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }
}

/// Where the picture is looked at.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Room {
    /// On a screen or paper: up to three slices side by side, the scale beside them.
    Wide,
    /// On a phone or in half a window: slices below each other, the scale above.
    Narrow,
}

/// Draws the slices of a map.
pub fn heat(mapped: &Mapped, slices: &Slices, room: Room) -> Heat {
    let unit = mapped.columns[0].scale;
    let scale = Scale::new(slices, unit);
    let [right, up] = slices.drawn.map(|axis| &mapped.axes[axis]);
    let wide = room == Room::Wide;
    let columns = if wide { slices.slices.len().min(3) } else { 1 };
    let rows = slices.slices.len().div_ceil(columns);
    let most = match columns {
        _ if !wide => 296.0,
        1 => 620.0,
        _ => 800.0 / columns as f64 - 58.0,
    };
    let aspect = aspect(right, up);
    let width = most * (1.25 / aspect).min(1.0);
    let height = width * aspect;
    let (left, top, between, below) = if wide { (64.0, 34.0, 58.0, 64.0) } else { (58.0, 82.0, 14.0, 64.0) };
    let bar = left + columns as f64 * (width + between);
    let bottom = top + rows as f64 * (height + below);
    let mut svg = Svg::new(if wide { bar + 96.0 } else { left + most + between }, bottom + 6.0, &mapped.words());
    svg.raw(&hatch(room));
    let mut frames = Vec::new();
    for (number, slice) in slices.slices.iter().enumerate() {
        let (column, row) = (number % columns, number / columns);
        let corner = [left + column as f64 * (width + between), top + row as f64 * (height + below)];
        let frame = Frame { corner, size: [width, height] };
        let title = beside(mapped, slices, slice);
        if slices.slices.len() > 1 {
            svg.text("legend", [corner[0], corner[1] - 8.0], "start", &title);
        }
        cells(&mut svg, &frame, slices, slice, &scale, unit);
        lines(&mut svg, &frame, mapped, slices, slice, &scale);
        place(&mut svg, &frame, mapped, slices, slice);
        marks(&mut svg, &frame, mapped, slices, slice);
        axes(&mut svg, &frame, right, up);
        frames.push(frame);
    }
    if wide {
        legend(&mut svg, [bar, top], bottom - below - top, mapped, &scale);
    } else {
        legend_above(&mut svg, [left, 22.0], most, mapped, &scale);
    }
    let holes = slices.slices.iter().any(|slice| slice.values.iter().any(|value| value.is_nan()));
    if holes {
        let (x, y) = if wide { (bar, bottom - 14.0) } else { (left, bottom - 10.0) };
        svg.raw(&format!("<rect class=\"hole\" x=\"{x:.1}\" y=\"{:.1}\" width=\"14\" height=\"14\"/>", y - 11.0));
        svg.text("small", [x + 20.0, y], "start", "out of reach");
    }
    Heat { svg, frames }
}

/// The pattern of what is out of reach; a page has both pictures, each with its own.
fn hatch(room: Room) -> String {
    let id = if room == Room::Wide { "hatch" } else { "hatch-narrow" };
    format!(
        "<defs><pattern id=\"{id}\" width=\"7\" height=\"7\" patternUnits=\"userSpaceOnUse\" \
         patternTransform=\"rotate(45)\"><line class=\"hatch\" x1=\"0\" y1=\"0\" x2=\"0\" y2=\"7\"/></pattern></defs>"
    )
}

/// Height over width: true to scale where both axes are lengths.
fn aspect(right: &Axis, up: &Axis) -> f64 {
    let span = |axis: &Axis| axis.values[axis.values.len() - 1] - axis.values[0];
    if right.dimension == up.dimension && up.unit() == "mm" { (span(up) / span(right)).clamp(0.2, 5.0) } else { 0.7 }
}

/// Which slice it is: `z = 800 mm`.
pub fn beside(mapped: &Mapped, slices: &Slices, slice: &Slice) -> String {
    let aside = (0..mapped.axes.len()).filter(|axis| !slices.drawn.contains(axis) && mapped.axes[*axis].varies());
    let one = |axis: usize| {
        let (index, axis) = (slice.at[axis], &mapped.axes[axis]);
        format!("{} = {} {}", axis.name, significant(axis.for_people(index), 4), axis.unit())
    };
    aside.map(one).collect::<Vec<_>>().join(", ")
}

fn cells(svg: &mut Svg, frame: &Frame, slices: &Slices, slice: &Slice, scale: &Scale, unit: f64) {
    let ([x, y], [width, height]) = (frame.corner, frame.size);
    svg.raw(&format!("<rect class=\"hole\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/>"));
    let share = |value: &f64| if value.is_nan() { f64::NAN } else { scale.share(value * unit) };
    let shares: Vec<f64> = slice.values.iter().map(share).collect();
    svg.image(frame.corner, frame.size, &raster::picture(&shares, slices.pixels));
}

/// Contour lines at the marks of the scale; a dark line in a light one can be
/// seen on any colour.
fn lines(svg: &mut Svg, frame: &Frame, mapped: &Mapped, slices: &Slices, slice: &Slice, scale: &Scale) {
    let unit = mapped.columns[0].scale;
    let values: Vec<f64> = slice.values.iter().map(|value| value * unit).collect();
    let [right, up] = slices.pixels.map(|count| count as f64);
    let ([x, y], [width, height]) = (frame.corner, frame.size);
    // Values are those of the cells' middles.
    let place = |[i, j]: [f64; 2]| [x + (i + 0.5) / right * width, y + height - (j + 0.5) / up * height];
    // The best and the worst cell have names of their own.
    let mut labels: Vec<([f64; 2], String)> = Vec::new();
    let extremes = [&mapped.summary.worst, &mapped.summary.best];
    for extreme in extremes.into_iter().flatten() {
        let at = mapped.indices(extreme.cell);
        let [i, j] = [0, 1].map(|k| {
            let axis = slices.drawn[k];
            (at[axis] * slices.pixels[k] / mapped.axes[axis].values.len()) as f64
        });
        labels.push((place([i, j]), String::new()));
    }
    for &mark in &scale.marks {
        let mut path = String::new();
        for line in contours(&values, slices.pixels[0], mark) {
            let line: Vec<[f64; 2]> = line.into_iter().map(place).collect();
            for (k, [x, y]) in line.iter().enumerate() {
                write!(path, "{}{x:.1} {y:.1}", if k == 0 { 'M' } else { 'L' }).expect("a string takes any text");
            }
            let long = line.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum::<f64>();
            if long > LABELLED {
                // Where no other label is, the nearest to the line's middle.
                let mut order: Vec<usize> = (0..line.len()).collect();
                order.sort_by_key(|&k| k.abs_diff(line.len() / 2));
                let clear = |&[a, b]: &[f64; 2]| {
                    let inside = a - x > 22.0 && x + width - a > 22.0 && b - y > 12.0 && y + height - b > 12.0;
                    inside && labels.iter().all(|([c, d], _)| (a - c).abs() > 44.0 || (b - d).abs() > 20.0)
                };
                if let Some(at) = order.into_iter().map(|k| line[k]).find(clear) {
                    labels.push((at, tick_label(mark, &scale.marks)));
                }
            }
        }
        if !path.is_empty() {
            svg.path("contour under", &path);
            svg.path("contour", &path);
        }
    }
    for ([x, y], label) in labels.into_iter().filter(|(_, label)| !label.is_empty()) {
        svg.text("level", [x, y + 4.0], "middle", &label);
    }
}

/// The best and the worst cell, where they are in the slice.
fn marks(svg: &mut Svg, frame: &Frame, mapped: &Mapped, slices: &Slices, slice: &Slice) {
    let named = [("worst", &mapped.summary.worst), ("best", &mapped.summary.best)];
    for (name, cell) in named.into_iter().filter_map(|(name, extreme)| Some((name, extreme.as_ref()?.cell))) {
        let at = mapped.indices(cell);
        let aside = (0..at.len()).filter(|axis| !slices.drawn.contains(axis));
        if aside.into_iter().any(|axis| slice.at[axis] != at[axis]) {
            continue;
        }
        let share = |k: usize| {
            let axis = slices.drawn[k];
            (at[axis] as f64 + 0.5) / mapped.axes[axis].values.len() as f64
        };
        let x = frame.corner[0] + share(0) * frame.size[0];
        let y = frame.corner[1] + (1.0 - share(1)) * frame.size[1];
        let anchor = if share(0) < 0.12 {
            "start"
        } else if share(0) > 0.88 {
            "end"
        } else {
            "middle"
        };
        let dx = match anchor {
            "start" => -4.0,
            "end" => 4.0,
            _ => 0.0,
        };
        for class in ["mark under", "mark"] {
            if name == "worst" {
                let cross = format!("M{:.1} {:.1}l9 9m0 -9l-9 9", x - 4.5, y - 4.5);
                svg.path(class, &cross);
            } else {
                svg.circle(class, [x, y], 5.0, "");
            }
        }
        let above = if share(1) > 0.9 { 20.0 } else { -10.0 };
        svg.text("level strong", [x + dx, y + above], anchor, name);
    }
}

/// Where the workpiece is best put, seen in the slice.
fn place(svg: &mut Svg, frame: &Frame, mapped: &Mapped, slices: &Slices, slice: &Slice) {
    let found = mapped.placements.iter().find_map(|placed| Some((placed.size, placed.best?)));
    let Some((size, best)) = found else { return };
    let aside = (0..mapped.axes.len()).filter(|axis| !slices.drawn.contains(axis));
    let within = |axis: usize| (best.first[axis]..best.first[axis] + best.span[axis]).contains(&slice.at[axis]);
    if !aside.into_iter().all(within) {
        return;
    }
    let share = |k: usize| {
        let axis = slices.drawn[k];
        let values = &mapped.axes[axis].values;
        // Cells are drawn about their values.
        let pitch = (values[values.len() - 1] - values[0]) / (values.len() - 1) as f64;
        let first = best.first[axis] as f64 + 0.5;
        [first / values.len() as f64, (first + size[axis] / pitch) / values.len() as f64]
    };
    let ([left, right], [below, above]) = (share(0), share(1));
    let ([x, y], [width, height]) = (frame.corner, frame.size);
    let path = format!(
        "M{:.1} {:.1}h{:.1}v{:.1}h{:.1}z",
        x + left * width,
        y + (1.0 - above) * height,
        (right - left) * width,
        (above - below) * height,
        (left - right) * width
    );
    svg.path("place under", &path);
    svg.path("place", &path);
}

fn axes(svg: &mut Svg, frame: &Frame, right: &Axis, up: &Axis) {
    let ([x, y], [width, height]) = (frame.corner, frame.size);
    svg.raw(&format!("<rect class=\"frame\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/>"));
    let ends = |axis: &Axis| {
        let last = axis.values.len() - 1;
        let (from, to) = (axis.for_people(0), axis.for_people(last));
        // A cell is drawn about its value.
        let half = 0.5 * (to - from) / last as f64;
        [from - half, to + half]
    };
    let tick = |axis: &Axis, count: usize| {
        let ([low, high], last) = (ends(axis), axis.values.len() - 1);
        let marks = ticks(axis.for_people(0), axis.for_people(last), count);
        let labels: Vec<(f64, String)> =
            marks.iter().map(|&mark| ((mark - low) / (high - low), tick_label(mark, &marks))).collect();
        labels.into_iter().filter(|(share, _)| (0.0..=1.0).contains(share)).collect::<Vec<_>>()
    };
    for (share, label) in tick(right, (width / 90.0) as usize) {
        let at = x + share * width;
        svg.line("tick", [at, y + height], [at, y + height + 5.0]);
        svg.text("small", [at, y + height + 18.0], "middle", &label);
    }
    for (share, label) in tick(up, (height / 50.0).max(2.0) as usize) {
        let at = y + (1.0 - share) * height;
        svg.line("tick", [x - 5.0, at], [x, at]);
        svg.text("small", [x - 8.0, at + 4.0], "end", &label);
    }
    svg.text("axis", [x + width / 2.0, y + height + 36.0], "middle", &format!("{} [{}]", right.name, right.unit()));
    let (mx, my) = (x - 48.0, y + height / 2.0);
    svg.raw(&format!(
        "<text class=\"axis\" text-anchor=\"middle\" transform=\"translate({mx:.1} {my:.1}) rotate(-90)\">{} [{}]</text>",
        up.name,
        up.unit()
    ));
}

/// What the colours stand for, and what their low and high end mean.
fn meaning(mapped: &Mapped) -> (String, [&'static str; 2]) {
    let what = heading(&mapped.columns[0]).replace("[u", "[µ").replace("/u", "/µ");
    (what, if mapped.measure.worse_is_larger() { ["holds", "gives way"] } else { ["gives way", "holds"] })
}

/// The scale, lying.
fn legend_above(svg: &mut Svg, [x, y]: [f64; 2], width: f64, mapped: &Mapped, scale: &Scale) {
    let shares: Vec<f64> = (0..256).map(|k| f64::from(k) / 255.0).collect();
    let (what, [low, high]) = meaning(mapped);
    svg.text("legend", [x, y - 8.0], "start", &what);
    svg.image([x, y], [width, 16.0], &raster::picture(&shares, [256, 1]));
    svg.raw(&format!("<rect class=\"frame\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"16\"/>"));
    svg.text("level", [x + 5.0, y + 12.0], "start", low);
    svg.text("level", [x + width - 5.0, y + 12.0], "end", high);
    for &mark in &scale.marks {
        let at = x + scale.share(mark) * width;
        svg.line("tick", [at, y + 16.0], [at, y + 21.0]);
        svg.text("small", [at, y + 33.0], "middle", &tick_label(mark, &scale.marks));
    }
}

fn legend(svg: &mut Svg, [x, y]: [f64; 2], height: f64, mapped: &Mapped, scale: &Scale) {
    let height = height.min(360.0);
    let shares: Vec<f64> = (0..256).map(|k| f64::from(k) / 255.0).collect();
    let (what, [low, high]) = meaning(mapped);
    svg.text("legend", [x + 92.0, y - 12.0], "end", &what);
    svg.image([x, y], [16.0, height], &raster::picture(&shares, [1, 256]));
    svg.raw(&format!("<rect class=\"frame\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"16\" height=\"{height:.1}\"/>"));
    for &mark in &scale.marks {
        let at = y + (1.0 - scale.share(mark)) * height;
        svg.line("tick", [x + 16.0, at], [x + 21.0, at]);
        svg.text("small", [x + 25.0, at + 4.0], "start", &tick_label(mark, &scale.marks));
    }
    for (word, at) in [high, low].into_iter().zip([y + 12.0, y + height - 4.0]) {
        svg.raw(&format!(
            "<text class=\"small\" text-anchor=\"{}\" transform=\"translate({:.1} {at:.1}) rotate(90)\">{word}</text>",
            if at < y + height / 2.0 { "start" } else { "end" },
            x + 70.0
        ));
    }
}
