//! Slips of displacements, and what is like them.

use core::f64::consts::TAU;
use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::WORDS;
use crate::campaign::made::Plan;
use crate::campaign::{Holdout, Observation};
use crate::identify::holdout::training;
use crate::probability::normal;
use crate::trace::tests::{names, traced};
use crate::trace::{Trace, Verdict};

/// Thirty poses under three loads each, all held against an unloaded reading from before.
fn plan(seed: u64) -> Plan {
    Plan { poses: 30, visits: 1, ramp: vec![0.35, 0.7, 1.0], ..Plan::new(seed) }
}

const ROWS: f64 = 90.0;

/// A campaign in which readings move by so much (m) at each row.
fn moved(plan: &Plan, mut course: impl FnMut(usize) -> Vector3<f64>) -> Trace {
    traced(&plan.run_with(|row, read: &mut Observation| {
        let by = course(row);
        (0..3).for_each(|axis| read.displacement[axis] += by[axis]);
    }))
}

fn slips(trace: &Trace) -> Vec<String> {
    names(trace).into_iter().filter(|name| name.contains("slip")).collect()
}

/// The base wanders, a step a row.
#[test]
fn a_walk_is_no_slip() {
    let (mut told, mut as_it_should_be, mut all) = (0, 0, Vec::new());
    for seed in 0..6 {
        let (mut random, mut at) = (ChaCha8Rng::seed_from_u64(seed), Vector3::zeros());
        let trace = moved(&plan(seed), |_| {
            at += Vector3::from_fn(|_, _| 8e-5 / ROWS.sqrt() * normal(&mut random));
            at
        });
        told += usize::from(trace.looks_like.contains(&WORDS.to_string()));
        as_it_should_be += usize::from(slips(&trace).is_empty() || trace.verdict == Verdict::Partial);
        all.push((names(&trace), trace.verdict, trace.looks_like));
    }
    assert!(as_it_should_be >= 5 && told >= 1, "{as_it_should_be} and {told} of 6: {all:?}");
}

/// One wave over a campaign is no slip, though half of it is like one.
#[test]
fn a_drift_that_comes_back_is_no_slip() {
    let mut all = Vec::new();
    for (seed, amplitude) in [(1_u32, 3e-5), (2, 5e-5), (3, 8e-5), (4, 5e-5)] {
        let phase = 0.7 * f64::from(seed);
        let along = amplitude * Vector3::new(0.6, -0.5, 0.62);
        let trace = moved(&plan(seed.into()), |row| along * (TAU * row as f64 / ROWS + phase).sin());
        all.push((slips(&trace), names(&trace), trace.verdict));
    }
    assert!(all.iter().all(|(slips, _, verdict)| slips.is_empty() && *verdict != Verdict::Adequate), "{all:?}");
}

/// A slip keeps its name, whenever it was and however little.
#[test]
fn a_slip_is_no_drift() {
    for (seed, (moment, size)) in (1..).zip([(12, 1e-4), (40, 6e-5), (60, 2e-4), (72, 1e-4)]) {
        let by = size * Vector3::new(0.6, -0.5, 0.62);
        let trace = moved(&plan(seed), |row| if row >= moment { by } else { Vector3::zeros() });
        assert_eq!((names(&trace), trace.verdict), (vec!["base_slip@base".to_string()], Verdict::Explained), "{seed}");
    }
}

/// A pose held out beside a slip neither chooses when it was nor judges it: what is told is
/// the same on whichever side of the slip it is.
#[test]
fn a_pose_held_out_beside_a_slip_chooses_nothing() {
    let by = 6e-5 * Vector3::new(0.6, -0.5, 0.62);
    for seed in [1, 3, 4] {
        let plan = plan(seed);
        let holdout = Some(Holdout { fraction: 0.25, seed });
        let fitted_to = training(plan.poses, holdout);
        let alone = |&pose: &usize| fitted_to[pose - 1] && !fitted_to[pose] && fitted_to[pose + 1];
        let pose = (5..25).find(alone).expect("one of seven of thirty");
        let [with, without] = [3 * pose, 3 * pose + 3].map(|moment| {
            let mut campaign = plan.run_with(|row, read: &mut Observation| {
                let by = if row >= moment { by } else { Vector3::zeros() };
                (0..3).for_each(|axis| read.displacement[axis] += by[axis]);
            });
            campaign.holdout = holdout;
            traced(&campaign)
        });
        assert_eq!((names(&with), with.verdict), (vec!["base_slip@base".to_string()], Verdict::Explained), "{seed}");
        // The header is line 1.
        assert_eq!(with.undecided, [3 * pose + 2, 3 * pose + 3, 3 * pose + 4]);
        assert_eq!(with.effects[0].effect, without.effects[0].effect);
        let errors = |trace: &Trace| (trace.estimates.clone(), trace.after, trace.undecided.clone(), trace.verdict);
        assert_eq!(errors(&with), errors(&without));
    }
}
