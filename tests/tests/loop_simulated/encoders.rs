//! Encoders behind the gears, and of the motors: what they see is in a gear, what
//! they do not see is in none.
//!
//! Seeds 700.. are those of this file. A second of arc is what such encoders
//! resolve; a gear's own errors are 30 urad, one number a pose and joint.

use robstiff::Effect;
use robstiff_identify::trace::{Trace, Verdict};
use robstiff_robots::Description;
use robstiff_tests::simulator::{Encoders, Scenario, five_axis, six_axis};

use crate::bench::{assert_most, names_all, plan, told, trace_files};

const BEHIND_GEARS: Encoders = Encoders { output: Some(5e-6), apart: 3e-5, motors: None };

/// With a small load in every visit.
const RAMP: [f64; 6] = [0.03, 0.35, 0.7, 1.0, 0.7, 0.35];

fn few(arm: &Description, hidden: &[Effect], poses: usize, seed: u64, encoders: Option<Encoders>) -> Scenario {
    Scenario { poses, ramp: RAMP.to_vec(), encoders, ..plan(arm, hidden, seed) }
}

/// Traces without encoders and with them, of the same poses, loads and noise.
fn both(arm: &Description, hidden: &[Effect], poses: usize, seeds: std::ops::Range<u64>) -> [Vec<(u64, Trace)>; 2] {
    let all = |encoders| {
        let of = |seed| (seed, trace_files(&few(arm, hidden, poses, seed, encoders).run(), arm, ""));
        seeds.clone().map(of).collect()
    };
    [all(None), all(Some(BEHIND_GEARS))]
}

fn is_alone(trace: &Trace, hidden: &[Effect]) -> bool {
    names_all(trace, hidden)
        && trace.verdict == Verdict::Explained
        && trace.effects.iter().all(|named| named.same_as().is_empty())
        && hidden.iter().all(|effect| trace.effects.iter().any(|named| named.effect.to_string() == effect.to_string()))
}

/// How many are named, and nothing beside or instead.
fn count(traces: &[(u64, Trace)], hidden: &[Effect]) -> usize {
    traces.iter().filter(|(_, trace)| is_alone(trace, hidden)).count()
}

/// At twelve poses the tool alone hardly shows two joints with a shaft in common.
#[test]
fn a_coupling_is_named_with_less_data() {
    let (arm, hidden) = (six_axis(), [Effect::JointCoupling { joints: [2, 3], value: 6e-8 }]);
    let [without, with] = both(&arm, &hidden, 12, 700..706);
    assert!(count(&without, &hidden) <= 2, "named without encoders: {}", told(&without[0].1));
    assert_most("a coupling, with encoders", 5, &with, |_, trace| {
        let number = &trace.effects[0].effect.parameters[0];
        is_alone(trace, &hidden)
            && (number.value - 6e-8).abs() < 4.0 * number.std.expect("it has one")
            && !trace.encoders.is_empty()
            && trace.encoders.iter().all(|(_, noise)| (4e-6..6e-6).contains(noise))
    });
}

/// Joints that are fitted again take all that the bending of a forearm does to the
/// tool at twelve poses; joints that are read cannot.
#[test]
fn a_link_is_seen_that_joints_would_take_for_theirs() {
    let (arm, hidden) = (six_axis(), [Effect::LinkCompliance { link: 3, bending: 1e-7, torsion: 0.0 }]);
    let [without, with] = both(&arm, &hidden, 12, 700..704);
    assert_eq!(count(&without, &hidden), 0, "named without encoders: {}", told(&without[0].1));
    assert_most("a forearm, with encoders", 3, &with, |_, trace| is_alone(trace, &hidden));
}

/// A link that bends little, at twelve poses: readings of the joints take nothing from what those of the tool show.
#[test]
fn what_looks_alike_is_told_apart() {
    let (arm, hidden) = (six_axis(), [Effect::LinkCompliance { link: 2, bending: 5e-8, torsion: 0.0 }]);
    let all = [702, 705, 710, 711].map(|seed| both(&arm, &hidden, 12, seed..seed + 1));
    let (without, with): (Vec<_>, Vec<_>) = all.into_iter().map(|[without, with]| (without, with)).unzip();
    let (without, with) = (without.concat(), with.concat());
    assert!(count(&with, &hidden) >= count(&without, &hidden), "told apart without encoders: {}", told(&without[0].1));
    assert_most("a link, with encoders", 3, &with, |_, trace| is_alone(trace, &hidden));
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    for arm in [five_axis(), six_axis()] {
        let of = |seed| (seed, trace_files(&few(&arm, &[], 40, seed, Some(BEHIND_GEARS)).run(), &arm, ""));
        let traces: Vec<(u64, Trace)> = (700..703).map(of).collect();
        assert_most("nothing, with encoders", 3, &traces, |_, trace| trace.verdict == Verdict::Adequate);
    }
}

/// What is in no gear is found as without them. On the six-axis arm it may be one that is only suspected, for
/// other sets come close where effects are taken to be smaller.
#[test]
fn a_bearing_is_named_beside_encoders() {
    for arm in [five_axis(), six_axis()] {
        let hidden = [Effect::TransverseCompliance { joint: 3, value: 3e-7 }];
        let of = |seed| (seed, trace_files(&few(&arm, &hidden, 40, seed, Some(BEHIND_GEARS)).run(), &arm, ""));
        let traces: Vec<(u64, Trace)> = (700..703).map(of).collect();
        assert_most("a bearing, with encoders", 3, &traces, |_, trace| {
            let is_named = names_all(trace, &hidden) && trace.verdict == Verdict::Explained;
            let bearing = hidden[0].to_string();
            let is_suspected = || trace.suspected.iter().all(|of| of.effect.to_string() == bearing);
            is_named || (arm.joints.len() == 6 && trace.effects.is_empty() && is_suspected())
        });
    }
}

/// A controller whose motors give way by three tenths of what the gears do: seen by
/// the motors' encoders, it is no compliance of the gears.
#[test]
fn what_the_motors_let_through_is_no_compliance() {
    let arm = six_axis();
    for output in [None, Some(5e-6)] {
        let encoders = Encoders { output, apart: 3e-5, motors: Some(0.3) };
        let plan = Scenario { encoders: Some(encoders), ..plan(&arm, &[], 700) };
        let trace = trace_files(&plan.run(), &arm, "");
        assert_eq!(trace.verdict, Verdict::Adequate, "{}", told(&trace));
        assert!(trace.motors && trace.encoders.is_empty() == output.is_none());
        for (estimate, joint) in trace.estimates.iter().zip(&plan.truth.joints) {
            let (off, std) = (estimate.value - joint.compliance(), estimate.std.unwrap_or(f64::INFINITY));
            assert!(off.abs() < 4.0 * std, "{}: {off:e} is beyond {std:e}", estimate.name);
        }
    }
}
