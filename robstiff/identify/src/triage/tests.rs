//! Each violation is found.

use std::collections::BTreeMap;
use std::string::String;
use std::vec;
use std::vec::Vec;

use nalgebra::{Rotation3, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::campaign::made::{Plan, campaign};
use crate::campaign::{ClampedRow, Data, Observation};
use crate::model::Arm;
use crate::observe::Observation as _;
use crate::observe::displacement::Displacement;
use crate::probability::normal;
use robstiff::Effect;
use robstiff_robots::samples::five_axis;

/// Ramps both ways in visits of their own, with a look at the unloaded arm.
pub(super) fn plan(seed: u64) -> Plan {
    Plan { visits: 4, ramp: vec![0.35, 0.7, 1.0, 0.7, 0.35, 0.0], there_and_back: true, poses: 24, ..Plan::new(seed) }
}

fn force(row: &Observation) -> Vector3<f64> {
    Vector3::from_column_slice(&row.wrench[..3])
}

pub(super) fn push(row: &mut Observation, by: Vector3<f64>) {
    (0..3).for_each(|k| row.displacement[k] += by[k]);
}

fn names(triage: &Triage) -> Vec<&'static str> {
    triage.violated().map(|(check, _)| check.name).collect()
}

pub(super) fn finding<'t>(triage: &'t Triage, name: &str) -> &'t Finding {
    triage.asked().find(|(check, _)| check.name == name).expect("asked").1
}

fn violates(name: &str, campaign: &Campaign) -> Finding {
    let triage = triage(campaign);
    let found = finding(&triage, name);
    assert!(found.violated, "{name}: {found:?}, but {:?}", names(&triage));
    found.clone()
}

#[test]
fn gears_that_harden_are_not_proportional() {
    let found = violates(
        "proportionality",
        &plan(1).run_with(|_, row| {
            let less = force(row) * (-1.5e-10 * force(row).norm());
            push(row, less);
        }),
    );
    assert!(found.statistic < -1.0 && found.said.contains("hardens"), "{found:?}");
}

#[test]
fn lost_motion_is_not_proportional_and_is_common_to_a_visit() {
    let lost = plan(2).run_with(|_, row| {
        if let Some(along) = force(row).try_normalize(1.0) {
            push(row, along * 3e-5);
        }
    });
    violates("proportionality", &lost);
    assert!(names(&triage(&lost)).iter().all(|name| ["proportionality", "loop area"].contains(name)));
    // The unloaded arm at the end of a visit tells the offset from the reading.
    let ramps = Plan::new(2).run_with(|_, row| {
        let lost = force(row).normalize() * 3e-5;
        push(row, lost);
    });
    violates("offset", &ramps);
}

#[test]
fn what_does_not_turn_round_is_found() {
    let found = violates(
        "reversal",
        &plan(3).run_with(|_, row| {
            let sag = Vector3::z() * (-4e-8 * force(row).norm());
            push(row, sag);
        }),
    );
    assert!(found.said.contains("z of the base"), "{found:?}");
}

#[test]
fn a_turned_force_sensor_is_not_reciprocal() {
    let turned = Rotation3::from_scaled_axis(Vector3::new(0.02, -0.05, 0.09));
    let clean = plan(4);
    let found = violates(
        "reciprocity",
        &clean.run_with(|_, row| {
            let force = turned * force(row);
            row.wrench[..3].copy_from_slice(force.as_slice());
        }),
    );
    assert!((1.0..20.0).contains(&found.statistic), "{found:?}");
    // The sensor's own frame moves with the tool.
    let arm = Arm::of(&clean.robot);
    violates(
        "reciprocity",
        &clean.run_with(|_, row| {
            let tool = arm.stand(&row.q, &[]).tcp.turn;
            let force = tool * (turned * (tool.transpose() * force(row)));
            row.wrench[..3].copy_from_slice(force.as_slice());
        }),
    );
}

#[test]
fn a_wrong_sign_does_negative_work() {
    let found = violates(
        "energy",
        &plan(5).run_with(|i, row| {
            if (48..72).contains(&i) {
                row.displacement = row.displacement.map(|d| -d);
            }
        }),
    );
    assert!(found.statistic >= 2.0, "{found:?}");
}

#[test]
fn friction_makes_a_loop() {
    let found = violates(
        "loop area",
        &plan(6).run_with(|i, row| {
            if (3..5).contains(&(i % 6)) {
                let behind = force(row).normalize() * 1.5e-5;
                push(row, behind);
            }
        }),
    );
    assert!(found.statistic > 0.0 && found.said.contains("hysteresis"), "{found:?}");
}

/// A visit is one loop, wherever the rows of others come in between.
#[test]
fn a_loop_counts_once() {
    let mut campaign = plan(6).run_with(|i, row| {
        if (3..5).contains(&(i % 6)) {
            let behind = force(row).normalize() * (1e-6 * row.pose as f64);
            push(row, behind);
        }
    });
    let statistic = |campaign: &Campaign| finding(&triage(campaign), "loop area").statistic;
    let visit_by_visit = statistic(&campaign);
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("made of displacements") };
    let place = |row: &Observation| if row.pose.is_multiple_of(2) { (row.line - 2) % 6 } else { 0 };
    data.rows.sort_by_key(|row| (row.pose, place(row)));
    let load_by_load = statistic(&campaign);
    assert!((load_by_load / visit_by_visit - 1.0).abs() < 1e-6, "{load_by_load} and {visit_by_visit}");
}

#[test]
fn what_is_left_without_a_load_is_found() {
    let found = violates(
        "return to zero",
        &plan(7).run_with(|i, row| {
            if i % 6 == 5 {
                row.displacement[1] += 1e-5;
            }
        }),
    );
    assert!((found.statistic / 10.0 - 1.0).abs() < 0.5 && found.said.contains("y of the base"), "{found:?}");
}

#[test]
fn drift_and_expansion_are_found() {
    let drift = plan(8).run_with(|i, row| row.displacement[0] += 3e-6 * (i % 6) as f64);
    violates("time", &drift);
    violates("order", &drift);
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut first = 20.0;
    let warm = plan(9).run_with(|i, row| {
        // The unloaded reading is as warm as the first row.
        let temperature = 20.0 + normal(&mut random);
        first = if i % 6 == 0 { temperature } else { first };
        row.temperature = Some(temperature);
        row.displacement[2] += 5e-6 * (temperature - first);
    });
    violates("temperature", &warm);
}

/// Student's noise of three degrees of freedom is beyond the level with all checks counted,
/// normal noise is not.
#[test]
fn heavy_tails_are_found() {
    let tails = |seed: u64, is_heavy: bool| {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut noise = || {
            let spread: f64 = (0..3).map(|_| normal(&mut random).powi(2)).sum::<f64>() / 3.0;
            1e-5 * normal(&mut random) / if is_heavy { spread.sqrt() } else { 1.0 }
        };
        let campaign = Plan { noise: [0.0; 3], ..plan(30 + seed) }.run_with(|_, row| {
            row.displacement = row.displacement.map(|reading| reading + noise());
        });
        finding(&triage(&campaign), "tails").violated
    };
    assert!((0..4).all(|seed| tails(seed, true)));
    assert!((0..8).all(|seed| !tails(seed, false)));
}

#[test]
fn noise_that_is_declared_too_small_is_found() {
    let mut campaign = plan(10).run();
    campaign.noise.displacement = Some(8e-6);
    violates("replicates", &campaign);
    campaign.noise.displacement = Some(1e-5);
    assert_eq!(names(&triage(&campaign)), Vec::<&str>::new());
}

/// What rounding to the steps of a gauge adds is not missing in what was declared.
#[test]
fn noise_is_not_declared_too_small_for_steps() {
    for seed in 10..14 {
        let mut campaign = Plan { noise: [3e-6; 3], ..plan(seed) }.run();
        let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
        for row in &mut data.rows {
            row.displacement = row.displacement.map(|reading| (reading / 1e-5).round() * 1e-5);
        }
        campaign.noise.displacement = Some(3e-6);
        assert_eq!(names(&triage(&campaign)), Vec::<&str>::new(), "seed {seed}");
    }
}

#[test]
fn noise_that_is_declared_far_too_large_is_found() {
    let mut campaign = plan(10).run();
    campaign.noise.displacement = Some(1e-3);
    violates("replicates", &campaign);
    campaign.noise.displacement = Some(2e-5);
    assert_eq!(names(&triage(&campaign)), Vec::<&str>::new());
}

/// Nothing but the description is wrong: forces in kilograms, stiffness per arcmin, or
/// compliances for stiffnesses.
#[test]
fn readings_are_not_blamed_for_a_description_that_is_too_soft() {
    for factor in [9.81, 3438.0, 1e6, 1e12] {
        for plan in [plan(15), Plan { visits: 1, ramp: vec![0.5, 1.0], ..Plan::new(3) }] {
            let mut campaign = plan.run();
            let parts = campaign.robot.joints.iter_mut().flat_map(|joint| &mut joint.compliance);
            parts.for_each(|part| part.value *= factor);
            let triage = triage(&campaign);
            assert_eq!(names(&triage), Vec::<&str>::new(), "{factor:e}");
            for (check, found) in triage.asked() {
                assert!(
                    found.statistic.is_finite() && !found.said.contains("NaN"),
                    "{factor:e} {}: {found:?}",
                    check.name
                );
            }
        }
    }
}

#[test]
fn wild_readings_are_listed() {
    let triage = triage(&plan(11).run_with(|i, row| {
        if i == 100 {
            row.displacement[0] += 2e-4;
        }
    }));
    assert_eq!(names(&triage), ["outliers"]);
    assert_eq!(triage.outliers.len(), 1);
    assert!(triage.outliers[0].said.starts_with("visit 16, line 102: off by ("), "{:?}", triage.outliers);
}

/// Encoders on the output side see all of a gear and nothing of a bearing.
#[test]
fn encoders_tell_gears_from_bearings() {
    let with_encoders = |hidden: Vec<Effect>, motors: bool| {
        let plan = Plan { hidden, ..plan(12) };
        let exact = plan.run();
        let data = crate::campaign::made::displacements(&exact);
        let observation = Displacement::new(&five_axis(), data);
        let torques = observation.loaded(observation.world(), &[], &[]).torques;
        plan.run_with(|i, row| {
            let turned = |joint: usize| five_axis().joints[joint].compliance() * torques[joint][i];
            let angles = (0..5).map(|joint| row.q[joint] + turned(joint) + 1e-4).collect();
            *if motors { &mut row.motors } else { &mut row.encoders } = Some(angles);
        })
    };
    let all = triage(&with_encoders(Vec::new(), false));
    let found = finding(&all, "encoders");
    assert!(!found.violated && found.statistic.abs() < 1.0, "{found:?}");
    let tilt = vec![Effect::TransverseCompliance { joint: 3, value: 1e-6 }];
    let found = violates("encoders", &with_encoders(tilt, false));
    assert!((5.0..60.0).contains(&found.statistic), "{found:?}");
    let found = violates("encoders", &with_encoders(Vec::new(), true));
    assert!((found.statistic / 100.0 - 1.0).abs() < 0.02 && found.said.contains("controller"), "{found:?}");
}

/// What single loads, one a pose, cannot be asked, and what would let them.
#[test]
fn what_cannot_be_asked_says_what_is_needed() {
    let triage = triage(&Plan { visits: 1, ramp: vec![1.0], ..Plan::new(13) }.run());
    let asked: Vec<&str> = triage.asked().map(|(check, _)| check.name).collect();
    assert_eq!(asked, ["energy"]);
    let needs: BTreeMap<&str, &String> = triage
        .checks
        .iter()
        .filter_map(|check| match &check.answer {
            Answer::NotAsked(needs) => Some((check.name, needs)),
            Answer::Asked(_) => None,
        })
        .collect();
    assert!(needs["reversal"].contains("the other way") && needs["reciprocity"].contains("different directions"));
    assert_eq!(needs.len(), CHECKS.len() - 1);
    let lever = Plan { at: [[0.0; 3], [0.1, 0.0, 0.2]], ..plan(14) };
    let of_lever = super::triage(&lever.run());
    assert!(of_lever.asked().all(|(check, _)| !["energy", "reciprocity"].contains(&check.name)));
    let with_rotations = super::triage(&Plan { rotation_noise: Some([2e-5; 3]), ..lever }.run());
    assert!(with_rotations.asked().any(|(check, _)| check.name == "reciprocity"));
    assert_eq!(names(&with_rotations), Vec::<&str>::new());
}

#[test]
fn clamped_axes_are_asked_too() {
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let mut rows = |disturb: &dyn Fn(usize, f64) -> f64| -> Vec<ClampedRow> {
        let torques = [100.0, -200.0, 300.0, 400.0, -100.0, 200.0, -300.0, -400.0];
        let places = (1..=5).flat_map(|axis| torques.into_iter().enumerate().map(move |(k, torque)| (axis, k, torque)));
        places
            .map(|(axis, k, torque)| {
                let exact = 3e-7 * torque + if axis == 2 { disturb(k, torque) } else { 0.0 };
                ClampedRow { line: 2, axis, torque, deflection: exact + 1e-6 * normal(&mut random) }
            })
            .collect()
    };
    let mut of = |disturb: &dyn Fn(usize, f64) -> f64| triage(&campaign(five_axis(), Data::Clamped(rows(disturb))));
    assert_eq!(names(&of(&|_, _| 0.0)), Vec::<&str>::new());
    assert_eq!(names(&of(&|_, torque| -1e-9 * torque * torque.abs() / 4.0)), ["proportionality"]);
    assert_eq!(names(&of(&|_, torque| 1e-7 * torque.abs())), ["reversal"]);
    assert_eq!(names(&of(&|_, torque| -6e-7 * torque)), ["energy"]);
    assert_eq!(names(&of(&|k, _| 1e-5 * k as f64)), ["order"]);
}

/// A decomposition of what is divided by no torque would not end.
#[test]
fn an_axis_without_a_torque_is_not_asked() {
    let rows = (0..8).map(|k| ClampedRow { line: 2 + k, axis: 1, torque: 0.0, deflection: 1e-6 * k as f64 }).collect();
    assert_eq!(triage(&campaign(five_axis(), Data::Clamped(rows))).asked().count(), 0);
}
