//! Slopes of clamped axes.

use std::string::ToString;
use std::vec::Vec;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::campaign::Data;
use crate::campaign::made::campaign;
use crate::probability::{WITHIN, normal};
use robstiff::JointKind;
use robstiff_robots::samples::five_axis;

fn row(torque: f64, deflection: f64) -> ClampedRow {
    ClampedRow { line: 2, axis: 1, torque, deflection }
}

#[test]
fn the_slope_goes_through_the_origin() {
    let found = identified(vec![row(100.0, 3e-5), row(-200.0, -6e-5), row(300.0, 9e-5)]);
    let Estimate { value, std, .. } = found.estimates[0];
    // As sure as the finest instrument reads.
    assert!((value - 3e-7).abs() < 1e-15 && std.expect("three rows") < 1e-9, "{value} {std:?}");
}

#[test]
fn scatter_makes_the_standard_deviation() {
    // 1, -2, 1 about slope 20 at torques 1, 2, 3: orthogonal to the torques, and
    // without a mean, so of it the unloaded reading has nothing. Of the torques'
    // 14 it takes 6^2 / (1 + 3). The quantile is that of two degrees of freedom.
    let rows = [(1.0, 21.0), (2.0, 38.0), (3.0, 61.0)].map(|(torque, read)| row(100.0 * torque, 1.3e-6 * read));
    let Estimate { value, std, .. } = identified(rows.to_vec()).estimates[0];
    assert!((value / 2.6e-7 - 1.0).abs() < 1e-6, "{value}");
    let expected = 1.3e-8 * (6.0_f64 / 2.0 / (14.0 - 9.0)).sqrt() * 4.302_652_73 / 1.959_963_98;
    assert!((std.expect("three rows") / expected - 1.0).abs() < 1e-3, "{std:?} {expected}");
}

/// Whatever the number of rows, 1.96 standard deviations are the 95 % interval.
#[test]
fn intervals_hold_what_they_say() {
    let mut random = ChaCha8Rng::seed_from_u64(31);
    let runs = 400;
    for torques in [&[400.0, 800.0][..], &[200.0, 400.0, 600.0], &[-800.0, -400.0, 200.0, 400.0, 600.0, 800.0]] {
        let within = (0..runs).filter(|_| {
            let unloaded = normal(&mut random);
            let mut read = |torque: &f64| row(*torque, 3e-7 * torque + 3e-6 * (normal(&mut random) - unloaded));
            let Estimate { value, std, .. } = identified(torques.iter().map(&mut read).collect()).estimates[0];
            (value - 3e-7).abs() <= WITHIN * std.expect("two rows or more")
        });
        let share = within.count() as f64 / f64::from(runs);
        assert!((share - 0.95).abs() < 0.04, "{share} at {torques:?}");
    }
}

#[test]
fn an_axis_that_is_read_once_is_refused() {
    let read = |rows: &[ClampedRow]| identify(&campaign(five_axis(), Data::Clamped(Vec::new())), rows).map(|_| ());
    let told = read(&[row(100.0, 3e-5)]).expect_err("one row").to_string();
    assert!(told.contains("one row (line 2) cannot tell how sure the compliance of axis 1 is"), "{told}");
    assert_eq!(read(&[row(100.0, 3e-5), row(0.0, 0.0)]), Ok(()));
}

#[test]
fn declared_laws_are_not_counted_twice() {
    let mut robot = five_axis();
    let (gap, knee) = (4e-4, 20.0);
    robot.effects.push(Effect::LostMotion { joint: 1, gap, knee });
    let rows = (1..=20).map(|k| 50.0 * f64::from(k));
    let rows = rows.map(|torque: f64| row(torque, 2.63e-7 * torque + 0.5 * gap * torque / torque.hypot(knee)));
    let rows: Vec<ClampedRow> = rows.collect();
    let found = identify(&campaign(robot, Data::Clamped(rows.clone())), &rows).expect("axis 1 is loaded");
    assert!((found.estimates[0].value / 2.63e-7 - 1.0).abs() < 1e-9, "{:?}", found.estimates[0]);
}

/// One reading the wrong way is an outlying one, most of them a wrong sign.
#[test]
fn a_wild_reading_is_no_wrong_sign() {
    let mut rows = [row(100.0, 3e-5), row(200.0, 6e-5), row(300.0, -9e-4)];
    let of = |rows: &[ClampedRow]| identify(&campaign(five_axis(), Data::Clamped(rows.to_vec())), rows);
    assert!(of(&rows).is_ok());
    rows[1].deflection = -6e-5;
    let told = of(&rows).expect_err("two of three");
    assert!(matches!(told, Error::AgainstTheLoads(_)), "{told:?}");
    assert!(told.to_string().contains("axis 1 deflects against its torque (rows from line 2)"), "{told}");
}

/// An axis that does not move is read a step off now and then.
#[test]
fn a_step_of_the_gauge_is_no_wrong_sign() {
    let still = [row(100.0, 0.0), row(200.0, 0.0), row(300.0, -1e-6), row(400.0, 0.0)];
    let others = [2e-5, 5e-5, 7e-5, 1.1e-4].iter().zip(still).map(|(&deflection, row)| ClampedRow {
        axis: 2,
        deflection,
        ..row
    });
    let of = |rows: Vec<ClampedRow>| identify(&campaign(five_axis(), Data::Clamped(rows.clone())), &rows);
    let found = of(still.into_iter().chain(others.clone()).collect()).expect("one axis is rigid");
    assert!(found.estimates[0].at_bound && found.estimates[0].value == 0.0, "{:?}", found.estimates[0]);
    let against = still.map(|row| ClampedRow { deflection: -1e-6, ..row });
    assert!(of(against.into_iter().chain(others.clone()).collect()).is_ok(), "a step off in every row");
    let against = still.map(|row| ClampedRow { deflection: -3e-7 * row.torque, ..row });
    assert!(matches!(of(against.into_iter().chain(others).collect()), Err(Error::AgainstTheLoads(_))));
}

/// The noise of gears, in rad, is none of a rail's, in m.
#[test]
fn a_rail_among_gears_has_its_own_wild_readings() {
    let mut robot = five_axis();
    robot.joints[1].kind = JointKind::Prismatic;
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let mut rows = measured(24, |axis, _| if axis == 2 { 0.0 } else { 1e-5 * normal(&mut random) });
    rows[35].deflection += 6e-5;
    let found = identify(&campaign(robot, Data::Clamped(rows.clone())), &rows).expect("three axes are loaded");
    assert_eq!(found.left_out, [37]);
}

/// What the data do not follow is at its bound, and no wrong sign.
#[test]
fn an_axis_that_gives_way_less_the_more_it_is_loaded_is_at_its_bound() {
    let mut robot = five_axis();
    robot.effects.push(Effect::LostMotion { joint: 1, gap: 4e-4, knee: 50.0 });
    let read = |k: i32| {
        let torque = 100.0 * f64::from(k);
        row(torque, 2e-4 * torque / torque.hypot(50.0) - 2e-8 * torque)
    };
    let rows: Vec<ClampedRow> = (1..=9).map(read).collect();
    let found = identify(&campaign(robot, Data::Clamped(rows.clone())), &rows).expect("axis 1 is loaded");
    let Estimate { value, std, at_bound, .. } = found.estimates[0];
    assert_eq!((value, std, at_bound), (0.0, None, true));
}

/// Three axes with so many rows each, and noise of 1 urad.
fn measured(count: usize, mut more: impl FnMut(usize, f64) -> f64) -> Vec<ClampedRow> {
    let mut random = ChaCha8Rng::seed_from_u64(77);
    let mut row = |k: usize| {
        let (axis, torque) = (k / count + 1, 1000.0 * (k % count + 1) as f64 / count as f64);
        let deflection = 3e-7 * torque + more(axis, torque) + 1e-6 * normal(&mut random);
        ClampedRow { line: k + 2, axis, torque, deflection }
    };
    (0..3 * count).map(&mut row).collect()
}

fn identified(rows: Vec<ClampedRow>) -> Identification {
    identify(&campaign(five_axis(), Data::Clamped(rows.clone())), &rows).expect("axes are loaded")
}

#[test]
fn a_wild_reading_is_left_out_and_named() {
    let mut rows = measured(8, |_, _| 0.0);
    rows[9].deflection *= 100.0;
    let found = identified(rows);
    assert_eq!((found.left_out.as_slice(), found.rows), ([11].as_slice(), 24));
    assert!((found.estimates[1].value / 3e-7 - 1.0).abs() < 0.02, "{:?}", found.estimates[1]);
}

#[test]
fn curves_and_noise_are_left_in() {
    assert!(identified(measured(8, |_, _| 0.0)).left_out.is_empty());
    let lost = |axis, torque: f64| if axis == 2 { 2e-4 * torque / torque.hypot(50.0) } else { 0.0 };
    assert!(identified(measured(8, lost)).left_out.is_empty());
}

/// What is declared must go with what is found: no file is written that cannot be read back.
#[test]
fn a_coupling_beyond_the_compliances_found_is_refused() {
    let mut robot = five_axis();
    robot.effects = [Effect::JointCoupling { joints: [2, 3], value: 2e-7 }].into();
    assert!(is_readable(&robot));
    let rows = measured(8, |axis, torque| if axis == 2 { -2e-7 * torque } else { 0.0 });
    let campaign = campaign(robot, Data::Clamped(rows.clone()));
    let why = identify(&campaign, &rows).expect_err("the root of 1e-7 times 3e-7 is less than 2e-7");
    assert_eq!(why, Error::NoDescription);
    let why = crate::trace::trace(&campaign, &Default::default(), &|_| {}).expect_err("it, too");
    assert_eq!(why, Error::NoDescription);
}

/// Twelve rows of two axes, two of a third that disagree.
#[test]
fn of_two_rows_neither_is_left_out() {
    let mut rows = measured(12, |_, _| 0.0);
    rows.truncate(26);
    rows[25].deflection = 9e-3;
    assert!(identified(rows).left_out.is_empty());
}

/// Three axes that are loaded up and down both ways, read in steps of a gauge, with noise
/// besides (rad); and the compliances that they have.
fn rounded(seed: u64, step: f64, noise: f64) -> (Vec<ClampedRow>, [f64; 3]) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let compliances = [2.1e-7, 3.3e-7, 4.7e-7].map(|h: f64| h * (1.0 + 0.3 * normal(&mut random).tanh()));
    let shares = [0.2, 0.4, 0.6, 0.8, 1.0, 0.8, 0.6, 0.4, 0.2, 0.0];
    let row = |k: usize| {
        let (axis, share) = (k / 20 + 1, shares[k % 10] * if k % 20 < 10 { 3000.0 } else { -3000.0 });
        let read = compliances[axis - 1] * share + noise * normal(&mut random);
        let deflection = if step > 0.0 { step * (read / step).round() } else { read };
        ClampedRow { line: k + 2, axis, torque: share, deflection }
    };
    ((0..60).map(row).collect(), compliances)
}

/// Rows that fit exactly may still be off by what their gauge does not show.
#[test]
fn no_slope_is_surer_than_its_gauge_reads() {
    for (step, noise) in [(2e-6, 3e-7), (5e-6, 5e-7), (1e-5, 1e-7), (5e-6, 2e-6)] {
        let (mut beyond, mut count) = (0, 0);
        for seed in 0..80 {
            let (rows, compliances) = rounded(seed, step, noise);
            // Now and then all fit exactly, as if no gauge had read them.
            if of_rounding(&rows) == [0.0; 3] {
                continue;
            }
            let found = identified(rows);
            for (estimate, truth) in found.estimates.iter().zip(compliances) {
                let std = estimate.std.unwrap_or_else(|| panic!("{estimate:?} {truth} {seed} {step}"));
                assert!(std > 1e-4 * truth, "{estimate:?}");
                beyond += usize::from((estimate.value - truth).abs() > WITHIN * std);
                count += 1;
            }
        }
        assert!(count > 220 && beyond * 20 <= count + 60, "{beyond} of {count} at {step} and {noise}");
    }
}

/// What is not rounded, or finer than the noise, is as sure as its scatter says.
#[test]
fn readings_that_are_not_rounded_are_as_sure_as_they_scatter() {
    let of = |rows: &[ClampedRow]| of_rounding(rows).into_iter().fold(0.0, f64::max);
    for seed in 0..20 {
        assert_eq!(of(&rounded(seed, 0.0, 1e-6).0), 0.0);
        // Half a step makes no difference.
        assert!(of(&rounded(seed, 1e-6, 6e-7).0) <= 0.36e-12);
    }
    // Nor are equal steps of the torque one of the gauge.
    let even: Vec<ClampedRow> = (1..=8).map(|k| row(100.0 * f64::from(k), 3e-5 * f64::from(k))).collect();
    assert_eq!(of_rounding(&even), [0.0]);
}
