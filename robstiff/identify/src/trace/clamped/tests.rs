//! What single rows of clamped axes are taken for. Rows are made from the laws
//! themselves: what is tested is the search.

use std::string::{String, ToString};
use std::vec::Vec;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use robstiff_robots::Description;

use crate::campaign::made::campaign;
use crate::campaign::{Campaign, ClampedRow, Data, Noise};
use crate::identify::uncertainty::WITHIN;
use crate::probability::normal;
use crate::trace::{Options, Trace, Verdict, trace};
use robstiff_robots::samples::five_axis;

/// One sigma of a reading (rad).
pub(super) const NOISE: f64 = 1e-6;

/// The same torques (Nm) on every axis; `more` is what an axis turns by besides its
/// compliance (rad).
pub(super) fn measured(robot: &Description, torques: &[f64], seed: u64, more: impl Fn(usize, f64) -> f64) -> Campaign {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut rows = Vec::new();
    for (joint, axis) in robot.joints.iter().zip(1..) {
        let unloaded = NOISE * normal(&mut random);
        for &torque in torques {
            let exact = joint.compliance() * torque + more(axis, torque);
            let deflection = exact + NOISE * normal(&mut random) - unloaded;
            rows.push(ClampedRow { line: rows.len() + 2, axis, torque, deflection });
        }
    }
    let noise = Noise { displacement: None, rotation: Some(NOISE) };
    Campaign { noise, ..campaign(robot.clone(), Data::Clamped(rows)) }
}

pub(super) fn traced(campaign: &Campaign) -> Trace {
    let options = Options { draws: 499, ..Options::default() };
    trace(campaign, &options, &|_| {}).expect("every axis is loaded")
}

pub(super) fn names(trace: &Trace) -> Vec<String> {
    trace.effects.iter().map(|named| named.effect.to_string()).collect()
}

/// What is left of the rows but those of some lines, root mean square (rad).
fn rms_without(trace: &Trace, lines: &[usize]) -> f64 {
    let rest: Vec<f64> =
        trace.residuals.iter().filter(|row| !lines.contains(&row.line)).map(|row| row.after[0]).collect();
    (rest.iter().map(|angle| angle * angle).sum::<f64>() / rest.len() as f64).sqrt()
}

pub(super) fn ramp(count: usize) -> Vec<f64> {
    (1..=count).map(|k| 1000.0 * k as f64 / count as f64).collect()
}

/// The play operator of a radius after a torque.
pub(super) fn play(torque: f64, radius: f64, before: f64) -> f64 {
    before.min(torque + radius).max(torque - radius)
}

/// What a program rounds is no structure, and axes that never move say nothing.
#[test]
fn readings_without_noise_leave_nothing_to_find() {
    let mut campaign = measured(&five_axis(), &ramp(14), 0, |_, _| 0.0);
    let told = |campaign: &Campaign| {
        let trace = traced(campaign);
        (trace.verdict, names(&trace))
    };
    let exact = |campaign: &mut Campaign, share: f64| {
        let Data::Clamped(rows) = &mut campaign.data else { unreachable!("made of clamped axes") };
        for row in rows {
            row.deflection = share * campaign.robot.joints[row.axis - 1].compliance() * row.torque;
        }
    };
    exact(&mut campaign, 1.1);
    assert_eq!(told(&campaign), (Verdict::Adequate, Vec::new()));
    exact(&mut campaign, 0.0);
    assert_eq!(told(&campaign), (Verdict::Insufficient, Vec::new()));
}

#[test]
fn a_curve_of_one_gear_is_no_wild_reading() {
    for seed in 0..3 {
        let lost = |axis, torque: f64| if axis == 2 { 0.5e-4 * torque / torque.hypot(20.0) } else { 0.0 };
        let trace = traced(&measured(&five_axis(), &ramp(14), seed, lost));
        let told = (trace.verdict, names(&trace));
        assert_eq!(told, (Verdict::Explained, ["lost_motion@joint 2".into()].into()), "seed {seed}");
    }
}

/// No gear of the catalogue turns by a wave of its torque: it is seen, and not taken for noise.
#[test]
fn a_wave_of_the_torque_is_structure() {
    let torques: Vec<f64> = ramp(14).into_iter().chain(ramp(7).into_iter().map(|torque| -torque)).collect();
    for seed in 0..4 {
        let wave = |axis, torque: f64| if axis == 2 { 2e-5 * (torque / 120.0).sin() } else { 0.0 };
        let trace = traced(&measured(&five_axis(), &torques, seed, wave));
        let told = (trace.verdict, names(&trace), trace.depends_on);
        assert_eq!(told, (Verdict::Unexplained, Vec::new(), ["torque of axis 2".to_string()].into()), "seed {seed}");
    }
}

/// Under loads that only rise a play operator is a dead zone: what softens may as well lag.
#[test]
fn what_softens_under_loads_that_only_rise_may_be_hysteresis() {
    for seed in 0..4 {
        let softer =
            |axis, torque: f64| if axis == 2 { 1e-7 * (torque - 300.0 * (torque / 300.0).tanh()) } else { 0.0 };
        let trace = traced(&measured(&five_axis(), &ramp(14), seed, softer));
        assert_eq!(names(&trace), ["stiffness_nonlinearity@joint 2"], "seed {seed}");
        assert!(trace.effects[0].same_as.contains(&"hysteresis@joint 2".to_string()), "{:?}", trace.effects[0].same_as);
    }
}

/// Two of eight rows of an axis do not hide each other.
#[test]
fn wild_readings_of_one_axis_are_told() {
    let mut campaign = measured(&five_axis(), &ramp(8), 7, |_, _| 0.0);
    let Data::Clamped(rows) = &mut campaign.data else { unreachable!("made of clamped axes") };
    rows[18].deflection += 3e-4;
    rows[21].deflection -= 2e-4;
    let trace = traced(&campaign);
    assert_eq!((trace.verdict, names(&trace)), (Verdict::Explained, ["outliers@rig".into()].into()));
    assert_eq!(trace.effects[0].lines, [20, 23]);
    // So far off that the tail underflows.
    assert!(trace.effects[0].p_value > 0.0);
    // What is told of before is over all rows, so is what is left of each.
    assert_eq!((trace.residuals.len(), trace.components), (40, 1));
    assert!((trace.residuals[18].after[0] - 3e-4).abs() < 5.0 * NOISE, "{:?}", trace.residuals[18]);
    let rest = rms_without(&trace, &[20, 23]);
    assert!(trace.identified.rms > 4e-5 && rest < 2.0 * NOISE, "{rest}, {:?}", [trace.identified, trace.after]);
}

/// A load was put on whatever was read: what a gear remembers of it is in all readings
/// after it.
#[test]
fn a_wild_reading_keeps_its_load() {
    let ramp: Vec<f64> =
        [200.0, 400.0, 600.0, 1000.0, 600.0, 400.0, 200.0, -200.0, -600.0, -1000.0, -600.0, -200.0].into();
    for seed in 0..4 {
        let state = core::cell::Cell::new(0.0);
        let lags = |axis: usize, torque: f64| {
            if axis != 2 {
                return 0.0;
            }
            state.set(play(torque, 250.0, state.get()));
            1e-7 * state.get()
        };
        let mut campaign = measured(&five_axis(), &ramp, 40 + seed, lags);
        let Data::Clamped(rows) = &mut campaign.data else { unreachable!("made of clamped axes") };
        rows[15].deflection += 1e-3;
        let trace = traced(&campaign);
        assert_eq!(names(&trace), ["hysteresis@joint 2", "outliers@rig"], "seed {seed}");
        assert_eq!(trace.effects[1].lines, [17]);
        assert!((trace.estimates[1].value / five_axis().joints[1].compliance() - 1.0).abs() < 0.05);
        let rest = rms_without(&trace, &[17]);
        assert!(rest < 2.0 * NOISE && trace.after.rms > 1e-5, "{rest}, {:?}", trace.after);
    }
}

/// The description is as declared then, and so is what is said of it.
#[test]
fn where_the_data_cannot_tell_the_error_stays_as_declared() {
    let mut campaign = measured(&five_axis(), &ramp(2), 3, |_, _| 0.0);
    let compliance = &mut campaign.robot.joints[0].compliance[0].value;
    *compliance *= 2.0;
    let off = 0.5 * *compliance;
    let trace = traced(&campaign);
    assert_eq!((trace.verdict, &trace.description), (Verdict::Insufficient, &campaign.robot));
    assert_eq!(trace.after, trace.declared);
    assert!((trace.residuals[1].after[0] / (-1000.0 * off) - 1.0).abs() < 0.1, "{:?}", trace.residuals[1]);
    assert_eq!(
        trace.pose_errors[0].after,
        (trace.residuals[0].after[0].powi(2) / 2.0 + trace.residuals[1].after[0].powi(2) / 2.0).sqrt()
    );
}

/// With its two wild rows the gap of axis 1 would be negative: the model stands
/// without them.
#[test]
fn wild_readings_stay_out_where_physics_needs_that() {
    let read: [[f64; 10]; 3] = [
        [-96.0, 156.8, 209.8, 62.7, 313.4, 315.2, 261.1, 208.8, 155.6, 102.2],
        [31.4, 61.2, 91.4, 123.3, 151.0, 151.5, 122.4, 92.1, 62.9, 29.2],
        [51.3, 104.5, 155.4, 204.7, 254.8, 257.0, 207.2, 155.0, 103.5, 51.5],
    ];
    let torques = [200.0, 400.0, 600.0, 800.0, 1000.0, 1000.0, 800.0, 600.0, 400.0, 200.0];
    let of_axis = |(axis, urad): (usize, &[f64; 10])| -> Vec<ClampedRow> {
        let rows = torques.iter().zip(urad).zip(10 * axis + 2..);
        rows.map(|((&torque, urad), line)| ClampedRow { line, axis: axis + 1, torque, deflection: 1e-6 * urad })
            .collect()
    };
    let rows = read.iter().enumerate().flat_map(of_axis).collect();
    let trace = traced(&campaign(five_axis(), Data::Clamped(rows)));
    assert_eq!(names(&trace), ["lost_motion@joint 1", "outliers@rig"]);
    assert_eq!(trace.effects[1].lines, [2, 5]);
}

/// Few rows tell little of the noise, and intervals know that.
#[test]
fn intervals_hold_where_axes_have_few_rows() {
    let (robot, campaigns) = (five_axis(), 60);
    for count in [3, 4] {
        let mut within = 0;
        for seed in 0..campaigns {
            let trace = traced(&measured(&robot, &ramp(count), 100 + seed, |_, _| 0.0));
            let holds = trace.estimates.iter().zip(&robot.joints).filter(|(estimate, joint)| {
                estimate.std.is_some_and(|std| (estimate.value - joint.compliance()).abs() <= WITHIN * std)
            });
            within += holds.count();
        }
        // Of 300 at 95 % fewer than 273 have a probability of 0.2 %.
        assert!(within >= 273, "{within} of 300 with {count} rows");
    }
}

/// What a row alone says is no curve of its gear: beyond twenty standard deviations it
/// is told, and where another name is told, the row is beside it.
#[test]
fn one_wild_reading_is_no_effect() {
    for seed in 0..20 {
        let mut campaign = measured(&five_axis(), &ramp(4), 300 + seed, |_, _| 0.0);
        let Data::Clamped(rows) = &mut campaign.data else { unreachable!("made of clamped axes") };
        rows[7 * seed as usize % 20].deflection += 40.0 * NOISE;
        let trace = traced(&campaign);
        for named in &trace.effects {
            let told = named.effect.to_string();
            assert!(told == "outliers@rig" || named.same_as.contains(&"outliers@rig".into()), "seed {seed}: {told}");
        }
    }
}

/// Of 100 campaigns without a wild row more than 2 name one with a probability of
/// 0.02 %, were one in 1000 to do so.
#[test]
fn noise_is_no_wild_reading() {
    let wild = |seed: &u64| {
        let trace = traced(&measured(&five_axis(), &ramp(3 + *seed as usize % 4), 500 + seed, |_, _| 0.0));
        names(&trace).contains(&"outliers@rig".into())
    };
    let count = (0..100).filter(wild).count();
    assert!(count <= 2, "{count} of 100");
}

/// Descriptions have no hardening of an axis that slides: what is written is fitted without.
#[test]
fn what_is_written_does_what_is_told() {
    let mut robot = five_axis();
    robot.joints.iter_mut().for_each(|joint| joint.kind = robstiff::JointKind::Prismatic);
    let hard = |axis, force: f64| if axis == 2 { 2e-7 * force / (force / 300.0).hypot(1.0) } else { 0.0 };
    let campaign = measured(&robot, &ramp(14), 1, hard);
    let trace = traced(&campaign);
    assert_eq!(names(&trace), ["stiffness_nonlinearity@joint 2"]);
    assert!(trace.description.effects.is_empty());
    let Data::Clamped(rows) = &campaign.data else { unreachable!("made of clamped axes") };
    let left = |row: &ClampedRow| row.deflection - trace.description.joints[row.axis - 1].compliance() * row.torque;
    let rms = (rows.iter().map(|row| left(row).powi(2)).sum::<f64>() / rows.len() as f64).sqrt();
    assert!((rms / trace.after.rms - 1.0).abs() < 1e-6, "{rms} and {}", trace.after.rms);
}

/// Radians and metres have no noise in common.
#[test]
fn axes_that_turn_and_axes_that_slide_are_traced_apart() {
    let mut robot = five_axis();
    robot.joints[1].kind = robstiff::JointKind::Prismatic;
    let campaign = measured(&robot, &ramp(8), 3, |_, _| 0.0);
    let told = trace(&campaign, &Options::default(), &|_| {}).map(|_| ()).expect_err("a rail among gears");
    assert!(matches!(told, crate::identify::Error::OtherCampaign(_)), "{told:?}");
    assert!(crate::identify::identify(&campaign).is_ok());
}

/// The torques of a loop up, down and to the other side.
pub(super) fn both_ways() -> Vec<f64> {
    let up = ramp(7);
    let loop_of =
        |sign: f64| -> Vec<f64> { up.iter().chain(up.iter().rev().skip(1)).map(|torque| sign * torque).collect() };
    loop_of(1.0).into_iter().chain(loop_of(-1.0)).collect()
}

/// Nearly half of an axis shifted is no matter of single rows, nor of its gear.
#[test]
fn a_slip_is_told_with_its_row() {
    let torques = both_ways();
    for (seed, from) in [(0, 9), (1, 16), (2, 22), (3, torques.len() - 2)] {
        let mut campaign = measured(&five_axis(), &torques, 700 + seed, |_, _| 0.0);
        let Data::Clamped(rows) = &mut campaign.data else { unreachable!("made of clamped axes") };
        let of_axis = rows.iter_mut().filter(|row| row.axis == 3);
        of_axis.skip(from).for_each(|row| row.deflection += 15.0 * NOISE);
        let trace = traced(&campaign);
        assert_eq!((trace.verdict, names(&trace)), (Verdict::Explained, ["base_slip@base".into()].into()), "{seed}");
        let slip = &trace.effects[0].effect;
        let line = 2 * torques.len() + from + 2;
        assert_eq!((slip.value("axis"), slip.value("line")), (3.0, line as f64), "{seed}");
        assert!((slip.value("shift") / (15.0 * NOISE) - 1.0).abs() < 0.2, "{seed}: {}", slip.value("shift"));
        assert!(slip.is_of_rig() && trace.description.effects.is_empty());
    }
}

/// Each axis has an unloaded reading of its own: each may slip.
#[test]
fn slips_of_two_axes_are_two() {
    let mut campaign = measured(&five_axis(), &both_ways(), 710, |_, _| 0.0);
    let Data::Clamped(rows) = &mut campaign.data else { unreachable!("made of clamped axes") };
    for (axis, from, off) in [(2, 10, 20.0), (5, 17, -25.0)] {
        let of_axis = rows.iter_mut().filter(|row| row.axis == axis);
        of_axis.skip(from).for_each(|row| row.deflection += off * NOISE);
    }
    let trace = traced(&campaign);
    assert_eq!(names(&trace), ["base_slip@base"; 2]);
    assert_eq!([0, 1].map(|k| trace.effects[k].effect.value("axis")), [5.0, 2.0]);
    assert!(trace.effects.iter().all(|named| !named.same_as.contains(&"base_slip@base".into())));
}

/// Each with the error that it and those before it leave.
#[test]
fn what_explains_most_is_told_first() {
    let curve = |knee: f64, torque: f64| torque / (torque / knee).hypot(1.0);
    let hard = |axis, torque| match axis {
        2 => 1e-7 * curve(300.0, torque),
        4 => 6e-7 * curve(300.0, torque),
        _ => 0.0,
    };
    let trace = traced(&measured(&five_axis(), &both_ways(), 730, hard));
    assert_eq!(names(&trace), ["stiffness_nonlinearity@joint 4", "stiffness_nonlinearity@joint 2"]);
    let [first, both] = [0, 1].map(|k| trace.effects[k].holdout_rms);
    assert!(first < 0.5 * trace.identified.holdout_rms && both < first, "{first} {both} {:?}", trace.identified);
}

/// After the last row of an axis none shows whether it has slipped.
#[test]
fn a_wild_last_row_may_be_a_slip() {
    for (row, may_be) in [(2, 0), (13, 1)] {
        let mut campaign = measured(&five_axis(), &ramp(14), 720, |_, _| 0.0);
        let Data::Clamped(rows) = &mut campaign.data else { unreachable!("made of clamped axes") };
        rows[14 + row].deflection += 60.0 * NOISE;
        let trace = traced(&campaign);
        assert_eq!(names(&trace), ["outliers@rig"]);
        assert_eq!(trace.effects[0].same_as.iter().filter(|name| *name == "base_slip@base").count(), may_be);
    }
}

/// A gear with two plays shifts where its loads turn: that is no slip beside one play.
#[test]
fn a_gear_that_lags_does_not_slip() {
    for seed in 0..4 {
        let states = core::cell::Cell::new([0.0; 2]);
        let lags = |axis: usize, torque: f64| {
            if axis != 2 {
                return 0.0;
            }
            let [near, far] = states.get();
            states.set([play(torque, 210.0, near), play(torque, 370.0, far)]);
            let [near, far] = states.get();
            0.6e-7 * near + 0.4e-7 * far
        };
        let trace = traced(&measured(&five_axis(), &both_ways(), 730 + seed, lags));
        assert_eq!(names(&trace), ["hysteresis@joint 2"], "seed {seed}");
    }
}

/// What acts besides the torque that is read loads the gear as well: its plays turn elsewhere,
/// which is no slip.
#[test]
fn a_bias_of_the_torque_shifts_where_a_gear_lags() {
    for seed in 0..4 {
        let (state, bias) = (core::cell::Cell::new(0.0), 60.0);
        let lags = |axis: usize, torque: f64| {
            let elastic = five_axis().joints[axis - 1].compliance() * bias;
            if axis != 2 {
                return elastic;
            }
            state.set(play(torque + bias, 250.0, state.get()));
            elastic + 1.5e-7 * state.get()
        };
        let trace = traced(&measured(&five_axis(), &both_ways(), 750 + seed, lags));
        let told = (trace.verdict, names(&trace));
        let both = ["load_cell_bias@rig", "hysteresis@joint 2"].map(String::from).to_vec();
        assert_eq!(told, (Verdict::Explained, both), "seed {seed}");
        assert!((trace.effects[0].effect.value("torque") / bias - 1.0).abs() < 0.1, "seed {seed}");
    }
}

/// Most rows of an axis fit a line without those that its gear hardens in: they come back with
/// the gear's own knee.
#[test]
fn a_curve_is_polished_on_the_rows_that_it_stands_on() {
    let torques: Vec<f64> = [10.0, 30.0, 60.0, 100.0, 200.0, 350.0, 500.0, 750.0, 1000.0].into();
    let back: Vec<f64> = torques.iter().rev().skip(1).copied().collect();
    let up: Vec<f64> = torques.iter().copied().chain(back).collect();
    let loads: Vec<f64> = up.iter().copied().chain(up.iter().map(|torque| -torque)).collect();
    for seed in 0..4 {
        let hard = |axis, torque: f64| {
            if axis == 5 { 1.2e-6 * torque / (torque / 400.0).hypot(1.0) } else { 0.0 }
        };
        let trace = traced(&measured(&five_axis(), &loads, 740 + seed, hard));
        let told = (trace.verdict, names(&trace));
        assert_eq!(told, (Verdict::Explained, ["stiffness_nonlinearity@joint 5".into()].into()), "seed {seed}");
        let knee = trace.effects[0].effect.value("knee");
        assert!((knee / 400.0 - 1.0).abs() < 0.05, "seed {seed}: {knee}");
    }
}
