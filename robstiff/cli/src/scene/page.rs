//! The page: the scene, its legends, and what moves it.

use robstiff_robots::Description;
use serde_json::Value;

use super::content::{Kind, Pose, Scene, Values};
use super::picture;
use crate::report::SHADES;
use crate::report::html::{Table, data, element, escape, number, page, text, words};
use crate::text::{decimals, significant};

const STYLE: &str = include_str!("scene.css");
/// Kinematics and compliance; how shapes are drawn; which; what moves them.
const SCRIPTS: [&str; 4] =
    [include_str!("arm.js"), include_str!("draw.js"), include_str!("scene.js"), include_str!("controls.js")];

/// The page, with the scene as the scripts read it.
pub fn html(robot: &Description, scene: &Scene, document: &Value) -> String {
    let body = format!(
        "{}<main>\n<div class=\"stage\">\n<canvas id=\"scene\" tabindex=\"0\" role=\"img\" \
         aria-label=\"{}; arrow keys turn it, plus and minus zoom\"></canvas>\n\
         <p id=\"keys\" class=\"live\">Drag or arrow keys turn, wheel or + and − zoom, 0 resets.</p>\n\
         <figure id=\"drawing\">\n{}</figure>\n</div>\n{}{}</main>\n{}{}",
        heading(robot, scene),
        escape(&described(robot, scene)),
        picture::svg(robot, scene),
        legend(scene),
        controls(robot, scene),
        table(scene),
        data("data", document),
    );
    let title = format!("{}: compliance in 3-D", robot.name);
    page(&title, &[SHADES, STYLE].concat(), &body, &format!("\"use strict\";\n{}", SCRIPTS.concat()))
}

fn heading(robot: &Description, scene: &Scene) -> String {
    let mut said = format!("<header>\n{}", text("h1", &robot.name));
    if let Some((passes, verdict)) = scene.values.as_ref().and_then(Values::verdict) {
        said += &format!("<p class=\"verdict {}\">{}</p>\n", if passes { "pass" } else { "fail" }, escape(&verdict));
    }
    if !robot.description.is_empty() {
        said += &text("p", robot.description.trim());
    }
    said + &text("p", &described(robot, scene)) + "</header>\n"
}

/// What is to be seen, in a sentence.
fn described(robot: &Description, scene: &Scene) -> String {
    let what = match scene.kind {
        Kind::Pose => "in one pose".to_owned(),
        Kind::Path => format!("along a path of {} points", scene.rows),
        Kind::Campaign => format!("in the {} poses of a campaign", scene.rows),
    };
    let force = scene.force.map_or_else(String::new, |force| {
        format!(" under a force of ({}) N", force.map(|component| significant(component, 4)).join(", "))
    });
    format!("{} {what}{force}, with the ellipsoids of its compliance at the tool", robot.name)
}

fn legend(scene: &Scene) -> String {
    let mut said = String::from("<div class=\"legend\">\n");
    if let Some(values) = scene.values.as_ref().filter(|_| scene.kind != Kind::Pose) {
        let unit = if values.unit == "um" { "µm" } else { &values.unit };
        let steps: String = (0..10).map(|shade| format!("<span class=\"shade{shade}\"></span>")).collect();
        let [nearest, farthest] = values.sizes();
        let middle = 0.5 * (nearest + farthest);
        let marks: String = [nearest, middle, farthest]
            .map(|value| format!("<span>{}</span>", escape(&significant(value, 3))))
            .concat();
        let heading = if unit.is_empty() { values.name.clone() } else { format!("{} [{unit}]", values.name) };
        said += &format!(
            "<div class=\"scale\">{}<div class=\"bar\" aria-hidden=\"true\">{steps}{}</div>\
             <div class=\"marks\">{marks}</div>\n{}<p>{} where it is {}.</p></div>\n",
            text("h2", &heading),
            tolerance_mark(values),
            tolerance_said(values, unit),
            if scene.kind == Kind::Path { "The line is wider" } else { "The dots are larger" },
            if values.least < 0.0 { "farther from zero" } else { "more" }
        );
    }
    said += &format!(
        "<div>{}<p>Where a force of one size, in every direction, moves the tool: its axes are the softest, the second \
         and the stiffest direction. <span id=\"ellipsoid-scale\"></span></p></div>\n",
        text("h2", "Ellipsoid [µm/N]")
    );
    if scene.poses.iter().any(|pose| pose.rapid) {
        said += &format!(
            "<div>{}<p>The thin grey line: nothing is cut there, and nothing is asked.</p></div>\n",
            text("h2", "Rapids")
        );
    }
    let any = |of: fn(&Pose) -> Option<[f64; 3]>| scene.poses.iter().any(|pose| of(pose).is_some());
    if any(|pose| pose.displacement.or(pose.off)) {
        let arrow = match (any(|pose| pose.off), any(|pose| pose.measured)) {
            (true, _) => "From where the tool is predicted to where it was read, enlarged.",
            (false, true) => "The displacement of the tool, enlarged. Dashed: measured. Full: predicted.",
            (false, false) => "The displacement of the tool, enlarged.",
        };
        said += &format!(
            "<div{}>{}<p>{arrow} <span id=\"arrow-scale\"></span></p></div>\n",
            // The drawing of a path has none.
            if scene.kind == Kind::Path { " class=\"live\"" } else { "" },
            text("h2", "Arrow [µm]")
        );
    }
    said + "</div>\n"
}

/// The tolerance on the bar; at an end where it is beyond all values.
fn tolerance_mark(values: &Values) -> String {
    let [nearest, farthest] = values.sizes();
    let mark = |tolerance: f64| {
        let share = (tolerance - nearest) / (farthest - nearest).max(f64::MIN_POSITIVE);
        // The page allows no style of an element's own.
        let at = decimals(100.0 * share.clamp(0.0, 1.0), 1);
        format!("<svg class=\"limit\"><line x1=\"{at}%\" x2=\"{at}%\" y1=\"0\" y2=\"100%\"/></svg>")
    };
    values.tolerance.map(mark).unwrap_or_default()
}

fn tolerance_said(values: &Values, unit: &str) -> String {
    let said = |tolerance| text("p", &format!("The mark is the tolerance, {} {unit}.", significant(tolerance, 4)));
    values.tolerance.map(said).unwrap_or_default()
}

fn controls(robot: &Description, scene: &Scene) -> String {
    let mut said = String::from("<section class=\"live controls\">\n");
    if scene.poses.len() > 1 {
        said += &format!(
            "<p class=\"row\"><label for=\"row\">{}</label><input id=\"row\" type=\"range\" min=\"0\" max=\"{}\" value=\"0\">\
             <button id=\"play\" type=\"button\">Play</button></p>\n",
            if scene.kind == Kind::Path { "Along the path" } else { "Pose" },
            scene.poses.len() - 1
        );
        if scene.kind == Kind::Path {
            said +=
                "<p><button id=\"near\" type=\"button\" aria-pressed=\"false\">Look at the path alone</button></p>\n";
        }
    }
    said += "<dl id=\"readout\" aria-live=\"polite\"></dl>\n<details><summary>Move the joints</summary>\n";
    for (k, joint) in robot.joints.iter().enumerate() {
        let unit = joint.people_unit();
        said += &format!(
            "<p class=\"row\"><label for=\"q{0}\">q{0} [{unit}]</label><input id=\"q{0}\" class=\"joint\" type=\"range\" \
             step=\"any\"><output for=\"q{0}\"></output></p>\n",
            k + 1
        );
    }
    said += "<p id=\"moved\"></p>\n<p><button id=\"back\" type=\"button\">Back to the given pose</button></p>\n";
    said + "</details>\n</section>\n"
}

/// The first poses as numbers.
fn table(scene: &Scene) -> String {
    const MOST_ROWS: usize = 12;
    let valued = scene.values.as_ref().filter(|_| scene.poses.iter().all(|pose| pose.value.is_some()));
    let mut head = vec![words("pose"), number("x [mm]"), number("y [mm]"), number("z [mm]")];
    head.extend(["softest [µm/N]", "second [µm/N]", "stiffest [µm/N]"].map(number));
    head.extend(valued.map(|values| {
        let unit = if values.unit == "um" { "µm" } else { &values.unit };
        number(if unit.is_empty() { values.name.clone() } else { format!("{} [{unit}]", values.name) })
    }));
    let mut table = Table::new(head);
    let mut worst: Vec<usize> = (0..scene.poses.len()).collect();
    let size = |k: usize| scene.poses[k].size();
    worst.sort_by(|&a, &b| size(b).total_cmp(&size(a)));
    for k in worst.into_iter().take(MOST_ROWS) {
        let pose = &scene.poses[k];
        let tip = pose.points.last().copied().unwrap_or_default();
        let mut cells = vec![words(pose.name.clone().unwrap_or_else(|| (pose.row + 1).to_string()))];
        cells.extend(tip.map(|component| number(decimals(component * 1e3, 1))));
        let principal = pose.principal.map(|principal| principal.map(|value| significant(value, 4)));
        cells.extend(principal.unwrap_or_else(|| std::array::from_fn(|_| "-".to_owned())).map(number));
        cells.extend(valued.map(|_| number(significant(pose.value.unwrap_or_default(), 4))));
        table.row(false, cells);
    }
    let heading = match scene.poses.len() {
        1 => "The pose",
        count if count <= MOST_ROWS => "The poses",
        _ => "The poses, the worst dozen first",
    };
    element("section", text("h2", heading) + &table.html())
}
