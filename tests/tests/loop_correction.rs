//! The correction that is no physics: it is there where something smooth is left
//! that has no name, helps at poses that nobody measured, and is not there where
//! nothing is left.

use std::fs;
use std::path::PathBuf;

use nalgebra::{SVector, Vector3, Vector6};
use robstiff::with_robot;
use robstiff_identify::campaign::Campaign;
use robstiff_identify::identify::predict;
use robstiff_identify::trace::{Correction, Options, trace};
use robstiff_tests::matrix::interval::fewest;
use robstiff_tests::matrix::{Case, Group, Ready};
use robstiff_tests::simulator::{Scenario, Simulated};

const SEED: u64 = 4711;

/// So many campaigns are corrected, where something is left.
const CORRECTED: usize = 10;

fn read(simulated: &Simulated, ready: &Ready) -> Campaign {
    let thread = format!("{:?}", std::thread::current().id()).replace(['(', ')'], "");
    let folder: PathBuf = std::env::temp_dir().join(format!("robstiff-correction-{}-{thread}", std::process::id()));
    simulated.write(&folder, &ready.declared.to_yaml()).expect("a temporary folder");
    let campaign = Campaign::read(folder.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"));
    fs::remove_dir_all(&folder).expect("the folder that was just made");
    campaign
}

/// The rms error at ten other poses without noise, without and with a correction.
fn elsewhere(ready: &Ready, description: &robstiff_robots::Description, correction: &Correction) -> [f64; 2] {
    let seed = ready.scenario.seed.wrapping_add(1 << 32);
    let scenario = Scenario { poses: 10, seed, noise: 0.0, rotation_noise: None, ..ready.scenario.clone() };
    let simulated = scenario.run();
    let campaign = read(&simulated, ready);
    let prediction = predict(description, &campaign).expect("displacements");
    let mut squares = [0.0; 2];
    for (row, predicted) in simulated.rows.iter().zip(&prediction.rows) {
        let left = Vector3::from(row.displacement) - Vector3::from(predicted.predicted);
        let wrench = Vector6::from(row.acting);
        let moved: Vector6<f64> = with_robot!(description, |robot| {
            correction.displacement(&robot, &SVector::from_column_slice(&row.q), &wrench)
        });
        squares[0] += left.norm_squared();
        squares[1] += (left - moved.fixed_rows::<3>(0)).norm_squared();
    }
    squares.map(|sum| (sum / (3 * simulated.rows.len()) as f64).sqrt())
}

#[test]
fn what_has_no_name_can_be_corrected() {
    let mut corrected = 0;
    for replicate in 0..CORRECTED {
        let ready = Case::new(Group::Outside("cross_dependence"), replicate, SEED).ready();
        let campaign = read(&ready.scenario.run(), &ready);
        let traced = trace(&campaign, &Options::default(), &|_| {}).expect("displacements");
        let Some(found) = Correction::of(&campaign, &traced) else { continue };
        assert!(found.unseen[1] < found.unseen[0]);
        let [without, with] = elsewhere(&ready, &traced.description, &found);
        println!("{replicate}: {:?}, elsewhere {without:e} {with:e}", found.unseen);
        assert!(with < without, "replicate {replicate}: {without:e} {with:e}");
        corrected += 1;
    }
    // A joint whose compliance goes with another's angle is what it is made of; where another
    // name stands for most of it, or little is left, there is none. Of sixteen it was ten.
    assert!(corrected >= fewest(CORRECTED, 0.6, 1e-2), "{corrected} of {CORRECTED}");
}

#[test]
fn where_nothing_is_left_there_is_none() {
    let found = (0..12).filter(|&replicate| {
        let ready = Case::new(Group::Nothing, replicate, SEED).ready();
        let campaign = read(&ready.scenario.run(), &ready);
        let traced = trace(&campaign, &Options::default(), &|_| {}).expect("displacements");
        Correction::of(&campaign, &traced).is_some()
    });
    // Two standard errors: 2.3 % by chance each, and a ridge that is large leaves
    // next to nothing to win by.
    assert!(found.count() <= 2);
}
