//! Tracing on campaigns made from the regression's own columns: what is tested
//! is the statistics, not the mechanics.

use std::rc::Rc;
use std::string::ToString;
use std::vec;

use nalgebra::DVector;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::bench::{Bench, Known};
use super::model::{Fitted, Named};
use super::selection::{grow, select};
use super::settle::settled;
use super::*;
use crate::campaign::Data;
use crate::campaign::made::Plan;
use crate::identify::column::Column;
use crate::identify::prepare::Prepared;
use crate::identify::samples::Samples;
use crate::identify::{Visibility, predict};
use crate::probability::normal;
use robstiff::elements::Spring;
use robstiff_robots::samples::five_axis;

pub(super) const SIGMA: f64 = 1e-5;

/// A campaign of two ramps a pose on an arm with further numbers, each column
/// times its value; joint compliances as declared.
pub(super) fn campaign(robot: &Description, poses: usize, hidden: &[(Column, f64)], seed: u64) -> Campaign {
    Plan { robot: robot.clone(), poses, hidden: hidden.to_vec(), noise: [SIGMA; 3], ..Plan::new(seed) }.run()
}

pub(super) fn traced(campaign: &Campaign) -> Trace {
    trace(campaign, &Options { draws: 499, ..Options::default() }, &|_| {}).expect("a campaign of displacements")
}

pub(super) fn names(trace: &Trace) -> Vec<String> {
    trace.effects.iter().map(|named| named.effect.to_string()).collect()
}

/// What has become of a gear is told of its own numbers, not as another effect.
#[test]
fn declared_laws_of_joints_are_fitted_again() {
    let worn = |gap| robstiff::Effect::LostMotion { joint: 2, gap, knee: 60.0 };
    let lags = |weight1| robstiff::Effect::Hysteresis {
        joint: 3,
        radius1: 40.0,
        weight1,
        radius2: 0.0,
        weight2: 0.0,
        radius3: 0.0,
        weight3: 0.0,
    };
    let cases = [
        (worn(1e-4), worn(3e-4), 3e-4),
        (worn(6e-4), worn(3e-4), 3e-4),
        (lags(1e-7), lags(3e-7), 3e-7),
        (lags(6e-7), lags(3e-7), 3e-7),
    ];
    for ((declared, now, truth), seed) in cases.into_iter().zip(3..) {
        let mut robot = five_axis();
        robot.effects.push(now);
        let mut campaign = campaign(&robot, 40, &[], seed);
        campaign.robot.effects[0] = declared;
        let trace = traced(&campaign);
        assert_eq!((names(&trace), trace.verdict), (vec![], Verdict::Adequate), "{declared}: {}", trace.why);
        let number = trace.estimates.last().expect("a number of the effect");
        let std = number.std.unwrap_or_else(|| panic!("{number:?}"));
        assert!((number.value - truth).abs() < 4.0 * std && std < 0.2 * truth, "{number:?}");
        assert!(trace.description.effects[0].numbers().contains(&number.value), "{:?}", trace.description.effects);
    }
}

pub(super) const TILT_3: (Column, f64) = (Column::Spring(Spring::Transverse(3)), 6e-7);

#[test]
fn a_missing_effect_is_named_and_goes_into_the_description() {
    let campaign = campaign(&five_axis(), 24, &[TILT_3], 3);
    let found = traced(&campaign);
    assert_eq!((names(&found), found.verdict), (vec!["transverse_compliance@joint 3".to_string()], Verdict::Explained));
    let h = &found.effects[0].effect.parameters[0];
    assert!((h.value - TILT_3.1).abs() < 4.0 * h.std.expect("a compliance has one"), "{h:?}");
    assert!(found.after.rms < 1.5 * SIGMA * 2_f64.sqrt() && found.identified.rms > 2.0 * found.after.rms);
    assert!((found.noise / SIGMA - 1.0).abs() < 0.2, "{}", found.noise);

    let predicted = predict(&found.description, &campaign).expect("the same robot");
    assert!((predicted.rms / found.after.rms - 1.0).abs() < 1e-9, "the description says what the model says");
    assert!(found.description.source.contains("transverse_compliance@joint 3"));
}

/// As where rows are cut that had spoken for it, or the noise is learnt again.
#[test]
fn what_is_not_significant_does_not_stay_named() {
    let campaign = campaign(&five_axis(), 24, &[TILT_3], 3);
    let prepared = Prepared::new(&campaign).expect("a campaign of displacements");
    let mut bench = Bench::new(&campaign, &prepared).expect("it shows the joints");
    let setting = bench.at(&[]).expect("no effects");
    let count = bench.candidates().len();
    let truth = (0..count).find(|&candidate| bench.candidates()[candidate].name() == "transverse_compliance@joint 3");
    let truth = truth.expect("it is in the catalogue");
    let alone = selection::best_with(&setting, &[], truth).expect("physically possible").named;
    let besides = (0..count).filter_map(|candidate| selection::best_with(&setting, &alone, candidate));
    let besides: Vec<Fitted> = besides.take(10).collect();
    assert_eq!(besides.len(), 10);
    for model in besides {
        let settled = settled(&mut bench, model, &Options::default());
        assert_eq!(settled.model.named.iter().map(|one| one.candidate).collect::<Vec<_>>(), [truth]);
        assert!(settled.p_values.len() == 1 && settled.p_values[0] < 0.001, "{:?}", settled.p_values);
        assert_eq!(settled.dropped.len(), 1);
    }
}

/// A model of as many effects as are looked for is tested like any other.
#[test]
fn what_is_missing_beside_six_effects_is_told() {
    let campaign = campaign(&five_axis(), 24, &[TILT_3], 3);
    let prepared = Prepared::new(&campaign).expect("a campaign of displacements");
    let mut bench = Bench::new(&campaign, &prepared).expect("it shows the joints");
    let is_of_a_gear = |candidate: &usize| {
        let name = bench.candidates()[*candidate].name();
        name.starts_with("pose_dependent_compliance") || name.starts_with("stiffness_nonlinearity")
    };
    let of_gears = (0..bench.candidates().len()).filter(is_of_a_gear);
    let six: Vec<Named> = of_gears.map(|candidate| Named { candidate, variant: 0 }).take(6).collect();
    let mut model = bench.fit_or_loosely(&six).expect("other than the tilt");
    let mut steps = Vec::new();
    let unnamed = grow(&mut bench, &mut model, &mut steps, &Options { draws: 199, ..Options::default() }, &|_| {});
    let last = steps.last().expect("it was tested");
    assert!(unnamed.expect("it shows the joints") && last.outcome.starts_with("something is missing beside 6 effects"));
}

/// Whatever they were like when the model was come to.
#[test]
fn a_model_settles_on_its_own_rows_and_noise() {
    let campaign = campaign(&five_axis(), 24, &[TILT_3], 3);
    let prepared = Prepared::new(&campaign).expect("a campaign of displacements");
    let mut bench = Bench::new(&campaign, &prepared).expect("it shows the joints");
    let alone = bench.fit(&[]).expect("no effects");
    let found = select(&mut bench, alone, &Options::default(), &|_| {});
    let model = found.expect("it shows the joints").model;
    let learnt = bench.noise.covariance.own[0];
    let mut noise = Known::clone(&bench.noise);
    noise.covariance.own.iter_mut().for_each(|own| *own *= 3.0);
    bench.noise = Rc::new(noise);
    bench.left_out[..6].fill(true);
    let settled = settled(&mut bench, model, &Options::default());
    assert_eq!((settled.dropped.len(), settled.model.named.len()), (0, 1));
    assert!(!bench.left_out.contains(&true), "rows that fit came back");
    assert!((bench.noise.covariance.own[0] / learnt - 1.0).abs() < 0.01, "{}", bench.noise.covariance.own[0]);
}

#[test]
fn one_seed_gives_one_result() {
    let campaign = campaign(&five_axis(), 16, &[TILT_3], 5);
    let (first, second) = (traced(&campaign), traced(&campaign));
    assert_eq!(first.after, second.after);
    let p_values =
        |trace: &Trace| -> Vec<f64> { trace.steps.iter().flat_map(|s| &s.candidates).map(|c| c.p_value).collect() };
    assert_eq!(p_values(&first), p_values(&second));
}

#[test]
fn an_arm_that_lacks_nothing_is_adequate() {
    let adequate = (0..10).filter(|&seed| traced(&campaign(&five_axis(), 20, &[], seed)).verdict == Verdict::Adequate);
    assert!(adequate.count() >= 9);
}

#[test]
fn poses_held_out_are_kept_from_the_search() {
    let mut campaign = campaign(&five_axis(), 24, &[TILT_3], 3);
    campaign.holdout = Some(crate::campaign::Holdout { fraction: 0.25, seed: 1 });
    let found = traced(&campaign);
    assert_eq!(found.held_out.len(), 6);
    assert_eq!(names(&found), ["transverse_compliance@joint 3"]);
    // Readings of the poses held out do not reach the search and the estimates,
    // even where they speak against what is found.
    if let Data::Displacement(data) = &mut campaign.data {
        for row in data.rows.iter_mut().filter(|row| found.held_out.contains(&row.pose.to_string())) {
            row.displacement = row.displacement.map(|reading| -20.0 * reading);
        }
    }
    let again = traced(&campaign);
    assert_eq!((names(&again), &again.estimates), (names(&found), &found.estimates));
    assert!(again.after.holdout_rms > again.identified.holdout_rms);
    assert!(again.after.holdout_rms > 10.0 * found.after.holdout_rms);
}

#[test]
fn few_poses_are_insufficient() {
    let found = traced(&campaign(&five_axis(), 5, &[TILT_3], 3));
    assert_eq!(found.verdict, Verdict::Insufficient);
    assert!(found.effects.is_empty() && found.why.contains("5 poses are too few"));
}

/// Data that can tell nothing change nothing, and the errors are those of the
/// description that is written.
#[test]
fn insufficient_data_leave_the_description_as_declared() {
    let mut declared = five_axis();
    declared.joints.iter_mut().flat_map(|joint| &mut joint.compliance).for_each(|part| part.value *= 0.6);
    let mut campaign = campaign(&five_axis(), 5, &[TILT_3], 3);
    campaign.robot = declared.clone();
    let found = traced(&campaign);
    assert_eq!((found.verdict, &found.description), (Verdict::Insufficient, &declared));
    assert_eq!(found.after, found.declared);
    assert!(found.identified.rms < found.declared.rms);
    let predicted = predict(&found.description, &campaign).expect("the same robot");
    assert!((predicted.rms / found.after.rms - 1.0).abs() < 1e-9);
    let of_rows = found.residuals.iter().flat_map(|row| row.after).map(|r| r * r).sum::<f64>();
    assert!(((of_rows / (3.0 * found.rows as f64)).sqrt() / found.after.rms - 1.0).abs() < 1e-9);
}

/// Readings of the wrong sign say of every joint that it is less than rigid,
/// and so nothing of what is missing.
#[test]
fn readings_against_the_loads_are_insufficient() {
    let mut campaign = campaign(&five_axis(), 16, &[TILT_3], 3);
    if let Data::Displacement(data) = &mut campaign.data {
        data.rows.iter_mut().for_each(|row| row.displacement = row.displacement.map(|reading| -reading));
    }
    let found = traced(&campaign);
    assert_eq!((found.verdict, &found.description), (Verdict::Insufficient, &campaign.robot));
    assert!(found.why.starts_with("the readings do not follow the loads; the files may say something else"));
    let signs = ["dx, dy and dz with the other sign", "Fx, Fy and Fz with the other sign"];
    assert_eq!(found.looks_like, signs);
    let seen = || found.estimates.iter().filter(|estimate| estimate.visibility == Visibility::Seen);
    assert!(seen().count() > 0 && seen().all(|estimate| estimate.at_bound && estimate.value == 0.0));
    assert!(seen().all(|estimate| estimate.std.is_none() && !estimate.is_noteworthy()));
}

/// A joint whose number noise takes a little below zero does not speak against an effect that
/// explains many times what is lost by holding it there.
#[test]
fn a_joint_a_little_below_zero_does_not_rule_out_what_is_missing() {
    let arm = five_axis();
    let sure = traced(&campaign(&arm, 24, &[TILT_3], 3));
    for (joint, (own, estimate)) in (1..).zip(arm.joints.iter().zip(&sure.estimates)) {
        let below = 3.0 * estimate.std.expect("every joint is seen");
        let hidden = (Column::Spring(Spring::Joint(joint)), -own.compliance() - below);
        let found = traced(&campaign(&arm, 24, &[TILT_3, hidden], 3));
        let told = (names(&found), found.verdict, found.estimates[joint - 1].at_bound);
        assert_eq!(told, (vec!["transverse_compliance@joint 3".into()], Verdict::Explained, true), "joint {joint}");
    }
}

/// In the standard convention joint 1 stands on the base, so its tilt is that
/// of the base; tilts of a spherical wrist differ by joint compliances.
#[test]
fn exact_aliases_are_said() {
    let found = traced(&campaign(&five_axis(), 24, &[(Column::Spring(Spring::BaseTilt), 1e-7)], 3));
    assert_eq!(names(&found), ["base_compliance@base"]);
    assert!(found.effects[0].same_as.contains(&"transverse_compliance@joint 1".to_string()));
}

/// They are those of the model with all its effects: without one, the others may come to nothing
/// that is possible, as a lever does that makes up for a soft base.
#[test]
fn exact_aliases_are_said_beside_other_effects() {
    let hidden = std::vec![(Column::Spring(Spring::BaseTilt), 6e-7)];
    let mut campaign = Plan { hidden, at: [[0.03, -0.05, 0.06], [0.0; 3]], ..Plan::new(3) }.run();
    if let Data::Displacement(data) = &mut campaign.data {
        data.wrench_at = [0.0; 3];
    }
    let found = traced(&campaign);
    let base = found.effects.iter().find(|named| named.effect.to_string() == "base_compliance@base");
    let base = base.unwrap_or_else(|| panic!("{:?}", names(&found)));
    assert_eq!(names(&found).len(), 2, "{:?}", names(&found));
    assert!(base.same_as.contains(&"transverse_compliance@joint 1".to_string()), "{:?}", base.same_as);
}

/// The base that yields alike in every direction moves the tool as the tool itself does, and
/// is told in one breath with the base's tilt.
#[test]
fn exact_aliases_of_a_part_are_said() {
    let hidden = [(Column::Spring(Spring::BaseTilt), 1e-7), (Column::Spring(Spring::ToolTranslation), 1e-7)];
    let found = traced(&campaign(&five_axis(), 24, &hidden, 3));
    assert_eq!(names(&found), ["base_compliance@base"]);
    let in_part = &found.effects[0].in_part;
    assert_eq!(*in_part, ["tool_compliance@tool", "transverse_compliance@joint 1"]);
    assert!(found.effects[0].same_as.is_empty(), "{:?}", found.effects[0].same_as);
}

/// A gear that grows softer with the rows, as nothing in the catalogue does, is
/// seen and not named.
#[test]
fn what_is_not_in_the_catalogue_stays_unexplained() {
    let found = traced(&softening(&[], 2e-7));
    assert!(matches!(found.verdict, Verdict::Unexplained | Verdict::Partial), "{:?}", names(&found));
    assert!(found.effects.iter().all(|named| named.partial) && !found.why.is_empty());
}

/// A campaign whose joint 2 grows softer from the first row to the last, by so much (rad/Nm).
fn softening(hidden: &[(Column, f64)], by: f64) -> Campaign {
    let mut campaign = campaign(&five_axis(), 24, hidden, 4);
    let moves = displacements(&mut campaign, |samples| samples.column(Column::Spring(Spring::Joint(2))));
    if let Data::Displacement(data) = &mut campaign.data {
        let rows = data.rows.len() as f64;
        for (i, row) in data.rows.iter_mut().enumerate() {
            let softer = by * i as f64 / rows;
            row.displacement = core::array::from_fn(|k| row.displacement[k] + softer * moves[3 * i + k]);
        }
    }
    campaign
}

/// What no effect accounts for lies along those of the joint that does it, and beside it
/// what is true stays named.
#[test]
fn what_is_left_lies_along_what_it_is_like() {
    let campaign = softening(&[TILT_3], 4e-7);
    let prepared = Prepared::new(&campaign).expect("a campaign of displacements");
    let bench = Bench::new(&campaign, &prepared).expect("it shows the joints");
    let setting = bench.at(&[]).expect("no effects");
    let of = |name: &str| (0..bench.candidates().len()).find(|&one| bench.candidates()[one].name() == name);
    let [tilt, curve] = ["transverse_compliance@joint 3", "stiffness_nonlinearity@joint 2"].map(of);
    let tilt = selection::best_with(&setting, &[], tilt.expect("in the catalogue")).expect("possible");
    let both = selection::best_with(&setting, &tilt.named, curve.expect("in the catalogue")).expect("possible");
    let (at_tilt, at_both) = (bench.at(&tilt.named).expect("linear"), bench.at(&both.named).expect("a knee"));
    let (alone, beside) = (along::along(&at_tilt, &tilt), along::along(&at_both, &both));
    let of_curve = both.named.iter().position(|one| !tilt.named.contains(one)).expect("there are two");
    assert!(alone[0].ratio < 0.8 && beside[1 - of_curve].ratio < 0.8, "{alone:?} {beside:?}");
    assert!(beside[of_curve].ratio > 0.95 && beside[of_curve].is_significant, "{beside:?}");

    let found = traced(&campaign);
    assert_eq!((names(&found), found.verdict), (vec!["transverse_compliance@joint 3".into()], Verdict::Partial));
}

fn displacements(campaign: &mut Campaign, of: impl Fn(&Samples) -> DVector<f64>) -> DVector<f64> {
    let Data::Displacement(data) = &campaign.data else { unreachable!("displacements") };
    of(&Samples::of_description(&campaign.robot, data))
}

/// A drift is the rig's: it is named, corrected for and not written down.
#[test]
fn faults_of_the_rig_stay_out_of_the_robot() {
    let mut campaign = campaign(&five_axis(), 24, &[], 5);
    if let Data::Displacement(data) = &mut campaign.data {
        for (i, row) in data.rows.iter_mut().enumerate() {
            row.displacement[0] += 4e-7 * (i as f64 - 120.0);
        }
    }
    let found = traced(&campaign);
    assert_eq!((names(&found), found.verdict), (vec!["thermal_drift@rig".to_string()], Verdict::Explained));
    assert!(found.description.effects.is_empty() && found.effects[0].effect.is_of_rig());
    assert!(found.identified.rms > 1.2 * found.after.rms && found.after.rms < 1.5 * SIGMA * 2_f64.sqrt());
}

/// The family-wise test rejects a true null as often as it says, also with
/// poses of unlike noise.
#[test]
fn the_bootstrap_has_its_nominal_size() {
    let (runs, level) = (100, 0.1);
    let rejected = (0..runs).filter(|&seed| {
        let mut campaign = campaign(&five_axis(), 15, &[], 1000 + seed);
        if let Data::Displacement(data) = &mut campaign.data {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            for row in data.rows.iter_mut().filter(|row| row.pose % 3 == 0) {
                row.displacement.iter_mut().for_each(|d| *d += 2.0 * SIGMA * normal(&mut rng));
            }
        }
        let prepared = Prepared::new(&campaign).expect("displacements");
        let bench = Bench::new(&campaign, &prepared).expect("joints are seen");
        let options = Options { seed, draws: 199, alpha: level };
        bench.tests(&[], &options).expect("joints are seen").smallest_p() <= level
    });
    let share = rejected.count() as f64 / runs as f64;
    // Three standard errors of a binomial above; the CR3 residuals err below.
    assert!((0.02..level + 3.0 * (level * (1.0 - level) / runs as f64).sqrt()).contains(&share), "{share}");
}
