//! What tracing makes of a base that slips within visits.

use std::vec;

use super::tests::{names, traced};
use super::*;
use crate::campaign::made::Plan;

/// A campaign of visits of five rows at 24 poses, two a pose; the base slips within these
/// visits before this one of their rows, by so much (m), and stays there until the next
/// unloaded reading.
fn slipped(visits: &[usize], before: usize, by: [f64; 3], seed: u64) -> Campaign {
    let plan = Plan { poses: 24, noise: [4e-6; 3], ..Plan::new(seed) };
    plan.run_with(|row, reading| {
        if visits.contains(&(row / 5)) && row % 5 >= before {
            (0..3).for_each(|k| reading.displacement[k] += by[k]);
        }
    })
}

/// Lines of a visit from one of its rows on, counted from 0.
fn lines(visit: usize, from: usize) -> Vec<usize> {
    (from..5).map(|row| 5 * visit + row + 2).collect()
}

/// Each is told with the line before which it was; whether it is not rather wild is not known.
#[test]
fn a_base_that_slips_within_two_visits_is_no_two_visits_of_wild_rows() {
    for (seed, before) in (0..3).flat_map(|seed| [1, 3].map(|before| (seed, before))) {
        let found = traced(&slipped(&[18, 40], before, [1.5e-4, -2e-4, 1e-4], seed));
        assert_eq!(names(&found), ["base_slip@base", "base_slip@base"], "seed {seed}: {}", found.why);
        assert_eq!(found.verdict, Verdict::Explained, "seed {seed}: {}", found.why);
        for (slip, visit) in found.effects.iter().zip([18, 40]) {
            assert_eq!(slip.lines, lines(visit, before), "seed {seed}");
            assert_eq!(slip.same_as, ["outliers@rig", "reflector_slip@rig"], "seed {seed}");
            assert!((slip.effect.value("dy") + 2e-4).abs() < 2e-5, "seed {seed}: {:?}", slip.effect);
        }
    }
}

/// After the first row of a visit; that row is off from all others, and is not wild.
#[test]
fn the_row_before_a_slip_is_not_wild() {
    for (seed, by) in [(2, 1e-4), (7, 1e-4), (8, 1e-4), (9, 1e-4), (1, 4e-5), (1, 2e-4)] {
        let plan = Plan { ramp: vec![0.3, 0.7, 1.0, 0.7], noise: [8e-6; 3], ..Plan::new(seed) };
        let campaign = plan.run_with(|row, reading| {
            if row / 4 == 44 && row % 4 >= 1 {
                (0..3).for_each(|k| reading.displacement[k] += [-by, by, by][k]);
            }
        });
        let found = traced(&campaign);
        assert_eq!(names(&found), ["base_slip@base"], "seed {seed}, {by} m: {}", found.why);
        assert_eq!(found.effects[0].lines, [179, 180, 181], "seed {seed}, {by} m");
    }
}

/// Whatever gives way at the end of many visits is not told for sure.
#[test]
fn the_ends_of_many_visits_may_be_slips() {
    let found = traced(&slipped(&[5, 18, 24, 40], 3, [1.5e-4, -2e-4, 1e-4], 1));
    assert_eq!(names(&found), ["outliers@rig"], "{}", found.why);
    assert_eq!(found.effects[0].same_as, ["base_slip@base", "reflector_slip@rig"]);
}
