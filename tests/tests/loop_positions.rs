//! The loop on absolute positions, read by a tracker that stands anywhere: what such
//! readings show of the kinematics, and under payloads of the compliances, is named,
//! written and predicted; what they cannot show is not named. Thresholds as in
//! `matrix_sample`: of the rate that is claimed, a count below them has a probability
//! of 1 in 1000.

use robstiff_identify::campaign::{Campaign, Data};
use robstiff_identify::predict::predict;
use robstiff_identify::trace::{EffectParameter, Options, Trace, Verdict, trace};
use robstiff_robots::{Description, Effect, Link};
use robstiff_tests::judge_tracing::{Told, suspected};
use robstiff_tests::matrix::interval::fewest;
use robstiff_tests::positions::{PAYLOADS, read};
use robstiff_tests::simulator::{DhColumn, Follows, Hidden, Outside, Positions, five_axis, scattered, six_axis};

/// Runs of what is to hold at a rate.
const RUNS: u64 = 6;

fn traced(campaign: &Campaign) -> Trace {
    trace(campaign, &Options::default(), &|_| {}).unwrap_or_else(|problem| panic!("{problem}"))
}

/// Both arms in turn, other compliances in every run.
fn positions(run: u64, seed: u64) -> (Positions, Description) {
    let declared = if run.is_multiple_of(2) { five_axis() } else { six_axis() };
    (Positions::new(scattered(&declared, 0.7..1.3, seed + run), seed + run), declared)
}

/// Asserts that what `hide` hides is named, alone, in as many runs as 95 in 100
/// would have; and gives the traces in which it is.
fn assert_named(name: &str, seed: u64, hide: impl Fn(&mut Positions, &mut Description)) -> Vec<(Campaign, Trace)> {
    let mut right = Vec::new();
    for run in 0..RUNS {
        let (mut positions, mut declared) = positions(run, seed);
        let reflector = positions.reflector;
        hide(&mut positions, &mut declared);
        let campaign = read(&positions, &declared, reflector);
        let trace = traced(&campaign);
        let told = Told::of(&trace);
        let stands = told.names.len() == 1
            && (told.names[0].name == name || told.names[0].same_as.iter().any(|other| other == name));
        println!("{name} {run}: {} {:?}{}", trace.verdict, told.names, suspected(&trace));
        // Beside what is named, small things may be suspected.
        if stands && matches!(trace.verdict, Verdict::Explained | Verdict::Partial) {
            right.push((campaign, trace));
        }
    }
    let least = fewest(RUNS as usize, 0.95, 1e-3);
    assert!(right.len() >= least, "{name}: {} of {RUNS}, not {least}", right.len());
    right
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    let runs = 20;
    let adequate = (0..runs).filter(|&run| {
        let (mut positions, declared) = positions(run, 300);
        if run % 4 < 2 {
            positions.payloads = PAYLOADS.to_vec();
        }
        let trace = traced(&read(&positions, &declared, positions.reflector));
        println!("{run}: {} {:?}", trace.verdict, Told::of(&trace).names);
        trace.verdict == Verdict::Adequate && trace.effects.is_empty()
    });
    let (count, least) = (adequate.count(), fewest(runs as usize, 0.98, 1e-3));
    assert!(count >= least, "{count} of {runs}, not {least}");
}

/// What is written predicts the same positions to their noise, wherever the tracker
/// stands.
#[test]
fn errors_of_the_kinematics_are_named_and_written() {
    let lengths = |row| Hidden::DhError { of: DhColumn::A, row, by: 2e-3 };
    let cases = [
        Hidden::JointZeroOffset { joint: 3, offset: 2e-3 },
        lengths(2),
        Hidden::DhError { of: DhColumn::Alpha, row: 1, by: 2e-3 },
        Hidden::TransmissionError { joint: 2, order: 2, sin: 3e-4, cos: -1e-4 },
    ];
    for (seed, hidden) in (400..).step_by(20).zip(cases) {
        for (campaign, trace) in
            assert_named(&hidden.name(), seed, |positions, _| positions.hidden = vec![hidden.clone()])
        {
            let left = predict(&trace.description, &campaign).expect("positions");
            assert!(left.rms < 40e-6, "{} um", left.rms * 1e6);
            assert!(trace.declared.rms > 2.0 * left.rms);
        }
    }
}

/// Links with masses, on a controller that does not correct for them.
#[test]
fn the_arms_own_weight_is_named() {
    let found = assert_named("gravity_sag@robot", 500, |positions, declared| {
        let masses = [300.0, 200.0, 150.0, 60.0, 30.0, 10.0];
        let links: Vec<Link> =
            (0..declared.joints.len()).map(|k| Link { mass: masses[k], center_of_mass: [-0.1, 0.02, 0.05] }).collect();
        declared.links.clone_from(&links);
        positions.truth = declared.clone();
        positions.truth.links.clear();
        positions.hidden = vec![Hidden::GravitySag(links)];
    });
    for (_, trace) in found {
        let share = trace.effects[0].effect.parameters[0].value;
        assert!((share - 1.0).abs() < 0.05, "{share}");
    }
}

/// Under payloads what yields beside the gears is named as with pulls of a cable.
#[test]
fn payloads_show_what_yields() {
    let tilt = Hidden::from(Effect::TransverseCompliance { joint: 2, value: 8e-7 });
    let varying = Hidden::PoseDependentCompliance { joint: 2, cos: [0.45, 0.0], sin: [-0.15, 0.0] };
    for (seed, hidden) in [(600, tilt), (640, varying)] {
        assert_named(&hidden.name(), seed, |positions, _| {
            positions.payloads = PAYLOADS.to_vec();
            positions.hidden = vec![hidden.clone()];
        });
    }
}

/// A weight that hangs elsewhere than the file says is the rig's, and stays there.
#[test]
fn where_a_payload_hangs_is_named_and_not_written() {
    let off = [0.15, 0.0, 0.1];
    let found = assert_named("lever_arm@rig", 980, |positions, _| {
        positions.payloads = PAYLOADS.to_vec();
        positions.hidden = vec![Hidden::LeverArm(off)];
    });
    for (_, trace) in found {
        assert!(trace.description.effects.is_empty());
        for (axis, truth) in ["x", "y", "z"].into_iter().zip(off) {
            let number = trace.effects[0].effect.parameters.iter().find(|number| number.name == axis);
            let number = number.expect(axis);
            let std = number.std.expect("a fitted number");
            assert!((number.value - truth).abs() < 4.0 * std, "{number:?}");
        }
    }
}

/// The law of a gear under payloads is named or suspected, and nothing but what is at its joint is named.
#[test]
fn gears_are_found_by_their_payloads() {
    let hardening = Hidden::from(Effect::StiffnessNonlinearity { joint: 3, added: 6e-7, knee: 700.0 });
    let right = (0..RUNS).filter(|run| {
        let (mut positions, declared) = positions(*run, 660);
        positions.payloads = vec![0.0, 50.0, 150.0, 250.0];
        positions.hidden = vec![hardening.clone()];
        let trace = traced(&read(&positions, &declared, positions.reflector));
        let named: Vec<String> = trace.effects.iter().map(|named| named.effect.to_string()).collect();
        println!("{run}: {} {named:?}{}", trace.verdict, suspected(&trace));
        let classes = trace.effects.iter().map(|of| &of.class).chain(trace.suspected.iter().map(|of| &of.class));
        let is_found = classes.flatten().any(|(name, _)| *name == hardening.name());
        is_found && trace.verdict != Verdict::Adequate && named.iter().all(|name| name.ends_with("@joint 3"))
    });
    let (count, least) = (right.count(), fewest(RUNS as usize, 0.95, 1e-3));
    assert!(count >= least, "{count} of {RUNS}, not {least}");
}

/// A weight at the TCP turns no tool, so a tool that yields is no other name of what
/// turns.
#[test]
fn what_shows_nothing_is_no_alias() {
    let found = assert_named("base_slip@base", 760, |positions, _| {
        positions.payloads = PAYLOADS.to_vec();
        positions.hidden = vec![Hidden::BaseSlip { shift: [2e-4, -1e-4, 1e-4], turn: [0.0, 1e-4, 0.0], when: 0.6 }];
    });
    for (_, trace) in found {
        let same_as = trace.effects[0].same_as();
        assert!(!same_as.iter().any(|name| name == "tool_compliance@tool"), "{same_as:?}");
    }
}

/// A reflector that is nowhere near where the campaign says is no noise.
#[test]
fn a_reflector_that_is_far_off_is_named() {
    let (positions, declared) = positions(0, 780);
    let trace = traced(&read(&positions, &declared, [0.4, 0.0, -0.3]));
    let named: Vec<String> = trace.effects.iter().map(|named| named.effect.to_string()).collect();
    assert_eq!(named, ["reflector_offset@rig"], "{} {}", trace.verdict, trace.why);
    for (name, off) in [("x", 0.4), ("y", 0.0), ("z", -0.3)] {
        let number = trace.effects[0].effect.parameters.iter().find(|number| number.name == name).expect(name);
        let truth = positions.reflector["xyz".find(name).expect("an axis")] - off;
        assert!((number.value - truth).abs() < 4.0 * number.std.expect("a fitted number"), "{number:?} {truth}");
    }
}

#[test]
fn faults_of_the_rig_are_named_and_not_written() {
    let slip = Hidden::BaseSlip { shift: [2e-4, -1e-4, 0.0], turn: [0.0, 1e-4, 0.0], when: 0.6 };
    let slips = assert_named("base_slip@base", 700, |positions, _| positions.hidden = vec![slip.clone()]);
    let moved = assert_named("reflector_offset@rig", 720, |positions, _| {
        positions.reflector = positions.reflector.map(|at| at + 5e-3);
    });
    let warmer = Hidden::Expansion { rate: 4e-5, follows: Follows::Temperature };
    let grows = assert_named("thermal_drift@rig", 920, |positions, _| positions.hidden = vec![warmer.clone()]);
    let knocked = assert_named("reflector_slip@rig", 960, |positions, _| {
        positions.hidden = vec![Hidden::ReflectorSlip { shift: [2e-4, -2e-4, 1e-4], when: 0.4 }];
    });
    let wild = assert_named("outliers@rig", 740, |positions, _| {
        positions.wild = vec![(7, [0.0, 1e-3, 0.0]), (31, [-2e-3, 0.0, 5e-4])];
    });
    for (_, trace) in slips.iter().chain(&moved).chain(&grows).chain(&knocked).chain(&wild) {
        assert!(trace.description.effects.is_empty());
    }
    // In the base frame, wherever the tracker stands.
    let assert_near = |trace: &Trace, name: &str, truth: f64| {
        let number = trace.effects[0].effect.parameters.iter().find(|number| number.name == name);
        let near = |number: &EffectParameter| (number.value - truth).abs() < 4.0 * number.std.expect("a fitted number");
        assert!(number.is_some_and(near), "{number:?} {truth}");
    };
    for (_, trace) in &slips {
        for (name, truth) in [("dx", 2e-4), ("dy", -1e-4), ("dz", 0.0), ("ry", 1e-4)] {
            assert_near(trace, name, truth);
        }
    }
    for (_, trace) in &grows {
        assert_near(trace, "growth", 4e-5);
    }
    for (_, trace) in &knocked {
        // Of 60 rows behind a header, in the course of a campaign at moments that are some rows apart.
        let line = trace.effects[0].effect.value("from_line");
        assert!((22.0..=30.0).contains(&line), "{line}");
        for (name, truth) in [("dx", 2e-4), ("dy", -2e-4), ("dz", 1e-4)] {
            assert_near(trace, name, truth);
        }
    }
    for (_, trace) in &wild {
        // The header is line 1.
        assert_eq!(trace.effects[0].lines, [9, 33]);
    }
}

/// The readings settle, fast and then slowly: a drift, and nothing of the arm.
#[test]
fn readings_that_settle_are_not_the_arm() {
    for run in 0..3 {
        let (mut positions, declared) = positions(run, 940);
        let (rate, follows) = ([3e-4, 0.0, -2e-4], Follows::Settling(700.0));
        positions.hidden = vec![Hidden::ThermalDrift { rate, follows }];
        let trace = traced(&read(&positions, &declared, positions.reflector));
        let names: Vec<String> = trace.effects.iter().map(|named| named.effect.to_string()).collect();
        assert_eq!(names, ["thermal_drift@rig"], "{} {}", trace.verdict, trace.why);
    }
}

/// All lengths that are read a thousandth too long are an arm that is a thousandth larger: the numbers of the
/// table take it, and no cause is named.
#[test]
fn a_scale_of_all_readings_is_one_of_the_table() {
    for run in 0..3 {
        let (mut positions, declared) = positions(run, 900);
        positions.hidden = vec![Hidden::TrackerScale(1e-3)];
        let trace = traced(&read(&positions, &declared, positions.reflector));
        let names = Told::of(&trace).names;
        assert!(names.iter().all(|name| name.name == "tracker_scale@rig"), "{names:?}");
        assert!(trace.after.holdout_rms < 0.2 * trace.declared.holdout_rms, "{:?} {:?}", trace.after, trace.declared);
    }
}

/// What no effect of the catalogue does is not told as one of them and the whole truth.
#[test]
fn what_is_outside_the_catalogue_is_not_explained() {
    let cable = Outside::Cable { link: 3, anchor: [0.5, 1.5, 2.5], stiffness: 3e3, length: 0.5 };
    let wave = Hidden::TransmissionError { joint: 2, order: 5, sin: 3e-4, cos: 1e-4 };
    for (seed, hidden) in [(800, Hidden::Outside(cable)), (820, wave)] {
        for run in 0..RUNS {
            let (mut positions, declared) = positions(run, seed);
            positions.truth = declared.clone();
            positions.hidden = vec![hidden.clone()];
            let trace = traced(&read(&positions, &declared, positions.reflector));
            let told = Told::of(&trace).names;
            let honest = matches!(trace.verdict, Verdict::Unexplained | Verdict::Partial);
            assert!(honest, "{} {run}: {} {told:?}", hidden.name(), trace.verdict);
        }
    }
}

/// A joint that goes farther than it reads is none of the effects that look like it, and is reported
/// for what it looks like.
#[test]
fn what_has_no_name_is_told_for_what_it_looks_like() {
    let cases = [
        ("an encoder of joint 4 with a scale of its own", [4, 4]),
        ("a coupling of the angles of joints 5 and 4", [5, 4]),
    ];
    for (seed, (words, [joint, of])) in (1000..).step_by(20).zip(cases) {
        let right = (0..RUNS).filter(|&run| {
            let (positions, declared) = positions(run, seed);
            let mut campaign = read(&positions, &declared, positions.reflector);
            if let Data::Position(data) = &mut campaign.data {
                data.rows.iter_mut().for_each(|row| row.q[joint - 1] -= 4e-4 * row.q[of - 1]);
            }
            let trace = traced(&campaign);
            let named: Vec<String> = trace.effects.iter().map(|named| named.effect.to_string()).collect();
            println!("{words} {run}: {} {named:?} {:?}{}", trace.verdict, trace.looks_like, suspected(&trace));
            named.is_empty()
                && trace.description.effects.is_empty()
                && trace.looks_like.len() == 1
                && trace.looks_like[0].starts_with(words)
        });
        let (count, least) = (right.count(), fewest(RUNS as usize, 0.95, 1e-3));
        assert!(count >= least, "{words}: {count} of {RUNS}, not {least}");
    }
}
