//! Absolute positions with something hidden, and with nothing. What the simulator
//! makes, which shares no formula, is traced among the tests of the workspace.

use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;
use robstiff_robots::effect::DhEntry;
use robstiff_robots::{Description, Link, catalogue};

use crate::campaign::made_positions::Plan;
use crate::campaign::{Campaign, Data, Holdout};
use crate::identify::baseline::Visibility;
use crate::trace::{Options, Trace, Verdict, trace};
use robstiff::Effect;

pub fn six_axis() -> Description {
    let text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
    Description::parse("kuka-kr270-r2700.yaml", text).expect("a description")
}

pub fn traced(campaign: &Campaign) -> Trace {
    trace(campaign, &Options { draws: 599, ..Options::default() }, &|_| {}).expect("positions")
}

pub fn names(trace: &Trace) -> Vec<String> {
    let mut names: Vec<String> = trace.effects.iter().map(|named| named.effect.to_string()).collect();
    names.sort();
    names
}

/// Several numbers of a table that are off at once, each with its value.
#[test]
fn errors_of_the_table_are_found_together() {
    let hidden = [
        Effect::JointZeroOffset { joint: 2, value: 3e-3 },
        Effect::JointZeroOffset { joint: 3, value: -2e-3 },
        Effect::JointZeroOffset { joint: 5, value: 4e-3 },
        Effect::DhError { entry: DhEntry::A(2), value: 1e-3 },
        Effect::DhError { entry: DhEntry::D(4), value: -8e-4 },
        Effect::DhError { entry: DhEntry::Alpha(1), value: 5e-4 },
    ];
    for seed in 0..3 {
        let trace = traced(&Plan { hidden: hidden.to_vec(), ..Plan::new(six_axis(), seed) }.run());
        assert_eq!(trace.verdict, Verdict::Explained, "{}", trace.why);
        assert_eq!(trace.effects.len(), hidden.len(), "{:?}", names(&trace));
        for effect in hidden {
            let found = trace.effects.iter().find(|named| named.effect.to_string() == effect.to_string());
            let number = &found.unwrap_or_else(|| panic!("{effect}: {:?}", names(&trace))).effect.parameters[0];
            let off = number.value - effect.numbers()[0];
            assert!(off.abs() < 4.0 * number.std.expect("a number that was fitted"), "{effect}: {number:?}");
        }
        assert_eq!(trace.description.effects.len(), hidden.len());
        assert!(trace.effects.is_sorted_by(|one, next| one.holdout_rms > next.holdout_rms));
        assert!(trace.invisible.contains(&"joint_zero_offset@joint 1".to_string()));
        assert!(trace.invisible.contains(&"dh_error@d1".to_string()));
    }
}

/// Parallel axes: a length along one is a length along the other.
#[test]
fn what_cannot_be_told_apart_is_listed() {
    let hidden = vec![Effect::DhError { entry: DhEntry::D(3), value: 1e-3 }];
    let trace = traced(&Plan { hidden, ..Plan::new(six_axis(), 2) }.run());
    let [named] = &trace.effects[..] else { panic!("{:?}", names(&trace)) };
    let other = if named.effect.to_string() == "dh_error@d2" { "dh_error@d3" } else { "dh_error@d2" };
    assert!(named.same_as.contains(&other.to_string()), "{:?}", named.same_as);
    assert!(trace.rivals.iter().any(|rival| rival.names == [other]));
}

/// A length of the last row and the reflector along it are one; the rig's is named.
#[test]
fn of_the_reflector_and_the_flange_the_reflector_is_named() {
    for seed in 0..4 {
        let hidden = vec![Effect::DhError { entry: DhEntry::D(6), value: 5e-4 }];
        let trace = traced(&Plan { hidden, ..Plan::new(six_axis(), seed) }.run());
        assert_eq!(names(&trace), ["reflector_offset@rig"]);
        assert_eq!(trace.effects[0].same_as, ["dh_error@d6"]);
        assert!(trace.description.effects.is_empty());
    }
}

/// What has several numbers may be one that it says as well, or several together.
#[test]
fn what_a_reflectors_offset_may_consist_of_is_listed() {
    let trace = traced(&Plan { marker: [1e-3, -5e-4, 2e-3], ..Plan::new(six_axis(), 5) }.run());
    assert_eq!(names(&trace), ["reflector_offset@rig"]);
    assert!(trace.effects[0].same_as.contains(&"dh_error@d6".to_string()), "{:?}", trace.effects[0].same_as);
    assert!(!trace.effects[0].same_as.contains(&"dh_error@a3".to_string()));
}

/// Readings far off do not keep an effect from being found, nor are they in its fit.
#[test]
fn wild_readings_do_not_hide_an_effect() {
    let hidden = vec![Effect::JointZeroOffset { joint: 3, value: 5e-3 }];
    let wild = |row: usize, read: &mut crate::campaign::PositionRow| {
        if [5, 17, 40].contains(&row) {
            read.position[1] += 0.5;
        }
    };
    let trace = traced(&Plan { hidden, ..Plan::new(six_axis(), 1) }.run_with(wild));
    assert_eq!(names(&trace), ["joint_zero_offset@joint 3", "outliers@rig"]);
    assert_eq!(trace.effects[1].lines, [7, 19, 42]);
    assert!((trace.effects[0].effect.parameters[0].value - 5e-3).abs() < 5e-5);
    let rest = trace.residuals.iter().filter(|row| ![7, 19, 42].contains(&row.line));
    let squares: Vec<f64> = rest.flat_map(|row| row.after).map(|one| one * one).collect();
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    // The three rows are predicted by the fit that leaves them out.
    assert!(rms < 4e-5 && trace.after.rms > 1e-2, "{rms}, {:?}", trace.after);
}

/// A share of the arm's weight is small as a number beside compliances, not as what it
/// does: half of it was taken away since, 0.1 mm, and the share is fitted again.
#[test]
fn a_declared_sag_beside_payloads_is_fitted_again() {
    let mut robot = six_axis();
    let masses = [100.0, 60.0, 40.0, 20.0, 10.0, 5.0];
    robot.links = masses.map(|mass| Link { mass, center_of_mass: [-0.1, 0.02, 0.05] }).to_vec();
    let with = |share| {
        let mut robot = robot.clone();
        robot.effects.push(Effect::GravitySag { share });
        robot
    };
    let mut campaign = Plan { payloads: vec![0.0, 250.0], ..Plan::new(with(0.5), 8) }.run();
    campaign.robot = with(1.0);
    let trace = traced(&campaign);
    let share = trace.estimates.last().expect("a share");
    assert_eq!((trace.verdict, &share.visibility), (Verdict::Adequate, &Visibility::Seen), "{:?}", names(&trace));
    assert!((share.value - 0.5).abs() < 4.0 * share.std.expect("it is fitted"), "{share:?}");
}

/// The first row and the last are what a slip of all the others, or of one row, says as
/// well.
#[test]
fn a_wild_reading_at_either_end_is_no_slip() {
    for (seed, end) in (0..6).flat_map(|seed| [(seed, 0), (seed, 59)]) {
        let off = |row: usize, read: &mut crate::campaign::PositionRow| {
            if row == end {
                read.position[1] += 0.02;
            }
        };
        let trace = traced(&Plan::new(six_axis(), 20 + seed).run_with(off));
        assert_eq!(
            (trace.verdict, names(&trace)),
            (Verdict::Explained, vec!["outliers@rig".to_string()]),
            "{seed} {end}"
        );
        assert_eq!(trace.effects[0].lines, [end + 2]);
    }
}

/// A slip of the last few rows is told as one, not as wild readings.
#[test]
fn a_slip_near_the_end_is_no_handful_of_wild_readings() {
    let slipped = |row: usize, read: &mut crate::campaign::PositionRow| {
        if row >= 56 {
            read.position = (Vector3::from(read.position) + Vector3::new(1e-3, 0.0, -2e-4)).into();
        }
    };
    let trace = traced(&Plan::new(six_axis(), 3).run_with(slipped));
    assert_eq!(names(&trace), ["base_slip@base"]);
    assert_eq!(trace.effects[0].effect.value("line"), 58.0);
}

/// A slip between two payloads of one visit leaves no row of it wild.
#[test]
fn a_slip_within_a_visit_is_found_where_it_is() {
    let slipped = |row: usize, read: &mut crate::campaign::PositionRow| {
        if row >= 61 {
            read.position[2] += 5e-4;
        }
    };
    let trace =
        traced(&Plan { poses: 40, payloads: vec![0.0, 100.0, 200.0], ..Plan::new(six_axis(), 2) }.run_with(slipped));
    assert_eq!(names(&trace), ["base_slip@base"]);
    assert_eq!(trace.effects[0].effect.value("line"), 63.0);
}

/// Where there are more visits than moments are tried, the moment is found between.
#[test]
fn the_moment_of_a_slip_is_found_among_many_visits() {
    let slipped = |row: usize, read: &mut crate::campaign::PositionRow| {
        if row >= 503 {
            read.position[0] += 1e-4;
        }
    };
    let trace = traced(&Plan { poses: 40, visits: 25, ..Plan::new(six_axis(), 4) }.run_with(slipped));
    assert_eq!(names(&trace), ["base_slip@base"]);
    assert_eq!(trace.effects[0].effect.value("line"), 505.0);
}

#[test]
fn a_drift_with_the_temperature_is_named() {
    let drift = |_: usize, read: &mut crate::campaign::PositionRow| {
        read.position[2] += 5e-5 * (read.temperature.unwrap_or_default() - 21.0);
    };
    let trace = traced(&Plan::new(six_axis(), 1).run_with(drift));
    assert_eq!(names(&trace), ["thermal_drift@rig"]);
}

/// Poses held out have no part in the fit, and are predicted as well.
#[test]
fn poses_held_out_are_predicted() {
    let hidden = vec![Effect::DhError { entry: DhEntry::A(3), value: 1e-3 }];
    let mut campaign = Plan { hidden, ..Plan::new(six_axis(), 6) }.run();
    campaign.holdout = Some(Holdout { fraction: 0.25, seed: 1 });
    let trace = traced(&campaign);
    assert_eq!((names(&trace), trace.held_out.len()), (vec!["dh_error@a3".to_string()], 15));
    assert!(trace.identified.holdout_rms > 5.0 * trace.after.holdout_rms);
    assert!((0.7..1.4).contains(&(trace.after.holdout_rms / 3e-5)), "{:?}", trace.after);
    // They have no part in the names, but in the verdict.
    let Data::Position(data) = &mut campaign.data else { unreachable!("positions") };
    let moved = trace.held_out.clone();
    for row in data.rows.iter_mut().filter(|row| moved.contains(&data.poses[row.pose])) {
        row.position[0] += 1.5e-4;
    }
    let missed = traced(&campaign);
    assert_eq!((names(&missed), missed.verdict), (names(&trace), Verdict::Partial));
    assert!(missed.why.contains("poses held out"), "{}", missed.why);
}

/// A gear may soften by nearly all the compliance that it has, not that it is declared to
/// have.
#[test]
fn a_gear_softens_by_what_it_is_found_to_have() {
    let added = -0.9 * six_axis().joints[1].compliance();
    let hidden = vec![Effect::StiffnessNonlinearity { joint: 2, added, knee: 1500.0 }];
    let payloads = vec![0.0, 60.0, 130.0, 200.0, 260.0];
    let mut campaign = Plan { hidden, payloads, ..Plan::new(six_axis(), 3) }.run();
    crate::identify::baseline::set_compliance(&mut campaign.robot.joints[1].compliance, 0.5 * -added);
    let trace = traced(&campaign);
    assert_eq!(
        (names(&trace), trace.verdict),
        (vec!["stiffness_nonlinearity@joint 2".to_string()], Verdict::Explained)
    );
    let number = &trace.effects[0].effect.parameters[0];
    assert!((number.value - added).abs() < 4.0 * number.std.expect("a fitted number"), "{number:?}");
}

/// Errors that a description declares are fitted again, and written as they are now; so
/// what changed is not looked for elsewhere.
#[test]
fn declared_errors_are_fitted_again() {
    let declared = [
        Effect::JointZeroOffset { joint: 3, value: 3e-4 },
        Effect::DhError { entry: DhEntry::A(2), value: 5e-4 },
        Effect::TransmissionError { joint: 5, order: 2.0, sin: 1e-4, cos: 0.0 },
    ];
    let now = [
        Effect::JointZeroOffset { joint: 3, value: 9e-4 },
        Effect::DhError { entry: DhEntry::A(2), value: -2e-4 },
        Effect::TransmissionError { joint: 5, order: 2.0, sin: -1e-4, cos: 3e-4 },
    ];
    for more in [None, Some(Effect::DhError { entry: DhEntry::A(3), value: 1e-3 })] {
        let hidden = now.into_iter().chain(more).collect();
        let mut campaign = Plan { hidden, ..Plan::new(six_axis(), 4) }.run();
        campaign.robot.effects.extend(declared);
        let trace = traced(&campaign);
        assert_eq!(names(&trace), more.iter().map(ToString::to_string).collect::<Vec<_>>(), "{}", trace.why);
        assert_eq!(trace.verdict, if more.is_some() { Verdict::Explained } else { Verdict::Adequate });
        let truth = [9e-4, -2e-4, -1e-4, 3e-4];
        let fitted = trace.estimates.iter().filter(|estimate| estimate.unit != "rad/Nm");
        assert_eq!(fitted.clone().count(), truth.len());
        for (estimate, truth) in fitted.zip(truth) {
            let std = estimate.std.unwrap_or_else(|| panic!("{estimate:?}"));
            assert!((estimate.value - truth).abs() < 4.0 * std && std < 4e-5, "{estimate:?}");
        }
        let written: Vec<f64> = trace.description.effects[..3].iter().map(|effect| effect.numbers()[0]).collect();
        assert!((written[0] - 9e-4).abs() < 1e-4 && (written[1] + 2e-4).abs() < 1e-4, "{written:?}");
        assert_eq!(written[2], 2.0);
    }
}

/// A length of the last row is not fitted again: another reflector would be taken for it.
#[test]
fn what_a_reflector_says_as_well_is_left_as_declared() {
    let mut campaign = Plan { marker: [1e-3, -5e-4, 2e-3], ..Plan::new(six_axis(), 5) }.run();
    campaign.robot.effects.push(Effect::DhError { entry: DhEntry::D(6), value: 0.0 });
    let trace = traced(&campaign);
    assert_eq!(names(&trace), ["reflector_offset@rig"]);
    assert_eq!(trace.description.effects, campaign.robot.effects);
    let estimate = trace.estimates.last().expect("a number of its own");
    assert!(estimate.name == "dh_error@d6" && estimate.visibility != Visibility::Seen, "{estimate:?}");
}

/// A declared noise is a yardstick; so are visits that come again.
#[test]
fn more_than_noise_is_not_adequate() {
    let mut campaign = Plan { noise: 6e-5, ..Plan::new(six_axis(), 8) }.run();
    assert_eq!(traced(&campaign).verdict, Verdict::Adequate);
    campaign.noise.displacement = Some(3e-5);
    let trace = traced(&campaign);
    assert_eq!(trace.verdict, Verdict::Unexplained, "{}", trace.why);
    assert!((0.6..0.85).contains(&trace.unexplained), "{}", trace.unexplained);

    // At every pose another shift, the same at each visit, which no smooth law makes.
    let plan = Plan { visits: 3, ..Plan::new(six_axis(), 9) };
    let poses = plan.poses;
    let shifted = |row: usize, read: &mut crate::campaign::PositionRow| {
        let angle = 100.0 * ((row % poses) as f64 * 0.618).sin();
        read.position[0] += 6e-5 * angle.sin();
        read.position[1] += 6e-5 * angle.cos();
    };
    assert_eq!(traced(&plan.run()).verdict, Verdict::Adequate);
    let mut campaign = plan.run_with(shifted);
    // What visits differ by is asked where no noise is declared.
    campaign.noise.displacement = None;
    let trace = traced(&campaign);
    assert_eq!(trace.verdict, Verdict::Unexplained, "{} {:?}", trace.why, names(&trace));
    assert!(trace.structure.iter().any(|test| test.name.contains("visits differ") && test.p_value < 1e-3));
}

#[test]
fn too_few_poses_tell_nothing() {
    let hidden = vec![Effect::JointZeroOffset { joint: 3, value: 5e-3 }];
    let plan = Plan { hidden, poses: 8, ..Plan::new(six_axis(), 1) };
    let trace = traced(&plan.run());
    assert_eq!((trace.verdict, trace.effects.len()), (Verdict::Insufficient, 0));
    assert!(trace.description.effects.is_empty() && trace.why.contains("8 poses"));
}

/// What is written is fitted without a wave that no description takes.
#[test]
fn what_is_written_does_what_is_told() {
    let wave = Effect::TransmissionError { joint: 5, order: 1.0, sin: 8e-3, cos: 0.0 };
    let zero = Effect::JointZeroOffset { joint: 3, value: 2e-3 };
    let campaign = Plan { hidden: vec![wave, zero], ..Plan::new(six_axis(), 6) }.run();
    let trace = traced(&campaign);
    assert_eq!(names(&trace), [zero.to_string(), wave.to_string()]);
    assert!(trace.description.effects.iter().all(|effect| effect.to_string() == zero.to_string()));
    let predicted = crate::identify::predict(&trace.description, &campaign).expect("the same robot").rms;
    assert!((predicted / trace.after.rms - 1.0).abs() < 1e-3, "{predicted} and {}", trace.after.rms);
}

/// A zero of a joint that slides is written as the error of its length.
#[test]
fn a_zero_of_a_joint_that_slides_is_written() {
    let mut robot = six_axis();
    robot.joints[2].kind = robstiff::JointKind::Prismatic;
    let hidden = vec![Effect::DhError { entry: DhEntry::D(3), value: 1e-3 }];
    let campaign = Plan { hidden: hidden.clone(), ..Plan::new(robot, 7) }.run();
    let trace = traced(&campaign);
    assert_eq!(names(&trace), ["joint_zero_offset@joint 3"]);
    assert_eq!(trace.description.effects[0].to_string(), hidden[0].to_string());
    let predicted = crate::identify::predict(&trace.description, &campaign).expect("the same robot").rms;
    assert!((predicted / trace.after.rms - 1.0).abs() < 1e-3, "{predicted} and {}", trace.after.rms);
}

/// An error of theta that is declared is the zero of its joint, which is nothing more to look for.
#[test]
fn a_declared_error_of_theta_is_no_other_zero() {
    let mut robot = six_axis();
    robot.effects.push(Effect::DhError { entry: DhEntry::Theta(3), value: 2e-3 });
    let campaign = Plan::new(robot, 1).run();
    let Data::Position(data) = &campaign.data else { unreachable!("made of positions") };
    let bench = super::bench::Bench::new(&campaign, data).expect("they tell where the robot stands");
    let zeros = bench.candidates.iter().filter(|one| one.kind.name == "joint_zero_offset").map(|one| one.name());
    let zeros: Vec<String> = zeros.collect();
    assert!(zeros.len() == 5 && !zeros.contains(&"joint_zero_offset@joint 3".to_string()), "{zeros:?}");
}
