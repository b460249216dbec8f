//! The scene as a drawing, for paper and for readers without scripts: seen in
//! parallel projection from the front left, shapes with classes that the style
//! sheet draws.

use robstiff_robots::Description;

use super::content::{Kind, Pose, Scene, length};
use crate::report::svg::{Svg, ticks};
use crate::text::significant;

const WIDTH: f64 = 860.0;
const HEIGHT: f64 = 560.0;
const MARGIN: f64 = 46.0;
/// Where the eye is: turned about z from x, and above the floor (rad).
const TURN: f64 = -0.9;
const HEIGHT_ANGLE: f64 = 0.38;
/// More ellipsoids than these hide each other.
const MOST_ELLIPSOIDS: usize = 9;
/// A path that is shorter is a place (m).
const LEAST_EXTENT: f64 = 1e-3;
/// The last colour and the last width of the scale, from 0.
const SHADES: f64 = 9.0;

/// The drawing.
pub fn svg(robot: &Description, scene: &Scene) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT, &format!("{} seen from the front left", robot.name));
    let per_unit = ellipsoid_scale(scene);
    let view = View::new(scene, per_unit);
    floor(&mut svg, &view);
    let Some(shown) = shown(scene) else { return svg.html() };
    arm(&mut svg, &view, shown);
    let stride = scene.poses.len().div_ceil(MOST_ELLIPSOIDS);
    for pose in scene.poses.iter().step_by(stride).filter(|_| scene.poses.len() > 1) {
        ellipsoid(&mut svg, "ellipsoid faint", &view, pose, per_unit);
    }
    ellipsoid(&mut svg, "ellipsoid", &view, shown, per_unit);
    path(&mut svg, &view, scene);
    let per_um = displacements(&mut svg, &view, scene);
    let mut scales = vec![format!("floor squares of {} m", significant(view.step, 3))];
    if shown.principal.is_some() {
        scales.push(format!("ellipsoids: 1 µm/N is {} mm", significant(per_unit * 1e3, 3)));
    }
    scales.extend(per_um.map(|per_um| format!("arrows: {} times their length", significant(per_um * 1e6, 3))));
    svg.text("axis", [WIDTH, HEIGHT - 8.0], "end", &scales.join("; "));
    svg.html()
}

/// The pose that the arm stands in: the worst.
fn shown(scene: &Scene) -> Option<&Pose> {
    scene.poses.iter().max_by(|a, b| a.size().total_cmp(&b.size()))
}

/// Metres a um/N: the longest semi-axis is at most a sixth of the arm, and no ellipsoid is
/// longer than the path.
fn ellipsoid_scale(scene: &Scene) -> f64 {
    let longest = scene.poses.iter().filter_map(|pose| pose.principal).map(|[softest, ..]| softest).fold(0.0, f64::max);
    let most = (reach(scene) / 6.0).min(extent(scene).map_or(f64::INFINITY, |extent| extent / 2.0));
    if longest > 0.0 { round(most / longest) } else { 0.0 }
}

/// From corner to corner of the box that a path is in (m); nothing where it stays in one place.
fn extent(scene: &Scene) -> Option<f64> {
    let tips = || scene.poses.iter().filter_map(|pose| pose.points.last());
    let side = |axis: usize| {
        let low = tips().fold(f64::INFINITY, |low, tip| low.min(tip[axis]));
        tips().fold(low, |high, tip| high.max(tip[axis])) - low
    };
    let extent = length(std::array::from_fn(side));
    (scene.kind == Kind::Path && extent > LEAST_EXTENT).then_some(extent)
}

/// The next round number below.
fn round(value: f64) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|step| step * power).find(|&step| step <= value).unwrap_or(power)
}

/// The length of the arm along its links (m).
fn reach(scene: &Scene) -> f64 {
    let Some(pose) = scene.poses.first() else { return 1.0 };
    let links = pose.points.windows(2).map(|ends| length(std::array::from_fn(|k| ends[1][k] - ends[0][k])));
    links.sum::<f64>().max(1e-3)
}

/// A parallel projection, and where it puts the scene.
struct View {
    corner: [f64; 2],
    per_m: f64,
    /// The square of the floor grid (m), and its first and last lines.
    step: f64,
    lines: [[f64; 2]; 2],
}

impl View {
    /// So that all poses and their ellipsoids, of `per_unit` m a um/N, are in it.
    fn new(scene: &Scene, per_unit: f64) -> Self {
        let reach = reach(scene);
        let points = || scene.poses.iter().flat_map(|pose| &pose.points);
        let step = ticks(0.0, reach, 8).get(1).copied().unwrap_or(0.5);
        let ends = |axis: usize| {
            let low = points().fold(0.0_f64, |low, point| low.min(point[axis]));
            let high = points().fold(0.0_f64, |high, point| high.max(point[axis]));
            [(low / step - 0.3).floor() * step, (high / step + 0.3).ceil() * step]
        };
        let lines = [ends(0), ends(1)];
        let corners = lines[0].into_iter().flat_map(|x| lines[1].map(|y| [x, y, 0.0]));
        let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let mut include = |point: [f64; 2], half: [f64; 2]| {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis] - half[axis]);
                high[axis] = high[axis].max(point[axis] + half[axis]);
            }
        };
        corners.chain(points().copied()).for_each(|point| include(flat(point), [0.0; 2]));
        for pose in &scene.poses {
            let [[xx, _], [_, yy]] = outline(pose, per_unit);
            include(flat(pose.points.last().copied().unwrap_or_default()), [xx, yy].map(f64::sqrt));
        }
        let per_m = ((WIDTH - 2.0 * MARGIN) / (high[0] - low[0])).min((HEIGHT - 2.0 * MARGIN) / (high[1] - low[1]));
        let centre = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
        Self { corner: [0.5 * WIDTH - centre[0] * per_m, 0.5 * HEIGHT + centre[1] * per_m], per_m, step, lines }
    }

    fn at(&self, point: [f64; 3]) -> [f64; 2] {
        let [right, up] = flat(point);
        [self.corner[0] + right * self.per_m, self.corner[1] - up * self.per_m]
    }
}

/// To the right and up in the picture.
fn flat([x, y, z]: [f64; 3]) -> [f64; 2] {
    let (sin, cos) = TURN.sin_cos();
    let (tilt, level) = HEIGHT_ANGLE.sin_cos();
    [y * cos - x * sin, z * level - (x * cos + y * sin) * tilt]
}

fn floor(svg: &mut Svg, view: &View) {
    let [[x1, x2], [y1, y2]] = view.lines;
    let count = |low: f64, high: f64| ((high - low) / view.step).round() as i32;
    for k in 0..=count(x1, x2) {
        let x = x1 + f64::from(k) * view.step;
        svg.line("grid", view.at([x, y1, 0.0]), view.at([x, y2, 0.0]));
    }
    for k in 0..=count(y1, y2) {
        let y = y1 + f64::from(k) * view.step;
        svg.line("grid", view.at([x1, y, 0.0]), view.at([x2, y, 0.0]));
    }
    for (name, axis) in [("x", 0), ("y", 1), ("z", 2)] {
        let mut end = [0.0; 3];
        end[axis] = view.step;
        svg.arrow("arrow axis", view.at([0.0; 3]), view.at(end));
        let [x, y] = view.at(end.map(|component| component * 1.12));
        svg.text("axis", [x, y + 4.0], "middle", name);
    }
}

fn arm(svg: &mut Svg, view: &View, pose: &Pose) {
    let points: Vec<[f64; 2]> = pose.points.iter().map(|&point| view.at(point)).collect();
    let [.., flange, tcp] = points[..] else { return };
    svg.polyline("link", points[..points.len() - 1].iter().copied());
    svg.polyline("tool", [flange, tcp]);
    // Of each joint the point where its axis begins.
    for (number, &[x, y]) in (1..).zip(points[..points.len() - 2].iter().step_by(2)) {
        svg.circle("joint", [x, y], 6.0, &format!("joint {number}"));
    }
}

fn path(svg: &mut Svg, view: &View, scene: &Scene) {
    let Some(values) = &scene.values else { return };
    // Errors have signs: what is far from zero is bad either way.
    let [nearest, farthest] = values.sizes();
    let step = |size: f64| (SHADES * (size - nearest) / (farthest - nearest).max(f64::MIN_POSITIVE)).round();
    let shade = |pose: &Pose| step(pose.value.map_or(nearest, f64::abs));
    for pair in scene.poses.windows(2).filter(|_| scene.kind == Kind::Path) {
        let [one, other] = [&pair[0], &pair[1]].map(|pose| pose.points.last().copied().unwrap_or_default());
        if pair[1].rapid {
            svg.line("path rapid", view.at(one), view.at(other));
            continue;
        }
        let worse = shade(&pair[0]).max(shade(&pair[1]));
        svg.line(&format!("path shade{worse:.0} wide{worse:.0}"), view.at(one), view.at(other));
    }
    for pose in scene.poses.iter().filter(|_| scene.kind == Kind::Campaign) {
        let at = view.at(pose.points.last().copied().unwrap_or_default());
        svg.circle(&format!("spot shade{:.0}", shade(pose)), at, 4.5, pose.name.as_deref().unwrap_or_default());
    }
}

/// The outline of the ellipsoid of displacements under forces of one size: the
/// image of the unit sphere under the compliance, projected, is that of the unit
/// circle under the root of `B B^T`, `B` the projection of the compliance. This is
/// `B B^T`; the roots of its diagonal are half the outline's width and height.
fn outline(pose: &Pose, scale: f64) -> [[f64; 2]; 2] {
    let [xx, yy, zz, xy, xz, yz] = pose.compliance.map(|entry| entry * scale);
    let columns = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(flat);
    let product = |i: usize, j: usize| columns.iter().map(|column| column[i] * column[j]).sum::<f64>();
    [[product(0, 0), product(0, 1)], [product(1, 0), product(1, 1)]]
}

fn ellipsoid(svg: &mut Svg, class: &str, view: &View, pose: &Pose, per_unit: f64) {
    let [[xx, xy], [_, yy]] = outline(pose, per_unit * view.per_m);
    // The factor of Cholesky is as good a root as any.
    let first = xx.sqrt().max(f64::MIN_POSITIVE);
    let below = xy / first;
    let second = (yy - below * below).max(0.0).sqrt();
    let [x, y] = view.at(pose.points.last().copied().unwrap_or_default());
    let outline = (0..=48).map(|k| {
        let (sin, cos) = (f64::from(k) / 48.0 * core::f64::consts::TAU).sin_cos();
        [x + first * cos, y - below * cos - second * sin]
    });
    svg.polyline(class, outline);
}

/// The displacements as arrows; metres a um, where there are any.
fn displacements(svg: &mut Svg, view: &View, scene: &Scene) -> Option<f64> {
    let all = || scene.poses.iter().flat_map(|pose| [pose.displacement, pose.measured, pose.off]).flatten();
    let largest = all().map(length).fold(0.0, f64::max);
    if largest == 0.0 || scene.kind == Kind::Path {
        return None;
    }
    let per_um = round(reach(scene) / 7.0 / largest * 1e6) / 1e6;
    for pose in &scene.poses {
        let tip = pose.points.last().copied().unwrap_or_default();
        for (class, arrow) in
            [("arrow before", pose.measured), ("arrow after", pose.displacement), ("arrow after", pose.off)]
        {
            let Some(arrow) = arrow else { continue };
            let end = std::array::from_fn(|k| tip[k] + arrow[k] * per_um);
            svg.arrow(class, view.at(tip), view.at(end));
        }
    }
    Some(per_um)
}
