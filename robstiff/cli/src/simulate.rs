//! `robstiff simulate`: a campaign on a robot that hides something.

use std::path::PathBuf;

use robstiff_identify::campaign::Data;
use robstiff_identify::simulate::{Scenario, Simulated, simulate};
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};
use serde_json::json;

use crate::failure::Failure;
use crate::output::{self, Files};
use crate::text::count;
use crate::{input, json};

/// Measures a scenario on a simulated robot, to try a plan before making it
///
/// DIR gets `campaign.yaml`, `loads.csv` (`positions.csv`) and `robot.yaml` (the
/// robot as declared) for the other commands, and `truth.yaml`: the robot as it was
/// simulated, with what was hidden from them.
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue
    #[arg(value_name = "ROBOT.yaml")]
    robot: PathBuf,
    /// What is measured, how well, and what is hidden (robstiff/docs/campaigns.md)
    #[arg(value_name = "SCENARIO.yaml")]
    scenario: PathBuf,
    /// The folder for the campaign
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Replace a campaign that is there already
    #[arg(long)]
    force: bool,
    /// Write what was done as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Measures.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (robot, _) = input::robot(&arguments.robot)?;
    input::complain_if_rigid(&robot);
    let name = arguments.scenario.display().to_string();
    let text = text::read(&arguments.scenario, MOST_OF_DOCUMENT)?;
    let scenario = Scenario::parse(&name, &text, &robot)?;
    let mut files = Files::default();
    files.protect(&arguments.robot);
    files.protect(&arguments.scenario);
    let names = ["campaign.yaml", scenario.measures.file(), "robot.yaml", "truth.yaml"];
    let paths = names.map(|name| arguments.out.join(name));
    files.foresee(arguments.json.iter().chain(&paths))?;
    if let Some(path) = paths.iter().find(|path| path.exists() && !arguments.force) {
        return Err(Failure::there_already(path, "folder"));
    }
    let simulated = simulate(&robot, &scenario).map_err(|refused| refused.located(&name, &text))?;
    let texts = simulated.files();
    for (path, text) in paths.into_iter().zip([texts.campaign, texts.observations.1, texts.robot, texts.truth]) {
        files.add(path, text);
    }
    if let Some(path) = &arguments.json {
        files.add(path, json::document(&document(&simulated)));
    }
    let said = files.write()?;
    output::print(page(&simulated) + &said)
}

fn page(simulated: &Simulated) -> String {
    let [rows, poses] = sizes(simulated);
    let hidden: Vec<String> = simulated.scenario.hidden.iter().map(|effect| format!("  {effect}\n")).collect();
    let hidden = if hidden.is_empty() { "  nothing\n".to_owned() } else { hidden.concat() };
    format!(
        "{}: {} at {}, seed {}\nhidden:\n{hidden}",
        simulated.declared.name,
        count(rows, "row"),
        count(poses, "pose"),
        simulated.scenario.seed
    )
}

fn document(simulated: &Simulated) -> serde_json::Value {
    let [rows, poses] = sizes(simulated);
    json!({
        "robot": simulated.declared.name,
        "rows": rows,
        "poses": poses,
        "seed": simulated.scenario.seed,
        "hidden": simulated.scenario.hidden.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "compliances": simulated.truth.joints.iter().map(|joint| json::number(joint.compliance())).collect::<Vec<_>>(),
    })
}

/// How many rows and poses there are.
fn sizes(simulated: &Simulated) -> [usize; 2] {
    match &simulated.data {
        Data::Displacement(data) => [data.rows.len(), data.poses.len()],
        Data::Position(data) => [data.rows.len(), data.poses.len()],
        Data::Clamped(_) => unreachable!("no scenario is of clamped axes"),
    }
}
