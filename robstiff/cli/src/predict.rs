//! `robstiff predict`: the error of a robot on measurements.

use std::fmt::Write as _;
use std::path::PathBuf;

use robstiff_identify::campaign::{Campaign, Data};
use robstiff_identify::predict::{PredictedRow, Prediction, predict};
use serde_json::json;

use crate::failure::Failure;
use crate::output::{self, Files};
use crate::text::{cell, count, field, micrometres};
use crate::{input, json};

/// The error of a robot on the measurements of a campaign
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue
    #[arg(value_name = "ROBOT.yaml")]
    robot: PathBuf,
    /// The campaign, which may have been measured for another description
    #[arg(value_name = "CAMPAIGN.yaml")]
    campaign: PathBuf,
    /// Write the error as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write predicted and measured displacement or position of every row to FILE
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// Predicts the campaign.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (robot, _) = input::robot(&arguments.robot)?;
    let campaign = input::campaign(&arguments.campaign)?;
    let mut files = Files::default();
    files.protect(&arguments.robot);
    files.protect_campaign(&campaign);
    files.foresee(arguments.json.iter().chain(&arguments.csv))?;
    let prediction = predict(&robot, &campaign).map_err(Failure::about(&campaign))?;
    if let Some(path) = &arguments.json {
        let document = json!({
            "rows": prediction.rows.len(),
            "rms_um": json::number(prediction.rms * 1e6),
            "p95_um": json::number(prediction.p95 * 1e6),
            "max_um": json::number(prediction.max * 1e6),
        });
        files.add(path, json::document(&document));
    }
    if let Some(path) = &arguments.csv {
        files.add(path, table(&campaign, &prediction));
    }
    let said = files.write()?;
    output::print(page(&robot.name, &prediction) + &said)
}

/// The line of the largest error, the first where several are.
fn worst_line(prediction: &Prediction) -> Option<usize> {
    let worse = |one: &PredictedRow, other: &PredictedRow| other.error() > one.error();
    prediction.rows.iter().reduce(|one, other| if worse(one, other) { other } else { one }).map(|row| row.line)
}

fn page(robot: &str, prediction: &Prediction) -> String {
    let Prediction { rows, rms, p95, max } = prediction;
    let line = worst_line(prediction).map(|line| format!(" (line {line})")).unwrap_or_default();
    format!(
        "{robot} on {}: error {} um rms, {} um at the 95th percentile, {} um at most{line}\n\
         (the length of a row's residual over the root of 3, as the noise of one axis)\n",
        count(rows.len(), "row"),
        micrometres(*rms),
        micrometres(*p95),
        micrometres(*max)
    )
}

/// A row for each of the campaign's, in its file's order and with its line there: displacements in
/// the base frame, positions in the frame that they were read in.
fn table(campaign: &Campaign, prediction: &Prediction) -> String {
    let (poses, visits, letter, unit, factor) = match &campaign.data {
        Data::Displacement(data) => (&data.poses, &data.visits, 'd', "um", 1e6),
        Data::Position(data) => (&data.poses, &data.visits, 'p', "mm", 1e3),
        Data::Clamped(_) => unreachable!("clamped axes are not predicted"),
    };
    let read: Vec<(usize, usize)> = match &campaign.data {
        Data::Displacement(data) => data.rows.iter().map(|row| (row.pose, row.visit)).collect(),
        Data::Position(data) => data.rows.iter().map(|row| (row.pose, row.visit)).collect(),
        Data::Clamped(_) => Vec::new(),
    };
    let mut csv = String::from("pose,visit");
    for (kind, unit) in [("predicted", unit), ("measured", unit), ("residual", "um")] {
        for axis in ["x", "y", "z"] {
            write!(csv, ",{kind}_{letter}{axis} [{unit}]").expect("a string takes any text");
        }
    }
    csv.push_str(",line\n");
    let mut rows: Vec<(&PredictedRow, (usize, usize))> = prediction.rows.iter().zip(read).collect();
    rows.sort_by_key(|(row, _)| row.line);
    for (row, (pose, visit)) in rows {
        csv += &format!("{},{}", field(&poses[pose]), field(&visits[visit]));
        for value in [row.predicted, row.measured].concat() {
            csv += &format!(",{}", cell(value * factor, 4));
        }
        for axis in 0..3 {
            csv += &format!(",{}", cell((row.measured[axis] - row.predicted[axis]) * 1e6, 4));
        }
        csv += &format!(",{}\n", row.line);
    }
    csv
}
