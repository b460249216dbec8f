//! Figures as SVG: shapes with classes that the style sheet draws, so that one
//! figure serves light, dark and paper.

use std::fmt::Write as _;

use super::html::escape;

/// How long the head of an arrow is.
const HEAD: f64 = 5.0;

/// A figure under construction, in pixels from the top left.
pub struct Svg {
    width: f64,
    height: f64,
    label: String,
    body: String,
}

impl Svg {
    /// An empty figure; `label` is read out in place of it.
    pub fn new(width: f64, height: f64, label: &str) -> Self {
        Self { width, height, label: escape(label), body: String::new() }
    }

    /// A straight line.
    pub fn line(&mut self, class: &str, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) {
        self.push(format_args!(
            "<line class=\"{class}\" x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\"/>"
        ));
    }

    /// A line through several points.
    pub fn polyline(&mut self, class: &str, points: impl IntoIterator<Item = [f64; 2]>) {
        let points: Vec<String> = points.into_iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        self.push(format_args!("<polyline class=\"{class}\" points=\"{}\"/>", points.join(" ")));
    }

    /// An area between several points.
    pub fn polygon(&mut self, class: &str, points: impl IntoIterator<Item = [f64; 2]>) {
        let points: Vec<String> = points.into_iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        self.push(format_args!("<polygon class=\"{class}\" points=\"{}\"/>", points.join(" ")));
    }

    /// An arrow; one shorter than its head is a dot.
    pub fn arrow(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let length = dx.hypot(dy);
        if length < HEAD {
            return self.circle("dot", from, 1.2, "");
        }
        let [ux, uy] = [dx / length * HEAD, dy / length * HEAD];
        let barb = |side: f64| [to[0] - ux + 0.5 * side * uy, to[1] - uy - 0.5 * side * ux];
        self.polyline(class, [from, to, barb(1.0), to, barb(-1.0)]);
    }

    /// A disc or ring, with what shows when it is pointed at.
    pub fn circle(&mut self, class: &str, [x, y]: [f64; 2], radius: f64, title: &str) {
        self.titled(format_args!("circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\""), title);
    }

    /// A bar, with what shows when it is pointed at.
    pub fn bar(&mut self, class: &str, [x, y]: [f64; 2], [width, height]: [f64; 2], title: &str) {
        let shape =
            format!("rect class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"");
        self.titled(format_args!("{shape}"), title);
    }

    /// A word; `anchor` is `start`, `middle` or `end`.
    pub fn text(&mut self, class: &str, [x, y]: [f64; 2], anchor: &str, text: &str) {
        let text = escape(text);
        self.push(format_args!(
            "<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{text}</text>"
        ));
    }

    /// Lines and areas as SVG writes a path.
    pub fn path(&mut self, class: &str, path: &str) {
        self.push(format_args!("<path class=\"{class}\" d=\"{path}\"/>"));
    }

    /// A picture whose pixels are shown as squares; `source` is a data URI.
    pub fn image(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], source: &str) {
        self.push(format_args!(
            "<image class=\"cells\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
             preserveAspectRatio=\"none\" href=\"{source}\"/>"
        ));
    }

    /// Elements as they are.
    pub fn raw(&mut self, elements: &str) {
        self.push(format_args!("{elements}"));
    }

    /// The figure as a file of its own.
    pub fn document(&self, style: &str) -> String {
        let Self { width, height, label, body } = self;
        format!(
            "<svg viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\" role=\"img\" \
             aria-label=\"{label}\" xmlns=\"http://www.w3.org/2000/svg\">\n<style>\n{style}</style>\n{body}</svg>\n"
        )
    }

    /// The figure as an element.
    pub fn html(&self) -> String {
        let Self { width, height, label, body } = self;
        format!(
            "<svg viewBox=\"0 0 {width:.0} {height:.0}\" role=\"img\" aria-label=\"{label}\" \
             xmlns=\"http://www.w3.org/2000/svg\">\n{body}</svg>\n"
        )
    }

    /// The figure as a file of its own, with a style sheet of its own.
    pub fn file(&self, style: &str) -> String {
        let figure = self.html();
        let (start, body) = figure.split_once('\n').expect("the element begins in a line of its own");
        format!("{start}\n{style}{body}")
    }

    /// The figure as an element that only repeats what stands beside it.
    pub fn decoration(&self, class: &str) -> String {
        let Self { width, height, body, .. } = self;
        format!(
            "<svg class=\"{class}\" viewBox=\"0 0 {width:.0} {height:.0}\" preserveAspectRatio=\"none\" aria-hidden=\"true\">\n{body}</svg>\n"
        )
    }

    fn titled(&mut self, shape: std::fmt::Arguments<'_>, title: &str) {
        match shape.to_string() {
            shape if title.is_empty() => self.push(format_args!("<{shape}/>")),
            shape => {
                let name = shape.split(' ').next().unwrap_or_default();
                self.push(format_args!("<{shape}><title>{}</title></{name}>", escape(title)));
            }
        }
    }

    fn push(&mut self, element: std::fmt::Arguments<'_>) {
        writeln!(self.body, "{element}").expect("a string takes any text");
    }
}

/// Round numbers from 0 or below up to what covers `largest`, about `count` of
/// them.
pub fn ticks(smallest: f64, largest: f64, count: usize) -> Vec<f64> {
    let span = largest - smallest;
    if !(span.is_finite() && span > 0.0) {
        return vec![0.0, 1.0];
    }
    let rough = span / count.max(1) as f64;
    let power = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().map(|m| m * power).find(|step| *step >= rough * 0.999);
    let step = step.unwrap_or(power * 10.0);
    let (first, last) = ((smallest / step).floor() as i64, (largest / step).ceil() as i64);
    (first..=last).map(|k| k as f64 * step).collect()
}

/// A number at an axis: no more digits than the step needs.
pub fn tick_label(value: f64, ticks: &[f64]) -> String {
    let step = ticks.get(1).map_or(1.0, |second| second - ticks[0]);
    // One digit more where the step is 2.5 of something. What rounding leaves of a difference
    // is neither a digit nor the next power of ten.
    let exponent = (step.log10() + 1e-9).floor();
    let leading = step / 10_f64.powf(exponent);
    let odd = (leading - leading.round()).abs() > 1e-6;
    let decimals = (-exponent).max(0.0) as usize + usize::from(odd && exponent <= 0.0);
    crate::text::decimals(value, decimals)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_cover() {
        assert_eq!(ticks(0.0, 93.0, 5), [0.0, 20.0, 40.0, 60.0, 80.0, 100.0]);
        assert_eq!(ticks(-7.0, 7.0, 4), [-10.0, -5.0, 0.0, 5.0, 10.0]);
        assert_eq!(ticks(0.0, 0.0, 5), [0.0, 1.0]);
        assert_eq!(ticks(0.0, f64::NAN, 5), [0.0, 1.0]);
        let fine = ticks(0.0, 0.9, 4);
        assert_eq!(
            fine.iter().map(|&tick| tick_label(tick, &fine)).collect::<Vec<_>>(),
            ["0.00", "0.25", "0.50", "0.75", "1.00"]
        );
        // 0.4 - 0.3 is not quite 0.1, nor is 0.7 - 0.6.
        for smallest in [0.3, 0.6] {
            let steps = [smallest, smallest + 0.1, smallest + 0.2];
            assert!(steps.iter().all(|&tick| tick_label(tick, &steps).len() == 3), "{smallest}");
        }
    }
}
