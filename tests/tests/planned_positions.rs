//! Absolute positions that were planned: simulated, and judged by what they tell, against
//! poses drawn at random.

use std::path::PathBuf;

use nalgebra::DMatrix;
use robstiff::Effect;
use robstiff_identify::campaign::{Campaign, Data, Noise, Positions};
use robstiff_identify::identify::PreparedPositions;
use robstiff_identify::plan::criterion::Judge;
use robstiff_identify::plan::positions::Adapter;
use robstiff_identify::plan::regressors::Regressors;
use robstiff_identify::plan::{Group, Options, Outlook, Plan, Visit, plan, plan_between};
use robstiff_identify::simulate::{Measures, Poses, Scenario, UnderPayloads, simulate};
use robstiff_identify::trace::{self, Trace, trace};
use robstiff_robots::Description;
use robstiff_robots::effect::DhEntry;
use robstiff_robots::effect::gravity_sag::GRAVITY;
use robstiff_tests::simulator::{five_axis, six_axis};

/// Noise of one reading (m).
const NOISE: f64 = 1e-5;

/// The greatest payload (kg), and half of it.
const PAYLOADS: [f64; 3] = [0.0, 100.0, 200.0];

/// Poses of the first campaign, and how many are added to it.
const FIRST: usize = 14;
const MORE: usize = 6;

const SEEDS: std::ops::Range<u64> = 900..916;

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
    let options = trace::Options { draws: 199, alpha: 0.05, ..trace::Options::default() };
    trace(campaign, &options, &|_| {}).expect("traced")
}

fn between(campaign: &Campaign, rivals: &[Effect], options: &Options) -> Plan {
    let mut traced = traced(campaign);
    traced.effects.clear();
    let names = rivals.iter().map(ToString::to_string).collect();
    plan_between(campaign, &traced, &[Group { named: None, names }], options).expect("planned")
}

fn poses(campaign: &Campaign) -> Vec<Vec<f64>> {
    let mut poses: Vec<Vec<f64>> = positions(campaign).rows.iter().map(|row| row.q.clone()).collect();
    poses.dedup();
    poses
}

/// By how much chi-square favours one effect over another, both compliances.
fn favours(campaign: &Campaign, one: Effect, other: Effect) -> f64 {
    let chi_square = |effect: Effect| {
        let mut campaign = campaign.clone();
        campaign.robot.effects.push(effect);
        let prepared = PreparedPositions::new(&campaign, positions(&campaign)).expect("positions");
        let (regression, start) = (prepared.regression([]), prepared.state(prepared.own.len()));
        let solved = regression.solve(&prepared.seen(), &start, &prepared.rows).expect("solved");
        solved.fit.rss / (NOISE * NOISE)
    };
    chi_square(other) - chi_square(one)
}

fn tilt(joint: usize, value: f64) -> Effect {
    Effect::TransverseCompliance { joint, value }
}

const BENDING: Effect = Effect::LinkCompliance { link: 3, bending: 3e-7, torsion: 0.0 };

/// Over sixteen campaigns, with the same noise on either side, the mean difference is to
/// exceed three of its own standard errors.
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
    assert!(mean > 3.0 * (variance / count).sqrt(), "{mean:.1} {differences:.1?}");
}

/// Chi-square favours the truth by its expected value, within four standard errors.
#[test]
fn what_is_expected_comes_true() {
    let (robot, truth) = (six_axis(), tilt(3, 3e-7));
    let mut errors = Vec::new();
    for seed in SEEDS.take(8) {
        let first = measured(&robot, &[truth], &PAYLOADS, drawn(&robot, 40), seed);
        let plan = between(&first, &[truth, BENDING], &Options { poses: 1, ..Options::default() });
        let expected = plan.pairs[0].now.powi(2);
        errors.push((favours(&first, truth, BENDING) - expected) / (2.0 * expected.sqrt()));
    }
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    println!("{errors:.2?}");
    assert!(mean.abs() < 4.0 / (errors.len() as f64).sqrt(), "{mean}");
}

/// The campaign's own visits, planned again, show what it is known to show.
#[test]
fn visits_show_what_a_campaign_does() {
    let robot = six_axis();
    let zero = Effect::JointZeroOffset { joint: 3, value: 2e-3 };
    let campaign = measured(&robot, &[tilt(2, 3e-7), zero], &PAYLOADS, drawn(&robot, 20), 3);
    let traced = trace(&campaign, &trace::Options::default(), &|_| {}).expect("traced");
    assert_eq!(traced.effects.len(), 2, "{:?}", traced.effects);
    let (adapter, rivals) = Adapter::new(&campaign, positions(&campaign), &traced, &[]).expect("positions");
    let payloads = PAYLOADS.map(|payload| [0.0, 0.0, -GRAVITY * payload, 0.0, 0.0, 0.0]);
    let visits: Vec<Visit> = poses(&campaign).into_iter().map(|q| Visit { q, loads: payloads.to_vec() }).collect();
    let shown: DMatrix<f64> = adapter.information(&visits, None).into_iter().sum();
    let known = adapter.known();
    for (i, j) in (0..known.nrows()).flat_map(|i| (0..known.ncols()).map(move |j| (i, j))) {
        let scale = (known[(i, i)] * known[(j, j)]).sqrt();
        assert!((known[(i, j)] - shown[(i, j)]).abs() < 1e-6 * scale, "{i} {j}");
    }
    // The standard deviations are those of the trace.
    let stds = Judge::new(&known, &rivals, adapter.variance()).stds(&known);
    for named in &traced.effects {
        let told = named.effect.parameters[0].std.expect("a fitted number");
        let at = rivals.model.iter().position(|number| number.name == named.effect.to_string()).expect("a number");
        assert!((stds[at] / told - 1.0).abs() < 0.5, "{}: {} {told}", named.effect, stds[at]);
    }
}

/// What no pose separates is said to be so; more payloads, or how the tool is turned,
/// tell some of it.
#[test]
fn some_rivals_need_other_measurements() {
    let two = [0.0, 200.0];
    let hardening = Effect::StiffnessNonlinearity { joint: 2, added: 1e-7, knee: 1000.0 };
    let lost = Effect::LostMotion { joint: 2, gap: 3.5e-5, knee: 100.0 };
    let wrist = tilt(5, 1.5e-7);
    let tool = Effect::ToolCompliance { rotation: 3e-7, translation: 0.0 };
    let length = Effect::DhError { entry: DhEntry::D(6), value: 1e-3 };
    for (truth, rival, expected, remedies) in [
        (lost, hardening, "slow", &["five payloads"][..]),
        (tilt(1, 1e-7), Effect::BaseCompliance { tilt: 1e-7, translation: 0.0 }, "alias", &[]),
        (wrist, tool, "slow", &["rotation", "second reflector"]),
        (length, tilt(6, 1e-6), "separable", &[]),
    ] {
        let robot = if truth == tilt(1, 1e-7) { five_axis() } else { six_axis() };
        let campaign = measured(&robot, &[truth], &two, drawn(&robot, 20), 1);
        let found = between(&campaign, &[truth, rival], &Options { poses: 4, ..Options::default() });
        let [pair] = &found.pairs[..] else { panic!("{:?}", found.pairs) };
        let outlook = match pair.outlook {
            Outlook::Separable => "separable",
            Outlook::Slow(_) => "slow",
            Outlook::Alias => "alias",
        };
        assert_eq!(outlook, expected, "{pair:?}");
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
    assert!(kinds("joint_zero_offset@") >= 4 && kinds("dh_error@") >= 10, "{:?}", found.numbers);
    assert!(found.numbers.iter().all(|number| number.after < number.now));
    assert!(found.proposals.iter().all(|planned| planned.visit.loads == [[0.0; 6]]));
    let (adapter, rivals) = Adapter::new(&campaign, positions(&campaign), &traced, &[]).expect("positions");
    let judge = Judge::new(&adapter.known(), &rivals, adapter.variance());
    let gained = |visits: &[Visit]| {
        let after = adapter.information(visits, None).into_iter().fold(adapter.known(), |sum, one| sum + one);
        let (before, after) = (judge.stds(&adapter.known()), judge.stds(&after));
        before.iter().zip(&after).map(|(before, after)| (before / after).ln()).sum::<f64>() / before.len() as f64
    };
    let planned: Vec<Visit> = found.proposals.iter().map(|planned| planned.visit.clone()).collect();
    let random = (0..10).map(|seed| {
        let poses = poses(&measured(&robot, &[], &[0.0], drawn(&robot, MORE), seed));
        gained(&poses.into_iter().map(|q| Visit { q, loads: vec![[0.0; 6]] }).collect::<Vec<_>>())
    });
    let (planned, random) = (gained(&planned), random.fold(0.0, f64::max));
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
