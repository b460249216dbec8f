//! Simulated campaigns, traced.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use robstiff_robots::{Description, catalogue};

use super::{NoiseSource, Options, Trace, Verdict, trace};
use crate::campaign::made::campaign;
use crate::campaign::{Campaign, ClampedRow, Data, Noise};
use crate::fit::case::Case;
use crate::model::Term;
use crate::model::arm::BETA;
use crate::predict::predict;
use crate::probability::normal;
use crate::select::folds::nested;
use crate::simulate::{Scenario, simulate};

const LOADS: &str = "\
name: a try
seed: 4
poses: {count: 30, floor: 100 mm, column: 600 mm}
visits: 2
ramp: [0.5, 1, -0.25]
force: {bounds: [500 N, 1.3 kN]}
noise: {displacement: 8 um}
scatter: 0.3
";

const POSITIONS: &str = "\
name: a try
kind: position
seed: 4
poses: {count: 60, floor: 100 mm, column: 600 mm}
noise: {displacement: 30 um}
";

const TILT: &str = "hidden:\n  effects:\n    - {kind: transverse_compliance, at: joint 3, value: 6e-7 rad/Nm}\n";
const ZERO: &str = "hidden:\n  effects:\n    - {kind: joint_zero_offset, at: joint 3, value: 0.1 deg}\n";

fn robot() -> Description {
    let text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
    Description::parse("robot.yaml", text).expect("of the catalogue")
}

/// A campaign whose noise is declared, where it is given (m).
fn simulated(scenario: &str, noise: Option<f64>) -> Campaign {
    let robot = robot();
    let scenario = Scenario::parse("try.yaml", scenario, &robot).unwrap_or_else(|problems| panic!("{problems}"));
    let made = simulate(&robot, &scenario).expect("it can be measured");
    Campaign { noise: Noise { displacement: noise, ..Noise::default() }, ..campaign(made.declared, made.data) }
}

fn traced(campaign: &Campaign) -> Trace {
    trace(campaign, &Options::default(), &|_| ()).expect("it can be traced")
}

fn names(trace: &Trace) -> Vec<String> {
    trace.effects.iter().map(|named| named.effect.to_string()).collect()
}

/// Load and reading both sit elsewhere on the tool. The tilt that is there as well goes into the description, and unseen poses are predicted better by it than by
/// the description's own numbers.
#[test]
fn two_faults_of_the_rig_are_corrected_for_in_what_is_written() {
    let scenario = format!("{LOADS}{TILT}wrench: {{at: [0.12, 0, 0]}}\nmeasured: {{at: [0, 0.12, 0.05]}}\n");
    let mut campaign = simulated(&scenario, None);
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
    (data.wrench_at, data.measured_at) = ([0.0; 3], [0.0; 3]);
    let found = traced(&campaign);
    let names = names(&found);
    for name in ["lever_arm@rig", "reflector_offset@rig"] {
        assert!(names.iter().any(|named| named == name), "{name}: {names:?} {:?}", found.suspected);
    }
    assert!(
        found.written.holdout_rms < 0.5 * found.identified.holdout_rms,
        "{:?} {:?}",
        found.written,
        found.identified
    );
    // On the rig as it is the description predicts to the noise: two readings of 8 um.
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
    (data.wrench_at, data.measured_at) = ([0.12, 0.0, 0.0], [0.0, 0.12, 0.05]);
    let error = predict(&found.description, &campaign).expect("it is of this robot").rms;
    assert!(error < 1.2 * 8e-6 * 2_f64.sqrt(), "{error}");
}

/// Its tilt is larger than bearings usually give way, and two springs of a softer neighbour are usual.
#[test]
fn an_effect_that_is_larger_than_usual_is_not_passed_over() {
    let found = traced(&simulated(&format!("{LOADS}{TILT}"), Some(8e-6)));
    let named =
        found.effects.iter().any(|named| named.class.iter().any(|(name, _)| name == "transverse_compliance@joint 3"));
    assert!(named, "{:?} {:?}", found.effects, found.suspected);
}

#[test]
fn readings_against_the_loads_tell_nothing() {
    let mut campaign = simulated(LOADS, Some(8e-6));
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
    data.rows.iter_mut().for_each(|row| row.displacement = row.displacement.map(|d| -d));
    let case = Case::new(&campaign, &campaign.robot);
    let mut engine = case.engine(&campaign.robot);
    let alone = engine.fit_alone().expect("it can be fitted");
    // Without any spring that is not negative nothing is accounted for.
    let readings = case.observation.readings();
    let rms = readings.rms(&alone, 0..readings.rows());
    assert!(rms > 0.9 * readings.rms(&readings.values, 0..readings.rows()), "{rms}");
    let found = traced(&campaign);
    assert_eq!(found.verdict, Verdict::Insufficient, "{}", found.why);
    assert!(found.why.contains("against the loads"), "{}", found.why);
}

/// A noise of 1.1 um that nobody declares is known from loads that are repeated, and nothing is left
/// beyond it.
#[test]
fn a_fine_noise_is_its_own() {
    let scenario = LOADS.replace("[0.5, 1, -0.25]", "[0.5, 1, 0.5, 1]").replace("8 um", "1.1 um");
    let found = traced(&simulated(&scenario, None));
    assert_eq!(found.noise_source, NoiseSource::Repetitions);
    assert!((0.9e-6..1.3e-6).contains(&found.noise), "{}", found.noise);
    assert_eq!(found.verdict, Verdict::Adequate, "{}", found.why);
}

/// One axis says nothing of another: what is unseen is a part of the loads of each.
#[test]
fn every_axis_is_in_every_fold() {
    let robot = robot();
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut rows = Vec::new();
    for axis in 1..=4 {
        for share in [0.25, 0.5, 0.75, 1.0, 0.75, 0.5, 0.25, -0.25, -0.5, -0.75, -1.0, -0.75, -0.5, -0.25] {
            let torque = 3000.0 * share;
            let deflection = 1.2 * robot.joints[axis - 1].compliance() * torque + 2e-6 * normal(&mut random);
            rows.push(ClampedRow { line: rows.len() + 2, axis, torque, deflection });
        }
    }
    let noise = Noise { rotation: Some(2e-6), ..Noise::default() };
    let campaign = Campaign { noise, ..campaign(robot, Data::Clamped(rows)) };
    let case = Case::new(&campaign, &campaign.robot);
    let mut engine = case.engine(&campaign.robot);
    let (found, _) = engine.run_from_alone(&|_| ()).expect("it can be fitted");
    let nested = nested(&engine, &found, 5, 1, &|_| ());
    let readings = case.observation.readings();
    let unseen = readings.rms(&nested.alone, 0..readings.rows());
    assert!(unseen < 1.3 * 2e-6, "{unseen}");
    let found = traced(&campaign);
    assert_eq!((found.poses, found.verdict), (4, Verdict::Adequate), "{}", found.why);
}

/// What is written predicts as well as is said of it.
#[test]
fn a_written_table_predicts_what_was_fitted() {
    let campaign = simulated(&format!("{POSITIONS}{ZERO}"), Some(3e-5));
    let found = traced(&campaign);
    assert_eq!(names(&found), ["joint_zero_offset@joint 3".to_string()], "{:?}", found.suspected);
    let error = predict(&found.description, &campaign).expect("it is of this robot").rms;
    assert!((error / found.written.rms - 1.0).abs() < 0.02, "{error} {:?}", found.written);
    assert!(error < 1.1 * 3e-5, "{error}");
}

/// Noise with heavy tails has readings that are far off. They are its own.
#[test]
fn tails_are_no_outliers() {
    let mut campaign = simulated(&LOADS.replace("8 um", "0 um"), None);
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for row in &mut data.rows {
        // Student's distribution with three degrees of freedom.
        let square: f64 = (0..3).map(|_| normal(&mut random).powi(2)).sum::<f64>() / 3.0;
        row.displacement = row.displacement.map(|d| d + 8e-6 * normal(&mut random) / square.sqrt());
    }
    let found = traced(&campaign);
    assert!(names(&found).is_empty(), "{:?}", names(&found));
    assert_eq!(found.verdict, Verdict::Adequate, "{}", found.why);
}

/// Nor is anything adequate that has readings which are far off beside noise without tails.
#[test]
fn outliers_are_beyond_the_tails() {
    let mut campaign = simulated(LOADS, None);
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
    for k in [20, 77, 140] {
        data.rows[k].displacement[k % 3] += 1e-3;
    }
    let case = Case::new(&campaign, &campaign.robot);
    let mut engine = case.engine(&campaign.robot);
    engine.run_from_alone(&|_| ()).expect("it can be fitted");
    let noise = &engine.noise;
    assert_eq!(noise.apart.beyond, [20, 77, 140], "{:?} {:?}", noise.apart, noise.weights);
    let found = traced(&campaign);
    assert_eq!(names(&found), ["outliers@rig".to_string()], "{:?}", found.suspected);
    assert_eq!(found.verdict, Verdict::Partial, "{}", found.why);
}

/// Elsewhere the other numbers of the table say it: of this arm only axes 2 and 3 are parallel.
#[test]
fn an_angle_between_axes_is_fitted_where_they_are_parallel() {
    let campaign = simulated(POSITIONS, None);
    let case = Case::new(&campaign, &campaign.robot);
    let layout = case.engine(&campaign.robot).layout();
    let joint = |k: usize| match layout.parameters[k].term {
        Term::Table(joint, BETA) => Some(joint),
        _ => None,
    };
    assert_eq!(layout.always().filter_map(joint).collect::<Vec<_>>(), [2]);
}

/// A single dial gauge along a direction of the base frame.
fn gauged(mut campaign: Campaign, along: [f64; 3]) -> Campaign {
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
    for row in &mut data.rows {
        let read: f64 = along.iter().zip(row.displacement).map(|(a, d)| a * d).sum();
        row.displacement = along.map(|a| a * read);
    }
    data.directions = std::vec![along];
    campaign
}

#[test]
fn a_dial_gauge_alone_shows_what_the_arm_lacks() {
    let noise = 2_f64.sqrt() * 8e-6;
    for along in [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8]] {
        let found = traced(&gauged(simulated(LOADS, Some(8e-6)), along));
        assert_eq!(found.verdict, Verdict::Adequate, "{} {:?}", found.why, found.noise);
        // Sixty unloaded readings and 180 loaded ones scatter by some 7 %.
        assert!((found.after.rms / noise - 1.0).abs() < 0.15, "{}", found.after.rms);

        let found = traced(&gauged(simulated(&format!("{LOADS}{TILT}"), Some(8e-6)), along));
        assert_eq!(names(&found), ["transverse_compliance@joint 3"], "{:?}", found.suspected);
        assert!(
            found.identified.rms > 2.0 * noise && found.after.rms < 1.1 * noise,
            "{:?} {:?}",
            found.identified,
            found.after
        );
        assert_eq!(found.components, 1);
    }
}
