//! What forces do to the tool along a path: told, and written.

use robstiff_machining::compensation::LeftIfWrong;
use robstiff_machining::deviation::{DeviationPoint, Stretch, Summary};
use robstiff_machining::path::lines;
use serde_json::{Value, json};

use super::cutting::{Compared, Corrected, CorrectedPoint, Cutting, WRONG};
use super::stock::Engaged;
use crate::json::{Lazy, number, numbers};
use crate::text::{Table, cell, count, decimals, micrometres};

/// Stretches and elements that a person is shown.
const MOST_SHOWN: usize = 12;

/// What a person is told.
pub fn page(cutting: &Cutting) -> String {
    let points = &cutting.deviation.points;
    let in_cut = cutting.deviation.in_cut().count();
    let over = match points.len() {
        all if in_cut == all => format!("all {}", count(all, "point")),
        all => format!("the {in_cut} of {} with a force", count(all, "point")),
    };
    let mut page = cutting.engaged.as_ref().map(Engaged::page).unwrap_or_default();
    page += &format!("\nDeviation under {} [um], over {over}\n", cutting.name);
    let mut rows = Table::new(1, ["", "mean", "rms", "worst"]);
    let mut row = |name: &str, of: Option<Summary>| {
        // A tool that plunges has no wall, and its feed no normal.
        let cells = of.map_or(["-"; 3].map(String::from), |of| [of.mean, of.rms, of.worst].map(micrometres));
        rows.row([name.to_owned()].into_iter().chain(cells));
    };
    row("distance from the path", cutting.deviation.distances());
    for (axis, name) in ["along the feed", "normal to it", "along the tool axis"].into_iter().enumerate() {
        let along = |point: &DeviationPoint| point.components.map(|found| found[axis]);
        row(name, cutting.deviation.summary(along));
    }
    let judged = if points.iter().any(|point| point.peak.is_some()) { ", peak of a revolution" } else { "" };
    row(&format!("error of the {}{judged}", surface(cutting)), cutting.deviation.errors());
    page += &rows.to_string();
    page += "positive errors are into the part, negative ones leave material";
    if cutting.takes_left && cutting.deviation.errors().is_some() {
        page += &format!(
            ";\n{} does not say on which side the wall is, so left of the tool is taken, as in up milling",
            cutting.name
        );
    }
    page.push('\n');
    if !cutting.undirected.is_empty() {
        page += &format!(
            "no force on {}: the tool plunges or stays in place, and the cut has no direction\n",
            lines(cutting.undirected.iter().copied())
        );
    }
    if let Some((tolerance, stretches)) = &cutting.tolerance {
        page += &verdict(*tolerance, stretches, [cutting.deviation.judged().count(), points.len()]);
    }
    let broken =
        cutting.tolerance.as_ref().is_some_and(|(_, stretches)| stretches.iter().any(|stretch| !stretch.holds));
    let shares = cutting.blame.iter().filter(|(_, share)| share.abs() >= 0.005).take(MOST_SHOWN);
    let shares: Vec<String> = shares.map(|(name, share)| format!("{name} {} %", decimals(share * 100.0, 0))).collect();
    if !shares.is_empty() {
        page += if broken { "there the error comes from " } else { "the error comes from " };
        page += &format!("{}\n", shares.join(", "));
    }
    if let Some(compared) = &cutting.compared {
        let mut rows = Table::new(1, ["", "removed [cm3/min]", "force [N]", "distance [um]", "error [um]"]);
        for one in compared {
            rows.row([
                one.name.clone(),
                one.removal.map_or("-".to_owned(), |rate| decimals(rate * 6e7, 2)),
                decimals(one.force, 1),
                or_none(one.distance),
                or_none(one.error),
            ]);
        }
        page += &format!("\nTwo cuts, at their worst\n{rows}");
    }
    if let Some(corrected) = &cutting.corrected {
        page += &correction(corrected, cutting.deviation.distances().map_or(0.0, |distances| distances.worst));
    }
    page
}

fn or_none(length: Option<f64>) -> String {
    length.map_or("-".to_owned(), micrometres)
}

/// What is machined.
pub fn surface(cutting: &Cutting) -> &'static str {
    if cutting.surface == "side" { "wall" } else { "floor" }
}

/// Whether the tolerance holds, where points are judged, so many of so many.
fn verdict(tolerance: f64, stretches: &[Stretch], [judged, all]: [usize; 2]) -> String {
    let limit = format!("tolerance {} um", decimals(tolerance * 1e6, 1));
    let broken: Vec<&Stretch> = stretches.iter().filter(|stretch| !stretch.holds).collect();
    if judged == 0 {
        return format!("\n{limit}: no point has an error to judge\n");
    }
    if broken.is_empty() {
        let of = if judged == all { "all along".to_owned() } else { format!("at the {judged} of {all} points judged") };
        return format!("\n{limit}: holds {of}\n");
    }
    // Only points that are judged can break it.
    let bad: usize = broken.iter().map(|stretch| stretch.points[1] - stretch.points[0] + 1).sum();
    let of = if judged == all { count(all, "point") } else { format!("the {judged} points judged, of {all}") };
    let mut text = format!("\n{limit}: broken at {bad} of {of}\n");
    for stretch in broken.iter().take(MOST_SHOWN) {
        let [from, to] = stretch.s.map(|s| decimals(s * 1e3, 1));
        let [first, last] = stretch.lines;
        let place = if first == last {
            format!("line {first}, s = {from} mm")
        } else {
            format!("lines {first} to {last}, s = {from} to {to} mm")
        };
        text += &format!("  {place}: worst {} um\n", or_none(stretch.worst));
    }
    if broken.len() > MOST_SHOWN {
        text += &format!("  and {} more\n", broken.len() - MOST_SHOWN);
    }
    text
}

fn correction(corrected: &Corrected, before: f64) -> String {
    let worst = corrected.points.iter().map(|point| point.remaining).fold(0.0, f64::max);
    let rounds = count(corrected.rounds, "round");
    let mut text = format!(
        "\nCorrected in at most {rounds}: of {} um at the worst, {} um are left if the model is true\n",
        micrometres(before),
        decimals(worst * 1e6, 3)
    );
    let per_cent = |left: LeftIfWrong| [left.rms, left.worst].map(|part| decimals(part * 100.0, 1));
    let wrong = decimals(WRONG * 100.0, 0);
    let heads = [
        "true compliance".to_owned(),
        format!("+{wrong} %: rms"),
        "worst".to_owned(),
        format!("-{wrong} %: rms"),
        "worst".to_owned(),
    ];
    let mut rows = Table::new(1, heads);
    let sensitivity = &corrected.sensitivity;
    let each = corrected.elements.iter().map(String::as_str).zip(&sensitivity.each);
    for (name, [softer, stiffer]) in [("of all", &sensitivity.all)].into_iter().chain(each) {
        rows.row([name.to_owned()].into_iter().chain(per_cent(*softer)).chain(per_cent(*stiffer)));
    }
    text += &format!("left of the deviation [%] if the model is not true\n{rows}");
    text
}

/// What some point has, so that there are columns for it.
#[derive(Clone, Copy)]
pub struct Columns {
    moments: bool,
    peaks: bool,
}

impl Columns {
    pub fn of(cutting: &Cutting) -> Self {
        let points = &cutting.deviation.points;
        let has_moment = |k: usize| acting(cutting, k).iter().skip(3).any(|moment| *moment != 0.0);
        Self { moments: (0..points.len()).any(has_moment), peaks: points.iter().any(|point| point.peak.is_some()) }
    }
}

/// The columns of `--out`, after those of the path.
pub fn columns(cutting: &Cutting, has: Columns) -> String {
    let mut columns = if cutting.engaged.is_some() { "ae [mm],ap [mm],".to_owned() } else { String::new() };
    columns += "Fx [N],Fy [N],Fz [N],";
    if has.moments {
        columns += "Mx [Nm],My [Nm],Mz [Nm],";
    }
    columns += "deviation [um],along [um],normal [um],axial [um],error [um]";
    if has.peaks {
        columns += ",peak [um]";
    }
    if cutting.corrected.is_some() {
        columns += ",dx [um],dy [um],dz [um],remaining [um]";
    }
    columns
}

/// The wrench on the tool at a point, on the corrected path where there is one: it is written
/// beside what to command.
fn acting(cutting: &Cutting, index: usize) -> [f64; 6] {
    match &cutting.corrected {
        Some(corrected) => corrected.points[index].wrench,
        None => cutting.deviation.points[index].wrench.into(),
    }
}

/// Their cells at a point; empty where there is no direction or surface.
pub fn cells(cutting: &Cutting, has: Columns, index: usize) -> String {
    let point = &cutting.deviation.points[index];
    let wrench = acting(cutting, index).into_iter().take(if has.moments { 6 } else { 3 });
    let mut cells: Vec<String> = cutting.engaged.iter().map(|engaged| engaged.cells(index)).collect();
    cells.extend(wrench.map(|component| cell(component, 4)));
    let along = |axis: usize| point.components.map(|components| components[axis]);
    let lengths = [Some(point.distance()), along(0), along(1), along(2), point.error];
    let micro = |length: Option<f64>| length.map_or_else(String::new, |length| cell(length * 1e6, 4));
    cells.extend(lengths.map(micro));
    if has.peaks {
        cells.push(micro(point.peak));
    }
    if let Some(corrected) = &cutting.corrected {
        let point = &corrected.points[index];
        cells.extend(point.correction.map(|length| cell(length * 1e6, 4)));
        cells.push(cell(point.remaining * 1e6, 6));
    }
    cells.join(",")
}

fn summary(of: Option<Summary>) -> Value {
    of.map_or(
        Value::Null,
        |of| json!({"mean_m": number(of.mean), "rms_m": number(of.rms), "worst_m": number(of.worst)}),
    )
}

/// Everything in SI units.
pub fn document(cutting: &Cutting) -> Lazy<'_> {
    let tolerance = cutting.tolerance.as_ref().map(|(tolerance, stretches)| {
        json!({
            "tolerance_m": number(*tolerance),
            // Where nothing is judged nobody can tell.
            "holds": cutting.deviation.errors().map(|_| stretches.iter().all(|stretch| stretch.holds)),
            "judged": cutting.deviation.judged().count(),
            "stretches": stretches.iter().map(|stretch| json!({
                "lines": stretch.lines,
                "s_m": numbers(stretch.s),
                "holds": stretch.holds,
                "worst_m": stretch.worst.map(number),
            })).collect::<Value>(),
        })
    });
    let share = |(name, share): &(String, f64)| json!({"element": name, "share": number(*share)});
    let compared = |one: &Compared| {
        json!({
            "cut": one.name,
            "removal_m3_per_s": one.removal.map(number),
            "force_n": number(one.force),
            "distance_m": one.distance.map(number),
            "error_m": one.error.map(number),
        })
    };
    Lazy::Fields(vec![
        ("forces", json!(cutting.name).into()),
        ("surface", json!(cutting.surface).into()),
        ("engagement", cutting.engaged.as_ref().map_or(Lazy::Value(Value::Null), Engaged::document)),
        ("points_with_force", json!(cutting.deviation.in_cut().count()).into()),
        ("distance", summary(cutting.deviation.distances()).into()),
        ("error", summary(cutting.deviation.errors()).into()),
        ("points", Lazy::list(&cutting.deviation.points, point)),
        ("lines_without_direction", json!(cutting.undirected).into()),
        ("tolerance", json!(tolerance).into()),
        ("shares", cutting.blame.iter().map(share).collect::<Value>().into()),
        ("compared", json!(cutting.compared.as_ref().map(|cuts| cuts.iter().map(compared).collect::<Value>())).into()),
        ("corrected", cutting.corrected.as_ref().map_or(Lazy::Value(Value::Null), corrected)),
    ])
}

fn point(point: &DeviationPoint) -> Value {
    json!({
        "line": point.line,
        "wrench": numbers(point.wrench.iter().copied()),
        "displacement": numbers(point.displacement.iter().copied()),
        "feed_normal_axis_m": point.components.map(|components| numbers(components.iter().copied())),
        "error_m": point.error.map(number),
        "peak_m": point.peak.map(number),
    })
}

fn corrected(corrected: &Corrected) -> Lazy<'_> {
    let left = |[softer, stiffer]: &[LeftIfWrong; 2]| {
        let one = |left: &LeftIfWrong| json!({"rms": number(left.rms), "worst": number(left.worst)});
        json!({"softer": one(softer), "stiffer": one(stiffer)})
    };
    let point = |point: &CorrectedPoint| {
        json!({
            "q": numbers(point.q.iter().copied()),
            "position_m": numbers((0..3).map(|axis| point.pose[(axis, 3)])),
            "quaternion_wxyz": numbers(super::quaternion(&point.pose)),
            "wrench": numbers(point.wrench),
            "correction_m": numbers(point.correction),
            "remaining_m": number(point.remaining),
            "rounds": point.rounds,
        })
    };
    let if_wrong = json!({
        "by": WRONG,
        "all": left(&corrected.sensitivity.all),
        "each": corrected.elements.iter().zip(&corrected.sensitivity.each).map(|(element, both)| json!({
            "element": element, "left": left(both),
        })).collect::<Value>(),
    });
    Lazy::Fields(vec![
        ("rounds", json!(corrected.rounds).into()),
        ("points", Lazy::list(&corrected.points, point)),
        ("left_if_wrong", if_wrong.into()),
    ])
}
