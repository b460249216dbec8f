//! What the documents show is what the programs read.

use std::fs;
use std::path::Path;

use robstiff::campaign::{Campaign, Data, Holdout};

/// The block of a language in a document.
fn block<'d>(document: &'d str, language: &str) -> &'d str {
    let rest = document.split(&format!("```{language}\n")).nth(1).expect("a block of the language");
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
