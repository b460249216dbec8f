//! `robstiff start`: what to measure first on an arm of one's own.

mod guide;
mod table;

use std::fs;
use std::path::{Path, PathBuf};

use robstiff_identify::plan::{self, Options, first};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};
use robstiff_robots::{Description, catalogue};

use crate::failure::Failure;
use crate::input::{self, positive};
use crate::json;
use crate::output::{self, Files};
use crate::text::count;

/// Begins with a robot: writes a folder with the poses and loads to measure first
///
/// DIR gets `campaign.yaml`, `loads.csv` with poses and loads filled in and the readings empty, the
/// robot's description, and `how-to-measure.html`. The poses and loads are chosen to tell the causes of
/// compliance apart.
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue
    #[arg(value_name = "ROBOT.yaml")]
    robot: PathBuf,
    /// The folder, which must be empty or missing; ROBOT-campaign where left out
    #[arg(long, visible_alias = "dir", value_name = "DIR")]
    out: Option<PathBuf>,
    /// How many poses to measure
    #[arg(long, value_name = "COUNT", default_value_t = 30, allow_hyphen_values = true, value_parser = input::whole::<u16>(1, 200))]
    poses: u16,
    /// The greatest force, which the arm must be able to bear in every pose, e.g. "500 N"
    #[arg(long, value_name = "FORCE", default_value = "500 N", allow_hyphen_values = true, value_parser = positive(Dimension::Force))]
    force: f64,
    /// The least height of the tool above the base's origin, e.g. "300 mm"; a tenth of the reach where left out
    #[arg(long, value_name = "HEIGHT", allow_hyphen_values = true, value_parser = input::length)]
    floor: Option<f64>,
    /// How far joints stay inside their limits, in percent of the range between these
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0 * plan::MARGIN, allow_hyphen_values = true, value_parser = input::margin)]
    margin: f64,
    /// Seed of the poses to choose from; one seed gives one folder
    #[arg(long, default_value_t = Options::default().seed, allow_hyphen_values = true, value_parser = input::seed)]
    seed: u64,
}

/// Writes the folder.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (robot, file) = input::robot(&arguments.robot)?;
    input::refuse_if_rigid(&robot, "`robstiff start`")?;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}-campaign", stem(&file))));
    refuse_if_used(&out)?;
    let (named, copy) = description(&arguments.robot)?;
    let options = Options {
        poses: arguments.poses.into(),
        force: Some(arguments.force),
        floor: arguments.floor,
        margin: arguments.margin / 100.0,
        seed: arguments.seed,
        ..Options::default()
    };
    let found = output::working("choosing poses", |_| first::first(&robot, &options))
        .map_err(|error| Failure::new(error.to_string()))?;
    let mut files = Files::default();
    files.add(out.join("campaign.yaml"), campaign(&robot, &named));
    files.add(out.join(SCHEMA), json::document(&robstiff_identify::campaign::schema::schema()));
    files.add(out.join("loads.csv"), table::table(&robot, &found));
    files.add(out.join("how-to-measure.html"), guide::page(&robot, &found));
    if let Some(text) = copy {
        files.add(out.join("robot.yaml"), text);
    }
    let said = files.write()?;
    output::print(page(&robot, &found, &out) + &said)
}

/// The schema of the campaign file, by which an editor completes and checks it.
const SCHEMA: &str = "campaign.schema.json";

fn stem(file: &str) -> &str {
    file.strip_suffix(".yaml").or_else(|| file.strip_suffix(".yml")).unwrap_or(file)
}

/// Stops where the folder has anything in it.
fn refuse_if_used(out: &Path) -> Result<(), Failure> {
    let used = match fs::read_dir(out) {
        Ok(mut entries) => entries.next().is_some(),
        Err(_) => out.exists(),
    };
    if used {
        return Err(Failure::new(format_args!(
            "{} is there already and is not empty; name another folder with --out",
            out.display()
        )));
    }
    Ok(())
}

/// How the campaign names the robot, and the text of its file, which is copied into the folder; a robot of
/// the catalogue is named.
fn description(path: &Path) -> Result<(String, Option<String>), Failure> {
    match path.to_str() {
        Some(name) if !path.is_file() && catalogue::find(name).is_some() => Ok((name.to_owned(), None)),
        _ => Ok(("robot.yaml".to_owned(), Some(text::read(path, MOST_OF_DOCUMENT)?))),
    }
}

fn campaign(robot: &Description, named: &str) -> String {
    format!(
        "# yaml-language-server: $schema={SCHEMA}
name: first loads on {}
robot: {named}
observations: loads.csv
kind: displacement
# Where the force acts and where the gauge reads: the tool centre point, or a point in the tool frame,
# e.g. at: [0, 0, 120 mm]. Axes: base, or tool.
wrench: {{frame: base, at: tcp}}
measured: {{frame: base, at: tcp}}
# What a reading scatters by where the same load is read again, one sigma. Known, it tells noise from causes:
# noise: {{displacement: 5 um}}
",
        robot.name
    )
}

fn page(robot: &Description, found: &first::First, out: &Path) -> String {
    let rows: usize = found.visits.iter().map(|visit| visit.loads.len()).sum();
    let mut page = format!(
        "{}: {} to measure, {} of loads up to {:.0} N\n\nTaken for granted:\n",
        robot.name,
        count(found.visits.len(), "pose"),
        count(rows, "row"),
        found.force
    );
    for said in &found.assumptions {
        page += &format!("- {said}\n");
    }
    page += "- the arm bears the force in every pose; nothing is known of what it could hit: try every pose slowly\n";
    let folder = out.display();
    page + &format!("\nMeasure as {folder}/how-to-measure.html says, then: robstiff trace {folder}/campaign.yaml\n\n")
}
