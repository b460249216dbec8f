//! Measurements that were planned: simulated, and judged by what they tell
//! apart, against poses and loads drawn at random.

use std::path::PathBuf;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff::Effect;
use robstiff_identify::campaign::{Campaign, Data, Frame, Noise};
use robstiff_identify::identify::identify;
use robstiff_identify::plan::{Group, Options, Outlook, Plan, plan_between};
use robstiff_identify::simulate::{Measures, Poses, Pull, Scenario, Simulated, UnderForces, simulate};
use robstiff_identify::trace::{self, trace};
use robstiff_robots::Description;
use robstiff_tests::simulator::{five_axis, six_axis};

/// Noise of one reading (m).
const NOISE: f64 = 8e-6;

/// The greatest force (N).
const FORCE: f64 = 1200.0;

/// Poses of the first campaign, and how many are added to it.
const FIRST: usize = 14;
const MORE: usize = 8;

const SEEDS: std::ops::Range<u64> = 700..712;

/// One pull a pose, with poses and directions given or drawn.
fn scenario(hidden: &[Effect], poses: Poses, directions: Vec<[f64; 3]>, seed: u64) -> Scenario {
    Scenario {
        name: String::from("planned"),
        seed,
        poses,
        visits: 1,
        measures: Measures::Displacements(UnderForces {
            ramp: vec![1.0],
            force: Pull { bounds: [FORCE; 2], directions },
            moment: None,
            frames: [Frame::Base; 2],
            rotation_noise: None,
            encoder_noise: None,
            shares_unloaded: true,
        }),
        wrench_at: [0.0; 3],
        measured_at: [0.0; 3],
        noise: [NOISE; 3],
        states_noise: true,
        hidden: hidden.to_vec(),
        scatter: 0.3,
        holdout: None,
    }
}

fn drawn(robot: &Description, count: usize) -> Poses {
    let within = robot.joints.iter().map(|joint| joint.limits.expect("the arms have limits")).collect();
    Poses::Drawn { count, within, floor: Some(0.1), column: Some(0.6) }
}

fn campaign(simulated: &Simulated) -> Campaign {
    Campaign {
        name: simulated.scenario.name.clone(),
        date: String::new(),
        operator: String::new(),
        path: PathBuf::new(),
        robot_path: PathBuf::new(),
        observations_path: PathBuf::new(),
        robot: simulated.declared.clone(),
        data: simulated.data.clone(),
        noise: Noise { displacement: Some(NOISE), rotation: None },
        holdout: None,
        held_out: Vec::new(),
        warnings: Vec::new(),
    }
}

/// Poses and directions of a campaign, a pull each.
type Pulls = Vec<(Vec<f64>, [f64; 3])>;

fn pulls(simulated: &Simulated) -> Pulls {
    let Data::Displacement(data) = &simulated.data else { unreachable!("displacements") };
    let rows = data.rows.iter();
    rows.map(|row| (row.q.clone(), [row.wrench[0], row.wrench[1], row.wrench[2]])).collect()
}

/// The campaign with these pulls, the first of them as they were.
fn measured(robot: &Description, hidden: &[Effect], pulls: &Pulls, seed: u64) -> Campaign {
    let (poses, directions) = pulls.iter().cloned().unzip();
    campaign(&simulate(robot, &scenario(hidden, Poses::Listed(poses), directions, seed)).expect("measured"))
}

/// A plan to tell an effect from others, whatever the trace made of them.
fn plan_for(campaign: &Campaign, one: Effect, others: &[Effect], options: &Options) -> Plan {
    // Folds have no part in a plan.
    let tracing = trace::Options { folds: 2, ..trace::Options::default() };
    let mut traced = trace(campaign, &tracing, &|_| {}).expect("traced");
    traced.effects.clear();
    traced.suspected.clear();
    let names = [&[one], others].concat().iter().map(ToString::to_string).collect();
    plan_between(campaign, &traced, &[Group { named: None, names }], options).expect("planned")
}

/// By how much chi-square favours one effect over another. One row a visit, so
/// every displacement has the variance of two readings.
fn favours(campaign: &Campaign, one: Effect, other: Effect) -> f64 {
    let Data::Displacement(data) = &campaign.data else { unreachable!("displacements") };
    let chi_square = |effect: Effect| {
        let mut campaign = campaign.clone();
        campaign.robot.effects.push(effect);
        let rms = identify(&campaign).expect("identified").rms.expect("of displacements");
        3.0 * data.rows.len() as f64 * rms * rms / (2.0 * NOISE * NOISE)
    };
    chi_square(other) - chi_square(one)
}

/// Whether a trace names an effect, or what is its exact alias, and can tell it
/// from another.
fn decides(campaign: &Campaign, truth: Effect, rival: Effect) -> bool {
    let traced = trace(campaign, &trace::Options::default(), &|_| {}).expect("traced");
    let [named] = &traced.effects[..] else { return false };
    let stands_for = |effect: Effect| {
        let name = effect.to_string();
        named.effect.to_string() == name || named.same_as().contains(&name)
    };
    stands_for(truth) && !stands_for(rival)
}

/// What came of planned and of random pulls over the seeds.
struct Gains {
    /// By how much chi-square favours the truth, on the mean.
    favours: [f64; 2],
    /// The standard error of the difference.
    error: f64,
    /// How many traces name the truth and do not think it could be the rival.
    decided: [usize; 2],
}

fn gains(robot: &Description, truth: Effect, rival: Effect) -> Gains {
    let mut differences = Vec::new();
    let mut sums = [0.0; 2];
    let mut decided = [0; 2];
    for seed in SEEDS {
        let first = simulate(robot, &scenario(&[truth], drawn(robot, FIRST), Vec::new(), seed)).expect("measured");
        let options = Options { poses: MORE, ..Options::default() };
        let planned = plan_for(&campaign(&first), truth, &[rival], &options);
        let next = |planned: &robstiff_identify::plan::Planned| {
            let [x, y, z, ..] = planned.greatest;
            (planned.visit.q.clone(), [x, y, z])
        };
        let planned: Pulls = planned.proposals.iter().map(next).collect();
        let random = scenario(&[], drawn(robot, MORE), Vec::new(), seed + 5000);
        let random = pulls(&simulate(robot, &random).expect("measured"));
        let campaigns = [planned, random].map(|more| {
            let all: Pulls = pulls(&first).into_iter().chain(more).collect();
            measured(robot, &[truth], &all, seed)
        });
        let favours = campaigns.each_ref().map(|campaign| favours(campaign, truth, rival));
        for (count, campaign) in decided.iter_mut().zip(&campaigns) {
            *count += usize::from(decides(campaign, truth, rival));
        }
        sums = [sums[0] + favours[0], sums[1] + favours[1]];
        differences.push(favours[0] - favours[1]);
    }
    let count = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / count;
    let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let (favours, error) = (sums.map(|sum| sum / count), (variance / count).sqrt());
    println!("{truth} against {rival}: {favours:.1?} +- {error:.1}, decided {decided:?}");
    Gains { favours, error, decided }
}

/// Twelve campaigns, with the same noise on either side: the mean difference is
/// to exceed three of its own standard errors, and traces decide at least as
/// often; more often where random poses seldom do.
fn planned_poses_are_better(robot: &Description, truth: Effect, rival: Effect) {
    let Gains { favours: [planned, random], error, decided } = gains(robot, truth, rival);
    assert!(planned - random > 3.0 * error, "{truth}: {planned:.1}, {random:.1} +- {error:.1}");
    assert!(decided[0] >= decided[1] && (decided[0] > decided[1] || decided[1] > 6), "{truth}: {decided:?}");
}

fn tilt(joint: usize, value: f64) -> Effect {
    Effect::TransverseCompliance { joint, value }
}

const BENDING: Effect = Effect::LinkCompliance { link: 3, bending: 3e-7, torsion: 0.0 };

#[test]
fn a_tilt_is_separated_from_bending_of_six() {
    planned_poses_are_better(&six_axis(), tilt(3, 6e-7), BENDING);
}

#[test]
fn a_tilt_is_separated_from_bending_of_five() {
    planned_poses_are_better(&five_axis(), tilt(3, 2e-7), BENDING);
}

#[test]
fn a_tilt_of_the_base_is_separated_from_that_of_joint_2() {
    planned_poses_are_better(&six_axis(), Effect::BaseCompliance { tilt: 1.5e-8, translation: 0.0 }, tilt(2, 3e-7));
}

fn planned(robot: &Description, named: Effect, same_as: &[Effect], options: &Options) -> Plan {
    let first = simulate(robot, &scenario(&[named], drawn(robot, 20), Vec::new(), 1)).expect("measured");
    plan_for(&campaign(&first), named, same_as, options)
}

/// What no pose separates is said to be so, and no sensor is named that would not separate it either.
#[test]
fn exact_aliases_are_said_to_be_so() {
    let robot = five_axis();
    let base = |tilt, translation| Effect::BaseCompliance { tilt, translation };
    let tool = Effect::ToolCompliance { rotation: 0.0, translation: 8e-8 };
    for (named, rival) in
        [(base(6e-8, 0.0), Effect::TransverseCompliance { joint: 1, value: 6e-8 }), (base(0.0, 8e-8), tool)]
    {
        let found = planned(&robot, named, &[rival], &Options { poses: 6, ..Options::default() });
        let [pair] = &found.pairs[..] else { panic!("{:?}", found.pairs) };
        assert_eq!(pair.outlook, Outlook::Alias, "{pair:?}");
        assert!(pair.after < 1e-2 && pair.angle < 1e-3, "{pair:?}");
        assert_eq!(pair.remedies, [], "{pair:?}");
        assert!(found.proposals.iter().all(|proposal| proposal.separates.is_none()));
    }
}

/// Under forces alone the tool of a wrist turns as the wrist's joints tilt; a
/// second lever tells them apart.
#[test]
fn a_second_lever_tells_the_tool_from_the_wrist() {
    let wrist = Effect::TransverseCompliance { joint: 5, value: 1.5e-6 };
    let tool = Effect::ToolCompliance { rotation: 3e-6, translation: 0.0 };
    let found = planned(&six_axis(), wrist, &[tool], &Options { poses: 6, ..Options::default() });
    let [pair] = &found.pairs[..] else { panic!("{:?}", found.pairs) };
    assert_ne!(pair.outlook, Outlook::Separable, "{pair:?}");
    assert!(pair.remedies.iter().any(|one| one.words.contains("second lever length")), "{:?}", pair.remedies);
}

#[test]
fn proposals_stay_within_limits_and_one_seed_gives_one_plan() {
    let robot = six_axis();
    let (tilt, bending) = (
        Effect::TransverseCompliance { joint: 3, value: 6e-7 },
        Effect::LinkCompliance { link: 3, bending: 3e-7, torsion: 0.0 },
    );
    let options = Options { poses: 7, force: Some(640.0), moment: Some(90.0), floor: Some(0.5), ..Options::default() };
    let found = planned(&robot, tilt, &[bending], &options);
    assert_eq!(found.proposals.len(), 7);
    for proposal in &found.proposals {
        assert!(proposal.visit.q.iter().zip(&robot.joints).all(|(&q, joint)| joint.reaches(q)));
        let [force, moment] = [0, 3].map(|first| Vector3::from_row_slice(&proposal.greatest[first..first + 3]).norm());
        assert!((force - 640.0).abs() < 1e-6 && (moment == 0.0 || (moment - 90.0).abs() < 1e-6));
        let [.., height] = robstiff_tests::simulator::Arm::new(&robot, &[]).tcp(&proposal.visit.q);
        assert!(height >= 0.5 - 1e-6, "{height}");
    }
    // Each pose is one of its own, and each measurement adds to what is known.
    for (k, one) in found.proposals.iter().enumerate() {
        assert!(found.proposals[..k].iter().all(|other| other.visit.q != one.visit.q));
        let before = if k == 0 { found.pairs[0].now } else { found.proposals[k - 1].separation[0] };
        assert!(one.separation[0] >= before);
    }
    assert!(found.numbers.iter().all(|number| number.after <= number.now));
    assert_eq!(planned(&robot, tilt, &[bending], &options).proposals, found.proposals);
    let other = planned(&robot, tilt, &[bending], &Options { seed: 2, ..options });
    assert_ne!(other.proposals, found.proposals);
}

/// Random draws are their own test of the expectation: chi-square favours the
/// truth by its expected value, within four standard errors.
#[test]
fn what_is_expected_comes_true() {
    let robot = six_axis();
    let truth = Effect::TransverseCompliance { joint: 3, value: 6e-7 };
    let rival = Effect::LinkCompliance { link: 3, bending: 3e-7, torsion: 0.0 };
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut errors = Vec::new();
    for seed in SEEDS {
        let first = simulate(&robot, &scenario(&[truth], drawn(&robot, 60), Vec::new(), seed)).expect("measured");
        let expected = plan_for(&campaign(&first), truth, &[rival], &Options { poses: 1, ..Options::default() });
        let expected = expected.pairs[0].now.powi(2);
        let again = measured(&robot, &[truth], &pulls(&first), random.random());
        errors.push((favours(&again, truth, rival) - expected) / (2.0 * expected.sqrt()));
    }
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    println!("{errors:.2?}");
    assert!(mean.abs() < 4.0 / (errors.len() as f64).sqrt(), "{mean}");
}
