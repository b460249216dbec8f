//! What the documents show is what the programs read.

use std::fs;
use std::path::Path;

use robstiff::campaign::{Campaign, Data, Holdout};
use robstiff::simulate::{Scenario, simulate};
use robstiff::trace::{Options, Verdict, trace};
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
fn the_campaign_of_the_readme_reads() {
    let readme = include_str!("../../robots/measured/README.md");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("documents");
    fs::create_dir_all(&folder).expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).expect("a file");
    write("campaign.yaml", block(readme, "yaml"));
    write("loads.csv", block(readme, "csv"));
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

/// The scenario that is shown is one that tracing gets to the bottom of.
#[test]
fn the_scenario_of_the_readme_simulates_and_traces() {
    let readme = include_str!("../../robots/measured/README.md");
    let robot = Description::parse("robot.yaml", include_str!("../../robots/kuka-kr270-r2700.yaml")).expect("a robot");
    let scenario = Scenario::parse("README.md", nth_block(readme, "yaml", 2), &robot);
    let simulated = simulate(&robot, &scenario.unwrap_or_else(|problems| panic!("{problems}"))).expect("measured");
    let (files, folder) = (simulated.files(), Path::new(env!("CARGO_TARGET_TMPDIR")).join("scenario"));
    fs::create_dir_all(&folder).expect("a folder");
    for (name, text) in [
        ("campaign.yaml", &files.campaign),
        ("loads.csv", &files.loads),
        ("robot.yaml", &files.robot),
        ("truth.yaml", &files.truth),
    ] {
        fs::write(folder.join(name), text).expect("a file");
    }
    let campaign = Campaign::read(folder.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"));
    assert_eq!((&campaign.robot, campaign.warnings.len()), (&robot, 0), "{:?}", campaign.warnings);
    assert_eq!(campaign.noise.displacement, Some(8e-6));
    assert_eq!(campaign.holdout, Some(Holdout { fraction: 0.25, seed: 1 }));
    let Data::Displacement(data) = &campaign.data else { panic!("a campaign of displacements") };
    assert_eq!((data.poses.len(), data.visits.len(), data.rows.len()), (40, 80, 480));
    assert_eq!(Description::read(folder.join("truth.yaml")).expect("a robot"), simulated.truth);
    let traced = trace(&campaign, &Options::default(), &|_| {}).expect("traced");
    let hidden = simulated.scenario.hidden[0].to_string();
    let named =
        |effect: &robstiff::trace::NamedEffect| effect.effect.to_string() == hidden || effect.same_as.contains(&hidden);
    assert!(traced.verdict == Verdict::Explained && traced.effects.iter().any(named), "{:?}", traced.effects);
}
