//! `robstiff trace`: the closed loop, from the residual to the effect that the
//! model lacks.

mod clamped;
mod content;
mod correction;
mod document;
mod doubts;
mod pictures;
mod story;
mod triage;
mod warned;

use std::path::PathBuf;

use robstiff_identify::campaign::Data;
use robstiff_identify::identify::Error;
use robstiff_identify::plan::next;
use robstiff_identify::trace::{Correction, Options, account_for, nested, trace};

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
    /// Seed of the bootstrap; one seed gives one result
    #[arg(long, default_value_t = Options::default().seed, allow_hyphen_values = true, value_parser = input::seed)]
    seed: u64,
    /// Bootstrap draws; the p-value of an effect is no smaller than one over one more than these
    #[arg(long, default_value_t = Options::default().draws as u32, allow_hyphen_values = true, value_parser = input::whole::<u32>(99, 1_000_000))]
    draws: u32,
    /// Level of the tests, over all candidates together
    #[arg(long, default_value_t = Options::default().alpha, allow_hyphen_values = true, value_parser = level)]
    alpha: f64,
    /// Repeat the whole search without each pose in turn, or in FOLDS parts, and report the error on
    /// the poses that a search was without
    #[arg(long, value_name = "FOLDS", num_args = 0..=1, value_parser = input::whole::<u32>(2, 1_000_000))]
    nested: Option<Option<u32>>,
    /// Look for a correction of what is left that is no physics, and where it predicts unseen poses
    /// better write it to `correction.json`
    #[arg(long)]
    correction: bool,
}

/// How many measurements are proposed; `robstiff plan` proposes more.
const PROPOSALS: usize = 3;

fn level(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(level) if level > 0.0 && level < 1.0 => Ok(level),
        _ => Err("a level is a number between 0 and 1".to_owned()),
    }
}

/// Traces the campaign.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let options = Options { seed: arguments.seed, draws: arguments.draws as usize, alpha: arguments.alpha };
    options.check().map_err(Failure::Usage)?;
    let campaign = input::campaign(&arguments.campaign)?;
    let mut files = Files::default();
    files.protect_campaign(&campaign);
    let [robot, told, shown, correcting] =
        ["robot.yaml", "trace.json", "report.html", "correction.json"].map(|name| arguments.out.join(name));
    // One text may be asked for twice by one name.
    let again = arguments.json.iter().filter(|path| **path != told);
    let correction_too = arguments.correction.then_some(&correcting);
    files.foresee(again.chain([&robot, &told, &shown]).chain(correction_too))?;
    files.foresee_robot(&robot, &campaign.robot)?;
    let (triage, traced, nested, correction) =
        output::working("asking the readings themselves", |spinner| -> Result<_, Error> {
            let progress = |stage: &str| spinner.set_message(stage.to_owned());
            let mut triage = robstiff_identify::triage::triage(&campaign);
            // First, for it may refuse the campaign or the folds.
            let folds = arguments.nested.map(|folds| folds.map(|folds| folds as usize));
            let nested = folds.map(|folds| nested(&campaign, &options, folds, &progress)).transpose()?;
            let mut traced = trace(&campaign, &options, &progress)?;
            account_for(&mut triage, &campaign, &traced);
            spinner.set_message("choosing what to measure next");
            // A trace stands without proposals, where none can be made.
            traced.next = next(&campaign, &traced, PROPOSALS).unwrap_or_default();
            let correction = match &campaign.data {
                Data::Displacement(_) if arguments.correction => Some(Correction::of(&campaign, &traced)),
                _ => None,
            };
            Ok((triage, traced, nested, correction))
        })
        .map_err(Failure::about(&campaign))?;

    let nested = nested.as_ref();
    let document = document::document(&traced, &triage, nested, &campaign);
    // Once: the campaign is predicted for it.
    let summary = story::summary(&traced, nested, &campaign);
    let mut page = triage::page(&triage) + &story::page(&traced, nested, &campaign, &summary);
    let mut report = content::report((&traced, summary), nested, &triage, &campaign, &options)?;
    if let Some(found) = &correction {
        let said = correction::sentence(found.as_ref());
        page += &format!("\n{said}\n");
        report.summary.push(said);
    } else if arguments.correction {
        page += "\nNo correction: it is one of displacements, and this campaign has none.\n";
    }
    let report = report::html(&report);
    let document = json::document(&document);
    files.add(robot, traced.description.to_yaml());
    if let Some(path) = &arguments.json {
        files.add(path, document.clone());
    }
    files.add(told, document);
    files.add(shown, report);
    let mut stale = correcting.exists();
    if let Some(Some(found)) = &correction {
        stale = false;
        files.add(&correcting, json::document(&correction::document(found, &traced)));
    }
    let said = files.write()?;
    if stale {
        output::complain(format_args!(
            "warning: {} is of an earlier trace, and does not belong to the robot that is written beside it now",
            correcting.display()
        ));
    }
    output::print(page + "\n" + &said)
}
