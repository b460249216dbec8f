//! `robstiff plan`: what to measure next.

mod document;
mod page;

use std::path::PathBuf;

use clap::ValueEnum;
use robstiff_identify::identify::Error;
use robstiff_identify::plan::{self, Options, plan};
use robstiff_identify::trace::{self, trace};
use robstiff_robots::quantity::Dimension;

use crate::failure::Failure;
use crate::input::positive;
use crate::output::{self, Files};
use crate::{input, json};

/// Proposes what to measure next: the poses and loads that best tell apart what a campaign could not
///
/// The campaign is traced first. Where no pose can tell two effects apart, it
/// says so, and which sensor would.
#[derive(clap::Args)]
pub struct Arguments {
    /// The campaign
    #[arg(value_name = "CAMPAIGN.yaml")]
    campaign: PathBuf,
    /// How many poses to propose
    #[arg(long, value_name = "COUNT", default_value_t = Options::default().poses as u16, allow_hyphen_values = true, value_parser = input::whole::<u16>(1, 200))]
    poses: u16,
    /// The folder for `plan.json` and `plan.csv`
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write the plan as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the poses and loads as a table, with a campaign's columns, to FILE
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// What the proposals are to be best at
    #[arg(long, value_enum, default_value_t = Criterion::Compound)]
    criterion: Criterion,
    /// The greatest force, e.g. "800 N"; the campaign's where left out
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true, value_parser = positive(Dimension::Force))]
    force: Option<f64>,
    /// The greatest moment, e.g. "100 Nm"; the campaign's where left out
    #[arg(long, value_name = "MOMENT", allow_hyphen_values = true, value_parser = positive(Dimension::Torque))]
    moment: Option<f64>,
    /// The least height of the tool above the base's origin, e.g. "300 mm"; the campaign's lowest where left out
    #[arg(long, value_name = "HEIGHT", allow_hyphen_values = true, value_parser = input::length)]
    floor: Option<f64>,
    /// How far joints stay inside their limits, in percent of the range between these
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0 * plan::MARGIN, allow_hyphen_values = true, value_parser = input::margin)]
    margin: f64,
    /// Seed of the search and of the bootstrap of the trace; one seed gives one result
    #[arg(long, default_value_t = Options::default().seed, allow_hyphen_values = true, value_parser = input::seed)]
    seed: u64,
}

/// What a plan is to be best at.
#[derive(Clone, Copy, ValueEnum)]
enum Criterion {
    /// Telling rivals apart first, and all numbers
    Compound,
    /// Telling rivals apart (T-optimal)
    T,
    /// The effects' numbers (Ds-optimal)
    Ds,
    /// All numbers (D-optimal)
    D,
}

/// Plans.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let campaign = input::campaign(&arguments.campaign)?;
    // Before minutes of tracing.
    plan::can_follow(&campaign).map_err(Failure::about(&campaign))?;
    let mut files = Files::default();
    files.protect_campaign(&campaign);
    let named = |name: &str| arguments.out.as_ref().map(|out| out.join(name));
    let mut documents: Vec<PathBuf> = arguments.json.iter().cloned().chain(named("plan.json")).collect();
    let mut tables: Vec<PathBuf> = arguments.csv.iter().cloned().chain(named("plan.csv")).collect();
    // One text may be asked for twice by one name.
    documents.dedup();
    tables.dedup();
    files.foresee(documents.iter().chain(&tables))?;
    let tracing = trace::Options { seed: arguments.seed, ..trace::Options::default() };
    let options = Options {
        poses: arguments.poses.into(),
        criterion: match arguments.criterion {
            Criterion::Compound => plan::Criterion::Compound,
            Criterion::T => plan::Criterion::T,
            Criterion::Ds => plan::Criterion::Ds,
            Criterion::D => plan::Criterion::D,
        },
        seed: arguments.seed,
        force: arguments.force,
        moment: arguments.moment,
        floor: arguments.floor,
        margin: arguments.margin / 100.0,
        ..Options::default()
    };
    let (planned, traced) = output::working("tracing", |spinner| -> Result<_, Error> {
        let traced = trace(&campaign, &tracing, &|stage| spinner.set_message(stage.to_owned()))?;
        spinner.set_message("choosing poses");
        Ok((plan(&campaign, &traced, &options)?, traced))
    })
    .map_err(Failure::about(&campaign))?;

    let document = json::document(&document::document(&planned, &traced, &campaign));
    let table = document::table(&planned, &campaign);
    for path in documents {
        files.add(path, document.clone());
    }
    for path in tables {
        files.add(path, table.clone());
    }
    let said = files.write()?;
    output::print(page::page(&planned, &traced, &campaign) + &said)
}
