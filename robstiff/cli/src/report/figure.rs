//! The figures of a report. What belongs to which model shows by its shape, so
//! that no colour is needed: a dash is the model as declared, a ring the joints
//! identified again, a disc the last model: with the effects, or else these joints.

use super::content::{PoseError, Report, Residual};
use super::svg::{Svg, tick_label, ticks};
use super::terms::Terms;
use crate::text::decimals;

const WIDTH: f64 = 860.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 44.0;

/// The error pose by pose, and under it what the effects add there.
pub fn errors(report: &Report) -> String {
    let poses = &report.errors;
    let terms = report.terms;
    let Terms { place: [place, _], printed, .. } = terms;
    let with_effects = report.has_effects();
    let (top, upper) = (34.0, 220.0);
    let (gap, lower) = if with_effects { (44.0, 80.0) } else { (0.0, 0.0) };
    let mut svg = Svg::new(WIDTH, top + upper + gap + lower + 40.0, &format!("Error of each {place} before and after"));

    // Data that cannot tell leave the description as declared, and so what is after.
    let last = |pose: &PoseError| if with_effects { pose.after } else { pose.identified };

    // A declared model may be far worse than the rest: it is cut, not the others squeezed.
    let compared = poses.iter().flat_map(|pose| [pose.identified, last(pose)]).fold(report.noise_um, f64::max);
    let declared = poses.iter().map(|pose| pose.declared).fold(0.0, f64::max);
    let ceiling = if declared > 2.5 * compared { 1.15 * compared } else { declared.max(compared) };
    let marks = ticks(0.0, ceiling, 5);
    let frame = Frame { x: LEFT, y: top, width: WIDTH - LEFT - RIGHT, height: upper, range: ends(&marks) };
    let step = frame.width / poses.len().max(1) as f64;
    for (k, _) in poses.iter().enumerate().filter(|(_, pose)| pose.held_out) {
        svg.bar("held-out", [LEFT + k as f64 * step, top], [step, upper], "");
    }
    frame.grid(&mut svg, &marks, &format!("error [{printed}]"));
    // A displacement is as noisy as one reading at least, as two at most.
    let noise = [report.reading_um, report.noise_um].map(|um| frame.up(um));
    svg.bar("noise", [LEFT, noise[1]], [frame.width, noise[0] - noise[1]], "");
    for y in noise {
        svg.line("noise", [LEFT, y], [WIDTH - RIGHT, y]);
    }
    svg.text("small", [WIDTH - RIGHT + 6.0, 0.5 * (noise[0] + noise[1]) + 4.0], "start", "noise");
    let radius = (step * 0.28).clamp(2.0, 4.5);
    for (k, pose) in poses.iter().enumerate() {
        let x = LEFT + (k as f64 + 0.5) * step;
        let title = pose_title(pose, terms, with_effects);
        if with_effects {
            svg.line("stem", [x, frame.up(pose.identified)], [x, frame.up(pose.after)]);
        }
        if pose.declared <= frame.range[1] {
            let y = frame.up(pose.declared);
            svg.line("declared", [x - 1.3 * radius, y], [x + 1.3 * radius, y]);
        } else {
            // Beyond the figure: a short stroke at its upper edge.
            svg.line("declared", [x, top - 5.0], [x, top + 1.0]);
        }
        if with_effects {
            svg.circle("before", [x, frame.up(pose.identified)], radius, &title);
        }
        svg.circle("after", [x, frame.up(last(pose))], radius, &title);
        if pose.outlying {
            svg.text("small", [x + radius + 4.0, frame.up(last(pose)) + 4.0], "start", "outlier");
        }
    }
    let beyond = poses.iter().any(|pose| pose.declared > frame.range[1]);
    legend(&mut svg, beyond, with_effects);
    pose_axis(&mut svg, poses, top + upper, step);

    if with_effects {
        let largest = poses.iter().map(|pose| pose.contribution).fold(0.0, f64::max);
        let marks = ticks(0.0, largest, 3);
        let frame = Frame { x: LEFT, y: top + upper + gap, width: frame.width, height: lower, range: ends(&marks) };
        frame.grid(&mut svg, &marks, &format!("what the effects written into the robot add [{printed}]"));
        for (k, pose) in poses.iter().enumerate() {
            let x = LEFT + (k as f64 + 0.5) * step;
            let (y, width) = (frame.up(pose.contribution), (step * 0.55).min(12.0));
            let title = format!("{}: {} {printed}", terms.named(&pose.id), decimals(pose.contribution, 1));
            svg.bar("contribution", [x - width / 2.0, y], [width, frame.up(0.0) - y], &title);
        }
        pose_axis(&mut svg, poses, top + upper + gap + lower, step);
    }
    svg.text("axis", [LEFT + frame.width / 2.0, top + upper + gap + lower + 34.0], "middle", place);
    svg.html()
}

fn pose_title(pose: &PoseError, terms: Terms, with_effects: bool) -> String {
    let [declared, identified, after] = [pose.declared, pose.identified, pose.after].map(|um| decimals(um, 1));
    let kept = match (pose.held_out, pose.outlying) {
        (true, false) => ", held out",
        (false, true) => ", with an outlier",
        (true, true) => ", held out, with an outlier",
        (false, false) => "",
    };
    let (name, unit) = (terms.named(&pose.id), terms.printed);
    let last = if with_effects { format!(", after {after} {unit}") } else { String::new() };
    format!("{name}{kept}: declared {declared} {unit}, identified {identified} {unit}{last}")
}

fn legend(svg: &mut Svg, beyond: bool, with_effects: bool) {
    let y = 10.0;
    let mut x = LEFT + 150.0;
    svg.line("declared", [x - 6.0, y], [x + 6.0, y]);
    let declared = if beyond { "as declared (strokes at the top: beyond)" } else { "as declared" };
    svg.text("legend", [x + 12.0, y + 4.0], "start", declared);
    x += if beyond { 270.0 } else { 100.0 };
    for (class, name, width) in models(with_effects) {
        svg.circle(class, [x, y], 4.5, "");
        svg.text("legend", [x + 10.0, y + 4.0], "start", name);
        x += width;
    }
}

/// Class, name and width in the legend of the models that were fitted; without
/// effects there is only one.
fn models(with_effects: bool) -> Vec<(&'static str, &'static str, f64)> {
    let identified = "joints identified again";
    if with_effects {
        vec![("before", identified, 170.0), ("after", "with the effects", 140.0)]
    } else {
        vec![("after", identified, 170.0)]
    }
}

/// Names under the poses, as many as there is room for.
fn pose_axis(svg: &mut Svg, poses: &[PoseError], y: f64, step: f64) {
    let widest = poses.iter().map(|pose| pose.id.chars().count()).max().unwrap_or(1);
    let every = ((widest as f64 * 6.5 + 8.0) / step).ceil().max(1.0) as usize;
    for (k, pose) in poses.iter().enumerate().step_by(every) {
        svg.text("small", [LEFT + (k as f64 + 0.5) * step, y + 14.0], "middle", &pose.id);
    }
}

/// The tips of the residual vectors seen along y and along z.
pub fn residuals(report: &Report) -> String {
    let (side, with_effects) = (360.0, report.has_effects());
    let top = 58.0;
    let mut svg = Svg::new(WIDTH, top + side + 40.0, "Residual vectors before and after in two projections");
    let last = |one: &Residual| if with_effects { one.after } else { one.before };
    let components = report.residuals.iter().flat_map(|one| [one.before, last(one)].concat());
    let largest = components.map(f64::abs).fold(2.0 * report.noise_um, f64::max);
    let marks = ticks(-largest, largest, 6);
    let radius = if report.residuals.len() > 200 { 1.8 } else { 2.8 };
    for (k, (across, up)) in [(0, 1), (0, 2)].into_iter().enumerate() {
        let x = LEFT + k as f64 * (WIDTH - 24.0 - side - LEFT);
        let frame = Frame { x, y: top, width: side, height: side, range: ends(&marks) };
        frame.grid(&mut svg, &marks, &format!("{} [µm]", AXES[up]));
        for &mark in &marks {
            let at = frame.right(mark);
            svg.line(if mark == 0.0 { "zero" } else { "grid" }, [at, top], [at, top + side]);
            svg.text("small", [at, top + side + 14.0], "middle", &tick_label(mark, &marks));
        }
        svg.text("axis", [x + side / 2.0, top + side + 34.0], "middle", &format!("{} [µm]", AXES[across]));
        let tip = |residual: [f64; 3]| [frame.right(residual[across]), frame.up(residual[up])];
        for Residual { before, .. } in report.residuals.iter().filter(|_| with_effects) {
            svg.circle("before", tip(*before), radius, "");
        }
        for residual in &report.residuals {
            svg.circle("after", tip(last(residual)), radius, "");
        }
        let two_sigma = frame.right(2.0 * report.noise_um) - frame.right(0.0);
        let center = [frame.right(0.0), frame.up(0.0)];
        // Dashes alone would be lost among the discs.
        svg.circle("halo", center, two_sigma, "");
        svg.circle("noise", center, two_sigma, "two sigma of the noise");
    }
    let mut x = LEFT + 5.0;
    let noise = ("noise", "noise, two sigma", 0.0);
    for (class, name, width) in models(with_effects).into_iter().chain([noise]) {
        svg.circle(class, [x, 10.0], 4.5, "");
        svg.text("legend", [x + 10.0, 14.0], "start", name);
        x += width;
    }
    svg.html()
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// A bar as long as an error, with marks where the noise is.
pub fn meter(error_um: f64, noise_um: [f64; 2], largest_um: f64) -> String {
    let length = |um: f64| if um.is_finite() && largest_um > 0.0 { (um * 238.0 / largest_um).min(240.0) } else { 0.0 };
    let mut svg = Svg::new(240.0, 12.0, "");
    svg.bar("", [0.0, 2.0], [length(error_um), 8.0], "");
    for noise in noise_um.map(length) {
        svg.line("", [noise, 0.0], [noise, 12.0]);
    }
    svg.decoration("meter")
}

/// A rectangle with the range of values that it spans upwards (and to the
/// right, where both are the same quantity).
pub struct Frame {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
    pub range: [f64; 2],
}

impl Frame {
    pub fn up(&self, value: f64) -> f64 {
        self.y + self.height * (1.0 - self.fraction(value))
    }

    pub fn right(&self, value: f64) -> f64 {
        self.x + self.width * self.fraction(value)
    }

    pub fn fraction(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        if value.is_finite() { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Horizontal lines with their numbers, and what they are over the axis.
    pub fn grid(&self, svg: &mut Svg, marks: &[f64], name: &str) {
        for &mark in marks {
            let y = self.up(mark);
            svg.line(if mark == 0.0 { "zero" } else { "grid" }, [self.x, y], [self.x + self.width, y]);
            svg.text("small", [self.x - 8.0, y + 4.0], "end", &tick_label(mark, marks));
        }
        svg.text("axis", [self.x - LEFT + 12.0, self.y - 12.0], "start", name);
    }
}

pub fn ends(marks: &[f64]) -> [f64; 2] {
    [marks[0], marks[marks.len() - 1]]
}
