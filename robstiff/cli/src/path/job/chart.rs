//! What a job has along its length: deviation, force, section of the cut; angles and speeds of the joints.

use super::content::{Job, Travel};
use super::thin;
use crate::report::svg::{Svg, tick_label, ticks};
use crate::text::{decimals, significant};

const WIDTH: f64 = 860.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 44.0;
/// Steps that lines over the width are drawn in.
const STEPS: usize = 480;

/// A line of a chart.
struct Line {
    class: &'static str,
    name: &'static str,
    values: Vec<(f64, Option<f64>)>,
}

/// A rectangle with what it spans.
struct Frame {
    corner: [f64; 2],
    size: [f64; 2],
    along: [f64; 2],
    range: [f64; 2],
}

impl Frame {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.right(x), self.up(y)]
    }

    fn right(&self, x: f64) -> f64 {
        let [from, to] = self.along;
        self.corner[0] + self.size[0] * ((x - from) / (to - from).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
    }

    fn up(&self, y: f64) -> f64 {
        let [low, high] = self.range;
        self.corner[1] + self.size[1] * (1.0 - ((y - low) / (high - low).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0))
    }

    fn line(&self, svg: &mut Svg, class: &str, values: &[(f64, Option<f64>)], steps: usize) {
        for line in thin::lines(values.iter().copied(), self.along, steps) {
            let mut drawn: Vec<[f64; 2]> = line.into_iter().map(|point| self.at(point)).collect();
            if let [one] = drawn[..] {
                // A line of one point is a dot.
                drawn.push(one);
            }
            svg.polyline(class, drawn);
        }
    }
}

/// Deviation, force and section of the cut over arc length; empty where there is no force.
pub fn along(job: &Job<'_>) -> String {
    let over = |of: &dyn Fn(usize) -> Option<f64>| -> Vec<(f64, Option<f64>)> {
        job.points.iter().enumerate().map(|(i, point)| (point.s * 1e3, of(i))).collect()
    };
    let sizes: Vec<Option<f64>> = job.sizes().collect();
    if sizes.iter().all(Option::is_none) {
        return String::new();
    }
    let name =
        if job.has_surface() { "error of the surface, either way [µm]" } else { "distance from the path [µm]" };
    let before = Line {
        class: if job.corrected.is_some() { "before" } else { "after" },
        name: if job.corrected.is_some() { "without the correction" } else { "" },
        values: over(&|i| Some(sizes[i]? * 1e6)),
    };
    let mut errors = vec![before];
    if job.corrected.is_some() {
        let commanded = job.commanded();
        errors.push(Line {
            class: "after",
            name: "with it, if the model is true",
            values: over(&|i| Some(commanded[i]? * 1e6)),
        });
    }
    let force = Line { class: "after", name: "", values: over(&|i| job.points[i].force) };
    let mut charts = vec![(name, errors, 150.0), ("force [N]", vec![force], 90.0)];
    if job.points.iter().any(|point| point.section.is_some()) {
        let section = |k: usize| over(&|i| Some(job.points[i].section?[k] * 1e3));
        let width = Line { class: "after", name: "radial width ae", values: section(0) };
        let depth = Line { class: "before", name: "axial depth ap", values: section(1) };
        charts.push(("section of the cut [mm]", vec![width, depth], 90.0));
    }
    let height = 34.0 + charts.iter().map(|(.., height)| height + 44.0).sum::<f64>();
    let mut svg = Svg::new(WIDTH, height, "Deviation, force and section of the cut along the job");
    let along = ends(job);
    let mut top = 34.0;
    for (k, (name, lines, height)) in charts.iter().enumerate() {
        let most = lines.iter().flat_map(|line| &line.values).filter_map(|(_, value)| *value).fold(0.0, f64::max);
        let limit = job.tolerance.filter(|_| k == 0).map(|tolerance| tolerance * 1e6);
        // A tolerance far above all would squeeze them.
        let most = limit.filter(|limit| *limit < 3.0 * most).map_or(most, |limit| limit.max(most));
        let marks = ticks(0.0, most, (height / 32.0) as usize);
        let frame = Frame {
            corner: [LEFT, top],
            size: [WIDTH - LEFT - RIGHT, *height],
            along,
            range: [0.0, marks[marks.len() - 1]],
        };
        for &mark in &marks {
            let y = frame.up(mark);
            svg.line(if mark == 0.0 { "zero" } else { "grid" }, [LEFT, y], [WIDTH - RIGHT, y]);
            svg.text("small", [LEFT - 8.0, y + 4.0], "end", &tick_label(mark, &marks));
        }
        svg.text("axis", [12.0, top - 12.0], "start", name);
        let mut x = WIDTH - RIGHT;
        for line in lines.iter().rev().filter(|line| !line.name.is_empty()) {
            svg.text("legend", [x, top - 12.0], "end", line.name);
            x -= 6.4 * line.name.len() as f64 + 10.0;
            svg.polyline(&format!("series {}", line.class), [[x - 22.0, top - 16.0], [x, top - 16.0]]);
            x -= 40.0;
        }
        for line in lines {
            frame.line(&mut svg, &format!("series {}", line.class), &line.values, STEPS);
        }
        if let Some(limit) = limit.filter(|limit| *limit <= frame.range[1]) {
            svg.line("limit", [LEFT, frame.up(limit)], [WIDTH - RIGHT, frame.up(limit)]);
            svg.text("small", [WIDTH - RIGHT + 6.0, frame.up(limit) + 4.0], "start", "limit");
        }
        top += height + 44.0;
    }
    distance(&mut svg, [LEFT, WIDTH - LEFT - RIGHT], along, top - 44.0);
    svg.html()
}

/// Angles and speeds of the joints over arc length, each between its limits.
pub fn joints(job: &Job<'_>, travels: &[Travel]) -> String {
    let (height, step, top) = (44.0, 66.0, 40.0);
    let lanes = job.joints.len() as f64;
    let mut svg = Svg::new(WIDTH, top + lanes * step + 26.0, "Coordinates and speeds of the joints along the job");
    let half = 0.5 * (WIDTH - 2.0 * LEFT - RIGHT - 36.0);
    let corners = [LEFT + 16.0, LEFT + 16.0 + half + LEFT + 20.0];
    svg.text("legend", [corners[0], 12.0], "start", "coordinate; the lane ends at the limits");
    svg.text("legend", [corners[1], 12.0], "start", "speed at the feeds of the path");
    let along = ends(job);
    for (j, (joint, travel)) in job.joints.iter().zip(travels).enumerate() {
        let (y, (unit, per)) = (top + j as f64 * step, joint.unit);
        let over = |of: &dyn Fn(usize) -> Option<f64>| -> Vec<(f64, Option<f64>)> {
            job.points.iter().enumerate().map(|(i, point)| (point.s * 1e3, of(i))).collect()
        };
        let range = joint.limits.unwrap_or(travel.range).map(|q| q * per);
        let margin = if joint.limits.is_none() { 0.1 * (range[1] - range[0]).max(1.0) } else { 0.0 };
        let range = [range[0] - margin, range[1] + margin];
        let frame = Frame { corner: [corners[0], y], size: [half, height], along, range };
        lane(
            &mut svg,
            &frame,
            &format!("joint {} [{unit}]", j + 1),
            range.map(|limit| decimals(limit, 0)),
            joint.limits.is_some(),
        );
        frame.line(&mut svg, "series after", &over(&|i| Some(job.points[i].q[j] * per)), STEPS / 2);

        let most = travel.speed.map_or(0.0, |(_, speed)| speed * per);
        let fastest = joint.fastest.map(|fastest| fastest * per);
        // A limit far above would make the line flat.
        let near = fastest.filter(|fastest| *fastest < 4.0 * most);
        let high = near.map_or(most, |fastest| fastest.max(most) * 1.05);
        let frame = Frame {
            corner: [corners[1], y],
            size: [half, height],
            along,
            range: [0.0, if high > 0.0 { high } else { 1.0 }],
        };
        let said = fastest.map_or(format!("joint {} [{unit}/s]", j + 1), |fastest| {
            format!("joint {} [{unit}/s], at most {}", j + 1, significant(fastest, 3))
        });
        let top_label = if travel.speed.is_some() { significant(high, 2) } else { String::new() };
        lane(&mut svg, &frame, &said, ["0".to_owned(), top_label], false);
        frame.line(&mut svg, "series after", &over(&|i| Some(job.speed(i, j)? * per)), STEPS / 2);
        if let Some(fastest) = near {
            svg.line("limit", [corners[1], frame.up(fastest)], [corners[1] + half, frame.up(fastest)]);
        }
    }
    for corner in corners {
        distance(&mut svg, [corner, half], along, top + lanes * step - (step - height));
    }
    svg.html()
}

fn lane(svg: &mut Svg, frame: &Frame, name: &str, ends: [String; 2], is_limited: bool) {
    let ([x, y], [width, height]) = (frame.corner, frame.size);
    svg.bar("lane", [x, y], [width, height], "");
    if is_limited {
        svg.line("limit", [x, y], [x + width, y]);
        svg.line("limit", [x, y + height], [x + width, y + height]);
    }
    svg.text("small", [x, y - 5.0], "start", name);
    svg.text("small", [x - 6.0, y + height + 2.0], "end", &ends[0]);
    svg.text("small", [x - 6.0, y + 8.0], "end", &ends[1]);
}

/// The ends of the arc length (mm).
fn ends(job: &Job<'_>) -> [f64; 2] {
    let [first, last] = [job.points.first(), job.points.last()].map(|point| point.map_or(0.0, |point| point.s * 1e3));
    [first, if last > first { last } else { first + 1.0 }]
}

/// Marks of the arc length under a chart.
fn distance(svg: &mut Svg, [x, width]: [f64; 2], [from, to]: [f64; 2], y: f64) {
    let marks = ticks(from, to, (width / 100.0) as usize);
    for &mark in marks.iter().filter(|mark| (from..=to).contains(*mark)) {
        let at = x + width * (mark - from) / (to - from);
        svg.text("small", [at, y + 14.0], "middle", &tick_label(mark, &marks));
    }
    svg.text("axis", [x + width, y + 30.0], "end", "along the path [mm]");
}
