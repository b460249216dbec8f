//! `robstiff forces`: what a cut pushes the tool with.

mod fit;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use robstiff::nalgebra::Vector3;
use robstiff_machining::milling::{Cut, CutFile, ForceFrame, Forces, MeasuredForce, Revolution};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::output::{self, Files};
use crate::text::{Table, cell, decimals, significant};
use crate::{input, json};

/// The force of a cut on the tool: mean, peak, and over a revolution
#[derive(clap::Args)]
pub struct Arguments {
    /// The cut: tool, material, engagement and feed, or measured forces (robstiff/docs/commands/forces.md)
    #[arg(value_name = "CUT.yaml", required_unless_present = "fit", conflicts_with = "fit")]
    cut: Option<PathBuf>,
    /// Fit cutting coefficients to recorded forces: lists of records with the cut of each
    #[arg(long, value_name = "RECORDS.yaml", num_args = 1.., conflicts_with_all = ["csv", "samples"])]
    fit: Vec<PathBuf>,
    /// Fit to the force over the revolution, not to the mean force alone
    #[arg(long, requires = "fit")]
    revolution: bool,
    /// Where a cut with the fitted coefficients is written
    #[arg(long, value_name = "CUT.yaml", requires = "fit")]
    out: Option<PathBuf>,
    /// How many angles of a revolution are looked at
    #[arg(long, value_name = "COUNT", default_value_t = 360, allow_hyphen_values = true, value_parser = input::whole::<u32>(4, 1_000_000))]
    samples: u32,
    /// Write the force over a revolution as a table to FILE
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write the same as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// What a force's components are along.
fn axes(forces: &Forces) -> [&'static str; 3] {
    match forces {
        Forces::Measured { force: MeasuredForce { frame: ForceFrame::Base | ForceFrame::Tool, .. }, .. } => {
            ["x", "y", "z"]
        }
        _ => ["feed", "normal", "axis"],
    }
}

/// Prints forces.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(cut) = &arguments.cut else {
        let (out, json) = (arguments.out.as_deref(), arguments.json.as_deref());
        return fit::run(&arguments.fit, arguments.revolution, out, json);
    };
    // Clap asks for nothing that conflicts with what is given.
    if arguments.out.is_some() || arguments.revolution {
        return Err(Failure::Usage("--out and --revolution go with --fit".into()));
    }
    let file = input::cut(cut)?;
    let count = arguments.samples as usize;
    let (mean, revolution) = match &file.forces {
        Forces::Model(cut) => (cut.mean_force(), Some(cut.revolution(count))),
        Forces::Measured { force, speed } => (force.mean(*speed), force.revolution(count, *speed)),
    };
    let looked_at = looked_at(&file.forces, revolution.as_ref());
    let mut files = Files::default();
    protect(&mut files, cut, &file);
    if let Some(path) = &arguments.csv {
        let Some(revolution) = &revolution else {
            return Err(Failure::new(format_args!(
                "{}: {}, so nobody can tell what a revolution is",
                cut.display(),
                lacks(&file.forces)
            )));
        };
        files.add(path, table(&file.forces, revolution));
    }
    if let Some(path) = &arguments.json {
        files.add(path, json::document(&document(&file, &mean, revolution.as_ref(), looked_at.peak())));
    }
    let said = files.write()?;
    output::print(page(&file, &mean, revolution.is_some(), &looked_at) + &said)
}

/// The forces among which the least and the greatest are looked for: of a model also those where
/// teeth begin and end to cut, of a record that tells no revolution all of its samples.
fn looked_at(forces: &Forces, revolution: Option<&Revolution>) -> Revolution {
    match (forces, revolution) {
        (Forces::Model(cut), Some(revolution)) => cut.extremes(revolution.samples.len()),
        (Forces::Measured { .. }, Some(revolution)) => revolution.clone(),
        (Forces::Measured { force, .. }, None) => {
            Revolution { samples: force.samples.iter().map(|sample| (0.0, sample.force)).collect() }
        }
        (Forces::Model(_), None) => Revolution { samples: Vec::new() },
    }
}

/// What a record lacks that tells no revolution.
pub fn lacks(forces: &Forces) -> &'static str {
    match forces {
        Forces::Measured { force, speed } if force.has_angles(*speed) => {
            "the record does not resolve a revolution: it is shorter, or coarser than four samples a turn"
        }
        _ => "the record has neither `angle` nor `t` with a `speed`",
    }
}

/// The files of a cut, which are not to be overwritten.
pub fn protect(files: &mut Files, path: &Path, file: &CutFile) {
    files.protect(path);
    file.measured_path.iter().for_each(|path| files.protect(path));
}

fn page(file: &CutFile, mean: &Vector3<f64>, is_revolution: bool, looked_at: &Revolution) -> String {
    let mut page = String::new();
    if !file.name.is_empty() {
        page += &format!("{}\n", file.name);
    }
    if !file.source.is_empty() {
        page += &format!("coefficients: {}\n", file.source);
    }
    match &file.forces {
        Forces::Model(cut) => page += &engagement(cut),
        Forces::Measured { force, .. } => {
            page += &format!("measured, {}\n", crate::text::count(force.samples.len(), "sample"));
        }
    }
    page += "\nForce on the tool [N]\n";
    let mut rows = Table::new(1, ["along", "mean", "least", "greatest"]);
    for (axis, name) in axes(&file.forces).into_iter().enumerate() {
        let range = looked_at.range(axis);
        let numbers = [mean[axis], range.least, range.greatest].map(|force| decimals(force, 1));
        rows.row([&[name.to_owned()], &numbers[..]].concat());
    }
    page += &rows.to_string();
    let [mean, peak] = [mean.norm(), looked_at.peak()].map(|force| decimals(force, 1));
    page += &format!("size of the mean force {mean} N, greatest force {peak} N");
    if !is_revolution {
        page += &format!("\n{}; least and greatest are of its samples", lacks(&file.forces));
    }
    page.push('\n');
    if let Forces::Model(cut) = &file.forces {
        page += &format!("torque {} Nm", significant(cut.mean_torque(), 3));
        if let (Some(power), Some(speed)) = (cut.power(), cut.feed_speed()) {
            page += &format!(", power {} W, feed {} mm/min", decimals(power, 0), decimals(speed * 6e4, 0));
        }
        page.push('\n');
        page +=
            "feed: where the tool goes; normal: left of it, seen from the spindle; axis: from the spindle to the tip\n";
    }
    page
}

fn engagement(cut: &Cut) -> String {
    let teeth = match cut.mill.teeth {
        1 => "1 tooth".to_owned(),
        teeth => format!("{teeth} teeth"),
    };
    let [entry, exit] = [cut.engagement.entry, cut.engagement.exit].map(|angle| decimals(angle.to_degrees(), 1));
    let wall = match cut.engagement.wall() {
        Some(wall) if wall > 0.0 => ", up milling (wall to the left)",
        Some(_) => ", down milling (wall to the right)",
        None => "",
    };
    let speed = cut
        .speed
        .map_or_else(String::new, |speed| format!(", {} rpm", significant(speed * 60.0 / std::f64::consts::TAU, 6)));
    format!(
        "mill {} mm, {teeth}, helix {} deg{speed}; {} mm deep, {} mm a tooth, teeth cut from {entry} to {exit} deg{wall}\n",
        significant(cut.mill.diameter * 1e3, 4),
        significant(cut.mill.helix.to_degrees(), 3),
        significant(cut.depth * 1e3, 4),
        significant(cut.feed_per_tooth * 1e3, 4),
    )
}

fn table(forces: &Forces, revolution: &Revolution) -> String {
    let [x, y, z] = match axes(forces) {
        ["x", "y", "z"] => ["Fx", "Fy", "Fz"],
        _ => ["Ffeed", "Fnormal", "Faxis"],
    };
    let mut table = format!("angle [deg],{x} [N],{y} [N],{z} [N]\n");
    for (angle, force) in &revolution.samples {
        let angle = (angle.to_degrees() * 1e9).round() / 1e9;
        let [x, y, z] = [force.x, force.y, force.z].map(|force| cell(force, 4));
        writeln!(table, "{angle},{x},{y},{z}").expect("a string takes any text");
    }
    table
}

/// Everything in SI units; what does not exist is null.
fn document(file: &CutFile, mean: &Vector3<f64>, revolution: Option<&Revolution>, peak: f64) -> Value {
    let model = match &file.forces {
        Forces::Model(cut) => Some(cut),
        Forces::Measured { .. } => None,
    };
    json!({
        "name": file.name,
        "source": file.source,
        "axes": axes(&file.forces),
        "mean_N": json::numbers(mean.iter().copied()),
        "peak_N": json::number(peak),
        "torque_Nm": model.map(Cut::mean_torque),
        "power_W": model.and_then(Cut::power),
        "feed_m_per_s": model.and_then(Cut::feed_speed),
        "engagement_rad": model.map(|cut| [cut.engagement.entry, cut.engagement.exit]),
        "revolution": revolution.map(|revolution| revolution.samples.iter().map(|(angle, force)| json!({
            "angle_rad": json::number(*angle), "force_N": json::numbers(force.iter().copied()),
        })).collect::<Value>()),
    })
}
