//! Compliances axis by axis, the procedure of Abele, Weigold and Rothenbücher
//! (CIRP Annals 56/1, 2007): one gear is loaded at a time, those before it are
//! clamped, and the compliance is the slope of deflection over torque.

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use robstiff_robots::Description;
use robstiff_robots::effect::physics::PLAYS;

use super::baseline::{Visibility, declared, with_values};
use super::uncertainty::{WITHIN, student};
use super::whitening::mean_share;
use super::{Error, Estimate, Identification, element_name, unit_of};
use crate::Effect;
use crate::campaign::{Campaign, ClampedRow};
use crate::elements::{plays, turn};

/// Identifies the compliances of the axes that were loaded, beside the laws of
/// joints that the description declares. Where a joint is compound, the measurement
/// sees the sum of its parts, which keep their proportion.
///
/// # Errors
/// An axis whose deflection goes against its torque; rows that load no axis.
pub fn identify(campaign: &Campaign, rows: &[ClampedRow]) -> Result<Identification, Error> {
    let own = declared(&campaign.robot);
    let less = without_laws(&campaign.robot, rows);
    let mut values: Vec<f64> = own.iter().map(|number| number.value).collect();
    let mut estimates = Vec::new();
    for (i, number) in own.iter().enumerate() {
        let here = |row: &&ClampedRow| number.effect.is_none() && row.axis == i + 1;
        let of_axis: Vec<&ClampedRow> = less.iter().filter(here).collect();
        let slope = slope(&of_axis);
        let count =
            |goes: fn(f64) -> bool| rows.iter().filter(here).filter(|row| goes(row.torque * row.deflection)).count();
        // A sign is wrong in all rows, a wild reading in one.
        if count(|work| work < 0.0) > count(|work| work > 0.0) {
            let line = of_axis[0].line;
            return Err(Error(format!(
                "axis {} deflects against its torque (rows from line {line}): check the signs",
                i + 1
            )));
        }
        let clipped = slope.is_some_and(|(value, _)| value < 0.0);
        if let Some((value, _)) = slope {
            values[i] = value.max(0.0);
        }
        estimates.push(Estimate {
            name: element_name(&campaign.robot, number),
            declared: number.value,
            value: values[i],
            std: slope.filter(|_| !clipped).and_then(|(_, std)| std),
            unit: unit_of(&campaign.robot, number.column),
            visibility: if slope.is_some() { Visibility::Seen } else { Visibility::Unseen },
            at_bound: clipped && number.value > 0.0,
        });
    }
    if estimates.iter().all(|estimate| estimate.visibility != Visibility::Seen) {
        return Err(Error(String::from("no row loads its axis: every torque is zero")));
    }
    Ok(Identification {
        left_out: Vec::new(),
        description: with_values(&campaign.robot, &values),
        correlation: DMatrix::identity(estimates.len(), estimates.len()),
        estimates,
        rows: rows.len(),
        poses: 0,
        noise: None,
        covariance: None,
        rms_declared: None,
        rms: None,
    })
}

/// The rows less what laws of joints do that the description declares, each axis
/// beginning at rest; but for a compliance that varies with the axis's angle,
/// which such rows do not tell. Torques (Nm) stay, deflections (rad) are what is
/// left.
pub fn without_laws(robot: &Description, rows: &[ClampedRow]) -> Vec<ClampedRow> {
    let mut states = std::vec![[0.0; PLAYS]; robot.joints.len()];
    let less = |row: &ClampedRow| {
        let (joint, mut less) = (row.axis - 1, *row);
        for effect in robot.effects.iter().filter(|effect| effect.row() == Some(row.axis)) {
            if matches!(effect, Effect::PoseDependentCompliance { .. }) {
                continue;
            }
            states[joint] = plays(effect, row.torque, states[joint]);
            let own = robot.joints[joint].compliance();
            less.deflection -= turn(effect, own, 0.0, row.torque, states[joint]).unwrap_or(0.0);
        }
        less
    };
    rows.iter().map(less).collect()
}

/// The slope through the origin of rows that share one unloaded reading, and its
/// standard deviation from their scatter (none from a single row); `None` where
/// nothing was loaded. The standard deviation is told as
/// [`uncertainty`](super::uncertainty) tells it.
fn slope(rows: &[&ClampedRow]) -> Option<(f64, Option<f64>)> {
    let share = mean_share(rows.len(), 1.0) / rows.len().max(1) as f64;
    let whitened = |of: fn(&ClampedRow) -> f64| {
        let values = DVector::from_iterator(rows.len(), rows.iter().map(|row| of(row)));
        let sum = values.sum();
        values.add_scalar(-share * sum)
    };
    let (torques, deflections) = (whitened(|row| row.torque), whitened(|row| row.deflection));
    let squares = torques.norm_squared();
    if squares == 0.0 {
        return None;
    }
    let slope = torques.dot(&deflections) / squares;
    let freedom = rows.len() as f64 - 1.0;
    let std = (freedom > 0.0).then(|| {
        let left = (deflections - slope * torques).norm_squared();
        (left / freedom / squares).sqrt() * student(freedom) / WITHIN
    });
    Some((slope, std))
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::campaign::Data;
    use crate::campaign::made::{campaign, normal};
    use crate::samples::five_axis;

    fn row(torque: f64, deflection: f64) -> ClampedRow {
        ClampedRow { line: 2, axis: 1, torque, deflection }
    }

    #[test]
    fn the_slope_goes_through_the_origin() {
        let rows = [row(100.0, 3e-5), row(-200.0, -6e-5), row(300.0, 9e-5)];
        let (value, std) = slope(&rows.each_ref()).expect("loaded");
        assert!((value - 3e-7).abs() < 1e-18 && std.expect("three rows") < 1e-18);
        assert_eq!(slope(&[&row(100.0, 1e-5)]).expect("loaded").1, None);
        assert_eq!(slope(&[&row(0.0, 1e-5)]), None);
        assert_eq!(slope(&[]), None);
    }

    #[test]
    fn scatter_makes_the_standard_deviation() {
        // 1, -2, 1 about slope 2 at torques 1, 2, 3: orthogonal to the torques, and
        // without a mean, so of it the unloaded reading has nothing. Of the torques'
        // 14 it takes 6^2 / (1 + 3). The quantile is that of two degrees of freedom.
        let rows = [row(1.0, 3.0), row(2.0, 2.0), row(3.0, 7.0)];
        let (value, std) = slope(&rows.each_ref()).expect("loaded");
        assert!((value - 2.0).abs() < 1e-12);
        let expected = (6.0_f64 / 2.0 / (14.0 - 9.0)).sqrt() * 4.302_652_73 / 1.959_963_98;
        assert!((std.expect("three rows") / expected - 1.0).abs() < 1e-8);
    }

    /// Whatever the number of rows, 1.96 standard deviations are the 95 % interval.
    #[test]
    fn intervals_hold_what_they_say() {
        let mut random = ChaCha8Rng::seed_from_u64(31);
        let runs = 2000;
        for torques in [&[400.0, 800.0][..], &[200.0, 400.0, 600.0], &[-800.0, -400.0, 200.0, 400.0, 600.0, 800.0]] {
            let within = (0..runs).filter(|_| {
                let unloaded = normal(&mut random);
                let mut read = |torque: &f64| row(*torque, 0.03 * torque + normal(&mut random) - unloaded);
                let rows: Vec<ClampedRow> = torques.iter().map(&mut read).collect();
                let (value, std) = slope(&rows.iter().collect::<Vec<_>>()).expect("loaded");
                (value - 0.03).abs() <= WITHIN * std.expect("two rows or more")
            });
            let share = within.count() as f64 / f64::from(runs);
            assert!((share - 0.95).abs() < 0.02, "{share} at {torques:?}");
        }
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

    /// One reading the wrong way is a wild one, most of them a wrong sign.
    #[test]
    fn a_wild_reading_is_no_wrong_sign() {
        let mut rows = [row(100.0, 3e-5), row(200.0, 6e-5), row(300.0, -9e-4)];
        let of = |rows: &[ClampedRow]| identify(&campaign(five_axis(), Data::Clamped(rows.to_vec())), rows);
        assert!(of(&rows).is_ok());
        rows[1].deflection = -6e-5;
        let Error(told) = of(&rows).expect_err("two of three");
        assert!(told.contains("axis 1 deflects against its torque (rows from line 2)"), "{told}");
    }

    /// What the data do not follow is at its bound, and no wrong sign.
    #[test]
    fn an_axis_that_gives_way_less_than_declared_is_at_its_bound() {
        let mut robot = five_axis();
        robot.effects.push(Effect::LostMotion { joint: 1, gap: 4e-4, knee: 200.0 });
        let rows = [row(100.0, 1e-6), row(200.0, 2e-6), row(300.0, 3e-6)];
        let found = identify(&campaign(robot, Data::Clamped(rows.to_vec())), &rows).expect("axis 1 is loaded");
        let Estimate { value, std, at_bound, .. } = found.estimates[0];
        assert_eq!((value, std, at_bound), (0.0, None, true));
    }
}
