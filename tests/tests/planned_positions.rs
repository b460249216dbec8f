//! Absolute positions that were planned: simulated, and judged by what they tell, against
//! poses drawn at random.

use std::path::PathBuf;

use robstiff::Effect;
use robstiff_identify::campaign::{Campaign, Data, Noise, Positions};
use robstiff_identify::plan::{Group, Options, Outlook, Plan, plan, plan_between};
use robstiff_identify::simulate::{Measures, Poses, Scenario, UnderPayloads, simulate};
use robstiff_identify::trace::{self, Trace, trace};
use robstiff_robots::Description;
use robstiff_robots::effect::gravity_sag::GRAVITY;
use robstiff_tests::simulator::{five_axis, six_axis};

/// Noise of one reading (m).
const NOISE: f64 = 1e-5;

/// The greatest payload (kg), and half of it.
const PAYLOADS: [f64; 3] = [0.0, 100.0, 200.0];

/// Poses of the first campaign, and how many are added to it.
const FIRST: usize = 14;
const MORE: usize = 6;

const SEEDS: std::ops::Range<u64> = 900..908;

fn drawn(robot: &Description, count: usize) -> Poses {
    let within = robot.joints.iter().map(|joint| joint.limits.expect("the arms have limits")).collect();
    Poses::Drawn { count, within, floor: Some(0.1), column: Some(0.6) }
}

fn measured(robot: &Description, hidden: &[Effect], payloads: &[f64], poses: Poses, seed: u64) -> Campaign {
    let scenario = Scenario {
        name: String::from("planned"),
        seed,
        poses,
        visits: 1,
        measures: Measures::Positions(UnderPayloads { payloads: payloads.to_vec(), repeatability: 0.0 }),
        wrench_at: [0.0, 0.0, 0.1],
        measured_at: [0.04, -0.02, 0.11],
        noise: [NOISE; 3],
        states_noise: true,
        hidden: hidden.to_vec(),
        scatter: 0.2,
        holdout: None,
    };
    let simulated = simulate(robot, &scenario).expect("measured");
    Campaign {
        name: scenario.name,
        date: String::new(),
        operator: String::new(),
        path: PathBuf::new(),
        robot_path: PathBuf::new(),
        observations_path: PathBuf::new(),
        robot: simulated.declared,
        data: simulated.data,
        noise: Noise { displacement: Some(NOISE), rotation: None },
        holdout: None,
        held_out: Vec::new(),
        warnings: Vec::new(),
    }
}

fn positions(campaign: &Campaign) -> &Positions {
    let Data::Position(data) = &campaign.data else { unreachable!("positions") };
    data
}

fn traced(campaign: &Campaign) -> Trace {
    // Folds have no part in a plan.
    let options = trace::Options { folds: 2, ..trace::Options::default() };
    trace(campaign, &options, &|_| {}).expect("traced")
}

fn between(campaign: &Campaign, rivals: &[Effect], options: &Options) -> Plan {
    let mut traced = traced(campaign);
    traced.effects.clear();
    traced.suspected.clear();
    let names = rivals.iter().map(ToString::to_string).collect();
    plan_between(campaign, &traced, &[Group { named: None, names }], options).expect("planned")
}

fn poses(campaign: &Campaign) -> Vec<Vec<f64>> {
    let mut poses: Vec<Vec<f64>> = positions(campaign).rows.iter().map(|row| row.q.clone()).collect();
    poses.dedup();
    poses
}

/// By how much chi-square favours one effect over another: of each declared, the numbers of the
/// description are fitted again.
fn favours(campaign: &Campaign, one: Effect, other: Effect) -> f64 {
    let chi_square = |effect: Effect| {
        let mut campaign = campaign.clone();
        campaign.robot.effects.push(effect);
        let readings = 3 * positions(&campaign).rows.len();
        readings as f64 * (traced(&campaign).identified.rms / NOISE).powi(2)
    };
    chi_square(other) - chi_square(one)
}

fn tilt(joint: usize, value: f64) -> Effect {
    Effect::TransverseCompliance { joint, value }
}

const BENDING: Effect = Effect::LinkCompliance { link: 3, bending: 3e-7, torsion: 0.0 };

/// Over eight campaigns, with the same noise on either side, the mean difference is to
/// exceed two of its own standard errors.
#[test]
fn planned_poses_separate_better_than_random_ones() {
    let (robot, truth) = (six_axis(), tilt(3, 3e-7));
    let mut differences = Vec::new();
    for seed in SEEDS {
        let first = measured(&robot, &[truth], &PAYLOADS, drawn(&robot, FIRST), seed);
        let planned = between(&first, &[truth, BENDING], &Options { poses: MORE, ..Options::default() });
        let planned: Vec<Vec<f64>> = planned.proposals.into_iter().map(|planned| planned.visit.q).collect();
        let random = poses(&measured(&robot, &[], &PAYLOADS, drawn(&robot, MORE), seed + 5000));
        let [planned, random] = [planned, random].map(|more| {
            let all = Poses::Listed(poses(&first).into_iter().chain(more).collect());
            favours(&measured(&robot, &[truth], &PAYLOADS, all, seed), truth, BENDING)
        });
        println!("{seed}: {planned:.1} {random:.1}");
        differences.push(planned - random);
    }
    let count = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / count;
    let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (count - 1.0);
    assert!(mean > 2.0 * (variance / count).sqrt(), "{mean:.1} {differences:.1?}");
}

/// Chi-square favours the truth by its expected value, within four standard errors.
#[test]
fn what_is_expected_comes_true() {
    let (robot, truth) = (six_axis(), tilt(3, 3e-7));
    let mut errors = Vec::new();
    for seed in SEEDS {
        let first = measured(&robot, &[truth], &PAYLOADS, drawn(&robot, 40), seed);
        let plan = between(&first, &[truth, BENDING], &Options { poses: 1, ..Options::default() });
        let expected = plan.pairs[0].now.powi(2);
        errors.push((favours(&first, truth, BENDING) - expected) / (2.0 * expected.sqrt()));
    }
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    println!("{errors:.2?}");
    assert!(mean.abs() < 4.0 / (errors.len() as f64).sqrt(), "{mean}");
}

/// What no pose separates is said to be so; how the tool is turned tells some of it.
#[test]
fn some_rivals_need_other_measurements() {
    let two = [0.0, 200.0];
    let base = Effect::BaseCompliance { tilt: 1e-7, translation: 0.0 };
    let tool = Effect::ToolCompliance { rotation: 3e-7, translation: 0.0 };
    for (robot, truth, rival, is_alias, remedies) in [
        (five_axis(), tilt(1, 1e-7), base, true, &[][..]),
        (six_axis(), tilt(5, 1.5e-7), tool, false, &["rotation", "second reflector"]),
    ] {
        let campaign = measured(&robot, &[truth], &two, drawn(&robot, 20), 1);
        let found = between(&campaign, &[truth, rival], &Options { poses: 4, ..Options::default() });
        let [pair] = &found.pairs[..] else { panic!("{:?}", found.pairs) };
        assert_eq!(pair.outlook == Outlook::Alias, is_alias, "{pair:?}");
        assert_ne!(pair.outlook, Outlook::Separable, "{pair:?}");
        let has = |words: &str| pair.remedies.iter().any(|one| one.words.contains(words));
        assert!(remedies.iter().all(|words| has(words)), "{pair:?}");
    }
}

/// Where nothing is missing and no payload shows a compliance, poses are proposed that
/// calibrate the table best, and better than random ones do.
#[test]
fn poses_sharpen_the_table() {
    let robot = six_axis();
    let campaign = measured(&robot, &[], &[0.0], drawn(&robot, 16), 5);
    let traced = traced(&campaign);
    assert!(traced.effects.is_empty());
    let found = plan(&campaign, &traced, &Options { poses: MORE, ..Options::default() }).expect("planned");
    let kinds = |kind: &str| found.numbers.iter().filter(|number| number.name.starts_with(kind)).count();
    assert!(kinds("joint_zero_offset@") >= 3 && kinds("dh_error@") >= 10, "{:?}", found.numbers);
    assert!(found.numbers.iter().all(|number| number.after < number.now));
    assert!(found.proposals.iter().all(|planned| planned.visit.loads == [[0.0; 6]]));
    // What is known of the table once these poses are measured too.
    let gained = |more: Vec<Vec<f64>>| {
        let all = Poses::Listed(poses(&campaign).into_iter().chain(more).collect());
        let campaign = measured(&robot, &[], &[0.0], all, 5);
        let after = plan(&campaign, &self::traced(&campaign), &Options { poses: 1, ..Options::default() });
        let after = after.expect("planned").numbers;
        let gains = found.numbers.iter().filter_map(|before| {
            let after = after.iter().find(|after| after.name == before.name)?;
            Some((before.now / after.now).ln())
        });
        let gains: Vec<f64> = gains.collect();
        gains.iter().sum::<f64>() / gains.len() as f64
    };
    let planned = gained(found.proposals.iter().map(|planned| planned.visit.q.clone()).collect());
    let random = (0..4).map(|seed| gained(poses(&measured(&robot, &[], &[0.0], drawn(&robot, MORE), seed))));
    let random = random.fold(0.0, f64::max);
    println!("{planned:.3} {random:.3}");
    assert!(planned > random);
}

#[test]
fn proposals_are_as_asked_for() {
    let robot = six_axis();
    let campaign = measured(&robot, &[], &PAYLOADS, drawn(&robot, 16), 5);
    let traced = traced(&campaign);
    let options = Options { poses: 5, floor: Some(0.5), force: Some(100.0 * GRAVITY), ..Options::default() };
    let found = plan(&campaign, &traced, &options).expect("planned");
    assert_eq!(found.proposals.len(), 5);
    for planned in &found.proposals {
        assert!(planned.visit.q.iter().zip(&robot.joints).all(|(&q, joint)| joint.reaches(q)));
        let [.., height] = robstiff_tests::simulator::Arm::new(&robot, &[]).tcp(&planned.visit.q);
        assert!(height >= 0.5 - 1e-6, "{height}");
        let payloads = planned.visit.payloads();
        assert!(payloads.iter().zip([0.0, 50.0, 100.0]).all(|(a, b)| (a - b).abs() < 1e-9), "{payloads:?}");
    }
    assert_eq!(plan(&campaign, &traced, &options).expect("planned").proposals, found.proposals);
    let refused = plan(&campaign, &traced, &Options { moment: Some(50.0), ..options }).expect_err("a moment");
    assert!(refused.to_string().contains("payloads pull by their weight"), "{refused}");
}
