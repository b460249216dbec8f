//! Holds the error on unseen poses that a trace reports against the error on poses that were kept from it.

use std::path::PathBuf;
use std::process;
use std::time::Instant;

use clap::Parser;
use robstiff_identify::campaign::{Campaign, Data, Holdout};
use robstiff_identify::trace::{Options, Trace, Verdict, trace};
use robstiff_tests::matrix::{Case, groups, run, shares};
use robstiff_tests::parallel;

/// Holds the error on unseen poses that a trace reports against the error on poses that were kept from it
///
/// Of campaigns that are given: reported with all poses, against the mean over three thirds that are held out.
/// Without any, of simulated ones: reported with 40 poses, against 20 more that are held out.
#[derive(Parser)]
#[command(name = "unseen")]
struct Arguments {
    /// Campaigns that were measured
    campaigns: Vec<PathBuf>,
    /// How many simulated campaigns, shared out among the groups of the matrix
    #[arg(long, default_value_t = 124)]
    count: usize,
    /// Seed of the simulated campaigns
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads
    #[arg(long, default_value_t = 2)]
    jobs: usize,
}

/// The part of the poses that is held out.
const PART: f64 = 1.0 / 3.0;

fn main() {
    let arguments = Arguments::parse();
    if arguments.campaigns.is_empty() {
        simulated(&arguments);
        return;
    }
    println!("| campaign | rows | declared [mm] | reported [mm] | held out [mm] | reported / held out | verdict | s |");
    println!("|---|---:|---:|---:|---:|---:|---|---:|");
    arguments.campaigns.iter().for_each(measured);
}

fn traced(campaign: &Campaign) -> Trace {
    trace(campaign, &Options::default(), &|_| {}).unwrap_or_else(|problem| fail(&problem))
}

fn fail(problem: &dyn std::error::Error) -> ! {
    eprintln!("{problem}");
    process::exit(1)
}

/// The error on poses that are held out; of a third of them.
fn held_out(campaign: &Campaign, seed: u64) -> f64 {
    let holdout = Some(Holdout { fraction: PART, seed });
    traced(&Campaign { holdout, ..campaign.clone() }).after.holdout_rms
}

/// A line of the table: lengths in space, an rms over rows.
fn measured(path: &PathBuf) {
    let campaign = Campaign::read(path).unwrap_or_else(|problem| fail(&problem));
    if matches!(campaign.data, Data::Clamped(_)) {
        eprintln!("{}: clamped axes have no poses to hold out", path.display());
        process::exit(1);
    }
    let campaign = Campaign { holdout: None, held_out: Vec::new(), ..campaign };
    let begun = Instant::now();
    let found = traced(&campaign);
    let seconds = begun.elapsed().as_secs_f64();
    let squares: f64 = (1..=3).map(|seed| held_out(&campaign, seed).powi(2)).sum();
    let [reported, truly] = [found.after.holdout_rms, (squares / 3.0).sqrt()];
    // An rms is over three axes.
    let mm = |rms: f64| 1e3 * 3.0_f64.sqrt() * rms;
    println!(
        "| {} | {} | {:.4} | {:.4} | {:.4} | {:.2} | {} | {seconds:.1} |",
        path.display(),
        found.rows,
        mm(found.declared.rms),
        mm(reported),
        mm(truly),
        reported / truly,
        found.verdict,
    );
}

/// What came of all simulated campaigns together.
fn simulated(arguments: &Arguments) {
    let cases: Vec<Case> = shares(&groups(), arguments.count)
        .flat_map(|(group, count)| (0..count).map(move |replicate| Case::new(group, replicate, arguments.seed)))
        .collect();
    let ratios: Vec<f64> = parallel::each(&cases, arguments.jobs, ratio).into_iter().flatten().collect();
    let count = ratios.len() as f64;
    let logs: Vec<f64> = ratios.iter().map(|ratio| ratio.ln()).collect();
    let mean = logs.iter().sum::<f64>() / count;
    let spread = (logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
    let off = 1.96 * spread / count.sqrt();
    println!(
        "{} campaigns: the error reported over that on poses held out is {:.3} (geometric mean; 95 % interval {:.3} to {:.3}), \
         one by one it scatters by {:.0} %.",
        ratios.len(),
        mean.exp(),
        (mean - off).exp(),
        (mean + off).exp(),
        100.0 * spread
    );
}

/// What is reported over what is true; none where the data cannot tell.
fn ratio(case: &Case) -> Option<f64> {
    let ready = case.clone().ready();
    let mut scenario = ready.scenario;
    let reported = traced(&run::read(&scenario.run(), &ready.declared));
    scenario.poses += scenario.poses / 2;
    let truly = held_out(&run::read(&scenario.run(), &ready.declared), 1);
    (reported.verdict != Verdict::Insufficient).then(|| reported.after.holdout_rms / truly)
}
