//! What the documents show is what the programs read.

use std::fs;
use std::path::Path;

use robstiff_identify::campaign::{Campaign, Data, Holdout};
use robstiff_identify::simulate::{Scenario, Simulated, simulate};
use robstiff_identify::trace::{Options, Verdict, trace};
use robstiff_robots::Description;

/// The first block of a language in a document.
fn block<'d>(document: &'d str, language: &str) -> &'d str {
    nth_block(document, language, 1)
}

/// A block of a language in a document, from 1.
fn nth_block<'d>(document: &'d str, language: &str, nth: usize) -> &'d str {
    let rest = document.split(&format!("```{language}\n")).nth(nth).expect("a block of the language");
    rest.split("```").next().expect("what precedes its end")
}

#[test]
fn the_campaign_of_the_book_reads() {
    let page = include_str!("../../robstiff/docs/campaigns.md");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("documents");
    fs::create_dir_all(&folder).expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).expect("a file");
    write("campaign.yaml", block(page, "yaml"));
    write("loads.csv", block(page, "csv"));
    write("robot.yaml", include_str!("../../robots/rv130hsc.yaml"));
    let campaign = Campaign::read(folder.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"));
    assert!(campaign.warnings.is_empty(), "{:?}", campaign.warnings);
    assert_eq!(campaign.noise.displacement, Some(8e-6));
    assert_eq!(campaign.holdout, Some(Holdout { fraction: 0.25, seed: 1 }));
    let Data::Displacement(data) = campaign.data else { panic!("a campaign of displacements") };
    assert_eq!((data.poses.len(), data.visits.len(), data.rows.len()), (1, 2, 3));
    for (metres, micrometres) in data.rows[1].displacement.into_iter().zip([25.0, -362.0, -825.0]) {
        assert!((1e6 * metres - micrometres).abs() < 1e-9, "{metres}");
    }
}

/// The campaign of a scenario of the measuring page, read back from its files.
fn simulated(which: usize, folder: &str) -> (Simulated, Campaign) {
    let page = include_str!("../../robstiff/docs/measuring.md");
    let robot = Description::parse("robot.yaml", include_str!("../../robots/kuka-kr270-r2700.yaml")).expect("a robot");
    let scenario = Scenario::parse("measuring.md", nth_block(page, "yaml", which), &robot);
    let simulated = simulate(&robot, &scenario.unwrap_or_else(|problems| panic!("{problems}"))).expect("measured");
    let (files, folder) = (simulated.files(), Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder));
    fs::create_dir_all(&folder).expect("a folder");
    for (name, text) in [
        ("campaign.yaml", &files.campaign),
        (files.observations.0, &files.observations.1),
        ("robot.yaml", &files.robot),
        ("truth.yaml", &files.truth),
    ] {
        fs::write(folder.join(name), text).expect("a file");
    }
    let campaign = Campaign::read(folder.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"));
    assert_eq!((&campaign.robot, campaign.warnings.len()), (&robot, 0), "{:?}", campaign.warnings);
    assert_eq!(Description::read(folder.join("truth.yaml")).expect("a robot"), simulated.truth);
    (simulated, campaign)
}

/// Whether tracing gets to the bottom of it.
fn is_explained(simulated: &Simulated, campaign: &Campaign) -> bool {
    let traced = trace(campaign, &Options::default(), &|_| {}).expect("traced");
    let named = |hidden: &robstiff::Effect| {
        let hidden = hidden.to_string();
        traced.effects.iter().any(|effect| effect.effect.to_string() == hidden || effect.same_as().contains(&hidden))
    };
    println!("{} {:?}", traced.verdict, traced.effects);
    traced.verdict == Verdict::Explained && simulated.scenario.hidden.iter().all(named)
}

/// The scenarios that are shown are some that tracing gets to the bottom of.
#[test]
fn the_scenario_of_the_book_simulates_and_traces() {
    let (simulated, campaign) = simulated(1, "scenario");
    assert_eq!(campaign.noise.displacement, Some(8e-6));
    assert_eq!(campaign.holdout, Some(Holdout { fraction: 0.25, seed: 1 }));
    let Data::Displacement(data) = &campaign.data else { panic!("a campaign of displacements") };
    assert_eq!((data.poses.len(), data.visits.len(), data.rows.len()), (40, 80, 480));
    assert!(is_explained(&simulated, &campaign));
}

#[test]
fn the_scenario_of_positions_simulates_and_traces() {
    let (simulated, campaign) = simulated(2, "positions");
    let Data::Position(data) = &campaign.data else { panic!("a campaign of positions") };
    assert_eq!((data.poses.len(), data.rows.len()), (60, 120));
    assert!(is_explained(&simulated, &campaign));
}
