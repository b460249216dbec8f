//! Displacements of a reflector that is elsewhere than the file says.

use std::string::String;
use std::vec::Vec;

use super::tests::{names, traced};
use super::{Rival, Trace, Verdict};
use crate::campaign::made::Plan;
use crate::campaign::{Campaign, Data};

/// Where the reflector is less where the file says (m).
const OFF: [f64; 3] = [0.06, -0.05, 0.08];

/// A campaign whose file has the reflector at another point than it was at, and the load so far
/// from where it acts (m).
fn campaign(lever: [f64; 3], seed: u64) -> Campaign {
    let mut campaign = Plan { at: [lever, [0.16, -0.05, 0.08]], ..Plan::new(seed) }.run();
    if let Data::Displacement(data) = &mut campaign.data {
        data.wrench_at = [0.0; 3];
        data.measured_at = core::array::from_fn(|k| data.measured_at[k] - OFF[k]);
    }
    campaign
}

/// The names that are told, in their order in the alphabet, with no effect of the robot.
fn told(trace: &Trace) -> Vec<String> {
    assert!(trace.verdict == Verdict::Explained && trace.description.effects.is_empty(), "{}", trace.why);
    let mut names = names(trace);
    names.sort();
    names
}

/// The last rows of the table with a lever of the load come to nearly the same, which takes four
/// names.
#[test]
fn a_reflector_that_is_elsewhere_is_named() {
    for seed in 1..=3 {
        let trace = traced(&campaign([0.0; 3], seed));
        assert_eq!(told(&trace), ["reflector_offset@rig"], "{seed}");
        for (number, off) in trace.effects[0].effect.parameters.iter().zip(OFF) {
            let std = number.std.expect("a length has one");
            assert!((number.value - off).abs() < 4.0 * std && std < 0.01, "{seed}: {number:?}");
        }
    }
}

/// Where the load is elsewhere, too, three errors of the last row and a lever do the very same:
/// the reflector is told, and they are its rival.
#[test]
fn a_last_row_that_would_do_the_same_is_a_rival() {
    for seed in 1..=3 {
        let trace = traced(&campaign([0.05, 0.03, -0.04], seed));
        assert_eq!(told(&trace), ["lever_arm@rig", "reflector_offset@rig"], "{seed}");
        let of_table = |rival: &Rival| rival.names.iter().filter(|name| !name.ends_with("@rig")).count();
        assert!(trace.rivals.iter().any(|rival| of_table(rival) == 3), "{seed}: {:?}", trace.rivals);
    }
}
