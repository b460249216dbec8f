//! Arms that lack nothing but the right compliances of their joints.

use robstiff::Effect;
use robstiff_identify::trace::{Trace, Verdict};
use robstiff_robots::Description;
use robstiff_tests::simulator::{five_axis, scattered, six_axis};

use crate::bench::{FLOOR, SCATTER_SEED, arm, assert_most, plan, trace_files, traced};

/// A name in at most one of twelve: the level is 1 % a campaign.
#[test]
fn nothing_is_named() {
    let traces: Vec<(u64, Trace)> = (100..112).map(|seed| (seed, traced(&arm(seed), &[], seed))).collect();
    assert_most("no name", 11, &traces, |_, trace| {
        trace.effects.is_empty() && (0.9..1.1).contains(&(trace.after.rms / FLOOR))
    });
    // Another 1 % finds structure.
    let adequate = |_, trace: &Trace| trace.verdict == Verdict::Adequate;
    assert_most("adequate", 11, &traces, adequate);

    // The joints are where they are said to be, within what is said: some
    // fifty deviations over their standard deviations, of mean square 1.
    let mut deviations = Vec::new();
    for (seed, trace) in traces.iter().filter(|(_, trace)| trace.verdict == Verdict::Adequate) {
        let truth = scattered(&arm(*seed), 0.7..1.3, seed + SCATTER_SEED);
        for (estimate, joint) in trace.estimates.iter().zip(&truth.joints) {
            deviations.extend(estimate.std.map(|std| (estimate.value - joint.compliance()) / std));
        }
    }
    let spread = (deviations.iter().map(|d| d * d).sum::<f64>() / deviations.len() as f64).sqrt();
    println!("{} deviations of spread {spread:.3}", deviations.len());
    assert!(deviations.len() > 40 && (0.8..1.25).contains(&spread), "{spread}");
    assert!(deviations.iter().all(|deviation| deviation.abs() < 4.5), "{deviations:?}");
}

/// What a description declares is not named again.
#[test]
fn what_is_declared_is_not_missing() {
    let declared = |mut arm: Description| {
        arm.effects.push(Effect::TransverseCompliance { joint: 3, value: 3e-7 });
        arm
    };
    let arms = [declared(five_axis()), declared(six_axis())];
    let traces: Vec<(u64, Trace)> =
        (120..123).flat_map(|seed| arms.each_ref().map(|arm| (seed, traced(arm, &[], seed)))).collect();
    assert_most("nothing beyond what is declared", 5, &traces, |_, trace| {
        let tilt = trace.estimates.last().expect("an effect");
        trace.verdict == Verdict::Adequate
            && tilt.name == "transverse_compliance@joint 3"
            && (tilt.value - 3e-7).abs() < 4.0 * tilt.std.expect("seen")
    });
}

/// Readings of the force that are all 20 % too large are compliances that are
/// all too small; no effect has anything to do with it.
#[test]
fn a_common_scale_is_one_of_all_joints() {
    let arm = six_axis();
    let traces: Vec<(u64, Trace)> = (130..133)
        .map(|seed| {
            let mut simulated = plan(&arm, &[], seed).run();
            simulated.rows.iter_mut().flat_map(|row| &mut row.wrench).for_each(|force| *force *= 1.2);
            (seed, trace_files(&simulated, &arm, ""))
        })
        .collect();
    assert_most("a common scale", 3, &traces, |_, trace| trace.verdict == Verdict::Adequate);
}
