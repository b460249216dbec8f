//! How often the intervals that are reported hold the truth.

use std::string::String;

use super::identify;
use crate::campaign::made::Plan;

const UNEQUAL: [f64; 3] = [6e-6, 9e-6, 1.5e-5];

/// Half of the width of a 95 % interval, in standard deviations.
const TWO_SIDED_95: f64 = 1.96;

/// The share of 95 % intervals that hold the true compliances, over campaigns.
fn coverage(plan: impl Fn(u64) -> Plan, campaigns: u64) -> (f64, String) {
    let (mut inside, mut all) = (0, 0);
    let mut squares = 0.0;
    for seed in 0..campaigns {
        let mut campaign = plan(seed).run();
        let truth = campaign.robot.clone();
        for part in campaign.robot.joints.iter_mut().flat_map(|joint| &mut joint.compliance) {
            part.value *= 0.8;
        }
        let found = identify(&campaign).expect("all joints are seen");
        for (estimate, joint) in found.estimates.iter().zip(&truth.joints) {
            let off = (estimate.value - joint.compliance()) / estimate.std.expect("seen");
            inside += usize::from(off.abs() <= TWO_SIDED_95);
            squares += off * off;
            all += 1;
        }
    }
    let rate = f64::from(inside as u32) / f64::from(all as u32);
    (rate, std::format!("{inside} of {all}, off by {:.3} sigma", (squares / f64::from(all as u32)).sqrt()))
}

/// 200 campaigns of five joints each. The joints of one campaign are nearly
/// independent, so that the share of 1000 intervals has a standard deviation of
/// 0.7 %; 93 to 97 % is three of them about 95 %.
#[test]
fn intervals_of_95_percent_hold_the_truth() {
    for (name, shares_unloaded, noise) in [
        ("shared", true, [1e-5; 3]),
        ("separate", false, [1e-5; 3]),
        ("shared, unequal", true, UNEQUAL),
        ("separate, unequal", false, UNEQUAL),
    ] {
        let plan = |seed| Plan { poses: 40, shares_unloaded, noise, ..Plan::new(1000 + seed) };
        let (rate, told) = coverage(plan, 100);
        std::println!("{name}: {told}");
        assert!((0.93..=0.97).contains(&rate), "{name}: {told}");
    }
}
