//! `robstiff trace`: the closed loop, from the residual to the effect that the
//! model lacks.

mod content;
mod document;
mod doubts;
mod finding;
mod numbers;
mod page;
mod pictures;
mod pose_errors;
mod triage;
mod warned;
mod wording;

use std::path::PathBuf;

use robstiff_identify::identify::Error;
use robstiff_identify::plan::next;
use robstiff_identify::rounded;
use robstiff_identify::trace::{Options, account_for, trace};

use crate::failure::Failure;
use crate::output::{self, Files};
use crate::{input, json, report};

/// Finds the effects that a description lacks, adds them, and reports the error before and after
#[derive(clap::Args)]
pub struct Arguments {
    /// The campaign
    #[arg(value_name = "CAMPAIGN.yaml")]
    campaign: PathBuf,
    /// The folder for `robot.yaml`, `trace.json` and `report.html`
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Write `trace.json` to FILE as well
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Seed of the parts in which poses are left out; one seed gives one result
    #[arg(long, default_value_t = Options::default().seed, allow_hyphen_values = true, value_parser = input::seed)]
    seed: u64,
    /// In how many parts of the poses the whole search is repeated, each time without one part, for the
    /// error on unseen poses; without a number, each pose by itself [default: 5]
    #[arg(long, value_name = "FOLDS", num_args = 0..=1, value_parser = input::whole::<u32>(2, 1_000_000))]
    nested: Option<Option<u32>>,
}

/// How many measurements are proposed; `robstiff plan` proposes more.
const PROPOSALS: usize = 3;

/// In how many folds the search is repeated; there are no more folds than poses.
fn folds(asked: Option<Option<u32>>) -> usize {
    match asked {
        None => Options::default().folds,
        Some(None) => usize::MAX,
        Some(Some(folds)) => folds as usize,
    }
}

/// Traces the campaign.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let options = Options { seed: arguments.seed, folds: folds(arguments.nested) };
    let campaign = input::campaign(&arguments.campaign)?;
    let mut files = Files::default();
    files.protect_campaign(&campaign);
    let [robot, figures, shown] = ["robot.yaml", "trace.json", "report.html"].map(|name| arguments.out.join(name));
    // One text may be asked for twice by one name.
    let again = arguments.json.iter().filter(|path| **path != figures);
    files.foresee(again.chain([&robot, &figures, &shown]))?;
    files.foresee_robot(&robot, &campaign.robot)?;
    let (triage, traced) = output::working("checking the readings themselves", |spinner| -> Result<_, Error> {
        let progress = |stage: &str| spinner.set_message(stage.to_owned());
        let mut triage = robstiff_identify::triage::triage(&campaign);
        let mut traced = trace(&campaign, &options, &progress)?;
        account_for(&mut triage, &campaign, &traced);
        spinner.set_message("choosing what to measure next");
        // Without proposals, where none can be made.
        traced.next = next(&campaign, &traced, PROPOSALS).unwrap_or_default();
        Ok((triage, traced))
    })
    .map_err(Failure::about(&campaign))?;

    // Once: the campaign is fitted again for it.
    let warnings = warned::warnings(&traced, &campaign);
    let summary = finding::summary(&traced, &campaign, &warnings);
    let page = triage::page(&triage) + &page::page(&traced, &campaign, &summary);
    let document = json::document(&document::document(&traced, &triage, &campaign, &warnings));
    let report = report::html(&content::report((&traced, summary), &triage, &campaign, options.seed)?);
    let written = rounded(traced.description.clone(), &campaign.robot);
    let written = input::moved(&written, (&campaign.robot, &campaign.robot_path), &arguments.out);
    files.add(robot, written.to_yaml());
    if let Some(path) = &arguments.json {
        files.add(path, document.clone());
    }
    files.add(figures, document);
    files.add(shown, report);
    let said = files.write()?;
    output::print(page + "\n" + &said)
}
