//! A clean robot passes at the stated level.

use std::collections::BTreeMap;
use std::format;
use std::string::String;
use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::tests::{finding, plan, push};
use super::*;
use crate::campaign::Data;
use crate::campaign::made::Plan;
use crate::probability::normal;
use robstiff::Effect;

/// 160 campaigns in which nothing is wrong with the readings, whatever the
/// description lacks: at 1 % more than 5 say something with a probability of
/// 0.6 %.
#[test]
fn a_clean_robot_passes() {
    let mut said: Vec<String> = Vec::new();
    for seed in 0..160 {
        let mut plan = Plan { poses: 16, ..plan(1000 + seed) };
        plan.shares_unloaded = seed % 2 == 0;
        plan.noise = if seed % 3 == 0 { [6e-6, 9e-6, 1.5e-5] } else { [1e-5; 3] };
        if seed % 4 == 1 {
            plan.hidden = vec![Effect::TransverseCompliance { joint: 3, value: 6e-7 }];
        }
        if seed % 4 == 2 {
            (plan.visits, plan.poses, plan.there_and_back) = (2, 24, false);
        }
        let mut campaign = plan.run();
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        for part in campaign.robot.joints.iter_mut().flat_map(|joint| &mut joint.compliance) {
            part.value *= random.random_range(0.7..1.3);
        }
        said.extend(triage(&campaign).violated().map(|(check, finding)| format!("{seed} {}: {finding:?}", check.name)));
    }
    assert!(said.len() <= 5, "{said:#?}");
}

/// Without Holm's correction each check keeps its own level: of 160 campaigns
/// no check has more p-values up to 5 % than 17, with a probability of 0.2 %.
#[test]
fn each_check_keeps_its_level() {
    let mut small: BTreeMap<&str, u32> = BTreeMap::new();
    for seed in 0..160 {
        let plan = Plan { poses: 14, shares_unloaded: seed % 2 == 0, ..plan(3000 + seed) };
        for (check, finding) in triage(&plan.run()).asked() {
            *small.entry(check.name).or_default() += u32::from(finding.p_value.is_some_and(|p| p <= 0.05));
        }
    }
    std::println!("{small:?}");
    assert!(small.values().all(|count| *count <= 17), "{small:?}");
}

#[test]
fn holm_counts_what_was_asked() {
    let adjusted = holm([Some(0.01), None, Some(0.04), Some(0.02)].into_iter());
    assert_eq!(adjusted, [Some(0.03), None, Some(0.04), Some(0.04)]);
}

/// What two loads of one visit have in common is no violation: of 100 campaigns
/// more than 12 are at or below 5 % with a probability of 0.1 %.
#[test]
fn loads_of_one_visit_share_its_unloaded_reading() {
    let below = |seed: &u64| {
        let mut random = ChaCha8Rng::seed_from_u64(*seed);
        let mut noise = || Vector3::from_fn(|_, _| 1e-5 * normal(&mut random));
        let plan = Plan { poses: 16, visits: 3, ramp: vec![0.5, 1.0], noise: [0.0; 3], ..Plan::new(4000 + seed) };
        let mut unloaded = Vector3::zeros();
        let mut campaign = plan.run_with(|i, row| {
            unloaded = if i % 6 == 0 { noise() } else { unloaded };
            push(row, noise() - unloaded);
        });
        let Data::Displacement(data) = &mut campaign.data else { unreachable!("made of displacements") };
        data.visits = data.poses.clone();
        data.rows.iter_mut().for_each(|row| row.visit = row.pose);
        finding(&triage(&campaign), "reciprocity").p_value.is_some_and(|p| p <= 0.05)
    };
    let count = (0..100).filter(below).count();
    assert!(count <= 12, "{count} of 100");
}
