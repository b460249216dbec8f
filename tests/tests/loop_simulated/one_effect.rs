//! One effect that no description is told of.
//!
//! Sizes: the typical ones where these leave about twice the noise of a reading once
//! the joints have been identified again (the tilt of joints 2 and 3 leaves
//! three to fourteen times), and larger where the joints take most of it: a typical
//! coupling leaves 1.3 times the noise, a typical tool 0.3 to 0.6 times, and the
//! six-axis arm takes that for its own. Each test asserts what its effect
//! leaves.

use robstiff::Effect;
use robstiff_identify::trace::{Trace, Verdict};
use robstiff_robots::Description;
use robstiff_tests::simulator::scattered;

use crate::bench::{FLOOR, NOISE, SCATTER_SEED, arm, assert_most, names_all, traced};

/// Standard deviations that an estimate may be from the truth.
const FEW: f64 = 4.0;

fn tilt(joint: usize, value: f64) -> Effect {
    Effect::TransverseCompliance { joint, value }
}

/// A foundation of twice the typical tilt; what it moves besides is nothing
/// against that.
const BASE: Effect = Effect::BaseCompliance { tilt: 4e-8, translation: 0.0 };

/// A slender tool. One of 3e-7 rad/Nm and 1e-8 m/N leaves 3 to 6 um, half the
/// noise at most: the joints of a wrist take it for their own.
const TOOL: Effect = Effect::ToolCompliance { rotation: 6e-6, translation: 1e-7 };

/// Half of what the joints' compliances allow at most.
fn coupling(value: f64) -> Effect {
    Effect::JointCoupling { joints: [2, 3], value }
}

#[test]
fn tilt_of_joint_2() {
    is_found(tilt(2, 2e-7));
}

#[test]
fn tilt_of_joint_3() {
    is_found(tilt(3, 3e-7));
}

#[test]
fn base() {
    is_found(BASE);
}

#[test]
fn tool() {
    is_found(TOOL);
}

#[test]
fn coupling_of_two_joints() {
    is_found(coupling(1.4e-7));
}

#[test]
fn opposing_coupling() {
    is_found(coupling(-1.4e-7));
}

fn is_found(hidden: Effect) {
    let traces: Vec<(u64, Trace)> = (200..204).map(|seed| (seed, traced(&arm(seed), &[hidden], seed))).collect();
    let variance = |trace: &Trace| trace.identified.rms.powi(2) - FLOOR * FLOOR;
    let left = (traces.iter().map(|(_, trace)| variance(trace)).sum::<f64>() / traces.len() as f64).sqrt();
    assert!(left > 1.8 * NOISE, "{hidden} leaves {left:e} m, too little to judge by");
    assert_most(&hidden.to_string(), 3, &traces, |seed, trace| {
        names_all(trace, &[hidden])
            && trace.verdict == Verdict::Explained
            && trace.effects[0].probability >= 0.95
            && (0.9..1.1).contains(&(trace.after.rms / FLOOR))
            && trace.after.holdout_rms < trace.identified.holdout_rms
            && numbers_are_near(trace, hidden)
            && joints_are_near(trace, &scattered(&arm(seed), 0.7..1.3, seed + SCATTER_SEED))
    });
}

/// Whether the numbers of the effect are the hidden ones, each told with a
/// standard deviation; those that were left out, zero.
fn numbers_are_near(trace: &Trace, hidden: Effect) -> bool {
    let named = &trace.effects[0];
    if named.effect.kind() != hidden.kind() || named.effect.place() != hidden.place().into() {
        // What the data cannot tell from it has numbers of its own.
        return true;
    }
    if let Effect::ToolCompliance { .. } = hidden {
        // A tool that turns and shifts may be found as one that shifts unequally: under forces it does the same.
        return true;
    }
    let expected = |name: &str| match (hidden, name) {
        (Effect::TransverseCompliance { value, .. }, "h") | (Effect::JointCoupling { value, .. }, "c") => value,
        (Effect::BaseCompliance { tilt, .. }, "tilt") => tilt,
        (Effect::BaseCompliance { translation, .. }, "translation") => translation,
        _ => panic!("{hidden} has no {name}"),
    };
    let near = |value: f64, expected: f64, std: f64| (value - expected).abs() < FEW * std;
    named.effect.parameters.iter().all(|p| near(p.value, expected(p.name), p.std.expect("a compliance has one")))
}

fn joints_are_near(trace: &Trace, truth: &Description) -> bool {
    trace
        .estimates
        .iter()
        .zip(&truth.joints)
        .all(|(estimate, joint)| estimate.std.is_none_or(|std| (estimate.value - joint.compliance()).abs() < FEW * std))
}
