//! The arm in its poses, with the residual at the tool as arrows: before on the
//! left, after on the right, on one scale.

use super::content::{Arm, Report};
use super::svg::{Svg, ticks};
use crate::text::decimals;

const WIDTH: f64 = 860.0;
/// One panel, and the room between two.
const PANEL: f64 = 400.0;
const GAP: f64 = WIDTH - 2.0 * PANEL;
const TOP: f64 = 34.0;
/// More arms than these hide each other; arrows are drawn of all poses.
const MOST_ARMS: usize = 24;

/// A view: which component goes to the right, which up, and its name.
type View = (usize, usize, &'static str);

/// The figure and its caption.
pub fn figure(report: &Report) -> (String, String) {
    let arms: Vec<&Arm> = report.arms.iter().filter(|arm| is_finite(arm)).collect();
    let with_effects = report.has_effects();
    let spread = |axis: usize| {
        let tips = || arms.iter().filter_map(|arm| arm.points.last()).map(|tip| tip[axis]);
        tips().fold(f64::MIN, f64::max) - tips().fold(f64::MAX, f64::min)
    };
    // From the side where the tool is seen to move most.
    let across = usize::from(spread(1) > spread(0));
    let names = ["x", "y"];
    let side = ["from the side, x and z", "from the side, y and z"][across];
    let views: [View; 2] = [(0, 1, "from above, x and y"), (across, 2, side)];
    let scenes: Vec<Scene> = views.iter().map(|&view| Scene::new(&arms, view)).collect();
    let height: f64 = scenes.iter().map(|scene| scene.height + TOP + 10.0).sum();
    let mut svg = Svg::new(WIDTH, height + 30.0, "The arm in its poses with its residuals before and after");

    let length = |residual: &[f64; 3]| residual.iter().map(|um| um * um).sum::<f64>().sqrt();
    let largest = arms.iter().map(|arm| length(&arm.before)).fold(0.0, f64::max);
    let worst = arms.iter().position(|arm| length(&arm.before) >= largest);
    let scale = Scale::new(largest.max(report.noise_um));
    let mut y = 0.0;
    for scene in &scenes {
        let after = if with_effects { "with the effects" } else { "" };
        for (k, name) in ["joints identified again", after].into_iter().enumerate().filter(|(_, name)| !name.is_empty())
        {
            let corner = [k as f64 * (PANEL + GAP), y + TOP];
            svg.text("axis", [corner[0], y + 18.0], "start", &format!("{name}, {}", scene.view.2));
            scene.draw(&mut svg, corner, &arms, worst, k == 1, scale.per_um);
        }
        y += scene.height + TOP + 10.0;
    }
    let bar = scale.bar_um * scale.per_um;
    svg.arrow("arrow before", [0.0, y + 12.0], [bar, y + 12.0]);
    svg.text("legend", [bar + 10.0, y + 16.0], "start", &format!("{} µm", decimals(scale.bar_um, 0)));
    let drawn = worst.and_then(|worst| arms.get(worst)).map_or_else(String::new, |arm| {
        format!(" Drawn strong: pose {}, where the error was largest; the square is its foot.", arm.id)
    });
    let rows = "The arrows are the residuals at the tool, in each pose that of its largest load; a dot is a \
                small one. Axes of the base frame";
    let caption = format!("{rows}: to the right {} or {}, up y or z.{drawn}", names[0], names[across]);
    let caption = caption.replace("x or x", "x");
    (svg.html(), caption)
}

fn is_finite(arm: &Arm) -> bool {
    let numbers = arm.points.iter().flatten().chain(&arm.before).chain(&arm.after);
    arm.points.len() > 1 && numbers.into_iter().all(|number| number.is_finite())
}

/// How long arrows are.
struct Scale {
    per_um: f64,
    /// A round residual for the legend.
    bar_um: f64,
}

impl Scale {
    /// The largest residual as a fifth of a panel.
    fn new(largest_um: f64) -> Self {
        let largest_um = if largest_um.is_finite() && largest_um > 0.0 { largest_um } else { 1.0 };
        let bar_um = ticks(0.0, largest_um, 3).get(1).copied().unwrap_or(1.0);
        Self { per_um: PANEL / 5.0 / largest_um, bar_um }
    }
}

/// The arms in one view.
struct Scene {
    view: View,
    /// The lower left corner (m).
    low: [f64; 2],
    /// Pixels a metre.
    per_m: f64,
    height: f64,
}

impl Scene {
    fn new(arms: &[&Arm], view: View) -> Self {
        let (across, up, _) = view;
        let ends = |axis: usize| {
            let all = || arms.iter().flat_map(|arm| &arm.points).map(|point| point[axis]);
            [all().fold(0.0, f64::min), all().fold(0.0, f64::max)]
        };
        let ([left, right], [bottom, top]) = (ends(across), ends(up));
        // Room for the arrows around the outermost tool.
        let margin = 0.12 * (right - left).max(top - bottom).max(1e-3);
        let (width, height) = (right - left + 2.0 * margin, top - bottom + 2.0 * margin);
        let per_m = PANEL / width.max(height);
        Self { view, low: [0.5 * (left + right) - 0.5 * PANEL / per_m, bottom - margin], per_m, height: height * per_m }
    }

    fn draw(&self, svg: &mut Svg, corner: [f64; 2], arms: &[&Arm], worst: Option<usize>, after: bool, per_um: f64) {
        let (across, up, _) = self.view;
        let at = |point: &[f64; 3]| {
            let right = corner[0] + (point[across] - self.low[0]) * self.per_m;
            [right, corner[1] + self.height - (point[up] - self.low[1]) * self.per_m]
        };
        let stride = arms.len().div_ceil(MOST_ARMS).max(1);
        for arm in arms.iter().step_by(stride) {
            svg.polyline("arm", arm.points.iter().map(at));
        }
        if let Some(arm) = worst.and_then(|worst| arms.get(worst)) {
            svg.polyline("arm strong", arm.points.iter().map(at));
            for point in &arm.points[1..] {
                svg.circle("joint", at(point), 3.0, "");
            }
            let foot = at(&arm.points[0]);
            svg.bar("foot", [foot[0] - 5.0, foot[1] - 5.0], [10.0, 10.0], "");
        }
        for tip in arms.iter().filter_map(|arm| Some((arm, at(arm.points.last()?)))) {
            let (arm, [x, y]) = tip;
            let residual = if after { arm.after } else { arm.before };
            let class = if after { "arrow after" } else { "arrow before" };
            svg.arrow(class, [x, y], [x + residual[across] * per_um, y - residual[up] * per_um]);
        }
    }
}
