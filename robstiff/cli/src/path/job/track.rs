//! The path seen from above and from the side.

use super::content::Job;
use super::thin::{Stroke, strokes};
use crate::report::svg::{Svg, tick_label, ticks};
use crate::text::{decimals, significant};

const WIDTH: f64 = 860.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 76.0;
const BETWEEN: f64 = 56.0;
/// The height of the view from above, and of that from the side, at most.
const HIGHEST: [f64; 2] = [520.0, 240.0];
/// Views are as high at least.
const LOWEST: f64 = 40.0;
/// Strokes of a view.
const MOST_STROKES: usize = 8000;
/// Rapids beyond this part of what is cut are outside of the picture.
const BEYOND: f64 = 0.3;

/// Ranks of strokes: rapids, feeds without a value, then the steps of the scale.
const RAPID: u8 = 0;
const PLAIN: u8 = 1;
const FIRST_SHADE: u8 = 2;
/// The last step of the scale, from 0.
const SHADES: f64 = 9.0;

/// Two of the axes, and the rectangle that shows them.
struct View {
    name: &'static str,
    id: &'static str,
    axes: [usize; 2],
    low: [f64; 2],
    corner: [f64; 2],
    size: [f64; 2],
    per_m: f64,
}

impl View {
    fn at(&self, point: &[f64; 3]) -> [f64; 2] {
        let along = |k: usize| (point[self.axes[k]] - self.low[k]) * self.per_m;
        [self.corner[0] + along(0), self.corner[1] + self.size[1] - along(1)]
    }
}

/// Both views; `worst` are the places that are marked, by their points.
pub fn picture(job: &Job<'_>, worst: Option<usize>) -> String {
    let [low, high] = extent(job);
    let span = |axis: usize| high[axis] - low[axis];
    let room = WIDTH - LEFT - RIGHT;
    let per_m = (room / span(0)).min(HIGHEST[0] / span(1));
    let mut top = TOP;
    let views = [("from above", "above", 1, HIGHEST[0]), ("from the side", "side", 2, HIGHEST[1])];
    let views = views.map(|(name, id, up, highest)| {
        let per_m = per_m.min(highest / span(up));
        let height = (span(up) * per_m).max(LOWEST);
        // In the middle of the room.
        let width = span(0) * per_m;
        let corner = [LEFT + 0.5 * (room - width), top];
        let low = [low[0], low[up] - 0.5 * (height / per_m - span(up))];
        top += height + BETWEEN;
        View { name, id, axes: [0, up], low, corner, size: [width, height], per_m }
    });
    let mut svg =
        Svg::new(WIDTH, top - BETWEEN + 40.0, &format!("The path of {} from above and from the side", job.file));
    let sizes: Vec<Option<f64>> = job.sizes().collect();
    let scale = Scale::of(&sizes);
    if let Some(scale) = &scale {
        legend(&mut svg, job, scale);
    }
    let ranks = ranks(job, &sizes, scale.as_ref());
    for view in &views {
        axes(&mut svg, view);
        svg.raw(&format!("<g clip-path=\"url(#{})\">", view.id));
        stock(&mut svg, view, job);
        let points = job.points.iter().zip(&ranks).map(|(point, rank)| (view.at(&point.at), *rank));
        for (rank, found) in strokes(&points.collect::<Vec<_>>(), MOST_STROKES) {
            let class = match rank {
                RAPID => "track rapid".to_owned(),
                PLAIN => "track plain".to_owned(),
                _ => format!("track shade{0} wide{0}", rank - FIRST_SHADE),
            };
            svg.path(&class, &drawn(&found));
        }
        svg.raw("</g>");
        if let Some(i) = worst {
            svg.circle("worst under", view.at(&job.points[i].at), 8.0, "");
            svg.circle(
                "worst",
                view.at(&job.points[i].at),
                8.0,
                &format!("the worst place, line {}", job.points[i].line),
            );
        }
    }
    svg.html()
}

/// What colours tell apart (m).
struct Scale([f64; 2]);

impl Scale {
    fn of(sizes: &[Option<f64>]) -> Option<Self> {
        let known = || sizes.iter().flatten().copied().filter(|size| size.is_finite());
        let least = known().reduce(f64::min)?;
        Some(Self([least, known().fold(least, f64::max)]))
    }

    fn share(&self, size: f64) -> f64 {
        let Self([least, most]) = self;
        ((size - least) / (most - least).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
    }
}

/// The rank of the way to each point.
fn ranks(job: &Job<'_>, sizes: &[Option<f64>], scale: Option<&Scale>) -> Vec<u8> {
    let shade = |i: usize| Some(FIRST_SHADE + (SHADES * scale?.share(sizes[i]?)).round() as u8);
    let rank = |i: usize| match (job.points[i].rapid, shade(i)) {
        (true, _) => RAPID,
        (false, None) => PLAIN,
        // The worse of both ends.
        (false, Some(rank)) => rank.max(i.checked_sub(1).and_then(shade).unwrap_or(rank)),
    };
    (0..job.points.len()).map(rank).collect()
}

/// The corners of what is shown (m): what is cut, and the rapids that are near it.
fn extent(job: &Job<'_>) -> [[f64; 3]; 2] {
    let block = job
        .stock
        .iter()
        .flat_map(|stock| stock.heights.iter().flat_map(|&z| stock.outline.iter().map(move |&[x, y]| [x, y, z])));
    let cutting = job.points.iter().filter(|point| !point.rapid).map(|point| point.at);
    let mut of_work = cutting.chain(block).peekable();
    let bounds = |of: &mut dyn Iterator<Item = [f64; 3]>| {
        of.fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], |[low, high], at| {
            [std::array::from_fn(|k| at[k].min(low[k])), std::array::from_fn(|k| at[k].max(high[k]))]
        })
    };
    let whole: [[f64; 3]; 2] = bounds(&mut job.points.iter().map(|point| point.at));
    let cut = if of_work.peek().is_some() { bounds(&mut of_work) } else { whole };
    let longest = (0..3).map(|k| cut[1][k] - cut[0][k]).fold(0.0, f64::max).max(1e-3);
    let (beyond, margin) = (BEYOND * longest, 0.03 * longest);
    let low = std::array::from_fn(|k| cut[0][k].min(whole[0][k].max(cut[0][k] - beyond)) - margin);
    let high = std::array::from_fn(|k| cut[1][k].max(whole[1][k].min(cut[1][k] + beyond)) + margin);
    [low, high]
}

/// Strokes as SVG writes them; one that goes on begins nothing.
fn drawn(strokes: &[Stroke]) -> String {
    let short = |value: f64| {
        let text = format!("{value:.1}");
        text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
    };
    let mut path = String::new();
    let mut end = None;
    for [from, to] in strokes {
        if end != Some(*from) {
            path += &format!("M{} {}", short(from[0]), short(from[1]));
        }
        path += &format!("L{} {}", short(to[0]), short(to[1]));
        end = Some(*to);
    }
    path
}

fn axes(svg: &mut Svg, view: &View) {
    let ([x, y], [width, height]) = (view.corner, view.size);
    svg.raw(&format!(
        "<clipPath id=\"{}\"><rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/></clipPath>",
        view.id
    ));
    let marks = |k: usize| {
        let (low, size) = (view.low[k] * 1e3, view.size[k] / view.per_m * 1e3);
        let marks = ticks(low, low + size, (view.size[k] / 70.0).ceil() as usize);
        let labels: Vec<(f64, String)> = marks.iter().map(|&mark| (mark, tick_label(mark, &marks))).collect();
        labels.into_iter().filter(move |(mark, _)| (low..=low + size).contains(mark))
    };
    for (mark, label) in marks(0) {
        let at = x + (mark * 1e-3 - view.low[0]) * view.per_m;
        svg.line("grid", [at, y], [at, y + height]);
        svg.text("small", [at, y + height + 14.0], "middle", &label);
    }
    for (mark, label) in marks(1) {
        let at = y + height - (mark * 1e-3 - view.low[1]) * view.per_m;
        svg.line("grid", [x, at], [x + width, at]);
        svg.text("small", [x - 8.0, at + 4.0], "end", &label);
    }
    let names = view.axes.map(|axis| ["x", "y", "z"][axis]);
    svg.text("legend", [x, y - 10.0], "start", &format!("{}: {} over {} [mm]", view.name, names[1], names[0]));
}

fn stock(svg: &mut Svg, view: &View, job: &Job<'_>) {
    let Some(stock) = &job.stock else { return };
    let [low, high] = stock.heights;
    let top = || stock.outline.iter().map(|&[x, y]| view.at(&[x, y, high]));
    if view.axes == [0, 1] {
        return svg.polygon("stock", top());
    }
    let bottom = stock.outline.iter().map(|&[x, y]| view.at(&[x, y, low]));
    let [from, to] = top().chain(bottom).fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], at| {
        [[0, 1].map(|k| at[k].min(low[k])), [0, 1].map(|k| at[k].max(high[k]))]
    });
    svg.polygon("stock", [from, [to[0], from[1]], to, [from[0], to[1]]]);
}

/// The scale, with the tolerance where it is within.
fn legend(svg: &mut Svg, job: &Job<'_>, scale: &Scale) {
    let (x, y, width, height) = (LEFT, 18.0, 300.0, 10.0);
    let name = if job.has_surface() { "error of the surface, either way" } else { "distance from the path" };
    let name = if job.corrected.is_some() { format!("{name}, without the correction") } else { name.to_owned() };
    svg.text("axis", [x, y - 7.0], "start", &format!("{name} [µm]"));
    let step = width / (SHADES + 1.0);
    for shade in 0..=SHADES as usize {
        svg.bar(&format!("shade{shade}"), [x + step * shade as f64, y], [step, height], "");
    }
    let Scale([least, most]) = scale;
    for share in [0.0, 0.5, 1.0] {
        let said = significant((least + share * (most - least)) * 1e6, 3);
        svg.text(
            "small",
            [x + share * width, y + height + 13.0],
            ["start", "middle", "end"][(share * 2.0) as usize],
            &said,
        );
    }
    let mut from = x + width + 30.0;
    if let Some(tolerance) = job.tolerance {
        if (*least..=*most).contains(&tolerance) {
            let at = x + scale.share(tolerance) * width;
            svg.line("limit", [at, y - 3.0], [at, y + height + 3.0]);
        }
        svg.line("limit", [from, y - 2.0], [from, y + height + 2.0]);
        let said = format!("tolerance {}", decimals(tolerance * 1e6, 1));
        svg.text("axis", [from + 8.0, y + 9.0], "start", &said);
        from += 40.0 + 6.5 * said.len() as f64;
    }
    let mut sign = |class: &str, said: &str| {
        svg.line(class, [from, y + 5.0], [from + 18.0, y + 5.0]);
        svg.text("axis", [from + 24.0, y + 9.0], "start", said);
        from += 46.0 + 6.5 * said.len() as f64;
    };
    sign("rapid", "rapid");
    sign("plain", "no force");
}
