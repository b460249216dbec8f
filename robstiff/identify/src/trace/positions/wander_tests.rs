//! What goes there and back, held against slips.

use core::f64::consts::TAU;
use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::tests::{names, six_axis, traced};
use crate::campaign::PositionRow;
use crate::campaign::made_positions::Plan;
use crate::probability::normal;
use crate::trace::Verdict;

/// Moves each reading by a course, along a line.
fn along(course: impl Fn(f64) -> f64) -> impl FnMut(usize, &mut PositionRow) {
    move |row: usize, read: &mut PositionRow| {
        let by = course(row as f64 / 60.0) * Vector3::new(0.6, -0.5, 0.62);
        read.position = (Vector3::from(read.position) + by).into();
    }
}

/// One wave over a campaign is no slip, though half of it is like one.
#[test]
fn a_drift_that_comes_back_is_no_slip() {
    for (seed, amplitude) in [(1_u32, 8e-5), (2, 1.2e-4), (3, 2.4e-4), (4, 1.2e-4)] {
        let phase = 0.7 * f64::from(seed);
        let wave = along(|at| amplitude * (TAU * at + phase).sin());
        let trace = traced(&Plan::new(six_axis(), u64::from(seed)).run_with(wave));
        let slips = names(&trace).into_iter().filter(|name| name.contains("slip"));
        assert_eq!(slips.collect::<Vec<_>>(), Vec::<String>::new(), "{seed}: {}", trace.why);
        assert_ne!(trace.verdict, Verdict::Adequate);
    }
}

/// Nor is a walk, of which a step is part.
#[test]
fn a_walk_is_no_slip_alone() {
    let mut as_it_should_be = 0;
    for seed in 0..8 {
        let (mut random, mut at) = (ChaCha8Rng::seed_from_u64(seed), Vector3::zeros());
        let walk = |_: usize, read: &mut PositionRow| {
            at += Vector3::from_fn(|_, _| 1.2e-4 / 60_f64.sqrt() * normal(&mut random));
            read.position = (Vector3::from(read.position) + at).into();
        };
        let trace = traced(&Plan::new(six_axis(), seed).run_with(walk));
        let slips = names(&trace).iter().filter(|name| name.contains("slip")).count();
        as_it_should_be += usize::from(slips == 0 || trace.verdict == Verdict::Partial);
    }
    assert!(as_it_should_be >= 7, "{as_it_should_be} of 8");
}

/// A slip keeps its name, whenever it was and however little.
#[test]
fn a_slip_is_no_drift() {
    for (seed, (moment, size)) in (1..).zip([(8, 2e-4), (20, 1e-4), (30, 8e-5), (40, 1e-3), (55, 3e-4)]) {
        let slip = along(|at| if at >= f64::from(moment) / 60.0 { size } else { 0.0 });
        let trace = traced(&Plan::new(six_axis(), seed).run_with(slip));
        assert_eq!((names(&trace), trace.verdict), (vec!["base_slip@base".to_string()], Verdict::Explained), "{seed}");
    }
}
