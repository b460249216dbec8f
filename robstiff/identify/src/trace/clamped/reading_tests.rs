//! What readings of clamped axes are off by, all of an axis or some.

use std::string::{String, ToString};
use std::vec::Vec;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::axes::Axes;
use super::bench::Bench;
use super::slips::as_good_as_slip;
use super::tests::{NOISE, both_ways, measured, names, ramp, traced};
use crate::campaign::{Campaign, ClampedRow, Data};
use crate::identify::clamped::slopes;
use crate::identify::identify;
use crate::probability::normal;
use crate::trace::Verdict;
use crate::trace::model::Named;
use robstiff_robots::samples::five_axis;

fn rows_of(campaign: &mut Campaign) -> &mut Vec<ClampedRow> {
    let Data::Clamped(rows) = &mut campaign.data else { unreachable!("made of clamped axes") };
    rows
}

/// The rows of an axis share it: it is no slip in their midst, no bias of the torque and no
/// matter of single rows.
#[test]
fn an_unloaded_reading_that_is_off_shifts_all_rows_of_its_axis() {
    for seed in 0..4 {
        let mut campaign = measured(&five_axis(), &both_ways(), 800 + seed, |_, _| 0.0);
        let first = 2 * both_ways().len() + 2;
        let of_axis = rows_of(&mut campaign).iter_mut().filter(|row| row.axis == 3);
        of_axis.for_each(|row| row.deflection += 30.0 * NOISE);
        let trace = traced(&campaign);
        assert_eq!((trace.verdict, names(&trace)), (Verdict::Explained, ["base_slip@base".into()].into()), "{seed}");
        let slip = &trace.effects[0].effect;
        assert_eq!((slip.value("axis"), slip.value("line")), (3.0, first as f64), "{seed}");
        assert!((slip.value("shift") / (30.0 * NOISE) - 1.0).abs() < 0.1, "{seed}: {}", slip.value("shift"));
        assert!(trace.after.rms < 2.0 * NOISE, "{seed}: {}", trace.after.rms);
    }
}

/// Of few rows an axis those of the largest torques may be wild, or its gear lost motion.
#[test]
fn wild_rows_list_the_curve_that_they_may_be() {
    let torques = [500.0, 1000.0, 500.0, 0.0, -500.0, -1000.0, -500.0, 0.0];
    for seed in 0..4 {
        let lost = |axis, torque: f64| if axis == 2 { 1e-4 * torque / torque.hypot(15.0) } else { 0.0 };
        let trace = traced(&measured(&five_axis(), &torques, 820 + seed, lost));
        let lost = String::from("lost_motion@joint 2");
        let told =
            |named: &crate::trace::NamedEffect| named.effect.to_string() == lost || named.same_as.contains(&lost);
        assert!(trace.effects.iter().any(told), "{seed}: {:?}", names(&trace));
    }
}

/// What most of them have in common is no accident of single rows.
#[test]
fn rows_of_another_axis_are_not_explained() {
    for seed in 0..4 {
        let mut campaign = measured(&five_axis(), &both_ways(), 830 + seed, |_, _| 0.0);
        rows_of(&mut campaign).iter_mut().filter(|row| row.axis == 5).for_each(|row| row.axis = 4);
        let verdict = traced(&campaign).verdict;
        assert!([Verdict::Partial, Verdict::Unexplained].contains(&verdict), "{seed}: {verdict}");
    }
}

/// A compliance that grows in the course of the rows is none of the catalogue.
#[test]
fn an_axis_that_grows_softer_is_structure() {
    for seed in 0..4 {
        let count = core::cell::Cell::new(0.0);
        let softer = |axis: usize, torque: f64| {
            if axis != 2 {
                return 0.0;
            }
            count.set(count.get() + 1.0);
            2e-3 * count.get() * five_axis().joints[1].compliance() * torque
        };
        let verdict = traced(&measured(&five_axis(), &both_ways(), 840 + seed, softer)).verdict;
        assert!([Verdict::Partial, Verdict::Unexplained].contains(&verdict), "{seed}: {verdict}");
    }
}

/// Rows of one torque are rounded alike: that is a curve of the torque, but no gear's.
#[test]
fn rounded_readings_have_no_structure() {
    for seed in 0..6 {
        let mut campaign = measured(&five_axis(), &both_ways(), 850 + seed, |_, _| 0.0);
        let step = 10.0 * NOISE;
        rows_of(&mut campaign).iter_mut().for_each(|row| row.deflection = (row.deflection / step).round() * step);
        let trace = traced(&campaign);
        assert_eq!((trace.verdict, names(&trace)), (Verdict::Adequate, Vec::new()), "{seed}: {}", trace.why);
    }
}

/// Rows of large torques are then the furthest off, and none of them is wild.
#[test]
fn noise_that_grows_with_the_torque_makes_no_row_wild() {
    for seed in 0..12 {
        let mut random = ChaCha8Rng::seed_from_u64(870 + seed);
        let mut campaign = measured(&five_axis(), &both_ways(), 870 + seed, |_, _| 0.0);
        rows_of(&mut campaign).iter_mut().for_each(|row| row.deflection *= 1.0 + 0.02 * normal(&mut random));
        let names = names(&traced(&campaign));
        assert!(!names.contains(&"outliers@rig".to_string()), "{seed}: {names:?}");
    }
}

/// Two or three of them are in proportion to compliances by chance: that is no bias of the torque.
#[test]
fn unloaded_readings_that_are_all_off_are_no_bias() {
    for seed in 0..6 {
        let mut random = ChaCha8Rng::seed_from_u64(860 + seed);
        let mut campaign = measured(&five_axis(), &both_ways(), 860 + seed, |_, _| 0.0);
        for axis in 1..=5 {
            let off = 15.0 * NOISE * normal(&mut random);
            rows_of(&mut campaign).iter_mut().filter(|row| row.axis == axis).for_each(|row| row.deflection += off);
        }
        let trace = traced(&campaign);
        let names = names(&trace);
        assert!(names.iter().all(|name| name == "base_slip@base"), "{seed}: {} {names:?}", trace.verdict);
        // One axis's slip in the place of another's has the same names.
        assert!(trace.rivals.iter().all(|rival| rival.names != names), "{seed}");
    }
}

/// The weight of a play is no less than zero: an axis that hardens at a kink, with a slip beside
/// it, does not lag.
#[test]
fn what_hardens_beside_a_slip_is_no_dead_zone() {
    let hard = |axis, torque: f64| if axis == 2 { -1.5e-7 * (torque - 400.0_f64).max(0.0) } else { 0.0 };
    let soft = |axis, torque| -hard(axis, torque);
    assert!(may_lag_with_a_slip(&soft) && !may_lag_with_a_slip(&hard));
}

/// Whether hysteresis of axis 2 is as good as a curve of its gear with a slip.
fn may_lag_with_a_slip(more: &dyn Fn(usize, f64) -> f64) -> bool {
    let campaign = measured(&five_axis(), &ramp(14), 850, more);
    let Data::Clamped(rows) = &campaign.data else { unreachable!("made of clamped axes") };
    let identified = slopes(&campaign, rows, &[]).expect("every axis is loaded");
    let bench = Bench::new(Axes::new(&campaign.robot, rows, &identified), None);
    let forms = |name: &str| -> Vec<Named> {
        let of_name = (0..bench.candidates.len()).filter(|&candidate| bench.candidates[candidate].name() == name);
        let forms = |candidate: usize| {
            (0..bench.candidates[candidate].variants.len()).map(move |variant| Named { candidate, variant })
        };
        of_name.flat_map(forms).collect()
    };
    let of_axis = |one: &&Named| bench.form(**one).told.iter().any(|told| told.name == "axis" && told.value == 2.0);
    let slips = forms("base_slip@base");
    let pairs = slips.iter().filter(of_axis).flat_map(|&slip| {
        forms("stiffness_nonlinearity@joint 2")
            .into_iter()
            .map(move |curve| if slip < curve { [slip, curve] } else { [curve, slip] })
    });
    let best = pairs.filter_map(|named| bench.fit(&named)).min_by(|a, b| a.bic.total_cmp(&b.bic)).expect("possible");
    let slip = best.named.iter().position(|one| slips.contains(one)).expect("it is one of the two");
    as_good_as_slip(&bench, &best, slip).contains(&"hysteresis@joint 2".to_string())
}

/// Of axes that slide numbers are in N and m; a drift is bounded over all rows of an axis.
#[test]
fn numbers_of_axes_that_slide_are_in_their_units() {
    let mut robot = five_axis();
    robot.joints.iter_mut().for_each(|joint| joint.kind = robstiff::JointKind::Prismatic);
    let count = both_ways().len();
    let row = core::cell::Cell::new(0);
    let drifts = |_, _: f64| {
        row.set(row.get() % count + 1);
        4e-6 * f64::from(u32::try_from(row.get()).expect("few rows"))
    };
    let biased = |axis: usize, _: f64| 60.0 * robot.joints[axis - 1].compliance();
    let told = |more: &dyn Fn(usize, f64) -> f64, [name, of, unit]: [&str; 3], truth: f64| {
        let trace = traced(&measured(&robot, &both_ways(), 860, more));
        assert_eq!(names(&trace), [name], "{}", trace.why);
        let number = trace.effects[0].effect.parameters.iter().find(|number| number.name == of).expect("its own");
        assert_eq!(number.unit, unit);
        assert!((number.value / truth - 1.0).abs() < 0.1, "{number:?}");
    };
    told(&drifts, ["thermal_drift@rig", "rate", "m/row"], 4e-6);
    told(&biased, ["load_cell_bias@rig", "torque", "N"], 60.0);
}

/// Nothing is told of axes whose torques are in another unit than identification takes them for.
#[test]
fn torques_in_another_unit_tell_nothing() {
    let mut campaign = measured(&five_axis(), &ramp(14), 1, |_, _| 0.0);
    rows_of(&mut campaign).iter_mut().for_each(|row| row.torque *= 1e3);
    let why = identify(&campaign).expect_err("it refuses another unit").to_string();
    let found = traced(&campaign);
    assert_eq!((names(&found), found.verdict, found.why.as_str()), (Vec::new(), Verdict::Insufficient, why.as_str()));
    assert!(why.contains("a torque in Nm taken for kNm") && found.description == campaign.robot, "{why}");
}
