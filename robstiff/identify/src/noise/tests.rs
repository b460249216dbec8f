//! Noise of known size and kind.

use nalgebra::{DMatrix, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::estimated::beyond_noise;
use super::straight::straightened;
use super::*;
use crate::campaign::made::{Plan, displacements};
use crate::campaign::{Campaign, Data, Displacements};
use crate::observe::displacement::Displacement;
use crate::probability::normal;
use robstiff::Effect;
use robstiff_robots::Description;
use robstiff_robots::samples::five_axis;

fn estimate(plan: &Plan) -> Covariance {
    of(&plan.run())
}

fn of(campaign: &Campaign) -> Covariance {
    let (samples, frame) = straight(campaign);
    Covariance::estimate(&samples, frame, campaign.noise, |_| true)
}

fn straight(campaign: &Campaign) -> (Samples, Frame) {
    let data = displacements(campaign);
    (straightened(&campaign.robot, data), data.measured_frame)
}

fn samples_of(robot: &Description, data: &Displacements) -> Samples {
    Samples::of(&Displacement::new(robot, data), robot, data)
}

fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().sum::<f64>() / values.count() as f64
}

/// The mean over campaigns of what one says, with seeds of their own.
fn estimates(plan: impl Fn(u64) -> Plan, count: u64) -> Vec<Covariance> {
    (0..count).map(|seed| estimate(&plan(seed))).collect()
}

const UNEQUAL: [f64; 3] = [6e-6, 9e-6, 1.5e-5];

/// Standard deviations of the estimates are 320 contrasts' 4 % of a sigma and,
/// by the profile likelihood, 0.2 of a share of one; of the mean of 30 a fifth.
#[test]
fn axes_and_the_share_of_the_unloaded_reading_come_back() {
    for shares_unloaded in [true, false] {
        let plan = |seed| Plan { noise: UNEQUAL, shares_unloaded, ..Plan::new(seed) };
        let found = estimates(plan, 30);
        // A row's own noise: one reading's, or both of a displacement.
        let of_own = if shares_unloaded { 1.0 } else { core::f64::consts::SQRT_2 };
        for (axis, sigma) in UNEQUAL.into_iter().enumerate() {
            let own = mean(found.iter().map(|one| one.own[axis]));
            assert!((own / (of_own * sigma) - 1.0).abs() < 0.03, "{shares_unloaded} {axis}: {own}");
        }
        let shared = mean(found.iter().map(|one| one.shared));
        // Held to 0..1, half of the estimates' scatter is cut off at the end.
        let (low, high) = if shares_unloaded { (0.85, 1.0) } else { (0.0, 0.1) };
        assert!((low..=high).contains(&shared), "{shares_unloaded}: {shared}");
        let reading = mean(found.iter().map(|one| one.reading().expect("estimated")));
        let truth = (UNEQUAL.iter().map(|s| s * s).sum::<f64>() / 3.0).sqrt();
        assert!((reading / truth - 1.0).abs() < 0.03, "{shares_unloaded}: {reading}");
        // Two tests at 1 % each: more than 3 of 30 with a probability of 0.3 %.
        assert!(found.iter().all(|one| one.unequal));
        assert!(found.iter().filter(|one| one.basis != Basis::Contrasts(Level::Linear)).count() <= 3);
        assert!(found.iter().map(|one| one.outliers.len()).sum::<usize>() <= 2);
    }
}

/// What a robot lacks is no noise: a tilting bearing, a turned force sensor, and
/// a tool's rotation leave the estimate as it was.
#[test]
fn what_a_model_lacks_does_not_pass_for_noise() {
    let plan = Plan { rotation_noise: Some([2e-5; 3]), ..Plan::new(3) };
    let plain = of(&plan.run());
    let hidden = std::vec![Effect::TransverseCompliance { joint: 3, value: 2e-6 }];
    let turned = nalgebra::Rotation3::from_scaled_axis(Vector3::new(0.1, -0.2, 0.3));
    let lacking = Plan { hidden, ..plan }.run_with(|_, row| {
        let force = turned * Vector3::from_column_slice(&row.wrench[..3]);
        row.wrench[..3].copy_from_slice(force.as_slice());
    });
    let found = of(&lacking);
    for (one, other) in plain.own.iter().zip(&found.own) {
        // Bending over, the arm is not quite linear.
        assert!((one / other - 1.0).abs() < 0.02, "{one} {other}");
    }
    assert!((plain.shared - found.shared).abs() < 0.05);
    assert!((found.own[3] / plain.own[3] - 1.0).abs() < 0.1);
}

/// Lost motion gives a visit's rows more in common than a reading could.
#[test]
fn the_unloaded_reading_is_a_reading() {
    let found = of(&Plan::new(5).run_with(|_, row| {
        let force = Vector3::from_column_slice(&row.wrench[..3]);
        let lost = force.normalize() * 4e-5;
        (0..3).for_each(|k| row.displacement[k] += lost[k]);
    }));
    assert_eq!(found.shared, 1.0);
    assert!(found.share.expect("ramps").beyond_one > 10.0);
    let plain = of(&Plan::new(5).run());
    assert!(plain.share.expect("ramps").beyond_one < 4.0);
}

/// Gears that harden are freed, and the noise is that of repeated loads.
#[test]
fn curvature_does_not_pass_for_noise() {
    let found = of(&Plan::new(7).run_with(|_, row| {
        let force = Vector3::from_column_slice(&row.wrench[..3]);
        let less = force * (force.norm() / 1e3 * 2e-7);
        (0..3).for_each(|k| row.displacement[k] -= less[k]);
    }));
    assert!(matches!(found.basis, Basis::Contrasts(Level::Curved | Level::Repeated)), "{:?}", found.basis);
    assert!((found.reading().expect("estimated") / 1e-5 - 1.0).abs() < 0.1);
}

/// Loads that were not repeated, one visit each: nothing is shared that could be
/// told, and nothing depends on it.
#[test]
fn rows_of_their_own_share_nothing() {
    let plan = Plan { visits: 8, ramp: std::vec![1.0], shares_unloaded: false, noise: [1e-5; 3], ..Plan::new(2) };
    let found = estimate(&plan);
    assert_eq!((found.shared, found.share), (0.0, None));
    assert!((found.reading().expect("estimated") / 1e-5 - 1.0).abs() < 0.1);
}

/// Noise in the tool's frame is found there.
#[test]
fn noise_of_a_camera_on_the_tool() {
    let plan = Plan { noise: [3e-6, 9e-6, 9e-6], measured_frame: Frame::Tool, ..Plan::new(4) };
    let found = estimate(&plan);
    assert!((found.own[0] / 3e-6 - 1.0).abs() < 0.15 && (found.own[1] / 9e-6 - 1.0).abs() < 0.15, "{:?}", found.own);
}

/// An outlying row and an outlying unloaded reading are named, and do not pass for noise.
#[test]
fn wild_readings_are_named() {
    let found = of(&Plan::new(9).run_with(|i, row| {
        if i == 123 {
            row.displacement[1] += 1.5e-4;
        }
        if (200..205).contains(&i) {
            row.displacement[2] -= 2e-4;
        }
    }));
    let [row, visit] = &found.outliers[..] else { panic!("{:?}", found.outliers) };
    assert_eq!((row.rows.as_slice(), row.whole_visit, visit.whole_visit), (&[123][..], false, true));
    assert_eq!((visit.rows.len(), visit.visit), (5, 40));
    assert!((row.shift[1] / 1.5e-4 - 1.0).abs() < 0.3 && (visit.shift[2] / -2e-4 - 1.0).abs() < 0.3);
    assert!(row.size > 4.0 && row.p_value < 1e-4);
    assert!((found.reading().expect("estimated") / 1e-5 - 1.0).abs() < 0.1);
}

/// Student's noise of three degrees of freedom is told from normal noise, which
/// is taken for heavy-tailed at the rate of the level.
#[test]
fn heavy_tails_are_noticed() {
    let tails = |campaign: &Campaign| {
        let (samples, frame) = straight(campaign);
        Covariance::estimate_with_tails(&samples, frame, campaign.noise, |_| true).1.expect("enough")
    };
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let found = tails(&Plan { noise: [1e-9; 3], ..Plan::new(11) }.run_with(|_, row| {
        for reading in &mut row.displacement {
            let spread: f64 = (0..4).map(|_| normal(&mut random).powi(2)).sum::<f64>() / 4.0;
            *reading += 1e-5 * normal(&mut random) / spread.sqrt();
        }
    }));
    assert!(found.p_value < 0.01 && found.freedom.is_some_and(|freedom| freedom < 10.0), "{found:?}");
    // 60 campaigns at a level of 5 %: more than 8 with a probability of 1 %.
    let clean = |seed: u64| Plan { poses: 12, ..Plan::new(100 + seed) }.run();
    let noticed = (0..60).filter(|&seed| tails(&clean(seed)).p_value <= 0.05).count();
    assert!(noticed <= 8, "{noticed}");
}

/// Clean campaigns: outlying readings in at most as many as the level says (in 60 at
/// 1 %, more than 3 with a probability of 0.3 %).
#[test]
fn no_reading_of_a_clean_campaign_is_wild() {
    let wild = estimates(|seed| Plan { poses: 12, ..Plan::new(300 + seed) }, 60);
    assert!(wild.iter().filter(|one| !one.outliers.is_empty()).count() <= 3);
}

/// Repetitions see the scatter between readings of one load, not the load.
#[test]
fn repetitions_give_the_noise() {
    let plan = Plan { poses: 30, visits: 1, ramp: std::vec![1.0], noise: [0.0; 3], ..Plan::new(1) };
    let mut campaign = plan.run();
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("made above") };
    let twins: Vec<crate::campaign::Observation> = data.rows.clone();
    for (i, mut twin) in twins.into_iter().enumerate() {
        // Rows without a visit of their own in common have each its unloaded
        // reading: a difference of 2 s has the variance of 4 readings, s^2.
        twin.visit = 30 + i;
        twin.displacement.iter_mut().for_each(|d| *d += 2e-5);
        data.rows.push(twin);
    }
    data.visits = (0..60).map(|i| format!("{i}")).collect();
    let samples = samples_of(&five_axis(), data);
    let covariance = Covariance::estimate(&samples, Frame::Base, Noise::default(), |_| true);
    let without = |left_out: &[usize]| {
        let left_out = left_out.to_vec();
        covariance.pure_error(&samples, Level::Repeated, |_| true, move |row| left_out.contains(&row))
    };
    let found = without(&[]);
    assert_eq!((found.freedom, without(&[3, 34, 40]).freedom), (90, 81));
    assert!((found.variance().expect("enough repetitions").sqrt() - 1e-5).abs() < 1e-12);
}

/// Contrasts are orthonormal, free of every load, and each holds as much of the
/// unloaded readings as it says.
#[test]
fn contrasts_are_free_of_loads() {
    let ramp = std::vec![0.35, 0.7, 1.0, 0.7, 0.35, 0.0];
    let campaign = Plan { poses: 300, visits: 4, ramp, there_and_back: true, ..Plan::new(6) }.run();
    let samples = samples_of(&campaign.robot, displacements(&campaign));
    let readings = DMatrix::from_fn(samples.rows.len(), 3, |i, k| samples.rows[i].displacement[k]);
    for (level, count) in [(Level::Linear, 22), (Level::Curved, 20), (Level::Repeated, 11)] {
        for chunk in contrasts(&samples, &readings, level, |_| true, |_| false) {
            assert_eq!(chunk.shares.len(), count, "{level:?}");
            let same = |i: usize, j: usize| f64::from(u8::from(chunk.visits[i] == chunk.visits[j]));
            let together = DMatrix::from_fn(24, 24, same);
            let shares = DMatrix::from_diagonal(&nalgebra::DVector::from_column_slice(&chunk.shares));
            assert!((chunk.basis.tr_mul(&chunk.basis) - DMatrix::identity(count, count)).amax() < 1e-12);
            assert!((chunk.basis.tr_mul(&together) * &chunk.basis - shares).amax() < 1e-12);
            let loads = DMatrix::from_fn(24, 6, |i, k| samples.rows[chunk.rows[i]].wrench[k] / 1e3);
            assert!(chunk.basis.tr_mul(&loads).amax() < 1e-12, "{level:?}");
        }
    }
}

/// With few contrasts as with many, for axes that differ: the counts of 4000 draws have
/// standard deviations of a sixth.
#[test]
fn more_is_freed_for_noise_as_often_as_it_is_said() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for (contrasts, fewer) in [(20, 10), (200, 12), (90, 60)] {
        let mut squares =
            |count: usize, sigma: f64| (0..count).map(|_| (sigma * normal(&mut random)).powi(2)).sum::<f64>();
        let freed = (0..4000).filter(|_| {
            let freer: Vec<f64> = UNEQUAL.iter().map(|&sigma| squares(fewer, sigma)).collect();
            let more = UNEQUAL.iter().map(|&sigma| squares(contrasts - fewer, sigma));
            let all: Vec<f64> = more.zip(&freer).map(|(more, freer)| more + freer).collect();
            beyond_noise((all, contrasts as f64), (freer, fewer as f64)).is_some_and(|p| p <= NESTED)
        });
        let share = freed.count() as f64 / 4000.0;
        assert!((0.5 * NESTED..1.5 * NESTED).contains(&share), "{contrasts} {fewer}: {share}");
    }
}
