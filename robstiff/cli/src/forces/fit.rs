//! `robstiff forces --fit`: cutting coefficients from recorded forces.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use robstiff::nalgebra::Vector3;
use robstiff_machining::milling::fit::{self, Fit, Fitted, Turn};
use robstiff_machining::milling::{Coefficients, Cut, Recorded, Records};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::output::{self, Files};
use crate::text::{Table, decimals, plus_minus, significant};
use crate::{json, text};

/// The rows of coefficients, each with those per chip area and per length of the edge.
const ROWS: [&str; 3] = ["tangential", "radial", "axial"];

/// Fits coefficients to the records of all lists together.
pub fn run(lists: &[PathBuf], by_revolution: bool, out: Option<&Path>, json: Option<&Path>) -> Result<(), Failure> {
    let mut files = Files::default();
    let (mut records, mut names, mut sources): (Vec<Recorded>, Vec<String>, Vec<String>) = Default::default();
    for list in lists {
        let read = Records::read(list)?;
        for warning in &read.warnings {
            output::complain(format_args!("warning: {warning}"));
        }
        files.protect(list);
        read.records.iter().for_each(|record| files.protect(&record.path));
        names.extend([read.name].into_iter().filter(|name| !name.is_empty()));
        sources.extend([read.source].into_iter().filter(|source| !source.is_empty()));
        records.extend(read.records);
    }
    let unfit = |unfit: fit::Unfit| Failure::new(format_args!("{}: {unfit}", lists[0].display()));
    let means = fit::by_means(&records).map_err(unfit)?;
    let found = if by_revolution { fit::by_revolutions(&records, &means.coefficients).map_err(unfit)? } else { means };
    let by = if by_revolution { "the force over the revolution" } else { "the mean forces" };
    if let Some(path) = out {
        files.add(path, cut(&records[0].cut, &found, &names.join(", "), &sources.join("; "), by));
    }
    if let Some(path) = json {
        files.add(path, json::document(&document(&records, &found, by_revolution)));
    }
    let said = files.write()?;
    output::print(page(&records, &found, by) + &said)
}

/// Those per chip area and per length of the edge, by rows.
fn pairs(of: &Coefficients) -> [[f64; 2]; 3] {
    [[of.ktc, of.kte], [of.krc, of.kre], [of.kac, of.kae]]
}

fn page(records: &[Recorded], found: &Fit, by: &str) -> String {
    let mut page = format!("{}, coefficients by {by}\n\n", text::count(records.len(), "record"));
    let mut table = Table::new(1, ["", "cutting [N/mm2]", "edge [N/mm]"]);
    let std = found.std.as_ref().map_or([[f64::NAN; 2]; 3], pairs);
    for ((name, value), std) in ROWS.into_iter().zip(pairs(&found.coefficients)).zip(std) {
        let [cutting, edge] = [(0, 1e6), (1, 1e3)].map(|(k, unit)| plus_minus(value[k] / unit, std[k] / unit));
        table.row([name.to_owned(), cutting, edge]);
    }
    page += &table.to_string();
    if found.std.is_none() {
        page += "no uncertainties: there are no more forces than coefficients\n";
    }
    page += "\nMean force on the tool along feed, normal and axis [N], and what the other records predict of it\n";
    let mut table = Table::new(1, ["record", "feed [mm/tooth]", "measured", "predicted", "off"]);
    let force = |force: &Vector3<f64>| force.iter().map(|force| decimals(*force, 1)).collect::<Vec<_>>().join(", ");
    for (record, fitted) in records.iter().zip(&found.records) {
        let (predicted, off) = match &fitted.predicted {
            Some(predicted) => (force(predicted), share(off(fitted, predicted))),
            None => ("-".to_owned(), "-".to_owned()),
        };
        let feed = significant(record.cut.feed_per_tooth * 1e3, 4);
        table.row([name(record), feed, force(&fitted.measured), predicted, off]);
    }
    page += &table.to_string();
    let turns: Vec<(&Recorded, Turn)> =
        records.iter().zip(&found.records).filter_map(|(record, fitted)| Some((record, fitted.turn?))).collect();
    if !turns.is_empty() {
        page += "\nForce over the revolution, and what the other records predict of it\n";
        let mut table = Table::new(1, ["record", "rms [N]", "off", "peak [N]", "predicted"]);
        for (record, turn) in turns {
            let [rms, peak, predicted] = [turn.force, turn.peak, turn.predicted_peak].map(|force| decimals(force, 1));
            table.row([name(record), rms, share(turn.rms / turn.force), peak, predicted]);
        }
        page += &table.to_string();
    }
    page
}

/// How far a prediction is off, as a part of the force.
fn off(fitted: &Fitted, predicted: &Vector3<f64>) -> f64 {
    (predicted - fitted.measured).norm() / fitted.measured.norm()
}

fn share(share: f64) -> String {
    format!("{} %", decimals(share * 100.0, 1))
}

fn name(record: &Recorded) -> String {
    record.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// A cut with the coefficients, in the conditions of the first record.
fn cut(cut: &Cut, found: &Fit, name: &str, source: &str, by: &str) -> String {
    let mut yaml = String::new();
    let mut line = |text: String| writeln!(yaml, "{text}").expect("a string takes any text");
    let one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    line(format!("# Coefficients by robstiff forces --fit from {by}; the cut is that of the first record."));
    if !source.is_empty() {
        line(format!("# {}", one_line(source)));
    }
    if !name.is_empty() {
        line(format!("name: {}", Value::from(one_line(name))));
    }
    let mill = &cut.mill;
    let runout = match &mill.runout[..] {
        [] => String::new(),
        out => format!(
            ", runout: [{}]",
            out.iter().map(|out| format!("{} um", number(out * 1e6))).collect::<Vec<_>>().join(", ")
        ),
    };
    let [diameter, depth, feed] = [mill.diameter, cut.depth, cut.feed_per_tooth].map(|length| number(length * 1e3));
    let helix = number(mill.helix.to_degrees());
    line(format!("tool: {{diameter: {diameter} mm, teeth: {}, helix: {helix} deg{runout}}}", mill.teeth));
    line("coefficients:".to_owned());
    let std = found.std.as_ref().map(pairs);
    for (row, (name, [cutting, edge])) in ROWS.into_iter().zip(pairs(&found.coefficients)).enumerate() {
        let [cutting, edge] = [cutting / 1e6, edge / 1e3].map(|value| significant_plain(value, 5));
        let uncertain = std.map_or(String::new(), |std| {
            let [cutting, edge] = [std[row][0] / 1e6, std[row][1] / 1e3].map(|value| significant_plain(value, 2));
            format!("   # one standard deviation: {cutting} N/mm2, {edge} N/mm")
        });
        line(format!("  {name}: {{cutting: {cutting} N/mm2, edge: {edge} N/mm}}{uncertain}"));
    }
    let [entry, exit] = [cut.engagement.entry, cut.engagement.exit].map(|angle| number(angle.to_degrees()));
    line(if cut.engagement.is_slot() {
        "milling: slot".to_owned()
    } else {
        format!("engagement: [{entry} deg, {exit} deg]")
    });
    line(format!("depth: {depth} mm"));
    line(format!("feed: {feed} mm/tooth"));
    if let Some(speed) = cut.speed {
        line(format!("speed: {} rpm", number(speed * 60.0 / std::f64::consts::TAU)));
    }
    yaml
}

/// A number as it was typed, without the rounding of its unit.
fn number(value: f64) -> String {
    ((value * 1e9).round() / 1e9).to_string()
}

/// So many digits, without an exponent.
fn significant_plain(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return "0".to_owned();
    }
    let decimals = (digits - 1 - value.abs().log10().floor() as i32).clamp(0, 12);
    text::decimals(value, decimals as usize)
}

fn document(records: &[Recorded], found: &Fit, by_revolution: bool) -> Value {
    let coefficients = |of: &Coefficients| {
        let [[ktc, kte], [krc, kre], [kac, kae]] = pairs(of).map(|pair| pair.map(json::number));
        json!({ "Ktc_Pa": ktc, "Kte_N_per_m": kte, "Krc_Pa": krc, "Kre_N_per_m": kre, "Kac_Pa": kac, "Kae_N_per_m": kae })
    };
    let record = |(record, fitted): (&Recorded, &Fitted)| {
        json!({
            "file": record.path.display().to_string(),
            "feed_per_tooth_m": json::number(record.cut.feed_per_tooth),
            "mean_N": json::numbers(fitted.measured.iter().copied()),
            "fitted_N": json::numbers(fitted.fitted.iter().copied()),
            "predicted_N": fitted.predicted.map(|force| json::numbers(force.iter().copied())),
            "revolution": fitted.turn.map(|turn| json!({
                "rms_N": json::number(turn.force),
                "predicted_rms_error_N": json::number(turn.rms),
                "peak_N": json::number(turn.peak),
                "predicted_peak_N": json::number(turn.predicted_peak),
            })),
        })
    };
    json!({
        "by": if by_revolution { "revolution" } else { "mean" },
        "coefficients": coefficients(&found.coefficients),
        "std": found.std.as_ref().map(coefficients),
        "records": records.iter().zip(&found.records).map(record).collect::<Value>(),
    })
}
