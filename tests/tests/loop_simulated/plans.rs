//! Other plans of a campaign: noise that is stated, rotations measured, poses
//! held out, large loads.

use robstiff::Effect;
use robstiff_identify::trace::{NoiseSource, Trace, Verdict};
use robstiff_tests::simulator::Scenario;

use crate::bench::{FLOOR, NOISE, arm, assert_most, names_all, plan, trace_files, trace_text};

const TILT: Effect = Effect::TransverseCompliance { joint: 3, value: 3e-7 };

/// Four campaigns, changed from the usual plan.
fn campaigns(hidden: &[Effect], change: impl Fn(Scenario) -> Scenario, more: &str) -> Vec<(u64, Trace)> {
    let trace = |seed| (seed, trace_files(&change(plan(&arm(seed), hidden, seed)).run(), &arm(seed), more));
    (500..504).map(trace).collect()
}

fn is_found(trace: &Trace) -> bool {
    names_all(trace, &[TILT])
        && trace.verdict == Verdict::Explained
        && (0.85..1.15).contains(&(trace.after.rms / FLOOR))
}

#[test]
fn noise_is_taken_as_stated() {
    let states = |scenario| Scenario { states_noise: true, ..scenario };
    let stated = |trace: &Trace| {
        assert_eq!(trace.noise_source, NoiseSource::Declared);
        assert!((trace.noise / NOISE - 1.0).abs() < 1e-12, "{}", trace.noise);
    };
    assert_most("with stated noise", 3, &campaigns(&[TILT], states, ""), |_, trace| {
        stated(trace);
        is_found(trace)
    });
    assert_most("nothing, with stated noise", 3, &campaigns(&[], states, ""), |_, trace| {
        stated(trace);
        trace.verdict == Verdict::Adequate
    });
}

#[test]
fn noise_is_estimated_where_it_is_not_stated() {
    assert_most("without stated noise", 3, &campaigns(&[TILT], |scenario| scenario, ""), |_, trace| {
        assert_ne!(trace.noise_source, NoiseSource::Declared);
        is_found(trace) && (0.85..1.15).contains(&(trace.noise / NOISE))
    });
}

/// Less noise than there is: what is left looks like structure, and says so.
#[test]
fn noise_that_is_stated_too_small_is_noticed() {
    let more = "noise: {displacement: 5 um}\n";
    assert_most("too small a noise", 3, &campaigns(&[], |scenario| scenario, more), |_, trace| {
        trace.verdict == Verdict::Unexplained && trace.unexplained > 0.5
    });
}

/// One load a visit, and an unloaded reading for each row: no load comes twice, so the noise is stated.
#[test]
fn rows_without_a_shared_reading() {
    let own =
        |scenario| Scenario { ramp: vec![1.0], visits: 5, shares_unloaded: false, states_noise: true, ..scenario };
    assert_most("rows of their own", 3, &campaigns(&[TILT], own, ""), |_, trace| is_found(trace));
}

/// A good tracker sees that large loads act on the arm as they have bent it,
/// which is no effect that is missing.
#[test]
fn what_a_bent_arm_does_is_not_missing() {
    let precise = |scenario| Scenario { noise: 2e-6, force: [1500.0, 2500.0], ..scenario };
    assert_most("large loads, little noise", 3, &campaigns(&[], precise, ""), |_, trace| {
        trace.verdict == Verdict::Adequate
    });
}

/// Moments and rotations make all joints of the wrist visible; without them the
/// flange axis of the six-axis arm goes through the point that is read.
#[test]
fn rotations_are_used() {
    let turned = |scenario| Scenario { rotation_noise: Some(5e-5), moment: Some([50.0, 200.0]), ..scenario };
    let sees_the_last_joint =
        |trace: &Trace| trace.estimates.iter().rfind(|e| e.name.starts_with("joint")).is_some_and(|e| e.std.is_some());
    let traces = campaigns(&[TILT], turned, "");
    assert_most("with rotations", 3, &traces, |_, trace| is_found(trace) && sees_the_last_joint(trace));
    for (_, trace) in campaigns(&[TILT], |scenario| scenario, "") {
        assert_eq!(sees_the_last_joint(&trace), trace.robot == "Rv130hsc");
    }
}

/// Readings at a marker beside the tool and pulls at a hook, as a rig has them,
/// each given in the frame and at the point that the campaign says.
#[test]
fn readings_and_loads_off_the_tcp() {
    let off = |scenario| Scenario {
        marker: [0.18, -0.12, 0.1],
        hook: [-0.06, 0.1, 0.15],
        measured_in_tool: true,
        wrench_in_tool: true,
        ..scenario
    };
    assert_most("off the tcp", 3, &campaigns(&[TILT], off, ""), |_, trace| is_found(trace));
    assert_most("nothing, off the tcp", 3, &campaigns(&[], off, ""), |_, trace| trace.verdict == Verdict::Adequate);
    // Taken for readings of the TCP, they are another arm's.
    let seen_wrongly = "measured: {frame: tool, at: tcp}";
    for (seed, declared) in [500, 501].map(|seed| (seed, arm(seed))) {
        let simulated = off(plan(&declared, &[], seed)).run();
        let said = simulated.campaign_yaml().replace("measured: {frame: tool, at: [0.18, -0.12, 0.1]}", seen_wrongly);
        assert!(said.contains(seen_wrongly));
        let trace = trace_text(&simulated, &declared, &said);
        assert!(trace.verdict != Verdict::Adequate, "{seed}: {}", trace.why);
    }
}

#[test]
fn held_out_poses_judge() {
    let traces = campaigns(&[TILT], |scenario| scenario, "holdout: {fraction: 0.25, seed: 3}\n");
    assert_most("with poses held out", 3, &traces, |_, trace| {
        assert_eq!((trace.poses, trace.held_out.len()), (40, 10));
        assert_eq!(trace.pose_errors.iter().filter(|pose| pose.held_out).count(), 10);
        is_found(trace)
            && (0.8..1.25).contains(&(trace.after.holdout_rms / FLOOR))
            && trace.identified.holdout_rms > 1.5 * trace.after.holdout_rms
    });
    // Other poses with another seed.
    let other = campaigns(&[TILT], |scenario| scenario, "holdout: {fraction: 0.25, seed: 4}\n");
    assert_ne!(traces[0].1.held_out, other[0].1.held_out);
}
