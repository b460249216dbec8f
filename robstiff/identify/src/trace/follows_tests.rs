//! What tracing makes of readings that hardly follow the loads.

use std::vec;

use super::tests::{names, traced};
use super::*;
use crate::campaign::made::Plan;

/// Half a dozen loads at each of a few poses, with the readings so many rows further down.
fn shifted(rows: usize, seed: u64) -> Campaign {
    let mut campaign = Plan { poses: 12, ramp: vec![0.5, 1.0], noise: [4e-6; 3], ..Plan::new(seed) }.run();
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
    let mut readings: Vec<[f64; 3]> = data.rows.iter().map(|row| row.displacement).collect();
    readings.rotate_right(rows);
    data.rows.iter_mut().zip(readings).for_each(|(row, reading)| row.displacement = reading);
    campaign
}

/// Each reading belongs to the load of the row before it.
#[test]
fn readings_one_row_off_are_not_adequate() {
    for seed in 0..6 {
        let found = traced(&shifted(1, seed));
        assert_eq!((names(&found), found.verdict), (vec![], Verdict::Insufficient), "seed {seed}: {}", found.why);
        let said = "the readings hardly follow the loads: ";
        assert!(found.why.starts_with(said) && found.why.contains("mixed up"), "seed {seed}: {}", found.why);
        assert_eq!(traced(&shifted(0, seed)).verdict, Verdict::Adequate, "seed {seed}");
    }
}

/// Noise that is half of what is read, by the squares, is much, and can be lived with.
#[test]
fn loads_that_are_small_against_the_noise_are_read_all_the_same() {
    let read = |noise: f64, seed| Plan { poses: 40, noise: [noise; 3], ..Plan::new(seed) }.run();
    for seed in 0..4 {
        let Data::Displacement(exact) = read(0.0, seed).data else { unreachable!("displacements") };
        let squares = exact.rows.iter().flat_map(|row| row.displacement).map(|reading| reading * reading);
        let displaced = (squares.sum::<f64>() / (3 * exact.rows.len()) as f64).sqrt();
        let found = traced(&read(displaced / 2_f64.sqrt(), seed));
        assert_eq!((names(&found), found.verdict), (vec![], Verdict::Adequate), "seed {seed}: {}", found.why);
    }
}
